"""Bounds of errors against errors in double-double, over random mechanisms, and against roots at
60 digits, over loops of one equation.

`python -P tests/random_families/error_bound --mechanisms 1000 --roots 1000`: exit code 1 where the
bound is false in a row, or in the median more than thirty times too large.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.error_bound import closed
from random_families.error_bound.case import FAMILIES, Rows, rows_of

DECADES = (0.0, 1e1, 1e2, 1e3, 1e5, 1e7, np.inf)
"""Of the condition, between which rows are told apart."""


def told(name: str, rows: Rows) -> str:
    """A line about some rows: how many, how often the bound is false, and how much it is above."""
    known = np.isfinite(rows.bound)
    false = np.count_nonzero(rows.error[known] > rows.bound[known])
    ratio = rows.bound[known] / np.maximum(rows.error[known], 1e-18)
    if not known.any():
        return f"{name:24s} {known.size:8d} rows, none with a bound"
    parts = [f"{known.size:8d} rows", f"{known.size - np.count_nonzero(known)} without"]
    parts += [f"{false} false", f"median {np.median(ratio):.1f} times the error"]
    return f"{name:24s} {', '.join(parts)}"


def together(parts: list[Rows]) -> Rows:
    return Rows(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def against_roots(numbers: range, places: int) -> int:
    """Prints what is found of loops of one equation, and returns how many bounds are false."""
    found: dict[str, list[closed.Row]] = {family: [] for family in closed.FAMILIES}
    for number in numbers:
        loop = closed.drawn(number)
        rows = closed.rows_of(loop, closed.turn_of(number, places))
        toward = closed.toward_dead_centre(loop)
        rows += closed.rows_of(loop, toward) if toward else []
        found[closed.FAMILIES[number % len(closed.FAMILIES)]] += rows
    false = 0
    for family, rows in found.items():
        if rows:
            error, bound, condition, _ = np.array(rows).T
            print(told(family, Rows(error, bound, condition)), flush=True)
            false += int(np.count_nonzero(error > bound))
    return false


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mechanisms", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    parser.add_argument("--roots", type=int, default=0, help="loops of one equation")
    parser.add_argument("--places", type=int, default=100, help="places of each")
    options = parser.parse_args()
    first = options.first
    false = against_roots(range(first, first + options.roots), options.places)
    numbers = range(first, first + options.mechanisms)
    if not options.mechanisms:
        return int(false > 0)
    found: dict[str, list[Rows]] = {family: [] for family in FAMILIES}
    for number in numbers:
        found[FAMILIES[number % len(FAMILIES)]].append(rows_of(number))
    every = together([rows for parts in found.values() for rows in parts])
    for family, parts in found.items():
        if parts:
            print(told(family, together(parts)))
    for low, high in itertools.pairwise(DECADES):
        chosen = (every.condition >= low) & (every.condition < high)
        print(told(f"condition {low:.0e} ... {high:.0e}", Rows(*(part[chosen] for part in every))))
    print(told("all", every))
    known = np.isfinite(every.bound)
    error, bound = every.error[known], every.bound[known]
    ratio = np.median(bound / np.maximum(error, 1e-18))
    return int(false > 0 or (error > bound).any() or ratio > 30.0)


if __name__ == "__main__":
    sys.exit(main())
