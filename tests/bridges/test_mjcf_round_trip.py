"""What goes out to MJCF and comes back is the same mechanism: coordinates, rates, accelerations,
named points, efforts and reactions agree in the row in which it was drawn."""

from __future__ import annotations

import os

import pytest
from bridges.round_trips import MECHANISMS, differences

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

SOME = [
    *("classics/bennett", "classics/five_link_suspension", "classics/sarrus", "classics/stewart"),
    *("couplings/cylinder_boom", "couplings/planetary_gear", "couplings/whitworth"),
    *("dissertation/prprrh", "dissertation/rchch", "lectures/lecture_ex3_6_screw"),
    *("plane/planar_shaper", "three_link_paper/cspc"),
]
ALL = sorted(
    str(path.relative_to(MECHANISMS).with_suffix("")) for path in MECHANISMS.glob("*/*.yaml")
)
REFUSED = {"couplings/cable_robot", "couplings/gear_play", "couplings/tackle"}


@pytest.mark.parametrize("name", ALL if os.environ.get("MECHKIN_RANDOM") else SOME)
def test_a_mechanism_comes_back(name: str) -> None:
    model = mk.load(MECHANISMS / f"{name}.yaml")
    if "sweep" not in model.runs:
        pytest.skip("it has responses alone")
    try:
        found = differences(model, model.analyze().rows // 2)
    except UsageError:
        assert name in REFUSED
        return
    assert found
    assert {name: error for name, error in found.items() if not error < 1e-9} == {}
