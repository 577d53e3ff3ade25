"""One random response of the package against the independent equations of motion.

Both are integrated at 1e-13. The reference is integrated a second time at 1e-12: ten times the
difference is what it may be wrong by. Columns are compared in parts of their largest value, at
least one (rad, or size).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from oracle.document import document, to_text
from oracle.dynamics.response import prepare
from random_families.response.drawing import drawing

import mechkin_cli as mk

_EXACT = 1e-10
_ENERGY = 1e-11


@dataclass(frozen=True)
class Outcome:
    """What one mechanism came to."""

    seed: int
    text: str
    error: float
    """Of coordinates and rates."""
    acceleration: float
    """Of accelerations and reactions."""
    energy: float
    doubt: float
    """How far the reference may be wrong."""
    fault: str = ""
    remark: str = ""

    @property
    def figures(self) -> dict[str, float]:
        return {
            "motion": self.error,
            "acceleration": self.acceleration,
            "energy": self.energy,
            "the reference": self.doubt,
        }


def run_one(seed: int, tolerance: str = "1e-13") -> Outcome:
    """The verdict on the mechanism of a seed."""
    data = document(drawing(seed))
    data["responses"]["run"]["tolerance"] = tolerance
    text = to_text(data)
    reference = prepare(data)
    exact, coarse = reference.run(1e-13), reference.run(1e-12)
    names = [name for name in exact if "." in name and not np.isnan(exact[name]).any()]
    moving = [name for name in names if not _is_force(name) and not name.endswith("_ddot")]
    doubt = max(_distance(exact, coarse, name) for name in moving)
    try:
        answer = mk.loads(text).respond("run")
        found = {name: np.array(answer[name]) for name in names}
        energy = np.array(answer["row.energy_error"], dtype=float)
        status = [str(x) for x in answer["row.status"]]
    except Exception as error:
        fault = f"{type(error).__name__}: {str(error).splitlines()[0]}"
        return Outcome(seed, text, np.nan, np.nan, np.nan, doubt, fault)
    errors = {name: _distance(exact, found, name) for name in names}
    motion = max((errors[name], name) for name in moving)
    acceleration = max((errors[name], name) for name in names if name not in moving)
    fault = ""
    if any(word != "ok" for word in status):
        fault = f"row.status {status}"
    elif not motion[0] < _EXACT + 10 * doubt:
        fault = f"{motion[1]} is off by {motion[0]:.1e}"
    elif not acceleration[0] < 10 * _EXACT + 100 * doubt:
        fault = f"{acceleration[1]} is off by {acceleration[0]:.1e}"
    elif not np.max(energy) < _ENERGY:
        fault = f"row.energy_error is {np.max(energy):.1e}"
    return Outcome(seed, text, motion[0], acceleration[0], float(np.max(energy)), doubt, fault)


def _is_force(name: str) -> bool:
    return ".force." in name or ".moment." in name


def _distance(exact: dict[str, np.ndarray], found: dict[str, np.ndarray], name: str) -> float:
    unit = np.pi / 180 if ".theta" in name and not name.endswith(("dot",)) else 1.0
    size = max(1.0, unit * float(np.max(np.abs(exact[name]))))
    error = unit * np.abs(found[name] - exact[name]) / size
    return float(np.max(np.where(np.isnan(error), np.inf, error)))
