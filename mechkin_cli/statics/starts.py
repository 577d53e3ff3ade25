"""All equilibria of several freedoms in a window.

Searches start at places spread over the window, in every assembly there, by Newton's steps and, in
turns, down to a stable place. How likely one more start finds another is told, as for assembly
modes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import functions
from mechkin_cli.search import all_assemblies
from mechkin_cli.session import turn_of
from mechkin_cli.statics.newton import Balancing, SearchEnd, search, settle

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.show import Floats
    from mechkin_cli.statics.known import Known
    from mechkin_cli.statics.places import Statics


def from_starts(
    response: ResponseProblem, balancing: Balancing, statics: Statics, known: Known
) -> list[Diagnostic]:
    """Searches from places spread over the window; how sure it is that they found all."""
    assert response.search is not None
    low, high = known.ends
    base = statics.session.inputs.values[:, 0]
    least = max(response.search.starts, tolerances.WINDOW_STARTS)
    torus = _is_torus(known)
    starts = ended = since = 0
    chance = 1.0
    while starts < tolerances.MOST_WINDOW_STARTS:
        inputs = base.copy()
        inputs[statics.free] = low + (high - low) * _spread(starts, statics.count)
        reduced, _ = statics.reduced(inputs[:, None])
        for state in all_assemblies(statics.session, reduced[:, 0], thorough=False).states.T:
            try:
                place = balancing.charted(statics, statics.place(inputs, state))
            except ValueError:
                continue
            if starts % 2:
                place = settle(balancing, place)
            found = search(balancing, place)
            if found.end is not SearchEnd.FOUND:
                continue
            ended += 1
            since = 0 if known.add(found) else since + 1
        starts += 1
        # as of assemblies: each of the known ones could have been the last that was missing
        pairs = max(len(known.found) * (len(known.found) + 1), 1)
        chance = min(1.0, float(functions.log(pairs / tolerances.SEARCH_DOUBT)) / max(since, 1))
        enough = chance <= tolerances.WINDOW_CHANCE or (not ended and starts >= 4 * least)
        if starts >= least and enough and not (torus and known.excess):
            break
    count = len(known.found)
    text = (
        f"{count} equilibri{'um' if count == 1 else 'a'} found from {starts} starts; with "
        f"{100.0 * (1.0 - tolerances.SEARCH_DOUBT):g} % confidence one more search that ends at "
        f"one finds another with a chance of at most {chance:.1g}"
    )
    if not ended:
        text = f"none of the searches from {starts} starts ended at an equilibrium"
        return [Diagnostic("window-starts", "note", text, response.place)]
    at = f"{ended} searches ended at an equilibrium, the last {since} of them at known ones"
    hint = "ask for more starts: starts: 1000"
    notes = [Diagnostic("window-starts", "note", text, response.place, at, hint=hint)]
    if torus and known.excess:
        # M. Morse: on a torus minima and saddles of even index are as many as those of odd index
        text = "equilibria are missing: over whole turns those of even and of odd index are as many"
        notes.append(Diagnostic("window-missing", "warning", text, response.place, hint=hint))
    return notes


def _is_torus(known: Known) -> bool:
    """Whether the window has every place of an open chain of joints that turn."""
    session, (low, high) = known.balancing.chosen, known.ends
    inputs = session.problem.motion.inputs[: len(known.window)]
    turns = all(turn_of(session.problem, item) is not None for item in inputs)
    wide = bool((high - low >= 2.0 * np.pi - tolerances.SAME_EQUILIBRIUM).all())
    return turns and wide and not session.graph.closings


def _spread(number: int, count: int) -> Floats:
    """A point of the unit cube (count,) that spreads evenly with its number: multiples of powers of
    the root of x^(count+1) = x + 1 (M. Roberts, 2018), which is the golden ratio for one."""
    root, powers = 2.0, [1.0]
    for _ in range(64):  # by Newton
        powers = np.multiply.accumulate([1.0, *[root] * (count + 1)]).tolist()
        root -= (powers[-1] - root - 1.0) / ((count + 1) * powers[-2] - 1.0)
    return np.array([(0.5 + (number + 1) / powers[k + 1]) % 1.0 for k in range(count)])
