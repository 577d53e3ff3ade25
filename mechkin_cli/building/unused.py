"""Notes parameters that nothing in the file uses: one that is misspelt where it was meant, or a
remainder.

Names are looked for in all texts of the file but those for people, so that no form of a section has
to be known here: a name that stands anywhere an expression might stand counts as used.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Final

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Diagnostic

_NAME: Final = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_FOR_PEOPLE: Final = ("name", "title", "source", "label", "text")
_OF_NAMES: Final = ("parameters", "quantities")
"""Sections whose keys are names that the file chooses."""


def note_unused(fields: Fields) -> None:
    """A note at every parameter that no expression uses, and at those that only such ones use."""
    # as written: a value from outside that names nothing makes nothing superfluous
    document = fields.document
    data = (replace(document, overrides={}) if document.overrides else document).data
    section = data.get("parameters")
    if not isinstance(section, dict) or not section:
        return
    users: dict[str, list[str]] = {name: [] for name in section}
    for user, text in section.items():
        for used in set(_NAME.findall(str(text))) & section.keys():
            users[used].append(user)
    unused = set(section)
    front: set[str] = set()
    for text in _texts({key: value for key, value in data.items() if key != "parameters"}):
        front |= unused & set(_NAME.findall(text))
        unused -= front
        if not unused:
            return
    while front:
        unused -= front
        front = {name for name in unused if not unused.issuperset(users[name])}
    for name in section:
        if name in unused:
            _note(fields, name, users[name])


def _note(fields: Fields, name: str, users: list[str]) -> None:
    but = f" but {', '.join(users)}, which nothing uses" if users else ""
    place = fields.document.key_place(("parameters", name))
    text = f"nothing uses the parameter {name}{but}"
    hint = "remove it, or use it where it was meant"
    fields.note(Diagnostic("unused-parameter", "note", text, place, hint=hint))


def _texts(data: Any, key: str = "") -> Iterator[str]:
    """All texts below a part of the file in which an expression might stand."""
    if isinstance(data, dict):
        for inner, value in data.items():
            is_prose = inner in _FOR_PEOPLE and key not in _OF_NAMES
            if not (is_prose and isinstance(value, str)):
                yield from _texts(value, inner)
    elif isinstance(data, (list, tuple)):
        for value in data:
            yield from _texts(value, key)
    elif isinstance(data, str):
        yield data
