"""What acts on the links at one row beside their pairs: loads, gravity and inertia.

Wrenches are (force, moment about the ground origin), in N and N m. Newton and Euler: the inertia
force -m a through the mass centre and the couple -(I alpha + omega x I omega).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.derived import AXES, directions
from mechkin_cli.mechanism import (
    ELEMENTARY,
    GROUND_NAME,
    ZERO,
    Amount,
    Attached,
    Damper,
    Joint,
    JointLoad,
    LinkLoad,
    Load,
    Mechanism,
    RigidLink,
    Spring,
    Tensor,
    Varying,
    Vector,
    Wanted,
    add,
    cross,
    dot,
    law_value,
    norm,
    reference_point,
    scale,
    subtract,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import ACCELERATION, ANGULAR_ACCELERATION, ANGULAR_RATE, LENGTH, VELOCITY

if TYPE_CHECKING:
    from mechkin_cli.sweep import Result


class Wrench(NamedTuple):
    """A force (N), and a moment (N m) about the ground origin."""

    force: Vector = ZERO
    moment: Vector = ZERO

    def plus(self, other: Wrench) -> Wrench:
        """The sum of both."""
        return Wrench(add(self.force, other.force), add(self.moment, other.moment))

    def times(self, factor: float) -> Wrench:
        """A multiple."""
        return Wrench(scale(factor, self.force), scale(factor, self.moment))


def force_at(point: Vector, force: Vector) -> Wrench:
    """A force through a point."""
    return Wrench(force, cross(point, force))


def coordinate_wrench(joint: Joint, coordinate: str, motion: RowMotion) -> Wrench:
    """The unit effort on a coordinate, as it acts on the second link: a force along its line
    through the pair's point, or the couple that works on this turn of the pair alone."""
    known = joint.type.coordinate[coordinate]
    axes = _axes(joint, motion)
    if not known.is_angle:
        return force_at(motion.point(joint.point), axes[known.freedom])
    turns = [number for number, slides in enumerate(joint.type.slides) if not slides]
    if joint.type.is_threaded or len(turns) == 1:
        return Wrench(ZERO, axes[known.freedom])
    others = [axes[number] for number in turns if number != known.freedom]
    return Wrench(ZERO, _working_on(axes[known.freedom], others))


def _axes(joint: Joint, motion: RowMotion) -> list[Vector]:
    """The direction of every freedom of a pair, as it is now."""
    found: list[Vector | None] = []
    for step, part in zip(joint.type.steps, joint.parts, strict=True):
        count = len(ELEMENTARY[step.letter].freedoms)
        if step.between:
            axis = None
        elif step.along is None:
            axis = motion.direction(Attached(joint.first, part.before.z))
        else:
            axis = motion.direction(joint.drawn(step.along))
        found += [axis] * count
    return [_square(found[k - 1], found[k + 1]) if a is None else a for k, a in enumerate(found)]


def _square(before: Vector | None, behind: Vector | None) -> Vector:
    """The axis of a turn that rides on neither link."""
    assert before is not None
    assert behind is not None
    axis = cross(before, behind)
    return scale(1.0 / norm(axis), axis)


def _working_on(axis: Vector, others: Sequence[Vector]) -> Vector:
    """The couple with the power of a unit rate about an axis and none about others."""
    if len(others) == 1:
        couple = subtract(axis, scale(dot(axis, others[0]), others[0]))
    else:
        couple = cross(others[0], others[1])
    return scale(1.0 / dot(couple, axis), couple)


def borne_wrenches(result: Result, motion: RowMotion, row: int) -> dict[str, Wrench]:
    """The sum of loads, gravity and inertia on every moving link at a row (from 0), in SI."""
    mechanism = result.problem.mechanism
    found = {name: Wrench() for name in (GROUND_NAME, *mechanism.links)}
    for name, link in mechanism.links.items():
        if name != GROUND_NAME:
            found[name] = _own(link, motion.links[name], mechanism.gravity)
    acting = _Acting(result, motion, row)
    for load in mechanism.loads:
        for name, wrench in acting.on_links(load):
            found[name] = found[name].plus(wrench)
    return found


