"""Loops whose branches come close to each other, or whose slides grow long: the same rows always.

The places of the dead centres are the oracle's, reached from home in small steps.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracle.document import document, to_text

import mechkin_cli as mk
from mechkin_cli.verdict import Status

LOOPS = Path(__file__).parent / "loops"
DEAD_CENTRES = {
    "chrrc": 9.46711963726975155,
    "rrrrhrr": 157.700749222384029,
    "rprcrr": 166.146730613026761,
}
"""In degrees of the input, on the branch through home; no row beyond has a solution on it."""


def swept(name: str, to: float, count: int, **options) -> mk.Analysis:
    data = document(LOOPS / f"{name}.yaml")
    data["motion"]["inputs"]["J1.theta"] = {"from": "0", "to": str(to), "count": str(count)}
    return mk.loads(to_text(data)).analyze(["J5.theta"], tables=[], **options)


def check_verdicts(name: str, analysis: mk.Analysis) -> None:
    beyond = analysis["J1.theta"] > DEAD_CENTRES[name]
    assert np.all(analysis.result.status[~beyond] == Status.ok)
    assert np.all(analysis.result.status[beyond] == Status.beyond_dead_centre)


@pytest.mark.parametrize("count", [2, 3, 4, 7, 13, 31, 181, 721])
@pytest.mark.parametrize(("name", "to"), [("chrrc", 30), ("rrrrhrr", 180), ("rprcrr", 180)])
def test_no_step_leads_past_a_dead_centre(name, to, count):
    check_verdicts(name, swept(name, to, count))


@pytest.mark.parametrize("joint", ["J2", "J3", "J4", "J5", "J6"])
def test_long_slides_close_at_any_joint(joint):
    """Slides of sixty sizes: the loops are closed as well as such lengths can be."""
    analysis = swept("rprcrr", 180, 361, closed_at=[joint])
    check_verdicts("rprcrr", analysis)


@pytest.mark.parametrize("name", ["chrrc", "rrrrhrr"])
def test_coarse_and_fine_rows_are_the_same(name):
    coarse, fine = swept(name, 180, 13), swept(name, 180, 721)
    assert np.array_equal(coarse.result.status, fine.result.status[::60])
    solved = coarse.result.status == Status.ok
    difference = np.abs(coarse["J5.theta"] - fine["J5.theta"][::60])[solved]
    assert np.all(difference <= 1e-10)
