"""Positions and rates of mechanisms of any structure at 60 digits.

Newton's method on all constraints with the pseudo-inverse of their matrix in double precision:
residuals have 60 digits, so each step wins the digits that the matrix has, whatever their number.
The same matrix solves every order of the Taylor series in time. Redundant equations that agree and
idle spins (`oracle.idle`) are no obstacle; a motion that is not determined is.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from oracle.bodies import Bodies, Placement, joint_names
from oracle.idle import Leg, legs, line, spin_rate
from oracle.kinematics import Solution
from oracle.mechanism import Mechanism
from oracle.numerics import Number, UnsolvableError, mp
from oracle.pairs import coordinates
from oracle.series import Series, coefficient, derivatives

_ORDER = 3
_MOST_STEPS = 60
_LONGEST_STEP = 0.5
_SETTLED = 1e-4
"""A step below which the matrix is kept: every further step wins four digits and more."""
_RANK = 1e-10
_SUFFIXES = ("", "_dot", "_ddot", "_dddot")


class Matrix:
    """The scaled derivative of all equations in double precision, and its pseudo-inverse."""

    def __init__(self, bodies: Bodies, placement: Placement, inputs: Mapping[str, Any]) -> None:
        self.size = bodies.mechanism.size
        rows, self.lengths = bodies.jacobian(placement, inputs)
        count = len(bodies.mechanism.links)
        # Rodrigues parameters are half of angles
        units = [mp.one / 2] * 3 + [self.size] * 3
        self.units = units * count
        self.array = np.array(
            [
                [
                    float(x * u / (self.size if length else 1))
                    for x, u in zip(row, self.units, strict=True)
                ]
                for row, length in zip(rows, self.lengths, strict=True)
            ]
        )
        self.extra = np.zeros((0, bodies.width))

    def scaled(self, values: list[Number]) -> np.ndarray:
        """Values of the equations in parts of the size."""
        pairs = zip(values, self.lengths, strict=True)
        return np.array([float(v / self.size if length else v) for v, length in pairs])

    def invert(self) -> np.ndarray:
        return np.linalg.pinv(np.vstack([self.array, self.extra]), rcond=_RANK)

    @cached_property
    def condition(self) -> float:
        """Infinite where rows or rank are missing."""
        values = np.linalg.svd(np.vstack([self.array, self.extra]), compute_uv=False)
        enough = len(values) == len(self.units) and values[-1] > _RANK * values[0]
        return float(values[0] / values[-1]) if enough else float("inf")


def assemble(
    mechanism: Mechanism,
    inputs: Mapping[str, Any],
    guess: Solution | None = None,
    placement: Placement | None = None,
) -> Solution:
    """The position nearest (in Newton's sense) to a guess, and its rates.

    `inputs` maps the driven coordinates to (value, rate, acceleration, jerk), what is left out
    being 0. Without a guess Newton's method starts from the drawing. Raises `UnsolvableError` where
    it does not converge, or the inputs leave more than idle spins undetermined.
    """
    bodies = Bodies(mechanism)
    driven = {n: [mp.mpf(x) for x in (*v, *[0] * 4)[:4]] for n, v in inputs.items()}
    if guess is not None:
        placement = _placement(bodies, guess)
    start = placement or bodies.drawing()
    placement = _positions(bodies, start, {n: v[0] for n, v in driven.items()})
    steps = _rates(bodies, placement, driven)
    poses = bodies.poses(placement, steps)
    found: dict[str, Any] = {}
    for name, angles in placement.angles.items():
        values = coordinates(bodies.pair(name, poses), angles)
        for full in joint_names(mechanism.joints[name], name):
            rates = derivatives(values[full.rpartition(".")[2]], _ORDER)
            found |= {full + s: x for s, x in zip(_SUFFIXES, rates, strict=True)}
    return Solution(mechanism, tuple(driven), found, poses, misfit(bodies, placement))


def misfit(bodies: Bodies, placement: Placement) -> Number:
    """The largest joint equation, lengths in parts of the size."""
    poses, size = bodies.poses(placement, {}), bodies.mechanism.size
    found = bodies.equations(placement, poses, {})
    return max(abs(e.value) / (size if e.length else 1) for e in found)


def condition_of(mechanism: Mechanism, solution: Solution) -> float:
    """Largest over smallest singular value of all constraints, lengths by the size.

    The unknowns are turns and displacements of all links, so it does not depend on how loops are
    cut. Idle spins are held.
    """
    bodies = Bodies(mechanism)
    values = {name: solution[name] for name in solution.inputs}
    return _matrix(bodies, _placement(bodies, solution), values).condition


def drawn_condition(mechanism: Mechanism) -> float:
    """`condition_of` an assembled drawing; infinite where its motion is not determined."""
    bodies = Bodies(mechanism)
    try:
        return _matrix(bodies, bodies.drawing(), dict.fromkeys(mechanism.inputs, mp.zero)).condition
    except UnsolvableError:
        return float("inf")


def assemble_rows(mechanism: Mechanism, steps: int = 1) -> list[Solution]:
    """All rows of the file's motion, each guessed from the one before by its velocities.

    The first row is reached from an assembled drawing in `steps` equal steps of all inputs.
    """
    rows = [mechanism.row(i) for i in range(mechanism.rows)]
    path = [{n: (v[0] * k / steps, *v[1:]) for n, v in rows[0].items()} for k in range(1, steps)]
    solutions: list[Solution] = []
    placement = None
    for row in [*path, *rows]:
        if solutions:
            placement = _towards(solutions[-1], row)
        solutions.append(assemble(mechanism, row, placement=placement))
    return solutions[len(path) :]


def _towards(last: Solution, inputs: Mapping[str, Any]) -> Placement:
    """Where the links are when all inputs move straight from their last values to others."""
    bodies = Bodies(last.mechanism)
    here = _placement(bodies, last)
    course = {n: [last[n], v[0] - last[n], mp.zero, mp.zero] for n, v in inputs.items()}
    series = bodies.poses(here, _rates(bodies, here, course, 1))
    poses = {}
    for link, (rotation, shift) in series.items():
        along = [[coefficient(x, 0) + coefficient(x, 1) for x in v] for v in (*rotation, shift)]
        poses[link] = along[:3], along[3]
    return bodies.placed(poses, here.angles)


def _placement(bodies: Bodies, solution: Solution) -> Placement:
    poses = {
        link: ([[coefficient(x, 0) for x in row] for row in r], [coefficient(x, 0) for x in p])
        for link, (r, p) in solution.poses.items()
    }
    angles = {
        name: {c: solution[f"{name}.{c}"] for c in joint.coordinates}
        for name, joint in bodies.mechanism.joints.items()
    }
    return bodies.placed(poses, angles)


def _positions(bodies: Bodies, placement: Placement, inputs: dict[str, Number]) -> Placement:
    inverse, step, matrix = np.zeros(0), np.inf, None
    for _ in range(_MOST_STEPS):
        if matrix is None or step > _SETTLED:
            matrix = Matrix(bodies, placement, inputs)
            inverse = matrix.invert()
        found = bodies.equations(placement, bodies.poses(placement, {}), inputs)
        change = -inverse @ matrix.scaled([e.value for e in found])
        step = float(np.max(np.abs(change)))
        change *= min(1.0, _LONGEST_STEP / step) if step else 1.0
        moves = [mp.mpf(x) * u for x, u in zip(change.tolist(), matrix.units, strict=True)]
        placement = bodies.moved(placement, moves)
        if step < 10.0 ** (-0.9 * mp.dps):
            break
    _check(bodies, placement)
    return placement


def _check(bodies: Bodies, placement: Placement) -> None:
    gap = misfit(bodies, placement)
    if gap > mp.mpf(10) ** (-0.8 * mp.dps):
        raise UnsolvableError(f"not assembled: the joints are open by {mp.nstr(gap, 3)}")
    poses = bodies.poses(placement, {})
    for name in bodies.mechanism.joints:
        if any(side <= 0 for side in bodies.pair(name, poses).sides()):
            raise UnsolvableError(f"{name} is assembled the wrong way round")


def _matrix(bodies: Bodies, placement: Placement, inputs: Mapping[str, Any]) -> Matrix:
    """With one row per idle leg that holds its spin."""
    matrix = Matrix(bodies, placement, inputs)
    poses = bodies.poses(placement, {})
    names = list(bodies.mechanism.links)
    rows = []
    for leg in legs(bodies.mechanism):
        row = np.zeros(bodies.width)
        for link in leg.links:
            # two parameters make an angle, half a parameter is its unit
            first = 6 * names.index(link)
            row[first : first + 3] = [float(x / matrix.size) for x in line(bodies, leg, poses)]
        rows.append(row)
    if rows:
        matrix.extra = np.array(rows)
    if matrix.condition == np.inf:
        raise UnsolvableError("the inputs do not determine the motion")
    return matrix


def _spin(bodies: Bodies, leg: Leg, poses: Any, order: int) -> float:
    """What the unknowns of an order have to make zero, the leg's line in parts of the size."""
    rate = coefficient(spin_rate(bodies, leg, poses, order), order - 1)
    return float(rate / (order * bodies.mechanism.size))


def _rates(
    bodies: Bodies, placement: Placement, driven: dict[str, list[Number]], last: int = _ORDER
) -> dict[str, list[Any]]:
    """The Taylor series of all unknowns up to t^last, by link."""
    matrix = _matrix(bodies, placement, {n: v[0] for n, v in driven.items()})
    inverse = matrix.invert()
    idle = legs(bodies.mechanism)
    taylor = [[mp.zero] for _ in range(bodies.width)]
    for order in range(1, last + 1):
        inputs = {
            n: Series(v[k] / mp.factorial(k) for k in range(order + 1)) for n, v in driven.items()
        }
        for entry in taylor:
            entry.append(mp.zero)
        first = None
        for _ in range(_MOST_STEPS):
            steps = [Series(entry) for entry in taylor]
            split = {k: steps[6 * i : 6 * i + 6] for i, k in enumerate(bodies.mechanism.links)}
            poses = bodies.poses(placement, split)
            found = bodies.equations(placement, poses, inputs)
            values = matrix.scaled([coefficient(e.value, order) for e in found])
            spins = [_spin(bodies, leg, poses, order) for leg in idle]
            change = -inverse @ np.concatenate([values, spins])
            for entry, x, u in zip(taylor, change.tolist(), matrix.units, strict=True):
                entry[order] += mp.mpf(x) * u
            largest = float(np.max(np.abs(change)))
            first = first or largest
            if largest <= max(first * 10.0 ** (-0.85 * mp.dps), 10.0 ** (8 - mp.dps)):
                break
        else:
            raise UnsolvableError("redundant constraints disagree about the rates")
    series = [Series(entry) for entry in taylor]
    return {k: series[6 * i : 6 * i + 6] for i, k in enumerate(bodies.mechanism.links)}
