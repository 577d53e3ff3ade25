"""Rows and variants of chains of dyads at, beside and past dead centres and branch points.

`nice python -P tests/random_families/dyad_chains --chains 200`: exit code 1 where a row is lost or
wrong.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.dyad_chains.drawn import sweep
from random_families.dyad_chains.judge import judge
from random_families.dyad_chains.varied import judge_variants, varied


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--chains", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    parser.add_argument("--variants", action="store_true", help="of one-row files instead of rows")
    parser.add_argument("--rows", type=int, default=40, help="of a chain, about")
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    chains = bad = 0
    for number in range(options.first, options.first + options.chains):
        case = (varied if options.variants else sweep)(number, options.rows)
        if case is None:
            continue
        found = (judge_variants if options.variants else judge)(case)
        chains += 1
        counts += found.counts
        bad += len(found.lost) + len(found.wrong)
        for word, lines in (("LOST", found.lost), ("WRONG", found.wrong)):
            for line in lines[:1]:
                print(f"{number} {case.what}: {word} {len(lines)}, {line}", flush=True)
    print(f"{chains} chains, {counts.total()} rows: {dict(sorted(counts.items()))}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
