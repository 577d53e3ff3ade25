"""Laws of motion: an input as a function of time, for files with `motion: {time: ...}`."""

from typing import Annotated, Any, Final, Literal

from mechkin_cli.schema.alternatives import Tag
from mechkin_cli.schema.base import Key, Section, refuse
from mechkin_cli.schema.joining import JoinedTable
from mechkin_cli.schema.rules import Limits
from mechkin_cli.schema.scalars import (
    AngleOrLength,
    AnyDimension,
    CoordinateAcceleration,
    CoordinateRate,
    CsvPath,
    Duration,
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


class _Rise(Section):
    start: Duration | None = None
    """When the rise begins, as `time` counts; left out, at the first moment of `time`. Before it
    the input rests."""
    duration: Duration | None = None
    """How long it lasts; left out, to the last moment of `time`. After it the input rests."""


class Harmonic(_Rise):
    """x = from + (to - from) * (1 - cos(pi*u))/2, with u from 0 to 1 over the duration."""

    law: Literal["harmonic"]
    first: Annotated[AngleOrLength, Key("from")]
    """Value before the rise."""
    last: Annotated[AngleOrLength, Key("to")]
    """Value after the rise."""


class Cycloidal(_Rise):
    """x = from + (to - from) * (u - sin(2*pi*u)/(2*pi)), with u from 0 to 1 over the duration."""

    law: Literal["cycloidal"]
    first: Annotated[AngleOrLength, Key("from")]
    """Value before the rise."""
    last: Annotated[AngleOrLength, Key("to")]
    """Value after the rise."""


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


Law = ConstantRate | ConstantAcceleration | Polynomial | Harmonic | Cycloidal | TableLaw

LAWS: Final = {
    "constant-rate": ConstantRate,
    "constant-acceleration": ConstantAcceleration,
    "polynomial": Polynomial,
    "harmonic": Harmonic,
    "cycloidal": Cycloidal,
    "table": TableLaw,
}
"""The laws of motion by their words."""

TaggedLaw = (
    Annotated[ConstantRate, Tag("(constant-rate)")]
    | Annotated[ConstantAcceleration, Tag("(constant-acceleration)")]
    | Annotated[Polynomial, Tag("(polynomial)")]
    | Annotated[Harmonic, Tag("(harmonic)")]
    | Annotated[Cycloidal, Tag("(cycloidal)")]
    | Annotated[TableLaw, Tag("(table)")]
)
"""The laws, as parts of a union that `law_tag` decides."""


def law_tag(mapping: dict[str, Any]) -> str | None:
    """The tag of what has a key `law`; None where the word is no law."""
    word = mapping["law"]
    return f"({word})" if isinstance(word, str) and word in LAWS else None
