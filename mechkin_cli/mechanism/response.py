"""A response: what one motion under forces asks for, in SI and checked; and equilibria, which are
looked for among the places at which a response could start.

At its first moment the mechanism is assembled with the start's coordinates and the driven ones at
their values; from there on loads and efforts move what is not driven, up to a stop or the last
moment.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.diagnostics import Place
from mechkin_cli.expressions import Expression, parse
from mechkin_cli.mechanism.curve import LoadLaw
from mechkin_cli.mechanism.motion import ORDERS, DrivenInput, Moments, MotionInputs
from mechkin_cli.mechanism.pairs import dimension_of
from mechkin_cli.mechanism.quantities import resting_quantities
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.mechanism.held import LockedFreedom
    from mechkin_cli.mechanism.model import JointLoad, Mechanism
    from mechkin_cli.mechanism.motion import Assembly, Course, Limit
    from mechkin_cli.mechanism.pair_type import Rubbing
    from mechkin_cli.mechanism.wanted import Wanted
    from mechkin_cli.units import Dimension, UnitSystem


Direction = Literal["up", "down", "any"]


class StartValue(NamedTuple):
    """A coordinate at the first moment: its value (rad, m) where it is one of the independent ones,
    and its rate (rad/s, m/s) where that is one of the rates given; None for what follows."""

    joint: str
    coordinate: str
    value: float | None
    rate: float | None

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"


@dataclass(frozen=True)
class CrossingEnd:
    """Ends a response where the value of `law` passes `at` (SI) the `count`th time, rising (`up`),
    falling or either; without `at`, where the condition `law` holds the `count`th time.

    `words` are what a row says of it: `O1.theta = 45 deg`. `limit`: that of a coordinate, where it
    is one.
    """

    words: str
    place: Place
    law: LoadLaw
    dimension: Dimension
    at: float | None
    direction: Direction
    count: int
    limit: Limit | None = None


@dataclass(frozen=True)
class DeadCentreEnd:
    """Ends a response at the dead centre number `count` of a coordinate, where its rate changes its
    sign."""

    words: str
    place: Place
    joint: str
    coordinate: str
    count: int


@dataclass(frozen=True)
class TurnsEnd:
    """Ends a response where an angle lies `count` turns from its start, to either side."""

    words: str
    place: Place
    joint: str
    coordinate: str
    count: int


@dataclass(frozen=True)
class SlopeEnd:
    """Ends a response where the slope of a function of a coordinate jumps, at `at` (rad, m), `by`
    some amount: rates jump with it. `owner` is the coupling or joint of the function."""

    words: str
    place: Place
    joint: str
    coordinate: str
    at: float
    owner: str
    by: str


Stop = CrossingEnd | DeadCentreEnd | TurnsEnd | SlopeEnd


class EquilibriumSearch(NamedTuple):
    """Where equilibria are looked for: within a `window` (rad, m) of each independent coordinate,
    all of them, from at least so many `starts` where several are free; without a window near the
    start, one."""

    window: tuple[Limit, ...] = ()
    starts: int = 0


DrivenRows = Callable[[int, int], "tuple[DrivenInput, ...]"]
"""Gives driven coordinates in rows from one to another, which is not among them."""


@dataclass(frozen=True, eq=False)
class ResponseProblem:
    """One of the file's responses, or of its equilibria: these have a `search`, and no stops, and
    all their rows are at one moment.

    Attributes:
        name: of the run.
        place: where the file says it.
        start: coordinates and rates at the first moment; those with a value are the independent
            coordinates there, and as many have a rate.
        assembly: which assembly is meant at the first moment.
        efforts: as given, their laws by the numbers of the response's; they stand among the
            mechanism's loads, too.
        driven: coordinates that move by laws, with their orders at all moments, or at some of very
            many, the first and the last among them; see `driven_in`.
        course: the driven coordinates between the moments, over the time in the file's units; None
            where nothing is driven.
        moments: of the rows.
        stops: what ends the response.
        tolerance: relative error of a step.
        fixed_step: in s, instead of a tolerance.
        mechanism: with the loads of this run alone, its efforts the last of them.
        load_laws: of the loads of this run.
        held: what holds its idle freedoms.
        search: of equilibria; None of a motion.
        driven_rows: gives them at the moments of rows from one to another, which is not among them;
            None where `driven` has all.
        frictions: without which loads balance at equilibria, and which hold the mechanism in an
            interval about each.
    """

    name: str
    place: Place
    start: tuple[StartValue, ...]
    assembly: Assembly
    efforts: tuple[JointLoad, ...]
    driven: tuple[DrivenInput, ...]
    course: Course | None
    moments: Moments
    stops: tuple[Stop, ...]
    tolerance: float
    fixed_step: float | None
    mechanism: Mechanism
    load_laws: tuple[LoadLaw, ...]
    held: tuple[LockedFreedom, ...] = ()
    search: EquilibriumSearch | None = None
    frictions: tuple[Rubbing, ...] = ()
    driven_rows: DrivenRows | None = None

    def driven_in(self, first: int, end: int) -> tuple[DrivenInput, ...]:
        """The driven coordinates at the moments of rows [first, end).

        Raises:
            InvalidFile: a law is not defined at one of them.
        """
        if self.driven_rows is not None and first < end:
            return self.driven_rows(first, end)
        return tuple(item.part(slice(first, end)) for item in self.driven)

    @property
    def section(self) -> str:
        """The section of the file that it stands in."""
        return "responses" if self.search is None else "equilibria"

    @property
    def named(self) -> str:
        """The key under which its independent coordinates stand."""
        if self.search is None:
            return "start"
        return "window" if self.search.window else "near"

    @property
    def rows(self) -> int:
        """Number of rows asked for."""
        return self.moments.rows

    @property
    def independent(self) -> list[tuple[str, str]]:
        """(joint, coordinate) of the start's values."""
        return [(one.joint, one.coordinate) for one in self.start if one.value is not None]

    @property
    def rubs_at_rest(self) -> bool:
        """Whether friction holds the mechanism in an interval of its one coordinate."""
        return bool(self.frictions) and len(self.independent) == 1

    @property
    def resting(self) -> dict[str, Wanted]:
        """What rows of equilibria have beside others, by name."""
        coordinates = [name for _, name in self.independent]
        return resting_quantities(coordinates, rubs=self.rubs_at_rest)

    @property
    def driven_at(self) -> list[tuple[str, str]]:
        """(joint, coordinate) of what is driven."""
        return [(item.joint, item.coordinate) for item in self.driven]

    @cached_property
    def watched(self) -> tuple[LoadLaw, ...]:
        """What the stops watch, one value each, in SI."""
        return tuple(_watched(stop) for stop in self.stops)

    @property
    def efforts_of(self) -> list[tuple[str, str]]:
        """(joint, coordinate) whose effort is told: those with efforts, then the driven ones, then
        those that limits push."""
        given = [one.acts_at for one in self.efforts]
        return list(dict.fromkeys([*given, *self.driven_at, *self.rebounding]))

    @cached_property
    def rebounding(self) -> tuple[tuple[str, str], ...]:
        """(joint, coordinate) that nothing drives and that have limits with a restitution."""
        ends = (stop.limit for stop in self.stops if isinstance(stop, CrossingEnd))
        found = [(end.joint, end.coordinate) for end in ends if end and end.restitution is not None]
        return tuple(at for at in dict.fromkeys(found) if at not in self.driven_at)


