"""python -P tests/random_families/change_points [--from N] [--count N] [--tolerance X]"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from random_families.change_points.judge import miss

LIMIT = 1e3
"""Errors in parts of the tolerance, at 1e-12 at least 1e-8."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--from", dest="first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--tolerance", type=float, default=1e-12)
    asked = parser.parse_args()
    lost, wrong, most = 0, 0, 0.0
    for number in range(asked.first, asked.first + asked.count):
        off, words = miss(number, asked.tolerance)
        if off == float("inf"):
            lost += 1
            print("lost:", words)
        elif off > max(1e-8, LIMIT * asked.tolerance):
            wrong += 1
            print("wrong:", words)
        else:
            most = max(most, off)
    print(f"{asked.count} motions: {lost} lost, {wrong} wrong, the others within {most:.2g} rad")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
