"""A picture as plain data: which curves stand against what, and what is marked.

Numbers stand over one column, a panel for each unit. Vectors are drawn in a plane with equal axes
instead: a position gives the curve of its point, a force its polar diagram about the origin. Two
columns of the same unit of length or force are drawn in such a plane, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.plots.curves import Curve, curve_of, parameter_curve
from mechkin_cli.status import Status
from mechkin_cli.units import FORCE, LENGTH, MOMENT
from mechkin_cli.view.marks import run_marks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.view.readable import Readable

COMPONENTS = "xyz"


class Panel(NamedTuple):
    """Curves of one unit."""

    unit: str
    curves: tuple[Curve, ...]


class Mark(NamedTuple):
    """A place of the run's parameter, and what happens there."""

    place: float
    words: str


class Picture(NamedTuple):
    """What is drawn.

    Attributes:
        title: above it.
        x: against which the curves of all panels stand; in a plane one for each curve.
        panels: from top to bottom; in a plane one.
        is_plane: both axes are of one unit and drawn to one scale.
        parameter: what the run goes along.
        marks: dead centres, branch points and events, by that parameter.
        solved: rows with a position (rows,).
        doubtful: verdicts other than ok of rows that have one: words and rows (rows,).
    """

    title: str
    x: tuple[Curve, ...]
    panels: tuple[Panel, ...]
    is_plane: bool
    parameter: Curve
    marks: tuple[Mark, ...]
    solved: Bools
    doubtful: tuple[tuple[str, Bools], ...]


def picture(
    analysis: Readable, title: str, y: Sequence[str | Curve], x: str | Curve | None = None
) -> Picture:
    """The picture of some columns, quantities or expressions, in the file's units.

    Args:
        analysis: of the run.
        title: above the picture.
        y: what is drawn; vectors alone, or numbers alone.
        x: against what; None: the run's parameter.

    Raises:
        UsageError: nothing to draw, words, or what cannot stand in one picture.
        ExpressionError: an unknown name, or dimensions that do not fit.
    """
    drawn = [one if isinstance(one, Curve) else curve_of(analysis, one) for one in y]
    if not drawn:
        raise UsageError(f"{title} has nothing to draw; name what to draw, with --y A.effort")
    along = parameter_curve(analysis)
    against = curve_of(analysis, x) if isinstance(x, str) else x
    if any(curve.is_vector for curve in drawn):
        xs, ys = _in_plane(drawn, against)
        return _picture(analysis, title, xs, (Panel(ys[0].unit, ys),), along, is_plane=True)
    against = against or along
    if against.is_vector:
        raise UsageError(f"{against.label} is a vector; draw over a number, such as its .x")
    units = dict.fromkeys(curve.unit for curve in drawn)
    panels = tuple(Panel(u, tuple(c for c in drawn if c.unit == u)) for u in units)
    label = analysis.result.units.label
    is_plane = against.label != along.label and set(units) == {against.unit}
    is_plane &= against.unit in {label(LENGTH), label(FORCE), label(MOMENT)}
    xs = len(drawn) * (against,) if is_plane else (against,)
    return _picture(analysis, title, xs, panels, along, is_plane=is_plane)


def _picture(
    analysis: Readable,
    title: str,
    x: tuple[Curve, ...],
    panels: tuple[Panel, ...],
    along: Curve,
    *,
    is_plane: bool,
) -> Picture:
    result = analysis.result
    found = run_marks(analysis, along.label, along.values)
    marks = tuple(Mark(float(str(mark["x"])), str(mark["text"])) for mark in found)
    doubtful = tuple(
        (status.label, result.status == status)
        for status in Status
        if status not in (Status.ok, Status.dead_centre)  # the latter is a mark
        and status.has_solution
        and bool((result.status == status).any())
    )
    return Picture(title, x, panels, is_plane, along, marks, result.solved, doubtful)


def _in_plane(
    drawn: Sequence[Curve], against: Curve | None
) -> tuple[tuple[Curve, ...], tuple[Curve, ...]]:
    """Vectors by the two components in which they spread most, all by the same."""
    numbers = [curve.label for curve in drawn if not curve.is_vector]
    if numbers or against is not None:
        other = numbers[0] if numbers or against is None else against.label
        vector = next(curve.label for curve in drawn if curve.is_vector)
        raise UsageError(
            f"{vector} is a vector, which is drawn in a plane of its own, without {other}; "
            "for curves over a column write its components: .x, .y or .z"
        )
    units = {curve.unit for curve in drawn}
    if len(units) > 1:
        found = " and ".join(sorted(units))
        raise UsageError(f"vectors in {found} do not go into one plane; draw them one by one")
    first, second = _widest(np.concatenate([curve.values for curve in drawn]))
    parts = [
        tuple(
            Curve(f"{curve.label}.{COMPONENTS[k]}", curve.unit, curve.values[:, k])
            for curve in drawn
        )
        for k in (first, second)
    ]
    return parts[0], parts[1]


def _widest(values: NDArray[np.float64]) -> tuple[int, int]:
    """The two components with the widest spread, in order; those without a number last. A vector
    of a plane has two."""
    spreads = [_spread(component) for component in values.T]
    ranked = sorted(range(len(spreads)), key=lambda k: -spreads[k])
    first, second = sorted(ranked[:2])
    return first, second


def _spread(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else -1.0
