"""Extreme cases, each against an independent solution in many digits.

Sizes from micrometres to thousands of kilometres: scaling all lengths changes no error. Positions
up to 1e-10 degrees from the dead centre: at the distance d (rad) the condition grows as
1 / sqrt(d); one rounding of the data moves the position by eps * condition, and as rates grow with
the condition, velocities lose eps * condition^2 of themselves; accelerations and loads follow them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmark.accuracy import errors
from benchmark.arithmetic import Arithmetic, best
from benchmark.closure import dead_centre, drawing
from benchmark.exact import ExactSpecimen, rcsr_specimen, sevenr_specimen
from benchmark.kernel_case import sweep_rows
from benchmark.specimen import values

from benchmarks.rcsr import SPAN, dimensions
from mechkin_cli.analysis.analysis import Analysis
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.model.model import loads
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

SIZES = tuple(10.0**k for k in range(-6, 7))
"""Factors on all lengths; at 1 the mechanism is about 9 m long."""

DISTANCES = tuple(10.0**-k for k in range(11))
"""Distances to the dead centre, degrees."""

SIZE_ROWS = 5
NEAR_DEAD_CENTRE = {"theta1": 3.58, "theta2": -1.03, "s": -8.9, "theta4": -2.2}
"""A guess of the dead centre at scale 1, rad and m."""

EPSILON = 2.0**-53
OTHER_BRANCH = "on the other branch"

_ERRORS = (
    ReportColumn("position", "error:\nposi-\ntion", "error"),
    ReportColumn("velocity", "velo-\ncity", "error"),
    ReportColumn("acceleration", "acceler-\nation", "error"),
    ReportColumn("loads", "\nloads", "error"),
)
_VERDICT = (
    ReportColumn("residual", "resi-\ndual", "error"),
    ReportColumn("condition", "condi-\ntion", "error"),
    ReportColumn("status", "\nstatus"),
)


def tables() -> Iterator[ReportTable]:
    """Sizes of both mechanisms, and the dead centre."""
    arithmetic = best()
    yield size_table(rcsr_specimen, SIZES, arithmetic)
    yield size_table(sevenr_specimen, SIZES[::3], arithmetic)
    yield dead_centre_table(arithmetic)


def size_table(
    scaled: Callable[[float], ExactSpecimen], sizes: Sequence[float], arithmetic: Arithmetic
) -> ReportTable:
    """One row per size: worst errors of a sweep in parts of the columns' largest values."""
    rows: list[dict[str, Cell]] = []
    for scale in sizes:
        specimen = scaled(scale)
        theta1, names = sweep_rows(specimen, SIZE_ROWS), specimen.levels[2]
        text = specimen.text(values(theta1.tolist()))
        analysis = loads(text, specimen.name).analyze(names)
        solved = np.flatnonzero(np.isfinite(analysis[specimen.coordinates[-1]]))
        guess = _coordinates(specimen, analysis, solved)
        exact = specimen.row_by_row(theta1[solved], guess, arithmetic)
        found = {name: analysis[name][solved] for name in names}
        result = analysis.result
        rows.append(
            {
                "scale": scale,
                **vars(errors(specimen, found, exact)),
                "residual": float(np.max(result.residual[solved])),
                "condition": float(np.max(result.condition[solved])),
                "status": ", ".join(sorted({Status(int(c)).label for c in result.status})),
            }
        )
    notes = (f"{SIZE_ROWS} rows a size; exact: {arithmetic.name}, 4x4 matrices and dense loads.",)
    columns = (ReportColumn("scale", "\nsize", "error"), *_ERRORS, *_VERDICT)
    title = f"{specimen.name}: lengths times 1e-6 to 1e6"
    return ReportTable(f"sizes_{specimen.name.lower()}", title, columns, rows, notes)


def dead_centre_table(arithmetic: Arithmetic) -> ReportTable:
    """One row per distance: errors of that position in parts of its own values."""
    specimen = rcsr_specimen()
    fold = dead_centre(drawing(dimensions(), arithmetic), NEAR_DEAD_CENTRE)
    theta1 = [float(sweep_rows(specimen, 2)[0])]
    theta1 += [float(fold.theta1 - arithmetic.radians(1) * distance) for distance in DISTANCES]
    analysis = loads(specimen.text(values(theta1)), "rcsr").analyze(specimen.levels[2])
    rows: list[dict[str, Cell]] = [
        _position_row(specimen, analysis, i, float(theta1[i]), float(fold.theta4), arithmetic)
        | {"distance": distance}
        for i, distance in enumerate(DISTANCES, 1)
    ]
    degrees = float(fold.theta1 * 180 / arithmetic.radians(180))
    columns = (
        ReportColumn("distance", "\ndegrees", "error"),
        *_ERRORS,
        ReportColumn("share", "of\neps c", "ratio"),
        *_VERDICT,
    )
    notes = (
        f"dead centre at {degrees:.13f} degrees; one sweep from {SPAN[0]:g}",
        f"exact: {arithmetic.name}; eps c: 2^-53 times the condition (one rounding).",
    )
    return ReportTable("dead_centre", "RCSR towards the dead centre", columns, rows, notes)


def _position_row(
    specimen: ExactSpecimen,
    analysis: Analysis,
    i: int,
    theta1: float,
    theta4_of_fold: float,
    arithmetic: Arithmetic,
) -> dict[str, Cell]:
    result = analysis.result
    row: dict[str, Cell] = {"status": Status(int(result.status[i])).label}
    if not np.isfinite(analysis["O4.theta"][i]):
        return row
    one = np.array([i])
    exact = specimen.row_by_row([theta1], _coordinates(specimen, analysis, one), arithmetic)
    found = errors(specimen, {name: analysis[name][one] for name in specimen.levels[2]}, exact)
    if analysis["O4.theta"][i] <= theta4_of_fold:
        row["status"] = f"{row['status']}, {OTHER_BRANCH}"
    condition = float(result.condition[i])
    share = None if found.position is None else found.position / (EPSILON * condition)
    return row | {
        **vars(found),
        "share": share,
        "residual": float(result.residual[i]),
        "condition": condition,
    }


def _coordinates(specimen: ExactSpecimen, analysis: Analysis, rows: NDArray[np.intp]) -> list[Any]:
    return [analysis[name][rows] for name in specimen.coordinates]
