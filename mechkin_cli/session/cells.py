"""The cells of a course: stretches of its parameter without a kink, and how the inputs rest at
their ends.

Kinks are where a choice on the tape (abs, min, max, wrap) goes the other way, and where a law
passes from one piece to the next; all are found to the last bits by bisection between samples. An
input that moves alone is straight between its turning points. Where several come to rest at once
the parameter tells their direction no longer, and the order in which they leave is read.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import pairwise
from math import frexp, inf, sqrt

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import CellKind, Course
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.show import Floats
from mechkin_cli.tape import CONDITIONS, Operation, Tape, compiled
from mechkin_cli.tolerances import (
    COURSE_JUMP,
    COURSE_REST,
    COURSE_SAME,
    COURSE_SAMPLES,
    COURSE_SLOW,
    MOST_COURSE_CELLS,
    MOST_COURSE_ORDER,
    MOST_COURSE_SAMPLES,
)

SWITCHES = (
    *CONDITIONS,
    Operation.MAGNITUDE,
    Operation.SIGN,
    Operation.LARGER,
    Operation.SMALLER,
    Operation.POWER_OF_TWO,
    Operation.WHOLE,
)
"""Operations that choose; the kernel's `replay_jets` is told which way each goes."""


class Cells(NamedTuple):
    """Attributes as those of `mechanism.course.Course`."""

    edges: Floats
    kinds: np.ndarray
    constants: Floats
    ways: Floats
    powers: np.ndarray


class Formula:
    """A tape of the inputs over a parameter (its first input) and constants of pieces.

    Args:
        tape: from both to the inputs in SI, without guards.
        edges: parameters at which constants change.
        constants: those of the piece in which a parameter lies.
    """

    def __init__(
        self, tape: Tape, edges: list[float], constants: Callable[[float], list[float]]
    ) -> None:
        self.tape = tape
        self.edges, self.constants = edges, constants
        self.switches = [
            k for k, code in enumerate(self.tape.operations.tolist()) if code in SWITCHES
        ]

    @cached_property
    def native(self) -> _kernel.Tape:
        """The tape in the kernel."""
        return compiled(self.tape)

    @cached_property
    def _operands(self) -> _kernel.Tape:
        outputs = self.tape.operands[self.switches, :2].reshape(-1)
        return compiled(replace(self.tape, outputs=outputs))

    def ways(self, at: Floats, constants: list[float]) -> Floats:
        """Which way each switch goes (places, switches)."""
        if not self.switches:
            return np.zeros((at.size, 0))
        found = self._operands.replay(self._given(at, constants), 0)[0]
        a, b = found[:, ::2], found[:, 1::2]
        ways = np.empty(a.shape)
        with np.errstate(invalid="ignore"):
            for k, number in enumerate(self.switches):
                ways[:, k] = _WAYS[Operation(int(self.tape.operations[number]))](a[:, k], b[:, k])
        return ways

    def jets(self, at: Floats, constants: list[float], ways: Floats) -> Floats:
        """Inputs with two derivatives by the parameter (places, inputs, 3), on one cell."""
        given = self._given(at, constants)
        return self.native.jets(given, np.ascontiguousarray(ways))

    def _given(self, at: Floats, constants: list[float]) -> Floats:
        given = np.empty((1 + len(constants), at.size))
        given[0] = at
        given[1:] = np.array(constants)[:, None]
        return given


_WAYS: dict[Operation, Callable[[Floats, Floats], Floats]] = {
    Operation.MAGNITUDE: lambda a, _: np.where(a < 0.0, -1.0, 1.0),
    Operation.SIGN: lambda a, _: np.sign(a),
    Operation.LARGER: lambda a, b: (b > a).astype(float),
    Operation.SMALLER: lambda a, b: (b < a).astype(float),
    Operation.LESS: lambda a, b: (a < b).astype(float),
    Operation.NOT_MORE: lambda a, b: (a <= b).astype(float),
    Operation.EQUAL: lambda a, b: (a == b).astype(float),
    Operation.POWER_OF_TWO: lambda a, _: np.zeros(a.shape),
    Operation.WHOLE: lambda a, _: np.rint(a),
}


Beside = Callable[["Floats"], "tuple[Floats, Floats]"]
"""Of parameters, those of the rows next to them below and above."""


class _Rows(NamedTuple):
    """The least and the largest parameter of the rows, and those next to others."""

    low: float
    high: float
    beside: Beside

    @property
    def same(self) -> float:
        """How far parameters lie apart that are one."""
        return COURSE_SAME * (self.high - self.low)


def _beside(rows: Floats) -> Beside:
    """Of rows whose parameters are held, in order."""

    def beside(at: Floats) -> tuple[Floats, Floats]:
        place = np.clip(np.searchsorted(rows, at), 1, rows.size - 1)
        return rows[place - 1], rows[place]

    return beside


class _Cell(NamedTuple):
    low: float
    high: float
    constants: list[float]
    ways: Floats


