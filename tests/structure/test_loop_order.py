"""The order of loops that share coordinates: as narrow as the best, whatever their numbers."""

from __future__ import annotations

import itertools
import random
from collections.abc import Sequence

import pytest

import mechkin_cli as mk
from mechkin_cli.structure import charted
from mechkin_cli.structure.loop_order import in_order


def row(loops: int) -> list[list[int]]:
    """Each loop has two coordinates of its own, and one of the loop before."""
    return [[2 * k, 2 * k + 1, 2 * k + 2] for k in range(loops)]


def ladder(loops: int, wide: int) -> list[list[int]]:
    """Rows of loops, each with a coordinate of those beside it and before it."""
    passed: list[list[int]] = [[] for _ in range(loops * wide)]
    unknown = 0
    for a, b in itertools.combinations(range(loops * wide), 2):
        if (b == a + 1 and b % wide) or b == a + wide:
            passed[a].append(unknown)
            passed[b].append(unknown)
            unknown += 1
    return passed


def star(arms: int, loops: int) -> list[list[int]]:
    """Rows of loops that begin at one coordinate."""
    passed, unknown = [], 1
    for _ in range(arms):
        before = 0
        for _ in range(loops):
            passed.append([before, unknown, unknown + 1])
            before, unknown = unknown + 1, unknown + 2
    return passed


def work(loops: Sequence[int], unknowns: Sequence[int], passed: Sequence[Sequence[int]]) -> int:
    """Entries of the band: for each loop the coordinates that are open, times the loops that one of
    them reaches to."""
    total = 0
    for k, _ in enumerate(loops):
        seen = [u for loop in loops[: k + 1] for u in passed[loop]]
        count = max(unknowns.index(u) for u in seen) + 1
        open_ones = unknowns[:count]
        ends = [max((i for i, loop in enumerate(loops) if u in passed[loop])) for u in open_ones]
        total += (count - k) * (max(ends) + 1 - k)
    return total


def renumbered(passed: list[list[int]], seed: int) -> list[list[int]]:
    unknowns = max(u for own in passed for u in own) + 1
    order = random.Random(seed)
    names = list(range(unknowns))
    order.shuffle(names)
    mixed = [sorted(names[u] for u in own) for own in passed]
    order.shuffle(mixed)
    return mixed


def ordered(passed: list[list[int]]) -> tuple[list[int], list[int], int]:
    unknowns = max(u for own in passed for u in own) + 1
    loops, columns = in_order(passed, unknowns)
    assert sorted(loops) == list(range(len(passed)))
    assert sorted(columns) == list(range(unknowns))
    return loops, columns, work(loops, columns, passed)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("loops", [1, 2, 7, 60])
def test_a_row_is_found_again(loops: int, seed: int) -> None:
    assert ordered(renumbered(row(loops), seed))[2] == ordered(row(loops))[2]


@pytest.mark.parametrize("seed", range(10))
def test_ladders_and_stars_stay_narrow(seed: int) -> None:
    for passed, most in ((ladder(20, 3), 1.5), (star(3, 12), 3.0)):
        assert ordered(renumbered(passed, seed))[2] <= most * ordered(passed)[2]


def test_it_is_near_the_best_of_all_orders_and_never_worse_than_given() -> None:
    parts = [part_of_best(seed) for seed in range(40)]
    assert max(parts) <= 2.0
    assert sum(parts) <= 1.2 * len(parts)


def part_of_best(seed: int) -> float:
    generator = random.Random(seed)
    passed = [sorted(generator.sample(range(9), generator.randint(2, 3))) for _ in range(5)]
    for u in sorted(set(range(9)) - {u for own in passed for u in own}):
        passed[u % 5].append(u)
    found = ordered(passed)[2]
    every = []
    for loops in itertools.permutations(range(5)):
        first = {u: k for k, loop in reversed(list(enumerate(loops))) for u in passed[loop]}
        last = {u: k for k, loop in enumerate(loops) for u in passed[loop]}
        columns = sorted(range(9), key=lambda u: (first[u], last[u], u))
        every.append(work(loops, columns, passed))
    assert found <= every[0]
    return found / min(every)


def test_a_free_motion_has_the_loops_of_a_file_in_a_row() -> None:
    """The cut joints of four-bars side by side, written in a random order."""
    links, joints = ["ground"], []
    for k in range(12):
        links += [f"crank{k}", f"bar{k}"]
        joints.append(f"A{k}: {{type: R, links: [ground, crank{k}], point: [{k}, 0]}}")
        joints.append(f"B{k}: {{type: R, links: [crank{k}, bar{k}], point: [{k}, 1]}}")
        joints.append(f"C{k}: {{type: R, links: [bar{k}, crank{k + 1}], point: [{k + 1}, 1]}}")
    links.append("crank12")
    joints.append("A12: {type: R, links: [ground, crank12], point: [12, 0]}")
    random.Random(2).shuffle(joints)
    text = "format: 1\nname: a row\nplane: xy\nlinks:\n"
    text += "".join(f"  {name}: {{}}\n" for name in links[1:])
    text += "joints:\n" + "".join(f"  {joint}\n" for joint in joints)
    graph = mk.loads(text + "motion: {inputs: {A5.theta: {at: 0}}}\n").graph
    free = charted(graph, {("A5", "theta")})
    (block,) = free.blocks
    assert block.closings == tuple(range(12))
    assert sorted(c.name for c in free.closings) == sorted(c.name for c in graph.closings)
    cranks = [{free.edges[e].child for e, _ in free.loops[c]} for c in block.closings]
    assert all(a & b for a, b in itertools.pairwise(cranks))
    assert len(set(block.unknowns)) == len(block.unknowns) == 25
