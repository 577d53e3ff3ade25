"""All equilibria in a window.

Of one freedom the curve of positions is followed (`curve`), of several searches start all over the
window (`starts`). Each equilibrium is known once, with its angles in the least turn (`Known`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.record import replace
from mechkin_cli.statics.curve import Curve
from mechkin_cli.statics.friction import FrictionRest, RestInterval
from mechkin_cli.statics.known import Known
from mechkin_cli.statics.newton import Balancing
from mechkin_cli.statics.places import Statics
from mechkin_cli.statics.result import EquilibriumResult
from mechkin_cli.statics.stability import judged
from mechkin_cli.statics.starts import from_starts

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.response import Prepared


def in_window(one: Prepared) -> EquilibriumResult:
    """All equilibria of an entry of the file with a window; its middle need not be assembled."""
    response, session = one.response, one.chosen
    start = replace(one.start, diagnostics=[])
    balancing = Balancing.of(session, response.independent)
    statics = Statics(session, range(len(response.independent)))
    assert response.search is not None
    known = Known(balancing, response.search.window)
    curve = Curve(balancing, statics, known) if statics.count == 1 else None
    if curve is not None:
        curve.look()
        notes = curve.notes(response)
    else:
        notes = from_starts(response, balancing, statics, known)
    notes = [*notes, *known.notes(response)]
    judgements = [(found, judged(balancing, found)) for found in known.found]
    judgements.sort(key=lambda pair: pair[1].coordinates.tolist())
    rests: list[RestInterval | None] = []
    if curve is not None and response.frictions:
        rest = FrictionRest(statics, response, response.search.window[0])
        judgements, rests = rest.rows(balancing, judgements, curve.places)
        notes = [*notes, *rest.notes(rests)]
    if not judgements:
        notes = [*notes, _none(response)]
    return EquilibriumResult(response, balancing, start, judgements, notes, rests)


def _none(response: ResponseProblem) -> Diagnostic:
    """That a window has no equilibrium."""
    assert response.search is not None
    names = " and ".join(one.name for one in response.search.window)
    text = f"no place within the window of {names} was found at which the loads balance"
    hint = "widen the window, or look at the forces of a sweep through it"
    return Diagnostic("no-equilibrium", "error", text, response.place, hint=hint)
