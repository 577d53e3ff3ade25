"""What acts on the links at one row beside their pairs, and how the links move there, in SI.

Loads, gravity and inertia (`borne_wrenches`): wrenches are (force, moment about the ground origin),
in N and N m. Newton and Euler: the inertia force -m a through the mass centre and the couple
-(I alpha + omega x I omega). Poses, velocities and accelerations are those of `row_motion`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.derived import AXES, directions
from mechkin_cli.kernel.functions import atan2, tan
from mechkin_cli.mechanism import (
    ELEMENTARY,
    GROUND,
    GROUND_NAME,
    UPPER_HALF,
    ZERO,
    Amount,
    Attached,
    Bushing,
    Damper,
    Frame,
    Joint,
    JointLoad,
    LinkLoad,
    Load,
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
    upright,
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
    """The direction of every freedom of a pair, as it is now; a turn that rides on neither link is
    square to those before and behind it."""
    known: list[Vector | None] = []
    for step, part in zip(joint.type.steps, joint.parts, strict=True):
        count = len(ELEMENTARY[step.letter].freedoms)
        if step.between:
            axis = None
        elif step.along is None:
            axis = motion.direction(Attached(joint.first, part.before.z))
        else:
            axis = motion.direction(joint.drawn(step.along))
        known += [axis] * count
    axes = []
    for k, axis in enumerate(known):
        if axis is None:
            before, behind = known[k - 1], known[k + 1]
            assert before is not None
            assert behind is not None
            square = cross(before, behind)
            axis = scale(1.0 / norm(square), square)
        axes.append(axis)
    return axes


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
    wrenches = {name: Wrench() for name in (GROUND_NAME, *mechanism.links)}
    for name, link in mechanism.links.items():
        if name != GROUND_NAME:
            wrenches[name] = _gravity_and_inertia(link, motion[name], mechanism.gravity)
    acting = _Acting(result, motion, row)
    for load in mechanism.loads:
        for name, wrench in acting.on_links(load):
            wrenches[name] = wrenches[name].plus(wrench)
    return wrenches


def _gravity_and_inertia(link: RigidLink, motion: RowLinkMotion, gravity: Vector) -> Wrench:
    centre = motion.point(link.center_of_mass)
    felt = subtract(gravity, motion.acceleration_of(link.center_of_mass))
    omega, alpha = (motion.frame.components(a) for a in (motion.omega, motion.alpha))
    gyroscopic = cross(omega, _times(link.inertia, omega))
    couple = motion.frame.vector(add(_times(link.inertia, alpha), gyroscopic))
    return force_at(centre, scale(link.mass, felt)).plus(Wrench(ZERO, scale(-1.0, couple)))


def _times(inertia: Tensor, vector: Vector) -> Vector:
    xx, yy, zz, xy, xz, yz = inertia
    return (dot((xx, xy, xz), vector), dot((xy, yy, yz), vector), dot((xz, yz, zz), vector))


class _Acting:
    """The loads of a result at one row."""

    def __init__(self, result: Result, motion: RowMotion, row: int) -> None:
        self.joints = result.problem.mechanism.joints
        self.result, self.motion, self.row = result, motion, row
        laws = result.problem.load_laws
        self.laws: Sequence[float] = [
            float(law_value(law, result.quantity, result.rows)[row]) for law in laws
        ]

    def on_links(self, load: Load) -> Iterator[tuple[str, Wrench]]:
        """The wrenches of a load, link by link."""
        if isinstance(load, LinkLoad):
            yield load.link, self._on_link(load)
        elif isinstance(load, JointLoad):
            yield from self._on_joint(load.joint, load.coordinate, self._amount(load.amount))
        elif isinstance(load, Bushing):
            yield from self._bushing(load)
        elif load.between is not None:
            yield from self._between(load, load.between)
        else:
            assert load.joint is not None
            assert load.coordinate is not None
            name = f"{load.joint}.{load.coordinate}"
            rate = self._number(f"{name}_dot") if isinstance(load, Damper) else 0.0
            resisting = -self._resistance(load, self._number(name), rate)
            yield from self._on_joint(load.joint, load.coordinate, resisting)

    def _number(self, name: str) -> float:
        value = self.result.quantity(name).value
        assert isinstance(value, np.ndarray)
        return float(value[self.row])

    def _amount(self, amount: Amount) -> float:
        return self.laws[amount.number] if isinstance(amount, Varying) else amount

    def _on_link(self, load: LinkLoad) -> Wrench:
        link = self.motion[load.link]
        x, y, z = (self._amount(amount) for amount in load.value)
        value = link.frame.vector((x, y, z)) if load.axes == "link" else (x, y, z)
        if load.kind == "torque":
            return Wrench(ZERO, value)
        return force_at(link.point(load.point), value)

    def _on_joint(self, name: str, coordinate: str, value: float) -> Iterator[tuple[str, Wrench]]:
        joint = self.joints[name]
        wrench = coordinate_wrench(joint, coordinate, self.motion).times(value)
        yield joint.second, wrench
        yield joint.first, wrench.times(-1.0)

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
        speeds = [self.motion[end.link].velocity_of(end.vector) for end in ends]
        rate = dot(along, subtract(speeds[1], speeds[0]))
        pull = scale(self._resistance(load, length, rate), along)
        yield ends[0].link, force_at(first, pull)
        yield ends[1].link, force_at(second, scale(-1.0, pull))

    def _bushing(self, load: Bushing) -> Iterator[tuple[str, Wrench]]:
        """Resists its deflection, or its rate: by the gradient of its energy, see
        kernel/core/forces/bushings.hpp."""
        first, second = (self.motion[name] for name in load.links)
        one, other = load.frames
        x, y, z = (first.frame.vector(axis) for axis in (one.x, one.y, one.z))
        axes = Frame(x, y, z, first.point(one.o))
        own = [axes.components(second.frame.vector(a)) for a in (other.x, other.y, other.z)]
        at = second.point(other.o)
        turn, cotangent = _rotation_vector(*own)
        if load.damps:
            relative = subtract(second.velocity_of(other.o), first.velocity_at(at))
            omega = axes.components(subtract(second.omega, first.omega))
            stretch = [*axes.components(relative), *omega]
        else:
            deflection = (*axes.local(at), *turn)
            stretch = [e - f for e, f in zip(deflection, load.free, strict=True)]
        by = [0.0] * 6
        for (i, k), entry in zip(UPPER_HALF, load.matrix, strict=True):
            by[i] += entry * stretch[k]
            by[k] += entry * stretch[i] if i != k else 0.0
        force, couple = (by[0], by[1], by[2]), (by[3], by[4], by[5])
        if not load.damps:
            across = cross(turn, couple)
            couple = add(couple, add(scale(0.5, across), scale(cotangent, cross(turn, across))))
        pull = force_at(at, scale(-1.0, axes.vector(force)))
        wrench = pull.plus(Wrench(ZERO, scale(-1.0, axes.vector(couple))))
        yield load.links[1], wrench
        yield load.links[0], wrench.times(-1.0)


def _rotation_vector(x: Vector, y: Vector, z: Vector) -> tuple[Vector, float]:
    """The rotation vector of a frame with these axes, and (1 - t/2 cot(t/2)) / t^2 for its turn."""
    skew = (y[2] - z[1], z[0] - x[2], x[1] - y[0])
    twice_sine, twice_cosine = norm(skew), x[0] + y[1] + z[2] - 1.0
    if twice_sine == 0.0:
        return ZERO, 1.0 / 12.0
    angle = atan2(twice_sine, twice_cosine)
    half = 0.5 * angle
    return scale(angle / twice_sine, skew), (1.0 - half / tan(half)) / (angle * angle)


_ORDERS = (("place", LENGTH), ("velocity", VELOCITY), ("acceleration", ACCELERATION))


class RowLinkMotion(NamedTuple):
    """A link at one row, in ground axes (m, rad, s).

    `reference` is a point of it as drawn, from the mechanism's datum, which is now at the origin of
    `frame`, whose axes are the ground axes as drawn on the link, and has `velocity` and
    `acceleration`.
    """

    frame: Frame = GROUND
    reference: Vector = ZERO
    velocity: Vector = ZERO
    acceleration: Vector = ZERO
    omega: Vector = ZERO
    alpha: Vector = ZERO

    def point(self, drawn: Vector) -> Vector:
        """Where a point drawn on the link is now."""
        return add(self.frame.o, self._arm(drawn))

    def velocity_of(self, drawn: Vector) -> Vector:
        """Velocity of a point drawn on the link."""
        return add(self.velocity, cross(self.omega, self._arm(drawn)))

    def velocity_at(self, place: Vector) -> Vector:
        """Velocity of the point of the link that is now at a place."""
        return add(self.velocity, cross(self.omega, subtract(place, self.frame.o)))

    def acceleration_of(self, drawn: Vector) -> Vector:
        """Acceleration of a point drawn on the link: a + alpha x r + omega x (omega x r)."""
        arm = self._arm(drawn)
        turning = add(cross(self.alpha, arm), cross(self.omega, cross(self.omega, arm)))
        return add(self.acceleration, turning)

    def _arm(self, drawn: Vector) -> Vector:
        return self.frame.vector(subtract(drawn, self.reference))


class RowMotion(dict[str, RowLinkMotion]):
    """All links at one row, by name."""

    def point(self, at: Attached) -> Vector:
        """Where a point of a link is."""
        return self[at.link].point(at.vector)

    def direction(self, at: Attached) -> Vector:
        """Where a direction of a link points."""
        return self[at.link].frame.vector(at.vector)


def row_motion(result: Result, row: int) -> RowMotion:
    """The links of a result at one row, counted from 0."""
    mechanism = result.problem.mechanism
    moving = [name for name in mechanism.links if name != GROUND_NAME]
    wanted = [quantity for name in moving for quantity in _read(name)]
    columns = result.evaluated(wanted)

    def vector(name: str) -> Vector:
        x, y, z = (float(component[row]) for component in columns[name])
        return (x, y, z)

    motion = RowMotion({GROUND_NAME: RowLinkMotion(upright(mechanism.datum))})
    for name in moving:
        x, y, z = (vector(f"{name} {axis}") for axis in AXES)
        place, velocity, acceleration = (vector(f"{name} {word}") for word, _ in _ORDERS)
        turning = (vector(f"{name}.omega"), vector(f"{name}.alpha"))
        reference = reference_point(mechanism, name).vector
        frame = Frame(x, y, z, place)
        motion[name] = RowLinkMotion(frame, reference, velocity, acceleration, *turning)
    return motion


def _read(name: str) -> Iterator[Wanted]:
    yield from directions(name)
    for order, (word, dimension) in enumerate(_ORDERS):
        yield Wanted(f"{name} {word}", "link_point", name, dimension, True, order=order)
    yield Wanted(f"{name}.omega", "omega", name, ANGULAR_RATE, True)
    yield Wanted(f"{name}.alpha", "alpha", name, ANGULAR_ACCELERATION, True)
