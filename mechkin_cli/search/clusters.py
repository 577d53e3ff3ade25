"""Where a search starts and ends: the states of a block and its random starts, whether a short
search can prove its assemblies, which end points are the same assembly, and how many may still be
unknown.

A short search can prove them where a block's real solutions are counted (`loop_equation`), or where
it finds as many as such a block has at most (`chain`). Of loops that are not counted those with a
large bound reach it for exceptional dimensions alone, and a search that does not is wasted.

`Clusters` sorts end points; `pose_keys`, `same_poses` and their kin compare poses.
"""

from __future__ import annotations

from math import isfinite, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.plan import Carrier, Layout
from mechkin_cli.record import NamedTuple
from mechkin_cli.search.chain import most_of_block
from mechkin_cli.search.loop_equation import count_assemblies

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from numpy.typing import NDArray

    from mechkin_cli.kernel.functions import RandomStarts
    from mechkin_cli.show import Bools, Floats


class Ended(NamedTuple):
    """End points (columns of `states` and of their `keys`) closed as well as possible: which of
    them are isolated assemblies, which assemblies are not, and their conditions."""

    states: Floats
    keys: Floats
    good: Bools
    free: Bools
    condition: Floats

    def part(self, own: slice) -> Ended:
        """Those of some columns."""
        return Ended(
            self.states[:, own],
            self.keys[:, own],
            self.good[own],
            self.free[own],
            self.condition[own],
        )


Within = tuple["Floats", "Floats"]
"""A box of states: centre (states,) and radius (states,), infinite where any value will do."""


def thread_states(layout: Layout, number: int) -> list[int]:
    """States of a block that are turns of threads, or counted ones."""
    unknowns = (layout.carrier_of(*u)[0] for u in layout.graph.blocks[number].unknowns)
    return [layout.carriers[k].state for k in unknowns if layout.carriers[k].part.type.counts_turns]


def most_turn(turns: int) -> float:
    """Angle of a thread within so many turns, and half a turn, to either side."""
    return pi * (2 * turns + 1)


def unknown_states(layout: Layout, number: int) -> list[int]:
    """The states of a block's unknowns, each once."""
    states: dict[int, None] = {}
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        if carrier.part.type.is_ball:
            states.update(dict.fromkeys(range(carrier.state, carrier.state + 4)))
        else:
            states[carrier.state + local] = None
    return list(states)


def upstream_states(layout: Layout, number: int) -> list[int]:
    """States of other blocks on which a block's loops depend: of the joints on their paths."""
    graph = layout.graph
    edges = graph.passed(graph.blocks[number])
    own = set(unknown_states(layout, number))
    if any(edge >= 0 and graph.edges[edge].hung for edge in edges):
        # a hung body stands where its ends are
        return [state for state in range(layout.states) if state not in own]
    return [
        state
        for carrier in layout.carriers
        if carrier.edge in edges
        for state in range(carrier.state, carrier.state + carrier.part.type.states)
        if state not in own
    ]


def on_tracks(layout: Layout, number: int, states: Floats) -> NDArray[np.bool_]:
    """Which columns of states lie between the ends of the open curves and surfaces that a block's
    unknowns go along."""
    inside = np.ones(states.shape[1], dtype=bool)
    for k in dict.fromkeys(
        layout.carrier_of(*each)[0] for each in layout.graph.blocks[number].unknowns
    ):
        carrier = layout.carriers[k]
        if carrier.part.track is not None:
            own = states[carrier.state : carrier.state + len(carrier.part.at)]
            inside &= carrier.part.track.holds(own)
    return inside


def randomise(
    layout: Layout,
    number: int,
    states: Floats,
    generator: RandomStarts,
    turns: int,
    middle: Floats,
    within: Within | None = None,
) -> None:
    """Fills the unknown states of a block with random starts, threads about `middle`; those that a
    box bounds lie in it."""
    rows = states.shape[1]
    reach = tolerances.SEARCH_SLIDES * layout.mechanism.box_diagonal() / layout.length
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        state = carrier.state + local
        if carrier.part.type.is_ball:
            if local == 0:
                states[state : state + 4] = generator.quaternions(rows)
        elif within is not None and isfinite(within[1][state]):
            generator.skip(rows)
        elif carrier.part.track is not None:
            low, high = carrier.part.track.ends[local]
            states[state] = 0.5 * (low + high) + generator.between(0.5 * (high - low), rows)
        elif carrier.part.type.slides[local]:
            states[state] = generator.between(reach, rows)
        else:
            thread = carrier.part.type.counts_turns
            half = most_turn(turns) if thread else pi
            states[state] = generator.between(half, rows)
            if thread:
                states[state] += middle[state]
    if within is None:
        return
    centre, radii = within
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        state = layout.carriers[k].state + local
        radius = float(radii[state])
        if isfinite(radius):
            states[state] = centre[state] + generator.between(radius, rows)


