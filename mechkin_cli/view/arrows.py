"""Arrows of forces and moments: every joint's reaction on its second link, what drives apply, and
the loads of the file.

`J.force` and `J.moment` are what the first link exerts on the second, about the joint's point;
`J.effort` is what a drive applies to the second link, along the joint's axis. Components that are
not unique are left out, and the arrow's name says which are there: `B.force (x, y)`; an arrow of
which nothing is known in any row is not there. Loads are forces and torques on links, loads of
joint coordinates on the second link, and what a spring between two points exerts on both.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.mechanism import (
    Attached,
    Bushing,
    Damper,
    JointLoad,
    LinkLoad,
    Spring,
    Varying,
    is_angle,
    law_value,
)
from mechkin_cli.tables import effort_names
from mechkin_cli.units import FORCE, MOMENT
from mechkin_cli.view.joints import carried, drawn_joints, link_poses
from mechkin_cli.view.page import packed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.building import DrawnBetween
    from mechkin_cli.mechanism import Amount, Mechanism, Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Readable
    from mechkin_cli.view.page import Lengths, Plain


Kind = Literal["force", "moment"]
AXES = "xyz"
NORMAL = (0.0, 0.0, 1.0)
KINDS: tuple[Kind, Kind] = ("force", "moment")


Arrow = tuple[str, Kind, Attached, "Floats"]
"""Name, kind, place on a link, and vectors over the rows (rows, 3) in the file's units."""


def tie_records(
    mechanism: Mechanism, drawn: Sequence[DrawnBetween], links: Sequence[str], lengths: Lengths
) -> list[Plain]:
    """Springs, dampers and cylinders for the page: those of loads between points and on joints that
    slide or turn about one axis, and those that are only `drawn`."""
    elements = (load for load in mechanism.loads if isinstance(load, Spring | Damper))
    loads = [load for load in elements if load not in mechanism.pretensions]
    kinds = {Spring: "spring", Damper: "damper"}
    ends = [
        (kinds[type(load)], load.between, None, None) for load in loads if load.between is not None
    ]
    found: list[Plain] = [
        {
            "kind": kind,
            "joint": None,
            "turns": False,
            "links": [links.index(end.link) for end in between],
            "places": [lengths.vector(end.vector) for end in between],
            "radius": None if radius is None else lengths.one(radius),
            "stroke": None if stroke is None else [lengths.one(end) for end in stroke],
        }
        for kind, between, radius, stroke in (*ends, *drawn)
        if all(end.link in links for end in between)
    ]
    joints = drawn_joints(mechanism)
    for load in loads:
        joint = mechanism.joints.get(load.joint or "")
        if joint is None or joint not in joints or len(joint.type.steps) > 1:
            continue  # of several displacements each has its own axis
        found.append(
            {
                "kind": kinds[type(load)],
                "joint": joints.index(joint),
                "turns": is_angle(load.coordinate or ""),
                "links": [links.index(joint.first), links.index(joint.second)],
                "places": [],
                "radius": None,
                "stroke": None,
            }
        )
    return found


def has_forces(mechanism: Mechanism) -> bool:
    """Whether anything can cause a force: a load, gravity on a mass, a mass that moves."""
    masses = any(link.has_mass for link in mechanism.links.values())
    return masses or bool(mechanism.loads or mechanism.frictions)


def reactions(problem: Problem) -> list[str]:
    """Names of the quantities that are shown as arrows of joints."""
    known = problem.quantities()
    names = [f"{joint.name}.{kind}" for joint in drawn_joints(problem.mechanism) for kind in KINDS]
    return [name for name in names if name in known]


def arrow_records(
    analysis: Readable, rows: NDArray[np.intp], links: Sequence[str], lengths: Lengths
) -> list[Plain]:
    """The arrows for the page in some rows."""
    units = analysis.result.units
    labels = {"force": units.label(FORCE), "moment": units.label(MOMENT)}
    return [
        {
            "name": name,
            "kind": kind,
            "unit": labels[kind],
            "link": links.index(place.link),
            "place": lengths.vector(place.vector),
            "values": packed("f32", values[rows]),
        }
        for name, kind, place, values in _arrows(analysis, links)
    ]


def _arrows(analysis: Readable, links: Sequence[str]) -> Iterator[Arrow]:
    problem = analysis.result.problem
    joints = problem.mechanism.joints
    for name in reactions(problem):
        joint, _, word = name.rpartition(".")
        kind = KINDS[0] if word == KINDS[0] else KINDS[1]
        yield from _known(name, kind, joints[joint].point, _in_space(analysis, name))
    yield from _efforts(analysis, problem)
    taken: Counter[str] = Counter()
    for name, kind, place, values in _loads(analysis, links):
        taken[name] += 1
        several = f"{name}, {taken[name]}" if taken[name] > 1 else name
        yield from _known(several, kind, place, values)


def _efforts(analysis: Readable, problem: Problem) -> Iterator[Arrow]:
    driven = [f"{joint}.{coordinate}" for joint, coordinate in problem.acting]
    for name, effort in zip(driven, effort_names(driven), strict=True):
        for kind, place, along in _along_joint(analysis, name, _drawable(analysis[effort])):
            yield from _known(effort, kind, place, along)


