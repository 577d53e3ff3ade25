"""The RCSR mechanism driven from rest by a torque of 10 lbm in^2/s^2, with the data of the source's
response: motion and energies by quadrature at 40 digits, reactions by Newton-Euler."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from oracle import document, to_text
from references import RCSR, exact

import mechkin_cli as mk

MOTION = {
    "theta1": "O1.theta",
    "omega1": "O1.theta_dot",
    "alpha1": "O1.theta_ddot",
    "kinetic_energy": "row.kinetic_energy",
    "input_work": "row.work",
}
AXIAL_1, AXIAL_4 = "dot(O1.force, A1)", "dot(O4.force, A4)"
_B_C_D = "det(B, C, cross(B, C))"
TABLES = {
    "theta1": "O1.theta",
    "omega1": "O1.theta_dot",
    "omega2": "O2.theta_dot",
    "omega4": "O4.theta_dot",
    "alpha1": "O1.theta_ddot",
    "alpha2": "O2.theta_ddot",
    "alpha4": "O4.theta_ddot",
    "theta2": "O2.theta",
    "s2": "O2.s",
    "theta4": "O4.theta",
    "FA1": AXIAL_1,
    "FA4": AXIAL_4,
    "FB": f"det(O3.force, C, cross(B, C))/{_B_C_D}",
    "FC": f"det(B, O3.force, cross(B, C))/{_B_C_D}",
    "FD": f"det(B, C, O3.force)/{_B_C_D}",
}
for _x in "xyz":
    TABLES |= {
        f"F41_{_x}": f"(O1.force - {AXIAL_1}*A1).{_x}",
        f"M41_{_x}": f"O1.moment_about_origin.{_x}",
        f"F12_{_x}": f"O2.force.{_x}",
        f"M12_{_x}": f"O2.moment_about_origin.{_x}",
        f"F43_{_x}": f"(O4.force - {AXIAL_4}*A4).{_x}",
        f"M43_{_x}": f"(O4.moment_about_origin - {AXIAL_4}*cross(O4.point, A4)).{_x}",
    }


def text(tolerance: str = "1e-13") -> str:
    """The file of the kinetostatics with the parameters of the response."""
    data = document(RCSR)
    for key in ("motion", "tables", "loads", "assembly", "coefficients"):
        data.pop(key, None)
    data["parameters"] |= {"alpha1": "10 deg", "alpha4": "20 deg"}
    data["parameters"] |= {"P1": "5 in", "P2": "10 in", "P3": "5 in", "P4": "10 in"}
    data["responses"] = {
        "run": {
            "start": {"O1.theta": "20"},
            "near": {"O2.theta": "174.5", "O2.s": "-9.862", "O4.theta": "152.6"},
            "efforts": {"O1.theta": "10"},
            "time": {"from": "0", "to": "2", "step": "0.1"},
            "tolerance": tolerance,
        }
    }
    return to_text(data)


@cache
def response() -> Any:
    return mk.loads(text()).respond("run")


def error(column: list[str], found: Any) -> float:
    expected = np.array(column, dtype=float)
    return float(np.max(np.abs(found - expected)) / np.max(np.abs(expected)))


@pytest.mark.parametrize("name", MOTION)
def test_the_motion_is_exact(name: str) -> None:
    assert error(exact("rcsr_response")[name], response()[MOTION[name]]) < 1e-10


@pytest.mark.parametrize("name", sorted(TABLES))
def test_every_column_of_the_tables_is_exact(name: str) -> None:
    column = exact("rcsr_response_tables")[name]
    found = response()[TABLES[name]]
    if not any(float(cell) for cell in column):
        assert np.max(np.abs(found)) < 1e-9
    else:
        assert error(column, found) < 1e-9


def test_energy_is_kept() -> None:
    assert np.max(response()["row.energy_error"]) <= 1e-11
    assert set(response()["row.status"]) == {"ok"}


def test_the_default_tolerance_keeps_ten_digits_of_the_angle() -> None:
    found = mk.loads(text("1e-10")).respond("run")
    assert error(exact("rcsr_response")["theta1"], found["O1.theta"]) < 1e-10
