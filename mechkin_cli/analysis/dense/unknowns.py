"""The unknowns and conditions with which each pair enters the dense system.

As the dissertation on successive screws writes them (sections 3.4 to 3.14): a pair on one axis A
has a force F and a moment M about the origin with F.A = 0 and (M - O x F).A = 0; what it can take
along the axis, FA, or about it, MA, stands apart; a screw takes FA with MA = -p FA. A ball has
three forces through its centre. Any other pair has six components, and a condition for each of its
freedoms.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.analysis.dense.loads import Wrench, coordinate_wrench, force_at
from mechkin_cli.mechanism.model import Attached, Joint
from mechkin_cli.mechanism.vectors import ZERO, Vector, cross, scale
from mechkin_cli.units import FORCE, MOMENT, Dimension

if TYPE_CHECKING:
    from mechkin_cli.analysis.dense.row_motion import RowMotion

UNIT_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_XYZ = "xyz"


class Unknown(NamedTuple):
    """One component: what it exerts on the second link of its joint per unit, in SI.

    `rank` orders the unknowns as the source does: forces, moments, what stands apart, efforts.
    """

    name: str
    joint: str
    dimension: Dimension
    wrench: Wrench
    rank: int


class Condition(NamedTuple):
    """A sum of a joint's force and moment components (per unknown of F and M) that vanishes."""

    name: str
    joint: str
    dimension: Dimension
    force: Vector
    moment: Vector

    def coefficient(self, wrench: Wrench) -> float:
        """The factor of an unknown."""
        parts = zip((*self.force, *self.moment), (*wrench.force, *wrench.moment), strict=True)
        total = 0.0
        for weight, component in parts:
            total += weight * component
        return total


class Pair(NamedTuple):
    """What one pair brings."""

    unknowns: tuple[Unknown, ...]
    conditions: tuple[Condition, ...]


Along = tuple[tuple[str, Attached], tuple[str, Attached]]
"""Two named directions of the forces of a ball; the third is their cross product."""


def pair_terms(joint: Joint, motion: RowMotion, along: Mapping[str, Along]) -> Pair:
    """Unknowns and conditions of a pair; `along` by the names of balls."""
    if joint.type.is_free:
        return Pair((), ())
    if joint.type.is_guide:
        return _guide(joint, motion)
    if joint.type.is_oriented:
        return _ball(joint, motion, along.get(joint.name))
    slides = [_no_force(joint, motion.direction(at), n) for n, at in _named(joint.free_slides)]
    turns = [_no_moment(joint, motion, at, n) for n, at in _named(joint.free_turns or ())]
    return Pair((*_components(joint),), (*slides, *turns))


def effort(joint: Joint, coordinate: str, motion: RowMotion, word: str) -> Unknown:
    """What the drive of a coordinate exerts; `word` names it."""
    known = joint.type.coordinate[coordinate]
    dimension = MOMENT if known.is_angle else FORCE
    wrench = coordinate_wrench(joint, coordinate, motion)
    return Unknown(f"{joint.name}.{coordinate}.{word}", joint.name, dimension, wrench, 4)


def _guide(joint: Joint, motion: RowMotion) -> Pair:
    axis, point = motion.direction(joint.axis), motion.point(joint.point)
    conditions = (
        _no_force(joint, axis, ""),
        Condition(
            f"{joint.name}: no moment in M about the axis",
            joint.name,
            MOMENT,
            scale(-1.0, cross(axis, point)),
            axis,
        ),
    )
    free = joint.type.free
    apart = []
    if joint.type.is_threaded:
        thread = force_at(point, axis).plus(Wrench(ZERO, scale(-joint.pitch, axis)))
        apart.append(Unknown(f"{joint.name}.FA", joint.name, FORCE, thread, 2))
    else:
        if not free["slide"]:
            force = force_at(point, axis)
            apart.append(Unknown(f"{joint.name}.FA", joint.name, FORCE, force, 2))
        if not free["turn"]:
            apart.append(Unknown(f"{joint.name}.MA", joint.name, MOMENT, Wrench(ZERO, axis), 2))
    return Pair((*_components(joint), *apart), conditions)


def _ball(joint: Joint, motion: RowMotion, along: Along | None) -> Pair:
    point = motion.point(joint.point)
    directions: Sequence[Vector] = UNIT_AXES
    names: Sequence[str] = _XYZ
    if along is not None:
        one, two = (motion.direction(at) for _, at in along)
        directions = (one, two, cross(one, two))
        first, second = (name for name, _ in along)
        names = (f" {first}", f" {second}", f" {first} x {second}")
    forces = tuple(
        Unknown(f"{joint.name}.F{name}", joint.name, FORCE, force_at(point, direction), 3)
        for name, direction in zip(names, directions, strict=True)
    )
    slides = [_no_force(joint, motion.direction(at), n) for n, at in _named(joint.free_slides)]
    return Pair(forces, (*slides,))


def _components(joint: Joint) -> Iterator[Unknown]:
    for letter, axis in zip(_XYZ, UNIT_AXES, strict=True):
        yield Unknown(f"{joint.name}.F{letter}", joint.name, FORCE, Wrench(axis, ZERO), 0)
    for letter, axis in zip(_XYZ, UNIT_AXES, strict=True):
        yield Unknown(f"{joint.name}.M{letter}", joint.name, MOMENT, Wrench(ZERO, axis), 1)


def _named(free: Sequence[Attached]) -> Iterator[tuple[str, Attached]]:
    """Directions with a number where there are several."""
    for number, at in enumerate(free, start=1):
        yield (f" {number}" if len(free) > 1 else ""), at


def _no_force(joint: Joint, axis: Vector, number: str) -> Condition:
    where = "along the axis" if joint.type.is_guide else f"along slide{number}"
    return Condition(f"{joint.name}: no force in F {where}", joint.name, FORCE, axis, ZERO)


def _no_moment(joint: Joint, motion: RowMotion, at: Attached, number: str) -> Condition:
    axis, point = motion.direction(at), motion.point(joint.point)
    name = f"{joint.name}: no moment in M about turn{number}"
    return Condition(name, joint.name, MOMENT, scale(-1.0, cross(axis, point)), axis)
