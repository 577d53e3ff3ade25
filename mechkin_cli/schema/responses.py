"""`responses:` - motions under forces, by name: where they start, what drives and what ends them;
and `equilibria:` - places at which loads balance.

What is free follows from loads and efforts; `motion.inputs` belongs to the sweep and holds nothing
here.
"""

from typing import Annotated, Any, ClassVar, Final, Literal

from mechkin_cli.schema.base import (
    NOTHING,
    FormChoice,
    Limits,
    SchemaName,
    Section,
    Shown,
    by_word,
    refuse,
)
from mechkin_cli.schema.loads import OrTable
from mechkin_cli.schema.motion import LAWS, FollowingInput, Law, TimeSection, law_tag
from mechkin_cli.schema.scalars import (
    START_PATTERN,
    AngleOrLength,
    AnyDimension,
    Coordinate,
    Dimensionless,
    Duration,
    ForceOrTorque,
    Text,
    WholeNumber,
)

StartName = Annotated[
    str,
    Limits(pattern=START_PATTERN),
    Shown(("string",), "a joint coordinate or its rate", ("O1.theta", "O1.theta_dot")),
    SchemaName("StartName"),
]
Effort = Annotated[OrTable[ForceOrTorque], SchemaName("Effort")]


class HeldCoordinate(Section):
    """A coordinate that stays where it is."""

    tag = "(held)"

    at: AngleOrLength
    """The value."""


def _law(mapping: dict[str, Any]) -> str | None:
    if "law" in mapping:
        return law_tag(mapping)
    return "(following)" if "with" in mapping else "(held)"


DrivenLaw = Annotated[HeldCoordinate | FollowingInput | Law, by_word("law", LAWS, _law)]


class ListedTime(Section):
    """The moments of the rows one by one."""

    tag = "(listed)"

    values: Annotated[tuple[Duration, ...], Limits(min_length=2)]
    """Rising moments, of which the first is that of `start`."""


def _spaced_or_listed(value: Any) -> str:
    return "(listed)" if isinstance(value, dict) and "values" in value else "(spaced)"


ResponseTime = Annotated[
    TimeSection | ListedTime, FormChoice(_spaced_or_listed), SchemaName("ResponseTime")
]
_OTHER_STOPS = {
    "contact": "a stop is a value: {value: O2.s, at: 0, direction: down}",
    "time": "the last moment is that of time: {from, to, step}",
    "event": "write value, dead_centre or turns",
    "condition": "write value: an expression, and at: the value at which it ends",
}


class Crossing(Section):
    """Ends the response where a value passes another."""

    tag = "(value)"
    advice: ClassVar[dict[str, str]] = _OTHER_STOPS

    value: AnyDimension
    """An expression of coordinates, rates, positions, velocities, parameters and time."""
    at: AnyDimension | None = None
    """The value at which the response ends, 0 unless given; a bare number is in the file's units. A
    condition such as A.s > 1 m needs none: the response ends where it holds."""
    direction: Literal["up", "down", "any"] = "any"
    """Whether it ends only where the value rises or falls."""
    count: Annotated[WholeNumber, Limits(ge=1, le=1_000_000)] = 1
    """Number of the passage that ends it, counted from 1."""


class DeadCentre(Section):
    """Ends the response at a dead centre of a coordinate: where its rate changes its sign."""

    tag = "(dead_centre)"
    advice: ClassVar[dict[str, str]] = _OTHER_STOPS

    dead_centre: Coordinate
    """The coordinate, for example O4.theta."""
    count: Annotated[WholeNumber, Limits(ge=1, le=1_000_000)] = 1
    """Number of the dead centre that ends it, counted from 1."""


class Turns(Section):
    """Ends the response where an angle has turned by whole turns from its start, to either side."""

    tag = "(turns)"
    advice: ClassVar[dict[str, str]] = _OTHER_STOPS

    turns: Coordinate
    """The angle, for example O1.theta."""
    count: Annotated[WholeNumber, Limits(ge=1, le=1_000_000)] = 1
    """Number of turns."""


def _stop(value: Any) -> str:
    keys = value.keys() if isinstance(value, dict) else ()
    return next((f"({key})" for key in ("dead_centre", "turns") if key in keys), "(value)")


Stop = Annotated[Crossing | DeadCentre | Turns, FormChoice(_stop)]


