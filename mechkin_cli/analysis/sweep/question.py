"""What a sweep is asked, worked out once for a session and kept there: runs that ask the same only
run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechkin_cli.analysis.sweep.actuation import watched
from mechkin_cli.analysis.sweep.friction_rows import judged_by
from mechkin_cli.mechanism.coefficient_quantities import (
    COEFFICIENT_KINDS,
    base_name,
    base_quantity,
)
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS, TRANSMISSION_KINDS
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import WRENCH_KINDS, demand_of

if TYPE_CHECKING:
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session


@dataclass(frozen=True)
class Question:
    """The quantities of a sweep.

    Attributes:
        asked: those asked for, and those by which the rows are judged beside them.
        wanted: of these, what the run that closes the rows reads off: no derived quantities.
        demand: what that run computes.
        rests_on_reactions: whether some are not unique where reactions are not.
    """

    asked: tuple[Wanted, ...]
    wanted: tuple[Wanted, ...]
    demand: Demand
    rests_on_reactions: bool


def question(session: Session, asked: Sequence[Wanted], *, verdicts: bool) -> Question:
    """What a session is asked; `verdicts`: each row's condition, and its power error where forces
    are computed."""

    def worked_out() -> Question:
        problem, everything = session.problem, list(asked)
        everything += held_moments(problem, everything)
        everything += watched(problem, everything)
        wanted, demand = at_once(session, everything, verdicts)
        return Question(
            tuple(everything),
            (*wanted, *judged_by(problem, wanted, demand)),
            demand,
            rest_on_reactions(problem, everything),
        )

    key = ("question", tuple(quantity.name for quantity in asked), verdicts)
    return session.own(key, worked_out)


def held_moments(problem: Problem, asked: Sequence[Wanted]) -> list[Wanted]:
    """The moments that hold idle legs, where forces are computed and they are not asked for."""
    if not (problem.hold_idle and demand_of(problem.mechanism, asked) & Demand.FORCES):
        return []
    from mechkin_cli.mechanism.idle import idle_freedoms

    known = problem.quantities()
    moments = {known[idle.holding] for idle in idle_freedoms(problem)}
    return sorted(moments.difference(asked))


def at_once(
    session: Session, asked: Sequence[Wanted], verdicts: bool
) -> tuple[list[Wanted], Demand]:
    """What the run that closes the rows reads off, and its demand: no derived quantities."""
    mechanism = session.problem.mechanism
    wanted = [q for q in asked if q.kind not in DERIVED_KINDS and q.owner != "row"]
    demand = demand_of(mechanism, wanted)
    if verdicts and session.graph.blocks:
        demand |= Demand.CONDITION
    if verdicts and demand & Demand.FORCES and demand & Demand.VELOCITY:
        demand |= Demand.POWER
    return wanted, demand


def rest_on_reactions(problem: Problem, asked: Sequence[Wanted]) -> bool:
    """Whether some quantities are not unique where reactions are not."""
    kinds = {*WRENCH_KINDS, *TRANSMISSION_KINDS}
    return any(
        base_quantity(problem.quantities(), base_name(quantity)).kind in kinds
        if quantity.kind in COEFFICIENT_KINDS
        else quantity.kind in kinds
        for quantity in asked
    )
