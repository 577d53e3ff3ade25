"""All assemblies of a mechanism at some inputs that random starts find, block by block.

A block is searched once for each *place* of the blocks that its loops hang from, and blocks that do
not depend on each other multiply their assemblies. The search of a block is Levenberg-Marquardt
from random starts (fixed seed); the starts of all places share the kernel's calls. A place's search
ends when all assemblies are proven to be found (`loop_equation`, `chain`), or when the chance that
one more start finds another is small.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.functions import RandomStarts, threads_for, width
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, Layout, home_state, is_lifted
from mechkin_cli.record import NamedTuple
from mechkin_cli.search.chain import most_of_block
from mechkin_cli.search.clusters import (
    Clusters,
    Ended,
    Within,
    counted_turns,
    first_of_each,
    most_turn,
    on_tracks,
    pose_keys,
    randomise,
    thread_states,
    unknown_states,
    upstream_states,
)
from mechkin_cli.search.loop_equation import counts_of_assemblies
from mechkin_cli.session import Ask, RowInputs, Session, Structure, lies_in_family, run

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.show import Bools, Floats


class BlockSearch(NamedTuple):
    """A search at `inputs` (inputs,), threads within `turns` to either side of those in
    `middle` (states,), starts `within` a box; `thorough`: for all assemblies, else for one."""

    layout: Layout
    plan: Plan
    inputs: Floats
    turns: int
    middle: Floats
    within: Within | None
    thorough: bool


class PlaceSearch:
    """The search of a block at one place (column of `bases`).

    `doubt` is the chance that its bound of what is left may fail; `limits` its most starts where
    none closes, and where some do; `goal` the chance of another assembly that ends it.
    """

    def __init__(
        self,
        clusters: Clusters,
        doubt: float,
        limits: tuple[int, int],
        most: int | None,
        goal: float,
        thorough: bool,
    ) -> None:
        self.clusters = clusters
        self.doubt, self.limits, self.most, self.goal = doubt, limits, most, goal
        self.thorough = thorough
        self.real: int | None = None

    def learn(self, count: tuple[int | None, int] | None) -> None:
        """Takes the loop's number of assemblies and the most it may have
        (`counts_of_assemblies`)."""
        if count is not None:
            self.real, most = count
            self.most = most if self.most is None else min(most, self.most)

    @property
    def is_complete(self) -> bool:
        """Whether all assemblies are proven to be found."""
        number = self.clusters.number
        if self.real is not None:
            return number == self.real
        # starts on a motion end all along it, but nowhere twice
        return number == self.most and int(self.clusters.met.min()) > 1

    @property
    def rest(self) -> float:
        """Bound of the chance that one more start that closes finds another assembly."""
        return 0.0 if self.is_complete else self.clusters.rest(self.doubt)

    @property
    def is_settled(self) -> bool:
        """Whether more starts are not worth it."""
        if self.is_complete:
            return True
        if not self.clusters.closed:
            return self.clusters.tried >= self.limits[0]
        chance = self.clusters.rest(self.doubt) if self.thorough else self.clusters.estimate
        return chance < self.goal

    @property
    def is_over(self) -> bool:
        """Whether the search ends, or gives up."""
        crowded = self.clusters.number > tolerances.SEARCH_MOST_MODES
        return crowded or self.clusters.tried >= self.limits[1] or self.is_settled


def search_block(
    request: BlockSearch, number: int, bases: Floats, generator: RandomStarts, doubts: list[float]
) -> list[PlaceSearch]:
    """Searches a block at all places (columns of `bases`, (states, places))."""
    searches = _searches(request, number, doubts)
    active = list(range(len(searches)))
    while active:
        tried = searches[active[0]].clusters.tried
        first = min(tolerances.SEARCH_STARTS, searches[0].limits[0])
        share = max(first // len(active), tolerances.SEARCH_LEAST_STARTS)
        if request.thorough:
            share = max(share, min(tried, tolerances.SEARCH_MOST_ROUND // len(active)))
        at_once = max(tolerances.SEARCH_MOST_COLUMNS // share, 1)
        for first in range(0, len(active), at_once):
            places = active[first : first + at_once]
            states = np.repeat(bases[:, places], share, axis=1)
            search_round(request, number, states, generator, [searches[i] for i in places])
        if not tried and request.within is None:
            # a box holds some of them, and their number is not known
            open_ = [i for i, search in enumerate(searches) if not search.is_complete]
            counts = counts_of_assemblies(request.layout, number, bases[:, open_])
            for i, count in zip(open_, counts, strict=True):
                searches[i].learn(count)
        active = [i for i in active if not searches[i].is_over]
        clusters = [search.clusters for search in searches]
        if any(c.closed + c.free for c in clusters):
            continue
        if sum(c.tried for c in clusters) >= searches[0].limits[0]:
            break  # as many starts as one place alone would have, and none closed
    return searches


def _searches(request: BlockSearch, number: int, doubts: list[float]) -> list[PlaceSearch]:
    layout = request.layout
    block, places = layout.graph.blocks[number], len(doubts)
    equations, unknowns = block.equations, len(block.unknowns)
    # multiplications of one step of a start, about: normal equations, their solution, screws
    step = unknowns * (unknowns * equations + unknowns * unknowns / 3.0 + 100.0)
    work = tolerances.SEARCH_ITERATIONS * step
    none = min(tolerances.SEARCH_HOPELESS_WORK / work, tolerances.SEARCH_HOPELESS_STARTS)
    none = max(none, tolerances.SEARCH_LEAST_HOPELESS_STARTS)
    most: float = tolerances.SEARCH_MOST_QUICK_STARTS
    if request.thorough:
        most = max(most, min(tolerances.SEARCH_MOST_WORK / work, tolerances.SEARCH_MOST_STARTS))
    most = max(most / places, tolerances.SEARCH_HOPELESS_STARTS)
    goal = min(
        tolerances.SEARCH_NEW_MODE_CHANCE * places, tolerances.SEARCH_NEW_MODE_CHANCE_OF_MANY
    )
    bound = most_of_block(layout.graph, block)
    limits = int(none), int(most)
    numbers = sorted({layout.carrier_of(*unknown)[0] for unknown in block.unknowns})
    own = [layout.carriers[k] for k in numbers]
    return [
        PlaceSearch(Clusters(layout, own), doubt, limits, bound, goal, request.thorough)
        for doubt in doubts
    ]


def search_round(
    request: BlockSearch,
    number: int,
    states: Floats,
    generator: RandomStarts,
    searches: list[PlaceSearch],
) -> None:
    """The same number of starts from each place, columns of `states`, place by place."""
    layout, middle = request.layout, request.middle
    randomise(layout, number, states, generator, request.turns, middle, request.within)
    values = np.repeat(request.inputs[:, None], states.shape[1], axis=1)
    residual, closed = ends(request.plan, number, values, states)
    threads = thread_states(layout, number)
    turned = np.abs(states[threads] - middle[threads, None]) <= most_turn(request.turns)
    good = closed & turned.all(axis=0) & on_tracks(layout, number, states)
    share = states.shape[1] // len(searches)
    closing = states[:, good]
    keys = searches[0].clusters.keys_of(closing)
    last = np.cumsum(good)[share - 1 :: share].tolist()
    parts = list(zip([0, *last], last, strict=False))
    unknown = [
        search.clusters.unknown(keys[:, first:end])
        for search, (first, end) in zip(searches, parts, strict=True)
    ]
    fresh = [first + some for (first, _), some in zip(parts, unknown, strict=True)]
    ended = _ended(request, number, closing[:, np.concatenate(fresh)], searches[0].clusters)
    done = 0
    for i, (search, (first, end), some) in enumerate(zip(searches, parts, unknown, strict=True)):
        clusters = search.clusters
        closest = float(np.min(residual[i * share : (i + 1) * share]))
        clusters.closest = min(clusters.closest, closest)
        clusters.tried += share
        clusters.add(end - first, some, ended.part(slice(done, done + some.size)))
        done += some.size


def _ended(request: BlockSearch, number: int, states: Floats, clusters: Clusters) -> Ended:
    """The end points of a block's search; not isolated are assemblies at which the block moves with
    all else held, or singular ones."""
    count = states.shape[1]
    if count == 0:
        none = np.ones(count, dtype=bool)
        return Ended(states, clusters.keys_of(states), none, none, np.zeros(count))
    values = np.repeat(request.inputs[:, None], count, axis=1)
    ask = Ask(Demand.CONDITION, iterations=20, only=number)
    batch = run(request.plan, RowInputs(values, states), ask)
    assert batch.condition is not None
    regular = batch.condition < tolerances.SEARCH_CONDITION
    keys = clusters.keys_of(batch.states)
    return Ended(batch.states, keys, batch.good & regular, batch.good & ~regular, batch.condition)


def ends(plan: Plan, number: int, values: Floats, states: Floats) -> tuple[Floats, Bools]:
    """Takes the starts `states` (states, starts) of a block to their ends, in place; residuals and
    which of them closed."""
    size = states.shape[1]
    residual, flags = np.empty(size), np.empty(size, dtype=np.uint8)
    plan.search(
        block=number,
        inputs=values,
        states=states,
        residual=residual,
        flags=flags,
        iterations=tolerances.SEARCH_ITERATIONS,
        tests=(tolerances.SEARCH_RESIDUAL,),
        lanes=width(),
        # an iteration of a start costs as much as a row or more
        threads=threads_for(size * tolerances.SEARCH_ITERATIONS),
    )
    return residual, flags == 0


class Assemblies(NamedTuple):
    """Assemblies (columns of `states`), their condition, and how the search went.

    `closed` starts of `starts` ended on an assembly; `chance` bounds the chance that one more that
    closes finds a new one (it may fail with `SEARCH_DOUBT`); where none of a block's starts closed,
    that one more does. `complete`: proven that there is none, by `bound`, the most that such loops
    have, or by a count of the loops' own real roots. `closest` is the least closing residual of any
    start of the last block searched; `stopped`: the search ended at its most starts. `free` starts
    ended where the loops still move with the inputs held, or in a singular place: these are no
    isolated assemblies and are left out. `failed` is the first block of which none of `tried`
    starts closed, at none of the `places` of the blocks before. `cut`: blocks have more assemblies
    together than are listed; those nearest to the drawing are.
    """

    states: Floats
    residual: Floats
    condition: Floats
    starts: int
    closed: int
    chance: float
    closest: float
    stopped: bool
    free: int
    complete: bool
    bound: int | None
    failed: int | None
    tried: int
    places: int
    cut: bool

    @property
    def number(self) -> int:
        """Of assemblies."""
        return int(self.states.shape[1])


class _Tally:
    """What the searches of all blocks amount to."""

    def __init__(self) -> None:
        self.searches = self.starts = self.closed = self.free = 0
        self.chance = self.closest = 0.0
        self.stopped, self.complete = False, True
        self.bound: int | None = 1
        self.failed: int | None = None
        self.most_places = tolerances.SEARCH_MOST_PLACES
        self.tried = self.places = 0

    def doubts(self, count: int) -> list[float]:
        """Shares of `SEARCH_DOUBT` for the next searches; all of them add up to it."""
        first = self.searches + 1
        self.searches += count
        return [tolerances.SEARCH_DOUBT / (s * (s + 1)) for s in range(first, first + count)]

    def cut(self) -> int:
        """Records that not all assemblies so far are continued; gives how many to continue where
        the next block is searched at each."""
        self.stopped, self.complete = True, False
        self.most_places = tolerances.SEARCH_FEW_PLACES
        return self.most_places

    @property
    def is_cut(self) -> bool:
        return self.most_places == tolerances.SEARCH_FEW_PLACES

    def add(self, number: int, searches: list[PlaceSearch]) -> None:
        all_clusters = [search.clusters for search in searches]
        self.starts += sum(clusters.tried for clusters in all_clusters)
        self.closed += sum(clusters.closed for clusters in all_clusters)
        self.free += sum(clusters.free for clusters in all_clusters)
        self.chance = max(self.chance, *(search.rest for search in searches))
        self.stopped = self.stopped or not all(search.is_settled for search in searches)
        self.complete = self.complete and all(search.is_complete for search in searches)
        self.closest = max(clusters.closest for clusters in all_clusters)
        self.tried = sum(clusters.tried for clusters in all_clusters)
        if not any(clusters.number for clusters in all_clusters):
            self.failed, self.places = number, len(searches)
            proven = all(search.is_complete for search in searches)
            self.complete = proven and not self.is_cut

    def multiply(self, bounds: list[int | None]) -> None:
        for bound in bounds:
            self.bound = None if self.bound is None or bound is None else self.bound * bound


def assemblies(
    layout: Layout,
    plan: Plan,
    inputs: Floats,
    turns: int = 1,
    within: Within | None = None,
    about: Floats | None = None,
    thorough: bool = True,
) -> Assemblies:
    """The assemblies at one set of inputs.

    Args:
        layout: the mechanism in the kernel.
        plan: its plan.
        inputs: (inputs,) in kernel units.
        turns: turns of helical joints to either side.
        within: where random starts are taken; None: everywhere.
        about: (states,) whose turns of threads are the middle of those searched; None: as drawn.
        thorough: whether all are wanted, or one among the most of them.
    """
    generator, tally = RandomStarts(), _Tally()
    middle = np.zeros(plan.states) if about is None else about
    request = BlockSearch(layout, plan, inputs, turns, middle, within, thorough)
    partial = _first_place(layout, inputs)
    for number in range(len(layout.graph.blocks)):
        upstream = upstream_states(layout, number)
        firsts, place = _different(partial[upstream])
        if len(firsts) > tally.most_places:
            partial = partial[:, _nearest_home(layout, partial, tally.cut())]
            firsts, place = _different(partial[upstream])
        doubts = tally.doubts(len(firsts))
        searches = search_block(request, number, partial[:, firsts], generator, doubts)
        tally.add(number, searches)
        tally.multiply(list({search.most for search in searches}))
        if tally.failed is not None:
            rest = layout.graph.blocks[number + 1 :]
            tally.multiply([most_of_block(layout.graph, block) for block in rest])
            partial = partial[:, :0]
            break
        counts = np.array([searches[k].clusters.number for k in place])
        if int(np.add.reduce(counts)) > tolerances.SEARCH_MOST_PRODUCTS:
            tally.cut()
            having = np.flatnonzero(counts)
            few = max(tolerances.SEARCH_MOST_PRODUCTS // (2 * int(counts.max())), 1)
            some = having[_nearest_home(layout, partial[:, having], few)]
            partial, place = partial[:, some], [place[i] for i in some]
        partial = _continued(layout, number, partial, place, searches)
    states, residual, condition = _closed(layout, plan, inputs, partial)
    complete = tally.complete and states.shape[1] == partial.shape[1]
    taut = _are_stretched(layout, states)
    states, residual, condition = states[:, taut], residual[taut], condition[taut]
    return Assemblies(
        states,
        residual,
        condition,
        starts=tally.starts,
        closed=tally.closed,
        chance=tally.chance,
        closest=tally.closest,
        stopped=tally.stopped,
        free=tally.free,
        complete=complete,
        bound=tally.bound if layout.graph.blocks else None,
        failed=tally.failed,
        tried=tally.tried,
        places=tally.places,
        cut=tally.is_cut,
    )


def _are_stretched(layout: Layout, states: Floats) -> Bools:
    """Whether all stretches and arcs of cables are as long as such may be in assemblies (columns):
    the slide that stands for one may as well go through its end, which a cable does not."""
    good = np.ones(states.shape[1], dtype=bool)
    for _, extent, value in layout.extents(states):
        good &= ~is_lifted(extent, value)
        if extent.most is not None:
            good &= value < extent.most
    return good


def _first_place(layout: Layout, inputs: Floats) -> Floats:
    """The one place before the first block: the inputs, unknowns zero, (states, 1)."""
    state = np.zeros((layout.states, 1))
    state[[c.state for c in layout.carriers if c.part.type.is_ball], 0] = 1.0
    for (edge, freedom), value in zip(layout.graph.inputs, inputs, strict=True):
        if edge >= 0:
            state[layout.state(edge, freedom), 0] = value
    return state


def _different(states: Floats) -> tuple[list[int], list[int]]:
    """The first column of each kind, and for each column which of these it is equal to."""
    firsts: list[int] = []
    kinds: dict[bytes, int] = {}
    place = []
    for number, column in enumerate(np.ascontiguousarray(states.T)):
        key = column.tobytes()
        if key not in kinds:
            kinds[key] = len(firsts)
            firsts.append(number)
        place.append(kinds[key])
    return firsts, place


def _nearest_home(layout: Layout, partial: Floats, count: int) -> NDArray[np.int64]:
    """The columns of the assemblies whose joints are nearest to the drawing, in their order."""
    home = home_state(layout)[:, None]
    away = np.zeros(partial.shape[1])
    keys = pose_keys(layout, partial)
    for key, drawn in zip(keys, pose_keys(layout, home), strict=True):
        away = away + (key - drawn) * (key - drawn)
    return np.sort(np.argsort(away, kind="stable")[:count])


def _continued(
    layout: Layout, number: int, partial: Floats, place: list[int], searches: list[PlaceSearch]
) -> Floats:
    """Every assembly so far with each of the block's own there."""
    own = unknown_states(layout, number)
    of_places = [searches[k].clusters for k in place]
    states = np.repeat(partial, [clusters.number for clusters in of_places], axis=1)
    states[own] = np.concatenate([clusters.states[own] for clusters in of_places], axis=1)
    return states


