"""How many freedoms a part of a mechanism has from a place: to first order, and in truth.

The assembled places next to a place form components of some dimensions that meet there. The motions
of first order are as many as the largest where the place is regular; else directions come from the
bifurcation equations, and two moves in one heading lead to a place of one component, where moves
along every motion of first order are closed again: the rank of the chords is the dimension.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

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


class _Unclear(Exception):
    """Chords or ranks do not agree."""


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
    heading = _units(random, 1, motions.shape[1]) @ motions.T
    both = np.repeat(state[None], 2, axis=0)
    for step in tolerances.MOBILITY_STEPS:
        wanted = step * np.concatenate([heading, -heading])
        there = closed(part, part.moved(both, wanted))
        strayed = np.sqrt(np.sum((part.steps(there.states, both) - wanted) ** 2, axis=1))
        for place in there.states[there.good & (strayed < 0.5 * step)]:
            try:
                found = _general(part, place, random, step)
            except _Unclear:
                continue
            return found if found.dimension == motions.shape[1] else None
    return None


def _singular(part: Part, state: Floats, first: Rank, random: RandomStarts) -> Freedom:
    """The components that meet where the first order has more motions than any of them."""
    forms = quadratic_forms(part, state, first.motions, first.stresses)
    alone = part.alone(state, first.motions)
    headings = directions(forms, alone, random) @ first.motions.T
    found: tuple[Component, ...] = ()
    doubt = ""
    for step in tolerances.MOBILITY_STEPS:
        found, doubt = _components(part, state, headings, step, random)
        if not doubt:
            break
    if doubt:
        return Freedom(first, (), doubt)
    return Freedom(first, found or (Component(0, state, first.motions[:, :0], 0.0),))


def _components(
    part: Part, state: Floats, headings: Floats, step: float, random: RandomStarts
) -> tuple[tuple[Component, ...], str]:
    """Components that two moves of a length along `headings` (number, columns) lead to, one of each
    dimension, the largest first; and a doubt in words."""
    if not len(headings):
        return (), ""
    starts = part.moved(np.repeat(state[None], len(headings), axis=0), step * headings)
    there = closed(part, starts, Sphere(state, step))
    known: dict[int, list[Component]] = {}
    doubt = _nearly(there, step)
    for place in _onward(part, state, there, step):
        try:
            found = _general(part, place, random, step)
        except _Unclear as unclear:
            doubt = str(unclear)
            continue
        known.setdefault(found.dimension, []).append(found)
    every = tuple(
        replace(known[k][0], places=tuple(component.state for component in known[k]))
        for k in sorted(known, reverse=True)
    )
    return every, "" if every else doubt


def _onward(part: Part, state: Floats, there: Closed, step: float) -> Floats:
    """Places (number, states) to which another move in the same heading leads, from some of those
    that closed, which are far from each other."""
    places = there.states[there.good]
    ways = part.steps(places, np.repeat(state[None], len(places), axis=0))
    ways /= np.sqrt(np.sum(ways * ways, axis=1, keepdims=True))
    some = apart_numbers(ways, tolerances.MOBILITY_PLACES)
    places, ways = places[some], ways[some]
    on = closed(part, part.moved(places, step * ways))
    moved = part.steps(on.states, places)
    return np.asarray(on.states[on.good & (np.sqrt(np.sum(moved * moved, axis=1)) > 0.5 * step)])


def _nearly(there: Closed, step: float) -> str:
    """Doubt where loops stay all but closed on the sphere: a motion of high order, or written
    dimensions of few digits."""
    if there.good.any():
        return ""
    least = float(there.misses.min())
    if least > tolerances.MOBILITY_OPEN:
        return ""
    return f"{step:g} away the loops are open by {least:.2g} of the size"


def _general(part: Part, state: Floats, random: RandomStarts, step: float) -> Component:
    """The component at a place, or at one next to it where the rank is larger."""
    place = state
    for _ in range(tolerances.MOBILITY_TRIES):
        _, jacobians = part.closing(place[None])
        rank = rank_of(jacobians[0], tolerances.MOBILITY_RANK_REACHED)
        motions = rank.motions
        count = motions.shape[1]
        if count == 0 or rank.stresses.shape[1] == 0:
            return Component(count, place, motions, tolerances.RANK_ZERO)
        turned = motions @ _frame(random, count)
        lengths = step * np.array(tolerances.MOBILITY_CHORDS)
        ways = np.concatenate([length * turned.T for length in lengths])
        ends = closed(part, part.moved(np.repeat(place[None], len(ways), axis=0), ways))
        ranks = [
            rank_of(jacobian, tolerances.MOBILITY_RANK_REACHED).motions.shape[1]
            for jacobian in ends.jacobians
        ]
        if min(ranks) == count:
            return _chords(part, place, ends, count, lengths, rank)
        place = ends.states[int(np.argmin(ranks))]
    raise _Unclear("the rank changes from place to place")


def _chords(
    part: Part, place: Floats, ends: Closed, count: int, lengths: Floats, rank: Rank
) -> Component:
    """The component at a place from moves of two lengths along all motions of first order."""
    if not ends.good.all():
        raise _Unclear("moves do not close again")
    ways = part.steps(ends.states, np.repeat(place[None], len(ends.states), axis=0))
    seen = []
    for k, length in enumerate(lengths):
        chords = ways[k * count : (k + 1) * count] / length
        _, values, right = np.linalg.svd(chords, full_matrices=False)
        low, high = tolerances.MOBILITY_CHORD_RANK
        if np.any((values > low) & (values < high)):
            raise _Unclear(f"chords of {length:g} have no clear rank")
        seen.append((int(np.count_nonzero(values >= high)), right))
    (dimension, _), (again, right) = seen
    if dimension != again:
        raise _Unclear(f"chords of two lengths have the ranks {dimension} and {again}")
    if dimension == count:
        return Component(count, place, rank.motions, tolerances.RANK_ZERO)
    return Component(dimension, place, right[:dimension].T, tolerances.MOBILITY_CHORD_DOUBT)


def _units(random: RandomStarts, number: int, size: int) -> Floats:
    found = random.between(1.0, number * size).reshape(number, size)
    return np.asarray(found / np.sqrt(np.sum(found * found, axis=1))[:, None])


def _frame(random: RandomStarts, size: int) -> Floats:
    """A random orthonormal frame (size, size)."""
    return np.asarray(np.linalg.qr(random.between(1.0, size * size).reshape(size, size))[0])
