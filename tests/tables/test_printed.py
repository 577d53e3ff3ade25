"""Reading printed values: digits as they stand, and what is wrong with its place."""

from decimal import Decimal

import pytest

from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.tables.print import MOST_BYTES, read_printed


def read(tmp_path, content: str | bytes):
    path = tmp_path / "p.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_printed(path)


def test_digits_are_kept(tmp_path):
    labels, rows = read(tmp_path, "theta,s\n150,1.30\n\n152,\n154,-.5\n")
    assert labels == ("theta", "s")
    assert rows == (
        (Decimal(150), Decimal("1.30")),
        (Decimal(152), None),
        (Decimal(154), Decimal("-0.5")),
    )
    assert [row[1] and row[1].as_tuple().exponent for row in rows] == [-2, None, -1]


@pytest.mark.parametrize(
    ("content", "place", "words"),
    [
        ("a,b\n1,2\n3,x4\n", "3:3", "b: 'x4' is no number"),
        ("a,b\n1,nan\n", "2:3", "'nan' is no number"),
        ("a,b\n1,2,3\n", "2:1", "the row has 3 cells for 2 labels"),
        ("a,a\n1,2\n", "1:1", "labels, each one once"),
        ("", "1:1", "labels, each one once"),
        (b"a,b\n1,\xff\n", "1:1", "byte 6 is not UTF-8 text"),
        ("a,b\n1," + "9" * 40 + "\n", "2:3", "is no number"),
        (b"1" * (MOST_BYTES + 1), "1:1", f"larger than {MOST_BYTES} bytes"),
    ],
)
def test_refusals(tmp_path, content, place, words):
    with pytest.raises(InvalidFile) as caught:
        read(tmp_path, content)
    assert f"p.csv:{place}: error: " in str(caught.value)
    assert words in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(UsageError, match=r"cannot read the printed values .* No such file"):
        read_printed(tmp_path / "none.csv")
