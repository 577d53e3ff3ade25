"""scipy row by row on 4x4 matrices: root finders over their tolerances, differences for rates."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.benchmark.measurement import Method
from mechkin_cli.benchmark.row_by_row import Gap, RowByRow, Solve

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene, Values
    from mechkin_cli.show import Floats


FAMILY = "scipy"
TOLERANCES = tuple(10.0**-k for k in (2, 5, 8, 14))
STEPS = tuple(10.0**-k for k in (2, 3, 4, 5))
"""Of the differences: how far inputs move between two positions (rad, m)."""


def methods(scene: Scene) -> Iterator[Method]:
    """`fsolve` (`least_squares` where equations are more than unknowns), and differences."""
    from scipy.optimize import fsolve, least_squares

    rows = RowByRow(scene)

    def by_fsolve(tolerance: float, gap: Gap, start: Floats) -> Floats:
        with warnings.catch_warnings():  # that a tolerance is not met is seen in the error
            warnings.simplefilter("ignore", RuntimeWarning)
            found: Floats = fsolve(gap, start, xtol=tolerance)
        return found

    def by_least_squares(tolerance: float, gap: Gap, start: Floats) -> Floats:
        at = max(tolerance, float(np.finfo(float).eps))
        found: Floats = least_squares(gap, start, method="lm", xtol=at, ftol=at, gtol=at).x
        return found

    solvers = {"least_squares": by_least_squares}
    if rows.is_square:
        solvers = {"fsolve": by_fsolve, **solvers}
    for name, solver in solvers.items():
        for tolerance in TOLERANCES[:: 3 if rows.is_long else 1]:
            call = partial(rows.values, partial(solver, tolerance), rows.inputs)
            yield _method(name, f"{tolerance:.0e}", "position", call, rows)
    best = solvers["fsolve" if rows.is_square else "least_squares"]
    if rows.rates.any() and not rows.is_long:
        for step in STEPS:
            call = partial(differences, rows, partial(best, TOLERANCES[-1]), step)
            yield _method(
                f"{next(iter(solvers))}, differences", f"{step:.0e}", "motion", call, rows
            )


def differences(rows: RowByRow, solve: Solve, step: float) -> Values:
    """Velocities and accelerations from three positions a row, whose inputs are `step` apart."""
    time = step / float(np.max(np.abs(rows.rates)))
    before, here, after = (
        rows.values(solve, rows.inputs + t * rows.rates + 0.5 * t * t * rows.accelerations)
        for t in (-time, 0.0, time)
    )
    asked, found = rows.scene.asked, dict(here)
    for name, first, second in zip(asked.position, asked.velocity, asked.acceleration, strict=True):
        found[first] = (after[name] - before[name]) / (2.0 * time)
        found[second] = (after[name] - 2.0 * here[name] + before[name]) / (time * time)
    return found


def _method(
    curve: str, setting: str, level: str, call: Callable[[], Values], rows: RowByRow
) -> Method:
    return Method(FAMILY, curve, setting, level, call, rows.scene.rows, call, slow=True)
