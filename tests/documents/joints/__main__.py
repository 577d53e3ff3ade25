"""Writes `docs/joints/LETTER.svg`, a drawing of each pair; with `--check` compares them."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from documents.joints.pairs import PAIRS
from made_page import write_or_check

FOLDER = Path(__file__).parents[3] / "docs" / "joints"

if __name__ == "__main__":
    codes = [
        write_or_check(FOLDER / f"{letter}.svg", drawn().svg(name))
        for letter, (name, drawn) in PAIRS.items()
    ]
    sys.exit(max(codes))
