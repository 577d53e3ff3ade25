"""What an equilibrium is: stable, unstable, marginal or indifferent, by its stiffness; its lowest
natural frequency.

The stiffness is a tensor there, since the forces vanish: its signs do not depend on the coordinates
that are named. Loads that have no potential leave it unsymmetric; then the real parts of its
eigenvalues decide, and only that the equilibrium does not creep away is told.
"""

from __future__ import annotations

from enum import Enum
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics.newton import search
from mechkin_cli.statics.places import Place, Statics, eigen, mass, stiffness

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Stability(Enum):
    """Whether an equilibrium comes back after a small push."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    MARGINAL = "marginal"
    INDIFFERENT = "indifferent"
    UNKNOWN = "not known"


class Verdict(NamedTuple):
    """Of one equilibrium: its stability, the least stiffness (N*m by kernel units), its error, the
    direction (free,) of it, the lowest natural frequency (1/s; nan where it is not stable, or
    nothing has a mass), the largest entry of the stiffness, and whether that is unsymmetric."""

    stability: Stability
    least: float
    error: float
    direction: Floats
    frequency: float
    size: float = 0.0
    unsymmetric: bool = False


def judged(statics: Statics, place: Place, time: float, largest: float) -> Verdict:
    """The verdict on an equilibrium, the largest force of one load being known."""
    count = statics.count
    found = stiffness(statics, place, time)
    if found is None:
        return Verdict(Stability.UNKNOWN, np.nan, np.nan, np.zeros(count), np.nan)
    matrix = found.matrix
    size = float(np.max(np.abs(matrix)))
    error = found.error + tolerances.MARGINAL_STIFFNESS * max(size, largest)
    off = float(np.max(np.abs(matrix - matrix.T)))
    unsymmetric = off > tolerances.UNSYMMETRIC_STIFFNESS * max(size, largest)
    symmetric = 0.5 * (matrix + matrix.T)
    values, vectors = eigen(symmetric)
    least, direction = float(values[0]), vectors[:, 0]
    if unsymmetric:
        # the least real part of the eigenvalues: above it nothing creeps away
        least = float(np.min(np.linalg.eigvals(matrix).real))
    stability = Stability.MARGINAL
    if least > error:
        stability = Stability.STABLE
    elif least < -error:
        stability = Stability.UNSTABLE
    elif _is_indifferent(statics, place, direction, time):
        stability = Stability.INDIFFERENT
    frequency = np.nan
    if stability is Stability.STABLE and not unsymmetric:
        frequency = _lowest_frequency(symmetric, mass(statics, place, time))
    return Verdict(stability, least, error, direction, frequency, size, unsymmetric)


def _is_indifferent(statics: Statics, place: Place, direction: Floats, time: float) -> bool:
    """Whether loads balance along a motion without stiffness, to both sides."""
    reach = tolerances.INDIFFERENT_REACH * np.array([-1.0, -0.5, 0.5, 1.0])
    for by in reach:
        inputs = np.stack([place.inputs, place.inputs], axis=1)
        inputs[statics.free, 1] += by * direction
        way = statics.way(inputs, place)
        if way.reached < 2:
            return False
        there = Place(inputs[:, 1], way.states[:, 1], way.turns[:, 1])
        again = search(statics, there, time)
        moved = again.place.inputs[statics.free] - place.inputs[statics.free]
        if not again.found or abs(float((moved * direction).sum()) / by - 1.0) > 0.5:
            return False
    return True


def _lowest_frequency(matrix: Floats, masses: Floats) -> float:
    """The lowest natural frequency (1/s) of a stable place; nan where nothing has a mass.

    The largest eigenvalue of K^-1 M is 1/omega^2: massless motions have none.
    """
    values, vectors = eigen(matrix)
    if not values[0] > 0.0:
        return np.nan
    scaled = vectors / np.sqrt(values)
    count = values.size
    inner = np.zeros((count, count))
    for i in range(count):
        for j in range(count):
            inner[i, j] = float((scaled[:, i] * (masses * scaled[:, j]).sum(axis=1)).sum())
    most = float(eigen(0.5 * (inner + inner.T))[0][-1])
    if not most > tolerances.EQUILIBRIUM_BALANCE * float(np.max(np.abs(masses))) / values[-1]:
        return np.nan
    return 1.0 / (2.0 * pi * sqrt(most))
