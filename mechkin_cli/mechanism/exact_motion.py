"""The motion of the inputs as the text says it: numbers over the rows, on a recording."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.tape.exact_rows import ExactRows


class ExactMoments(NamedTuple):
    """The moments of a response's rows in double-double (2, rows): in s, and in the file's unit."""

    in_si: Floats
    written: Floats


class ExactMotion(NamedTuple):
    """Inputs by name, each with value, rate, acceleration and jerk; `time` has its value alone.

    Attributes:
        rows: holds the numbers that differ from row to row.
        in_si: in rad, m and s.
        written: in the file's units.
        tie_rates: of tied inputs by their leaders, in the order of `Motion.tied`, in SI.
    """

    rows: ExactRows
    in_si: Mapping[str, Any]
    written: Mapping[str, Any]
    tie_rates: tuple[Any, ...] = ()
