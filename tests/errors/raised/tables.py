"""The tables of `tests/reference/exact` with sixty digits instead of seventeen."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mpmath
from errors.raised import chains, three_links
from oracle import mp
from references import FOLDER, exact

DIGITS = 60
ROUNDING = 1e-16
"""Of a number of seventeen digits."""
PLACES = ("case", "branch", "theta1", "theta_A_deg", "theta_A_dot", "theta_A_ddot")
PLACES += ("s_A", "s_A_dot", "s_A_ddot")
"""Columns that say which row it is, and keep their text."""
TABLES = {
    **dict.fromkeys(("rcsr", "rchch_kinematics_A_B", "rcsr_csr_rigid_kinematics"), chains.raised),
    **dict.fromkeys(("rspr", "rsgc", "rspp", "pspr"), three_links.raised),
}


def path_of(table: str) -> Path:
    return FOLDER / "raised" / f"{table}.csv"


def rows_of(table: str) -> Iterator[dict[str, str]]:
    """The rows as they are kept, with seventeen digits."""
    data = exact(table)
    for values in zip(*data.values(), strict=True):
        yield dict(zip(data, values, strict=True))


def raise_row(table: str, row: dict[str, str]) -> dict[str, str]:
    """A row with sixty digits, each cell of which rounds to the seventeen.

    Raises:
        ValueError: a cell does not.
    """
    computed = TABLES[table](table, row)
    with mp.workdps(DIGITS + 10):
        found = {label: mp.mpf(value) for label, value in computed.items()}
    for label, value in found.items():
        if abs(value - mp.mpf(row[label])) > ROUNDING * abs(value) + 1e-28:
            raise ValueError(f"{table}: {label} is {mp.nstr(value, 20)}, kept is {row[label]}")
    kept = {label: row[label] for label in PLACES if label in row}
    return kept | {label: _text(value) for label, value in found.items()}


def _text(value: Any) -> str:
    return str(mpmath.nstr(mp.in_mpmath(value), DIGITS, strip_zeros=False))
