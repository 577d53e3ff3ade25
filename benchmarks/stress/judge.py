"""The verdict on every row: what the solver said of it, against what is true."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.stress.numbers.double_double import PI, DoubleDouble, radians
from benchmarks.stress.numbers.series import Series
from benchmarks.stress.quantity import Mask, Quantity, Rows, Truth
from mechkin_cli.bench.runs import (
    NINE_DIGITS,
    ROUNDING,
    TOLERANCE,
    WRONG,
    WRONG_TOLERANCES,
    verdicts_of,
)
from mechkin_cli.verdict import has_solution

FAR = 16.0
"""Rad or sizes: states are reduced to a turn, cells are not."""
TURN = DoubleDouble.of(2 * PI)


@dataclass(frozen=True)
class Found:
    """What the solver gave, in radians' degrees and SI as files of this room are written.

    `codes`, `condition` and `bound` (nan where rows have none) are (mechanisms, rows), as are the
    values by name, angles in degrees and rates in rad/s; `noted` (mechanisms, 1) says of which runs
    say that they take the mechanism for one whose axes or points coincide, `unit` (mechanisms, 1)
    in which length bounds of rows are, in m.
    """

    codes: NDArray[np.int8]
    condition: Rows
    bound: Rows
    values: dict[str, Rows]
    noted: Mask
    unit: Rows


@dataclass(frozen=True)
class Judged:
    """(mechanisms, rows) each; errors and bounds are nan where there is nothing to compare.

    Positions in rad and parts of the size, or of the value where that is larger; `miss` without
    these parts, nan where a value is so large that its cell rounds by more than a state. Rates,
    accelerations and forces in parts of the row's largest.
    """

    verdict: NDArray[np.int8]
    condition: Rows
    bound: Rows
    position: Rows
    miss: Rows
    rate: Rows
    acceleration: Rows
    force: Rows


def judge(found: Found, truth: Truth, *, response: bool = False) -> Judged:
    """All rows of a block; those of a response count in its tolerances."""
    solved = has_solution(found.codes) & truth.exists
    with np.errstate(all="ignore"):
        position, miss, elsewhere = _positions(found, truth)
        rate, acceleration = _rates(found, truth)
        force = _forces(found, truth)
        condition = np.fmax(found.condition, 1.0)
        wrong, well = elsewhere < position, np.ones(position.shape, bool)
        if response:
            wrong |= ~(position <= WRONG_TOLERANCES * TOLERANCE)
        else:
            rounding = WRONG * ROUNDING * condition
            wrong |= ~(position <= np.maximum(rounding, NINE_DIGITS))
            well = ~(rate > np.maximum(rounding * condition, NINE_DIGITS))
            second = np.fmax(acceleration, force)
            well &= ~(second > np.maximum(rounding * condition * condition, NINE_DIGITS))
    # what a held freedom keeps is a convention, and no error
    blank = np.where(solved & truth.decided & ~found.noted, 0.0, np.nan)
    return Judged(
        verdicts_of(found.codes, truth.exists, truth.decided, wrong, well, found.noted),
        condition,
        found.bound + blank,
        position + blank,
        miss + blank,
        rate + blank,
        acceleration + blank,
        force + blank,
    )


def _positions(found: Found, truth: Truth) -> tuple[Rows, Rows, Rows]:
    """The largest errors, in parts of large values and without, and how far the row is from the
    other assembly where that is told."""
    shape = found.codes.shape
    error, bare, elsewhere = np.zeros(shape), np.zeros(shape), np.full(shape, np.inf)
    for quantity in truth.quantities:
        right = quantity.levels[0]
        scale = truth.size if quantity.kind == "length" else 1.0
        miss = _apart(found, quantity, right) / scale
        far = np.abs(right.high) / scale
        bare = np.maximum(bare, np.where(far < FAR, miss, np.nan))
        error = np.maximum(error, miss / np.maximum(1.0, far))
        if quantity.other is not None:
            elsewhere = np.fmin(elsewhere, _apart(found, quantity, quantity.other) / scale)
    return error, bare, elsewhere


def misses(found: Found, truth: Truth) -> Rows:
    """The largest errors of joint coordinates (mechanisms, rows), which bounds of rows are about,
    in rad and the solver's own unit of length; nan where places of links alone are compared."""
    coordinates = tuple(q for q in truth.quantities if ".position." not in q.keys[0])
    if not coordinates:
        return np.full(found.codes.shape, np.nan)
    return _positions(found, replace(truth, quantities=coordinates, size=found.unit))[1]


def _apart(found: Found, quantity: Quantity, right: DoubleDouble) -> Rows:
    """How far a coordinate is from a value, in m or rad."""
    given = found.values[quantity.keys[0]]
    if quantity.kind == "length":
        return np.abs((right - given).high)
    miss = radians(given) - right
    if quantity.kind == "angle":
        miss = miss - TURN * np.rint((miss / TURN).high)
    return np.abs(miss.high)


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
        _, rate, bend = quantity.levels
        fastest = np.maximum(fastest, np.abs(rate.high) / scale)
        strongest = np.maximum(strongest, np.abs(bend.high) / scale)
        for k, (right, key) in enumerate(zip((rate, bend), quantity.keys[1:], strict=True)):
            miss = np.abs((right - found.values[key]).high) / scale
            errors[k] = np.fmax(errors[k], miss)
    strongest = np.maximum(strongest, fastest * fastest)
    return errors[0] / fastest, errors[1] / strongest


def _forces(found: Found, truth: Truth) -> Rows:
    """Errors in parts of the row's largest force or load; of moments over the size."""
    shape = found.codes.shape
    error, largest = np.full(shape, np.nan), np.zeros(shape) + truth.heaviest
    for force in truth.forces:
        scale = truth.size if force.is_moment else 1.0
        largest = np.fmax(largest, np.abs(force.value.high) / scale)
        # a force that is not given is as far off as can be
        miss = np.abs((force.value - found.values[force.key]).high) / scale
        error = np.fmax(error, np.where(np.isnan(miss), np.inf, miss))
    return error / largest