def _watched(stop: Stop) -> LoadLaw:
    if isinstance(stop, CrossingEnd):
        return stop.law

    name = f"{stop.joint}.{stop.coordinate}"
    if isinstance(stop, DeadCentreEnd):
        name += ORDERS[1]
    return LoadLaw((name,), stop.place, parse(name))


def first_motion(response: ResponseProblem, units: UnitSystem) -> MotionInputs:
    """The first moment as a motion of one row: the start's coordinates, then the driven ones.

    A start's coordinate without a rate of its own stands there with rate 0; accelerations are those
    of laws, and 0 of what is free.
    """
    still = [_started(one, units) for one in response.start if one.value is not None]
    moving = [_at_first(item) for item in response.driven]
    return MotionInputs((*still, *moving), 1, response.moments.part(slice(1)))


def _started(one: StartValue, units: UnitSystem) -> DrivenInput:
    first = [0.0 if number is None else number for number in (one.value, one.rate)]
    orders = np.array([[number] for number in (*first, 0.0, 0.0)])
    dimension = dimension_of(one.coordinate)
    written = []
    for order in orders:
        written.append(units.from_si(order.copy(), dimension))
        dimension /= TIME
    value, rate, acceleration, jerk = orders
    return DrivenInput(
        one.joint, one.coordinate, value, rate, acceleration, jerk, np.array(written)
    )


def _at_first(item: DrivenInput) -> DrivenInput:
    return item.part(slice(1))._replace(follows=False)


# Balances of the sweep over a cycle: what a file asks for, checked.


class Cycle(NamedTuple):
    """The rows from the first to the last, which repeats it, at equal distances of `name`: an
    input, number `number`, that turns `turns` times, or `time` (number None)."""

    name: str
    number: int | None
    turns: int
    step: float
    """From row to row, in rad or s."""
    first: float
    """At the first row, in rad or s."""


@dataclass(frozen=True)
class Balance:
    """One balance; `name` is the stem of its files, `place` where the file says it."""

    name: str
    title: str
    place: Place
    cycle: Cycle


@dataclass(frozen=True)
class LoadWork(Balance):
    """Work of every effort and load."""


@dataclass(frozen=True)
class Harmonics(Balance):
    """Fourier coefficients of some expressions, of `orders` times the turn of the input, or of the
    whole of time."""

    of: tuple[tuple[str, Expression], ...]
    orders: tuple[float, ...]


@dataclass(frozen=True)
class Flywheel(Balance):
    """The flywheel for an unevenness at a mean rate (rad/s); None: the input's in the rows."""

    unevenness: float
    rate: float


AnyBalance = LoadWork | Harmonics | Flywheel
