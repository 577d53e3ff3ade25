"""Boxes about the rows of a sweep that hold the true positions, found by Krawczyk's operator with
the kernel's equations and derivatives; sums in plain doubles, which is enough for tests."""

from __future__ import annotations

from typing import Any

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.proofs.enclose import EnclosedInputs, Positions


def boxes_of(session: Any, given: EnclosedInputs, states: np.ndarray) -> Positions:
    """Of the session's rows with their inputs and states (states, rows)."""
    constants = session.precise.enclosed_constants(session)
    plan = session.plan.with_constants(np.ascontiguousarray(constants[:, 0]))
    rows = states.shape[1]
    boxes = Positions(plan, constants, np.ascontiguousarray(states), np.zeros((plan.columns, rows)))
    unknown = [session.layout.column(k, f) for b in session.graph.blocks for k, f in b.unknowns]
    radius = np.stack([_radius(boxes, given, row, unknown) for row in range(rows)], axis=1)
    return boxes._replace(radius=np.ascontiguousarray(radius))


def _radius(boxes: Positions, given: EnclosedInputs, row: int, unknown: list[int]) -> np.ndarray:
    """Radii (columns,) of a box with exactly one solution; fails where none is found."""
    point = np.zeros(boxes.plan.columns)
    equations, derivatives = evaluated(boxes, given, row, point)
    inverse = np.linalg.pinv(derivatives[:, unknown, 0])
    image = np.abs(inverse) @ np.abs(equations).sum(axis=1)
    radius = 2.0 * image + 1e-22
    for _ in range(8):
        point[unknown] = radius
        _, derivatives = evaluated(boxes, given, row, point)
        middle, *width = derivatives[:, unknown].transpose(2, 0, 1)
        rest = np.abs(np.eye(len(unknown)) - inverse @ middle) + np.abs(inverse) @ np.abs(
            width
        ).sum(axis=0)
        found = image + rest @ radius
        if (found < radius).all():
            return point
        radius = 2.0 * found
    raise AssertionError(f"no box about row {row}")


def evaluated(
    boxes: Positions, given: EnclosedInputs, row: int, radius: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Equations (equations, 3) and derivatives (equations, columns, 3) over a row's box."""
    count = boxes.plan.equations
    equations = np.empty((3 * count, 1))
    derivatives = np.empty((3 * count * boxes.plan.columns, 1))
    low, radii = (np.ascontiguousarray(boxes.constants[:, part]) for part in (1, 2))
    _kernel.enclose(
        boxes.plan,
        low=low,
        radii=radii,
        states=np.ascontiguousarray(boxes.states[:, [row]]),
        inputs=np.ascontiguousarray(given.inputs[:, :, [row]].reshape(-1, 1)),
        radius=np.ascontiguousarray(radius[:, None]),
        equations=equations,
        derivatives=derivatives,
    )
    return equations.reshape(count, 3), derivatives.reshape(count, -1, 3)
