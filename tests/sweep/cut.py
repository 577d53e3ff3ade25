"""Sweeps cut into small parts."""

from __future__ import annotations

import pytest

from mechkin_cli import tolerances
from mechkin_cli.building import spacing


def cut(monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    """Lets runs have parts of so many rows, and files make their numbers part by part."""
    monkeypatch.setattr(tolerances, "PART_ROWS", rows)
    monkeypatch.setattr(tolerances, "LEAST_PART_ROWS", rows)
    monkeypatch.setattr(tolerances, "WHOLE_PARTS", 1)
    monkeypatch.setattr(spacing, "LONG_RUN", rows + 1)
    # the first assembly is looked for among few of the rows, and next to the drawing
    monkeypatch.setattr(spacing, "SAMPLE", 3)
