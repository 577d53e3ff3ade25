"""Why a quantity is not repeated in double-double, in a few words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.coefficient_quantities import COEFFICIENT_KINDS
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
CROSSED = "the motion passes a branch point"
OTHER_RATES = "the start gives rates of other coordinates"
STOP = "the moment of a stop"
NOT_RESOLVED = "beyond the moment at which the steps of the repetition run out"
DRAWING = "measured from the drawing in doubles"
DENSE = "a dense system"
BALANCE = "a balance over all rows"
SUMMARY = "a summary: off by no more than twice the worst cell of its column"
AS_DRIVEN = "read as if the start's coordinates were driven"


_NUMBERS_OF_ROWS = {"time", "kinetic_energy", "potential_energy", "work", "dissipated"}


def reason_of(problem: Problem, quantity: Wanted) -> str:
    """Why the quantity is not repeated; "" where it is."""
    if quantity.owner == "row" and quantity.kind not in _NUMBERS_OF_ROWS:
        return VERDICT
    if quantity.kind in LEDGER_KINDS:
        return INTEGRAL
    if problem.response is not None and quantity.kind in COEFFICIENT_KINDS:
        return AS_DRIVEN
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
