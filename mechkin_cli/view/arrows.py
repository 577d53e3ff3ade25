"""Arrows of forces and moments: every joint's reaction on its second link, and what drives apply.

`J.force` and `J.moment` are what the first link exerts on the second, about the joint's point;
`J.effort` is what a drive applies to the second link, along the joint's axis. Components that are
not unique are left out, and the arrow's name says which are there: `B.force (x, y)`; an arrow of
which nothing is known in any row is not there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.mechanism import is_angle
from mechkin_cli.tables import effort_names
from mechkin_cli.units import FORCE, MOMENT
from mechkin_cli.view.joints import drawn_joints
from mechkin_cli.view.page import packed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Attached, Mechanism, Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Readable
    from mechkin_cli.view.page import Lengths, Plain


Kind = Literal["force", "moment"]
AXES = "xyz"
NORMAL = (0.0, 0.0, 1.0)
KINDS: tuple[Kind, Kind] = ("force", "moment")


Arrow = tuple[str, Kind, "Attached", "Floats"]
"""Name, kind, place on a link, and vectors over the rows (rows, 3) in the file's units."""


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
        for name, kind, place, values in _arrows(analysis)
    ]


def _arrows(analysis: Readable) -> Iterator[Arrow]:
    problem = analysis.result.problem
    joints = problem.mechanism.joints
    for name in reactions(problem):
        joint, _, word = name.rpartition(".")
        kind = KINDS[0] if word == KINDS[0] else KINDS[1]
        yield from _known(name, kind, joints[joint].point, _in_space(analysis, name))
    yield from _efforts(analysis, problem)


def _efforts(analysis: Readable, problem: Problem) -> Iterator[Arrow]:
    driven = [f"{joint}.{coordinate}" for joint, coordinate in problem.acting]
    for name, effort in zip(driven, effort_names(driven), strict=True):
        joint = problem.mechanism.joints[name.rpartition(".")[0]]
        if joint not in drawn_joints(problem.mechanism) or len(joint.coordinates) != 1:
            continue  # the axis of one of several coordinates is not that of the joint
        axis = f"{joint.name}.axis"
        hinged = joint.plane and axis not in problem.quantities()  # about the plane's normal
        direction = np.array([NORMAL]) if hinged else _in_space(analysis, axis)
        along = direction * _drawable(analysis[effort])[:, None]
        kind = KINDS[1] if is_angle(name.rpartition(".")[2]) else KINDS[0]
        yield from _known(effort, kind, joint.point, along)


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
