"""Published and exact values of mechanisms, from `tests/reference`.

`exact/rcsr.csv`: 17 significant digits computed at 40; angles in degrees, rates in rad/s, lengths
in in, forces in lbm in/s^2, moments in lbm in^2/s^2 about the ground origin. Columns `ne_*` are
Newton-Euler; `author_*` follow the inertia couples of the dissertation, which are wrong but
reproduce its print. Other files of `exact/` have kinematics only, angles in degrees; how their
branches are chosen is said where they are used. `raised/` has the kinematics of these tables, and
reactions of the RCSR, at 60 digits (`python -P tests/errors/raised`). Cells as printed stand
beside the mechanisms, in `mechanisms/*/*/published/*.csv`.
"""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent / "reference"
MECHANISMS = Path(__file__).parent.parent / "mechanisms"
FILE_OF = {path.stem: path for path in sorted(MECHANISMS.glob("*/*.yaml"), key=lambda p: p.name)}
"""The kept mechanisms by the stems of their names, whatever folder they lie in."""

RCSR = FILE_OF["rcsr"]
SWEPT = [path for path in FILE_OF.values() if "\nmotion:\n" in path.read_text(encoding="utf-8")]
"""Mechanism files that have a sweep; others have responses alone."""


@cache
def exact(name: str) -> dict[str, list[str]]:
    """The columns of `exact/<name>.csv` by header, as text."""
    return _columns(FOLDER / "exact" / f"{name}.csv")


@cache
def published(name: str) -> dict[str, list[str]]:
    """The columns of `published/<name>.csv` by header, as printed."""
    (path,) = MECHANISMS.glob(f"*/*/published/{name}.csv")
    return _columns(path)


def committed(stem: str, table: str) -> list[dict[str, str]]:
    """The rows of a table kept beside its mechanism, by label."""
    with (FILE_OF[stem].with_suffix("") / f"{table}.csv").open(
        newline="", encoding="utf-8"
    ) as file:
        return list(csv.DictReader(file))


def published_names() -> list[str]:
    return sorted(path.stem for path in MECHANISMS.glob("*/*/published/*.csv"))


def _columns(path: Path) -> dict[str, list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return {name: list(cells) for name, cells in zip(header, zip(*rows, strict=True), strict=True)}
