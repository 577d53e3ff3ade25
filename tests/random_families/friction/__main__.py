"""Random loops with friction against dense free-body equations.

    python -P tests/random_families/friction --seeds 0:1000 [--actuators] [--radius LOW:HIGH]

`--radius` scales the coefficients of each so that the spectral radius of its Lipschitz matrix in
the first row is random in between. Exit code 1 where something is wrong.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from random_families.friction.case import LOST, Answers, is_slow, judge, rows, text_of
from random_families.friction.loops import Loop, loop


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", default="0:100", help="first:last, the last is left out")
    parser.add_argument("--actuators", action="store_true", help="efforts act elsewhere")
    parser.add_argument("--radius", help="low:high, of the first row")
    parser.add_argument("--save", type=Path, help="folder for the files at fault")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split(":"))
    counts: Counter[str] = Counter()
    decided, faults = Counter[tuple[str, bool]](), 0
    for seed in range(first, last):
        own, radius = loop(seed, actuators=options.actuators), None
        if own is not None and options.radius:
            own, radius = scaled(own, seed, *map(float, options.radius.split(":")))
        if own is None:
            counts["none"] += 1
            continue
        judged = judge(own)
        counts += judged.counts
        if radius is not None and not judged.fault:
            decided["below 1" if radius < 1.0 else "above 1", judged.counts["ok"] > 0] += 1
        if judged.fault:
            faults += 1
            print(f"{seed:6d}  {judged.fault[:400]}", flush=True)
            if options.save:
                options.save.mkdir(parents=True, exist_ok=True)
                path = options.save / f"friction_{seed}.yaml"
                path.write_text(f"# {judged.fault}\n{text_of(own.data)}\n", encoding="utf-8")
    print(f"{faults} at fault; rows: {dict(counts)}")
    for (where, is_decided), number in sorted(decided.items()):
        print(f"radius {where}: {number} {'decided' if is_decided else 'undecided'}")
    return 1 if faults else 0


def scaled(own: Loop, seed: int, low: float, high: float) -> tuple[Loop | None, float | None]:
    """One row with coefficients for a spectral radius in between, and that radius."""
    inputs = own.data["motion"]["inputs"]
    once = {
        name: {"at": 0} | {k: sweep[k] for k in ("rate", "acceleration")}
        for name, sweep in inputs.items()
    }
    own.data["motion"] = {"inputs": once}
    answers = Answers(own.smooth().data)
    if not own.frictions or answers.statuses[0] in LOST:
        return None, None
    constant = own.rubbing(1.0)
    row = rows(constant, answers)[0]
    if any(is_slow(row, name) for name in own.frictions):
        return None, None
    radius = row.friction().radius
    if not 1e-6 < radius < 1e6:
        return None, None
    wanted = random.Random(seed).uniform(low, high)
    return constant.rubbing(wanted / radius), wanted


if __name__ == "__main__":
    sys.exit(main())
