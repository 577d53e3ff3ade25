"""Random single loops of R, P, C, H and S, one per seed, with the oracle's answers."""

from __future__ import annotations

import random
from functools import cache

from oracle import condition_of, newton_euler, random_loop, read, solve
from properties.case import Case

ROWS = (0, 4)
"""The rows farthest from home; one of them is compared with the oracle."""

_FREEDOMS = {"R": 1, "P": 1, "C": 2, "H": 1, "S": 3}
_TURNS = {"R": 1, "P": 0, "C": 1, "H": 1, "S": 3}


@cache
def loop(seed: int) -> Case:
    generator = random.Random(seed)
    text = random_loop(generator, _types(generator))
    mechanism = read(text)
    row = ROWS[seed // 4 % 2]
    solution = solve(mechanism, mechanism.row(row))
    reactions = newton_euler(mechanism, solution)
    return Case(text, mechanism, row, solution, reactions, condition_of(mechanism, solution))


def _types(generator: random.Random) -> str:
    """Joint types in random order, seven freedoms together.

    Two S would leave an idle spin; with only three turns the orientations hold every turn, so none
    can be driven; with more than three slides some are redundant.
    """
    while True:
        types, freedoms = "", 0
        while freedoms < 7:
            types += generator.choice("RRRPCHS")
            freedoms += _FREEDOMS[types[-1]]
        turns = sum(_TURNS[t] for t in types)
        drivable = types[0] == "P" or (types[0] != "S" and turns >= 4)
        closable = any(t in "RPCS" for t in types[1:])
        if freedoms == 7 and turns >= 3 and drivable and closable and types.count("S") <= 1:
            return types
