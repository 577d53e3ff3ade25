"""Worst deviation of `Model.sensitivities` from derivatives of 40 digits, mechanism by mechanism.

`python -P tests/sensitivities/exact` takes every kept mechanism with a sweep, all its parameters
and as many of its numbers, drawn at random, made parameters, at `--rows` of its rows (4).
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from oracle import read
from sensitivities.exact.comparison import compare
from sensitivities.exact.files import NAMES, file, some_rows, spatial, with_parameters


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", help="stems of files; all")
    parser.add_argument("--rows", type=int, default=4)
    parser.add_argument("--numbers", type=int, default=4, help="numbers that become parameters")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    worst, bad = 0.0, 0
    print("mechanism parameters rows pairs worst where wrong-verdicts refused stuck seconds")
    for name in given.names or NAMES:
        began = time.perf_counter()
        data = file(name)
        own = list(data.get("parameters", {}))
        parameters = own + with_parameters(data, given.numbers, (name, given.seed))
        rows = some_rows(read(spatial(data)).rows, given.rows)
        found = compare(data, parameters, rows)
        at = max(found, key=lambda one: one.off)
        wrong = sum(len(one.wrong) for one in found)
        refused, stuck = (sum(getattr(one, k) for one in found) for k in ("refused", "stuck"))
        worst, bad = max(worst, at.off), bad + wrong
        seconds = time.perf_counter() - began
        print(
            f"{name} {len(parameters)} {len(rows)} {len(found)} {at.off:.1e} "
            f"{at.quantity}/{at.parameter} {wrong} {refused} {stuck} {seconds:.1f}",
            flush=True,
        )
        for one in [one for one in found if one.wrong or one.off > 1e-10][:6]:
            text = data["parameters"][one.parameter]
            print(f"    {one.quantity} by {one.parameter} = {text}: {one.off:.1e} {one.wrong}")
    print(f"worst {worst:.1e}, wrong verdicts {bad}")
    return int(worst > 1e-10 or bad > 0)


if __name__ == "__main__":
    sys.exit(main())
