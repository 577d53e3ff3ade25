"""Reaction tables in the source's layout against the dense system's own solution.

What a pair takes along and about its axis stands apart (FA, MA), F and M are what is left; the
joints of the files may have reversed axes or name their links the other way round.
"""

from __future__ import annotations

import pytest
from references import committed

LIMIT = 1e-9

SEVEN = {
    "sevenr": 7,
    "rprhrrr": 7,
    "rrrrrrh": 7,
    "rprrhc": 6,
    "pphchp": 6,
    "rcrcr": 5,
    "phchc": 5,
}


def unknowns(stem: str, name: str) -> dict[str, float]:
    return {row["unknown"]: float(row["value"]) for row in committed(stem, f"{name}_unknowns")}


def near(values: list[float], expected: list[float]) -> bool:
    largest = max(map(abs, expected))
    return all(abs(a - b) <= LIMIT * largest for a, b in zip(values, expected, strict=True))


@pytest.mark.parametrize(("stem", "count"), SEVEN.items(), ids=SEVEN)
def test_mechanisms_without_printed_numbers(stem, count):
    solution = unknowns(stem, "coefficients")
    for k in range(1, count + 1):
        row = committed(stem, f"reactions_{k}")[0]
        sign = -1.0 if k == count else 1.0  # the last joint goes from its link to ground
        pair = f"{count}{count - 1}" if k == count else f"{k - 1 or count}{k}"
        for letter in "FM":
            labels = [f"{letter}{pair}_{axis}" for axis in "xyz"]
            found = [float(row[label]) for label in labels]
            assert near(found, [sign * solution[f"J{k}.{letter}{axis}"] for axis in "xyz"]), labels
        for letter in ("FA", "MA"):
            if f"J{k}.{letter}" in solution:
                assert near([float(row[f"{letter}{k}"])], [sign * solution[f"J{k}.{letter}"]])
    first = committed(stem, "reactions_1")[0]
    (effort,) = (value for name, value in solution.items() if name.endswith(".effort"))
    assert near([float(first.get("MIN") or first["FIN"])], [effort])


A, REVERSED = 1.0, -1.0
"""The file's axis against the source's."""
CASES = {
    ("rcsr", "table_15"): ("table_14", "O1", "41", 1.0, ("FA1", REVERSED)),
    ("rcsr", "table_16"): ("table_14", "O2", "21", 1.0, None),
    ("rcsr", "table_17"): ("table_14", "O4", "43", 1.0, ("FA4", A)),
    ("rcsr_csr", "table_25"): ("table_24", "O1", "41", 1.0, ("FA1", REVERSED)),
    ("rcsr_csr", "table_26"): ("table_24", "O2", "21", 1.0, None),
    ("rcsr_csr", "table_27"): ("table_24", "O4", "43", 1.0, ("FA4", A)),
    ("rcsr_csr", "table_29"): ("table_24", "O5", "25", 1.0, None),
    ("rcsr_csr", "table_31"): ("table_24", "O7", "46", 1.0, ("FA7", A)),
    ("rchch", "table_33"): ("table_32", "O1", "51", 1.0, ("FA1", REVERSED)),
    ("rchch", "table_34"): ("table_32", "O2", "21", -1.0, None),
    ("rchch", "table_35"): ("table_32", "O3", "32", -1.0, ("FA3", REVERSED)),
    ("rchch", "table_36"): ("table_32", "O4", "43", 1.0, None),
    ("rchch", "table_37"): ("table_32", "O5", "54", 1.0, ("FA5", A)),
}
"""Joint, pair of links, whether the source turns the reaction round, what stands apart."""


@pytest.mark.parametrize(("where", "case"), CASES.items(), ids=[f"{s}-{t}" for s, t in CASES])
def test_printed_layouts(where, case):
    name, joint, pair, sign, apart = case
    row, solution = committed(*where)[0], unknowns(where[0], name)
    for letter in "FM":
        found = [float(row[f"{letter}{pair}_{axis}"]) for axis in "xyz"]
        assert near(found, [sign * solution[f"{joint}.{letter}{axis}"] for axis in "xyz"])
    if apart is not None:
        label, turned = apart
        assert near([float(row[label])], [sign * turned * solution[f"{joint}.FA"]])


@pytest.mark.parametrize(
    ("table", "ball", "names"),
    [
        ("table_28", "O3", {"FB": "B", "FC": "C", "FD": "B x C"}),
        ("table_30", "O6", {"FE": "E", "FF": "F", "FG": "E x F"}),
    ],
)
def test_forces_of_balls(table, ball, names):
    row, solution = committed("rcsr_csr", table)[0], unknowns("rcsr_csr", "table_24")
    found = [float(row[label]) for label in names]
    assert near(found, [solution[f"{ball}.F {direction}"] for direction in names.values()])


def test_screws_take_their_lead():
    """MA3 = -2 FA3 and MA5 = -5 FA5 in every row."""
    for table, number, lead in (("table_35", 3, 2), ("table_37", 5, 5)):
        for row in committed("rchch", table):
            force, moment = float(row[f"FA{number}"]), float(row[f"MA{number}"])
            assert abs(moment + lead * force) <= LIMIT * abs(moment)
