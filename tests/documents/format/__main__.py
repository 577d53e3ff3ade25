"""Writes `docs/format.md` from the JSON Schemas; with `--check` compares it."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from documents.format.page import PAGE, page
from made_page import write_or_check

if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page()))
