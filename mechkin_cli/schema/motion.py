"""`motion:` - which coordinates are driven, and through which values; `assembly:` - the first row.

Rows of a sweep: n = floor(|to - from|/|step| + 1e-9) + 1, x_i = from + i*step. One input is swept;
others are held (`at`), follow (`with`) or run in step through equally many values. With `grid` two
inputs run through all pairs of their values. Or the rows are moments of `time`, and inputs move by
laws.
"""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal

from mechkin_cli.schema.base import (
    NOTHING,
    Limits,
    Section,
    Spaced,
    by_word,
    refuse,
)
from mechkin_cli.schema.scalars import (
    Angle,
    AngleOrLength,
    AnyDimension,
    Coordinate,
    CoordinateAcceleration,
    CoordinateJerk,
    CoordinateRate,
    CsvPath,
    Duration,
    Flag,
    JoinedTable,
    Text,
    WholeNumber,
)


class ConstantRate(Section):
    """x = at + rate*t, with t from the first moment of `time`."""

    law: Literal["constant-rate"]
    at: AngleOrLength
    """Value at the first moment."""
    rate: CoordinateRate
    """Constant rate."""


class ConstantAcceleration(Section):
    """x = at + rate*t + acceleration*t^2/2, with t from the first moment of `time`."""

    law: Literal["constant-acceleration"]
    at: AngleOrLength
    """Value at the first moment."""
    rate: CoordinateRate = "0"
    """Rate at the first moment."""
    acceleration: CoordinateAcceleration
    """Constant acceleration."""


class Polynomial(Section):
    """x = c0 + c1*t + c2*t^2 + ..., with t from the first moment of `time`."""

    law: Literal["polynomial"]
    coefficients: Annotated[tuple[AnyDimension, ...], Limits(min_length=1, max_length=20)]
    """c0, c1, c2, ... of x = c0 + c1*t + c2*t^2 + ..., with t counted from the first moment of
    `time`, where x is c0; the k-th has the coordinate's dimension per time^k. Those of an angle
    carry units from c1 on, unless the file's angular rates are in its angle per its time."""


class ExpressionLaw(Section):
    """x as an expression of `time`; its rates are exact."""

    advice: ClassVar[dict[str, str]] = dict.fromkeys(
        ("expression", "formula", "function", "x", "f", "of"), "write value: 20 mm*time/(1 s)"
    )

    law: Literal["expression"]
    value: AnyDimension
    """The value as an expression of `time` and parameters: `20 deg*sin(360 deg*time/(1 s))`."""


class Rise(Section):
    """x = from + (to - from) * s(u), with u from 0 to 1 over the duration and s as the law says."""

    advice: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("begin", "t0", "delay"), "write start: 0.1 s"),
        **dict.fromkeys(("end", "stop", "for", "time", "beta"), "write duration: 0.5 s"),
        **dict.fromkeys(("rise", "lift", "height", "h", "stroke"), "write from: 0, to: 20 mm"),
    }

    if TYPE_CHECKING:
        law: str
    start: Duration | None = None
    """When the rise begins, as `time` counts; left out, at the first moment of `time`. Before it
    the input rests."""
    duration: Duration | None = None
    """How long it lasts; left out, to the last moment of `time`. After it the input rests."""
    first: AngleOrLength
    """Value before the rise."""
    last: AngleOrLength
    """Value after the rise."""


class Harmonic(Rise):
    """x = from + (to - from) * (1 - cos(pi*u))/2, with u from 0 to 1 over the duration."""

    law: Literal["harmonic"]


class Cycloidal(Rise):
    """x = from + (to - from) * (u - sin(2*pi*u)/(2*pi)), with u from 0 to 1 over the duration."""

    law: Literal["cycloidal"]


class Rise345(Rise):
    """x = from + (to - from) * (10*u^3 - 15*u^4 + 6*u^5), with u from 0 to 1 over the duration."""

    law: Literal["3-4-5"]


class Rise4567(Rise):
    """x = from + (to - from) * (35*u^4 - 84*u^5 + 70*u^6 - 20*u^7), with u from 0 to 1 over the
    duration."""

    law: Literal["4-5-6-7"]