def free_places(session: Session, within: Within, generator: RandomStarts, count: int) -> Floats:
    """Places (states, places) of a free motion, closed to what the search leaves, at which some of
    `count` random starts end: the steps are short where the loops leave a motion, so that each ends
    near where it starts; short circuits have their share of them.

    Args:
        session: of the free motion, whose loops are one block.
        within: where starts are taken.
        generator: of the starts.
        count: of them.
    """
    layout, inputs = session.layout, session.inputs.reduced[:, 0]
    turns, middle = session.problem.assembly.turns, _named_turns(session)
    states = np.repeat(_first_place(layout, inputs), count, axis=1)
    randomise(layout, 0, states, generator, turns, middle, within)
    _, closed = ends(session.plan, 0, np.repeat(inputs[:, None], count, axis=1), states)
    threads = thread_states(layout, 0)
    turned = np.abs(states[threads] - middle[threads, None]) <= most_turn(turns)
    good = closed & turned.all(axis=0) & on_tracks(layout, 0, states)
    states = np.ascontiguousarray(states[:, good])
    _wrap_angles(layout, states)
    return states[:, _are_stretched(layout, states)]


def single_assembly(layout: Layout, plan: Plan, inputs: Floats, state: Floats) -> Floats:
    """Where one start (states,) ends, block by block; closed or not."""
    values, states = np.ascontiguousarray(inputs[:, None]), state[:, None].copy()
    for number in range(len(layout.graph.blocks)):
        ends(plan, number, values, states)
    end: Floats = states[:, 0].copy()
    return end


