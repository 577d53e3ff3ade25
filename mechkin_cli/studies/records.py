"""What is kept of variants: columns of numbers and words, a line for each variant or row."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

Values: TypeAlias = "NDArray[np.float64] | NDArray[np.int64] | NDArray[np.object_]"
"""Numbers (lines,), nan where there is none; whole numbers; or texts."""


class Heading(NamedTuple):
    """A column: its label, its unit ("" where it has none), and what it holds."""

    label: str
    unit: str = ""
    kind: str = "number"
    """`number`, `whole` or `text`."""


Records = dict[str, Values]
"""Columns by label."""


def joined(pieces: Sequence[Records]) -> Records:
    """Records one below the other."""
    if len(pieces) == 1:
        return pieces[0]
    return {label: np.concatenate([piece[label] for piece in pieces]) for label in pieces[0]}


def empty_values(kind: str, count: int) -> Values:
    """A column without any value."""
    if kind == "text":
        return np.full(count, "", dtype=object)
    return np.zeros(count, dtype=np.int64) if kind == "whole" else np.full(count, np.nan)


def numbers(values: Values) -> Floats:
    """A column of numbers or whole numbers as doubles."""
    return np.asarray(values, dtype=np.float64)
