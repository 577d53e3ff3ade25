"""What a random motion through folded places misses by."""

from __future__ import annotations

import numpy as np
from random_families.change_points.neutral import Case, case

import mechkin_cli as mk


def miss(number: int, tolerance: float = 1e-12) -> tuple[float, str]:
    """The largest error of an angle (rad, infinite where a row is lost), and words."""
    return judged(number, case(number, tolerance))


def judged(number: int, drawn: Case) -> tuple[float, str]:
    """As `miss`, of a mechanism."""
    found = mk.loads(drawn.text).respond("run")
    status = [str(word) for word in found["row.status"]]
    if "branch-lost" in status or "step-limit" in status or "not-assembled" in status:
        said = " ".join(str(d) for d in found.diagnostics if d.severity == "error")
        return np.inf, f"{number} ({drawn.what}): {said}"
    off = max(
        float(np.max(np.abs(found[name] - exact)))
        for name, exact in (("A.theta", drawn.theta), ("D.theta", drawn.phi))
    )
    return off, f"{number} ({drawn.what}): {drawn.crossings} folds, off by {off:.2g} rad"
