"""Studies that the tests share."""

from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
MECHANISMS = ROOT / "mechanisms"
KEPT = sorted(MECHANISMS.glob("*/studies/*.yaml"), key=lambda path: path.name)

RCSR: dict[str, Any] = {
    "vary": {
        "P1": {"from": "0.38 in", "to": "0.62 in", "count": 7},
        "P2": {"tolerance": "0.03 in"},
        "alpha1": {"deviation": "0.2 deg"},
    },
    "sample": {"count": 9, "seed": 3},
    "keep": [
        {"of": "O1.effort", "as": ["peak", "rms", "mean", "place_of_peak"]},
        {"of": "O4.theta", "as": ["max", "min", "range", "place_of_max", "place_of_min"]},
        {"of": "norm(O3.force)", "as": "value", "at": "170 deg", "label": "ball"},
    ],
    "rows": ["O4.theta", "O1.effort"],
    "dead_centres": "place",
}
"""Of rcsr.yaml: some variants end at a dead centre."""


def study_text(data: dict[str, Any], mechanism: Path) -> str:
    """The study as a file (JSON is YAML)."""
    import json

    return json.dumps({"study": 1, "mechanism": str(mechanism), **data}, indent=1)
