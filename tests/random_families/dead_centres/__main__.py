"""Dead centres proven of random four-bars, RSSR and slider-cranks, against closed forms.

`python -P tests/random_families/dead_centres --linkages 1000`: exit code 1 where an enclosure does
not hold the dead centre at 40 digits, or fewer than 99 in 100 are proven.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.dead_centres.case import linkage
from random_families.dead_centres.judge import judge


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--linkages", type=int, default=300)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    options = parser.parse_args()
    met = proven = wrong = 0
    radius = 0.0
    for number in range(options.first, options.first + options.linkages):
        found = judge(linkage(number))
        met, proven, wrong = met + found.met, proven + found.proven, wrong + len(found.false)
        radius = max(radius, found.radius)
        for line in found.reasons:
            print(f"{number}: {line}")
        for line in found.false:
            print(f"{number}: FALSE {line}")
    print(f"{met} dead centres, {proven} proven, {wrong} false, radii up to {radius:.1e}")
    return int(wrong > 0 or proven < 0.99 * met)


if __name__ == "__main__":
    sys.exit(main())
