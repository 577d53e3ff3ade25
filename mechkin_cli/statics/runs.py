"""From the entry of an equilibrium in the file to its rows: the first assembly, the search, the
verdicts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.response import prepare, read
from mechkin_cli.session import Packing, input_numbers, input_text
from mechkin_cli.statics.friction import FrictionRest
from mechkin_cli.statics.newton import Balancing, Search, SearchEnd, search
from mechkin_cli.statics.places import Statics
from mechkin_cli.statics.result import EquilibriumResult
from mechkin_cli.statics.stability import held, judged

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem, ResponseProblem
    from mechkin_cli.response import Prepared
    from mechkin_cli.session import Session

ANY_PACKING = Packing()
"""As many lanes and threads as pay."""


def balance(
    problem: Problem,
    response: ResponseProblem,
    quantities: Iterable[str] = (),
    packing: Packing = ANY_PACKING,
    session: Session | None = None,
) -> EquilibriumResult:
    """Finds the equilibria that an entry of the file asks for and reads some quantities.

    Args:
        problem: of the file.
        response: one of its equilibria.
        quantities: names out of `response_problem(problem, response).quantities()`.
        packing: how places are packed.
        session: of that problem, where there is one; it remembers the start.

    Raises:
        UnsolvableGraph: the entry names too few or too many coordinates, or such that do not fix
            the place.
        KeyError: an unknown quantity.
    """
    result = balanced(prepare(problem, response, packing, session))
    read(result, quantities)
    return result


def balanced(one: Prepared) -> EquilibriumResult:
    """The equilibria of an entry of the file, before anything is read."""
    assert one.response.search is not None
    if not one.response.search.window:
        return _near(one)
    from mechkin_cli.statics.window import in_window

    return in_window(one)


def _near(one: Prepared) -> EquilibriumResult:
    """The equilibrium near the start."""
    response = one.response
    balancing = Balancing.of(one.chosen, response.independent)
    if one.begun is None or one.start.state is None:
        return EquilibriumResult(response, balancing, one.start, [], [])
    statics = Statics(one.chosen, range(len(response.independent)))
    begin = statics.place(one.chosen.inputs.values[:, 0], one.start.state)
    try:
        place = balancing.charted(statics, begin)
    except ValueError:
        return EquilibriumResult(response, balancing, one.start, [], [_dead_start(response)])
    found = search(balancing, place)
    rest = FrictionRest(statics, response) if response.rubs_at_rest else None
    if found.found:
        row, at = (found, judged(balancing, found)), found.place
    elif rest is not None and rest.unfounded is None and rest.holds(begin):
        row, at = held(balancing, place), place
    else:
        return EquilibriumResult(
            response, balancing, one.start, [], [not_found(response, balancing, found)]
        )
    if rest is None:
        return EquilibriumResult(response, balancing, one.start, [row], [])
    rests = rest.about([balancing.uncharted(statics, at)])
    return EquilibriumResult(response, balancing, one.start, [row], rest.notes(rests), rests)


def _dead_start(response: ResponseProblem) -> Diagnostic:
    text = "the start is a dead centre of a coordinate that it names"
    hint = "start beside it, or name a coordinate that moves there"
    return Diagnostic("start-at-dead-centre", "error", text, response.place, hint=hint)


_HINTS = {
    SearchEnd.LEAST: "start elsewhere (near:), or look through a window (window:)",
    SearchEnd.RUNAWAY: "add what holds it: a spring, a stop, a held coordinate (driven:)",
    SearchEnd.BRANCH_ENDS: "name a coordinate that moves there, or start elsewhere (near:)",
    SearchEnd.NO_FORCES: "write loads that have a value there, or start elsewhere (near:)",
    SearchEnd.STEPS: "start nearer (near:), or look through a window (window:)",
}


def not_found(response: ResponseProblem, balancing: Balancing, found: Search) -> Diagnostic:
    """Why a search has not found an equilibrium, and where it ended."""
    session = balancing.chosen
    places = input_numbers(session.problem, session.layout, balancing.named(found.place)[0])
    where = ", ".join(map(input_text, places))
    share = float(np.max(np.abs(found.forces))) / found.largest if found.largest > 0.0 else np.nan
    return Diagnostic(
        "no-equilibrium",
        "error",
        f"no place near the start was found at which the loads balance: {found.end.value} at "
        f"{where}",
        response.place,
        measured=f"{share:.1e} of the largest force of one load is left there",
        hint=_HINTS[found.end],
        numbers=places,
    )
