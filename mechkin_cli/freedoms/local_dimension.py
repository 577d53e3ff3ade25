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
from mechkin_cli.freedoms.bifurcation import apart_numbers, directions, quadratic_forms
from mechkin_cli.freedoms.chords import (
    Component,
    Move,
    Unclear,
    component_at,
    lengths,
    scaled,
)
from mechkin_cli.freedoms.closed import Closed, Sphere, closed
from mechkin_cli.freedoms.rank import Rank, rank_of

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.parts import Part
    from mechkin_cli.solver.random_starts import RandomStarts


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


MOVES = tuple(Move(*each) for each in tolerances.MOBILITY_MOVES)
FAR_MOVE = Move(*tolerances.MOBILITY_FAR_MOVE)


class _Nearly(Unclear):
    """Loops stay all but closed: the `least` that they are open by is small."""

    def __init__(self, least: float, move: Move) -> None:
        open_by = f"{least:.2g} of the size (limit {move.limit:g})"
        super().__init__(f"{move.step:g} away the loops are open by {open_by}")
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
    if regular:
        return Freedom(first, (), "a special position")
    if not first.stresses.shape[1]:
        # regular by its rank, but its moves do not show it: sizes too far apart for the numbers
        return Freedom(first, (), "no move along its motions closes the loops as they should")
    return _singular(part, state, first, random)


def _regular(part: Part, state: Floats, first: Rank, random: RandomStarts) -> Component | None:
    """The component if it has as many dimensions as there are motions of first order, so that there
    is but one; None else."""
    motions = first.motions
    heading = scaled(_units(random, 1, motions.shape[1]) @ motions.T)
    both = np.repeat(state[None], 2, axis=0)
    for move in MOVES:
        wanted = move.step * np.concatenate([heading, -heading])
        there = closed(part, part.moved(both, wanted))
        strayed = lengths(part.steps(there.states, both) - wanted)
        kept = there.good(move.limit) & (strayed < tolerances.MOBILITY_STRAYED * lengths(wanted))
        for place in there.states[kept]:
            try:
                found = component_at(part, place, random, move)
            except Unclear:
                continue
            return found if found.dimension == motions.shape[1] else None
    return None


class _Search(NamedTuple):
    """Places to be found from the place `state` (states,) of a part along `headings` (number,
    columns), whose largest steps are one; `most` of them are looked at."""

    part: Part
    state: Floats
    headings: Floats
    most: int
    random: RandomStarts


def _singular(part: Part, state: Floats, first: Rank, random: RandomStarts) -> Freedom:
    """The components that meet where the first order has more motions than any of them."""
    count = first.motions.shape[1]
    forms = quadratic_forms(part, state, first.motions, first.stresses)
    alone = part.alone(state, first.motions)
    headings = scaled(directions(forms, alone, random) @ first.motions.T)
    least, largest = tolerances.MOBILITY_PLACES
    most = min(max(tolerances.MOBILITY_WORK // count, least), largest)
    search = _Search(part, state, headings, most, random)
    try:
        try:
            found = _components(search, MOVES[0])
        except _Nearly as near:
            found = _components(search, FAR_MOVE, tolerances.MOBILITY_GROWTH * near.least)
        except Unclear:
            found = _components(search, MOVES[1])
    except Unclear as unclear:
        return Freedom(first, (), str(unclear))
    if len(found) > 1 and found[0].dimension == count:
        found = found[1:]  # with as many as to first order the place would be regular
    return Freedom(first, found or (Component(0, state, first.motions[:, :0], 0.0),))


def _components(
    search: _Search, move: Move, nearly: float = tolerances.MOBILITY_OPEN
) -> tuple[Component, ...]:
    """Components that two moves lead to, one of each dimension, the largest first.

    Raises:
        Unclear: none has a clear dimension, or no loops are closed, but some open by less than
            `nearly`.
    """
    if not len(search.headings):
        return ()
    ways = move.step * search.headings
    starts = search.part.moved(np.repeat(search.state[None], len(ways), axis=0), ways)
    there = closed(search.part, starts, Sphere(search.state, lengths(ways)))
    least = float(there.misses.min())
    if move.limit <= least < nearly:
        raise _Nearly(least, move)
    known: dict[int, list[Component]] = {}
    doubt = Unclear("a second move does not close") if least < move.limit else None
    for place in _onward(search, there, move):
        try:
            found = component_at(search.part, place, search.random, move)
        except Unclear as unclear:
            doubt = unclear
            continue
        known.setdefault(found.dimension, []).append(found)
    if doubt and not known:
        raise doubt
    return tuple(
        replace(known[k][0], places=tuple(component.state for component in known[k]))
        for k in sorted(known, reverse=True)
    )


def _onward(search: _Search, there: Closed, move: Move) -> Floats:
    """Places (number, states) to which another move in the same heading leads, from some of those
    that closed, which are far from each other."""
    part = search.part
    places = there.states[there.good(move.limit)]
    ways = part.steps(places, np.repeat(search.state[None], len(places), axis=0))
    some = apart_numbers(ways / lengths(ways)[:, None], search.most)
    places, ways = places[some], ways[some]
    on = closed(part, part.moved(places, ways))
    far = lengths(part.steps(on.states, places)) > 0.5 * lengths(ways)
    return np.asarray(on.states[on.good(move.limit) & far])


def _units(random: RandomStarts, number: int, size: int) -> Floats:
    found = random.between(1.0, number * size).reshape(number, size)
    return np.asarray(found / np.sqrt(np.sum(found * found, axis=1))[:, None])
