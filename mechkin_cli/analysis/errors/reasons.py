"""Why a quantity is not repeated in double-double, in a few words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.derived_quantities import FINITE_KINDS, LEDGER_KINDS
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of

if TYPE_CHECKING:
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted

VERDICT = "a verdict"
WORDS = "words"
INTEGRAL = "an integral over the rows"
FRICTION = "friction"
TABLE_LOADS = "a load that is read from a table"
DRAWING = "measured from the drawing in doubles"
RESPONSE = "a response"
OTHER_TABLE = "no table of rows"


def reason_of(problem: Problem, quantity: Wanted) -> str:
    """Why the quantity is not repeated; "" where it is."""
    if quantity.owner == "row" and quantity.kind != "time":
        return VERDICT
    if quantity.kind in LEDGER_KINDS:
        return INTEGRAL
    forces = demand_of(problem.mechanism, [quantity]) & Demand.FORCES
    if problem.mechanism.frictions and forces:
        # whether a joint sticks or slips is decided by doubles
        return FRICTION
    if forces and any(law.curve is not None for law in problem.load_laws):
        # the curve through the table is known in doubles
        return TABLE_LOADS
    if quantity.kind in FINITE_KINDS - {"finite_angle"}:
        return DRAWING
    return ""
