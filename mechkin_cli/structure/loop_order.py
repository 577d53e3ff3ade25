"""The order of loops that are solved for together, so that loops that share coordinates stand side
by side.

Equations and unknowns in this order make a matrix whose entries lie in a narrow band
(kernel/core/arithmetic/band.hpp), so that the work goes with the number of loops. The order is
King's (Int. J. Numer. Meth. Eng. 2, 1970): from a loop at an end on, each time the loop next to
those before that brings the fewest new coordinates. It depends on the loops alone, and on numbers
where these leave it open.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from heapq import heappop, heappush

Passed = Sequence[Sequence[int]]
"""The unknowns that each loop passes."""


def in_order(passed: Passed, unknowns: int) -> tuple[list[int], list[int]]:
    """Loops and unknowns in the order of the narrower band: as they are, or by King's method."""
    orders = list(range(len(passed))), _king(passed, unknowns)
    choices = [(loops, _unknowns_of(loops, passed, unknowns)) for loops in orders]
    return min(choices, key=lambda choice: _work(choice[0], choice[1], passed))


def entries_of(passed: Passed, equations: Sequence[int], unknowns: int) -> int:
    """Entries of the band of loops and unknowns as they stand, with those that rows exchanged in it
    may fill; `equations` of each loop."""
    begins, row = [0], 0
    for count in equations:
        begins.append(begins[-1] + count)
    first, end = [begins[-1]] * unknowns, [0] * unknowns
    for loop, own in enumerate(passed):
        for unknown in own:
            first[unknown] = min(first[unknown], begins[loop])
            end[unknown] = begins[loop + 1]
    # the rows of unknowns from `row` on end where those do that an equation may exchange with them
    entries = last = 0
    by_first = sorted(range(unknowns), key=first.__getitem__)
    reach = taken = 0
    begin = [begins[-1]] * unknowns
    for row in range(unknowns):
        before = reach
        while taken < unknowns and first[by_first[taken]] <= row:
            reach = max(reach, by_first[taken] + 1)
            taken += 1
        reach = max(reach, row + 1)
        for unknown in range(before, reach):
            last = max(last, end[unknown])
            begin[unknown] = row
        last = max(last, row + 1)
        entries += last - begin[row]
    return entries


def _loops_of(passed: Passed, unknowns: int) -> list[list[int]]:
    """The loops that pass each unknown."""
    loops: list[list[int]] = [[] for _ in range(unknowns)]
    for loop, own in enumerate(passed):
        for unknown in own:
            loops[unknown].append(loop)
    return loops


def _distances(start: int, passed: Passed, loops_of: Sequence[Sequence[int]]) -> dict[int, int]:
    """Of all loops joined to one, in the order of their distance from it."""
    distance, met = {start: 0}, set()
    queue = [start]
    for loop in queue:
        for unknown in passed[loop]:
            if unknown in met:
                continue
            met.add(unknown)
            for other in loops_of[unknown]:
                if other not in distance:
                    distance[other] = distance[loop] + 1
                    queue.append(other)
    return distance


def _end(start: int, passed: Passed, loops_of: Sequence[Sequence[int]]) -> int:
    """A loop at an end of those joined to one: the farthest from the farthest, as far as it goes.

    Gibbs, Poole and Stockmeyer, SIAM J. Numer. Anal. 13, 1976.
    """
    depth = -1
    while True:
        distance = _distances(start, passed, loops_of)
        most = max(distance.values())
        if most <= depth:
            return start
        depth = most
        start = min(
            (loop for loop, far in distance.items() if far == most),
            key=lambda loop: (len(passed[loop]), loop),
        )


def _king(passed: Passed, unknowns: int) -> list[int]:
    loops_of = _loops_of(passed, unknowns)
    new = [len(own) for own in passed]
    is_met = [False] * unknowns
    order: list[int] = []
    is_taken = [False] * len(passed)
    for first in range(len(passed)):
        if is_taken[first]:
            continue
        start = _end(first, passed, loops_of)
        met = {start: 0}
        # new coordinates, when the loop was met, which one
        heap = [(new[start], 0, start)]
        while heap:
            count, _, loop = heappop(heap)
            if is_taken[loop] or count != new[loop]:
                continue
            is_taken[loop] = True
            order.append(loop)
            for unknown in passed[loop]:
                if is_met[unknown]:
                    continue
                is_met[unknown] = True
                for other in loops_of[unknown]:
                    new[other] -= 1
                    when = met.setdefault(other, len(order))
                    heappush(heap, (new[other], when, other))
    return order


def _unknowns_of(loops: Iterable[int], passed: Passed, unknowns: int) -> list[int]:
    """Unknowns as the loops in an order meet them, those that go first before others."""
    first, last = [len(passed)] * unknowns, [len(passed)] * unknowns
    for place, loop in enumerate(loops):
        for unknown in passed[loop]:
            first[unknown] = min(first[unknown], place)
            last[unknown] = place
    return sorted(range(unknowns), key=lambda unknown: (first[unknown], last[unknown], unknown))


def _work(loops: Sequence[int], unknowns: Sequence[int], passed: Passed) -> int:
    """Unknowns that are open, times loops that they reach to, over all loops."""
    place = {unknown: k for k, unknown in enumerate(unknowns)}
    ends = {unknown: k for k, loop in enumerate(loops) for unknown in passed[loop]}
    reach = last = work = 0
    for k, loop in enumerate(loops):
        for unknown in passed[loop]:
            reach = max(reach, place[unknown] + 1)
            last = max(last, ends[unknown])
        work += (reach - k) * (last + 1 - k)
    return work
