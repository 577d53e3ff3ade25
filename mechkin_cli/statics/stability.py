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
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import eliminated
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics.forces import Forces, ForcesAt, FreePlace, summed
from mechkin_cli.statics.newton import Balancing, Search, SearchEnd, search
from mechkin_cli.statics.places import eigen

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Stability(Enum):
    """Whether an equilibrium comes back after a small push."""

    STABLE = "stable"
    UNSTABLE = "unstable"
    MARGINAL = "marginal"
    INDIFFERENT = "indifferent"
    FLUTTERS = "unstable by flutter"
    HELD = "held by friction"
    UNKNOWN = "not known"


class Verdict(NamedTuple):
    """Of one equilibrium: its stability, the independent coordinates (freedoms,) there in kernel
    units, the least stiffness by them (N*m by kernel units; nan where they do not move one by one)
    and the coordinate that has most of its motion, the lowest natural frequency (1/s; nan where it
    is not stable, or nothing has a mass), the largest force or stiffness of one load (kernel
    units), and whether the stiffness is unsymmetric."""

    stability: Stability
    coordinates: Floats
    least: float
    along: int
    frequency: float
    size: float = 0.0
    unsymmetric: bool = False


def judged(balancing: Balancing, found: Search) -> Verdict:
    """The verdict on an equilibrium that was found."""
    forces, place = balancing.forces, found.place
    coordinates, rates = balancing.named(place)
    # of one freedom it is known which way no push comes back
    beside = _FOLDED if forces.freedoms == 1 else np.zeros((forces.freedoms, 0))
    derivative, inertia, near = forces.stiffness_and_inertia(place, beside)
    matrix, nothing = derivative.matrix, np.nan
    if not np.isfinite(matrix).all():
        return Verdict(Stability.UNKNOWN, coordinates, nothing, 0, nothing)
    size = max(float(np.max(np.abs(matrix))), found.largest)
    error = derivative.error + tolerances.MARGINAL_STIFFNESS * size
    off = float(np.max(np.abs(matrix - matrix.T)))
    unsymmetric = off > tolerances.UNSYMMETRIC_STIFFNESS * size
    symmetric = 0.5 * (matrix + matrix.T)
    values, vectors = eigen(symmetric)
    least, direction = float(values[0]), vectors[:, 0]
    if unsymmetric:
        # above the least real part of the eigenvalues nothing creeps away
        creeping = _kernel.eigen(np.ascontiguousarray(matrix))
        assert creeping is not None
        least = float(np.min(creeping[0]))
    stability = Stability.MARGINAL
    if not unsymmetric and abs(least) > error:
        if forces.freedoms > 1:
            near = forces.at(place, direction[:, None] * _FOLDED)
        error = max(error, _fold_stiffness(near, direction, size))
    if least > error:
        stability = Stability.STABLE
    elif least < -error:
        stability = Stability.UNSTABLE
    elif _is_indifferent(balancing, place, direction):
        stability = Stability.INDIFFERENT
    if unsymmetric and stability is Stability.STABLE and _flutters(forces, place, matrix):
        stability = Stability.FLUTTERS
    frequency = nothing
    if stability is Stability.STABLE and not unsymmetric:
        frequency = _lowest_frequency(symmetric, inertia)
    along = int(np.argmax(np.abs(summed(rates.T * direction[:, None]))))
    named = _in_coordinates(symmetric, rates)
    length = forces.session.layout.length
    by_coordinates = nothing if named is None else length * length * float(eigen(named)[0][0])
    return Verdict(stability, coordinates, by_coordinates, along, frequency, size, unsymmetric)


def held(balancing: Balancing, place: FreePlace) -> tuple[Search, Verdict]:
    """A place at which the loads do not balance and friction holds the mechanism, and its
    verdict: neither stiffness nor frequencies are told there."""
    forces = balancing.forces.at(place, np.zeros((balancing.forces.freedoms, 1)))
    largest = float(balancing.largest(FreePlace.many([place]))[0])
    coordinates, _ = balancing.named(place)
    found = Search(place, forces.forces[:, 0], largest, SearchEnd.FOUND, 0)
    verdict = Verdict(Stability.HELD, coordinates, np.nan, 0, np.nan, largest)
    return found, verdict


_FOLDED = np.array([[-1.0, 0.0, 1.0]]) * tolerances.NEWTON_DIFFERENCE
"""Steps from a place by which it is told from a fold."""