def _along_joint(
    analysis: Readable, name: str, values: Floats
) -> Iterator[tuple[Kind, Attached, Floats]]:
    """What acts along a joint coordinate on the second link: values (rows,) in file units."""
    problem = analysis.result.problem
    joint = problem.mechanism.joints[name.rpartition(".")[0]]
    if joint not in drawn_joints(problem.mechanism) or len(joint.coordinates) != 1:
        return  # the axis of one of several coordinates is not that of the joint
    axis = f"{joint.name}.axis"
    hinged = joint.plane and axis not in problem.quantities()  # about the plane's normal
    direction = np.array([NORMAL]) if hinged else _in_space(analysis, axis)
    kind = KINDS[1] if is_angle(name.rpartition(".")[2]) else KINDS[0]
    yield kind, joint.point, direction * values[:, None]


def _loads(analysis: Readable, links: Sequence[str]) -> Iterator[Arrow]:
    result = analysis.result
    mechanism = result.problem.mechanism
    loads = mechanism.loads
    if not loads:
        return
    pulling = (relation for relation in mechanism.couplings.values() if relation.pulls)
    carriers = {relation.mesh.carrier for relation in pulling if relation.mesh is not None}
    poses = link_poses(result, links)
    dimensions = {KINDS[0]: FORCE, KINDS[1]: MOMENT}

    def own(values: Floats, kind: Kind) -> Floats:
        return np.asarray(result.units.from_si(values, dimensions[kind]), dtype=np.float64)

    for load in loads:
        if isinstance(load, LinkLoad) and load.link in links:
            vector = np.stack([_amount(analysis, each) for each in load.value], axis=1)
            if load.axes == "link":
                pose = poses[:, links.index(load.link)]
                vector = carried(pose, vector) - pose[:, :3]
            kind = KINDS[0] if load.kind == "force" else KINDS[1]
            place = Attached(load.link, load.point)
            if load.kind == "torque":
                link = mechanism.links.get(load.link)
                place = Attached(load.link, link.center_of_mass if link else load.point)
            yield f"{load.kind} on {load.link}", kind, place, own(vector, kind)
        elif isinstance(load, JointLoad):
            kind = KINDS[1] if is_angle(load.coordinate) else KINDS[0]
            values = own(_amount(analysis, load.amount), kind)
            for one, place, along in _along_joint(analysis, load.name, values):
                yield f"load at {load.name}", one, place, along
        elif isinstance(load, Spring) and load.between is not None:
            if not all(end.link in links for end in load.between):
                continue
            first, second = (
                carried(poses[:, links.index(end.link)], end.vector) for end in load.between
            )
            apart = second - first
            length = np.sqrt((apart * apart).sum(axis=1))
            pull = load.preload + load.stiffness * (length - load.free)
            with np.errstate(invalid="ignore", divide="ignore"):
                force = own(apart * (pull / length)[:, None], KINDS[0])
            is_pull = load in mechanism.pretensions
            word = "pretension" if is_pull else "spring"
            for end, vector in zip(load.between, (force, -force), strict=True):
                # what pulls of one belt do to its carrier is together nothing
                if not (is_pull and end.link in carriers):
                    yield f"{word} on {end.link}", KINDS[0], end, vector
        elif isinstance(load, Bushing) and load.name and not load.damps and load.links[1] in links:
            place = Attached(load.links[1], load.frames[1].o)
            for kind in KINDS:
                name = f"{load.name}.{kind}"
                yield name, kind, place, _in_space(analysis, name)


def _amount(analysis: Readable, amount: Amount) -> Floats:
    """A force or moment over the rows (rows,), in SI."""
    result = analysis.result
    if not isinstance(amount, Varying):
        return np.full(analysis.rows, amount)
    law = result.problem.load_laws[amount.number]
    return np.asarray(law_value(law, result.quantity, analysis.rows), dtype=np.float64)


def _drawable(values: Floats) -> Floats:
    """Values with nan for what grows without bound towards its row, which has no arrow."""
    return np.where(np.isinf(values), np.nan, values)


def _in_space(analysis: Readable, name: str) -> Floats:
    """A vector over the rows (rows, 3); what a plane leaves out of it is zero."""
    components = _drawable(analysis[name])
    vector = np.zeros((len(components), 3))
    places = analysis.result.problem.quantities()[name].places
    vector[:, list(places)] = components.reshape(len(components), len(places))
    return vector


def _known(name: str, kind: Kind, place: Attached, values: Floats) -> Iterator[Arrow]:
    """The arrow without components that are not unique in any row; nothing if none is left, or if
    all are zero."""
    known = np.array([np.isfinite(component).any() for component in values.T])
    values = np.where(known, values, 0.0)
    if not known.any() or not np.nan_to_num(values).any():
        return
    if not known.all():
        axes = ", ".join(axis for axis, is_known in zip(AXES, known, strict=True) if is_known)
        name = f"{name} ({axes})"
    yield name, kind, place, values