def with_assemblies(
    layout: Layout, plan: Plan, inputs: Floats, found: Assemblies, states: Floats
) -> Assemblies:
    """`found` with the assemblies among `states` (states, count) that it lacks."""
    every = np.concatenate([found.states, states], axis=1)
    states, residual, condition = _closed(layout, plan, inputs, every)
    return found._replace(states=states, residual=residual, condition=condition)


def _closed(
    layout: Layout, plan: Plan, inputs: Floats, states: Floats
) -> tuple[Floats, Floats, Floats]:
    """Newton on the whole mechanism, singular ends and doubles dropped, angles wrapped: states,
    residual, condition."""
    if states.shape[1] == 0:
        return states, np.empty(0), np.empty(0)
    values = np.repeat(inputs[:, None], states.shape[1], axis=1)
    batch = run(plan, RowInputs(values, states), Ask(Demand.CONDITION, iterations=20))
    if not batch.good.all():
        # next to a fold the last of many steps may be one by rounding over next to nothing
        states = np.where(batch.good, batch.states, states)
        batch = run(plan, RowInputs(values, states), Ask(Demand.CONDITION, iterations=0))
    assert batch.condition is not None
    keep = batch.good & (batch.condition < tolerances.SEARCH_CONDITION)
    states = batch.states[:, keep]
    _wrap_angles(layout, states)
    # of the same pose the one next to the drawing
    turned = np.zeros(states.shape[1])
    for number in counted_turns(layout):
        turned = turned + np.abs(states[number])
    ahead = np.argsort(turned, kind="stable")
    chosen = np.sort(ahead[first_of_each(pose_keys(layout, states[:, ahead]))])
    return states[:, chosen], batch.residual[keep][chosen], batch.condition[keep][chosen]


