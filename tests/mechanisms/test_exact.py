"""Kinematics against values that other programs computed at 40 and more digits.

`rspr`, `rsgc`, `rspp`, `pspr`: closed forms of the paper on three-link mechanisms with its errata
corrected; `rchch`, `rcsr_csr`: the closure of the unfolded chains. Angles are in degrees.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from mechanisms.runs import edited, worst, worst_angle
from references import exact

LIMIT = 1e-12  # of the column's largest value

_SLIP = {f"slip_{c}": f"S.slip.{c}" for c in "xyz"}


def _rates(label: str, quantity: str, degrees: bool = False) -> dict[str, str]:
    value = f"{label}_deg" if degrees else label
    return {value: quantity, f"{label}_dot": f"{quantity}_dot", f"{label}_ddot": f"{quantity}_ddot"}


def _rchch() -> dict[str, str]:
    found = {}
    for k in "2345":
        found |= _rates(f"s{k}", f"O{k}.s")
        theta = f"O{k}.theta"
        found |= {f"theta{k}_deg": theta, f"omega{k}": f"{theta}_dot", f"alpha{k}": f"{theta}_ddot"}
    return found


def _rcsr_csr() -> dict[str, str]:
    names = {"theta2": "O2.theta", "s2": "O2.s", "theta4": "O4.theta"}
    names |= {"theta5": "O5.theta", "s5": "O5.s", "theta7": "O7.theta"}
    dots = {f"d{label}": f"{q}_dot" for label, q in names.items()}
    return names | dots | {f"dd{label}": f"{q}_ddot" for label, q in names.items()}


@dataclass(frozen=True)
class Case:
    """Rows of `exact/<table>.csv` for which `rows` hold, and what the file computes for them."""

    name: str
    table: str
    columns: dict[str, str]
    rows: dict[str, str] = field(default_factory=dict)
    edits: dict[str, Any] = field(default_factory=dict)

    @property
    def chosen(self) -> list[int]:
        data = exact(self.table)
        count = len(next(iter(data.values())))
        return [i for i in range(count) if all(data[k][i] == v for k, v in self.rows.items())]

    @property
    def quantities(self) -> list[str]:
        """Names without the components of vectors."""
        return [re.sub(r"\.[xyz]$", "", quantity) for quantity in self.columns.values()]

    def column(self, label: str) -> np.ndarray:
        """Seventeen digits, which reading rounds to the nearest double."""
        return np.array([float(exact(self.table)[label][i]) for i in self.chosen])


def near(**coordinates: float) -> dict[str, Any]:
    return {"assembly": {"near": {k.replace("_", "."): v for k, v in coordinates.items()}}}


_RSPR = _rates("theta_B", "B.theta", degrees=True) | _SLIP

_RSGC = _rates("theta_B", "B.theta", degrees=True) | _rates("s_G", "S.s") | _rates("s_B", "B.s")
_PRINTED = {
    "A": {"type": "R", "links": ["ground", "one"], "point": [0, 0, 0], "axis": [2, 1, 0]},
    "S": {"type": "Sp", "links": ["one", "two"], "point": ["1.5"] * 3, "normal": [0, 0, 1]},
    "B": {"type": "R", "links": ["ground", "two"], "point": [0, 0, 1], "axis": [-3, 2, 0]},
}
_BRANCH_B = near(O2_theta=-65, O3_theta=-46, O4_theta=-101, O5_theta=-23)

CASES = {
    "R-Sp-R": Case("rspr", "rspr", _RSPR, {"case": "rspr_identified", "branch": "home"}),
    "R-Sp-R other": Case(
        "rspr",
        "rspr",
        _RSPR,
        {"case": "rspr_identified", "branch": "other"},
        near(B_theta=-162),
    ),
    "R-Sp-R as printed": Case(
        "rspr",
        "rspr",
        _RSPR,
        {"case": "rspr_as_printed", "branch": "home"},
        {"joints": _PRINTED},
    ),
    "R-Sp-R as printed, other": Case(
        "rspr",
        "rspr",
        _RSPR,
        {"case": "rspr_as_printed", "branch": "other"},
        {"joints": _PRINTED, **near(B_theta=141)},
    ),
    "R-Sg-C": Case("rsgc", "rsgc", _RSGC, {"branch": "home"}),
    "R-Sg-C other": Case("rsgc", "rsgc", _RSGC, {"branch": "other"}, near(B_theta=-167)),
    "RCHCH A": Case("rchch", "rchch_kinematics_A_B", _rchch(), {"branch": "A"}),
    "RCHCH B": Case("rchch", "rchch_kinematics_A_B", _rchch(), {"branch": "B"}, _BRANCH_B),
    "RCSR-CSR": Case("rcsr_csr", "rcsr_csr_rigid_kinematics", _rcsr_csr()),
}


def error(label: str, values: np.ndarray, expected: np.ndarray) -> float:
    is_angle = label.endswith("_deg") or label.startswith("theta")
    return worst_angle(values, expected) if is_angle else worst(values, expected)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_sweeps(case):
    analysis = edited(case.name, case.quantities, **case.edits)
    assert analysis.rows == len(case.chosen)
    for label, quantity in case.columns.items():
        assert error(label, analysis[quantity], case.column(label)) <= LIMIT, label


ROW_BY_ROW = {
    "R-Sp-P": (Case("rspp", "rspp", _rates("s_B", "B.s") | _SLIP), "A.theta", "theta_A", {}),
    "P-Sp-R": (Case("pspr", "pspr", _RSPR, {"branch": "home"}), "A.s", "s_A", {}),
    "P-Sp-R other": (
        Case("pspr", "pspr", _RSPR, {"branch": "other"}),
        "A.s",
        "s_A",
        near(B_theta=160),
    ),
}


@pytest.mark.parametrize(("case", "driven", "label", "edits"), ROW_BY_ROW.values(), ids=ROW_BY_ROW)
def test_rows_with_rates_of_their_own(case, driven, label, edits):
    place = f"{label}_deg" if driven.endswith("theta") else label
    found = []
    for i in case.chosen:
        at, rate, acceleration = (
            exact(case.table)[name][i] for name in (place, f"{label}_dot", f"{label}_ddot")
        )
        motion = {"inputs": {driven: {"at": at, "rate": rate, "acceleration": acceleration}}}
        found.append(edited(case.name, case.quantities, motion=motion, **edits))
    for column, quantity in case.columns.items():
        values = np.array([analysis[quantity][0] for analysis in found])
        assert error(column, values, case.column(column)) <= LIMIT, column
