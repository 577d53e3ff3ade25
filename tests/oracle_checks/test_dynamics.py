"""The independent equations of motion against published values and conservation of energy."""

from __future__ import annotations

import numpy as np
import pytest
from oracle import document
from oracle.dynamics.response import prepare
from references import RCSR, exact


def test_rcsr_moves_as_the_quadrature_at_forty_digits() -> None:
    data = document(RCSR)
    for key in ("motion", "tables", "loads", "assembly", "coefficients"):
        data.pop(key, None)
    data["parameters"] |= {"alpha1": "10 deg", "alpha4": "20 deg"}
    data["parameters"] |= {"P1": "5 in", "P2": "10 in", "P3": "5 in", "P4": "10 in"}
    near = {"O2.theta": "174.5", "O2.s": "-9.862", "O4.theta": "152.6"}
    times = {"from": "0", "to": "2", "step": "0.1"}
    run = {"start": {"O1.theta": "20"}, "near": near, "efforts": {"O1.theta": "10"}, "time": times}
    data["responses"] = {"run": run}
    found = prepare(data).run()
    columns = exact("rcsr_response") | exact("rcsr_response_tables")
    for name, quantity in (
        ("theta1", "O1.theta"),
        ("omega1", "O1.theta_dot"),
        ("alpha1", "O1.theta_ddot"),
        ("theta4", "O4.theta"),
        ("alpha4", "O4.theta_ddot"),
        ("kinetic_energy", "kinetic"),
        ("input_work", "work"),
    ):
        expected = [float(cell) for cell in columns[name]]
        assert found[quantity] == pytest.approx(expected, rel=1e-12, abs=1e-13), name
    assert np.max(np.abs(found["defect"])) < 1e-12
