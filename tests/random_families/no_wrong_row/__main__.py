"""Random mechanisms near change points, merged and doubled, against closed forms.

`python -P tests/random_families/no_wrong_row --mechanisms 10000`: every row of every mechanism is
decided by its closed form; exit code 1 where one is wrong or lost.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from collections import Counter
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.no_wrong_row.run import Outcome, run_one


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--mechanisms", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--show", type=int, default=3, help="cases shown of each kind of fault")
    parser.add_argument("--save", type=Path, help="folder for the files of the cases shown")
    parser.add_argument("--series", type=int, default=1, choices=(1, 2, 3))
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.mechanisms)
    rows: Counter[str] = Counter()
    mechanisms: Counter[str] = Counter()
    start = time.monotonic()
    run = partial(run_one, series=options.series)
    with multiprocessing.Pool(options.processes) as pool:
        for outcome in pool.imap_unordered(run, numbers, chunksize=8):
            rows.update(outcome.counts)
            for kind, words in outcome.faults.items():
                mechanisms[kind] += 1
                if mechanisms[kind] <= options.show:
                    _show(outcome, kind, words, options.save)
    total = sum(rows.values())
    seconds = time.monotonic() - start
    print(f"{options.mechanisms} mechanisms, {total} rows, {seconds:.0f} s")
    for kind, count in rows.most_common():
        in_how_many = f" in {mechanisms[kind]} mechanisms" if mechanisms[kind] else ""
        print(f"{count:10d} {kind}{in_how_many}")
    return 1 if mechanisms else 0


def _show(outcome: Outcome, kind: str, words: str, folder: Path | None) -> None:
    print(f"{kind}: number {outcome.number} ({outcome.what}): {words}", flush=True)
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        name = kind.replace(":", "").replace(" ", "_")
        path = folder / f"{name}_{outcome.number}.yaml"
        path.write_text(f"# {kind}: {words}\n{outcome.text}", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
