"""Other reactions in equilibrium, where redundant constraints leave them arbitrary.

A cell is unique if it is the same for them all. They differ by fixed parts of the null space of
the closing wrenches; efforts and what acts on ground are unique where the motion is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.analysis.batched import run_reached
from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup
from mechkin_cli.solver.demand import WRENCH_KINDS
from mechkin_cli.solver.graph import is_redundant

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

SHIFTS = (1, 2)
"""Two: one alone may leave a cell unchanged by chance."""


def other_reactions(
    setup: Setup, rows: RowStates, values: Floats, loads: Floats | None
) -> tuple[Floats, ...]:
    """The outputs for other reactions, each as `values` (slots, rows); () if there are none.

    `loads` as `run_reached` takes them.
    """
    reactions = [quantity for quantity in setup.wanted if quantity.kind in WRENCH_KINDS]
    if not (is_redundant(setup.graph) and reactions and rows.reached.any()):
        return ()
    found = []
    for shift in SHIFTS:
        shifted = run_reached(setup, rows, shift=shift, loads=loads).outputs
        assert shifted is not None
        changed = values.copy()
        for slot in (setup.outputs.slots[quantity.name] for quantity in reactions):
            here = slice(slot.first, slot.first + slot.width)
            changed[here] = shifted[here]
        found.append(changed)
    return tuple(found)
