"""Options of `python -m benchmarks --stress`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

MOST_ROWS = 10**9
MOST_SEED = 2**63 - 1
MOST_NUMBER = 10**9
MOST_PROCESSES = 256

Stress = Annotated[
    bool, typer.Option("--stress", help="Hard mechanisms by the thousand instead of run times.")
]
Rows = Annotated[
    float,
    typer.Option("--rows", min=1, max=MOST_ROWS, help="--stress: rows in all, as 1e6."),
]
Seed = Annotated[
    int,
    typer.Option("--seed", min=0, max=MOST_SEED, help="--stress: seed of the random mechanisms."),
]
Family = Annotated[
    str | None, typer.Option("--family", metavar="NAME", help="--stress: one family alone.")
]
Only = Annotated[
    int | None,
    typer.Option(
        "--only",
        min=0,
        max=MOST_NUMBER,
        metavar="K",
        help="--stress: print mechanism K of the family as a file, and run nothing.",
    ),
]
Page = Annotated[
    Path | None, typer.Option("--page", metavar="FILE", help="--stress: also write a page.")
]
Check = Annotated[
    bool,
    typer.Option("--check", help="--stress: run the small set anew and compare it with the page."),
]
Processes = Annotated[
    int,
    typer.Option(
        "--processes", min=0, max=MOST_PROCESSES, help="--stress: processes at once; 0: all cores."
    ),
]
Small = Annotated[
    Path | None,
    typer.Option(
        "--small",
        metavar="FILE",
        help="--stress: write the set of `mechkin bench --stress`, and run nothing.",
    ),
]
