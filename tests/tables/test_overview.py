"""The overview page of a folder."""

from mechkin_cli.tables.errata import MARK, OverviewRow, overview_page


def test_one_line_per_file():
    page = overview_page(
        [
            OverviewRow(
                "rcsr", "RCSR", "R C S R", "1", "2", "27", "6 of 6 agree", "a book", "p.svg"
            ),
            OverviewRow(
                "odd", "a | b\nc", "R", "0 (count 1)", "1 (all)", "3 of 9", "", "", "p.svg"
            ),
        ]
    )
    lines = page.splitlines()
    assert lines[0] == MARK
    assert lines[-2:] == [
        "| ![RCSR](rcsr/p.svg) | [RCSR](rcsr.yaml) "
        "| R C S R | 1 | 2 | 27 | [6 of 6 agree](rcsr/errata.md) | a book |",
        "| ![a \\| b c](odd/p.svg) | [a \\| b c](odd.yaml) "
        "| R | 0 (count 1) | 1 (all) | 3 of 9 |  |  |",
    ]
    assert all(line.count("|") - line.count("\\|") == 9 for line in lines if line[:1] == "|")
