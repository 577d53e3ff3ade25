"""Groups as the rank of their loops says, where there are more equations than freedoms.

Then a matching cannot tell which equations are new, and proposes groups only. A set of links is
*determined* if none of them can move while the inputs and what is placed before rest. If a set is
not, the links that cannot move all the same hold the largest determined set within it; two
determined sets are one together. So whatever is proposed, a group is as soon as it is determined,
and it is a smallest one if no determined set is left when any one of its links is taken away.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from mechkin_cli.solver.graph.components import Component
from mechkin_cli.solver.graph.network import Connection
from mechkin_cli.solver.graph.rates import Rates
from mechkin_cli.tolerances import MOST_SPLIT_LINKS


class Found(NamedTuple):
    """Sets of links in the order in which they are determined, and those that are not."""

    sets: list[tuple[str, ...]]
    left: tuple[str, ...]


def determined_sets(
    component: Component, proposed: Sequence[Collection[str]], rates: Rates
) -> Found:
    """The determined sets of a component, from proposals in their order."""
    search = _Search(component.connections, rates)
    placed = {component.entry}
    found: list[tuple[str, ...]] = []
    waiting: list[str] = []
    for links in proposed:
        waiting += links
        some = search.core(waiting, placed)
        if not some:
            continue
        waiting = [link for link in waiting if link not in some]
        for part in search.split(some, placed):
            found.append(tuple(part))
            placed.update(part)
    return Found(found, tuple(waiting))


class _Search:
    def __init__(self, connections: Sequence[Connection], rates: Rates) -> None:
        self.connections = connections
        self.rates = rates

    def core(self, links: Sequence[str], placed: Collection[str]) -> list[str]:
        """The largest determined set within some links, in their order."""
        members = list(links)
        while members:
            still = self.rates.still(set(members), self.connections, placed)
            if len(still) == len(members):
                break
            members = [link for link in members if link in still]
        return members

    def split(self, links: Sequence[str], placed: Collection[str]) -> list[list[str]]:
        """A determined set in smallest ones, each after those that it needs."""
        if len(links) > MOST_SPLIT_LINKS or self._is_one_loop(links, placed):
            return [list(links)]
        for link in reversed(links):
            some = self.core([other for other in links if other != link], placed)
            if some:
                rest = [other for other in links if other not in some]
                return [*self.split(some, placed), *self.split(rest, {*placed, *some})]
        return [list(links)]

    def _is_one_loop(self, links: Sequence[str], placed: Collection[str]) -> bool:
        """Whether some links are in one loop together, which determines all or none."""
        own = set(links)
        inside = {*own, *placed}
        held = [
            c
            for c in self.connections
            if (c.first in own or c.second in own) and c.first in inside and c.second in inside
        ]
        ends = [link for c in held for link in (c.first, c.second)]
        return len(held) == len(links) + 1 and all(ends.count(link) == 2 for link in links)
