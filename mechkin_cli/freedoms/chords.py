"""The dimension of the assembled places about one of them, by moves that are closed again.

Moves along an orthonormal frame of the motions of first order go where they are meant to as far as
they lie in the component, else they fall back: the rank of the chords is its dimension. Two lengths
must agree, and moves in the span of the chords must go where they are meant to.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.freedoms.closed import Closed, closed
from mechkin_cli.freedoms.rank import rank_of

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.parts import Part
    from mechkin_cli.solver.random_starts import RandomStarts


@dataclass(frozen=True)
class Component:
    """A component of the assembled places: its dimension, a general place `state` (states,), and
    steps (columns, dimension) along it, known to `doubt`; `places` are more of its kind."""

    dimension: int
    state: Floats
    tangents: Floats
    doubt: float
    places: tuple[Floats, ...] = ()


class Move(NamedTuple):
    """A move by its largest step (rad, parts of the size), and how far loops that are closed after
    it may be open."""

    step: float
    limit: float


class Unclear(Exception):
    """Chords or ranks do not agree."""


def component_at(part: Part, state: Floats, random: RandomStarts, move: Move) -> Component:
    """The component at a place, or at one next to it where the rank is larger."""
    place = state
    for _ in range(tolerances.MOBILITY_TRIES):
        _, jacobians = part.closing(place[None])
        rank = rank_of(jacobians[0], tolerances.MOBILITY_RANK_REACHED)
        motions = rank.motions
        count = motions.shape[1]
        if count == 0 or rank.stresses.shape[1] == 0:
            return Component(count, place, motions, tolerances.RANK_ZERO)
        units = (motions @ _frame(random, count)).T
        ways = move.step * scaled(units)
        ways = np.concatenate([part_of * ways for part_of in tolerances.MOBILITY_CHORDS])
        ends = closed(part, part.moved(np.repeat(place[None], len(ways), axis=0), ways))
        if not ends.good(move.limit).all():
            raise Unclear("moves do not close again")
        ranks = [
            rank_of(jacobian, tolerances.MOBILITY_RANK_REACHED).motions.shape[1]
            for jacobian in ends.jacobians
        ]
        if min(ranks) == count:
            dimension, tangents = _chords(part, place, ends, ways, move)
            if not dimension:
                raise Unclear(f"{move.step:g} away nothing can move")
            if not _is_smooth(part, place, tangents, move, _frame(random, dimension)):
                raise Unclear("several motions meet wherever it goes")
            if dimension == count:
                return Component(count, place, motions, tolerances.RANK_ZERO)
            return Component(dimension, place, tangents, tolerances.MOBILITY_CHORD_DOUBT)
        place = ends.states[int(np.argmin(ranks))]
    raise Unclear("the rank changes from place to place")


def _chords(
    part: Part, place: Floats, ends: Closed, ways: Floats, move: Move
) -> tuple[int, Floats]:
    """Dimension and steps (columns, dimension) of the component at a place, from the `ends` of
    moves along `ways` (number, columns), which are all motions of first order at two lengths."""
    chords = part.steps(ends.states, np.repeat(place[None], len(ways), axis=0))
    chords /= lengths(ways)[:, None]
    seen = []
    for some in np.split(chords, len(tolerances.MOBILITY_CHORDS)):
        _, values, right = np.linalg.svd(some, full_matrices=False)
        low, high = tolerances.MOBILITY_CHORD_RANK
        if np.any((values > low) & (values < high)):
            raise Unclear(f"chords have singular values between {low:g} and {high:g}")
        seen.append((int(np.count_nonzero(values >= high)), right))
    (dimension, _), (again, right) = seen
    if dimension != again:
        raise Unclear(f"chords of two lengths have the ranks {dimension} and {again}")
    return dimension, right[:dimension].T


def _is_smooth(part: Part, place: Floats, tangents: Floats, move: Move, frame: Floats) -> bool:
    """Whether moves along the `tangents` (columns, dimension), mixed by a `frame`, go where they
    are meant to: they would not where several components meet, whose chords count together."""
    ways = move.step * tolerances.MOBILITY_CHORDS[0] * scaled((tangents @ frame).T)
    both = np.repeat(place[None], len(ways), axis=0)
    ends = closed(part, part.moved(both, ways))
    strayed = lengths(part.steps(ends.states, both) - ways)
    return bool(
        np.all(ends.good(move.limit) & (strayed < tolerances.MOBILITY_STRAYED * lengths(ways)))
    )


def lengths(ways: Floats) -> Floats:
    """Lengths (number,) of steps (number, columns)."""
    return np.asarray(np.sqrt(np.sum(ways * ways, axis=1)))


def scaled(ways: Floats) -> Floats:
    """Steps (number, columns) whose largest is one."""
    return np.asarray(ways / np.abs(ways).max(axis=1, initial=0.0, keepdims=True))


def _frame(random: RandomStarts, size: int) -> Floats:
    """A random orthonormal frame (size, size)."""
    return np.asarray(np.linalg.qr(random.between(1.0, size * size).reshape(size, size))[0])