def _wrap_angles(layout: Layout, states: Floats) -> None:
    """Brings the angles of unknown turns into (-pi, pi], and parameters of closed curves between
    their ends, in place; threads keep their turns."""
    driven = {layout.state(edge, freedom) for edge, freedom in layout.graph.inputs}
    for carrier in layout.carriers:
        for number, freedom in enumerate(carrier.part.type.freedoms, start=carrier.state):
            if freedom.is_cyclic and number not in driven:
                row = states[number]
                row -= np.ceil((row - pi) / (2.0 * pi)) * (2.0 * pi)
        if carrier.part.track is not None:
            own = slice(carrier.state, carrier.state + len(carrier.part.at))
            if driven.isdisjoint(range(own.start, own.stop)):
                states[own] = carrier.part.track.wrapped(states[own])


def all_assemblies(
    session: Session, inputs: Floats, within: Within | None = None, *, thorough: bool = True
) -> Assemblies:
    """All assemblies at some inputs (inputs,) that random starts find, or those `within` a box;
    not `thorough`: most of them, where one is wanted. Of a mechanism that is held in a family those
    of the family."""
    turns, about = session.problem.assembly.turns, _named_turns(session)
    if within is not None:
        found = assemblies(session.layout, session.plan, inputs, turns, within, about, thorough)
    else:
        found = _everywhere(session.structure, inputs, turns, about, False)
        if thorough and not (found.complete or found.cut):
            found = _everywhere(session.structure, inputs, turns, about, True)
    if not session.problem.stopped:
        return found
    own = lies_in_family(session, inputs, found.states)
    return found._replace(
        states=found.states[:, own], residual=found.residual[own], condition=found.condition[own]
    )


@remembered
def _everywhere(
    structure: Structure, inputs: Floats, turns: int, about: Floats, thorough: bool
) -> Assemblies:
    return assemblies(structure.layout, structure.plan, inputs, turns, None, about, thorough)


def _named_turns(session: Session) -> Floats:
    """(states,): the turns of threads that the assembly's `near` names, else zero."""
    states: Floats = np.zeros(session.layout.states)
    for name, value in session.problem.assembly.near.items():
        owner, _, coordinate = name.rpartition(".")
        joint, edge = session.layout.mechanism.joints[owner], session.layout.edge_number.get(owner)
        if edge is not None and joint.type.counts_turns:
            number = session.layout.state(edge, joint.type.freedom_of[coordinate])
            states[number] = value / joint.unit_of(coordinate, session.layout.length)
    return states