def cells_of(formula: Formula, at: Floats, beside: Beside | None = None) -> Cells:
    """The cells between the least and the largest parameter of the rows.

    Args:
        formula: of the inputs.
        at: parameters of the rows, or of some of very many, the least and the largest among them.
        beside: of very many, their rows next to parameters; None: `at` are all.
    """
    low, high = float(at.min()), float(at.max())
    density = max(COURSE_SAMPLES, min(8 * at.size, MOST_COURSE_SAMPLES)) / (high - low)
    rows = _Rows(low, high, beside or _beside(np.unique(at)))
    edges = _snapped(np.array([low, *(e for e in formula.edges if low < e < high), high]), rows)
    kinked = [
        part
        for cell in _between(formula, edges)
        for part in _at_kinks(formula, cell, _samples(cell, density), rows)
    ]
    found: list[tuple[_Cell, CellKind, tuple[int, int]]] = []
    for cell in kinked:
        found += _at_rests(formula, cell, _samples(cell, density), rows)
    return Cells(
        np.array([low, *(cell.high for cell, _, _ in found)]),
        np.array([kind for _, kind, _ in found], dtype=np.int8),
        np.array([cell.constants for cell, _, _ in found]).reshape(len(found), -1),
        np.array([cell.ways for cell, _, _ in found]).reshape(len(found), -1),
        np.array([powers for _, _, powers in found], dtype=np.int64),
    )


def jumps_of(course: Course) -> Floats:
    """By how much the inputs and their rates by the parameter jump at the inner edges of its cells
    (edges, inputs, 2), in SI; what is rounding is 0."""
    native, count = compiled(course.tape), course.edges.size - 2

    def sides(first: int) -> Floats:
        """Values and rates on the cells from `first` on, one for each inner edge."""
        found = np.empty((count, course.values.shape[0], 2))
        for k in range(count):
            given = np.array([course.edges[k + 1], *course.constants[k + first]])[:, None]
            ways = np.ascontiguousarray(course.ways[k + first : k + first + 1])
            found[k] = native.jets(given, ways[0])[0, :, :2]
        return found

    before, behind = sides(0), sides(1)
    jumps = behind - before
    fastest = np.max(np.abs([before, behind])[..., 1], axis=(0, 1), initial=0.0)
    # at least that of going once through all values
    fastest += np.ptp(course.values, axis=1) / (course.edges[-1] - course.edges[0])
    limits = np.stack(
        [COURSE_JUMP * (1.0 + np.max(np.abs(course.values), axis=1)), COURSE_REST * fastest], axis=1
    )
    return np.where(np.abs(jumps) > limits, jumps, 0.0)


def _samples(cell: _Cell, density: float) -> Floats:
    count = int((cell.high - cell.low) * density) + 17
    return cell.low + (cell.high - cell.low) * np.linspace(0.0, 1.0, count)


def _snapped(edges: Floats, rows: _Rows) -> Floats:
    """Edges in order, those next to a row exactly on it, each once."""
    for near in rows.beside(edges):
        edges = np.where(np.abs(edges - near) <= rows.same, near, edges)
    edges = np.array(sorted(set(edges.tolist())))
    apart = np.diff(edges) > rows.same
    kept: Floats = edges[np.concatenate([[True], apart])]
    return kept


def _between(formula: Formula, edges: Floats) -> list[_Cell]:
    found = []
    for low, high in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        middle = 0.5 * (low + high)
        constants = formula.constants(middle)
        found.append(_Cell(low, high, constants, formula.ways(np.array([middle]), constants)[0]))
    return found


def _parts(formula: Formula, cell: _Cell, inner: list[float], rows: _Rows) -> list[_Cell]:
    """A cell cut at some parameters in it."""
    edges = _snapped(np.array([cell.low, *sorted(inner), cell.high]), rows)
    edges[0], edges[-1] = cell.low, cell.high
    found = []
    for low, high in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        ways = formula.ways(np.array([0.5 * (low + high)]), cell.constants)[0]
        found.append(_Cell(low, high, cell.constants, ways))
    return found


def _at_kinks(formula: Formula, cell: _Cell, at: Floats, rows: _Rows) -> list[_Cell]:
    """A cell cut where a switch goes the other way."""
    if not formula.switches:
        return [cell]
    at = at[1:-1]
    ways = formula.ways(at, cell.constants)
    kinks: list[float] = []
    for k in np.flatnonzero((ways[1:] != ways[:-1]).any(axis=1)):
        low, high, before = float(at[k]), float(at[k + 1]), ways[k]
        while len(kinks) < MOST_COURSE_CELLS:
            kink, after = _change(formula, cell, low, high, before)
            kinks.append(kink)
            if (after == ways[k + 1]).all():
                break
            low, before = np.nextafter(kink, high), after
    return _parts(formula, cell, kinks, rows)


