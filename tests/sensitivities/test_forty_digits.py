"""Sensitivities of kept mechanisms against derivatives of 40 digits by the independent oracle.

`MECHKIN_RANDOM=1` takes all mechanisms instead of some, all their parameters and a number of the
file made a parameter; 2 and more as many numbers. `python -P tests/sensitivities/exact` tells the
worst deviation of each.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest
from oracle import read
from sensitivities.exact.comparison import Compared, compare
from sensitivities.exact.files import NAMES, file, some_rows, spatial, with_parameters

from mechkin_cli.sensitivities.first_order import Sensitivities

RIGHT = 1e-10
"""In parts of the column's largest."""
NUMBERS = int(os.environ.get("MECHKIN_RANDOM", "0"))
SOME = {
    "rcsr": ["P1"],
    "planar_shaper": [],
    "hooke": ["angle"],
    "bennett": ["a"],
    "rsgc": [],
    "phchc": [],
    "lecture_ex7_3c_d314": [],
}


def compared(name: str) -> list[Compared]:
    data = file(name)
    parameters = list(data.get("parameters", {})) if NUMBERS else SOME[name]
    parameters = parameters + with_parameters(data, NUMBERS or 1, name)
    return compare(data, parameters, some_rows(read(spatial(data)).rows, 2 if NUMBERS else 1))


@pytest.mark.parametrize("name", NAMES if NUMBERS else SOME)
def test_derivatives(name: str) -> None:
    found = compared(name)
    assert max(one.off for one in found) <= RIGHT, max(found, key=lambda one: one.off)
    assert not [one for one in found if one.wrong]
    assert sum(one.told for one in found) > 0


def test_a_part_in_a_billion_is_seen(monkeypatch: Any) -> None:
    own = Sensitivities.__getitem__

    def wrong(s: Sensitivities, pair: tuple[str, str]) -> np.ndarray:
        return own(s, pair) * (1.0 + 1e-9 * (pair[0] == "B.theta_dot"))

    monkeypatch.setattr(Sensitivities, "__getitem__", wrong)
    found = {one.quantity: one.off for one in compared("rsgc")}
    assert found.pop("B.theta_dot") > RIGHT
    assert max(found.values()) <= RIGHT
