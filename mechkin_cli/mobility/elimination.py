"""Long rows of loops, eliminated one after the other: damped steps and ranks at the cost of the
loops that hang together, not of the cube of all.

Loops that share joints are sorted into bands: a loop, those that share a joint with it, those that
share one with these, and so on. A freedom is eliminated once all loops that pass it have been
added; the freedoms that later loops pass, too, stay with a triangle of equations, the front (I. S.
Duff, J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, 1983;
by QR, so that the condition is not squared). Some freedoms more than one loop has go in each step,
so that its work outweighs its calls.

`regular_motions` tells the motions that loops allow without a dense factorisation, where the loops
are independent of each other by far: those that damped steps from random rates end at, by inverse
iteration, and beside them the next singular values. Where these are not clear there is no answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats

    Numbers = NDArray[np.intp]


class FrontStep(NamedTuple):
    """Equations `rows` that are added to a front; its columns, of which the first `ended` are
    eliminated; where among them are those of the front `before`, and those that are `new`."""

    rows: Numbers
    columns: Numbers
    ended: int
    before: Numbers
    new: Numbers


class Fronts:
    """How the equations of loops are eliminated.

    Args:
        passing: which columns each loop passes (loops, columns).
        rows: the equations of each loop.
    """

    def __init__(self, passing: NDArray[np.bool_], rows: Sequence[Numbers]) -> None:
        self.count = int(passing.shape[1])
        self.steps: list[FrontStep] = []
        order = _in_bands(passing)
        passed = [np.flatnonzero(passing[loop]).tolist() for loop in order]
        last = {column: place for place, own in enumerate(passed) for column in own}
        before: list[int] = []
        new: list[int] = []
        added: list[Numbers] = []
        for place, (loop, own) in enumerate(zip(order, passed, strict=True)):
            new += [column for column in own if column not in before and column not in new]
            added.append(rows[loop])
            front = [*before, *new]
            ready = [column for column in front if last[column] <= place]
            if len(ready) < tolerances.MOBILITY_FRONT and place + 1 < len(order):
                continue
            rest = [column for column in front if last[column] > place]
            at = {column: k for k, column in enumerate((*ready, *rest))}
            self.steps.append(
                FrontStep(
                    np.concatenate(added),
                    np.array([*ready, *rest], dtype=np.intp),
                    len(ready),
                    np.array([at[column] for column in before], dtype=np.intp),
                    np.array([at[column] for column in new], dtype=np.intp),
                )
            )
            before, new, added = rest, [], []

    @property
    def pays(self) -> bool:
        """Whether the fronts are so small that less is done than for all at once."""
        return 2 * max(len(step.columns) for step in self.steps) < self.count


def _in_bands(passing: NDArray[np.bool_]) -> list[int]:
    """The loops by how many joints lead to them from one at an end (Cuthill, McKee 1969)."""
    shared = passing.astype(np.float64)
    beside = [np.flatnonzero(row).tolist() for row in shared @ shared.T]

    def outward(start: int) -> list[int]:
        seen, front = {start}, [start]
        for loop in front:
            more = [other for other in beside[loop] if other not in seen]
            seen.update(more)
            front += more
        return front

    order: list[int] = []
    left = dict.fromkeys(range(len(passing)))
    while left:
        found = outward(outward(next(iter(left)))[-1])
        order += found
        for loop in found:
            left.pop(loop, None)
    return order


class DampedTriangle:
    """The triangle of Jacobians (places, rows, columns) above a damping (places,), with the right
    side of their `misses` (places, rows)."""

    def __init__(self, fronts: Fronts, jacobians: Floats, misses: Floats, damping: Floats) -> None:
        self.fronts, places = fronts, len(jacobians)
        # equations that nothing moves, as those out of a plane, ask for no step
        told = np.any(jacobians != 0.0, axis=(0, 2))
        self.parts: list[Floats] = []
        front = np.zeros((places, 0, 1))
        for step in fronts.steps:
            rows = step.rows[told[step.rows]]
            kept, width = front.shape[1], step.columns.size
            above = np.zeros((places, kept + rows.size + step.new.size, width + 1))
            above[:, :kept, step.before] = front[:, :, :-1]
            above[:, :kept, -1] = front[:, :, -1]
            own = slice(kept, kept + rows.size)
            above[:, own, :width] = jacobians[:, rows[:, None], step.columns]
            above[:, own, -1] = -misses[:, rows]
            above[:, kept + rows.size + np.arange(step.new.size), step.new] = damping[:, None]
            triangle = np.asarray(np.linalg.qr(above, mode="r"), dtype=np.float64)
            self.parts.append(triangle[:, : step.ended])
            front = triangle[:, step.ended : width, step.ended :]

    def solution(self) -> Floats:
        """The step (places, columns) that is least square with the damping."""
        right = [part[:, :, -1:] for part in self.parts]
        return self._backward(right)[:, :, 0]

    def normal_solution(self, right: Floats) -> Floats:
        """What the squares of the triangle map to some columns (places, columns, number)."""
        left = right.copy()
        halves: list[Floats] = []
        for step, part in zip(self.fronts.steps, self.parts, strict=True):
            own, rest = step.columns[: step.ended], step.columns[step.ended :]
            diagonal = np.swapaxes(part[:, :, : step.ended], 1, 2)
            half = np.asarray(np.linalg.solve(diagonal, left[:, own]), dtype=np.float64)
            left[:, rest] -= np.swapaxes(part[:, :, step.ended : -1], 1, 2) @ half
            halves.append(half)
        return self._backward(halves)

    def _backward(self, right: Sequence[Floats]) -> Floats:
        places, _, number = right[0].shape
        found = np.zeros((places, self.fronts.count, number))
        whole = zip(self.fronts.steps, self.parts, right, strict=True)
        for step, part, known in reversed(list(whole)):
            own, rest = step.columns[: step.ended], step.columns[step.ended :]
            known = known - part[:, :, step.ended : -1] @ found[:, rest]
            found[:, own] = np.linalg.solve(part[:, :, : step.ended], known)
        return found


def regular_motions(fronts: Fronts, jacobian: Floats, zero: float) -> Floats | None:
    """An orthonormal basis (columns, count) of the motions that a Jacobian (rows, columns) allows,
    where the equations that anything moves are independent, by singular values far above `zero` of
    the largest; None where that is not clear, or motions are so many that all at once is less."""
    told = np.any(jacobian != 0.0, axis=1)
    count = jacobian.shape[1] - int(np.count_nonzero(told))
    beside = tolerances.MOBILITY_VALUES_BESIDE
    if count < 0 or tolerances.MOBILITY_FEW_MOTIONS * (count + beside) > jacobian.shape[1]:
        return None
    size = jacobian.shape[1], count + beside
    random = RandomStarts()
    basis = np.linalg.qr(random.between(1.0, size[0] * size[1]).reshape(size))[0]
    largest = _largest_value(jacobian, basis)
    damping = np.array([tolerances.MOBILITY_DAMPING * largest])
    triangle = DampedTriangle(fronts, jacobian[None], np.zeros((1, len(jacobian))), damping)
    for _ in range(tolerances.MOBILITY_INVERSE_ITERATIONS):
        basis = np.linalg.qr(triangle.normal_solution(basis[None])[0])[0]
    _, values, right = np.linalg.svd(jacobian @ basis, full_matrices=False)
    # the least first; of the motions alone they are rounding
    values, right = values[::-1], right[::-1]
    if values[:count].max(initial=0.0) > tolerances.RANK_ROUNDING * size[0] * largest:
        return None
    if values[count] < tolerances.MOBILITY_SURELY_REGULAR * zero * largest:
        return None
    return np.asarray(basis @ right[:count].T)


def _largest_value(matrix: Floats, start: Floats) -> float:
    """The largest singular value, from below, by powers of some columns."""
    found = start
    for _ in range(tolerances.MOBILITY_INVERSE_ITERATIONS):
        found = np.linalg.qr(matrix.T @ (matrix @ found))[0]
    return float(np.linalg.svd(matrix @ found, compute_uv=False)[0])
