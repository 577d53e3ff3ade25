"""Groups as the rank of their loops says, where there are more equations than freedoms.

Then a matching cannot tell which equations are new, and proposes groups only. A set of links is
*determined* if none of them can move while the inputs and what is placed before rest. If a set is
not, the links that cannot move all the same hold the largest determined set within it; two
determined sets are one together. So whatever is proposed, a group is as soon as it is determined,
and it is a smallest one if no determined set is left when any one of its links is taken away.
Smallest sets that hold each other twice are one in the end (`held_twice`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from mechkin_cli.solver.graph.components import Component
from mechkin_cli.solver.graph.held_twice import solved_together
from mechkin_cli.solver.graph.network import Connection, incidence
from mechkin_cli.solver.graph.rates import Rates, joins
from mechkin_cli.solver.graph.regions import SPACE
from mechkin_cli.tolerances import MOST_SPLIT_LINKS


class Found(NamedTuple):
    """Sets of links in the order in which they are determined, and those that are not."""

    sets: list[tuple[str, ...]]
    left: tuple[str, ...]


def determined_sets(
    component: Component, proposed: Sequence[Collection[str]], rates: Rates
) -> Found:
    """The determined sets of a component, from proposals in their order.

    A small component is looked at as a whole, so that no proposal decides between sets.
    """
    search = _Search(component.connections, rates)
    placed = {component.entry}
    found: list[tuple[str, ...]] = []
    waiting: list[str] = []
    ordered = [link for links in proposed for link in links]
    whole = len(ordered) <= MOST_SPLIT_LINKS
    for links in [ordered] if whole else proposed:
        waiting += links
        some = search.core(waiting, placed)
        waiting = [link for link in waiting if link not in some]
        for part in search.split(some, placed):
            found.append(tuple(part))
            placed.update(part)
    return Found(solved_together(found, search, component.entry), tuple(waiting))


class _Search:
    def __init__(self, connections: Sequence[Connection], rates: Rates) -> None:
        self.connections = connections
        self.rates = rates
        self.at = incidence(connections)
        self._failed: dict[tuple[str, ...], int] = {}

    def core(self, links: Sequence[str], placed: Collection[str], without: str = "") -> list[str]:
        """The largest determined set within some links, in their order, `without` a connection."""
        members = list(links)
        while members:
            around = [c for c in self.around(members) if c.name != without]
            still = self.rates.still(set(members), around, placed)
            if len(still) == len(members):
                break
            members = [link for link in members if link in still]
        return members

    def split(self, links: Sequence[str], placed: Collection[str]) -> Iterator[list[str]]:
        """A determined set in smallest ones, each after those that it needs."""
        rest, inside = list(links), set(placed)
        while rest:
            some = self._small(rest, inside) or self._least(rest, inside)
            if len(some) < len(rest) and len(some) > 2:
                yield from self.split(some, inside)
            else:
                yield some
            inside.update(some)
            rest = [link for link in rest if link not in some]

    def _small(self, links: Sequence[str], placed: Collection[str]) -> list[str]:
        """The first determined link or pair of joined links."""
        rank = {link: k for k, link in enumerate(links)}
        pairs = (
            [link, other]
            for link in links
            for other in dict.fromkeys(self.connections[k].other(link) for k in self.at[link])
            if rank.get(other, -1) > rank[link]
        )
        for some in (*([link] for link in links), *pairs):
            if self._is_determined(some, placed):
                return some
        return []

    def _is_determined(self, links: Sequence[str], placed: Collection[str]) -> bool:
        """Whether some links are determined; tried again only where more of their connections
        lead to what is placed."""
        inside = [c for c in self.around(links) if joins(c, links, placed)]
        joints = [c for c in inside if c.leg is None]
        freedoms = sum(c.freedoms - c.driven for c in joints)
        most = SPACE * (len(joints) - len(links)) + len(inside) - len(joints)
        if freedoms > most or self._failed.get(tuple(links)) == len(inside):
            return False
        found = len(self.rates.still(links, inside, placed)) == len(links)
        if not found:
            self._failed[tuple(links)] = len(inside)
        return found

    def _least(self, links: Sequence[str], placed: Collection[str]) -> list[str]:
        """The smallest determined set that is left when one link is taken away; all links where
        none is."""
        least = list(links)
        if len(links) <= MOST_SPLIT_LINKS:
            for link in reversed(links):
                own = self.core([other for other in links if other != link], placed)
                if own and len(own) < len(least):
                    least = own
        return least

    def around(self, links: Sequence[str]) -> list[Connection]:
        """The connections at some links, in their order."""
        return [self.connections[k] for k in sorted({k for link in links for k in self.at[link]})]
