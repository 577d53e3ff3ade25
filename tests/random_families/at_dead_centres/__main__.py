"""Rows at and beside dead centres of random linkages, against closed forms.

`python -P tests/random_families/at_dead_centres --linkages 1000`: exit code 1 where a row is lost
or wrong.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.at_dead_centres.case import FAMILIES
from random_families.at_dead_centres.judge import judge


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--linkages", type=int, default=300)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    parser.add_argument("--family", choices=FAMILIES, action="append")
    options = parser.parse_args()
    bad = 0
    for family in options.family or FAMILIES:
        files = rows = lost = wrong = 0
        for number in range(options.first, options.first + options.linkages):
            case = FAMILIES[family](number)
            if case is None:
                continue
            found = judge(case)
            files, rows = files + 1, rows + found.rows
            lost, wrong = lost + len(found.lost), wrong + len(found.wrong)
            for word, lines in (("LOST", found.lost), ("WRONG", found.wrong)):
                for line in lines[:1]:
                    print(f"{family} {number}: {word} {len(lines)}, {line}")
        print(f"{family}: {files} files, {rows} rows, {lost} lost, {wrong} wrong", flush=True)
        bad += lost + wrong
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
