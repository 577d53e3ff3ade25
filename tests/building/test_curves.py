"""Tables of two columns: the smooth curve through them, and what is said about bad ones."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.interpolate import CubicSpline

from mechkin_cli.building.fields import Fields
from mechkin_cli.building.load_laws import read_curve
from mechkin_cli.mechanism.curve import Curve, smooth_curve
from mechkin_cli.reading.document import document_from_text, read_document
from mechkin_cli.units.dimension import ANGLE, TIME
from mechkin_cli.units.units import UnitSystem

FILE = "format: 1\nlaw: t.csv\n"


def cubic(x: float) -> list[float]:
    """x^3 - 4 x + 1 and its derivatives."""
    return [x * x * x - 4 * x + 1, 3 * x * x - 4, 6 * x, 6]


def test_a_table_of_a_cubic_is_met_between_and_beyond_its_points() -> None:
    points = [-2.0, -1.5, 0.25, 1.0, 3.0]
    curve = smooth_curve(points, [cubic(x)[0] for x in points])
    x = np.linspace(-3, 4, 29)
    expected = np.array([cubic(value) for value in x]).T
    np.testing.assert_allclose(curve.evaluate(x), expected, rtol=0, atol=2e-12)
    assert (curve.first, curve.last) == (-2.0, 3.0)


@pytest.mark.parametrize(
    ("x", "y", "at_two"),
    [
        ([1.0, 3.0], [10.0, 14.0], [12.0, 2.0, 0.0, 0.0]),
        ([0.0, 1.0, 3.0], [0.0, 1.0, 9.0], [4.0, 4.0, 2.0, 0.0]),
        ([0.0, 1.0, 3.0, 4.0], [5.0, 5.0, 5.0, 5.0], [5.0, 0.0, 0.0, 0.0]),
    ],
)
def test_few_points(x: list[float], y: list[float], at_two: list[float]) -> None:
    assert smooth_curve(x, y).evaluate(np.array([2.0]))[:, 0].tolist() == at_two


@given(
    st.lists(st.floats(0.1, 3.0), min_size=2, max_size=12),
    st.lists(st.floats(-5.0, 5.0), min_size=13, max_size=13),
)
def test_the_curve_is_the_spline_with_not_a_knot_ends(gaps: list[float], y: list[float]) -> None:
    x = np.concatenate([[0.0], np.cumsum(gaps)])
    ordinates = y[: x.size]
    curve, peer = smooth_curve(x.tolist(), ordinates), CubicSpline(x, ordinates)
    at = np.concatenate([x, (x[1:] + x[:-1]) / 2])
    for order, found in enumerate(curve.evaluate(at)[:3]):
        scale = 1e-9 * max(1.0, *np.abs(peer(at, order)))
        np.testing.assert_allclose(found, peer(at, order), rtol=0, atol=scale)
    assert curve.evaluate(x)[0].tolist() == ordinates


def read(folder: Path, content: str | bytes) -> tuple[Curve | None, str]:
    """The curve of t.csv beside a file in deg and ms, and all that is said about it."""
    (folder / "m.yaml").write_text(FILE)
    text = content.encode() if isinstance(content, str) else content
    (folder / "t.csv").write_bytes(text)
    units = UnitSystem.from_mapping({"angle": "deg", "time": "ms"})
    fields = Fields(read_document(folder / "m.yaml"), units)
    curve = read_curve(fields, ("law",), "t.csv", TIME, ANGLE)
    return curve, "\n".join(map(str, fields.diagnostics)).replace(f"{folder}/", "")


@pytest.mark.parametrize(
    "content", ["t,x\n0,0\n500,90\n", "\ufefft, x\r\n0 , 0\r\n\r\n 5e2,+90.0\r\n\r\n"]
)
def test_numbers_are_in_the_files_units(tmp_path: Path, content: str) -> None:
    curve, said = read(tmp_path, content)
    assert said == ""
    assert curve is not None
    assert curve.last == 0.5
    value, slope, *_ = curve.evaluate(np.array([0.25]))[:, 0]
    assert (value, slope) == pytest.approx((np.pi / 4, np.pi), rel=1e-15)


BAD = [
    ("t,x\n0,0\n1 ms,5\n", "t.csv:3:1: error: '1 ms' is not a number; write a finite number"),
    ("t,x\n0,0\n1,abc\n", "t.csv:3:3: error: 'abc' is not a number"),
    ("t,x\n0,0\n1,nan\n", "t.csv:3:3: error: 'nan' is not a number"),
    ("t,x\n0,0\n1,1e999\n", "t.csv:3:3: error: '1e999' is not a number"),
    ("t,x\n0,0\n1,\n", "t.csv:3:3: error: '' is not a number"),
    ("t,x\n0,0\n1,2,3\n", "t.csv:3:1: error: this row has 3 columns, not two; write x,y"),
    ("t;x\n0;0\n1;2\n", "t.csv:2:1: error: the columns of this table are parted by semicolons"),
    ("t;x\n0;1,5\n1;2,5\n", "t.csv:2:1: error: the columns of this table are parted by semicol"),
    ("t,x\n0,0\n2,0\n\n2,1\n", "t.csv:5:1: error: 2.0 is not larger than the 2.0 before it"),
    ("t,x\n0,0\n2,0\n1,1\n", "t.csv:4:1: error: 1.0 is not larger than the 2.0"),
    ("0,0\n1,1\n2,2\n", "t.csv:1:1: error: this table has no header"),
    ("t,x\n0,0\n", "t.csv:3:1: error: this table has one row behind its header; give two"),
    ("t,x\n", "t.csv:2:1: error: this table has no row"),
    ("", "t.csv:1:1: error: this table has no row"),
    ("t,x\n0,0\n1,1e150\n", "t.csv:3:1: error: 1e+150 is too large to compute with (limit 5.73e+"),
    ("t,x\n0,0\n1e-320,1\n2,3\n", "m.yaml:2:6: error: the curve through this table is too steep"),
    (b"t,x\n0,\xff\n", "t.csv:2:1: error: the byte 0xFF is not UTF-8 text; save the file"),
    (
        "t,x\n" + "0,0\n" * 1_100_000,
        "m.yaml:2:6: error: t.csv is too large for a table: more than 4 MiB (limit 4194304 bytes)",
    ),
]


@pytest.mark.parametrize(("content", "words"), BAD, ids=[words for _, words in BAD])
def test_bad_tables_are_refused_at_their_line(
    tmp_path: Path, content: str | bytes, words: str
) -> None:
    curve, said = read(tmp_path, content)
    assert curve is None
    assert said.startswith(words)
    assert "\n" not in said


def test_a_missing_table_is_refused_where_it_is_named(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text(FILE)
    fields = Fields(read_document(tmp_path / "m.yaml"), UnitSystem())
    for name, words in (("t.csv", "does not exist"), (".", "is not a regular file")):
        assert read_curve(fields, ("law",), name, TIME, ANGLE) is None
        said = str(fields.diagnostics.pop())
        assert f"m.yaml:2:6: error: {tmp_path / name} {words}" in said


def test_a_text_without_a_file_has_no_folder() -> None:
    fields = Fields(document_from_text(FILE, "text"), UnitSystem())
    assert read_curve(fields, ("law",), "t.csv", TIME, ANGLE) is None
    assert "this text comes from no file" in str(fields.diagnostics[0])
