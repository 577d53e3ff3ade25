"""The motion of the inputs over the rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.tape.rows import differ

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.course import Course
    from mechkin_cli.tape.tape import Tape

ORDERS = ("", "_dot", "_ddot", "_dddot")
"""What the names of a coordinate's derivatives end in, from order 0 on."""


class DrivenInput(NamedTuple):
    """One driven coordinate over the rows, in rad, m and s.

    `written_orders` (4, rows) holds values, rates, accelerations and jerks in the file's units, as
    they were written. `follows` says whether it is an expression of other inputs.
    """

    joint: str
    coordinate: str
    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    written_orders: Floats
    follows: bool = False

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"

    @property
    def written(self) -> Floats:
        """Values in the file's units, as written."""
        values: Floats = self.written_orders[0]
        return values

    @property
    def orders(self) -> dict[str, tuple[Floats, Floats]]:
        """In SI and as written, by name: `O1.theta`, `O1.theta_dot`, ..."""
        in_si = (self.values, self.rates, self.accelerations, self.jerks)
        names = (self.name + suffix for suffix in ORDERS)
        return dict(zip(names, zip(in_si, self.written_orders, strict=True), strict=True))


class Moments(NamedTuple):
    """The moments of the rows in s, and as written in the file's units."""

    values: Floats
    written: Floats


class Motion(NamedTuple):
    """All inputs; a mechanism without inputs has one row. `time` is there where the file has it,
    `course` where inputs move by laws or follow others; `ties` are all inputs as functions of each
    one that others follow (`building.course`). `tied` are pairs (input, leader) of inputs of which
    the leader's motor moves both, `tie_rates` (tied, rows) the rates of the first by the second."""

    inputs: tuple[DrivenInput, ...]
    rows: int
    time: Moments | None = None
    course: Course | None = None
    ties: tuple[tuple[str, Tape], ...] = ()
    tied: tuple[tuple[int, int], ...] = ()
    tie_rates: Floats | None = None

    @property
    def driven(self) -> list[tuple[str, str]]:
        """(joint, coordinate) of the inputs."""
        return [(i.joint, i.coordinate) for i in self.inputs]

    @property
    def leading(self) -> DrivenInput | None:
        """The first input that moves over the rows; the first of all if none does."""
        moving = (i for i in self.inputs if differ(i.values))
        return next(moving, self.inputs[0] if self.inputs else None)


@dataclass(frozen=True)
class Assembly:
    """Which assembly is meant at the first row: near some coordinates (rad, m), a mode, or
    neither; `straight`: branch points are passed along the smooth continuation."""

    near: Mapping[str, float] = field(default_factory=dict)
    mode: str | None = None
    turns: int = 1
    straight: bool = False
