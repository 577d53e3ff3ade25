"""Unfolded chains at many digits: Newton's method of the oracle from the seventeen digits."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from mechanisms.test_exact import CASES
from mechanisms.test_oracle import mechanism
from oracle import Mechanism, mp, newton_euler, read, solve
from oracle_checks.test_rcsr import COORDINATES
from references import RCSR

DIGITS = 90
FILES = {"rcsr": "rcsr", "rchch_kinematics_A_B": "rchch", "rcsr_csr_rigid_kinematics": "rcsr_csr"}
POINTS = ("pm1", "pm2", "pm3", "o2", "o3")
REACTIONS = {"ne_F21": "force", "ne_M21": "moment_about_origin"}


def columns_of(table: str) -> dict[str, str]:
    """Quantities by the headers of their columns; angles in degrees."""
    if table == "rcsr":
        return {label: quantity for label, (quantity, _) in COORDINATES.items()}
    return next(case.columns for case in CASES.values() if case.table == table)


@cache
def _mechanism(table: str) -> Mechanism:
    return read(RCSR) if table == "rcsr" else mechanism.__wrapped__(FILES[table])


def raised(table: str, row: Mapping[str, str]) -> dict[str, Any]:
    """The cells of a row of `exact/<table>.csv`, of the RCSR with places and loads."""
    with mp.workdps(DIGITS):
        degree = mp.pi / 180
        columns = columns_of(table)
        guess = {q: mp.mpf(row[label]) * _unit(q) for label, q in columns.items()}
        its = _mechanism(table)
        rows = (its.row(k) for k in range(its.rows))
        place = mp.mpf(row["theta1"]) * degree
        inputs = min(rows, key=lambda inputs: abs(inputs["O1.theta"][0] - place))
        solution = solve(its, inputs, guess)
        found = {label: solution[q] / _unit(q) for label, q in columns.items()}
        if table != "rcsr":
            return found
        for point in POINTS:
            for prefix, values in zip(("", "v_", "a_"), solution.point(point), strict=False):
                found |= _vector(f"{prefix}{point}", values)
        loads = newton_euler(its, solution)
        found |= _vector("ne_F21", loads.force["O2"])
        found |= _vector("ne_M21", loads.moment_about_origin["O2"])
        return found | {"ne_MIN": -loads.effort["O1.theta"]}


def _unit(quantity: str) -> Any:
    return mp.pi / 180 if quantity.endswith(".theta") else mp.one


def _vector(label: str, values: Any) -> dict[str, Any]:
    return {f"{label}_{axis}": value for axis, value in zip("xyz", values, strict=True)}
