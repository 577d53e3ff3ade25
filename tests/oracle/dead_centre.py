"""The dead centre of a branch by Newton's method on the bordered system.

At a fold the closure g(q, x) = 0 has a direction v with (dg/dq) v = 0. Unknown are q, the input x
and v, with v normalised against its first guess. Second derivatives along two directions come from
series: D2[v, w] = (c2(v + w) - c2(v - w)) / 2, c2(u) the coefficient of t^2 of g along u.
"""

from __future__ import annotations

from typing import Any

from oracle.closure import Closure, State
from oracle.kinematics import Guess, jacobian, solve
from oracle.mechanism import Mechanism
from oracle.numerics import Number, UnsolvableError, linear_solve, mp
from oracle.series import coefficient
from oracle.vectors import scale

_MOST_STEPS = 40
_LONGEST_STEP = mp.mpf(1) / 5


def fold(mechanism: Mechanism, coordinate: str, guess: Guess) -> tuple[Number, dict[str, Any]]:
    """The input value at the dead centre near a guess, and the coordinates there.

    `guess` is near a position close to the fold, the input included; other inputs are not
    supported. Raises `UnsolvableError` where Newton's method does not converge.
    """
    closure = Closure(mechanism)
    start = solve(mechanism, {coordinate: (guess[coordinate], 1)}, guess)
    values = {n: v for n, v in start.coordinates.items() if n in closure.names}
    rotations = {n[:-9]: v for n, v in start.coordinates.items() if n.endswith(".rotation")}
    state = closure.start(values, rotations)
    names = [*(n for n in closure.names if n != coordinate), coordinate]
    v = _tangent(closure, state, names)
    border = list(v)
    for _ in range(_MOST_STEPS):
        step = _newton_step(closure, state, names, v, border)
        largest = max(abs(x) / closure.scale_of(n) for n, x in zip(names, step, strict=False))
        if largest > _LONGEST_STEP:
            step = scale(step, _LONGEST_STEP / largest)
        moved = dict(state.values)
        for name, change in zip(names, step, strict=False):
            moved[name] += change
        state = State(moved, state.rotations)
        v = [a + b for a, b in zip(v, step[len(names) :], strict=True)]
        if largest < mp.mpf(10) ** (-0.6 * mp.dps):
            break
    else:
        raise UnsolvableError("Newton's method found no dead centre near the guess")
    x = state.values[coordinate]
    state = closure.rebased(state)
    found = state.values | {f"{name}.rotation": r for name, r in state.rotations.items()}
    return x, found


def _tangent(closure: Closure, state: State, names: list[str]) -> list[Number]:
    """The unknowns' rates for a unit rate of the input, scaled to length one."""
    matrix = jacobian(closure, state, names)
    rates = linear_solve([row[:-1] for row in matrix], [-row[-1] for row in matrix])
    return scale(rates, 1 / mp.sqrt(mp.fsum(x * x for x in rates)))


def _along(closure: Closure, state: State, direction: dict[str, Number]) -> list[list[Number]]:
    """Coefficients of 1, t and t^2 of every equation along a direction."""
    higher = {name: [value] for name, value in direction.items()}
    equations = closure.residual(closure.series(state, higher, 2), state)
    return [[coefficient(e, k) for k in range(3)] for e in equations]


def _newton_step(
    closure: Closure, state: State, names: list[str], v: list[Number], border: list[Number]
) -> list[Number]:
    count = len(v)
    direction = dict(zip(names, v, strict=False))
    here = _along(closure, state, direction)
    first = jacobian(closure, state, names)
    second = []
    for name in names:
        more, less = dict(direction), dict(direction)
        more[name] = more.get(name, mp.zero) + 1
        less[name] = less.get(name, mp.zero) - 1
        forward, backward = _along(closure, state, more), _along(closure, state, less)
        second.append([(a[2] - b[2]) / 2 for a, b in zip(forward, backward, strict=True)])
    matrix, right = [], []
    for i, (value, slope, _) in enumerate(here):
        matrix.append([*first[i], *[mp.zero] * count])
        right.append(-value)
        matrix.append([*(column[i] for column in second), *first[i][:-1]])
        right.append(-slope)
    matrix.append([mp.zero] * len(names) + border)
    right.append(1 - mp.fsum(a * b for a, b in zip(border, v, strict=True)))
    return linear_solve(matrix, right)
