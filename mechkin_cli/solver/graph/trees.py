"""The joints at which the loops of a group are closed, and the tree that is left.

What is placed before a group counts as one vertex. Joints with most freedoms close
(docs/numerics.md, Closing joints): least equations, a minimum spanning tree by freedoms (Kruskal
1956). Among equals the loops are split evenly at their closing joints; then the first joints as
written close.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, groupby, product
from math import comb, prod

from mechkin_cli.solver.graph.assur import Group
from mechkin_cli.solver.graph.network import Connection
from mechkin_cli.tolerances import MOST_COMPARED_TREES, MOST_EQUATIONS


class NothingCloses(Exception):
    """A loop of connections none of which may close it; `links` lie on it."""

    def __init__(self, connections: Sequence[Connection]) -> None:
        self.connections = tuple(connections)
        super().__init__()


def closings_of(group: Group, depth: Mapping[str, int]) -> list[Connection]:
    """The connections at which a group's loops are closed, legs left out.

    `depth` is the number of tree edges from ground to each link that is placed before.

    Raises:
        NothingCloses: a loop of inputs, H and the like alone.
    """
    joints = [c for c in group.connections if c.leg is None]
    loops = len(joints) - len(group.links)
    if not loops:
        _check_tree(group, joints)
        return []
    able = sorted((c for c in joints if not c.stays), key=lambda c: c.equations)
    fixed = [c for c in joints if c.stays]
    chosen = _first_choice(group, fixed, able)
    if sum(c.equations for c in chosen) > MOST_EQUATIONS:
        return chosen  # too large a block to be solved, however its loops are split
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


def _check_tree(group: Group, joints: Sequence[Connection]) -> None:
    sets = _Sets(group.links)
    for number, c in enumerate(joints):
        if not sets.join(c):
            raise NothingCloses(_loop(group, joints[:number], c))


def _first_choice(
    group: Group, fixed: Sequence[Connection], able: Sequence[Connection]
) -> list[Connection]:
    """The first in the order of `able` that leaves a tree."""
    sets = _Sets(group.links)
    for number, c in enumerate(fixed):
        if not sets.join(c):
            raise NothingCloses(_loop(group, fixed[:number], c))
    return [c for c in reversed(able) if not sets.join(c)][::-1]


def _loop(group: Group, before: Sequence[Connection], last: Connection) -> list[Connection]:
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
    found, link = [last], of(last.second)
    while (back := came.get(link)) is not None:
        found.append(back)
        link = of(back.first) if of(back.second) == link else of(back.second)
    return found


def _most_even(
    group: Group,
    joints: Sequence[Connection],
    able: Sequence[Connection],
    chosen: Sequence[Connection],
    depth: Mapping[str, int],
) -> list[Connection]:
    """Of the choices with as few equations the one whose loops are split most evenly."""
    legs = [c for c in group.connections if c.leg is not None]
    names = {c.name for c in chosen}
    classes = [list(some) for _, some in groupby(able, key=lambda c: c.equations)]
    counts = [sum(c.name in names for c in some) for some in classes]
    if prod(comb(len(s), n) for s, n in zip(classes, counts, strict=True)) > MOST_COMPARED_TREES:
        return _exchanged(joints, legs, classes, list(chosen), depth)
    best, least = list(chosen), _unevenness(joints, legs, chosen, depth)
    every = (combinations(s, n) for s, n in zip(classes, counts, strict=True))
    for choice in product(*every):
        if not least:
            break
        some = [c for part in choice for c in part]
        found = _unevenness(joints, legs, some, depth, least)
        if found < least:
            best, least = some, found
    return best


def _exchanged(
    joints: Sequence[Connection],
    legs: Sequence[Connection],
    classes: Sequence[Sequence[Connection]],
    chosen: list[Connection],
    depth: Mapping[str, int],
) -> list[Connection]:
    """Exchanges a closing joint for another of its loop with as many freedoms where it helps."""
    least = _unevenness(joints, legs, chosen, depth)
    equals = {c.name: some for some in classes for c in some}
    for k, old in enumerate(chosen):
        for new in equals[old.name]:
            if new in chosen:
                continue
            some = [*chosen[:k], new, *chosen[k + 1 :]]
            found = _unevenness(joints, legs, some, depth, least)
            if found < least:
                chosen, least = some, found
    order = {c.name: k for k, c in enumerate(c for some in classes for c in some)}
    return sorted(chosen, key=lambda c: order[c.name])


def _unevenness(
    joints: Sequence[Connection],
    legs: Sequence[Connection],
    closings: Sequence[Connection],
    depth: Mapping[str, int],
    most: float = float("inf"),
) -> float:
    """How much longer one way is than the other, of all loops; infinite if no tree is left."""
    names = {c.name for c in closings}
    tree = [c for c in joints if c.name not in names]
    found = tree_depths(tree, depth)
    total = 0
    for c in (*closings, *legs):
        first = found.get(c.first, depth.get(c.first))
        second = found.get(c.second, depth.get(c.second))
        if first is None or second is None:
            return float("inf")
        slides = c.leg is not None and c.leg.slide is not None
        total += abs(second - first - slides)
        if total >= most:
            return float("inf")
    reached = all(c.first in found and c.second in found for c in tree)
    return total if reached else float("inf")


def tree_depths(tree: Sequence[Connection], depth: Mapping[str, int]) -> dict[str, int]:
    """Tree edges from ground to each link at some connections that are reached from those
    placed before."""
    ends: dict[str, list[str]] = {}
    for c in tree:
        ends.setdefault(c.first, []).append(c.second)
        ends.setdefault(c.second, []).append(c.first)
    found = {link: depth[link] for link in ends if link in depth}
    front = list(found)
    for link in front:
        for other in ends[link]:
            if other not in found:
                found[other] = found[link] + 1
                front.append(other)
    return found
