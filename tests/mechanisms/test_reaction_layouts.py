"""Reaction tables in the source's layout against the dense system's own solution.

What a pair takes along and about its axis stands apart (FA, MA), F and M are what is left; the
joints of the files may have reversed axes or name their links the other way round.
"""

from __future__ import annotations

import numpy as np
import pytest
from references import FILE_OF, committed

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


COLUMNS = {
    ("rcsr", "table_14"): "F41 F21 F43 M41 M21 M43 FA1 FA4 FB FC FD MIN",
    ("rcsr_csr", "table_24"): "F41 F21 F43 M41 M21 M43 FA1 FA4 FB FC FD MIN"
    " F25 F46 M25 M46 FA7 FE FF FG",
    ("rchch", "table_32"): "F51 F21 F32 F43 F54 M51 M21 M32 M43 M54 FA1 FA3 FA5 MIN",
}
"""Unknowns of the printed coefficient tables in the order of their columns."""


@pytest.mark.parametrize(("where", "words"), COLUMNS.items(), ids=[n for _, n in COLUMNS])
def test_unknowns_are_the_reaction_tables(where, words):
    """In the source's order and signs: what its own columns have at the first row."""
    stem, name = where
    row: dict[str, str] = {}
    for file in sorted((FILE_OF[stem].parent / stem).glob("table_??.csv")):
        if file.stem != name:
            row |= committed(stem, file.stem)[0]
    labels = []
    for word in words.split():
        labels += [word] if word in row else [f"{word}_{axis}" for axis in "xyz"]
    values = list(unknowns(stem, name).values())
    for kind in ("F", "M"):
        chosen = [k for k, label in enumerate(labels) if label.startswith(kind)]
        assert near([values[k] for k in chosen], [float(row[labels[k]]) for k in chosen]), kind
    assert len(values) == len(labels)


def turned(axis: list[float], theta: float) -> np.ndarray:
    """A direction of the crank's home drawing, turned by -theta about x."""
    c, s = np.cos(np.radians(theta)), np.sin(np.radians(theta))
    return np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ axis


def in_plane(angle: float) -> list[float]:
    return [np.cos(np.radians(angle)), 0.0, np.sin(np.radians(angle))]


A1 = np.array([1.0, 0.0, 0.0])


def coefficients(stem: str, name: str) -> tuple[list[str], np.ndarray]:
    rows = [list(row.values()) for row in committed(stem, name)]
    return [row[1] for row in rows], np.array([[float(q) for q in row[2:-1]] for row in rows])


@pytest.mark.parametrize(
    ("stem", "name", "turn", "tilt", "point"),
    [
        ("rcsr", "table_14", 12.0, -15.0, (0.0, 0.5, 0.0)),
        ("rcsr_csr", "table_24", 10.0, None, None),
    ],
)
def test_loop_one_is_laid_out_as_in_print(stem, name, turn, tilt, point):
    """Entries that the text names: Q(4,24), Q(20,13), Q(22,7..9), Q(23,1..3), Q(24,10..12)."""
    names, q = coefficients(stem, name)
    theta = float(committed(stem, "table_" + ("15" if stem == "rcsr" else "25"))[0]["theta1"])
    a2 = turned(in_plane(turn), theta)
    assert list(q[0:6, 23]) == [0, 0, 0, 1, 0, 0]
    assert np.allclose(q[18, 3:6], a2, rtol=0, atol=1e-11)
    assert np.allclose(q[19, 12:15], a2, rtol=0, atol=1e-11)
    a4, arm = q[20, 6:9], q[21, 6:9]
    assert np.allclose(q[21, 15:18], a4, rtol=0, atol=1e-12)
    assert abs(a4 @ arm) <= 1e-11  # O4 x A4
    if tilt is not None:
        assert np.allclose(a4, in_plane(tilt), rtol=0, atol=1e-12)
        assert np.allclose(arm, np.cross(point, a4), rtol=0, atol=1e-12)
    assert list(q[22, 0:3]) == list(q[23, 9:12]) == list(A1)
    assert not np.any(q[23, 0:3])  # O1 lies on A1 through the origin
    assert [line.partition(":")[0] for line in names[:18:6]] == ["crank", "coupler", "rocker"]
    for first in (0, 3):  # ground and crank on the crank: F41 - F21, M41 - M21
        assert np.array_equal(q[0:3, first : first + 3], (1 - 2 * (first > 0)) * np.eye(3))


def test_loop_two_follows_loop_one():
    """Q(26,33) is A50z, F46 and M46 act on the output."""
    names, q = coefficients("rcsr_csr", "table_24")
    assert np.allclose(q[24, 24:27], q[25, 30:33], rtol=0, atol=1e-12)
    assert abs(np.linalg.norm(q[25, 30:33]) - 1) <= 1e-11
    assert abs(q[25, 24:27] @ q[25, 30:33]) <= 1e-10
    assert not np.any(q[24:, :24])
    rows = [k for k, line in enumerate(names) if line.startswith("output: ")]
    assert np.array_equal(q[rows[:3], 27:30], np.eye(3))
    assert np.array_equal(q[rows[3:], 33:36], np.eye(3))


def test_the_load_of_link_four_is_in_rows_21_to_26():
    """C(21) to C(26); MIN acts about A1 on link one, and every link takes the pair behind it."""
    names, q = coefficients("rchch", "table_32")
    assert names[20] == "four: force x"
    assert names[25] == "four: moment z"
    assert list(q[:6, 33]) == [0, 0, 0, 1, 0, 0]
    for k, first in enumerate((0, 6, 12, 20)):
        own, next_pair = 3 * k, 3 * k + 3
        sign = 1.0 if k == 0 else -1.0  # F51 and F21 both act on link one
        assert np.array_equal(q[first : first + 3, own : own + 3], sign * np.eye(3))
        assert np.array_equal(q[first : first + 3, next_pair : next_pair + 3], np.eye(3))


def test_screws_take_their_lead():
    """MA3 = -2 FA3 and MA5 = -5 FA5 in every row."""
    for table, number, lead in (("table_35", 3, 2), ("table_37", 5, 5)):
        for row in committed("rchch", table):
            force, moment = float(row[f"FA{number}"]), float(row[f"MA{number}"])
            assert abs(moment + lead * force) <= LIMIT * abs(moment)
