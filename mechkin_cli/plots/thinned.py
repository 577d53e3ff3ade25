"""Pictures of long runs, of which no more rows are held than a picture shows: of neighbouring ones
the first and the last, where each curve is largest and least, and where verdicts change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.plots.curves import Drawing, Picture, PlotCurve, picture

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats

STRETCHES = 4096
"""Into which the rows of a long run are cut: more than a picture is wide, in dots."""


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
    length = max(1, run_rows // STRETCHES)
    for part, own in parts:
        marks |= dict.fromkeys(part.marks)
        pieces.append(_at(part, _shown(part, own, length)))
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


def _shown(part: Drawing, own: slice, length: int) -> NDArray[np.intp]:
    """The rows of a part that a picture shows, of stretches of a length."""
    begin, end, _ = own.indices(part.status.size)
    if begin >= end:
        return np.empty(0, dtype=np.intp)
    starts = np.arange(begin, end, length)
    chosen = [starts, np.append(starts[1:], end) - 1]
    changes = np.flatnonzero(np.diff(part.status[begin:end])) + begin
    chosen += [changes, changes + 1]
    curves = (*part.curves, *(() if part.against is None else (part.against,)))
    for curve in curves:
        columns = curve.values.reshape(len(curve.values), -1).T
        for values in columns:
            chosen += [
                _extreme(values[begin:end], starts - begin, way) + begin for way in (1.0, -1.0)
            ]
    found = np.unique(np.concatenate(chosen).astype(np.intp))
    return found[(found >= begin) & (found < end)]


def _extreme(values: Floats, starts: NDArray[np.intp], way: float) -> NDArray[np.intp]:
    """Where each stretch that begins at `starts` is largest (way 1) or least (-1); its first row
    where it has no number."""
    sizes = np.where(np.isfinite(values), way * values, -np.inf)
    largest = np.maximum.reduceat(sizes, starts)
    stretch = np.repeat(np.arange(starts.size), np.diff(np.append(starts, values.size)))
    places = np.flatnonzero(sizes == largest[stretch])
    _, first = np.unique(stretch[places], return_index=True)
    return places[first]


def _at(one: Drawing, rows: NDArray[np.intp]) -> Drawing:
    return one._replace(
        curves=tuple(_rows_of(curve, rows) for curve in one.curves),
        against=None if one.against is None else _rows_of(one.against, rows),
        parameter=_rows_of(one.parameter, rows),
        status=one.status[rows],
        marks=(),
    )


def _rows_of(curve: PlotCurve, rows: NDArray[np.intp]) -> PlotCurve:
    return curve._replace(values=curve.values[rows])


def _joined(curves: list[PlotCurve]) -> PlotCurve:
    return curves[0]._replace(values=np.concatenate([curve.values for curve in curves]))
