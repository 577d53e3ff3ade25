"""`mechkin bench --stress`: families of hard mechanisms, every row decided by a closed form."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import put, put_json, say
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.nearest import did_you_mean

if TYPE_CHECKING:
    from mechkin_cli.benchmark.stress.tally import Tally

MOST_ROWS = 10**9
MOST_SEED = 2**63


class Stress(NamedTuple):
    """What the command line asks for."""

    rows: int
    seed: int
    family: str | None
    only: int | None
    page: Path | None
    check: bool
    processes: int
    json: bool


def stress_command(asked: Stress, show: Callable[[object], None]) -> int:
    """Runs it; `show` prints tables. Exit code 1 where a row is wrong and says ok, or the page is
    not current."""
    from mechkin_cli.benchmark.stress.families.table import FAMILIES

    names = list(FAMILIES)
    if asked.family is not None:
        if asked.family not in FAMILIES:
            raise UsageError(f"there is no family {asked.family}{did_you_mean(asked.family, names)}")
        names = [asked.family]
    if asked.only is not None:
        return _one(names, asked)
    if asked.check:
        return _checked(asked)
    tallies = _run(asked.rows, asked.seed, names, asked)
    _told(tallies, asked, show)
    return ExitCode.DIFFERENCES if any(t.verdicts["false_ok"] for t in tallies) else 0
