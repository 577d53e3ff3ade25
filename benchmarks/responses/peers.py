"""Other ways to a response: scipy's integrators on the case's equations, Pinocchio's accelerations
in them, MuJoCo's own steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

if TYPE_CHECKING:
    from benchmarks.responses.cases import Case
    from benchmarks.responses.tree import Tree

STEPS = (16, 64, 256)
"""Of MuJoCo between two rows."""


class Way(NamedTuple):
    """A way to the motion of a case: what is timed, and the coordinates (names, rows) it finds."""

    method: str
    setting: str
    call: Callable[[], object]
    read: Callable[[], Any]


def peers(case: Case, tolerances: tuple[float, ...]) -> tuple[list[Way], list[str]]:
    """Every other way that can run here, and the libraries that are missing."""
    found: list[Way] = []
    missing: list[str] = []
    for library, ways in (("scipy", _scipy), ("pinocchio", _pinocchio), ("mujoco", _mujoco)):
        try:
            found += ways(case, tolerances)
        except ImportError:
            missing.append(library)
    return found, missing


def _scipy(case: Case, tolerances: tuple[float, ...]) -> Iterator[Way]:
    integrate = import_module("scipy.integrate").solve_ivp
    for integrator in case.integrators:
        for tolerance in tolerances:
            run = partial(_integrated, integrate, case, case.rates, integrator, tolerance)
            yield Way(f"scipy, {integrator}", f"{tolerance:.0e}", run, run)


def _integrated(integrate: Any, case: Case, rates: Any, integrator: str, tolerance: float) -> Any:
    span = (float(case.moments[0]), float(case.moments[-1]))
    limits = {"rtol": tolerance, "atol": tolerance}
    found = integrate(rates, span, case.start, integrator, case.moments, **limits).y
    return found[: len(case.names)]


def _pinocchio(case: Case, tolerances: tuple[float, ...]) -> Iterator[Way]:
    if case.tree is None:
        return
    pin = import_module("pinocchio")
    integrate = import_module("scipy.integrate").solve_ivp
    model = _model(pin, case.tree)
    data, none, count = model.createData(), np.zeros(len(case.names)), len(case.names)

    def rates(_: Any, y: Any) -> Any:
        q, u = y[:count], y[count:]
        return np.concatenate([u, pin.aba(model, data, q, u, none)])

    for tolerance in tolerances:
        run = partial(_integrated, integrate, case, rates, "DOP853", tolerance)
        yield Way("Pinocchio in scipy, DOP853", f"{tolerance:.0e}", run, run)


def _model(pin: Any, tree: Tree) -> Any:
    """The tree as hinges of the library, whose frames have the axes of the drawing."""
    model = pin.Model()
    model.gravity.linear = tree.gravity
    index: list[int] = []
    for k, one in enumerate(tree.carried):
        root = one.parent < 0
        last = np.zeros(3) if root else tree.points[one.parent]
        place = pin.SE3(np.eye(3), tree.points[k] - last)
        above = 0 if root else index[one.parent]
        turn = pin.JointModelRevoluteUnaligned(tree.axes[k])
        index.append(model.addJoint(above, turn, place, one.joint))
        body = tree.bodies[k]
        if body is not None:
            own = pin.Inertia(body.mass, body.centre - tree.points[k], body.inertia)
            model.appendBodyToJoint(index[-1], own, pin.SE3.Identity())
    return model


def _mujoco(case: Case, _: tuple[float, ...]) -> Iterator[Way]:
    if case.tree is None:
        return
    mujoco = import_module("mujoco")
    for steps in STEPS:
        step = float(case.moments[1] - case.moments[0]) / steps
        model = mujoco.MjModel.from_xml_string(_xml(case.tree, step))
        run = partial(_stepped, mujoco, model, case, steps)
        yield Way("MuJoCo, Runge-Kutta steps", f"{steps} a row", run, run)


def _stepped(mujoco: Any, model: Any, case: Case, steps: int) -> Any:
    data, count = mujoco.MjData(model), len(case.names)
    data.qpos[:], data.qvel[:] = case.start[:count], case.start[count:]
    found = [data.qpos.copy()]
    for _ in case.moments[1:]:
        mujoco.mj_step(model, data, steps)
        found.append(data.qpos.copy())
    return np.array(found).T


def _xml(tree: Tree, step: float) -> str:
    root = ElementTree.Element("mujoco")
    ElementTree.SubElement(root, "compiler", angle="radian", balanceinertia="false")
    given = {"timestep": repr(step), "gravity": _numbers(tree.gravity), "integrator": "RK4"}
    option = ElementTree.SubElement(root, "option", given)
    ElementTree.SubElement(option, "flag", contact="disable")
    elements = [ElementTree.SubElement(root, "worldbody")]
    for k, one in enumerate(tree.carried):
        last = np.zeros(3) if one.parent < 0 else tree.points[one.parent]
        above = elements[one.parent + 1]
        at = _numbers(tree.points[k] - last)
        elements.append(ElementTree.SubElement(above, "body", name=one.joint, pos=at))
        ElementTree.SubElement(elements[-1], "joint", type="hinge", axis=_numbers(tree.axes[k]))
        body = tree.bodies[k]
        if body is not None:
            t = body.inertia
            parts = (t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2])
            inertia = {"mass": repr(float(body.mass)), "fullinertia": _numbers(parts)}
            inertia["pos"] = _numbers(body.centre - tree.points[k])
            ElementTree.SubElement(elements[-1], "inertial", inertia)
    return ElementTree.tostring(root, encoding="unicode")


def _numbers(values: Any) -> str:
    return " ".join(repr(float(x)) for x in values)
