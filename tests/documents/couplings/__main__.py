"""Writes `docs/couplings/NAME.svg`, a picture of each coupling; with `--check` compares them."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from documents.couplings.pictures import PICTURES, picture
from made_page import write_or_check

FOLDER = Path(__file__).parents[3] / "docs" / "couplings"

if __name__ == "__main__":
    sys.exit(max(write_or_check(FOLDER / f"{name}.svg", picture(name)) for name in PICTURES))
