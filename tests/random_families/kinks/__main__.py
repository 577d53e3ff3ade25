"""Random mechanisms under loads with kinks, against an independent integration.

`python -P tests/random_families/kinks --seeds 0:200`: exit code 1 where a row is wrong or lost.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.kinks.case import run_one


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", default="0:200", help="first:last, the last is left out")
    parser.add_argument("--save", type=Path, help="folder for the files at fault")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split(":"))
    start, faults, held, worst = time.monotonic(), 0, 0, 0.0
    for seed in range(first, last):
        found = run_one(seed)
        print(
            f"{seed:6d}  rows {found.rows}  motion {found.error:.1e}  reference {found.doubt:.1e}"
            f"  {found.fault}",
            flush=True,
        )
        held += "held" in found.rows
        if not found.fault:
            worst = max(worst, found.error)
            continue
        faults += 1
        if options.save:
            options.save.mkdir(parents=True, exist_ok=True)
            path = options.save / f"kinks_{seed}.yaml"
            path.write_text(f"# {found.fault}\n{found.text}", encoding="utf-8")
    print(
        f"{last - first} mechanisms, {held} held at a jump, {faults} at fault; the others within"
        f" {worst:.1e}; {time.monotonic() - start:.0f} s"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
