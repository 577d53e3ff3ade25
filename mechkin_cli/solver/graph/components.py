"""Biconnected components: the parts of the network whose loops share connections.

Loops of different components have no connection in common, so each component is solved by itself,
against the link at which it hangs (Hopcroft, Tarjan 1973, Algorithm 447; linear).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from mechkin_cli.solver.graph.network import Connection


class Component(NamedTuple):
    """Connections of one component in their order; `entry` is its link nearest to ground."""

    entry: str
    connections: tuple[Connection, ...]

    @property
    def links(self) -> tuple[str, ...]:
        """Its links without the entry."""
        ends = (link for c in self.connections for link in (c.first, c.second))
        return tuple(link for link in dict.fromkeys(ends) if link != self.entry)

    @property
    def space(self) -> int:
        """Freedoms of a free body of it: six, or three in a plane."""
        return min(c.space for c in self.connections)

    @property
    def loops(self) -> int:
        """Independent loops."""
        return len(self.connections) - len(self.links)


def biconnected(
    connections: Sequence[Connection], at: dict[str, list[int]], root: str
) -> list[Component]:
    """The components of what is joined to the root; each after the one that holds its entry."""
    depth = {root: 0}
    low = {root: 0}
    walked: list[int] = []
    used: set[int] = set()
    found: list[Component] = []
    path = [(root, iter(at.get(root, ())), 0)]
    while path:
        link, ahead, start = path[-1]
        for number in ahead:
            if number in used:
                continue
            used.add(number)
            walked.append(number)
            other = connections[number].other(link)
            if other in depth:
                low[link] = min(low[link], depth[other])
                continue
            depth[other] = low[other] = len(path)
            path.append((other, iter(at[other]), len(walked) - 1))
            break
        else:
            path.pop()
            if path:
                parent = path[-1][0]
                low[parent] = min(low[parent], low[link])
                if low[link] >= depth[parent]:
                    members = tuple(connections[k] for k in sorted(walked[start:]))
                    found.append(Component(parent, members))
                    del walked[start:]
    return found[::-1]
