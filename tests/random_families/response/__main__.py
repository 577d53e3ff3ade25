"""Random mechanisms that move by themselves, against an independent integration.

`python -P tests/random_families/response --seeds 0:100`: exit code 1 where a row is wrong or lost.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.response.case import run_one


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", default="0:100", help="first:last, the last is left out")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--save", type=Path, help="folder for the files at fault")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split(":"))
    start, faults, worst = time.monotonic(), 0, [0.0] * 3
    with multiprocessing.Pool(options.processes) as pool:
        for found in pool.imap_unordered(run_one, range(first, last)):
            figures = (found.error, found.acceleration, found.energy)
            print(
                f"{found.seed:6d}  motion {figures[0]:.1e}  acceleration {figures[1]:.1e}"
                f"  energy {figures[2]:.1e}  reference {found.doubt:.1e}  {found.fault}",
                flush=True,
            )
            if found.fault:
                faults += 1
                if options.save:
                    options.save.mkdir(parents=True, exist_ok=True)
                    path = options.save / f"response_{found.seed}.yaml"
                    path.write_text(f"# {found.fault}\n{found.text}", encoding="utf-8")
            else:
                worst = [max(a, b) for a, b in zip(worst, figures, strict=True)]
    print(
        f"{last - first} mechanisms, {faults} at fault; the others within {worst[0]:.1e} in"
        f" motion, {worst[1]:.1e} in acceleration, {worst[2]:.1e} in energy;"
        f" {time.monotonic() - start:.0f} s"
    )
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
