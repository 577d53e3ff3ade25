"""What must hold for any text that is run: an answer, or a refusal that has a place.

`python -P tests/fuzz/answers.py --seeds 0:1000 [--save FOLDER]` damages files with responses,
friction, actuators and balances; exit code 1 at a defect.
"""

from __future__ import annotations

import argparse
import multiprocessing
import random
import re
import sys
import time
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz.damage import damaged
from fuzz.verdict import FILE, check

import mechkin_cli as mk
from mechkin_cli.schema.json_schema import json_schema_text

FORCES = tuple(
    path.read_text(encoding="utf-8") for path in sorted(Path(__file__).parent.glob("forces/*.yaml"))
)
WORDS = tuple(sorted(set(re.findall(r"[a-z][a-z_0-9]+", json_schema_text()))))
MOST_SECONDS = 120.0
"""Of one file: the longest search for assemblies, of a point 1e9 mm away, takes a minute."""


def answer(text: str) -> str:
    """Reads, builds and runs a file: 'answered' or the code of the first refusal.

    Whatever else is raised is a defect, as is an error without a place.
    """
    try:
        model = mk.loads(text, FILE)
        for run in model.runs:
            result = model.analyze() if run == "sweep" else model.respond(run)
            _ = [str(diagnostic).encode() for diagnostic in result.diagnostics]
        return "answered"
    except mk.InvalidFile as invalid:
        for diagnostic in invalid.diagnostics:
            check(diagnostic, text.encode())
        return invalid.diagnostics[0].code


def seeded(seed: int) -> str:
    """The damaged text of a seed."""
    dice = random.Random(seed)
    return damaged(dice.choice(FORCES), WORDS, dice)


def run_one(seed: int) -> tuple[int, str, str]:
    """Seed, what came out, and the traceback of a defect."""
    start = time.process_time()
    try:
        found, fault = answer(seeded(seed)), ""
    except Exception:
        found, fault = "defect", traceback.format_exc()
    seconds = time.process_time() - start
    if seconds > MOST_SECONDS:
        found, fault = "defect", f"{seconds:.0f} s"
    return seed, found, fault


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--seeds", default="0:1000", help="first:last, the last is left out")
    parser.add_argument("--save", type=Path, help="folder for the files at fault")
    options = parser.parse_args()
    first, last = map(int, options.seeds.split(":"))
    counts: dict[str, int] = {}
    with multiprocessing.Pool(1, maxtasksperchild=200) as pool:
        for seed in range(first, last):
            waiting = pool.apply_async(run_one, (seed,))
            try:
                _, found, fault = waiting.get(timeout=5 * MOST_SECONDS)
            except multiprocessing.TimeoutError:
                print(f"{seed}: hangs", flush=True)
                pool.terminate()
                return 1
            counts[found] = counts.get(found, 0) + 1
            if fault:
                print(f"{seed}: {fault}", flush=True)
                if options.save:
                    options.save.mkdir(parents=True, exist_ok=True)
                    (options.save / f"answer_{seed}.yaml").write_text(seeded(seed))
    print(dict(sorted(counts.items(), key=lambda item: -item[1])))
    return 1 if counts.get("defect") else 0


if __name__ == "__main__":
    sys.exit(main())
