"""One mechanism file as plain data, and the place in its text of every value and character.

A path leads into the file from the top, by keys and by the numbers of list items from 0:
`("tables", 0, "columns", 2, "value")`.

The place of a character of a scalar is found behind quotes, escapes and folds. In plain and block
style only white space is folded, so the n-th visible character of the text is the n-th visible
character of the source. In quoted style an escape sequence stands for one character.
"""

from __future__ import annotations

import collections.abc
import json
import re
from collections.abc import Iterator
from functools import cached_property
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Any, TypeAlias

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError, nearest
from mechkin_cli.reading.text import (
    INVISIBLE,
    MOST_EVENTS,
    MOST_LEVELS,
    character_name,
    check_size,
    lines_of,
    read_text,
)
from mechkin_cli.reading.yaml import (
    Entry,
    Mapping,
    Mark,
    Node,
    PlainData,
    ScalarNode,
    Sequence,
    Style,
    parse,
    plain_data,
)
from mechkin_cli.record import dataclass, field, replace

KeyPath: TypeAlias = tuple[str | int, ...]

_PARAMETERS = "parameters"


@dataclass(frozen=True)
class Document:
    """A mechanism file as written.

    `file` is the name that messages show, `text` the source, `root` the top-level mapping;
    `overrides` holds the parameters set from outside, by name; `folder` is that of the files it
    names, None for a text that does not come from a file. With `is_data` the text was made from a
    program's data, and places are paths of keys. `tables` are the contents of files that it names,
    by name, as they were when they were first read, so that building a document again, here or in
    another process, builds the same.
    """

    file: str
    text: str
    root: Mapping
    overrides: dict[str, str] = field(default_factory=dict)
    folder: Path | None = None
    is_data: bool = False
    tables: dict[str, bytes] = field(default_factory=dict)

    @property
    def files(self) -> tuple[Path, ...]:
        """The file itself and those of the tables read so far; none for a text or for data."""
        if self.folder is None:
            return ()
        return (Path(self.file), *(self.folder / name for name in self.tables))

    @cached_property
    def data(self) -> dict[str, PlainData]:
        """The file as dict, list and str, with the overrides in place."""
        data = {key: plain_data(entry.value) for key, entry in self.root.entries.items()}
        parameters = data.get(_PARAMETERS)
        if isinstance(parameters, dict):
            data[_PARAMETERS] = parameters | self.overrides
        return data

    def node(self, path: KeyPath) -> Node | None:
        """The node at a path, None where there is nothing; overrides count."""
        entry, depth = self._reach(path)
        return entry.value if depth == len(path) else None

    def place(self, path: KeyPath) -> Place:
        """Where the value at a path stands; for a missing one, its nearest ancestor that exists."""
        if override := self._override(path):
            return self._outside(override, 0)
        entry, depth = self._reach(path)
        return self._at(path[:depth], entry.value.mark)

    def key_place(self, path: KeyPath) -> Place:
        """Where the key at a path stands (of a list item, the item); missing keys as in `place`."""
        entry, depth = self._reach(path)
        return self._at(path, entry.mark) if depth == len(path) else self.place(path)

    def place_in(self, path: KeyPath, offset: int) -> Place:
        """Where the character `offset` (from 0) of the scalar at a path, or at its nearest ancestor
        that exists, stands in the source."""
        if override := self._override(path):
            return self._outside(override, offset)
        # a number that stands for several has one text
        node = self._reach(path)[0].value
        if not isinstance(node, ScalarNode):
            return self.place(path)
        if self.is_data:
            return self.place(path)._replace(column=offset + 1)
        return Place(self.file, *source_mark(node, offset, self._lines))

    def with_parameters(self, parameters: collections.abc.Mapping[str, str]) -> Document:
        """The document with other values for some of its `parameters`.

        Raises `UsageError` for a name that the file does not define.
        """
        entry = self.root.entries.get(_PARAMETERS)
        defined = entry.value.entries if entry and isinstance(entry.value, Mapping) else {}
        for name, value in parameters.items():
            if name not in defined:
                raise UsageError(_unknown_parameter(name, list(defined), self.file))
            if not value.strip():
                raise UsageError(f"--set {name}: the value is empty; write --set {name}=0.6in")
        return replace(self, overrides=self.overrides | dict(parameters))

    @cached_property
    def _lines(self) -> list[str]:
        return lines_of(self.text)

    def _reach(self, path: KeyPath) -> tuple[Entry, int]:
        """The last entry on the path that exists, and the number of steps that lead to it."""
        entry = Entry(self.root.mark, self.root)
        for depth, step in enumerate(path):
            child = _child(entry.value, step)
            if child is None:
                return entry, depth
            entry = child
        if override := self._override(path):
            text = self.overrides[override]
            entry = Entry(entry.mark, ScalarNode(text, entry.value.mark, Style.PLAIN))
        return entry, len(path)

    def _at(self, path: KeyPath, mark: Mark) -> Place:
        if self.is_data:
            return Place(f"{self.file} at {key_words(path)}", 0, 1)
        return Place(self.file, *mark)

    def _override(self, path: KeyPath) -> str | None:
        if len(path) == 2 and path[0] == _PARAMETERS and path[1] in self.overrides:
            return str(path[1])
        return None

    def _outside(self, name: str, offset: int) -> Place:
        return Place(f"--set {name}", 0, offset + 1)


