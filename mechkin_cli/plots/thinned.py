"""Pictures of long runs, of which no more rows are held than a picture shows: of neighbouring ones
the first and the last, where each curve is largest and least, where gaps begin and where verdicts
change. In a plane, where curves may return to where they were, lines between them pass all others
within a dot, and what would be drawn over others is left out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.plots.curves import Drawing, Picture, PlotCurve, picture
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats

    Rows = NDArray[np.intp]

STRETCHES = 4096
"""Into which the rows of a long run are cut: more than a picture is wide, in dots."""

MOST_GAPS, _GAP_PASSES = 1 << 18, 16
"""Rows of a picture up to which every end of a gap that is shown is, too; behind them gaps of
several curves that come thick and fast may be drawn longer than they are."""


def thinned_picture(parts: Iterable[tuple[Drawing, slice]], run_rows: int) -> Picture:
    """The picture of a run whose rows come in parts.

    Args:
        parts: what is drawn of each, and which of its rows are in none before it.
        run_rows: of all.

    Raises:
        UsageError: what cannot stand in one picture.
    """
    pieces: list[Drawing] = []
    marks: dict[tuple[float, str], None] = {}
    # of two at least: a line is lifted in the first row of a stretch and goes on from its last
    length = max(2, run_rows // STRETCHES)
    papers: list[_Paper] = []
    held = 0
    for part, own in parts:
        marks |= dict.fromkeys(part.marks)
        begin, end, _ = own.indices(part.status.size)
        own_rows = _at(part, slice(begin, max(begin, end)))
        passes = _GAP_PASSES if held < MOST_GAPS else 1
        rows, blank = _shown(own_rows, length, papers, passes)
        held += rows.size
        pieces.append(_blanked(_at(part, rows + begin), blank))
    first = pieces[0]
    curves = [_joined([piece.curves[k] for piece in pieces]) for k in range(len(first.curves))]
    against = [piece.against for piece in pieces if piece.against is not None]
    return picture(
        first._replace(
            curves=tuple(curves),
            against=_joined(against) if against else None,
            parameter=_joined([piece.parameter for piece in pieces]),
            marks=tuple(marks),
            status=np.concatenate([piece.status for piece in pieces]),
        )
    )


def _shown(one: Drawing, length: int, papers: list[_Paper], passes: int) -> tuple[Rows, Bools]:
    """The rows that a picture shows of stretches of a length, and in which of them its lines are
    lifted, since the rows behind them would be drawn over others; `passes` over their gaps."""
    count = one.status.size
    if not count:
        return np.empty(0, dtype=np.intp), np.empty(0, dtype=bool)
    starts = np.arange(0, count, length)
    ends = np.append(starts[1:], count) - 1
    changes = np.flatnonzero(np.diff(one.status))
    chosen = [starts, ends, changes, changes + 1]
    columns = [column for curve in _curves(one) for column in _columns(curve)]
    for values in columns:
        chosen += [_extreme(values, starts, way) for way in (1.0, -1.0)]
    planes = _planes(one)
    if planes:
        papers += [_Paper() for _ in planes[len(papers) :]]
        squares = [paper.squares(*plane) for paper, plane in zip(papers, planes, strict=True)]
        chosen += _bends(squares, starts, ends)
    rows = _with_gaps(np.unique(np.concatenate(chosen).astype(np.intp)), columns, passes)
    blank = np.zeros(rows.size, dtype=bool)
    if planes:
        stretch = rows // length
        fresh = np.zeros(starts.size, dtype=bool)
        for paper, (x, y) in zip(papers, squares, strict=True):
            fresh |= paper.draw(x[rows], y[rows], stretch, starts.size)
        fresh |= _told(one, starts, ends)
        # the line is lifted in the first row of what is left out, and goes on from the last one
        before, behind = np.append(True, fresh[:-1]), np.append(fresh[1:], True)
        at_start, at_end = rows == starts[stretch], rows == ends[stretch]
        lifted = ~fresh[stretch] & before[stretch] & at_start & ~at_end
        kept = fresh[stretch] | lifted | (behind[stretch] & at_end)
        rows, blank = rows[kept], lifted[kept]
    return rows, blank


def _curves(one: Drawing) -> list[PlotCurve]:
    return [*one.curves, *(() if one.against is None else (one.against,))]


def _columns(curve: PlotCurve) -> list[Floats]:
    return list(curve.values.reshape(len(curve.values), -1).T)


def _planes(one: Drawing) -> list[tuple[Floats, Floats]]:
    """The planes in which curves may return to where they were: each two components of a vector, or
    a column over another one."""
    vectors = [_columns(curve) for curve in one.curves if curve.is_vector]
    if vectors:
        return [pair for columns in vectors for pair in combinations(columns, 2)]
    if one.against is None or one.against.is_vector or one.against.label == one.parameter.label:
        return []
    return [(one.against.values, curve.values) for curve in one.curves]


def _told(one: Drawing, starts: Rows, ends: Rows) -> Bools:
    """Stretches that are drawn wherever they lie: the first and the last one, those with marks, and
    those with verdicts."""
    told = np.maximum.reduceat(one.status != Status.ok, starts)
    told[[0, -1]] = True
    along = one.parameter.values
    low, high = np.minimum.reduceat(along, starts), np.maximum.reduceat(along, starts)
    for place, _ in one.marks:
        told |= (low <= place) & (place <= high)
    return np.asarray(told)


def _bends(squares: Sequence[tuple[Floats, Floats]], starts: Rows, ends: Rows) -> list[Rows]:
    """Rows between which straight lines pass all others within half a square: stretches are halved
    until they do."""
    found: list[Rows] = []
    long = ends - starts > 1
    first, last = starts[long], ends[long]
    while first.size:
        sizes = last - first
        begins = np.cumsum(sizes) - sizes
        owner = np.repeat(np.arange(first.size), sizes)
        rows = np.arange(owner.size) - begins[owner] + first[owner]
        bent = np.zeros(first.size, dtype=bool)
        for x, y in squares:
            way = x[last] - x[first], y[last] - y[first]
            length = np.hypot(*way)
            unit = [each / np.where(length > 0, length, 1.0) for each in way]
            dx, dy = x[rows] - x[first][owner], y[rows] - y[first][owner]
            along = dx * unit[0][owner] + dy * unit[1][owner]
            along -= np.clip(along, 0.0, length[owner])
            across = dx * unit[1][owner] - dy * unit[0][owner]
            # where an end has no number all others are looked at
            near = (2 * np.hypot(along, across) <= 1) | ~np.isfinite(x[rows] + y[rows])
            bent |= ~np.minimum.reduceat(near, begins)
        first, last = first[bent], last[bent]
        middle = (first + last) // 2
        found.append(middle)
        first, last = np.concatenate([first, middle]), np.concatenate([middle, last])
        long = last - first > 1
        first, last = first[long], last[long]
    return found


def _with_gaps(rows: Rows, columns: Sequence[Floats], passes: int) -> Rows:
    """The same rows and, of gaps between two of them, the first row and the last, with the rows
    before and behind: no line crosses a gap, or ends before one. Rows that one column adds may lie
    in a gap of another, which the next pass sees."""
    gaps = [(np.isfinite(values), _none(values)) for values in columns]
    for _ in range(passes):
        more = [rows]
        for known, none in gaps:
            first, behind = rows[:-1], rows[1:]
            begin = none[np.searchsorted(none, first)]
            begin = begin[known[first] & (begin <= behind)]
            end = none[np.searchsorted(none, behind) - 1]
            end = end[known[behind] & (end >= first)]
            more += [begin - 1, begin, end, end + 1]
        found = np.unique(np.concatenate(more))
        if found.size == rows.size:
            break
        rows = found
    return rows


def _none(values: Floats) -> Rows:
    """Rows without a number, with one before all and one behind."""
    return np.concatenate([[-1], np.flatnonzero(~np.isfinite(values)), [values.size]])


SQUARES = 1024
"""Of a picture across: of about a dot each."""

_SAMPLES = 1 << 18
"""Points of lines that are drawn at once."""


class _Paper:
    """Where lines in a plane have been drawn, in squares; it grows with them, and is empty then."""

    def __init__(self) -> None:
        self._low = np.full(2, np.inf)
        self._high = np.full(2, -np.inf)
        self._drawn = np.zeros(SQUARES * SQUARES, dtype=bool)

    def squares(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Places in squares, nan where there is none."""
        known = np.isfinite(x) & np.isfinite(y)
        points = np.where(known, [x, y], np.nan)
        if known.any():
            low, high = np.nanmin(points, axis=1), np.nanmax(points, axis=1)
            if (low < self._low).any() or (high > self._high).any():
                self._grow(low, high)
        size = self._high - self._low
        size = np.where((size > 0) & np.isfinite(size), size, 1.0)
        placed = (points - self._low[:, None]) * ((SQUARES - 1) / size)[:, None]
        return placed[0], placed[1]

    def _grow(self, low: Floats, high: Floats) -> None:
        grown = np.minimum(low, self._low), np.maximum(high, self._high)
        if np.isfinite(self._low).all():
            # by more than is needed, so that it grows a few times alone
            size = grown[1] - grown[0]
            grown = (
                np.where(low < self._low, grown[0] - size / 2, self._low),
                np.where(high > self._high, grown[1] + size / 2, self._high),
            )
        self._low, self._high = grown
        self._drawn[:] = False

    def draw(self, x: Floats, y: Floats, stretch: Rows, stretches: int) -> Bools:
        """Draws a line through places in squares; which of its stretches are new (stretches,)."""
        fresh = np.zeros(stretches, dtype=bool)
        across = np.maximum(np.abs(np.diff(x)), np.abs(np.diff(y)))
        counts = np.where(np.isfinite(across), np.ceil(across) + 1, 0).astype(np.intp)
        drawn = []
        for lines in np.split(
            np.arange(counts.size), np.flatnonzero(np.diff(np.cumsum(counts) // _SAMPLES)) + 1
        ):
            owner = np.repeat(lines, counts[lines])
            begins = np.cumsum(counts[lines]) - counts[lines]
            number = np.arange(owner.size) - np.repeat(begins, counts[lines])
            part = (number + 1) / counts[owner]
            at = [each[owner] + part * (each[owner + 1] - each[owner]) for each in (x, y)]
            square = at[1].astype(np.intp) * SQUARES + at[0].astype(np.intp)
            new = ~self._drawn[square]
            fresh[stretch[owner[new] + 1]] = True
            drawn.append(np.unique(square[new]))
        for each in drawn:
            self._drawn[each] = True
        return fresh


def _extreme(values: Floats, starts: Rows, way: float) -> Rows:
    """Where each stretch that begins at `starts` is largest (way 1) or least (-1); its first row
    where it has no number."""
    sizes = np.where(np.isfinite(values), way * values, -np.inf)
    largest = np.maximum.reduceat(sizes, starts)
    stretch = np.repeat(np.arange(starts.size), np.diff(np.append(starts, values.size)))
    places = np.flatnonzero(sizes == largest[stretch])
    _, first = np.unique(stretch[places], return_index=True)
    return places[first]


def _at(one: Drawing, rows: Rows | slice) -> Drawing:
    return one._replace(
        curves=tuple(_rows_of(curve, rows) for curve in one.curves),
        against=None if one.against is None else _rows_of(one.against, rows),
        parameter=_rows_of(one.parameter, rows),
        status=one.status[rows],
    )


def _blanked(one: Drawing, rows: Bools) -> Drawing:
    """Without numbers in some rows."""
    if not rows.any():
        return one

    def without(curve: PlotCurve) -> PlotCurve:
        values = curve.values.copy()
        values[rows] = np.nan
        return curve._replace(values=values)

    against = None if one.against is None else without(one.against)
    return one._replace(curves=tuple(without(curve) for curve in one.curves), against=against)


def _rows_of(curve: PlotCurve, rows: Rows | slice) -> PlotCurve:
    return curve._replace(values=curve.values[rows])


def _joined(curves: list[PlotCurve]) -> PlotCurve:
    return curves[0]._replace(values=np.concatenate([curve.values for curve in curves]))
