"""A document from the plain data of a program: a mapping of texts, numbers, lists and mappings.

The data is written as text (JSON, which is YAML), so that nothing after the reader knows the
difference; but a message names the path of keys to a value instead of a line that nobody has seen.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Any

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place
from mechkin_cli.reading.document import Document, KeyPath, document_from_text, key_words
from mechkin_cli.reading.text import INVISIBLE, MOST_EVENTS, MOST_LEVELS, character_name
from mechkin_cli.record import replace


def document_from_data(data: Mapping[Any, Any], name: str, folder: Path | None) -> Document:
    """The document that data describes; `name` stands for the file in messages.

    Numbers are written with their shortest decimals, arrays and numbers of numpy as lists and
    numbers.

    Raises:
        InvalidFile: a value that no mechanism file can hold, with the path of keys to it.
    """
    plain = _DataReader(name).plain(data, ())
    document = document_from_text(json.dumps(plain, indent=1, ensure_ascii=False), name)
    return replace(document, folder=folder, is_data=True)


class _DataReader:
    """Turns values into texts, lists and mappings; `_above` are the containers of a value."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._above: list[int] = []
        self._count = 0

    def plain(self, value: Any, path: KeyPath) -> Any:
        self._count += 1
        if self._count > MOST_EVENTS:
            raise self._refused(path, f"more than {MOST_EVENTS} values", "keep tables in files")
        if not isinstance(value, str | Mapping | list | tuple | Real) and hasattr(value, "tolist"):
            value = value.tolist()
        if isinstance(value, Mapping | list | tuple):
            return self._container(value, path)
        return self._text(value, path)

    def _container(self, value: Any, path: KeyPath) -> Any:
        if id(value) in self._above:
            raise self._refused(path, "a value that holds itself", "write it out")
        if len(self._above) >= MOST_LEVELS:
            raise self._refused(path, f"nested deeper than {MOST_LEVELS} levels", "write it flat")
        self._above.append(id(value))
        try:
            if not isinstance(value, Mapping):
                return [self.plain(item, (*path, i)) for i, item in enumerate(value)]
            return {self._key(key, path): self.plain(value[key], (*path, key)) for key in value}
        finally:
            self._above.pop()

    def _key(self, key: Any, path: KeyPath) -> str:
        if not isinstance(key, str):
            what = f"a key that is not a text ({type(key).__name__})"
            raise self._refused(path, what, "keys are names such as joints")
        return self._checked(key, path)

    def _text(self, value: Any, path: KeyPath) -> str:
        if isinstance(value, str):
            return self._checked(value, path)
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, Integral):
            return str(int(value))
        if isinstance(value, Real):
            number = float(value)
            if isfinite(number):
                return repr(number)
            raise self._refused(path, f"the number {number}", "write a finite number")
        what = "no value (None)" if value is None else f"a {type(value).__name__}"
        hint = "leave the key out" if value is None else "write a text, a number, a list or a dict"
        raise self._refused(path, what, hint)

    def _checked(self, text: str, path: KeyPath) -> str:
        if found := INVISIBLE.search(text):
            raise self._refused(path, f"{character_name(found[0])} in a text", "delete it")
        return text

    def _refused(self, path: KeyPath, what: str, hint: str) -> InvalidFile:
        place = Place(f"{self._name} at {key_words(path)}", 0, 1)
        return InvalidFile([Diagnostic("bad-value", "error", what, place, hint=hint)])
