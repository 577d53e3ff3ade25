"""Positions by Newton's method on the whole closure; rates by its Taylor series in time.

With q(t) = q0 + q1 t + q2 t^2 + ..., the coefficient of t^k of the closure is J q_k + (terms of
lower q), J the derivative by the unknowns: every order is one linear system with the same matrix. J
itself is taken column by column from series of order one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracle.closure import Closure, Pose, State
from oracle.mechanism import Mechanism
from oracle.numerics import Number, UnsolvableError, linear_solve, mp
from oracle.series import derivatives
from oracle.vectors import Matrix, add, apply, axial, product, transpose

Inputs = Mapping[str, Sequence[Any]]
Guess = Mapping[str, Any]

_ORDER = 3
_MOST_STEPS = 60
_LONGEST_STEP = mp.mpf(1) / 2
_CLOSE = mp.mpf(1) / 100
_SUFFIXES = ("", "_dot", "_ddot", "_dddot")


@dataclass(frozen=True)
class Solution:
    """A position with three derivatives in time, all in the base units and ground axes.

    `coordinates` has every `J.theta`, `J.s` with its `_dot`, `_ddot`, `_dddot`, and `J.rotation` of
    an S (the second link's turn against the first, a matrix); it serves as a guess of another
    solve.
    """

    mechanism: Mechanism
    inputs: tuple[str, ...]
    coordinates: dict[str, Any]
    poses: dict[str, Pose]
    misfit: Number

    def __getitem__(self, name: str) -> Any:
        return self.coordinates[name]

    def rotation(self, link: str) -> list[Matrix]:
        """R and its three derivatives; x of the home drawing is at R x + p."""
        entries = [[derivatives(x, _ORDER) for x in row] for row in self.poses[link][0]]
        return [[[x[k] for x in row] for row in entries] for k in range(_ORDER + 1)]

    def motion(self, link: str, place: Sequence[Number]) -> list[list[Number]]:
        """Position, velocity, acceleration, jerk of a link's point, `place` in the home drawing."""
        rotation, shift = self.poses[link]
        moved = [derivatives(x, _ORDER) for x in add(apply(rotation, place), shift)]
        return [list(values) for values in zip(*moved, strict=True)]

    def point(self, name: str) -> list[list[Number]]:
        """Position, velocity, acceleration and jerk of a named point of the file."""
        return self.motion(*self.mechanism.points[name])

    def direction(self, name: str) -> list[Number]:
        link, vector = self.mechanism.directions[name]
        return apply(self.rotation(link)[0], vector)

    def joint_point(self, name: str) -> list[Number]:
        """`J.point`, carried by the second link; the sphere of Sp and Sg is the first link's."""
        joint = self.mechanism.joints[name]
        if joint.type in ("Sp", "Sg"):
            return self.motion(joint.first, joint.points[0])[0]
        return self.motion(joint.second, joint.points[1])[0]

    def joint_axis(self, name: str) -> list[Number]:
        """The axis, normal or groove of the second link; of a U `axis2`."""
        joint = self.mechanism.joints[name]
        if joint.axes is None:
            raise ValueError(f"{name} has no axis")
        return apply(self.rotation(joint.second)[0], joint.axes[1])

    def omega(self, link: str) -> list[Number]:
        """Angular velocity: the axial vector of R' R^T."""
        r, r1 = self.rotation(link)[:2]
        return axial(product(r1, transpose(r)))

    def alpha(self, link: str) -> list[Number]:
        """Angular acceleration: R'' R^T + R' R'^T, whose second term is symmetric."""
        r, _, r2 = self.rotation(link)[:3]
        return axial(product(r2, transpose(r)))


def solve(mechanism: Mechanism, inputs: Inputs, guess: Guess | None = None) -> Solution:
    """The position nearest (in Newton's sense) to a guess, and its rates.

    `inputs` maps the driven coordinates to (value, rate, acceleration, jerk), what is left out
    being 0; `guess` maps other coordinates to values, zero if left out. Raises `UnsolvableError`
    where Newton's method does not converge, or the inputs leave the motion undetermined.
    """
    closure = Closure(mechanism)
    driven = {n: [mp.mpf(x) for x in (*v, *[0] * 4)[:4]] for n, v in inputs.items()}
    unknown = [name for name in closure.names if name not in driven]
    values = {n: mp.mpf(v) for n, v in (guess or {}).items() if n in unknown}
    rotations = {n[:-9]: v for n, v in (guess or {}).items() if n.endswith(".rotation")}
    state = closure.start(values | {n: v[0] for n, v in driven.items()}, rotations)
    try:
        state = _assemble(closure, state, unknown)
    except ZeroDivisionError:
        raise UnsolvableError("the guess leaves a loop open by exactly half a turn") from None
    higher = _rates(closure, state, unknown, driven)
    series = closure.series(state, higher, _ORDER)
    return Solution(
        mechanism,
        tuple(driven),
        _coordinates(mechanism, series, state),
        closure.poses(series, state),
        closure.misfit(state),
    )


def jacobian(closure: Closure, state: State, names: Sequence[str]) -> list[list[Number]]:
    """The derivative of the closure by the named coordinates."""
    columns = []
    for name in names:
        q = closure.series(state, {name: [mp.one]}, 1)
        columns.append(closure.coefficients(q, state, 1))
    return transpose(columns)


def _assemble(closure: Closure, state: State, unknown: Sequence[str]) -> State:
    enough, least = mp.mpf(10) ** (-0.6 * mp.dps), mp.mpf(10) ** (-0.9 * mp.dps)
    largest, age = mp.inf, 0
    matrix: list[list[Number]] = []
    for _ in range(_MOST_STEPS):
        # near the solution a matrix serves for three steps: an evaluation costs a sixth of one
        age = age + 1 if largest < _CLOSE and age < 2 else 0
        if age == 0:
            matrix = jacobian(closure, state, unknown)
        residual = closure.coefficients(state.values, state, 0)
        step = linear_solve(matrix, [-r for r in residual])
        scaled = (abs(c) / closure.scale_of(n) for n, c in zip(unknown, step, strict=True))
        largest = max(scaled, default=mp.zero)
        # long steps leap to other branches
        factor = min(mp.one, _LONGEST_STEP / largest) if largest else mp.one
        values = dict(state.values)
        for name, change in zip(unknown, step, strict=True):
            values[name] += factor * change
        state = closure.rebased(State(values, state.rotations))
        if largest < (enough if age == 0 else least):
            break
    misfit = closure.misfit(state)
    if misfit > mp.mpf(10) ** (-0.75 * mp.dps):
        raise UnsolvableError(f"not assembled: the loops are open by {mp.nstr(misfit, 3)}")
    return state


def _rates(
    closure: Closure, state: State, unknown: Sequence[str], driven: dict[str, list[Number]]
) -> dict[str, list[Number]]:
    """The Taylor coefficients of t, t^2, t^3 of all coordinates."""
    higher = {n: [v[k] / mp.factorial(k) for k in range(1, 4)] for n, v in driven.items()}
    higher |= {name: [] for name in unknown}
    matrix = jacobian(closure, state, unknown)
    for order in range(1, _ORDER + 1):
        residual = closure.coefficients(closure.series(state, higher, order), state, order)
        step = linear_solve(matrix, [-r for r in residual])
        for name, value in zip(unknown, step, strict=True):
            higher[name].append(value)
    return higher


def _coordinates(mechanism: Mechanism, series: dict[str, Any], state: State) -> dict[str, Any]:
    found: dict[str, Any] = {f"{name}.rotation": r for name, r in state.rotations.items()}
    for name, joint in mechanism.joints.items():
        for coordinate in joint.coordinates:
            full = f"{name}.{coordinate}"
            if joint.type == "H" and coordinate == "s":
                q = series[f"{name}.theta"] * (joint.lead / (2 * mp.pi))
            else:
                q = series[full]
            found |= {full + s: x for s, x in zip(_SUFFIXES, derivatives(q, _ORDER), strict=True)}
    return found


def sweep(mechanism: Mechanism, steps: int = 1) -> list[Solution]:
    """All rows of the file's motion, each guessed from the one before by its velocities.

    The first row starts from `assembly: near`, or else from the home drawing, reached in `steps`
    steps.
    """
    rows = [mechanism.row(i) for i in range(mechanism.rows)]
    guess: dict[str, Any] = dict(mechanism.near)
    if not guess:
        for k in range(steps):
            part = {n: (v[0] * k / steps, *v[1:]) for n, v in rows[0].items()}
            guess = predicted(solve(mechanism, part, guess), rows[0])
    solutions: list[Solution] = []
    for row in rows:
        if solutions:
            guess = predicted(solutions[-1], row)
        solutions.append(solve(mechanism, row, guess))
    return solutions


def predicted(last: Solution, inputs: Inputs) -> dict[str, Any]:
    """Coordinates moved by velocity * time, the time that the first moving input takes."""
    time = mp.zero
    for name, law in inputs.items():
        if last[name + "_dot"] != 0:
            time = (law[0] - last[name]) / last[name + "_dot"]
            break
    names = [n for n in last.coordinates if n.endswith((".theta", ".s"))]
    return last.coordinates | {n: last[n] + last[n + "_dot"] * time for n in names}


def condition(mechanism: Mechanism, solution: Solution) -> float:
    """Largest over smallest singular value of the closure's derivative, lengths by the size."""
    closure = Closure(mechanism)
    values = {n: v for n, v in solution.coordinates.items() if n in closure.names}
    rotations = {n[:-9]: v for n, v in solution.coordinates.items() if n.endswith(".rotation")}
    state = closure.start(values, rotations)
    unknown = [name for name in closure.names if name not in solution.inputs]
    matrix = jacobian(closure, state, unknown)
    rows = [mechanism.size if i % 6 >= 3 else mp.one for i in range(len(matrix))]
    scaled = [
        [float(x / r * closure.scale_of(n)) for x, n in zip(line, unknown, strict=True)]
        for line, r in zip(matrix, rows, strict=True)
    ]
    values_ = np.linalg.svd(np.array(scaled), compute_uv=False)
    return float(values_[0] / values_[-1])
