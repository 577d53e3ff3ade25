"""Committed tables against fresh ones."""

import os

import pytest

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.compare import CellChange, compare_files, read_committed

OLD = b"theta,s,w\n150,2,0.001\n152,-4,\n"


def compared(fresh: bytes, committed: bytes, name: str = "a.csv"):
    (comparison,) = compare_files({name: fresh}, {name: committed})
    return comparison


def test_equal_missing_extra_in_order():
    fresh = {"b.csv": OLD, "a.csv": OLD, "new.md": b"# t\n"}
    found = compare_files(fresh, {"z.csv": b"", "a.csv": OLD, "b.csv": OLD, "old.csv": OLD})
    assert [(item.name, item.verdict) for item in found] == [
        ("b.csv", "equal"),
        ("a.csv", "equal"),
        ("new.md", "missing"),
        ("old.csv", "extra"),
        ("z.csv", "extra"),
    ]


def test_differing_cells_with_the_largest_changes():
    found = compared(b"theta,s,w\n150,2,0.002\n152,-5,\n", OLD)
    assert found.verdict == "different"
    assert found.remarks == ()
    assert found.cells == (
        CellChange(1, "w", "0.001", "0.002", 0.5, 1.0),
        CellChange(2, "s", "-4", "-5", 0.2, 0.25),
    )
    assert found.cell_count == 2
    assert found.largest_relative_change == 0.5
    assert found.largest_scaled_change == 1.0


def test_rounding_near_a_zero_crossing_is_small_beside_the_column():
    found = compared(b"s\n1000\n-2e-13\n", b"s\n1000\n2e-13\n")
    assert found.largest_relative_change == 2
    assert found.largest_scaled_change == pytest.approx(4e-16, rel=1e-12)


def test_an_emptied_cell_has_no_numeric_change():
    found = compared(b"theta,s,w\n150,,0.001\n152,-4,\n", OLD)
    assert found.cells == (CellChange(1, "s", "2", ""),)
    assert found.largest_relative_change is None


def test_only_the_first_cells_are_kept():
    rows = range(20)
    fresh = "x\n" + "".join(f"{row + 1}\n" for row in rows)
    committed = "x\n" + "".join(f"{row}\n" for row in rows)
    found = compared(fresh.encode(), committed.encode())
    assert [cell.row for cell in found.cells] == [1, 2, 3]
    assert found.cell_count == 20
    assert found.largest_relative_change == 1


@pytest.mark.parametrize(
    ("fresh", "committed", "remarks"),
    [
        (OLD + b"154,1,1\n", OLD, ("committed 2 rows, fresh 3",)),
        (b"a,c\n1,3\n", b"a,b\n1,2\n", ("columns not committed: c", "columns no longer made: b")),
        (b"b,a\n2,1\n", b"a,b\n1,2\n", ("the columns stand in another order or number",)),
        (b"a,b\n1,2\n", b"a,b\n1\n", ("committed row 1 has 1 cells for 2 columns",)),
        (
            OLD,
            OLD.replace(b"\n", b"\r\n"),
            ("the cells agree; line 1 differs in spacing, quotes or line ending",),
        ),
        (
            OLD,
            OLD.replace(b"152", b'"152"'),
            ("the cells agree; line 3 differs in spacing, quotes or line ending",),
        ),
        (
            OLD,
            OLD[:-1],
            ("the cells agree; line 4 differs in spacing, quotes or line ending",),
        ),
        (OLD, b"a\xff\n", ("committed file: byte 1 is not UTF-8 text",)),
        (
            b"a\n1\n",
            b"",
            ("columns not committed: a", "committed 0 rows, fresh 1"),
        ),
    ],
)
def test_remarks(fresh, committed, remarks):
    found = compared(fresh, committed)
    assert found.verdict == "different"
    assert found.remarks == remarks


def test_columns_are_matched_by_label():
    found = compared(b"new,s,theta\n1,2,150\n1,-4,153\n", b"theta,s\n150,2\n152,-4\n")
    assert [(cell.row, cell.column) for cell in found.cells] == [(2, "theta")]


def test_an_enormous_cell_is_reported_not_a_crash():
    found = compared(b"a\n1\n", b'a\n"' + b"x" * 200_000 + b'"\n')
    assert found.verdict == "different"
    assert "not readable as CSV" in found.remarks[0]


MARKDOWN = (
    "# T\n\n| a\\|b [in] |    m |\n| -------: | :--- |\n|        1 | A    |\n\n- Row 1: ok.\n"
)


def test_markdown_cells_and_text():
    fresh = MARKDOWN.replace("        1", "        2").replace("# T", "# U")
    found = compared(fresh.encode(), MARKDOWN.encode(), "t.md")
    assert found.cells == (CellChange(1, "a\\|b [in]", "1", "2", 0.5, 1.0),)
    assert found.remarks == ('text: committed "# T", fresh "# U"',)


def test_a_markdown_footnote_that_is_gone():
    fresh = MARKDOWN.replace("\n- Row 1: ok.\n", "")
    found = compared(fresh.encode(), MARKDOWN.encode(), "t.md")
    assert found.remarks == ('text: committed "- Row 1: ok.", fresh nothing',)


def test_markdown_padding():
    found = compared(MARKDOWN.encode(), MARKDOWN.replace("     1", "1").encode(), "t.md")
    assert found.remarks == ("the cells agree; line 5 differs in spacing, quotes or line ending",)


def test_the_committed_files_of_a_folder(tmp_path):
    (tmp_path / "b.csv").write_bytes(b"b")
    (tmp_path / "a.md").write_bytes(b"a")
    (tmp_path / "notes.txt").write_bytes(b"")
    (tmp_path / "folder.csv").mkdir()
    assert read_committed(tmp_path) == {"a.md": b"a", "b.csv": b"b"}
    assert read_committed(tmp_path / "none") == {}


def test_a_committed_file_that_cannot_be_read(tmp_path, monkeypatch):
    (tmp_path / "b.csv").write_bytes(b"b")

    def refuse(path, flags):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(UsageError, match=r"cannot read .*b\.csv: Permission denied"):
        read_committed(tmp_path)
