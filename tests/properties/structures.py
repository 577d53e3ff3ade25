"""Random mechanisms of two and three loops with all joint types, one per seed."""

from __future__ import annotations

import random
from functools import cache

from oracle import (
    SHAPES,
    assemble,
    condition_of,
    newton_euler,
    random_structure,
    read,
)
from properties.case import Case

WORST_CONDITION = 200.0
"""At the row: close to a dead centre rates grow faster than the condition."""


@cache
def structure(seed: int) -> Case:
    """Shapes in turn; every third with one more input, every fifth with an open chain."""
    generator = random.Random(seed)
    shape = SHAPES[seed % len(SHAPES)]
    while True:
        text = random_structure(
            generator,
            shape,
            inputs=2 if seed % 3 == 2 else 1,
            tail=seed % 5 == 4,
            worst_condition=WORST_CONDITION,
        )
        mechanism = read(text)
        row = 0 if seed % 2 else mechanism.rows - 1
        solution = assemble(mechanism, mechanism.row(row))
        condition = condition_of(mechanism, solution)
        if condition <= WORST_CONDITION:
            reactions = newton_euler(mechanism, solution)
            return Case(text, mechanism, row, solution, reactions, condition)