class ModifiedSine(Rise):
    """A rise whose acceleration is a quick sine in its first and last eighth, a slow one between
    them."""

    law: Literal["modified-sine"]


class ModifiedTrapezoid(Rise):
    """A rise whose acceleration is constant over two quarters, which quarter waves of a sine join
    to each other and to the ends."""

    law: Literal["modified-trapezoid"]


class Sine(Section):
    """x = offset + amplitude * sin(2*pi*frequency*t + phase), with t from the first moment of
    `time`."""

    advice: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("omega", "w", "speed", "rate", "rpm", "f", "hz"), "write frequency: 2 Hz"),
        **dict.fromkeys(("at", "mean", "center", "bias", "value"), "write offset: 5 deg"),
        **dict.fromkeys(("stroke", "range"), "write amplitude: half of it"),
    }

    law: Literal["sine"]
    amplitude: AngleOrLength
    """Amplitude, half of the way between the extreme values."""
    frequency: AnyDimension | None = None
    """Periods per time, such as `2 Hz` or `120/(1 min)`; left out, `period`."""
    period: Duration | None = None
    """How long a period lasts; left out, `frequency`."""
    phase: Angle = "0"
    """Phase at the first moment."""
    offset: AngleOrLength = "0"
    """Value in the middle of the oscillation."""

    def check(self) -> None:
        """Exactly one of frequency and period."""
        if self.frequency is None and self.period is None:
            text = "a sine needs a frequency or a period"
            raise refuse("missing-key", text, "add one of them, such as frequency: 2 Hz")
        if self.frequency is not None and self.period is not None:
            text = "frequency and period say the same"
            raise refuse("two-choices", text, "keep one of them", "period")


class Segment(Section):
    """One segment of a sequence."""

    keys: ClassVar[dict[str, str]] = {"extent": "for", "last": "to"}
    advice: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("duration", "time", "angle", "over"), "write for: 0.2 s"),
        "from": "a segment begins where the one before ends; the first one at from: of the law",
    }

    extent: AnyDimension
    """How long it lasts: a time, or how far the coordinate goes that the law runs over."""
    law: Literal[
        "dwell",
        "constant-rate",
        "harmonic",
        "cycloidal",
        "3-4-5",
        "4-5-6-7",
        "modified-sine",
        "modified-trapezoid",
    ]
    """How it goes: at rest, at a constant rate, or by one of the rises."""
    last: AngleOrLength | None = None
    """Value at its end; left out, of a dwell, as before."""

    def check(self) -> None:
        """A dwell has no end of its own, the others have one."""
        if self.law == "dwell" and self.last is not None:
            text = "a dwell stays where it is"
            raise refuse("dwell-to", text, "remove to, or write another law", "to")
        if self.law != "dwell" and self.last is None:
            raise refuse("missing-key", "the key to is missing", "add to: the value at its end")


class Sequence(Section):
    """Segments one after another, before and after which the input rests."""

    law: Literal["sequence"]
    first: AngleOrLength = "0"
    """Value at the beginning."""
    start: AnyDimension | None = None
    """When the first segment begins, as `time` counts; left out, at the first moment of `time`."""
    segments: Annotated[tuple[Segment, ...], Limits(min_length=1)]
    """The segments; over an angle that they span a turn of, they are repeated in each turn."""


class TableLaw(JoinedTable):
    """x as a table of time and value, joined by a curve: a spline, or a monotone one."""

    law: Literal["table"]
    file: CsvPath
    """CSV file with a header and two columns: time (as `time` counts) and value; relative to the
    mechanism file."""

    def check(self) -> None:
        """The rate does not jump."""
        super().check()
        if self.interpolation == "linear":
            text = "the rate of a linear law jumps at every point, where forces would be infinite"
            raise refuse("linear-law", text, "write interpolation: monotone", "interpolation")


