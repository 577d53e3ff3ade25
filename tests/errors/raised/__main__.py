"""Raises the references of `tests/reference/exact` to sixty digits.

`python -P tests/errors/raised` writes `tests/reference/raised`; with `--check` it writes nothing,
and the exit code is 1 where a file is not as written.
"""

from __future__ import annotations

import argparse
import csv
import io
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from errors.raised.tables import TABLES, path_of, raise_row, rows_of


def text_of(table: str) -> str:
    rows = [raise_row(table, row) for row in rows_of(table)]
    out = io.StringIO()
    writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true")
    check, wrong = parser.parse_args().check, 0
    for table in TABLES:
        path, text = path_of(table), text_of(table)
        if not check:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            print(f"{path.name} is not as written", file=sys.stderr)
            wrong = 1
    return wrong


if __name__ == "__main__":
    sys.exit(main())