def _fold_stiffness(near: ForcesAt, direction: Floats, size: float) -> float:
    """The stiffness up to which a place is not told from a fold, from the forces near it in a
    direction.

    Along this the force is k u + c u^2 / 2 about the place: it vanishes again at -2 k / c, and
    between both it comes to k^2 / (2 c). Where that balances to rounding, the place may be where k
    is zero.
    """
    if not near.good.all():
        return 0.0
    before, here, behind = (float(summed(direction * near.forces[:, k])) for k in range(3))
    bend = abs(before - 2.0 * here + behind) / tolerances.NEWTON_DIFFERENCE**2
    return sqrt(2.0 * bend * tolerances.EQUILIBRIUM_BALANCE * size)


def _in_coordinates(matrix: Floats, rates: Floats) -> Floats | None:
    """A stiffness by coordinates whose rates (coordinates, freedoms) along the chart are known:
    N^-T K N^-1; None at a dead centre of one."""
    count = rates.shape[0]
    columns = []
    for k in range(count):
        unit = [float(k == i) for i in range(count)]
        solved = eliminated(rates.tolist(), unit, tolerances.RANK_ZERO)
        if solved is None or not max(map(abs, solved)) < tolerances.DEAD_COORDINATE:
            return None
        columns.append(np.array(solved))
    product = np.array(
        [[float(summed(a * summed(matrix.T * b[:, None]))) for b in columns] for a in columns]
    )
    symmetric: Floats = 0.5 * (product + product.T)
    return symmetric


def _is_indifferent(balancing: Balancing, place: FreePlace, direction: Floats) -> bool:
    """Whether loads balance along a motion without stiffness, to both sides."""
    forces = balancing.forces
    reach = tolerances.INDIFFERENT_REACH * np.array([-1.0, -0.5, 0.5, 1.0])
    beside = forces.at(place, direction[:, None] * reach)
    for number in range(reach.size):
        if not beside.good[number]:
            return False
        again = search(balancing, forces.moved(place, beside, number))
        if not again.found:
            return False
        moved = again.place.state - place.state
        wanted = beside.states[:, number] - place.state
        if np.max(np.abs(moved - wanted)) > 0.5 * np.max(np.abs(wanted)):
            return False
    return True


def _flutters(forces: Forces, place: FreePlace, matrix: Floats) -> bool:
    """Whether a small motion grows that does not creep: an eigenvalue of M s^2 + D s + K has a real
    part above zero. Motions without mass do not flutter; where some have none, nothing is told."""
    count = forces.freedoms
    masses, damping = forces.inertia(place), forces.damping(place).matrix
    if not float(np.min(eigen(masses)[0])) > tolerances.MASSLESS * float(np.max(np.abs(masses))):
        return False
    system = np.zeros((2 * count, 2 * count))
    system[:count, count:] = np.eye(count)
    for column in range(count):
        for block, part in ((0, matrix), (count, damping)):
            right = (-part[:, column]).tolist()
            solved = eliminated(masses.tolist(), right, tolerances.MASSLESS)
            if solved is None or not np.isfinite(solved).all():
                return False
            system[count:, block + column] = solved
    # rates in parts of what the stiffness makes of them
    pace = sqrt(float(np.max(np.abs(system[count:, :count]))))
    if not pace > 0.0:
        return False
    system[count:, :count] /= pace
    system[:count, count:] *= pace
    values = _kernel.eigen(np.ascontiguousarray(system))
    return values is not None and float(np.max(values[0])) > tolerances.FLUTTER * pace


def _lowest_frequency(matrix: Floats, masses: Floats) -> float:
    """The lowest natural frequency (1/s) of a stable place; nan where nothing has a mass.

    The largest eigenvalue of K^-1 M is 1/omega^2: massless motions have none.
    """
    values, vectors = eigen(matrix)
    scaled = vectors / np.sqrt(values)
    inner = np.array(
        [[float(summed(a * summed(masses.T * b[:, None]))) for b in scaled.T] for a in scaled.T]
    )
    most = float(eigen(0.5 * (inner + inner.T))[0][-1])
    heaviest = float(np.max(np.abs(masses)))
    if not most > tolerances.EQUILIBRIUM_BALANCE * heaviest / values[-1] or not heaviest > 0.0:
        return np.nan
    return 1.0 / (2.0 * pi * sqrt(most))