def _change(
    formula: Formula, cell: _Cell, low: float, high: float, before: Floats
) -> tuple[float, Floats]:
    """The first change of the ways behind `low`, and the ways behind it."""
    after = before
    for _ in range(12):
        at = low + (high - low) * np.linspace(0.0, 1.0, 33)
        ways = formula.ways(at, cell.constants)
        other = np.flatnonzero((ways != before).any(axis=1))
        first = max(int(other[0]), 1) if other.size else 32
        low, high, after = float(at[first - 1]), float(at[first]), ways[first]
    return high, after


def _at_rests(
    formula: Formula, cell: _Cell, at: Floats, rows: _Rows
) -> list[tuple[_Cell, CellKind, tuple[int, int]]]:
    """A smooth cell cut where what moves in it turns or rests."""
    rates = formula.jets(at, cell.constants, cell.ways)[:, :, 1]
    fastest = np.nanmax(np.abs(rates), axis=0, initial=0.0)
    moving = np.flatnonzero(fastest > 0.0)
    if moving.size == 0:
        return [(cell, CellKind.STRAIGHT, (1, 1))]
    speed = _Speed(formula, cell, moving, fastest[moving])
    if moving.size == 1:
        parts = _parts(formula, cell, speed.turns(at, rates[:, moving[0]]), rows)
        return [(part, CellKind.STRAIGHT, (1, 1)) for part in parts]
    found: list[tuple[_Cell, CellKind, tuple[int, int]]] = []
    for part in _parts(formula, cell, speed.rests(at), rows):
        powers = (speed.order(part.low, part.high), speed.order(part.high, part.low))
        if min(powers) == 1:
            found.append((part, CellKind.CURVED, powers))
            continue
        lower, upper = _parts(formula, part, [0.5 * (part.low + part.high)], rows)
        found.append((lower, CellKind.CURVED, (powers[0], 1)))
        found.append((upper, CellKind.CURVED, (1, powers[1])))
    return found


class _Speed:
    """The rates of the inputs that move on a cell, in parts of the fastest of each."""

    def __init__(self, formula: Formula, cell: _Cell, moving: np.ndarray, fastest: Floats) -> None:
        self.formula, self.cell, self.moving, self.fastest = formula, cell, moving, fastest

    def _jets(self, at: Floats) -> Floats:
        cell = self.cell
        found = self.formula.jets(at, cell.constants, cell.ways)[:, self.moving]
        jets: Floats = found / self.fastest[:, None]
        return jets

    def of(self, at: Floats) -> Floats:
        """The largest of them (places,)."""
        speeds: Floats = np.max(np.abs(self._jets(at)[:, :, 1]), axis=1)
        return speeds

    def turns(self, at: Floats, rates: Floats) -> list[float]:
        """Where the one input that moves turns back."""
        signs = np.sign(rates)
        passed = np.flatnonzero(signs)
        found = []
        for one, other in pairwise(passed.tolist()):
            if signs[one] == signs[other]:
                continue
            low, high = float(at[one]), float(at[other])
            for _ in range(12):
                inner = low + (high - low) * np.linspace(0.0, 1.0, 33)
                turned = np.sign(self._jets(inner)[:, 0, 1]) != signs[one]
                first = max(int(np.argmax(turned)), 1) if turned.any() else 32
                low, high = float(inner[first - 1]), float(inner[first])
            found.append(high)
        return found

    def rests(self, at: Floats) -> list[float]:
        """Where all stand still at once."""
        speed, last = self.of(at), at.size - 1
        beside = np.concatenate([[inf], speed, [inf]])
        least = (speed <= beside[:-2]) & (speed <= beside[2:])
        # at an end of the cell it may rest; what it rests next to is sought beside one alone
        least[[0, last]] &= speed[[0, last]] > COURSE_REST
        found = []
        # next to a zero; where the rates are even nothing rests
        for k in np.flatnonzero(least & (speed < COURSE_SLOW)).tolist():
            low, high = float(at[max(k - 1, 0)]), float(at[min(k + 1, last)])
            for _ in range(16):
                near = low + (high - low) * np.linspace(0.0, 1.0, 33)
                best = int(np.argmin(self.of(near)))
                low, high = float(near[max(best - 1, 0)]), float(near[min(best + 1, 32)])
            middle = 0.5 * (low + high)
            if self.of(np.array([middle]))[0] <= COURSE_REST:
                found.append(middle)
        return found

    def order(self, end: float, other: float) -> int:
        """The power of the distance from an end with which the inputs leave it: 1 unless they rest
        there."""
        if not self.of(np.array([end]))[0] <= COURSE_REST:
            return 1
        away = (other - end) * 0.01
        values = self._jets(np.array([end, end + away, end + 0.5 * away]))[:, :, 0]
        far, near = np.max(np.abs(values[1:] - values[0]), axis=1)
        if not far > 0.0 or not near > 0.0:
            return 1
        mantissa, exponent = frexp(float(far / near))
        return min(max(exponent if mantissa > sqrt(0.5) else exponent - 1, 1), MOST_COURSE_ORDER)
