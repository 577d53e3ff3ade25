"""Regions of low order: joints whose screws span less than those of their component.

Links of a plane linkage in space have three freedoms against each other, not six, and each of its
joints that many equations less; likewise about a point, without turning, in Bennett's loop. Where
such a region is only a part of a component, its links share the pose of its frame (the plane), and
have the freedoms of its order beside it. The order is that of the screws as drawn (loop_rank.py).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from mechkin_cli.solver.graph.components import Component
from mechkin_cli.solver.graph.network import Connection, incidence
from mechkin_cli.solver.loop_rank import loop_order

SPACE = 6
"""Freedoms of a body in space."""


class Region(NamedTuple):
    """Numbers of the connections of a region in its component, its links, and its order."""

    connections: frozenset[int]
    links: frozenset[str]
    order: int


def order_of(connections: Iterable[Connection]) -> int:
    """Rank of the screws of some connections; six with a leg or a free pair among them."""
    members = tuple(connections)
    if not all(c.has_screws for c in members):
        return SPACE
    return loop_order(tuple(sorted(c.joint for c in members)))


def find_regions(component: Component, order: int) -> list[Region]:
    """The regions of lower order than the component's, the lowest first."""
    connections = component.connections
    at = incidence(connections)
    cycles = {
        cycle
        for one, other in _neighbours(connections, at)
        if (cycle := _shortest(connections, at, one, other))
    }
    seeds = [
        (rank, sorted(cycle))
        for cycle in cycles
        if (rank := order_of(connections[k] for k in cycle)) < order
    ]
    if not seeds:
        return []
    merged = _merged(connections, sorted(seeds))
    found = [_grown(connections, at, numbers, rank) for rank, numbers in merged]
    return sorted(found, key=lambda region: (region.order, -len(region.connections)))


def _neighbours(
    connections: Sequence[Connection], at: dict[str, list[int]]
) -> list[tuple[int, int]]:
    """Pairs of joints on a link, of each joint's two links that with fewer joints."""
    found: set[tuple[int, int]] = set()
    for number, c in enumerate(connections):
        fewest = min(len(at[c.first]), len(at[c.second]))
        for link in (c.first, c.second):
            if len(at[link]) == fewest:
                found |= {(min(number, k), max(number, k)) for k in at[link] if k != number}
    screws = [c.has_screws for c in connections]
    return sorted(pair for pair in found if screws[pair[0]] and screws[pair[1]])


def _shortest(
    connections: Sequence[Connection], at: dict[str, list[int]], one: int, other: int
) -> frozenset[int] | None:
    """A shortest loop of joints through two on one link, None where there is none."""
    pair = (connections[one], connections[other])
    link = next(end for end in (pair[0].first, pair[0].second) if end in pair[1][1:3])
    start, goal = pair[0].other(link), pair[1].other(link)
    came = {start: (start, one), link: (link, one)}
    front = [start]
    for near in front:
        if near == goal:
            cycle = [one, other]
            while near != start:
                near, k = came[near]
                cycle.append(k)
            return frozenset(cycle)
        for k in at[near]:
            far = connections[k].other(near)
            if far not in came and connections[k].has_screws:
                came[far] = (near, k)
                front.append(far)
    return None


def _merged(
    connections: Sequence[Connection], seeds: Sequence[tuple[int, list[int]]]
) -> list[tuple[int, set[int]]]:
    """Loops of one order that share a joint and span nothing more together, as one region."""
    regions: list[tuple[int, set[int], tuple[int, ...]] | None] = []
    owners: dict[int, list[int]] = {}
    for rank, cycle in seeds:
        members, base = set(cycle), _base(connections, cycle, rank)
        near = {r for k in cycle for r in owners.get(k, ())}
        for r in sorted(near):
            other = regions[r]
            if other is None or other[0] != rank:
                continue
            both = {*base, *other[2]}
            if order_of(connections[k] for k in both) == rank:
                members |= other[1]
                regions[r] = None
        for k in members:
            owners.setdefault(k, []).append(len(regions))
        regions.append((rank, members, base))
    return [(region[0], region[1]) for region in regions if region is not None]


def _base(connections: Sequence[Connection], cycle: Sequence[int], rank: int) -> tuple[int, ...]:
    """The first joints of a loop that span what all of them do."""
    for count in range(1, len(cycle)):
        if order_of(connections[k] for k in cycle[:count]) == rank:
            return tuple(cycle[:count])
    return tuple(cycle)


def _grown(
    connections: Sequence[Connection], at: dict[str, list[int]], numbers: set[int], rank: int
) -> Region:
    """With the joints between links of the region that span nothing more."""
    links = {link for k in numbers for link in (connections[k].first, connections[k].second)}
    base = _base(connections, sorted(numbers), rank)
    inside = {k for link in links for k in at[link]} - numbers
    more = {
        k
        for k in inside
        if connections[k].first in links
        and connections[k].second in links
        and connections[k].has_screws
        and order_of(connections[b] for b in (*base, k)) == rank
    }
    return Region(frozenset(numbers | more), frozenset(links), rank)
