"""The pages on errors of the sources: as many as counted, and their right numbers are ours."""

from __future__ import annotations

import re

import pytest
from references import MECHANISMS, committed

PAGES = MECHANISMS.parent / "docs" / "errata"
COUNTS = {"lecture_notes": 11, "three_link_paper": 24}


def rows(name: str) -> list[list[str]]:
    lines = (PAGES / f"{name}.md").read_text(encoding="utf-8").splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [row for row in cells if re.fullmatch(r"[0-9]+", row[0])]


@pytest.mark.parametrize(("name", "count"), COUNTS.items())
def test_the_slips_are_numbered(name, count):
    assert [int(row[0]) for row in rows(name)] == list(range(1, count + 1))


def test_every_table_of_the_dissertation_is_compared():
    """Those with numbers: III to XXXVII; XIV, XXIV and XXXII are of letters."""
    found = {path.stem for path in MECHANISMS.glob("*/*/published/table_*.csv")}
    numbers = set(range(3, 38)) - {14, 24, 32}
    assert found == {f"table_{n:02}" for n in numbers} | {"table_31_as_printed"}


RIGHT = {
    2: ("ex3_5_C", ["P_x", "P_y", "P_z"]),
    3: ("ex3_6_screw", ["r13", "r21", "r32", "O_z", "O_x"]),
    4: ("ex3_6_rectangle", [f"P{k}_{axis}" for k in "1234" for axis in "xyz"]),
    6: ("ex7_1_double_slider", ["alpha_rod_z"]),
    7: ("ex7_2_crank_slider_clevis", [f"omega_AB_{axis}" for axis in "xyz"]),
    10: ("ex7_3b_d314", ["omega_coupler_x", "Omega"]),
    11: ("ex7_3c_d314", ["Bo_theta_ddot", *(f"alpha_coupler_{axis}" for axis in "xyz")]),
}


@pytest.mark.parametrize("number", RIGHT)
def test_right_numbers_are_those_of_the_tables(number):
    stem, labels = RIGHT[number]
    (row,) = committed(f"lecture_{stem}", "result")
    told = re.findall(r"-?[0-9]+(?:\.[0-9]+)?", rows("lecture_notes")[number - 1][3])
    for text, label in zip(told, labels, strict=False):
        unit = 10.0 ** -len(text.partition(".")[2])
        assert abs(float(text) - float(row[label])) <= 0.5001 * unit, label
    assert len(told) >= len(labels)
