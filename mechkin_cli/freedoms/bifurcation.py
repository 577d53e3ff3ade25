"""Directions in which a mechanism may leave a place: the bifurcation equations.

A curve of assembled places with the tangent N a at its start (N the motions of first order) obeys
W^T D2F[N a, N a] = 0 for all stresses W, as many quadratic forms in a as there are stresses. They
are solved for directions from random ones; forms say nothing along their common null space, the
radical, and are solved beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.freedoms.closed import damped_steps

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.parts import Part
    from mechkin_cli.solver.random_starts import RandomStarts


def quadratic_forms(part: Part, state: Floats, motions: Floats, stresses: Floats) -> Floats:
    """Independent forms (forms, k, k) on `motions` (columns, k) at a place with `stresses`
    (rows, r): derivatives of the Jacobian by central differences."""
    step, count = tolerances.MOBILITY_DIFFERENCE, motions.shape[1]
    ways = step * np.concatenate([motions.T, -motions.T])
    _, jacobians = part.closing(part.moved(np.repeat(state[None], 2 * count, axis=0), ways))
    second = (jacobians[:count] - jacobians[count:]) / (2.0 * step) @ motions
    forms = np.einsum("rs,irj->sij", stresses, second)
    forms = 0.5 * (forms + np.swapaxes(forms, 1, 2))
    _, values, right = np.linalg.svd(forms.reshape(len(forms), -1), full_matrices=False)
    rank = int(np.count_nonzero(values > tolerances.MOBILITY_FORM))
    return np.asarray(right[:rank].reshape(rank, count, count))


def directions(forms: Floats, alone: Floats, random: RandomStarts) -> Floats:
    """Unit directions (directions, k) in which all forms (forms, k, k) vanish, either way: beside
    their radical, far from each other where there are many, and in it.

    Motions `alone` (k, count), which move single links only, are no part of them but in some: they
    would hide the others.
    """
    count = forms.shape[1]
    _, values, right = np.linalg.svd(forms.reshape(-1, count), full_matrices=True)
    rank = int(np.count_nonzero(values > tolerances.MOBILITY_FORM))
    beside, radical = right[:rank], right[rank:]
    shared = _less(radical, alone)
    solved = apart(_zeros(beside @ forms @ beside.T, random), tolerances.MOBILITY_HEADINGS)
    found = [solved @ beside]
    if len(shared):
        found.append((found[0] + _units(random, len(solved), len(shared)) @ shared) * np.sqrt(0.5))
        found.append(_units(random, tolerances.MOBILITY_FREE_HEADINGS, len(shared)) @ shared)
    if len(shared) < len(radical):
        found.append(_units(random, tolerances.MOBILITY_LONE_HEADINGS, len(radical)) @ radical)
    every = np.concatenate(found)
    return np.concatenate([every, -every])


def _less(rows: Floats, columns: Floats) -> Floats:
    """Orthonormal rows of what the span of some rows has square to some columns."""
    if not columns.shape[1] or not len(rows):
        return rows
    taken = np.linalg.qr(columns)[0]
    _, values, right = np.linalg.svd(rows - (rows @ taken) @ taken.T, full_matrices=False)
    return np.asarray(right[values > 0.5])


def _zeros(forms: Floats, random: RandomStarts) -> Floats:
    """Unit vectors (found, k) at which all forms vanish, by Gauss and Newton from random ones."""
    count = forms.shape[1]
    if count == 0:
        return np.zeros((0, 0))
    at = _units(random, tolerances.MOBILITY_DIRECTIONS, count)
    for _ in range(tolerances.MOBILITY_ITERATIONS):
        misses = _values(forms, at)
        if np.abs(misses).max() < tolerances.MOBILITY_TIGHT:
            break
        slopes = 2.0 * np.einsum("fij,dj->dfi", forms, at)
        along = np.zeros((len(at), 1))  # no step along the vector, whose length is one
        at = at + damped_steps(
            np.concatenate([slopes, at[:, None]], axis=1), np.concatenate([misses, along], axis=1)
        )
        at /= np.sqrt(np.sum(at * at, axis=1))[:, None]
    solved = np.abs(_values(forms, at)).max(axis=1) < tolerances.MOBILITY_CLOSED
    return np.asarray(at[solved])


def _values(forms: Floats, at: Floats) -> Floats:
    """Values (directions, forms) of the forms."""
    return np.asarray(np.einsum("di,fij,dj->df", at, forms, at))


def _units(random: RandomStarts, number: int, size: int) -> Floats:
    """Random unit vectors (number, size)."""
    found = random.between(1.0, number * size).reshape(number, size)
    return np.asarray(found / np.sqrt(np.sum(found * found, axis=1))[:, None])


def apart(vectors: Floats, most: int) -> Floats:
    """Some of many unit vectors (number, size), each as far from those before as any is."""
    return np.asarray(vectors[apart_numbers(vectors, most)])


def apart_numbers(vectors: Floats, most: int) -> list[int]:
    """Their numbers."""
    if not len(vectors):
        return []
    chosen, nearest = [0], vectors @ vectors[0]
    while len(chosen) < most:
        further = int(np.argmin(nearest))
        if nearest[further] > 1.0 - tolerances.MOBILITY_SAME_DIRECTION:
            break
        chosen.append(further)
        nearest = np.maximum(nearest, vectors @ vectors[further])
    return chosen
