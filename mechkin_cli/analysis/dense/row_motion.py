"""Where the links are at one row, and how they move: poses, velocities and accelerations in SI."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.analysis.derived.basis import AXES, directions
from mechkin_cli.mechanism.derived_quantities import reference_point
from mechkin_cli.mechanism.model import GROUND_NAME, Attached, Mechanism
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, cross, dot, scale, subtract
from mechkin_cli.units import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_RATE,
    LENGTH,
    VELOCITY,
)

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result

_ORDERS = (("place", LENGTH), ("velocity", VELOCITY), ("acceleration", ACCELERATION))


class LinkMotion(NamedTuple):
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

    links: Mapping[str, LinkMotion]

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
    return RowMotion({GROUND_NAME: LinkMotion(), **motions})


def _motion(mechanism: Mechanism, name: str, vector: Callable[[str], Vector]) -> LinkMotion:
    x, y, z = (vector(f"{name} {axis}") for axis in AXES)
    at = [vector(f"{name} {word}") for word, _ in _ORDERS]
    reference = reference_point(mechanism, name).vector
    turning = (vector(f"{name}.omega"), vector(f"{name}.alpha"))
    return LinkMotion((x, y, z), reference, at[0], at[1], at[2], *turning)


def _read(name: str) -> Iterator[Wanted]:
    yield from directions(name)
    for order, (word, dimension) in enumerate(_ORDERS):
        yield Wanted(f"{name} {word}", "link_point", name, dimension, True, order=order)
    yield Wanted(f"{name}.omega", "omega", name, ANGULAR_RATE, True)
    yield Wanted(f"{name}.alpha", "alpha", name, ANGULAR_ACCELERATION, True)
