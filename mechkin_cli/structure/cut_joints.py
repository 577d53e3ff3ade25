"""Cut joints: those at which the loops of a mechanism are closed.

What is placed before a group counts as one vertex (`closings_of`; docs/numerics.md, Closing
joints). The loops of a group are closed at the joints with most freedoms: least equations, a
minimum spanning tree by freedoms (Kruskal 1956). Among equals the loops are split evenly at their
cut joints; then the first joints as written close. A loop that would pass many joints is closed
where it is shortest, and so are the loops of large groups (short_loops.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, groupby, product
from math import comb, prod

from mechkin_cli.mechanism import GROUND_NAME
from mechkin_cli.structure.network import Connection, Reduction, Subgraph, depths, outward
from mechkin_cli.structure.short_loops import short_cuts
from mechkin_cli.tolerances import FULL_EQUATIONS, MOST_COMPARED_TREES, MOST_LOOP_JOINTS


def closing_names(whole: Reduction, groups: Sequence[Subgraph]) -> list[str]:
    """The cut joints of all groups: fewest equations first, then as written."""
    depth = {GROUND_NAME: 0}
    above: dict[str, str] = {}
    chosen: dict[str, int] = {}
    for group in groups:
        cuts = _shortened(group, closings_of(group, depth), depth, above)
        some = {c.name: c.equations for c in cuts}
        tree = [c for c in group.connections if c.has_coordinates and c.name not in some]
        above.update(outward(tree, depth))
        depth.update(depths(tree, depth))
        chosen.update(some)
    written = [name for name in whole.joints if name in chosen]
    return sorted(written, key=chosen.__getitem__)


def _shortened(
    group: Subgraph,
    chosen: list[Connection],
    depth: Mapping[str, int],
    above: Mapping[str, str],
) -> list[Connection]:
    """The cut joints, or, of one loop that they make long, that which makes it shortest.

    A rhomb of scissors is split most evenly where both halves lead to ground by a side of the
    scissors each, but closes in itself as well: with the storeys loops would grow, and with the
    square of the storeys the work. `above` is the link that carries a link.
    """
    farthest = max((depth.get(link, 0) for c in group.connections for link in c.ends), default=0)
    if len(chosen) != 1 or 2 * (farthest + len(group.links)) <= MOST_LOOP_JOINTS:
        return chosen
    joints = [c for c in group.connections if c.has_coordinates]
    own = set(group.links)

    def key(cut: Connection) -> tuple[float, bool]:
        # where all are long the group's links stay joined, so that the loops on them are short
        return _passed(joints, cut, depth, above), cut.first in own and cut.second in own

    (best,), least = chosen, key(chosen[0])
    if least[0] <= MOST_LOOP_JOINTS:
        return chosen
    for c in joints:
        if not c.stays and c.equations == chosen[0].equations and (found := key(c)) < least:
            best, least = c, found
    return [best]


def _passed(
    joints: Sequence[Connection],
    cut: Connection,
    depth: Mapping[str, int],
    above: Mapping[str, str],
) -> float:
    """How many joints of the tree a loop passes with a cut joint; more than `MOST_LOOP_JOINTS` are
    not told apart, and without a tree they are infinite."""
    tree = [c for c in joints if c is not cut]
    found, below = depths(tree, depth), outward(tree, depth)
    if not all(c.first in found and c.second in found for c in tree):
        return float("inf")
    one, other, passed = cut.first, cut.second, 0
    while one != other and passed <= MOST_LOOP_JOINTS:
        first, second = (found.get(link, depth.get(link, 0)) for link in (one, other))
        if first < second:
            one, other = other, one
        one = below.get(one) or above[one]
        passed += 1
    return passed


class NothingCloses(Exception):
    """A loop of connections none of which may close it; `links` lie on it."""

    def __init__(self, connections: Sequence[Connection]) -> None:
        self.connections = tuple(connections)
        super().__init__()


def closings_of(group: Subgraph, depth: Mapping[str, int]) -> list[Connection]:
    """The connections at which a group's loops are cut.

    `depth` is the number of tree edges from ground to each link that is placed before.

    Raises:
        NothingCloses: a loop of inputs, H and the like alone.
    """
    joints = [c for c in group.connections if c.has_coordinates]
    loops = len(joints) - len(group.links)
    if not loops:
        _joined(group, joints)
        return []
    able = sorted((c for c in joints if not c.stays), key=lambda c: c.equations)
    sets = _joined(group, [c for c in joints if c.stays])
    # the first in the order of `able` that leave a tree
    chosen = [c for c in reversed(able) if not sets.join(c)][::-1]
    if sum(c.equations for c in chosen) > FULL_EQUATIONS:
        return short_cuts(group.links, joints, chosen)
    return _most_even(group, joints, able, chosen, depth)


class _Sets:
    """Which links are joined so far."""

    def __init__(self, links: Iterable[str]) -> None:
        self.top = {link: link for link in links}

    def join(self, c: Connection) -> bool:
        """Joins the ends of a connection; False if they are joined already."""
        one, other = self._root(c.first), self._root(c.second)
        if one == other:
            return False
        if one:
            self.top[one] = other
        else:
            self.top[other] = one
        return True

    def _root(self, link: str) -> str:
        """Its representative; empty for what is placed before."""
        top = self.top
        while link in top and top[link] != link:
            up = top[link]
            top[link] = top.get(up, up)
            link = top[link]
        return link if link in top else ""


def _joined(group: Subgraph, joints: Sequence[Connection]) -> _Sets:
    """The links that joints join, none of which may close a loop."""
    sets = _Sets(group.links)
    for number, c in enumerate(joints):
        if not sets.join(c):
            raise NothingCloses(_loop(group, joints[:number], c))
    return sets


def _loop(group: Subgraph, before: Sequence[Connection], last: Connection) -> list[Connection]:
    """The loop that a connection closes with some before it."""
    own = set(group.links)

    def of(link: str) -> str:
        return link if link in own else ""

    came: dict[str, Connection | None] = {of(last.first): None}
    front = [of(last.first)]
    for link in front:
        for c in before:
            for here, there in ((of(c.first), of(c.second)), (of(c.second), of(c.first))):
                if here == link and there not in came:
                    came[there] = c
                    front.append(there)
    loop, link = [last], of(last.second)
    while (back := came.get(link)) is not None:
        loop.append(back)
        link = of(back.first) if of(back.second) == link else of(back.second)
    return loop


def _most_even(
    group: Subgraph,
    joints: Sequence[Connection],
    able: Sequence[Connection],
    chosen: Sequence[Connection],
    depth: Mapping[str, int],
) -> list[Connection]:
    """Of the choices with as few equations the one whose loops are split most evenly."""
    others = [c for c in group.connections if not c.has_coordinates]
    names = {c.name for c in chosen}
    classes = [list(some) for _, some in groupby(able, key=lambda c: c.equations)]
    counts = [sum(c.name in names for c in some) for some in classes]
    if prod(comb(len(s), n) for s, n in zip(classes, counts, strict=True)) > MOST_COMPARED_TREES:
        return _exchanged(joints, others, classes, list(chosen), depth)
    best, least = list(chosen), _unevenness(joints, others, chosen, depth)
    every = (combinations(s, n) for s, n in zip(classes, counts, strict=True))
    for choice in product(*every):
        if not least:
            break
        some = [c for part in choice for c in part]
        found = _unevenness(joints, others, some, depth, least)
        if found < least:
            best, least = some, found
    return best


def _exchanged(
    joints: Sequence[Connection],
    others: Sequence[Connection],
    classes: Sequence[Sequence[Connection]],
    chosen: list[Connection],
    depth: Mapping[str, int],
) -> list[Connection]:
    """Exchanges a cut joint for another of its loop with as many freedoms where it helps."""
    least = _unevenness(joints, others, chosen, depth)
    equals = {c.name: some for some in classes for c in some}
    for k, old in enumerate(chosen):
        for new in equals[old.name]:
            if new in chosen:
                continue
            some = [*chosen[:k], new, *chosen[k + 1 :]]
            found = _unevenness(joints, others, some, depth, least)
            if found < least:
                chosen, least = some, found
    order = {c.name: k for k, c in enumerate(c for some in classes for c in some)}
    return sorted(chosen, key=lambda c: order[c.name])


def _unevenness(
    joints: Sequence[Connection],
    others: Sequence[Connection],
    closings: Sequence[Connection],
    depth: Mapping[str, int],
    most: float = float("inf"),
) -> float:
    """How much longer one path is than the other, of all loops; infinite if no tree is left."""
    names = {c.name for c in closings}
    tree = [c for c in joints if c.name not in names]
    found = depths(tree, depth)
    total = 0
    for c in (*closings, *others):
        first = found.get(c.first, depth.get(c.first))
        second = found.get(c.second, depth.get(c.second))
        if first is None or second is None:
            return float("inf")
        total += abs(second - first - len(c.constraint.slides))
        if total >= most:
            return float("inf")
    reached = all(c.first in found and c.second in found for c in tree)
    return total if reached else float("inf")
