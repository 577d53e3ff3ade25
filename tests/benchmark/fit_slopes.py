"""What exact derivatives in every step of a fit's local search cost beside four-point differences.

    python -P tests/benchmark/fit_slopes.py

Processor time of one search from the file's own values; both end at the cost that is printed.
"""

from __future__ import annotations

import sys
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

import mechkin_cli as mk
from mechkin_cli.fit.measure import FitModels, FitSlopes, FitValues
from mechkin_cli.fit.request import request
from mechkin_cli.fit.search import Measured, refined

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
LINE = [[x, 0] for x in range(-80, 81, 20)]
CASES: tuple[tuple[str, dict[str, Any], dict[str, Any], Any], ...] = (
    (
        "fits/straight_line",
        {"of": "pen.position - middle.position", "is": LINE},
        {"b": (80, 200), "d": (40, 200), "h": (100, 300)},
        (),
    ),
    (
        "rssr",
        {"of": "O4.theta", "at": [70, 90, 110, 130, 150], "is": [0, 10, 20, 30, 40]},
        {"r": (20, 80), "x": (100, 250), "d": (100, 220)},
        (),
    ),
    (
        "fits/counterweights",
        {"of": "ground.shaking_force", "least": "rms"},
        dict.fromkeys(("x1", "y1", "x3", "y3"), (-150, 150)),
        (),
    ),
    (
        "fits/hatch",
        {"of": "hinge.effort", "least": "peak"},
        {"u": (-150, 150), "v": (-400, -50), "p": (100, 350)},
        {"of": "long + gas.s", "max": "450 mm"},
    ),
)


def measured(model: mk.Model, target: Any, bounds: Any, held: Any) -> tuple[Measured, np.ndarray]:
    """What a search goes by, and where it begins."""
    asked = request(model.problem, target, bounds, held)
    values = FitValues(FitModels(model), asked)
    own = [(one.own - one.lower) / (one.upper - one.lower) for one in asked.parameters]
    return Measured(values.measure, FitSlopes(values).stacked), np.array(own)


def main() -> int:
    """One line for each case."""
    for name, target, bounds, held in CASES:
        model = mk.load(next(MECHANISMS.glob(f"*/{name}.yaml")))
        told = []
        for kind in ("differences", "exact_slopes"):
            for _ in range(2):  # the first records what the model keeps
                found, own = measured(model, target, bounds, held)
                begin = process_time()
                end, _, _ = refined(found, own, getattr(found, kind))
                seconds = process_time() - begin
            cost = float(found.one(end).costs[0])
            told.append((seconds, found.slopes_taken + found.exact_taken, cost))
        (quick, some, one), (exact, others, other) = told
        print(
            f"{name}: differences {quick:.2f} s ({some} Jacobians, cost {one:.6g}), exact "
            f"{exact:.2f} s ({others}, cost {other:.6g}), {exact / quick:.1f} times"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
