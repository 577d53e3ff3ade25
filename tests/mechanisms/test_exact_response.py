"""The response of the RCSR mechanism against an energy integral at 40 digits.

`rcsr_response.csv` has the motion, kinetic energy and work; `rcsr_response_tables.csv` every column
of Tables XIX to XXIII in the source's signs and places, with a drive of 10 in the sense of growing
theta1, which is about -A1.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mechanisms.runs import model, worst
from references import committed, exact

import mechkin_cli as mk

MOTION = {
    "theta1": "O1.theta",
    "omega1": "O1.theta_dot",
    "alpha1": "O1.theta_ddot",
    "kinetic_energy": "row.kinetic_energy",
    "input_work": "row.work",
}
COORDINATES = {"theta2": "O2.theta", "s2": "O2.s", "theta4": "O4.theta"}
TABLES = {
    "table_19": ["theta1", "omega1", "omega2", "omega4", "alpha1", "alpha2", "alpha4", "t"],
    "table_20": [*(f"{k}41_{axis}" for k in "FM" for axis in "xyz"), "FA1"],
    "table_21": [f"{k}12_{axis}" for k in "FM" for axis in "xyz"],
    "table_22": ["FB", "FC", "FD", "alpha1"],
    "table_23": [*(f"{k}43_{axis}" for k in "FM" for axis in "xyz"), "FA4"],
}


def values(table: str, label: str) -> np.ndarray:
    return np.array([float(text) for text in exact(table)[label]])


@cache
def response() -> mk.Analysis:
    return model("rcsr_response").respond("response")


@pytest.mark.parametrize("label", MOTION)
def test_motion_energy_and_work(label):
    found = response()[MOTION[label]]
    assert worst(found, values("rcsr_response", label)) <= 1e-10


def test_no_energy_is_lost():
    assert np.max(np.abs(response()["row.energy_error"])) <= 1e-11


@pytest.mark.parametrize("label", COORDINATES)
def test_other_coordinates(label):
    found = response()[COORDINATES[label]]
    assert worst(found, values("rcsr_response_tables", label)) <= 1e-10


@pytest.mark.parametrize(
    ("table", "label"), [(table, label) for table, labels in TABLES.items() for label in labels]
)
def test_every_column_of_the_tables(table, label):
    """As committed, with twelve digits; columns that vanish do so to rounding of the others."""
    found = np.array([float(row[label]) for row in committed("rcsr_response", table)])
    expected = values("rcsr_response_tables", label)
    assert found.size == expected.size == 21
    largest = np.max(np.abs(expected))
    assert np.max(np.abs(found - expected)) <= (1e-9 * largest if largest else 1e-11)
