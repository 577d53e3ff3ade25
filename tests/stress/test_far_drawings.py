"""A drawing a million sizes away from the ground origin: nothing is lost but the places' digits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from rcsr.columns import KINEMATICS, LOADS, labels
from stress.cases import drawn_at

import mechkin_cli as mk

SHIFT = (2.0**23, -(2.0**24), 2.0**22)  # m; the mechanism's size is 10 m
FAR = float(np.linalg.norm(SHIFT))
EPS = 2.0**-52
PLACES = [label for _, label in labels(("table_04", "table_05"))]
AT_ORIGIN = [label for _, label in labels(LOADS) if label.startswith("M") and label != "MIN"]
SAME = [
    (table, label) for table, label in labels(KINEMATICS + LOADS) if label not in PLACES + AT_ORIGIN
]


@cache
def run(far: bool) -> mk.Analysis:
    return mk.loads(drawn_at(SHIFT if far else (0.0, 0.0, 0.0))).analyze()


@cache
def cells(far: bool) -> dict[tuple[str, str], np.ndarray]:
    return {(t.name, c.label): c.values for t in run(far).tables for c in t.columns}


def test_verdicts():
    assert not run(True).result.status.any()
    assert np.all(run(True)["row.residual"] <= 1e-14)
    assert np.all(run(True)["row.power_error"] <= 1e-12)


@pytest.mark.parametrize(("table", "label"), SAME)
def test_what_does_not_depend_on_the_place(table, label):
    """As exact as near the origin: 2e-14 and 1e-13 of the column's largest, from both sides."""
    near, far = cells(False)[table, label], cells(True)[table, label]
    limit = 2 * (1e-13 if table in LOADS else 2e-14)
    assert np.abs(far - near).max() <= limit * np.abs(near).max()


@pytest.mark.parametrize("point", ["pm1", "pm2", "pm3", "o2", "o3"])
def test_positions_are_shifted(point):
    """To a rounding of the distance."""
    near, far = (run(where)[f"{point}.position"] for where in (False, True))
    assert np.abs(far - near - SHIFT).max() <= EPS * FAR


@pytest.mark.parametrize("joint", ["O1", "O2", "O3", "O4"])
def test_moments_about_the_joint_stay(joint):
    near, far = (run(where)[f"{joint}.moment"] for where in (False, True))
    one_metre = np.abs(run(False)[f"{joint}.force"]).max()
    assert np.abs(far - near).max() <= 2e-13 * max(np.abs(near).max(), one_metre)


@pytest.mark.parametrize("joint", ["O1", "O2", "O3", "O4"])
def test_moments_about_the_origin_get_the_long_lever(joint):
    near, far = (run(where)[f"{joint}.moment_about_origin"] for where in (False, True))
    force = run(False)[f"{joint}.force"]
    wanted = near + np.cross(np.array(SHIFT), force)
    assert np.abs(far - wanted).max() <= 2e-13 * FAR * np.abs(force).max()
