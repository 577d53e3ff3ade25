"""How many freedoms a part of a mechanism has from a place: to first order, and in truth.

The assembled places next to a place form components of some dimensions that meet there. The motions
of first order are as many as the largest where the place is regular; else directions come from the
bifurcation equations, and two moves in one heading lead to a place of one component, where moves
along every motion of first order are closed again: the rank of the chords is the dimension.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.bifurcation import apart_numbers, directions, quadratic_forms
from mechkin_cli.analysis.mobility.closed import Closed, Sphere, closed
from mechkin_cli.analysis.mobility.rank import Rank, rank_of

if TYPE_CHECKING:
    from mechkin_cli.analysis.mobility.parts import Part
    from mechkin_cli.arrays import Floats
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


@dataclass(frozen=True)
class Freedom:
    """Freedoms of a part from a place.

    `first` is the rank there; `components` are those found to meet there, one for each dimension,
    the largest first; `doubt` says in words why the answer is not clear, else it is empty.
    """

    first: Rank
    components: tuple[Component, ...]
    doubt: str = ""

    @property
    def dimensions(self) -> tuple[int, ...]:
        """Dimensions of the components, the largest first."""
        return tuple(component.dimension for component in self.components)


class Move(NamedTuple):
    """A move by its largest step (rad, parts of the size), and how far loops that are closed after
    it may be open."""

    step: float
    limit: float


MOVES = tuple(Move(*each) for each in tolerances.MOBILITY_MOVES)
FAR_MOVE = Move(*tolerances.MOBILITY_FAR_MOVE)


class _Unclear(Exception):
    """Chords or ranks do not agree."""


class _Nearly(_Unclear):
    """Loops stay all but closed: the `least` that they are open by is small."""

    def __init__(self, least: float, move: Move) -> None:
        super().__init__(
            f"{move.step:g} away the loops are open by {least:.2g} of the size, limit {move.limit:g}"
        )
        self.least = least


def freedom_of(
    part: Part, state: Floats, random: RandomStarts, *, regular: bool = False
) -> Freedom:
    """The freedoms of a part from an assembled place `state` (states,); if only `regular` places
    are wanted, others are a doubt."""
    _, jacobians = part.closing(state[None])
    first = rank_of(jacobians[0], tolerances.RANK_ZERO)
    if not first.clear:
        return Freedom(first, (), first.doubt)
    if first.motions.shape[1] == 0:
        return Freedom(first, (Component(0, state, first.motions, 0.0),))
    component = _regular(part, state, first, random)
    if component is not None:
        return Freedom(first, (component,))
    return (
        Freedom(first, (), "a special position")
        if regular
        else _singular(part, state, first, random)
    )


def _regular(part: Part, state: Floats, first: Rank, random: RandomStarts) -> Component | None:
    """The component if it has as many dimensions as there are motions of first order, so that there
    is but one; None else."""
    motions = first.motions
    heading = _scaled(_units(random, 1, motions.shape[1]) @ motions.T)
    both = np.repeat(state[None], 2, axis=0)
    for move in MOVES:
        wanted = move.step * np.concatenate([heading, -heading])
        there = closed(part, part.moved(both, wanted))
        strayed = _lengths(part.steps(there.states, both) - wanted)
        kept = there.good(move.limit) & (strayed < tolerances.MOBILITY_STRAYED * _lengths(wanted))
        for place in there.states[kept]:
            try:
                found = _general(part, place, random, move)
            except _Unclear:
                continue
            return found if found.dimension == motions.shape[1] else None
    return None


def _singular(part: Part, state: Floats, first: Rank, random: RandomStarts) -> Freedom:
    """The components that meet where the first order has more motions than any of them."""
    forms = quadratic_forms(part, state, first.motions, first.stresses)
    alone = part.alone(state, first.motions)
    headings = directions(forms, alone, random) @ first.motions.T
    headings = _scaled(headings)
    try:
        try:
            found = _components(part, state, headings, MOVES[0], random)
        except _Nearly as near:
            most = tolerances.MOBILITY_GROWTH * near.least
            found = _components(part, state, headings, FAR_MOVE, random, most)
        except _Unclear:
            found = _components(part, state, headings, MOVES[1], random)
    except _Unclear as unclear:
        return Freedom(first, (), str(unclear))
    if len(found) > 1 and found[0].dimension == first.motions.shape[1]:
        found = found[1:]  # with as many as to first order the place would be regular
    return Freedom(first, found or (Component(0, state, first.motions[:, :0], 0.0),))


def _components(
    part: Part,
    state: Floats,
    headings: Floats,
    move: Move,
    random: RandomStarts,
    nearly: float = tolerances.MOBILITY_OPEN,
) -> tuple[Component, ...]:
    """Components that two moves along `headings` (number, columns) lead to, one of each dimension,
    the largest first.

    Raises:
        _Unclear: none has a clear dimension, or no loops are closed, but some open by less than
            `nearly`.
    """
    if not len(headings):
        return ()
    ways = move.step * headings
    starts = part.moved(np.repeat(state[None], len(ways), axis=0), ways)
    there = closed(part, starts, Sphere(state, _lengths(ways)))
    least = float(there.misses.min())
    if move.limit <= least < nearly:
        raise _Nearly(least, move)
    known: dict[int, list[Component]] = {}
    doubt = _Unclear("a second move does not close") if least < move.limit else None
    for place in _onward(part, state, there, move):
        try:
            found = _general(part, place, random, move)
        except _Unclear as unclear:
            doubt = unclear
            continue
        known.setdefault(found.dimension, []).append(found)
    if doubt and not known:
        raise doubt
    return tuple(
        replace(known[k][0], places=tuple(component.state for component in known[k]))
        for k in sorted(known, reverse=True)
    )


def _onward(part: Part, state: Floats, there: Closed, move: Move) -> Floats:
    """Places (number, states) to which another move in the same heading leads, from some of those
    that closed, which are far from each other."""
    places = there.states[there.good(move.limit)]
    ways = part.steps(places, np.repeat(state[None], len(places), axis=0))
    units = ways / _lengths(ways)[:, None]
    some = apart_numbers(units, tolerances.MOBILITY_PLACES)
    places, ways = places[some], ways[some]
    on = closed(part, part.moved(places, ways))
    far = _lengths(part.steps(on.states, places)) > 0.5 * _lengths(ways)
    return np.asarray(on.states[on.good(move.limit) & far])


def _general(part: Part, state: Floats, random: RandomStarts, move: Move) -> Component:
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
        ways = move.step * _scaled(units)
        ways = np.concatenate([part_of * ways for part_of in tolerances.MOBILITY_CHORDS])
        ends = closed(part, part.moved(np.repeat(place[None], len(ways), axis=0), ways))
        if not ends.good(move.limit).all():
            raise _Unclear("moves do not close again")
        ranks = [
            rank_of(jacobian, tolerances.MOBILITY_RANK_REACHED).motions.shape[1]
            for jacobian in ends.jacobians
        ]
        if min(ranks) == count:
            dimension, tangents = _chords(part, place, ends, ways, move)
            if not dimension:
                raise _Unclear(f"{move.step:g} away nothing can move")
            if not _is_smooth(part, place, tangents, move, _frame(random, dimension)):
                raise _Unclear("several motions meet wherever it goes")
            if dimension == count:
                return Component(count, place, motions, tolerances.RANK_ZERO)
            return Component(dimension, place, tangents, tolerances.MOBILITY_CHORD_DOUBT)
        place = ends.states[int(np.argmin(ranks))]
    raise _Unclear("the rank changes from place to place")


def _chords(
    part: Part, place: Floats, ends: Closed, ways: Floats, move: Move
) -> tuple[int, Floats]:
    """Dimension and steps (columns, dimension) of the component at a place, from the `ends` of
    moves along `ways` (number, columns), which are all motions of first order at two lengths."""
    chords = part.steps(ends.states, np.repeat(place[None], len(ways), axis=0))
    chords /= _lengths(ways)[:, None]
    seen = []
    for some in np.split(chords, len(tolerances.MOBILITY_CHORDS)):
        _, values, right = np.linalg.svd(some, full_matrices=False)
        low, high = tolerances.MOBILITY_CHORD_RANK
        if np.any((values > low) & (values < high)):
            raise _Unclear(f"chords have singular values between {low:g} and {high:g}")
        seen.append((int(np.count_nonzero(values >= high)), right))
    (dimension, _), (again, right) = seen
    if dimension != again:
        raise _Unclear(f"chords of two lengths have the ranks {dimension} and {again}")
    return dimension, right[:dimension].T


def _is_smooth(part: Part, place: Floats, tangents: Floats, move: Move, frame: Floats) -> bool:
    """Whether moves along the `tangents` (columns, dimension), mixed by a `frame`, go where they
    are meant to: they would not where several components meet, whose chords count together."""
    ways = move.step * tolerances.MOBILITY_CHORDS[0] * _scaled((tangents @ frame).T)
    both = np.repeat(place[None], len(ways), axis=0)
    ends = closed(part, part.moved(both, ways))
    strayed = _lengths(part.steps(ends.states, both) - ways)
    return bool(
        np.all(ends.good(move.limit) & (strayed < tolerances.MOBILITY_STRAYED * _lengths(ways)))
    )


def _lengths(ways: Floats) -> Floats:
    """Lengths (number,) of steps (number, columns)."""
    return np.asarray(np.sqrt(np.sum(ways * ways, axis=1)))


def _scaled(ways: Floats) -> Floats:
    """Steps (number, columns) whose largest is one."""
    return np.asarray(ways / np.abs(ways).max(axis=1, initial=0.0, keepdims=True))


def _units(random: RandomStarts, number: int, size: int) -> Floats:
    found = random.between(1.0, number * size).reshape(number, size)
    return np.asarray(found / np.sqrt(np.sum(found * found, axis=1))[:, None])


def _frame(random: RandomStarts, size: int) -> Floats:
    """A random orthonormal frame (size, size)."""
    return np.asarray(np.linalg.qr(random.between(1.0, size * size).reshape(size, size))[0])
