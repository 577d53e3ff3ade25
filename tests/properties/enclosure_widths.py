"""How wide enclosures are: radii against true errors of the midpoints, over random mechanisms.

    python tests/properties/enclosure_widths.py [EVERY]

takes every so many of the random mechanisms of this folder. Errors are the largest of a row's
quantities of one family, each in parts of the family's largest; so are radii.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
from oracle.numerics import mp
from properties.answers import kind
from properties.cases import CASES, case
from properties.expected import expected
from properties.test_enclosures import enclosures


def widths(name: str) -> dict[str, tuple[float, float]]:
    """Largest error and largest radius by family, in parts of the family's largest value."""
    its = case(name)
    _, found = enclosures(its.text)
    largest: dict[str, list[float]] = {}
    for quantity, values in expected(its.mechanism, its.solution, its.reactions).items():
        if quantity not in found or quantity.endswith((".theta", ".theta1", ".theta2")):
            continue
        family = kind(quantity).family
        scale = its.size ** kind(quantity).lengths
        sums = largest.setdefault(family, [0.0, 0.0, 0.0])
        parts = (part[:, its.row] for part in found[quantity])
        for value, high, low, r in zip(values, *parts, strict=True):
            off = value - mp.mpf(float(high)) - mp.mpf(float(low))
            new = abs(float(value)) / scale, abs(float(off)) / scale, r / scale
            sums[:] = [max(old, each) for old, each in zip(sums, new, strict=True)]
    return {f: (error / value, r / value) for f, (value, error, r) in largest.items() if value}


def main() -> int:
    every = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    all_widths = [widths(name) for name in CASES[::every]]
    for family in ("order 0", "order 1", "order 2", "load"):
        error, radius = np.array([w[family] for w in all_widths if family in w]).T
        ratio = radius / np.maximum(error, 2.0**-106)
        print(
            f"{family}: {len(ratio)} rows, radius {np.median(radius):.1e} (at most "
            f"{radius.max():.1e}), over the true error {np.median(ratio):.0f} in the median, at "
            f"most {ratio.max():.0f}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
