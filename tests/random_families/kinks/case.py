"""One random response with kinks against the independent equations of motion, whose integrator
takes ever shorter steps across kinks, of which it knows nothing.

The reference is integrated at 1e-11 and at 1e-10; ten times the difference is what it may be wrong
by. A motion that is held where a load jumps may end there, and is compared up to there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from oracle.document import document
from oracle.dynamics.response import prepare
from random_families.kinks.drawing import drawing
from random_families.response.case import _distance, _is_force

import mechkin_cli as mk

_EXACT = 1e-7


@dataclass(frozen=True)
class Outcome:
    """What one mechanism came to."""

    seed: int
    text: str
    rows: str
    error: float
    doubt: float
    """How far the reference may be wrong."""
    fault: str = ""

    @property
    def figures(self) -> dict[str, float]:
        return {"motion": self.error, "the reference": self.doubt}

    @property
    def remark(self) -> str:
        return "held at a jump" if "held" in self.rows else ""


def run_one(seed: int) -> Outcome:
    """The verdict on the mechanism of a seed."""
    text = drawing(seed)
    try:
        answer = mk.loads(text).respond("run")
    except Exception as error:
        fault = f"{type(error).__name__}: {str(error).splitlines()[0]}"
        return Outcome(seed, text, "", np.nan, np.nan, fault)
    status = [str(x) for x in answer["row.status"]]
    count = next((k for k, word in enumerate(status) if word != "ok"), len(status))
    codes = [d.code for d in answer.diagnostics if d.severity == "error"]
    held = codes == ["held-at-jump"]
    rows = f"{count}/{len(status)} {' '.join(codes)}"
    if count < len(status) and not held:
        return Outcome(seed, text, rows, np.nan, np.nan, f"rows are lost: {codes}")
    reference = prepare(document(text))
    reference.times = reference.times[:count]
    if count < 2:
        return Outcome(seed, text, rows, 0.0, 0.0)
    exact, coarse = reference.run(1e-11), reference.run(1e-10)
    names = [name for name in exact if "." in name and not np.isnan(exact[name]).any()]
    moving = [n for n in names if not _is_force(n) and not n.endswith("_ddot")]
    doubt = max(_distance(exact, coarse, name) for name in moving)
    found = {name: np.array(answer[name])[:count] for name in moving}
    error, name = max((_distance(exact, found, name), name) for name in moving)
    fault = "" if error < _EXACT + 10 * doubt else f"{name} is off by {error:.1e}"
    return Outcome(seed, text, rows, error, doubt, fault)