class Response(Section):
    """A motion under forces: gravity, springs, dampers, loads and efforts move what is free."""

    editors: ClassVar[dict[str, Any]] = {
        "allOf": [
            {"not": {"required": ["near", "mode"]}},
            {"not": {"required": ["tolerance", "fixed_step"]}},
        ]
    }
    advice: ClassVar[dict[str, str]] = {
        "inputs": "coordinates that move by laws stand under driven:",
        "initial": "write start: {O1.theta: 20, O1.theta_dot: 0 rad/s}",
        "loads": "loads stand in the file's loads:, with runs: [NAME] for this response alone",
        "events": "write stop: [{value: O1.theta, at: 45}]",
        "step": "rows stand under time: {from, to, step}, the integrator's own under fixed_step",
        "tables": "tables stand in the file's tables:, with run: NAME",
    }

    start: dict[StartName, AnyDimension] = NOTHING
    """As many independent coordinates as there are free freedoms, by value, and their rates; rates
    left out are zero, and a rate of another coordinate may stand for one of theirs."""
    near: dict[Coordinate, AngleOrLength] = NOTHING
    """Take the assembly nearest to these coordinates; left out, the file's choice."""
    mode: Text | None = None
    """Take the assembly mode of this letter at the start, or the one drawn: `home`; left out, the
    file's choice."""
    efforts: dict[Coordinate, Effort] = NOTHING
    """Force or torque on coordinates: a number, an expression, or a table over the coordinate; they
    add to the loads; left out, none."""
    driven: dict[Coordinate, DrivenLaw] = NOTHING
    """Coordinates whose motion is prescribed: by a law of time, by others (`with`), or held
    (`at`); left out, none."""
    time: ResponseTime
    """The moments of the rows."""
    stop: tuple[Stop, ...] = ()
    """What ends the response before its last moment; left out, nothing."""
    tolerance: Dimensionless | None = None
    """Relative error of a step; left out, 1e-10."""
    fixed_step: Duration | None = None
    """A step of its own for the integrator instead of a tolerance; left out, steps go
    by the tolerance."""

    def check(self) -> None:
        """One of near and mode at most, one of tolerance and fixed_step at most."""
        if self.near and self.mode is not None:
            text = "near and mode both choose the assembly mode"
            raise refuse("two-choices", text, "keep one of them", "mode")
        if self.tolerance is not None and self.fixed_step is not None:
            text = "tolerance and fixed_step both choose the steps"
            raise refuse("two-choices", text, "keep one of them", "fixed_step")


class CoordinateWindow(Section):
    """The values of a coordinate within which equilibria are looked for."""

    tag = "(window)"
    advice: ClassVar[dict[str, str]] = {
        "step": "a window has no rows: write from: and to: alone",
        "min": "write from: for the least value",
        "max": "write to: for the largest value",
    }

    first: AngleOrLength
    """Least value."""
    last: AngleOrLength
    """Largest value."""


class Equilibrium(Section):
    """Places at which all loads balance: one near a start, or all within a window."""

    editors: ClassVar[dict[str, Any]] = {
        "allOf": [
            {"not": {"required": ["near", "window"]}},
            {"not": {"required": ["mode", "window"]}},
        ],
        "dependentRequired": {"starts": ["window"]},
    }
    advice: ClassVar[dict[str, str]] = {
        "start": "where the search starts stands under near: {A.theta: 20}",
        "inputs": "coordinates that are held stand under driven: {A.theta: {at: 20}}",
        "loads": "loads stand in the file's loads:, with runs: [NAME] for these equilibria alone",
        "stop": "only a response has a stop",
        "tables": "tables stand in the file's tables:, with run: NAME",
        "modes": "a window takes all assembly modes; mode: A chooses that of one equilibrium",
    }

    near: dict[Coordinate, AngleOrLength] = NOTHING
    """Where the search for one equilibrium starts: as many independent coordinates as there are
    free freedoms; left out, with the drawing."""
    mode: Text | None = None
    """Start in the assembly mode of this letter, or the one drawn: `home`; left out, the file's
    choice."""
    window: dict[Coordinate, CoordinateWindow] = NOTHING
    """Find all equilibria within these values of as many independent coordinates as there are free
    freedoms, in every assembly mode; left out, one near the start."""
    starts: Annotated[WholeNumber, Limits(ge=1, le=1_000_000)] | None = None
    """Least number of places in the window from which the search starts where several freedoms are
    free; left out, as many as the search needs."""
    driven: dict[Coordinate, HeldCoordinate] = NOTHING
    """Coordinates that are held (`at`); left out, none."""
    efforts: dict[Coordinate, Effort] = NOTHING
    """Force or torque on coordinates: a number, an expression, or a table over the coordinate; they
    add to the loads; left out, none."""
    time: Duration | None = None
    """The moment for which loads that depend on time are taken; left out, 0."""

    def check(self) -> None:
        """One of near and window at most; a window takes every mode and has the starts."""
        if self.near and self.window:
            text = "near asks for one equilibrium, window for all"
            raise refuse("two-choices", text, "keep one of them", "window")
        if self.window and self.mode is not None:
            text = "a window takes the equilibria of every assembly mode"
            raise refuse("two-choices", text, "remove mode, or write near for window", "mode")
        if self.starts is not None and not self.window:
            text = "starts are counted in a window, and there is none"
            raise refuse("starts-without-window", text, "remove starts, or add window", "starts")


EXAMPLES_BY_KEY: Final[dict[str, Any]] = {
    "equilibria": {"ride": {"near": {"A.theta": 20}}},
    "rest": ["B.s"],
    "starts": 200,
    "window": {"A.theta": {"from": -180, "to": 180}},
}
EXAMPLES_OF_EQUILIBRIA: Final[dict[tuple[str, str], Any]] = {
    ("Equilibrium", "time"): "2 s",
    ("Equilibrium", "driven"): {"A.theta": {"at": "30 deg"}},
}
"""Examples of what is written about rest, by key and by section, for editors."""
