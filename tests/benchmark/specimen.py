"""A mechanism that is measured: its file, how it is driven, what is asked of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

ORDERS = ("", "_dot", "_ddot")
Names = tuple[str, ...]


@dataclass(frozen=True)
class Specimen:
    """A mechanism of the benchmark.

    Args:
        name: as the tables show it.
        text: the mechanism file for a motion of the input.
        driven: the one input, an angle.
        coordinates: the coordinates that are solved for.
        loads: the effort, and force and moment of every joint.
        rate, acceleration: of the input, rad/s and rad/s^2.
        span: the sweep, degrees.
    """

    name: str
    text: Callable[[str], str]
    driven: str
    coordinates: Names
    loads: Names
    rate: float
    acceleration: float
    span: tuple[float, float]

    @property
    def motion(self) -> tuple[Names, Names, Names]:
        """Names of the coordinates, of their rates and of their accelerations."""
        position, velocity, acceleration = (
            tuple(f"{name}{order}" for name in self.coordinates) for order in ORDERS
        )
        return position, velocity, acceleration

    @property
    def levels(self) -> tuple[Names, Names, Names]:
        """Quantities of three levels: positions; with their derivatives; everything."""
        position, velocity, acceleration = self.motion
        moving = (*position, *velocity, *acceleration)
        return position, moving, (*moving, *self.loads)


def values(radians: Sequence[float]) -> str:
    """The motion through some values of the input."""
    return f"values: [{', '.join(repr(float(x)) for x in radians)}]"
