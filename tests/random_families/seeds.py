"""The command of a random family: judges seeds, shows what is at fault, closes with a count."""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol


class Verdict(Protocol):
    """What a family says of one seed."""

    @property
    def fault(self) -> str:
        """What is wrong, empty where nothing is."""

    @property
    def text(self) -> str:
        """The mechanism file."""

    @property
    def figures(self) -> Mapping[str, float]:
        """Largest errors, by what they are errors of."""

    @property
    def remark(self) -> str:
        """What is counted beside faults, or empty."""


def judge_seeds(family: str, doc: str | None, judge: Callable[[int], Verdict], default: str) -> int:
    """Runs a family's command.

    Args:
        family: what the files at fault are called.
        doc: of the command, its first line is the help.
        judge: the verdict on a seed; a function of a module where processes are asked for.
        default: seeds, `first:last`.

    Returns:
        Exit code: 1 where something is wrong.
    """
    options = _parser(doc, default).parse_args()
    first, last = map(int, options.seeds.split(":"))
    start, faults = time.monotonic(), 0
    worst: dict[str, float] = {}
    remarks: Counter[str] = Counter()
    with multiprocessing.Pool(options.processes) as pool:
        seeds = range(first, last)
        for seed, found in zip(seeds, pool.imap(judge, seeds), strict=True):
            if options.verbose or found.fault:
                figures = "  ".join(f"{name} {x:.1e}" for name, x in found.figures.items())
                print(f"{seed:6d}  {figures}  {found.remark}  {found.fault}", flush=True)
            if found.fault:
                faults += 1
                _save(options.save, f"{family}_{seed}.yaml", found)
                continue
            remarks[found.remark] += bool(found.remark)
            for name, x in found.figures.items():
                worst[name] = max(worst.get(name, 0.0), x)
    counted = "".join(f", {n} {remark}" for remark, n in sorted(remarks.items()) if remark)
    within = ", ".join(f"{x:.1e} in {name}" for name, x in worst.items())
    print(
        f"{last - first} mechanisms{counted}, {faults} at fault; the others within {within};"
        f" {time.monotonic() - start:.0f} s"
    )
    return 1 if faults else 0


def _parser(doc: str | None, default: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=(doc or "").split("\n")[0])
    parser.add_argument("--seeds", default=default, help="first:last, the last is left out")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--save", type=Path, help="folder for the files at fault")
    parser.add_argument("--verbose", action="store_true", help="a line for every seed")
    return parser


def _save(folder: Path | None, name: str, found: Verdict) -> None:
    if folder is None:
        print(found.text, file=sys.stderr)
        return
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(f"# {found.fault}\n{found.text}", encoding="utf-8")