def read_document(path: str | Path) -> Document:
    """The document in a file.

    Raises `UsageError` where there is no file to read, `InvalidFile` where it is not the YAML of a
    mechanism file.
    """
    return replace(document_from_text(read_text(path), str(path)), folder=Path(path).parent)


def document_from_text(text: str, name: str) -> Document:
    """The document in a text; `name` stands for the file in messages. Raises `InvalidFile`."""
    check_size(len(text.encode("utf-8", "surrogatepass")), name)
    text = text.removeprefix("\ufeff")
    return Document(name, text, parse(text, name))


def key_words(path: KeyPath) -> str:
    """A path of keys as messages show it.

    >>> key_words(("joints", "A", "point", 2)), key_words(())
    ('joints.A.point[2]', 'the top')
    """
    words = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)
    return words.removeprefix(".") or "the top"


def _child(node: Node, step: str | int) -> Entry | None:
    if isinstance(node, Mapping) and isinstance(step, str):
        return node.entries.get(step)
    if isinstance(node, Sequence) and isinstance(step, int) and 0 <= step < len(node.items):
        return Entry(node.items[step].mark, node.items[step])
    return None


def _unknown_parameter(name: str, defined: list[str], file: str) -> str:
    message = f"--set {name}: {file} defines no parameter {name!r}"
    if close := nearest(name, defined):
        return f"{message}; did you mean {close}?"
    if not defined:
        return f"{message}; it has no parameters: section"
    return f"{message}; it has {', '.join(defined[:10])}{', ...' if len(defined) > 10 else ''}"


_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|.|$)")

_ESCAPES_OF_BLANKS = ("", *" \tntrvfNLP_")


def source_mark(scalar: ScalarNode, offset: int, lines: list[str]) -> Mark:
    """The position of `scalar.text[offset]`, given the source `lines`.

    An offset behind the last character gives the place just behind it.

    >>> source_mark(ScalarNode("a''b", Mark(1, 4), Style.DOUBLE_QUOTED), 3, ["x: \\"a''b\\""])
    Mark(line=1, column=8)
    """
    visible_before = sum(not character.isspace() for character in scalar.text[:offset])
    if visible_before == 0 and scalar.style is Style.PLAIN:
        return scalar.mark
    at_blank = offset >= len(scalar.text) or scalar.text[offset].isspace()
    position = scalar.mark
    for seen, (mark, width) in enumerate(_visible(scalar, lines)):
        if at_blank and seen + 1 == visible_before:
            before = scalar.text[:offset]
            blanks = len(before) - len(before.rstrip())
            return Mark(mark.line, mark.column + width + blanks)
        if not at_blank and seen == visible_before:
            return mark
        position = mark
    return position


def _visible(scalar: ScalarNode, lines: list[str]) -> Iterator[tuple[Mark, int]]:
    """Mark and width of the source of each visible character, from the scalar's start on."""
    line, column = scalar.mark
    if scalar.style is Style.BLOCK:
        line, column = line + 1, 1
    elif scalar.style is not Style.PLAIN:
        column += 1
    for number in range(line, len(lines) + 1):
        source = lines[number - 1]
        index = column - 1 if number == line else 0
        while index < len(source):
            width = _width(source, index, scalar.style)
            if _is_visible(source, index, scalar.style):
                yield Mark(number, index + 1), width
            index += width


def _is_visible(source: str, index: int, style: Style) -> bool:
    if style is Style.DOUBLE_QUOTED and source[index] == "\\":
        return source[index + 1 : index + 2] not in _ESCAPES_OF_BLANKS
    return not source[index].isspace()


def _width(source: str, index: int, style: Style) -> int:
    if style is Style.DOUBLE_QUOTED and source[index] == "\\":
        escape = _ESCAPE.match(source, index)
        return len(escape[0]) if escape else 1
    if style is Style.SINGLE_QUOTED and source.startswith("''", index):
        return 2
    return 1


# Plain data of a program: a mapping of texts, numbers, lists and mappings. It is written as text
# (JSON, which is YAML), so that nothing after the reader knows the difference; but a message names
# the path of keys to a value instead of a line that nobody has seen.


def document_from_data(
    data: collections.abc.Mapping[Any, Any], name: str, folder: Path | None
) -> Document:
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
        if not isinstance(value, str | collections.abc.Mapping | list | tuple | Real) and hasattr(
            value, "tolist"
        ):
            value = value.tolist()
        if isinstance(value, collections.abc.Mapping | list | tuple):
            return self._container(value, path)
        return self._text(value, path)

    def _container(self, value: Any, path: KeyPath) -> Any:
        if id(value) in self._above:
            raise self._refused(path, "a value that holds itself", "write it out")
        if len(self._above) >= MOST_LEVELS:
            raise self._refused(path, f"nested deeper than {MOST_LEVELS} levels", "write it flat")
        self._above.append(id(value))
        try:
            if not isinstance(value, collections.abc.Mapping):
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
