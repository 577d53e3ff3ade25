"""The verdict on every row: what the solver said of it, against what is true."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.benchmark.stress.numbers.double_double import PI, DoubleDouble, radians
from mechkin_cli.benchmark.stress.numbers.series import Series
from mechkin_cli.benchmark.stress.quantity import Mask, Quantity, Rows, Truth
from mechkin_cli.status import Status, has_solution

ROUNDING = 2.0**-53
WRONG = 1000.0
"""Errors above this many roundings times the condition are no rounding but another place."""
WRONG_TOLERANCES = 1000.0
"""The same of responses, in their tolerances: errors of steps add up."""
TOLERANCE = 1e-10
"""Of a response that names none."""
TURN = DoubleDouble.of(2 * PI)


class Verdict(IntEnum):
    """What became of a row."""

    right = 0
    right_warned = 1
    """Right, `near-singular` or `rank-unclear`."""
    rightly_none = 2
    """There is none, and none was given."""
    undecided = 3
    """Rounding of the written numbers alone decides whether there is one."""
    false_alarm = 4
    """There is one, and none was given."""
    wrong_warned = 5
    """Wrong, `near-singular` or `rank-unclear`."""
    false_ok = 6
    """Wrong, or there is none, and the row says ok."""


@dataclass(frozen=True)
class Found:
    """What the solver gave, in radians' degrees and SI as files of this room are written.

    `codes`, `condition` and `bound` (nan where rows have none) are (mechanisms, rows), as are the
    values by name, angles in degrees and rates in rad/s.
    """

    codes: NDArray[np.int8]
    condition: Rows
    bound: Rows
    values: dict[str, Rows]


@dataclass(frozen=True)
class Judged:
    """(mechanisms, rows) each; errors are nan where there is nothing to compare.

    Positions in rad and parts of the size, rates and accelerations in parts of the row's largest.
    """

    verdict: NDArray[np.int8]
    condition: Rows
    bound: Rows
    position: Rows
    rate: Rows
    acceleration: Rows


def judge(found: Found, truth: Truth, *, response: bool = False) -> Judged:
    """All rows of a block; those of a response count in its tolerances."""
    solved = has_solution(found.codes) & truth.exists
    with np.errstate(all="ignore"):
        position, elsewhere = _positions(found, truth)
        rate, acceleration = _rates(found, truth)
        condition = np.fmax(found.condition, 1.0)
        limit = WRONG_TOLERANCES * TOLERANCE if response else WRONG * ROUNDING * condition
        wrong = ~(position <= limit) | (elsewhere < position)
    blank = np.where(solved & truth.decided, 0.0, np.nan)
    return Judged(
        _verdicts(found.codes, truth, wrong),
        condition,
        found.bound + blank,
        position + blank,
        rate + blank,
        acceleration + blank,
    )


def _verdicts(codes: NDArray[np.int8], truth: Truth, wrong: Mask) -> NDArray[np.int8]:
    solved = has_solution(codes)
    certain = codes == Status.ok
    good = solved & truth.exists & ~wrong
    verdict = np.where(solved, np.where(certain, Verdict.false_ok, Verdict.wrong_warned), 0)
    verdict = np.where(good, np.where(certain, Verdict.right, Verdict.right_warned), verdict)
    none = np.where(truth.exists, Verdict.false_alarm, Verdict.rightly_none)
    verdict = np.where(solved, verdict, none)
    return np.where(truth.decided, verdict, Verdict.undecided).astype(np.int8)


def _positions(found: Found, truth: Truth) -> tuple[Rows, Rows]:
    """The largest error, and how far the row is from the other assembly where that is told."""
    error = np.zeros(found.codes.shape)
    elsewhere = np.full(found.codes.shape, np.inf)
    for quantity in truth.quantities:
        value = quantity.value
        right = value.value if isinstance(value, Series) else value
        error = np.maximum(error, _apart(found, quantity, right, truth.size))
        if quantity.other is not None:
            elsewhere = np.fmin(elsewhere, _apart(found, quantity, quantity.other, truth.size))
    return error, elsewhere


def _apart(found: Found, quantity: Quantity, right: DoubleDouble, size: Rows) -> Rows:
    """How far a coordinate is from a value: rad, or parts of the size or of the value where that is
    larger."""
    given = found.values[quantity.name]
    if quantity.kind == "length":
        return np.abs((right - given).high) / np.maximum(size, np.abs(right.high))
    miss = radians(given) - right
    if quantity.kind == "angle":
        miss = miss - TURN * np.rint((miss / TURN).high)
    return np.abs(miss.high) / np.maximum(1.0, np.abs(right.high))


def _rates(found: Found, truth: Truth) -> tuple[Rows, Rows]:
    """Errors of rates in parts of the largest rate of the row; of accelerations in parts of the
    largest, or of that rate squared."""
    shape = found.codes.shape
    fastest, strongest = np.ones(shape), np.ones(shape)
    errors = [np.full(shape, np.nan), np.full(shape, np.nan)]
    for quantity in truth.quantities:
        if not isinstance(quantity.value, Series):
            continue
        scale = truth.size if quantity.kind == "length" else 1.0
        rate, bend = quantity.value.rate, quantity.value.acceleration
        fastest = np.maximum(fastest, np.abs(rate.high) / scale)
        strongest = np.maximum(strongest, np.abs(bend.high) / scale)
        for k, (right, suffix) in enumerate(((rate, "_dot"), (bend, "_ddot"))):
            miss = np.abs((right - found.values[quantity.name + suffix]).high) / scale
            errors[k] = np.fmax(errors[k], miss)
    strongest = np.maximum(strongest, fastest * fastest)
    return errors[0] / fastest, errors[1] / strongest
