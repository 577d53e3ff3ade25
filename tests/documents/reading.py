"""The pages as texts, and their blocks of code."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]


def page(name: str) -> str:
    """A page by its path from the root: `docs/verdicts.md`."""
    return (ROOT / name).read_text(encoding="utf-8")


def blocks(text: str, language: str) -> list[str]:
    """The fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def ran(code: str, name: str) -> Any:
    """What a block of Python calls by a name, after it ran."""
    names: dict[str, Any] = {}
    exec(code, names)
    return names[name]