def _own(link: RigidLink, motion: RowLinkMotion, gravity: Vector) -> Wrench:
    """Gravity and inertia of a link."""
    centre = motion.point(link.center_of_mass)
    felt = subtract(gravity, motion.acceleration_of(link.center_of_mass))
    omega, alpha = motion.drawn(motion.omega), motion.drawn(motion.alpha)
    gyroscopic = cross(omega, _times(link.inertia, omega))
    couple = motion.direction(add(_times(link.inertia, alpha), gyroscopic))
    return force_at(centre, scale(link.mass, felt)).plus(Wrench(ZERO, scale(-1.0, couple)))


def _times(inertia: Tensor, vector: Vector) -> Vector:
    xx, yy, zz, xy, xz, yz = inertia
    return (dot((xx, xy, xz), vector), dot((xy, yy, yz), vector), dot((xz, yz, zz), vector))


class _Acting:
    """The loads of a result at one row."""

    def __init__(self, result: Result, motion: RowMotion, row: int) -> None:
        self.joints = result.problem.mechanism.joints
        self.motion = motion
        self.result = result
        self.row = row
        laws = result.problem.load_laws
        self.laws: Sequence[float] = [
            float(law_value(law, result.quantity, result.rows)[row]) for law in laws
        ]

    def on_links(self, load: Load) -> Iterator[tuple[str, Wrench]]:
        """What a load exerts, link by link."""
        if isinstance(load, LinkLoad):
            yield load.link, self._on_link(load)
        elif isinstance(load, JointLoad):
            yield from self._on_joint(load.joint, load.coordinate, self._amount(load.value))
        elif load.between is not None:
            yield from self._between(load, load.between)
        else:
            assert load.joint is not None
            assert load.coordinate is not None
            resisting = -self._resistance(load, *self._coordinate(load))
            yield from self._on_joint(load.joint, load.coordinate, resisting)

    def _number(self, name: str) -> float:
        value = self.result.quantity(name).value
        assert isinstance(value, np.ndarray)
        return float(value[self.row])

    def _amount(self, amount: Amount) -> float:
        return self.laws[amount.number] if isinstance(amount, Varying) else amount

    def _on_link(self, load: LinkLoad) -> Wrench:
        link = self.motion.links[load.link]
        x, y, z = (self._amount(amount) for amount in load.value)
        value = link.direction((x, y, z)) if load.axes == "link" else (x, y, z)
        if load.kind == "torque":
            return Wrench(ZERO, value)
        return force_at(link.point(load.point), value)

    def _on_joint(self, name: str, coordinate: str, value: float) -> Iterator[tuple[str, Wrench]]:
        joint = self.joints[name]
        wrench = coordinate_wrench(joint, coordinate, self.motion).times(value)
        yield joint.second, wrench
        yield joint.first, wrench.times(-1.0)

    def _coordinate(self, load: Spring | Damper) -> tuple[float, float]:
        """Value and rate of the coordinate on which a spring or damper acts."""
        name = f"{load.joint}.{load.coordinate}"
        rate = self._number(f"{name}_dot") if isinstance(load, Damper) else 0.0
        return self._number(name), rate

    @staticmethod
    def _resistance(load: Spring | Damper, stretch: float, rate: float) -> float:
        """Force or moment against growing stretch."""
        if isinstance(load, Spring):
            return load.stiffness * (stretch - load.free) + load.preload
        return load.damping * rate

    def _between(
        self, load: Spring | Damper, ends: tuple[Attached, Attached]
    ) -> Iterator[tuple[str, Wrench]]:
        """Pulls both ends towards each other."""
        first, second = (self.motion.point(end) for end in ends)
        line = subtract(second, first)
        length = norm(line)
        along = scale(1.0 / length, line)
        speeds = [self.motion.links[end.link].velocity_of(end.vector) for end in ends]
        rate = dot(along, subtract(speeds[1], speeds[0]))
        pull = scale(self._resistance(load, length, rate), along)
        yield ends[0].link, force_at(first, pull)
        yield ends[1].link, force_at(second, scale(-1.0, pull))


