"""MuJoCo: the mechanism as bodies with soft constraints, stepped in time while the inputs move.

Loops are closed and inputs driven by its equality constraints, which are springs by their nature;
its step is varied. Positions are read after the time between two rows has passed. Links have unit
masses, as motions that are prescribed do not depend on them.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from mechkin_cli.bench.chain import (
    GROUND,
    BodyTree,
    Closed,
    CommonFrame,
    CommonPoint,
    TreeDisplacement,
)
from mechkin_cli.bench.measurement import Method, Unable
from mechkin_cli.bench.methods import RowByRow

if TYPE_CHECKING:
    from mechkin_cli.bench.scene import BenchScene, Values
    from mechkin_cli.mechanism.vectors import Frame
    from mechkin_cli.show import Floats

FAMILY = "MuJoCo"
STEPS = (4, 16, 64)
"""Of time between two rows."""

INERTIA = 0.1
"""Of every link, kg m^2."""

HINGES = {"R": ("hinge",), "P": ("slide",), "C": ("hinge", "slide")}
"""Its joints along an axis by the kind of displacement."""


def methods(scene: BenchScene) -> Iterator[Method]:
    """Steps in time, by their number between two rows."""
    mujoco = import_module("mujoco")
    # that a step was too long is seen in the error; a callback of one's own would be kept for ever
    mujoco.set_mju_user_warning(str)
    rows = RowByRow(scene)
    _check(scene.chain, rows)
    for steps in STEPS:
        stepping = Stepping(mujoco, rows, steps)
        call = stepping.sweep
        setting = f"{steps} a row"
        yield Method(
            FAMILY, "constrained steps", setting, "position", call, scene.rows, call, slow=True
        )


def _check(chain: BodyTree, rows: RowByRow) -> None:
    kinds = {body.by.kind for body in chain.bodies if body is not None}
    if not kinds <= {*HINGES, "W"}:
        other = ", ".join(sorted(kinds - {*HINGES, "W"}))
        raise Unable(f"no model of this tree was written for it (joints {other} in the tree)")
    if not all(_pairs(closing) for closing in chain.closings):
        raise Unable("only loops that close in a ball or a hinge are written for it (its connect)")
    if not between_rows(rows) > 0.0:
        raise Unable("its inputs have no rates that lead from row to row, so that no time passes")


def between_rows(rows: RowByRow) -> float:
    """The time in s from a row to the next at the inputs' largest rates; 0 where they have none."""
    largest = np.max(np.abs(rows.rates), axis=1, initial=0.0)
    moved = np.abs(np.diff(rows.inputs, axis=1))[largest > 0.0]
    return float(np.max(moved / largest[largest > 0.0, None], initial=0.0))


