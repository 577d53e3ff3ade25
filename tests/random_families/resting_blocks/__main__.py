"""Random blocks that rest and slip under loads over time, against scipy.

`python -P tests/random_families/resting_blocks --seeds 0:60`: exit code 1 where a row is wrong or
lost.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.resting_blocks.case import run_one


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", default="0:60", help="first:last, the last is left out")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split(":"))
    start, faults, worst = time.monotonic(), 0, 0.0
    for seed in range(first, last):
        found = run_one(seed)
        if found.fault:
            faults += 1
            print(f"{found.fault}\n{found.text}", flush=True)
        else:
            worst = max(worst, found.error)
    print(
        f"{last - first} blocks, {faults} at fault; the others within {worst:.1e};"
        f" {time.monotonic() - start:.0f} s"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