# Where the links are at one row, and how they move: poses, velocities and accelerations in SI.

_ORDERS = (("place", LENGTH), ("velocity", VELOCITY), ("acceleration", ACCELERATION))


class RowLinkMotion(NamedTuple):
    """A link at one row, in ground axes (m, rad, s).

    `axes` are the ground axes as drawn on it; `reference` is a point of it as drawn, which is now
    at `place` and has `velocity` and `acceleration`.
    """

    axes: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    reference: Vector = ZERO
    place: Vector = ZERO
    velocity: Vector = ZERO
    acceleration: Vector = ZERO
    omega: Vector = ZERO
    alpha: Vector = ZERO

    def direction(self, drawn: Vector) -> Vector:
        """Where a direction drawn on the link points now."""
        x, y, z = self.axes
        return add(add(scale(drawn[0], x), scale(drawn[1], y)), scale(drawn[2], z))

    def drawn(self, direction: Vector) -> Vector:
        """A direction of now as drawn on the link."""
        return (
            dot(self.axes[0], direction),
            dot(self.axes[1], direction),
            dot(self.axes[2], direction),
        )

    def point(self, drawn: Vector) -> Vector:
        """Where a point drawn on the link is now."""
        return add(self.place, self._arm(drawn))

    def velocity_of(self, drawn: Vector) -> Vector:
        """Velocity of a point drawn on the link."""
        return add(self.velocity, cross(self.omega, self._arm(drawn)))

    def acceleration_of(self, drawn: Vector) -> Vector:
        """Acceleration of a point drawn on the link: a + alpha x r + omega x (omega x r)."""
        arm = self._arm(drawn)
        turning = add(cross(self.alpha, arm), cross(self.omega, cross(self.omega, arm)))
        return add(self.acceleration, turning)

    def _arm(self, drawn: Vector) -> Vector:
        return self.direction(subtract(drawn, self.reference))


class RowMotion(NamedTuple):
    """All links at one row."""

    links: Mapping[str, RowLinkMotion]

    def point(self, at: Attached) -> Vector:
        """Where a point of a link is."""
        return self.links[at.link].point(at.vector)

    def direction(self, at: Attached) -> Vector:
        """Where a direction of a link points."""
        return self.links[at.link].direction(at.vector)


def row_motion(result: Result, row: int) -> RowMotion:
    """The links of a result at one row, counted from 0."""
    mechanism = result.problem.mechanism
    moving = [name for name in mechanism.links if name != GROUND_NAME]
    wanted = [quantity for name in moving for quantity in _read(name)]
    found = result.evaluated(wanted)

    def vector(name: str) -> Vector:
        x, y, z = (float(component[row]) for component in found[name])
        return (x, y, z)

    motions = {name: _motion(mechanism, name, vector) for name in moving}
    return RowMotion({GROUND_NAME: RowLinkMotion(), **motions})


def _motion(mechanism: Mechanism, name: str, vector: Callable[[str], Vector]) -> RowLinkMotion:
    x, y, z = (vector(f"{name} {axis}") for axis in AXES)
    at = [vector(f"{name} {word}") for word, _ in _ORDERS]
    reference = reference_point(mechanism, name).vector
    turning = (vector(f"{name}.omega"), vector(f"{name}.alpha"))
    return RowLinkMotion((x, y, z), reference, at[0], at[1], at[2], *turning)


def _read(name: str) -> Iterator[Wanted]:
    yield from directions(name)
    for order, (word, dimension) in enumerate(_ORDERS):
        yield Wanted(f"{name} {word}", "link_point", name, dimension, True, order=order)
    yield Wanted(f"{name}.omega", "omega", name, ANGULAR_RATE, True)
    yield Wanted(f"{name}.alpha", "alpha", name, ANGULAR_ACCELERATION, True)
