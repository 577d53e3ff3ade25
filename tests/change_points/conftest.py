"""Tests named in `not_yet.txt` fail strictly: one that passes must leave the list."""

from __future__ import annotations

from pathlib import Path

import pytest

HERE = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    listed = HERE / "not_yet.txt"
    names = set(listed.read_text(encoding="utf-8").splitlines()) if listed.exists() else set()
    for item in items:
        if item.path.parent == HERE and f"{item.path.stem}::{item.name}" in names:
            item.add_marker(pytest.mark.xfail(strict=True, reason="not right yet"))
