"""Closing loops from many places at once, by Levenberg and Marquardt's steps.

A step is that of Gauss and Newton, damped by the square of what the loops are open: quadratic
where the equations bound the distance, however many of them are redundant (Yamashita, Fukushima
2001), and halving where they touch their solutions. Steps are solved by QR of the Jacobian above
the damping, so that the Jacobian's condition is not squared.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.parts import Part


class Sphere(NamedTuple):
    """Places whose steps from a `centre` (states,) have lengths, `radii` (places,)."""

    centre: Floats
    radii: Floats


class Closed(NamedTuple):
    """States (places, states), how far (places,) their loops are open, Jacobians there."""

    states: Floats
    misses: Floats
    jacobians: Floats

    def good(self, limit: float) -> NDArray[np.bool_]:
        """Places whose loops are open by less than a limit."""
        return self.misses < limit


def closed(part: Part, starts: Floats, sphere: Sphere | None = None) -> Closed:
    """The assembled places next to `starts` (places, states), on a sphere if one is given."""
    states = starts.copy()
    places = len(states)
    best = Closed(
        states.copy(), np.full(places, np.inf), np.zeros((places, part.rows.size, part.count))
    )
    stuck = np.zeros(places, dtype=np.intp)
    active = np.arange(places)
    for _ in range(tolerances.MOBILITY_ITERATIONS):
        misses, jacobians = part.closing(states[active])
        largest = np.abs(misses).max(axis=1, initial=0.0)
        if sphere is not None:
            misses, matrix, off = _on_sphere(
                part, states[active], misses, jacobians, Sphere(sphere.centre, sphere.radii[active])
            )
        else:
            matrix, off = jacobians, np.zeros(active.size)
        whole = np.maximum(largest, np.where(off > tolerances.MOBILITY_SPHERE, off, 0.0))
        stuck[active] += np.where(whole < 0.9 * best.misses[active], 0, 1)
        better = whole < best.misses[active]
        chosen = active[better]
        best.states[chosen] = states[chosen]
        best.misses[chosen] = whole[better]
        best.jacobians[chosen] = jacobians[better]
        rounding = np.where(whole < tolerances.MOBILITY_NEAR, 1, tolerances.MOBILITY_STUCK)
        going = (whole >= tolerances.MOBILITY_TIGHT) & (stuck[active] <= rounding)
        active, misses, matrix = active[going], misses[going], matrix[going]
        if not active.size:
            break
        states[active] = part.moved(states[active], damped_steps(matrix, misses))
    return best


def _on_sphere(
    part: Part, states: Floats, misses: Floats, jacobians: Floats, sphere: Sphere
) -> tuple[Floats, Floats, Floats]:
    """Misses and Jacobians with the sphere's equation, and how far off it the places are."""
    ways = part.steps(states, np.broadcast_to(sphere.centre, states.shape))
    off = (np.sum(ways * ways, axis=1) / sphere.radii - sphere.radii) / 2.0
    row = ways / sphere.radii[:, None]
    return (
        np.concatenate([misses, off[:, None]], axis=1),
        np.concatenate([jacobians, row[:, None]], axis=1),
        np.abs(off),
    )


def damped_steps(jacobians: Floats, misses: Floats) -> Floats:
    """Damped steps (places, columns), none longer than the stride."""
    places, _, columns = jacobians.shape
    damping = np.sqrt(np.sum(misses * misses, axis=1))
    damping = np.maximum(damping, tolerances.MOBILITY_DAMPING)
    above = np.concatenate([jacobians, -misses[:, :, None]], axis=2)
    below = np.zeros((places, columns, columns + 1))
    below[:, np.arange(columns), np.arange(columns)] = damping[:, None]
    triangle = np.asarray(np.linalg.qr(np.concatenate([above, below], axis=1), mode="r"))
    steps = np.linalg.solve(triangle[:, :columns, :columns], triangle[:, :columns, columns:])
    found = steps[:, :, 0]
    longest = np.abs(found).max(axis=1, initial=0.0)
    too_long = np.maximum(longest / tolerances.MOBILITY_STRIDE, 1.0)
    return np.asarray(found / too_long[:, None])
