"""Explicit stepping, as programs of the literature have it: rates are integrated from row to row.

Euler's method moves each step by the rates at its start (a successive screw displacement); the
classical Runge-Kutta method takes four rates a step. No step closes the loops again, so that errors
grow along the sweep.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.benchmark.measurement import Method
from mechkin_cli.benchmark.methods import Unable
from mechkin_cli.benchmark.row_by_row import RowByRow

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene, Values
    from mechkin_cli.show import Floats


FAMILY = "stepping"
EULER_STEPS = (1, 4)
RUNGE_KUTTA_STEPS = (1, 2)
"""Steps between two rows."""

DIFFERENCE = 2.0**-18
"""Of the columns (rad, m): central differences leave its square, far below what steps leave."""

Rate = Callable[["Floats", dict[int, Any], "Floats"], "Floats"]


def methods(scene: Scene) -> Iterator[Method]:
    """Both methods over their steps."""
    rows = RowByRow(scene)
    if rows.is_long:
        raise Unable(f"{len(rows.unknowns)} unknowns at once: differences take too long in Python")
    plans = [("Euler's method", euler, n) for n in EULER_STEPS]
    plans += [("Runge-Kutta method", runge_kutta, n) for n in RUNGE_KUTTA_STEPS]
    for curve, rule, steps in plans:
        call = partial(stepped, rows, rule, steps)
        setting = f"{steps} a row"
        yield Method(FAMILY, curve, setting, "position", call, scene.rows, call, slow=True)


def stepped(rows: RowByRow, rule: Any, steps: int) -> Values:
    """Positions by name, stepped from row to row."""
    q, turned = rows.start.copy(), dict(rows.turned)
    q[rows.driven] = rows.inputs[:, 0]
    found, orientations = [q], [turned]
    for row in range(1, rows.inputs.shape[1]):
        part = (rows.inputs[:, row] - rows.inputs[:, row - 1]) / steps
        for _ in range(steps):
            q, turned = rows.rebased(q, turned)
            q = q + rule(rows, q, turned, part)
        found.append(q)
        orientations.append(turned)
    return rows.named(np.array(found).T, orientations)


def euler(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """One step that moves the inputs by `part`."""
    return slopes(rows, q, turned, part)


def runge_kutta(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """The same by the classical method of fourth order."""
    one = slopes(rows, q, turned, part)
    two = slopes(rows, q + 0.5 * one, turned, part)
    three = slopes(rows, q + 0.5 * two, turned, part)
    four = slopes(rows, q + three, turned, part)
    found: Floats = (one + 2.0 * two + 2.0 * three + four) / 6.0
    return found


def slopes(rows: RowByRow, q: Floats, turned: dict[int, Any], part: Floats) -> Floats:
    """How all coordinates move to first order where the inputs move by `part`."""
    moved = np.zeros_like(q)
    moved[rows.driven] = part

    def along(direction: Floats) -> Floats:
        ahead, behind = (rows.gap(q + s * direction, turned) for s in (DIFFERENCE, -DIFFERENCE))
        return (ahead - behind) / (2.0 * DIFFERENCE)

    columns = np.array([along(unit) for unit in np.eye(q.size)[rows.unknowns]]).T
    moved[rows.unknowns] = np.linalg.lstsq(columns, -along(moved), rcond=None)[0]
    return moved
