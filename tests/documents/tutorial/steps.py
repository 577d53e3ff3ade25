"""The tutorial as steps: files that its reader writes, and commands with what they print."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

PAGE = Path(__file__).parents[3] / "docs" / "tutorial.md"
_FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_SECTION = re.compile(r"^(\w+):.*?(?=^\w|\Z)", re.MULTILINE | re.DOTALL)


class Step(NamedTuple):
    """A block of commands with the text shown below it, "" where none is."""

    commands: str
    shown: str


class Written(NamedTuple):
    """A file as it is after the reader has written it."""

    name: str
    text: str


def steps() -> list[Step | Written]:
    """What a reader of the page does, in order."""
    found: list[Step | Written] = []
    whole = ""
    for language, text in _FENCE.findall(PAGE.read_text(encoding="utf-8")):
        if language == "sh":
            found.append(Step(text, ""))
        elif language == "text":
            last = found[-1]
            assert isinstance(last, Step), "what a command prints stands behind it"
            found[-1] = last._replace(shown=text)
        elif text.startswith("study:"):
            found.append(Written("made.yaml", text))
        else:
            whole = replaced(whole, text)
            found.append(Written("pump.yaml", whole))
    return found


def replaced(whole: str, sections: str) -> str:
    """A file in which sections stand for those of their name, and others behind all."""
    for section in _SECTION.finditer(sections):
        name, text = section[1], section[0].rstrip() + "\n"
        old = next((one for one in _SECTION.finditer(whole) if one[1] == name), None)
        whole = whole + text if old is None else whole[: old.start()] + text + whole[old.end() :]
    return whole
