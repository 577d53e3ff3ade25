"""From the entry of an equilibrium in the file to its rows: the first assembly, the search, the
verdicts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import response_problem
from mechkin_cli.record import replace
from mechkin_cli.response import read
from mechkin_cli.session import Packing, Session, input_numbers, input_text
from mechkin_cli.statics.newton import Search, SearchEnd, search
from mechkin_cli.statics.places import Statics
from mechkin_cli.statics.result import EquilibriumResult
from mechkin_cli.statics.stability import judged
from mechkin_cli.sweep import first_assembly

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem, ResponseProblem

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
    if session is None:
        session = Session.of(response_problem(problem, response))
    assert response.search is not None
    if response.search.window:
        from mechkin_cli.statics.window import in_window

        result = in_window(session.packed(packing), response)
    else:
        result = _near(session.packed(packing), response)
    read(result, quantities)
    return result


def _near(session: Session, response: ResponseProblem) -> EquilibriumResult:
    """The equilibrium near the start."""
    session, start = first_assembly(session)
    placed = [
        one if one.place else one._replace(place=response.place) for one in start.diagnostics
    ]
    start = replace(start, diagnostics=placed)
    if start.state is None:
        return EquilibriumResult(session, start, response, [], [])
    statics = Statics(session, range(len(response.independent)))
    time = float(response.moments.values[0])
    begin = statics.place(session.inputs.values[:, 0], start.state)
    found = search(statics, begin, time)
    if not found.found:
        return EquilibriumResult(session, start, response, [], [not_found(session, response, found)])
    verdict = judged(statics, found.place, time, found.largest)
    return EquilibriumResult(session, start, response, [(found, verdict)], [])


_HINTS = {
    SearchEnd.LEAST: "start elsewhere (near:), or look through a window (window:)",
    SearchEnd.RUNAWAY: "add what holds it: a spring, a stop, a held coordinate (driven:)",
    SearchEnd.BRANCH_ENDS: "name a coordinate that moves there, or start elsewhere (near:)",
    SearchEnd.NO_FORCES: "write loads that have a value there, or start elsewhere (near:)",
    SearchEnd.STEPS: "start nearer (near:), or look through a window (window:)",
}


def not_found(session: Session, response: ResponseProblem, found: Search) -> Diagnostic:
    """Why a search has not found an equilibrium, and where it ended."""
    places = input_numbers(session.problem, session.layout, found.place.inputs)
    places = places[: len(response.independent)]
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
