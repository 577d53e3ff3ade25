"""Random loops with idle freedoms against kinematics of the tests' own (`idle_chains.py`).

Whatever is idle on the way of a loop, `mobility` names and `analyze` solves; where more is undriven
than idle, `analyze` says so. What no idle motion moves must agree in every row.
`MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os
from collections import Counter
from functools import cache
from random import Random

import numpy as np
import pytest
from random_families.idle_chains import Loop, Pair, Told, random_loop, told, turned, unit, written

from mechkin_cli import InvalidFile, Model, loads

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
TRAVEL, ROWS = 0.4, 5
NEAR = 1e-8
"""Both close loops to 1e-13; a singular value is 0.05 or more."""

PLAIN = ("S", "E", "C", "U", "R", "P")
CONTACTS = ("Sp", "Sg")
BALLS = ("S", *CONTACTS)


def kinds_of(rng: Random) -> tuple[str, ...]:
    """A driven R, then two to four pairs, at most one of them a sphere on a plane or groove."""
    found = [rng.choice(PLAIN) for _ in range(rng.choice([2, 3, 3, 4]))]
    if rng.random() < 0.4:
        found[rng.randrange(len(found))] = rng.choice(CONTACTS)
    return ("R", *found)


def drawn(rng: Random) -> list[Pair]:
    """A loop with idle freedoms; of four one as chance has it, the others such that as many
    freedoms are left as a loop needs, or, of four one, one more."""
    any_ = rng.random() < 0.25
    beyond = 7 if rng.random() < 0.75 else 8
    while True:
        pairs = random_loop(rng, kinds_of(rng))
        loop = Loop(pairs)
        rates = np.array([rng.gauss(0, 0.5) for _ in range(loop.count)])
        idle = loop.idle(loop.moved(loop.start(), rates)).shape[1]
        if idle and (any_ or loop.count - idle == beyond):
            return pairs


@cache
def cases(family: str, count: int) -> list[tuple[int, list[Pair], Told]]:
    found = []
    for number in range(count):
        rng = Random(f"{family} {number}")
        pairs = drawn(rng)
        known = told(rng, Loop(pairs), TRAVEL, ROWS)
        if known is not None and known.idle:
            found.append((number, pairs, known))
    return found


def settled(pairs: list[Pair], known: Told) -> bool:
    """Whether something beside the crank moves that is not idle, or no ball is in the loop.

    Where all else is idle, a ball that touches is kept in touch by freedoms that are held in part,
    and the hold may have a dead centre of its own.
    """
    names = [name for name in known.values[0] if name != "J0.theta"]
    moves = any(abs(row[name]) > 1e-6 for row in known.values for name in names)
    return moves or not any(pair.kind in BALLS for pair in pairs)


def far(name: str, one: float, other: float) -> float:
    """How far two values of a coordinate are apart, of angles modulo a turn."""
    off = one - other
    if "theta" in name:
        off = (off + np.pi) % (2 * np.pi) - np.pi
    return abs(float(off))


def off_by(model: Model, known: Told) -> float:
    """How far the rows are from those known; infinite where one is not `ok`."""
    names = list(known.values[0])
    found = model.analyze(names)
    if found["row.status"].tolist() != ["ok"] * ROWS:
        return float("inf")
    return max(
        far(name, float(found[name][row]), known.values[row][name])
        for name in names
        for row in range(ROWS)
    )


def is_named_undriven(text: str) -> bool:
    """Whether no row but the first has a solution, and it is said that something is not driven."""
    try:
        found = loads(text).analyze([])
    except InvalidFile as error:
        return "not driven" in str(error)
    codes = {one.code for one in found.diagnostics if one.severity == "error"}
    return "ok" not in found["row.status"].tolist()[1:] and "undriven-freedom" in codes


def test_what_is_idle_is_named_and_solved() -> None:
    met: Counter[str] = Counter()
    for number, pairs, known in cases("chain", 100 * TIMES):
        text = written(pairs, TRAVEL, ROWS)
        kinds = [pair.kind for pair in pairs]
        if known.undriven > known.idle:
            met["undriven"] += 1
            assert is_named_undriven(text), (number, kinds)
        elif settled(pairs, known):
            met["solved"] += 1
            model = loads(text)
            found = model.mobility()
            assert len(found.idle) == known.idle, (number, kinds, found.idle)
            assert off_by(model, known) < NEAR, (number, kinds)
    assert met["solved"] >= 10 * TIMES
    assert met["undriven"] >= 5 * TIMES


def turned_in_space(rng: Random, pairs: list[Pair]) -> list[Pair]:
    turn, shift = turned(2.0 * unit(rng)), 3.0 * unit(rng)
    return [
        Pair(p.kind, turn @ p.point + shift, turn @ p.axis, turn @ p.other, p.back) for p in pairs
    ]


def drawn_the_other_way(pairs: list[Pair]) -> list[Pair]:
    """With the links of some pairs exchanged whose coordinates then change their sign alone."""
    return [
        Pair(p.kind, p.point, p.axis, p.other, not p.back) if p.kind in "SRPC" and k else p
        for k, p in enumerate(pairs)
    ]


@pytest.mark.parametrize("change", ["turned", "order", "names", "other way"])
def test_no_change_that_says_nothing_changes_an_answer(change: str) -> None:
    solved = 0
    for number, pairs, known in cases("metamorphic chain", 24 * TIMES):
        if known.undriven > known.idle or not settled(pairs, known):
            continue
        rng = Random(f"{change} {number}")
        order = list(range(len(pairs)))
        values = known.values
        if change == "turned":
            pairs = turned_in_space(rng, pairs)
        elif change == "order":
            rng.shuffle(order)
        elif change == "other way":
            swapped = {f"J{k}." for k, p in enumerate(pairs) if k and p.kind in "SRPC"}
            pairs = drawn_the_other_way(pairs)
            values = [
                {n: -v if n.partition(".")[0] + "." in swapped else v for n, v in row.items()}
                for row in values
            ]
        text = written(pairs, TRAVEL, ROWS, order)
        if change == "names":
            for k in range(1, len(pairs)):
                text = text.replace(f"L{k}", f"link_{'zyxwv'[k]}")
        assert off_by(loads(text), known._replace(values=values)) < NEAR, (number, text)
        solved += 1
    assert solved >= 4 * TIMES


def test_a_doubled_loop_is_solved_as_one() -> None:
    """Two loops on one crank: both have their own idle freedoms."""
    solved = 0
    for number, pairs, known in cases("doubled chain", 24 * TIMES):
        if known.undriven > known.idle or not settled(pairs, known):
            continue
        lines = written(pairs, TRAVEL, ROWS).splitlines()
        start = next(k for k, line in enumerate(lines) if line.startswith("joints"))
        again = []
        for line in lines[start + 2 : -1]:
            for k in range(len(pairs) - 1, 0, -1):
                line = line.replace(f" J{k}:", f" K{k}:")
                line = line.replace(f"L{k}", f"M{k}") if k > 1 else line
            again.append(line)
        names = ", ".join(f"M{k}: {{}}" for k in range(2, len(pairs)))
        lines[2] = lines[2].replace("}}", "}, " + names + "}") if names else lines[2]
        text = "\n".join([*lines[:-1], *again, lines[-1]])
        assert off_by(loads(text), known) < NEAR, (number, text)
        solved += 1
    assert solved >= 4 * TIMES
