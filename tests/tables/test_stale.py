"""Only what mechkin wrote, and writes no more, counts as stale."""

from __future__ import annotations

import pytest

from mechkin_cli.tables.compare import stale_files
from mechkin_cli.tables.errata import HEAD, HEADER

CSV = b"theta,s\n0,1\n45,2\n"
PAGE = b"# Old table\n\n| theta [deg] | s [mm] |\n| --: | --: |\n| 0 | 1 |\n| 45 | 2 |\n"


def test_a_pair_is_stale_unless_it_is_made_again() -> None:
    both = {"old.csv": CSV, "old.md": PAGE}
    assert stale_files([], both) == ("old.csv", "old.md")
    assert stale_files(["old.csv", "old.md"], both) == ()
    assert stale_files(["old.csv"], both) == ()


@pytest.mark.parametrize(
    "others",
    [
        {"old.csv": CSV},
        {"old.md": PAGE},
        {"old.csv": CSV, "older.md": PAGE},
        {"old.csv": CSV, "old.md": PAGE.removeprefix(b"# Old table\n")},
        {"old.csv": CSV + b"90,3\n", "old.md": PAGE},
        {"old.csv": CSV.replace(b"theta", b"phi"), "old.md": PAGE},
        {"old.csv": b"\xff", "old.md": PAGE},
        {"old.csv": b"", "old.md": b"# my notes\n"},
        {"errata.md": b"# My errata\n"},
        {"disagreements.csv": b"who,with whom\n"},
    ],
)
def test_what_may_be_somebody_elses_stays(others: dict[str, bytes]) -> None:
    assert stale_files([], others) == ()


def test_the_pages_beside_print_are_known_by_their_words() -> None:
    pages = {
        "errata.md": f"# A: printed\n\n{HEAD}\n".encode(),
        "disagreements.csv": f"{HEADER}a,1,row,1,b,2,3,1\n".encode(),
    }
    assert stale_files([], pages) == ("disagreements.csv", "errata.md")
