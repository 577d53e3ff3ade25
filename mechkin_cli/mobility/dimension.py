"""How many freedoms a part of a mechanism has from a place: to first order, and finite ones.

The assembled places next to a place form components of some dimensions that meet there. The motions
of first order are as many as the largest where the place is regular; else directions come from the
bifurcation equations, and two moves in one heading lead to a place of one component.

Directions: a curve of assembled places with the tangent N a at its start (N the motions of first
order) obeys W^T D2F[N a, N a] = 0 for all stresses W, as many quadratic forms in a as there are
stresses. They are solved for directions from random ones; forms say nothing along their common null
space, the radical, and are solved beside it.

Dimension: moves along an orthonormal frame of the motions of first order are closed again. They go
where they are meant to as far as they lie in the component, else they fall back: the rank of the
chords is its dimension. Two lengths must agree, and moves in the span of the chords must go where
they are meant to.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mobility.configurations import Closed, LoopPart, closed, damped_steps
from mechkin_cli.mobility.opened import Rank, rank_of
from mechkin_cli.record import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel.functions import RandomStarts
    from mechkin_cli.show import Floats


def quadratic_forms(part: LoopPart, state: Floats, motions: Floats, stresses: Floats) -> Floats:
    """Independent forms (forms, k, k) on `motions` (columns, k) at a place with `stresses`
    (rows, r): derivatives of the Jacobian by central differences."""
    step, count = tolerances.MOBILITY_DIFFERENCE, motions.shape[1]
    moves = step * np.concatenate([motions.T, -motions.T])
    _, jacobians = part.closing(part.moved(np.repeat(state[None], 2 * count, axis=0), moves))
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
    zeros = _zeros(beside @ forms @ beside.T, random)
    solved = zeros[_far_apart(zeros, tolerances.MOBILITY_HEADINGS)]
    units = [solved @ beside]
    if len(shared):
        units.append((units[0] + _units(random, len(solved), len(shared)) @ shared) * np.sqrt(0.5))
        units.append(_units(random, tolerances.MOBILITY_FREE_HEADINGS, len(shared)) @ shared)
    if len(shared) < len(radical):
        units.append(_units(random, tolerances.MOBILITY_LONE_HEADINGS, len(radical)) @ radical)
    every = np.concatenate(units)
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
    vectors = random.between(1.0, number * size).reshape(number, size)
    return np.asarray(vectors / np.sqrt(np.sum(vectors * vectors, axis=1))[:, None])


def _far_apart(vectors: Floats, most: int) -> list[int]:
    """Numbers of some of many unit vectors (number, size), each as far from those before as any."""
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


@dataclass(frozen=True)
class AssemblyComponent:
    """A component of the assembled places: its dimension, a general place `state` (states,), and
    steps (columns, dimension) along it, known to `doubt`. The first order has `excess` more motions
    there. `alike` are all places found of its dimension, itself among them: of one component or of
    several (`families`)."""

    dimension: int
    state: Floats
    tangents: Floats
    doubt: float
    excess: int = 0
    alike: tuple[AssemblyComponent, ...] = ()

    @property
    def places(self) -> tuple[Floats, ...]:
        """The states of those alike."""
        return tuple(one.state for one in self.alike)

    def rates_along(self, columns: Sequence[int]) -> Floats:
        """Singular values of the rates of some columns along it, the largest first."""
        return np.asarray(np.linalg.svd(self.tangents[list(columns)], compute_uv=False))

    def rank_along(self, columns: Sequence[int]) -> int:
        """How many rates of some columns are independent along it."""
        least = max(self.doubt, tolerances.RANK_ZERO)
        return int(np.count_nonzero(self.rates_along(columns) > least))

    @property
    def families(self) -> tuple[tuple[AssemblyComponent, ...], ...]:
        """Those alike by components: next to a place where several meet each has its own steps."""
        left, found = list(self.alike or (self,)), []
        while left:
            family = [left.pop(0)]
            for one in family:  # grows
                near = [other for other in left if _apart(one, other) < tolerances.MOBILITY_FAMILY]
                left = [other for other in left if all(other is not each for each in near)]
                family += near
            found.append(tuple(family))
        return tuple(found)


def _apart(one: AssemblyComponent, other: AssemblyComponent) -> float:
    """The sine of the largest angle between the steps along two components of one dimension."""
    off = other.tangents - one.tangents @ (one.tangents.T @ other.tangents)
    return float(np.linalg.norm(off, 2)) if off.size else 0.0


def relative_rates(part: LoopPart, component: AssemblyComponent) -> Floats:
    """Rates (columns, dimension) along a component, each column in a unit of its own, so that what
    moves little beside the rest, as the far end of a long row of loops, is told from what rests.

    A unit is the rate itself where that is clear; a loop in which none is clear has the unit of
    those next to it. With new units more rates become clear, until no others do.
    """
    rates = component.tangents
    if component.doubt > tolerances.RANK_ZERO or not component.dimension:
        return rates
    clear = np.abs(rates).max(axis=1) > tolerances.RANK_ZERO
    if clear.all():
        return rates
    passing = part.loops.passing[part.cuts][:, part.columns]
    beside = passing.astype(np.float64) @ passing.T > 0.0
    (jacobian,) = part.closing(component.state[None])[1]
    with np.errstate(divide="ignore"):
        entries = np.log2(np.abs(jacobian))  # powers of two: units may lie beyond all floats
    units, known = np.zeros(part.count), np.zeros_like(clear)
    while np.any(clear > known) and not clear.all():
        known |= clear
        units[clear] += np.log2(np.abs(rates[clear]).max(axis=1))
        units = _spread(units, known, passing, beside)
        rows = (entries + units).max(axis=1, initial=-np.inf)
        told = np.isfinite(rows)
        even = np.zeros_like(jacobian)
        even[told] = np.sign(jacobian[told]) * np.exp2(entries[told] + units - rows[told, None])
        again = part.rank(even, tolerances.MOBILITY_RANK_REACHED).motions
        if again.shape[1] != component.dimension:
            break
        rates = again
        clear = np.abs(rates).max(axis=1) > tolerances.RANK_ZERO
    return rates


def _spread(
    units: Floats, known: NDArray[np.bool_], passing: NDArray[np.bool_], beside: NDArray[np.bool_]
) -> Floats:
    """Units (columns,) of which some are known: the others have that of the largest known one of a
    loop that passes them, loops without any that of those next to them."""
    every = np.where(passing & known, units, -np.inf).max(axis=1)
    while np.any(np.isneginf(every)):
        nearest = np.where(beside & np.isfinite(every), every, np.inf).min(axis=1)
        new = np.isneginf(every) & np.isfinite(nearest)
        if not new.any():
            return units
        every[new] = nearest[new]
    return np.where(known, units, np.where(passing, every[:, None], np.inf).min(axis=0))


def usual(sizes: Sequence[Floats] | Floats) -> Floats:
    """The lower median of sizes (places, ...): next to where families cross a double root is known
    to less than elsewhere."""
    return np.asarray(np.sort(np.asarray(sizes), axis=0)[(len(sizes) - 1) // 2])


def still_along(
    part: LoopPart, state: Floats, family: Sequence[AssemblyComponent]
) -> dict[int, int]:
    """Columns of the whole that rest along a family, where the drawing has them, with their numbers
    in the part."""
    starts = np.repeat(state[None], len(family), axis=0)
    steps = usual(np.abs(part.steps(np.array([one.state for one in family]), starts)))
    still = np.flatnonzero(steps < tolerances.MOBILITY_CHORD_DOUBT)
    return {int(part.columns[k]): int(k) for k in still}


Move = tuple[float, float]
"""A move by its largest step (rad, parts of the size), and how far loops that are closed after it
may be open."""


class Unclear(Exception):
    """Chords or ranks do not agree."""


def component_at(
    part: LoopPart, state: Floats, random: RandomStarts, move: Move, most: int
) -> AssemblyComponent:
    """The component at a place, or at one next to it where the rank is larger; where it was reached
    from there are `most` motions of first order."""
    place = state
    for _ in range(tolerances.MOBILITY_TRIES):
        _, jacobians = part.closing(place[None])
        rank = part.rank_reached(jacobians[0], most)
        motions = rank.motions
        count = motions.shape[1]
        if count == 0 or rank.stresses.shape[1] == part.held:
            return AssemblyComponent(count, place, motions, tolerances.RANK_ZERO)
        units = (motions @ _frame(random, count)).T
        moves = move[0] * _scaled(units)
        moves = np.concatenate([part_of * moves for part_of in tolerances.MOBILITY_CHORDS])
        ends = closed(part, part.moved(np.repeat(place[None], len(moves), axis=0), moves))
        if not ends.good(move[1]).all():
            raise Unclear("moves do not close again")
        ranks = [part.rank_reached(jacobian, most).motions.shape[1] for jacobian in ends.jacobians]
        if min(ranks) == count:
            dimension, tangents = _chords(part, place, ends, moves)
            if not dimension:
                raise Unclear(f"{move[0]:g} away nothing can move")
            if not _is_smooth(part, place, tangents, move, _frame(random, dimension)):
                raise Unclear("several motions meet wherever it goes")
            if dimension == count:
                is_short = move[0] < tolerances.MOBILITY_MOVES[0][0]
                if is_short and ends.misses.max() > tolerances.MOBILITY_CLOSED_SURELY:
                    raise Unclear(f"{move[0]:g} away the loops are open by {ends.misses.max():.2g}")
                return AssemblyComponent(count, place, motions, tolerances.RANK_ZERO)
            doubt = tolerances.MOBILITY_CHORD_DOUBT
            return AssemblyComponent(dimension, place, tangents, doubt, count - dimension)
        place = ends.states[int(np.argmin(ranks))]
    raise Unclear("the rank changes from place to place")


def general_places(
    part: LoopPart, family: Sequence[AssemblyComponent], random: RandomStarts
) -> tuple[AssemblyComponent, ...]:
    """Those places of a family at which the first order has the fewest motions, its own or one of
    those to which long moves along it lead; where it has as many as dimensions they are the steps
    along it, without the doubt of chords."""
    known, least = list(family), min(one.excess for one in family)
    for one in family if least else ():
        heading = _scaled(_units(random, 1, one.dimension) @ one.tangents.T)
        moves = tolerances.MOBILITY_FAR_MOVE[0] * np.concatenate([heading, -heading])
        ends = closed(part, part.moved(np.repeat(one.state[None], 2, axis=0), moves))
        good = ends.good(tolerances.MOBILITY_CLOSED)
        for state, jacobian in zip(ends.states[good], ends.jacobians[good], strict=True):
            motions = part.rank_reached(jacobian, one.dimension + one.excess).motions
            if motions.shape[1] == one.dimension:
                known.append(replace(one, state=state, tangents=motions, excess=0, alike=()))
    least = min(one.excess for one in known)
    return tuple(one for one in known if one.excess == least)


def _chords(part: LoopPart, place: Floats, ends: Closed, moves: Floats) -> tuple[int, Floats]:
    """Dimension and steps (columns, dimension) of the component at a place, from the `ends` of
    `moves` (number, columns) along all motions of first order at two lengths."""
    chords = part.steps(ends.states, np.repeat(place[None], len(moves), axis=0))
    chords /= _lengths(moves)[:, None]
    seen = []
    for some in np.split(chords, len(tolerances.MOBILITY_CHORDS)):
        _, values, right = np.linalg.svd(some, full_matrices=False)
        low, high = tolerances.MOBILITY_CHORD_RANK
        if ends.misses.max() > tolerances.MOBILITY_CLOSED_SURELY:
            high = tolerances.MOBILITY_CHORD_OPEN
        if np.any((values > low) & (values < high)):
            raise Unclear(f"chords have singular values between {low:g} and {high:g}")
        seen.append((int(np.count_nonzero(values >= high)), right))
    (dimension, _), (again, right) = seen
    if dimension != again:
        raise Unclear(f"chords of two lengths have the ranks {dimension} and {again}")
    return dimension, right[:dimension].T


def _is_smooth(part: LoopPart, place: Floats, tangents: Floats, move: Move, frame: Floats) -> bool:
    """Whether moves along the `tangents` (columns, dimension), mixed by a `frame`, go where they
    are meant to: they would not where several components meet, whose chords count together."""
    moves = move[0] * tolerances.MOBILITY_CHORDS[0] * _scaled((tangents @ frame).T)
    return bool(np.all(_closed_as_meant(part, place, moves, move)[1]))


def _closed_as_meant(
    part: LoopPart, place: Floats, moves: Floats, move: Move
) -> tuple[Closed, NDArray[np.bool_]]:
    """The ends of moves (number, columns) from a place, and which of them did not stray."""
    starts = np.repeat(place[None], len(moves), axis=0)
    ends = closed(part, part.moved(starts, moves))
    strayed = _lengths(part.steps(ends.states, starts) - moves)
    limit = tolerances.MOBILITY_STRAYED * _lengths(moves)
    return ends, ends.good(move[1]) & (strayed < limit)


def _lengths(steps: Floats) -> Floats:
    """Lengths (number,) of steps (number, columns)."""
    return np.asarray(np.sqrt(np.sum(steps * steps, axis=1)))


def _scaled(steps: Floats) -> Floats:
    """Steps (number, columns) whose largest is one."""
    return np.asarray(steps / np.abs(steps).max(axis=1, initial=0.0, keepdims=True))


def _frame(random: RandomStarts, size: int) -> Floats:
    """A random orthonormal frame (size, size)."""
    return np.asarray(np.linalg.qr(random.between(1.0, size * size).reshape(size, size))[0])


@dataclass(frozen=True)
class LocalFreedom:
    """Freedoms of a part from a place.

    `first` is the rank there; `components` are those that meet there, one for each dimension, the
    largest first; `doubt` says in words why the answer is not clear, else it is empty.
    """

    first: Rank
    components: tuple[AssemblyComponent, ...]
    doubt: str = ""

    @property
    def dimensions(self) -> tuple[int, ...]:
        """Dimensions of the components, the largest first."""
        return tuple(component.dimension for component in self.components)

    @property
    def every(self) -> tuple[AssemblyComponent, ...]:
        """The components at all places found."""
        return tuple(
            one for component in self.components for one in component.alike or (component,)
        )

    @property
    def families(self) -> tuple[tuple[AssemblyComponent, ...], ...]:
        """The places found by the component that they lie in, the largest dimension first."""
        return tuple(family for component in self.components for family in component.families)

    def driven_first(self, columns: Sequence[int]) -> LocalFreedom:
        """The same with the place first of the largest dimension at which the rates of some columns
        are farthest from dependent."""
        if not self.components or not columns or not self.components[0].alike:
            return self
        first, *others = self.components
        rates = [one.rates_along(columns).min(initial=1.0) for one in first.alike]
        chosen = first.alike[int(np.argmax(rates))]
        alike = (chosen, *(one for one in first.alike if one is not chosen))
        return replace(self, components=(replace(chosen, alike=alike), *others))


class _Nearly(Unclear):
    """Loops stay all but closed: the `least` that they are open by is small."""

    def __init__(self, least: float, move: Move) -> None:
        open_by = f"{least:.2g} of the size (limit {move[1]:g})"
        super().__init__(f"{move[0]:g} away the loops are open by {open_by}")
        self.least = least


def freedom_of(
    part: LoopPart,
    state: Floats,
    random: RandomStarts,
    *,
    regular: bool = False,
    rests: Sequence[int] = (),
) -> LocalFreedom:
    """The freedoms of a part from an assembled place `state` (states,); with `regular`, any other
    than a regular place is a doubt. A component along which the columns `rests` and no motions of
    first order but theirs rest is looked at alone, if there is one."""
    _, jacobians = part.closing(state[None])
    first = part.rank(jacobians[0], tolerances.RANK_ZERO)
    if not first.clear:
        return LocalFreedom(first, (), first.doubt)
    count = first.motions.shape[1]
    if count == 0:
        return LocalFreedom(first, (AssemblyComponent(0, state, first.motions, 0.0),))
    if rests:
        along = first.motions @ rank_of(first.motions[list(rests)], tolerances.RANK_ZERO).motions
        # single links that move, too, only shorten the way of the others
        beside = _less(along.T, along @ part.alone(state, along))
        for _ in range(tolerances.MOBILITY_TRIES if len(beside) else 0):
            heading = _units(random, 1, len(beside)) @ beside
            component = _component_along(part, state, along, heading, random, count)
            if component is not None and component.dimension + component.excess == count:
                (steps,) = part.steps(component.state[None], state[None])
                if np.abs(steps[list(rests)]).max() < tolerances.MOBILITY_CHORD_DOUBT:
                    return LocalFreedom(first, (component,))
    heading = _units(random, 1, count) @ first.motions.T
    component = _component_along(part, state, first.motions, heading, random, count)
    if component is not None:
        return LocalFreedom(first, (component,))
    if regular:
        return LocalFreedom(first, (), "a special position")
    if not first.stresses.shape[1]:
        # regular by its rank, but its moves do not show it: sizes too far apart for the numbers
        return LocalFreedom(first, (), "no move along its motions closes the loops as they should")
    return _singular(part, state, first, random)


def _component_along(
    part: LoopPart,
    state: Floats,
    motions: Floats,
    heading: Floats,
    random: RandomStarts,
    most: int,
) -> AssemblyComponent | None:
    """The component to which a heading (1, columns) leads among some of the `most` motions of first
    order (columns, count), if it has as many dimensions as they are: where they are all, there is
    but this one. None else."""
    heading = _scaled(heading)
    for move in tolerances.MOBILITY_MOVES:
        moves = move[0] * np.concatenate([heading, -heading])
        ends, as_meant = _closed_as_meant(part, state, moves, move)
        for place in ends.states[as_meant]:
            try:
                component = component_at(part, place, random, move, most)
            except Unclear:
                continue
            return component if component.dimension == motions.shape[1] else None
    return None


def _singular(part: LoopPart, state: Floats, first: Rank, random: RandomStarts) -> LocalFreedom:
    """The components that meet where the first order has more motions than any of them."""
    count = first.motions.shape[1]
    forms = quadratic_forms(part, state, first.motions, first.stresses)
    alone = part.alone(state, first.motions)
    lone = first.motions @ alone
    headings = _scaled(directions(forms, alone, random) @ first.motions.T)
    least, largest = tolerances.MOBILITY_PLACES
    most = min(max(tolerances.MOBILITY_WORK // count, least), largest)

    def components(
        move: Move, nearly: float = tolerances.MOBILITY_OPEN
    ) -> tuple[AssemblyComponent, ...]:
        if not len(headings):
            return ()
        step, limit = move
        moves = step * headings
        starts = part.moved(np.repeat(state[None], len(moves), axis=0), moves)
        ends = closed(part, starts, (state, _lengths(moves)))
        open_by = float(ends.misses.min())
        if limit <= open_by < nearly:
            raise _Nearly(open_by, move)
        good = ends.states[ends.good(limit)]
        places = _onward(part, state, good, most, limit)
        doubt = Unclear("a second move does not close") if open_by < limit else None
        rest = _onward(part, state, good, len(good), limit)
        return _components(part, state, lone, places, rest, random, move, count, doubt)

    try:
        try:
            meeting = components(tolerances.MOBILITY_MOVES[0])
        except _Nearly as near:
            far = tolerances.MOBILITY_FAR_MOVE
            meeting = components(far, tolerances.MOBILITY_GROWTH * near.least)
        except Unclear:
            meeting = components(tolerances.MOBILITY_MOVES[1])
    except Unclear as unclear:
        return LocalFreedom(first, (), str(unclear))
    if len(meeting) > 1 and meeting[0].dimension == count:
        meeting = meeting[1:]  # with as many as to first order the place would be regular
    fixed = AssemblyComponent(0, state, first.motions[:, :0], 0.0)
    return LocalFreedom(first, meeting or (fixed,))


def _components(
    part: LoopPart,
    state: Floats,
    lone: Floats,
    places: Floats,
    rest: Floats,
    random: RandomStarts,
    move: Move,
    most: int,
    doubt: Unclear | None,
) -> tuple[AssemblyComponent, ...]:
    """Components of some places (number, states), one of each dimension, the largest first; of the
    `rest` (number, states) those are looked at, too, to which no component found leads from `state`
    but for motions that are `lone` (columns, count); `most` as in `component_at`.

    Raises:
        Unclear: the last `doubt`, where none has a clear dimension.
    """
    found: list[AssemblyComponent] = []
    for place in places:
        try:
            found.append(component_at(part, place, random, move, most))
        except Unclear as unclear:
            doubt = unclear
    if doubt and not found:
        raise doubt
    headings = part.steps(rest, np.repeat(state[None], len(rest), axis=0))
    headings -= (headings @ lone) @ lone.T
    headings /= _lengths(headings)[:, None]
    off = np.ones(len(rest))
    known = 0
    for _ in range(tolerances.MOBILITY_PLACES[0]):
        for one in found[known:]:
            aside = headings - (headings @ one.tangents) @ one.tangents.T
            off = np.minimum(off, _lengths(aside))
        known = len(found)
        if not np.any(off > tolerances.MOBILITY_ASIDE):
            break
        furthest = int(np.argmax(off))
        off[furthest] = 0.0
        try:
            found.append(component_at(part, rest[furthest], random, move, most))
        except Unclear:
            continue
    of = {
        k: tuple(one for one in found if one.dimension == k) for k in {c.dimension for c in found}
    }
    return tuple(replace(of[k][0], alike=of[k]) for k in sorted(of, reverse=True))


def _onward(part: LoopPart, state: Floats, places: Floats, most: int, limit: float) -> Floats:
    """Places (number, states) to which another move in the same heading leads, from `most` of
    some places, far from each other, to which a first move from a state led."""
    moves = part.steps(places, np.repeat(state[None], len(places), axis=0))
    some = _far_apart(moves / _lengths(moves)[:, None], most)
    places, moves = places[some], moves[some]
    ends = closed(part, part.moved(places, moves))
    far = _lengths(part.steps(ends.states, places)) > 0.5 * _lengths(moves)
    return np.asarray(ends.states[ends.good(limit) & far])
