"""Determined sets of links that hold each other twice, which are solved together.

Two equal rods a quarter apart couple wheels that either of them lets go in line; a strut between
two copies of a linkage has dead centres where the copies have none. Solved by one of them alone, a
link is lost where the other still holds it. So where one of its own connections is taken out of a
set, and later sets hold some of its links all the same, these sets are one.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Protocol

from mechkin_cli.solver.graph.matching import strong_components
from mechkin_cli.solver.graph.network import Connection
from mechkin_cli.solver.graph.rates import joins

Links = tuple[str, ...]


class Search(Protocol):
    """What is determined among some links."""

    def core(self, links: Sequence[str], placed: Collection[str], without: str = "") -> list[str]:
        """The largest determined set, `without` a connection."""
        ...

    def around(self, links: Sequence[str]) -> list[Connection]:
        """The connections at some links."""
        ...


def solved_together(sets: Sequence[Links], search: Search, entry: str) -> list[Links]:
    """The sets, each after those that it needs, as they are to be solved."""
    owner = {link: k for k, links in enumerate(sets) for link in links}
    ahead = []
    placed = {entry}
    for k, links in enumerate(sets):
        ends = {end for c in search.around(links) for end in (c.first, c.second)}
        before = {owner[end] for end in ends if owner.get(end, k) < k}
        ahead.append(sorted(before | _holding(k, sets, search, placed)))
        placed.update(links)
    together = strong_components(ahead, range(len(sets)))
    return [tuple(link for k in part for link in sets[k]) for part in together]


def _holding(
    number: int, sets: Sequence[Links], search: Search, placed: Collection[str]
) -> set[int]:
    """The later sets that hold a link of one where one of its connections is missing."""
    own = sets[number]

    def holds(later: Sequence[int], missing: str) -> bool:
        links = [*own, *(link for k in later for link in sets[k])]
        return not set(own).isdisjoint(search.core(links, placed, missing))

    for c in search.around(own):
        later = list(range(number + 1, len(sets)))
        if not joins(c, own, placed) or not holds(later, c.name):
            continue
        while later and holds(later[:-1], c.name):
            later.pop()
        for k in later[-2::-1]:
            fewer = [other for other in later if other != k]
            later = fewer if holds(fewer, c.name) else later
        return set(later)
    return set()
