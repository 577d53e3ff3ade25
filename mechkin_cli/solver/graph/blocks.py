"""Blocks: groups with their closings, each after the groups that place the links it hangs on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from heapq import heapify, heappop, heappush

from mechkin_cli.mechanism.model import GROUND_NAME
from mechkin_cli.solver.graph.assur import Group
from mechkin_cli.solver.graph.matching import strong_components
from mechkin_cli.solver.graph.network import Connection
from mechkin_cli.solver.graph.records import Block, Closing, TreeEdge

Freedom = tuple[int, int]


class NothingSolved(Exception):
    """Some connections without unknowns beside those of their closing joints.

    `loops` are the names of the joints in their loops, the closing joint first; legs close others.
    """

    def __init__(
        self, connections: Sequence[Connection], loops: Sequence[Sequence[str]], equations: int
    ) -> None:
        self.connections = tuple(connections)
        self.loops = loops
        self.equations = equations
        super().__init__()


def in_order(
    groups: Sequence[Group], edges: Sequence[TreeEdge], place: Mapping[str, int]
) -> list[list[Group]]:
    """Groups in the order of solution; those together that the tree makes depend on each other.

    `place` numbers the closings; first comes what has fewest of them, then what is numbered first.
    """
    owner = {link: k for k, group in enumerate(groups) for link in group.links}
    ahead: list[set[int]] = [set() for _ in groups]
    for k, group in enumerate(groups):
        ends = {link for c in group.connections for link in (c.first, c.second)}
        ahead[k] = {owner[link] for link in (*ends, group.entry) if link != GROUND_NAME} - {k}
    for edge in edges:
        if edge.child in owner and edge.parent in owner:
            one, other = owner[edge.child], owner[edge.parent]
            if one != other:
                ahead[one].add(other)
    parts = strong_components([sorted(some) for some in ahead], range(len(groups)))
    part_of = {k: p for p, part in enumerate(parts) for k in part}
    waits = [{part_of[o] for k in part for o in ahead[k]} - {p} for p, part in enumerate(parts)]
    behind: list[list[int]] = [[] for _ in parts]
    for p, some in enumerate(waits):
        for other in some:
            behind[other].append(p)

    def key(p: int) -> tuple[int, list[int], int]:
        names = [c.name for k in parts[p] for c in groups[k].connections]
        numbers = sorted(place[name] for name in names if name in place)
        return (len(numbers), numbers, p)

    count = [len(some) for some in waits]
    ready = [key(p) for p in range(len(parts)) if not count[p]]
    heapify(ready)
    found: list[list[Group]] = []
    while ready:
        p = heappop(ready)[2]
        found.append([groups[k] for k in parts[p]])
        for other in behind[p]:
            count[other] -= 1
            if not count[other]:
                heappush(ready, key(other))
    return found


def lay_blocks(
    order: Sequence[Sequence[Group]],
    edges: Sequence[TreeEdge],
    closings: Mapping[str, Closing],
    place: Mapping[str, int],
    driven: Sequence[Freedom],
) -> tuple[list[Closing], list[Block], set[Freedom]]:
    """Closings in block order, the blocks, and the freedoms that are known in the end.

    Raises:
        NothingSolved: a block has no unknowns.
    """
    solved = set(driven)
    laid: list[Closing] = []
    blocks: list[Block] = []
    for part in order:
        connections = [c for group in part for c in group.connections]
        names = sorted((c.name for c in connections if c.name in closings), key=place.__getitem__)
        if not names:
            continue
        some = [closings[name] for name in names]
        members = sorted({k for closing in some for k, _ in closing.loop})
        freedoms = [(k, f) for k in members for f in range(edges[k].freedoms)]
        unknowns = tuple(freedom for freedom in freedoms if freedom not in solved)
        equations = sum(closing.equations for closing in some)
        if not unknowns:
            loops = [
                [closing.joint.name, *(edges[k].joint.name for k, _ in closing.loop)]
                for closing in some
                if closing.leg is None
            ]
            raise NothingSolved(connections, loops, equations)
        start = len(laid)
        laid.extend(some)
        solved.update(unknowns)
        blocks.append(Block(tuple(range(start, len(laid))), unknowns, equations))
    return laid, blocks, solved