Law = (
    ConstantRate
    | ConstantAcceleration
    | Polynomial
    | ExpressionLaw
    | Sine
    | Harmonic
    | Cycloidal
    | Rise345
    | Rise4567
    | ModifiedSine
    | ModifiedTrapezoid
    | Sequence
    | TableLaw
)

LAWS: Final = {
    "constant-rate": ConstantRate,
    "constant-acceleration": ConstantAcceleration,
    "polynomial": Polynomial,
    "expression": ExpressionLaw,
    "sine": Sine,
    "harmonic": Harmonic,
    "cycloidal": Cycloidal,
    "3-4-5": Rise345,
    "4-5-6-7": Rise4567,
    "modified-sine": ModifiedSine,
    "modified-trapezoid": ModifiedTrapezoid,
    "sequence": Sequence,
    "table": TableLaw,
}
"""The laws of motion by their words."""


def law_tag(mapping: dict[str, Any]) -> str | None:
    """The tag of a mapping with a key `law`; None where the word is not a law."""
    word = mapping.get("law")
    return f"({word})" if isinstance(word, str) and word in LAWS else None


ROWS: Final = {
    **dict.fromkeys(("start", "begin", "min", "first"), "write from: 0"),
    **dict.fromkeys(("end", "stop", "max", "last", "until"), "write to: 90"),
    **dict.fromkeys(("steps", "n", "rows", "number"), "write count: 37, or step: 5"),
    **dict.fromkeys(("dt", "increment", "by", "timestep", "time_step"), "write step: 0.1"),
}
"""What to write for other words of rows."""


class WithRates(Section):
    """The rates of inputs that have values for rows."""

    advice: ClassVar[dict[str, str]] = {
        **ROWS,
        **dict.fromkeys(("speed", "velocity", "omega", "rpm"), "write rate: 10 rad/s"),
        "alpha": "write acceleration: 1 rad/s^2",
    }

    rate: CoordinateRate = "0"
    """Rate of the input, the same in every row."""
    acceleration: CoordinateAcceleration = "0"
    """Second rate of the input, the same in every row."""
    jerk: CoordinateJerk = "0"
    """Third rate of the input, the same in every row."""


class SweptInput(Spaced, WithRates):
    """An input that runs from one value to another in equal steps."""

    tag = "(swept)"

    first: AngleOrLength
    """Value of the first row."""
    last: AngleOrLength
    """Value that the last row reaches or stays below."""
    step: AngleOrLength | None = None
    """Distance between rows, its sign does not matter; left out, `count` says it."""
    count: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of rows, the last of which is exactly `to`; left out, `step` says it."""


class ListedInput(WithRates):
    """An input that takes the listed values, one per row."""

    tag = "(listed)"

    values: Annotated[tuple[AngleOrLength, ...], Limits(min_length=1)]
    """The value of each row."""


class HeldInput(WithRates):
    """An input that has the same value in every row."""

    tag = "(held)"

    at: AngleOrLength
    """The value."""


class FollowingInput(Section):
    """An input that follows others; its rates follow from the expression by the chain rule."""

    tag = "(following)"
    keys: ClassVar[dict[str, str]] = {"value": "with"}

    value: AnyDimension
    """An expression of other inputs, and of `time` where there is one: `2*O1.theta`."""
    drive: Literal["own", "tie"] | None = None
    """`tie`: the motors of the inputs that it follows move it, too; `own`: it has a motor
    of its own; left out, `own`."""


class TimeSection(Spaced):
    """The moments of the rows, where the inputs are given by laws."""

    advice: ClassVar[dict[str, str]] = ROWS

    tag = "(spaced)"

    first: Duration
    """First moment."""
    last: Duration
    """Last moment."""
    step: Duration | None = None
    """Time between rows; left out, `count` says it."""
    count: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of rows; left out, `step` says it."""


def _tag(mapping: dict[str, Any]) -> str | None:
    if "law" in mapping:
        return law_tag(mapping)
    if {"from", "to", "step", "count"} & mapping.keys():
        return "(swept)"
    for key, tag in (("values", "(listed)"), ("with", "(following)"), ("at", "(held)")):
        if key in mapping:
            return tag
    return "(swept)"