def is_in_reach(layout: Layout, state: Floats) -> bool:
    """Whether a short search may prove the number of assemblies at the inputs of one of them,
    `state` (states,)."""
    if len(layout.graph.blocks) > tolerances.SEARCH_MOST_QUICK_BLOCKS:
        return False
    for number, block in enumerate(layout.graph.blocks):
        most = most_of_block(layout.graph, block)
        if most is not None and most <= tolerances.SEARCH_REACHED_BOUND:
            continue
        count = count_assemblies(layout, number, state)
        if count is None or (count[0] is None and count[1] > tolerances.SEARCH_REACHED_BOUND):
            return False
    return True


_IN_CACHE = 1 << 14
"""Differences of poses that are taken all at once; more of them leave the processor's cache."""


class Clusters:
    """Representatives (columns of `states`) of the assemblies that starts ended on, told apart by
    some of the kernel's joints (None: all), and how often each was met.

    Starts are independent, so while k assemblies are known a start that closes meets a new one with
    a chance u that stays the same until it happens. That the wait for it is longer than w happens
    with chance (1 - u)^w; so with a doubt d / (k (k + 1)) for each k, d for all of them, u is at
    most log(k (k + 1) / d) / w, whenever one looks (`rest`).

    Many different assemblies that are near singular are places on a motion that dimensions only
    just stop (`SEARCH_MOST_SINGULAR`): they count as free, and so do all that come after. If they
    stand on few folds they are what rounding leaves of those: one for each.
    """

    def __init__(self, layout: Layout, carriers: Sequence[Carrier] | None = None) -> None:
        self.layout, self.carriers = layout, carriers
        self.states = np.empty((layout.states, 0))
        self.keys: Floats | None = None
        self.met = np.empty(0, dtype=np.int64)
        self.condition = np.empty(0)
        self.is_fold = np.empty(0, dtype=bool)
        self.folds = False
        self.tried = 0
        self.closed = 0
        self.newest = 0
        self.free = 0
        self.closest = float("inf")

    @property
    def number(self) -> int:
        """Of assemblies."""
        return int(self.met.size)

    def keys_of(self, states: Floats) -> Floats:
        """What end points (columns) are told apart by (keys, columns)."""
        return pose_keys(self.layout, states, self.carriers, by_turns=True)

    def unknown(self, keys: Floats) -> NDArray[np.int64]:
        """Which end points (columns of keys) are not known; those that are, are counted."""
        return self._left(keys)

    def add(self, tried: int, unknown: NDArray[np.int64], ended: Ended) -> None:
        """Sorts the unknown ones of end points that were `tried`, in the order of their starts,
        into the clusters, as they ended."""
        good, free = ended.good, int(np.count_nonzero(ended.free))
        if self.folds:
            singular = _near_singular(ended.condition)
            free += int(np.count_nonzero(good & singular))
            good = good & ~singular
        closing = np.ones(tried, dtype=bool)
        closing[unknown[~good]] = False
        order = self.closed + np.cumsum(closing)
        self.closed += int(np.count_nonzero(closing))
        self.free += free
        if good.any():
            states, keys = ended.states[:, good], ended.keys[:, good]
            self._take(states, keys, order[unknown[good]], ended.condition[good])
        if int(np.count_nonzero(_near_singular(self.condition))) > tolerances.SEARCH_MOST_SINGULAR:
            self._merge_folds()

    def _take(
        self, states: Floats, keys: Floats, order: NDArray[np.int64], condition: Floats
    ) -> None:
        """Takes in those that are still not known, each once."""
        rest = self._left(keys, condition)
        chosen, met = [], []
        while rest.size:
            # the others are none of those taken in before
            same = same_poses(keys[:, rest[:1]], keys[:, rest[1:]])[0]
            chosen.append(int(rest[0]))
            met.append(1 + int(np.count_nonzero(same)))
            rest = rest[1:][~same]
        if not chosen:
            return
        known = keys[:, :0] if self.keys is None else self.keys
        self.keys = np.concatenate([known, keys[:, chosen]], axis=1)
        self.states = np.concatenate([self.states, states[:, chosen]], axis=1)
        self.met = np.append(self.met, np.array(met, dtype=np.int64))
        self.condition = np.append(self.condition, condition[chosen])
        self.is_fold = np.append(self.is_fold, np.zeros(len(chosen), dtype=bool))
        self.newest = max(self.newest, int(order[chosen].max()))

    def _merge_folds(self) -> None:
        """Leaves one of those that are near singular on each fold, unless there are too many folds:
        that of middle condition, neither the farthest off nor one that has no tangent."""
        assert self.keys is not None
        left = np.flatnonzero(_near_singular(self.condition))
        keep = np.ones(self.number, dtype=bool)
        folds: list[int] = []
        left = left[np.argsort(self.condition[left], kind="stable")]
        while left.size:
            keys = self.keys[:, left]
            limit = _scatter(self.condition[left[:1]], self.condition[left])
            same = same_poses(keys[:, :1], keys, limit)[0]
            own = left[same]
            middle = own[own.size // 2]
            self.met[middle] = int(np.add.reduce(self.met[own]))
            keep[own] = own == middle
            folds.append(int(middle))
            left = left[~same]
        if len(folds) > tolerances.SEARCH_MOST_FOLDS:
            self._free_singular()
            return
        self.is_fold[folds] = True
        self._select(keep)

    def _select(self, keep: Bools) -> None:
        assert self.keys is not None
        self.states, self.keys = self.states[:, keep], self.keys[:, keep]
        self.met, self.condition = self.met[keep], self.condition[keep]
        self.is_fold = self.is_fold[keep]

    def _free_singular(self) -> None:
        """Leaves out those that are near singular; the wait for a new one begins again."""
        keep = ~_near_singular(self.condition)
        left_out = int(np.add.reduce(self.met[~keep]))
        self._select(keep)
        self.closed = max(self.closed - left_out, self.number)
        self.newest, self.free, self.folds = self.closed, self.free + left_out, True

    def _left(self, keys: Floats, condition: Floats | None = None) -> NDArray[np.int64]:
        """Which columns, of some conditions where these are known, are not known; those that are,
        are counted."""
        if self.keys is None:
            return np.arange(keys.shape[1])
        limit: float | Floats = tolerances.SAME_MODE
        if condition is not None:
            scattered = self.is_fold[:, None] & _near_singular(condition)
            reach = np.maximum(_scatter(self.condition, condition), tolerances.SAME_MODE)
            limit = np.where(scattered, reach, tolerances.SAME_MODE)
        known = same_poses(self.keys, keys, limit)
        self.met += np.count_nonzero(known, axis=1)
        return np.flatnonzero(~known.any(axis=0))

    @property
    def estimate(self) -> float:
        """Estimated chance that one more closing start finds a new assembly (Good 1953)."""
        return max(int(np.count_nonzero(self.met == 1)), 1) / self.closed if self.closed else 1.0

    def rest(self, doubt: float) -> float:
        """Bound of that chance, and before the first closing of the chance that a start closes; the
        chance that it does not hold is `doubt`."""
        waited = self.closed - self.newest if self.closed else self.tried
        if not waited:
            return 1.0
        pairs = max(self.number * (self.number + 1), 1)
        return min(1.0, float(functions.log(pairs / doubt)) / waited)


def _near_singular(condition: Floats) -> Bools:
    singular: Bools = ~(condition < tolerances.CONDITION_NEAR_SINGULAR)
    return singular


def _scatter(known: Floats, others: Floats) -> Floats:
    """By how much poses on one fold may differ, of some conditions (known, others): these go as the
    inverse of the distance from it, unlike along a motion that hardly ends."""
    apart: Floats = tolerances.FOLD_CONDITION * (1.0 / known[:, None] + 1.0 / others[None, :])
    return apart


def pose_keys(
    layout: Layout,
    states: Floats,
    carriers: Sequence[Carrier] | None = None,
    left_out: Collection[tuple[int, int]] = (),
    *,
    by_turns: bool = False,
) -> Floats:
    """Numbers (keys, columns) that differ between assemblies: cosines and sines of turns, slides,
    products of quaternions, places on curves and surfaces, of some of the kernel's joints (None:
    all).

    `left_out` are freedoms (tree edge, number) that do not matter; `by_turns`, places a whole turn
    apart differ where couplings count it, which have yet to say where other joints stand then.
    """
    used = [
        carrier
        for carrier in (layout.carriers if carriers is None else carriers)
        if (carrier.edge, carrier.first_freedom) not in left_out
    ]
    triples = _turn_triples(layout, used)
    turns = _cosines_and_sines(states, used, by_turns)
    keys: list[Floats] = []
    for triple in triples:
        (cz, sz), (cy, sy), (cx, sx) = (
            (functions.cos(states[n]), functions.sin(states[n])) for n in triple
        )
        # the rotation about z, y and x, one after the other
        keys += [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx]
        keys += [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx]
        keys += [-sy, cy * sx, cy * cx]
    for carrier in used:
        state = carrier.state
        if any(state in triple for triple in triples):
            continue
        if carrier.part.type.is_ball:
            q = states[state : state + 4]
            keys.extend(q[i] * q[j] for i in range(4) for j in range(i, 4))
            continue
        if carrier.part.track is not None:
            places = carrier.part.track.places_at(states[state : state + len(carrier.part.at)])
            keys.extend(place / layout.length for place in places)
            continue
        for number in range(state, state + len(carrier.part.type.freedoms)):
            keys.extend(turns.get(number) or (states[number],))
    return np.array(keys) if keys else np.zeros((0, states.shape[1]))


def counted_turns(layout: Layout) -> list[int]:
    """The states of turns that couplings count."""
    return [
        carrier.state + number
        for carrier in layout.carriers
        for number, freedom in enumerate(carrier.part.type.freedoms)
        if freedom.counted
    ]


def _turn_triples(layout: Layout, carriers: Sequence[Carrier]) -> list[list[int]]:
    """States of three turns rz, ry, rx that make an orientation: two triples make the same one."""
    triples: dict[int, list[int]] = {}
    for carrier in sorted(carriers, key=lambda carrier: carrier.first_freedom):
        turns = any(freedom.is_cyclic for freedom in carrier.part.type.freedoms)
        if turns and layout.graph.edges[carrier.edge].joint.type.is_free:
            triples.setdefault(carrier.edge, []).append(carrier.state)
    return [turns for turns in triples.values() if len(turns) == 3]


def _cosines_and_sines(
    states: Floats, carriers: Sequence[Carrier], by_turns: bool
) -> dict[int, tuple[Floats, Floats]]:
    """Of the turns of some joints, by state."""
    cyclic = [
        number
        for carrier in carriers
        for number, freedom in enumerate(carrier.part.type.freedoms, start=carrier.state)
        if freedom.is_cyclic or (freedom.counted and not by_turns)
    ]
    angles = states[cyclic].reshape(-1)
    shape = (len(cyclic), states.shape[1])
    cosines, sines = (f(angles).reshape(shape) for f in (functions.cos, functions.sin))
    return dict(zip(cyclic, zip(cosines, sines, strict=True), strict=True))


def same_poses(
    known: Floats, keys: Floats, limit: float | Floats = tolerances.SAME_MODE
) -> NDArray[np.bool_]:
    """Which columns of `keys` are the poses of which columns of `known`: (known, keys), as `limit`
    may be."""
    if known.size * keys.shape[1] <= _IN_CACHE:
        near = np.abs(known[:, :, None] - keys[:, None, :]) < limit
        few: NDArray[np.bool_] = np.logical_and.reduce(near, axis=0)
        return few
    same = np.ones((known.shape[1], keys.shape[1]), dtype=bool)
    for one, other in zip(known, keys, strict=True):
        same &= np.abs(one[:, None] - other[None, :]) < limit
    return same


def pose_number(
    layout: Layout, states: Floats, state: Floats, limit: float = tolerances.SAME_MODE
) -> int | None:
    """Which of some assemblies (states, number) a state (states,) is; None if none of them."""
    keys = pose_keys(layout, states), pose_keys(layout, state[:, None])
    same = same_poses(*keys, limit)[:, 0]
    return int(np.argmax(same)) if same.any() else None


def first_of_each(keys: Floats) -> NDArray[np.int64]:
    """Which columns are poses that no column before them is.

    Columns are sorted by one sum over their keys; the same poses are neighbours there.
    """
    weights = 1.0 + 0.6180339887498949 * np.arange(keys.shape[0])
    sums = np.zeros(keys.shape[1])
    for weight, key in zip(weights, keys, strict=True):
        sums = sums + weight * key

    reach = tolerances.SAME_MODE * keys.shape[0] * float(weights[-1:].max(initial=1.0))
    order = np.argsort(sums, kind="stable")
    is_first = np.ones(keys.shape[1], dtype=bool)
    for apart in range(1, keys.shape[1]):
        near = np.flatnonzero(sums[order[apart:]] - sums[order[:-apart]] <= reach)
        if not near.size:
            break
        one, other = order[near], order[near + apart]
        same = (np.abs(keys[:, one] - keys[:, other]) < tolerances.SAME_MODE).all(axis=0)
        is_first[np.maximum(one, other)[same]] = False
    return np.flatnonzero(is_first)
