"""Cut joints of many loops that are solved together, so that each loop passes few joints.

Loops that lead to ground, each past those before it, share their unknowns with all of these; loops
that close in themselves share them with their neighbours, and leave a band (loop_order.py). Found
are the shortest loops that are independent of each other (Horton, SIAM J. Comput. 16, 1987), each
through one joint and by the shortest way back. A loop is cut at a joint that no other one passes:
then the tree leads round each of them as it was found. Where the loops have no such joints, cut
joints are exchanged for others of their loops as long as that makes loops shorter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from mechkin_cli.structure.network import Connection
from mechkin_cli.tolerances import EXCHANGE_ROUNDS, MOST_EXCHANGED_LOOPS

Neighbours = Mapping[str, Sequence[tuple[str, int]]]
"""The links beside each, and the numbers of the joints between."""


def short_cuts(
    links: Sequence[str], joints: Sequence[Connection], chosen: Sequence[Connection]
) -> list[Connection]:
    """As many cut joints with as many equations that make shorter loops, or those `chosen`; links
    that are placed before count as one."""
    own = set(links)
    ends = [tuple(end if end in own else "" for end in (c.first, c.second)) for c in joints]
    beside: dict[str, list[tuple[str, int]]] = {}
    for number, (one, other) in enumerate(ends):
        beside.setdefault(one, []).append((other, number))
        beside.setdefault(other, []).append((one, number))
    basis = _basis(sorted(set(_shortest(ends, beside)), key=_by_length), len(chosen))
    cuts = _private(basis, joints)
    equations = sum(c.equations for c in chosen)
    if cuts is not None and sum(joints[k].equations for k in cuts) == equations:
        return [joints[k] for k in sorted(cuts)]
    if len(chosen) > MOST_EXCHANGED_LOOPS:
        return list(chosen)
    return _exchanged(joints, ends, beside, chosen)


def _by_length(loop: int) -> tuple[int, int]:
    return loop.bit_count(), loop


def _numbers(loop: int) -> Iterator[int]:
    """The joints of a loop, which is a bit for each."""
    while loop:
        lowest = loop & -loop
        yield lowest.bit_length() - 1
        loop ^= lowest


def _shortest(ends: Sequence[tuple[str, ...]], beside: Neighbours) -> Iterator[int]:
    """A shortest loop through each joint that lies on one, from both of its links at a time."""
    for number, (one, other) in enumerate(ends):
        if one == other:
            yield 1 << number
            continue
        ways = ({one: 0}, {other: 0})
        fronts = [[one], [other]]
        met: list[int] = []
        while not met and all(fronts):
            # a link with many joints, as ground, is met from both sides before it is left
            side = min(0, 1, key=lambda s: sum(len(beside[link]) for link in fronts[s]))
            here, there = ways[side], ways[1 - side]
            front = []
            for link in fronts[side]:
                for far, joint in beside[link]:
                    if joint == number or far in here:
                        continue
                    here[far] = here[link] | 1 << joint
                    front.append(far)
                    if far in there:
                        met.append(here[far] | there[far])
            fronts[side] = front
        if met:
            yield 1 << number | min(met, key=_by_length)


def _basis(loops: Sequence[int], count: int) -> list[int]:
    """The first `count` of some loops none of which others add up to."""
    reduced: dict[int, int] = {}
    found = []
    for loop in loops:
        rest = loop
        while rest and (pivot := rest.bit_length()) in reduced:
            rest ^= reduced[pivot]
        if rest:
            reduced[rest.bit_length()] = rest
            found.append(loop)
            if len(found) == count:
                break
    return found


def _private(loops: Sequence[int], joints: Sequence[Connection]) -> list[int] | None:
    """For each loop a joint that may close it and that no other one passes; None if some has
    none."""
    once = more = 0
    for loop in loops:
        more |= once & loop
        once |= loop
    cuts = []
    for loop in loops:
        able = [k for k in _numbers(loop & ~more) if not joints[k].stays]
        if not able:
            return None
        cuts.append(min(able, key=lambda k: (joints[k].equations, k)))
    return cuts


def _exchanged(
    joints: Sequence[Connection],
    ends: Sequence[tuple[str, ...]],
    beside: Neighbours,
    chosen: Sequence[Connection],
) -> list[Connection]:
    """Each cut joint in turn exchanged for that of its loop which leaves the shortest loops."""
    names = {c.name for c in chosen}
    cuts = [k for k, c in enumerate(joints) if c.name in names]
    ways = {"": 0}
    front = [""]
    for link in front:
        for far, number in beside.get(link, ()):
            if far not in ways and joints[number].name not in names:
                ways[far] = ways[link] | 1 << number
                front.append(far)
    loops = [1 << k | ways[ends[k][0]] ^ ways[ends[k][1]] for k in cuts]
    for _ in range(EXCHANGE_ROUNDS):
        is_shorter = False
        for place in sorted(range(len(cuts)), key=lambda p: (-loops[p].bit_count(), p)):
            loop, old = loops[place], joints[cuts[place]]
            gain: dict[int, int] = {}
            for p, other in enumerate(loops):
                shared = other & loop
                if p == place or not shared:
                    continue
                less = other.bit_count() - (other ^ loop).bit_count()
                for k in _numbers(shared):
                    gain[k] = gain.get(k, 0) + less
            able = {
                k: less
                for k, less in gain.items()
                if less > 0 and not joints[k].stays and joints[k].equations == old.equations
            }
            if not able:
                continue
            best = max(able, key=lambda k: (able[k], -k))
            cuts[place] = best
            loops = [
                other ^ loop if p != place and other >> best & 1 else other
                for p, other in enumerate(loops)
            ]
            is_shorter = True
        if not is_shorter:
            break
    return [joints[k] for k in sorted(cuts)]
