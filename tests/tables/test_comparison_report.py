"""What `tables --check` prints."""

import pytest

from mechkin_cli.tables.compare import CellChange, FileComparison, compare_files, report

EXPECTED = """\
rcsr/table_03.csv: different, 5 cells; largest relative change 0.2 (0.0031 of
    its column's largest value)
  columns not committed: FB
  row 1, omega2: committed 0.143, fresh 0.144
  row 2, s2: committed -9, fresh empty
  row 7, s2: committed -9, fresh -8
  and 2 more cells
rcsr/table_04.md: missing, not committed yet
rcsr/table_99.csv: extra, no table makes this file any more
4 table files: 1 equal, 1 different, 1 missing, 1 extra; where the change is
    meant, run `mechkin tables` and commit the files
"""


def test_the_whole_report():
    comparisons = [
        FileComparison(
            "rcsr/table_03.csv",
            "different",
            ("columns not committed: FB",),
            (
                CellChange(1, "omega2", "0.143", "0.144", 0.007, 0.007),
                CellChange(2, "s2", "-9", ""),
                CellChange(7, "s2", "-9", "-8", 0.2, 0.0031),
            ),
            5,
            0.2,
            0.0031,
        ),
        FileComparison("rcsr/table_05.csv", "equal"),
        FileComparison("rcsr/table_04.md", "missing"),
        FileComparison("rcsr/table_99.csv", "extra"),
    ]
    assert report(comparisons) == EXPECTED


@pytest.mark.parametrize(
    ("count", "text"), [(0, "0 table files: 0 equal\n"), (1, "1 table file: 1 equal\n")]
)
def test_equal_files_are_only_counted(count, text):
    assert report([FileComparison("a.csv", "equal")] * count) == text


@pytest.mark.parametrize(
    "committed",
    [
        b"x" * 5000 + b"\n" + b"y" * 5000,
        b"a," * 3000 + b"\n1,2\n",
        b"\xff\xfe\x00",
        b"\x1b[31m,\x07\n1,2\n",
        b'"unclosed',
    ],
)
@pytest.mark.parametrize("name", ["a.csv", "a.md", "a" * 200 + ".csv"])
def test_no_line_is_wider_than_80_columns_or_holds_control_characters(name, committed):
    text = report(compare_files({name: b"a\n1\n"}, {name: committed}))
    assert all(len(line) <= 80 for line in text.splitlines())
    assert all(line.isprintable() for line in text.split("\n"))
    assert "1 different" in text
