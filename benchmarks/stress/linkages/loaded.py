"""Forces in R S S R and R S S P whose rod has no mass: it carries a force along itself.

The balance of the follower along what its joint leaves free gives that force; those of the other
joints and the drive's effort follow link by link.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.rssr import Rssr
from benchmarks.stress.linkages.slider import Slider
from benchmarks.stress.linkages.writing import decimals, number, place
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.numbers.vectors import (
    Vector,
    cross,
    dot,
    minus,
    plus,
    times,
    turn,
    unit,
)
from benchmarks.stress.quantity import Force, Quantity, Rows
from benchmarks.stress.reach import Margin


@dataclass(frozen=True)
class Body:
    """Mass (mechanisms, 1) in kg, mass centre as drawn (mechanisms, 3), and moments of inertia
    about the ground's directions there (mechanisms, 3), without products."""

    mass: Rows
    centre: Rows
    inertia: Rows

    def text(self, k: int) -> str:
        """Link k as files write it."""
        moments = zip(("xx", "yy", "zz"), self.inertia[k], strict=True)
        inertia = ", ".join(f"{name}: {number(value)}" for name, value in moments)
        return (
            f"{{mass: {number(self.mass[k, 0])}, center_of_mass: {place(self.centre[k])}, "
            f"inertia: {{{inertia}}}}}"
        )


class Turning(NamedTuple):
    """A body on an axis through a foot: its inertia about the axis, the arm from the foot to its
    mass centre, and the centre's acceleration."""

    inertia: Number
    arm: Vector
    acceleration: Vector


@dataclass(frozen=True)
class Loaded:
    """A linkage with masses of its crank and its follower, and gravity (mechanisms, 3) in m/s^2."""

    linkage: Rssr | Slider
    crank: Body
    follower: Body
    gravity: Rows
    field: Field = DoubleDouble

    def margin(self, angle: Number) -> Margin:
        """That of the linkage."""
        return self.linkage.margin(angle)

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """Those of the linkage."""
        return self.linkage.quantities(angle)

    def size(self) -> Rows:
        """That of the linkage."""
        return self.linkage.size()

    def as_written(self) -> Loaded:
        """The same of the numbers that its files say, in place of their doubles."""
        return replace(self, linkage=self.linkage.as_written(), field=decimals)

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        follower = "rocker" if isinstance(self.linkage, Rssr) else "slider"
        links = {"crank": self.crank.text(k), "rod": "{}", follower: self.follower.text(k)}
        loads = f"loads: [{{type: gravity, g: {place(self.gravity[k])}}}]"
        return self.linkage.text(k, name, degrees, loads, links=links)

    def forces(self, angle: Series) -> tuple[tuple[Force, ...], Rows]:
        """Forces on the second links of all joints and the drive's effort at angles of the crank
        in rad, and the largest of weights and inertia forces in N."""
        a, b = (vector(self.field, p) for p in self.linkage.points[:2])
        axis = unit(vector(self.field, self.linkage.axes[0]))
        gravity = vector(self.field, self.gravity)
        crank = self._turning(self.crank, a, axis, angle)
        arm = _values(turn(axis, angle)(minus(b, a)))
        end = plus(a, arm)
        rod, held, heaviest = self._follower(end, angle, gravity)
        on_crank = _weight(self.field(self.crank.mass), crank.acceleration, gravity)
        torque = dot(cross(crank.arm, gravity), axis) * self.field(self.crank.mass)
        effort = crank.inertia * angle.acceleration - torque + dot(cross(arm, rod), axis)
        found = {"A": plus(on_crank, rod), "B": rod, "C": rod, **held}
        forces = [
            Force(f"{joint}.force", value, k)
            for joint, values in found.items()
            for k, value in enumerate(values)
        ]
        forces.append(Force("A.effort", effort, is_moment=True))
        spin = np.abs((crank.inertia * angle.acceleration).high) / self.size()
        return tuple(forces), heaviest + _length(on_crank) + spin

    def _follower(
        self, end: Vector, angle: Series, gravity: Vector
    ) -> tuple[Vector, dict[str, Vector], Rows]:
        """The rod's force on the follower, that of the follower's joint to ground by its name, and
        the follower's loads."""
        linkage, mass = self.linkage, self.field(self.follower.mass)
        motion = linkage.quantities(angle)[0].value
        c, way = vector(self.field, linkage.points[2]), unit(vector(self.field, linkage.axes[1]))
        if isinstance(linkage, Slider):
            along = unit(minus(plus(c, times(motion.value, way)), end))
            load = _weight(mass, times(motion.acceleration, way), gravity)
            rod = times(dot(load, way) / dot(along, way), along)
            return rod, {"P": minus(load, rod)}, _length(load)
        d = vector(self.field, linkage.points[3])
        rocker = self._turning(self.follower, d, way, motion)
        arm = _values(turn(way, motion)(minus(c, d)))
        along = unit(minus(plus(d, arm), end))
        spin = rocker.inertia * motion.acceleration
        torque = spin - dot(cross(rocker.arm, gravity), way) * mass
        rod = times(torque / dot(cross(arm, along), way), along)
        load = _weight(mass, rocker.acceleration, gravity)
        heaviest = _length(load) + np.abs(spin.high) / self.size()
        return rod, {"D": minus(load, rod)}, heaviest

    def _turning(self, body: Body, foot: Vector, axis: Vector, angle: Series) -> Turning:
        arm = minus(vector(self.field, body.centre), foot)
        moved = turn(axis, angle)(arm)
        across = cross(axis, arm)
        own = vector(self.field, body.inertia)
        about = dot((axis[0] * axis[0], axis[1] * axis[1], axis[2] * axis[2]), own)
        inertia = about + self.field(body.mass) * dot(across, across)
        x, y, z = (component.acceleration for component in moved)
        return Turning(inertia, _values(moved), (x, y, z))


def _values(moved: Vector) -> Vector:
    x, y, z = (component.value for component in moved)
    return x, y, z


def _weight(mass: Number, acceleration: Vector, gravity: Vector) -> Vector:
    """The force that a mass wants from its joints."""
    return times(mass, minus(acceleration, gravity))


def _length(force: Vector) -> Rows:
    length: Rows = dot(force, force).sqrt().high
    return length