class Stepping:
    """A scene as a model of the library."""

    def __init__(self, mujoco: Any, rows: RowByRow, steps: int) -> None:
        self.mujoco, self.rows, self.steps, self.chain = mujoco, rows, steps, rows.chain
        self.step = between_rows(rows) / steps
        self.names: dict[int, str] = {}
        self.model = mujoco.MjModel.from_xml_string(self._text())
        # its compiler takes points on second bodies from a drawing that need not be closed
        for name, closing, (one, two) in self._connected():
            anchors = self.model.eq_data[self.model.equality(name).id]
            anchors[:3] = self._local(closing.first, one)
            anchors[3:6] = self._local(closing.second, two)
        self.places = {k: int(self.model.joint(name).qposadr[0]) for k, name in self.names.items()}

    def sweep(self) -> Values:
        """All rows: the constraint of the input moves on with every step."""
        rows, mujoco = self.rows, self.mujoco
        data = mujoco.MjData(self.model)
        for k, place in self.places.items():
            data.qpos[place] = rows.start[k]
        drives = [self.model.equality(f"drive{k}").id for k in rows.driven]
        found, last = (
            np.repeat(rows.start[:, None], rows.inputs.shape[1], axis=1),
            rows.inputs[:, 0],
        )
        for row in range(rows.inputs.shape[1]):
            given = rows.inputs[:, row]
            for part in np.linspace(0.0, 1.0, self.steps + 1)[1:]:
                self.model.eq_data[drives, 0] = last + part * (given - last)
                mujoco.mj_step(self.model, data)
            last = given
            found[:, row] = self._coordinates(data, given)
        return rows.named(found, [rows.turned] * rows.inputs.shape[1])

    def _coordinates(self, data: Any, given: Floats) -> Floats:
        found = self.rows.start.copy()
        for k, place in self.places.items():
            found[k] = data.qpos[place]
        found[self.rows.driven] = given
        return found

    def _text(self) -> str:
        root = ElementTree.Element("mujoco")
        _add(root, "compiler", angle="radian")
        options = {"timestep": repr(self.step), "gravity": "0 0 0", "integrator": "implicitfast"}
        _add(root, "option", **options)
        world = _add(root, "worldbody")
        equality = _add(root, "equality")
        elements = [world]
        for number, body in enumerate(self.chain.bodies):
            assert body is not None
            parent = world if body.parent == GROUND else elements[body.parent + 1]
            elements.append(self._body(parent, number, body.parent, body.by))
        solver = {"solref": f"{2.0 * self.step!r} 1", "solimp": "0.9999 0.9999 0.001"}
        for name, closing, _ in self._connected():
            bodies = {"body1": _name(closing.first), "body2": _name(closing.second)}
            _add(equality, "connect", name=name, anchor="0 0 0", **bodies, **solver)
        for k in self.rows.driven:
            drive = {"name": f"drive{k}", "joint1": self.names[k], "polycoef": "0 0 0 0 0"}
            _add(equality, "joint", **drive, **solver)
        return ElementTree.tostring(root, encoding="unicode")

    def _connected(self) -> Iterator[tuple[str, Closed, tuple[Any, Any]]]:
        """Name, closing and points of every constraint."""
        for number, closing in enumerate(self.chain.closings):
            for which, pair in enumerate(_pairs(closing)):
                yield f"closing{number}.{which}", closing, pair

    def _body(self, parent: Any, number: int, of: int, by: TreeDisplacement) -> Any:
        """A body whose frame is that behind its displacement."""
        place = np.linalg.inv(self._after(of)) @ _matrix(by.before)
        rotation = place[:3, :3]
        axes = {"xyaxes": _numbers([*rotation[:, 0], *rotation[:, 1]])}
        body = _add(parent, "body", name=_name(number), pos=_numbers(place[:3, 3]), **axes)
        inertia = {"mass": "1", "diaginertia": _numbers([INERTIA] * 3)}
        _add(body, "inertial", pos="0 0 0", **inertia)
        for local, kind in enumerate(HINGES.get(by.kind, ())):
            name = f"q{by.first + local}"
            self.names[by.first + local] = name
            _add(body, "joint", name=name, type=kind, axis="0 0 1")
        return body

    def _after(self, number: int) -> Any:
        if number == GROUND:
            return np.eye(4)
        body = self.chain.bodies[number]
        assert body is not None
        return _matrix(body.by.after)

    def _local(self, number: int, at: Any) -> Any:
        return (np.linalg.inv(self._after(number)) @ [*at, 1.0])[:3]


def _add(parent: Any, kind: str, **attributes: str) -> Any:
    return ElementTree.SubElement(parent, kind, attributes)


def _pairs(closing: Closed) -> list[tuple[Any, Any]]:
    """Points that a closing keeps together: one of a ball, two on the axis of a hinge."""
    if isinstance(closing, CommonPoint):
        return [(closing.on_first, closing.on_second)]
    if isinstance(closing, CommonFrame) and [by.kind for by in closing.chain] == ["R"]:
        (by,) = closing.chain
        ends = [[np.array(f.o), np.add(f.o, f.z)] for f in (by.before, by.after)]
        return list(zip(*ends, strict=True))
    return []


def _matrix(frame: Frame) -> Any:
    found = np.eye(4)
    found[:3] = np.column_stack([frame.x, frame.y, frame.z, frame.o])
    return found


def _name(number: int) -> str:
    return "world" if number == GROUND else f"b{number}"


def _numbers(values: Any) -> str:
    return " ".join(repr(float(x)) for x in values)