InputMotion = Annotated[
    SweptInput | ListedInput | HeldInput | FollowingInput | Law, by_word("law", LAWS, _tag)
]


_GRID_INPUTS: Final = 2


class MotionSection(Section):
    """The driven coordinates. Without inputs the mechanism has one row."""

    editors: ClassVar[dict[str, Any]] = {
        "not": {"required": ["grid", "rest"], "properties": {"grid": {"const": True}}}
    }

    inputs: dict[Coordinate, InputMotion] = NOTHING
    """Driven coordinates by name; left out, one row, which stands as it is assembled."""
    time: TimeSection | None = None
    """The moments of the rows, for inputs that are given by laws; left out, inputs have rows of
    their own."""
    grid: Flag = False
    """`true`: the rows are all pairs of the values of two inputs, the first of which changes once
    the second has run through all of its own; left out, inputs run in step."""
    rest: tuple[Coordinate, ...] = ()
    """Independent coordinates that nothing drives: in each row they are where the loads balance,
    and nothing moves; left out, the inputs drive all that is free."""

    @property
    def with_rows(self) -> tuple[str, ...]:
        """The inputs that list rows of their own, in the order of the file."""
        of_rows = (SweptInput, ListedInput)
        return tuple(name for name, motion in self.inputs.items() if isinstance(motion, of_rows))

    def check(self) -> None:
        """Laws go with `time`, rows of an input's own do not; a grid has two inputs with rows; what
        rests is not driven."""
        for number, name in enumerate(self.rest):
            if name in self.inputs:
                text = f"{name} is an input, which is driven, and cannot rest under the loads"
                raise refuse("rest-and-input", text, "remove it from one of them", "rest", number)
            if name in self.rest[:number]:
                raise refuse("named-twice", f"{name} stands twice", "name it once", "rest", number)
        if self.rest and self.grid:
            text = "a grid drives all its inputs, and nothing rests in it"
            raise refuse("rest-in-grid", text, "remove rest, or grid", "rest")
        for name, motion in self.inputs.items():
            has_law = isinstance(motion, tuple(LAWS.values()))
            if has_law and self.time is None:
                text = f"the law of {name} needs the moments of the rows"
                raise refuse("law-without-time", text, "add time: {from, to, step}", "inputs", name)
            if self.time is not None and isinstance(motion, (SweptInput, ListedInput)):
                text = f"{name} lists rows of its own beside time:"
                hint = "give it a law, or remove time"
                raise refuse("rows-beside-time", text, hint, "inputs", name)
        count = len(self.with_rows)
        if self.grid and count != _GRID_INPUTS:
            names = f": {', '.join(self.with_rows)}" if count else ""
            text = f"a grid takes two inputs with rows of their own, here are {count}{names}"
            hint = "give a second one from, to and step, or values; or remove grid"
            if count > _GRID_INPUTS:
                hint = "hold the others with at, let them follow with an expression, or remove grid"
            raise refuse("grid-inputs", text, hint, "grid")


class AssemblySection(Section):
    """The mode followed; left out, an assembled home drawing, else the mode nearest to it."""

    editors: ClassVar[dict[str, Any]] = {"not": {"required": ["near", "mode"]}}

    near: dict[Coordinate, AngleOrLength] = NOTHING
    """Take the mode nearest to these coordinates; left out, an assembled drawing, else the nearest
    to the drawing."""
    mode: Text | None = None
    """Take the mode of this letter, as `mechkin modes` names it, or the one drawn: `home`; left
    out, as `near` says."""
    turns: Annotated[WholeNumber, Limits(ge=0, le=1000)] = 1
    """Turns of helical joints to either side within which modes are looked for."""
    at_branch_points: Literal["straight"] | None = None
    """`straight`: where the branch crosses another, as a parallelogram's does when it lies flat, it
    goes on along its smooth continuation. Left out, the branch ends there."""

    def check(self) -> None:
        """One of near and mode at most."""
        if self.near and self.mode is not None:
            text = "near and mode both choose the assembly mode"
            raise refuse("two-choices", text, "keep one of them", "mode")
