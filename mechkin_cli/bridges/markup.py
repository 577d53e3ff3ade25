"""XML as elements that know their lines, with limits that hostile files meet early.

Entities and document types are refused before anything of them is expanded.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Final
from xml.parsers import expat

import numpy as np

from mechkin_cli.bridges.parts import LARGEST, NUMBER, refuse
from mechkin_cli.diagnostics import Place
from mechkin_cli.reading import shortened
from mechkin_cli.record import NamedTuple

MOST_LEVELS: Final = 150
"""Elements inside one another."""

MOST_ELEMENTS: Final = 20_000
"""Elements of a file."""

LEAST_DIRECTION: Final = 1e-10
"""Length below which a vector has no direction."""


class Element(NamedTuple):
    """An element: its tag, attributes, children in order, and where it begins."""

    tag: str
    attributes: dict[str, str]
    children: list[Element]
    at: Place

    def all(self, *tags: str) -> Iterator[Element]:
        """The children of some tags."""
        return (child for child in self.children if child.tag in tags)

    def first(self, tag: str) -> Element | None:
        """The first child of a tag."""
        return next(self.all(tag), None)

    def text(self, name: str) -> str:
        """An attribute that is needed."""
        found = self.attributes.get(name, "").strip()
        if not found:
            hint = f'write {name}="..."'
            refuse("missing-attribute", f"<{self.tag}> needs {name}", self.at, hint)
        return found

    def numbers(self, name: str, counts: Iterable[int], default: str | None = None) -> Any:
        """An attribute of numbers as an array; None where it is left out without a default."""
        written = self.attributes.get(name, default)
        if written is None:
            return None
        words = written.split()
        allowed = tuple(counts)
        if len(words) not in allowed:
            expected = " or ".join(map(str, allowed))
            told = f"{name} of <{self.tag}> has {len(words)} numbers"
            refuse("wrong-count", told, self.at, f"write {expected} of them", shortened(written))
        values = []
        for word in words:
            value = float(word) if NUMBER.fullmatch(word) else float("nan")
            if not abs(value) <= LARGEST:
                told = f"{name} of <{self.tag}> is no finite number below {LARGEST:g}"
                refuse("not-a-number", told, self.at, "correct it", shortened(word))
            values.append(value)
        return np.array(values)

    def number(self, name: str, default: str | None = None) -> float | None:
        """An attribute that is one number."""
        found = self.numbers(name, (1,), default)
        return None if found is None else float(found[0])

    def direction(self, name: str, default: str | None = None) -> Any:
        """An attribute that is a direction, as a unit vector; None where it is left out."""
        found = self.numbers(name, (3,), default)
        if found is None:
            return None
        length = float(np.linalg.norm(found))
        if length < LEAST_DIRECTION:
            refuse("no-direction", f"{name} of <{self.tag}> is zero", self.at, "give a direction")
        return found / length


def read_markup(text: str, file: str) -> Element:
    """The root element of a text.

    Raises:
        InvalidFile: it is not well formed, beyond a limit, or has a document type.
    """
    reader = _Reader(file)
    try:
        reader.parser.Parse(text.encode("utf-8", "replace"), True)
    except expat.ExpatError as error:
        place = Place(file, error.lineno, error.offset + 1)
        words = expat.ErrorString(error.code) or "it is not well formed"
        refuse("not-xml", f"this is no XML: {words}", place, "correct it there, or just before")
    except ValueError as error:
        refuse("not-xml", f"this is no XML: {error}", Place(file, 1, 1), "save it as UTF-8")
    assert reader.root is not None
    return reader.root


class _Reader:
    def __init__(self, file: str) -> None:
        self.file = file
        self.root: Element | None = None
        self.stack: list[Element] = []
        self.count = 0
        # the encoding of a declaration is that of the file, which is decoded already
        self.parser = expat.ParserCreate("utf-8")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._doctype

    def _at(self) -> Place:
        parser = self.parser
        return Place(self.file, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)

    def _doctype(self, *_: object) -> None:
        hint = "delete it; robot files need none"
        refuse("doctype", "a document type or an entity is not read", self._at(), hint)

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        element = Element(tag, attributes, [], self._at())
        if self.count > MOST_ELEMENTS:
            told = f"{MOST_ELEMENTS} elements at most are read"
            refuse("too-many-elements", told, element.at, "leave out what is not needed")
        if len(self.stack) >= MOST_LEVELS:
            told = f"elements are nested deeper than {MOST_LEVELS} levels"
            refuse("too-deep", told, element.at, "write the model flatter")
        if self.stack:
            self.stack[-1].children.append(element)
        else:
            self.root = element
        self.stack.append(element)

    def _end(self, tag: str) -> None:
        self.stack.pop()


# Rotations and displacements, as matrices.


def pose(turn: Any, place: Any) -> Any:
    """A displacement (4, 4)."""
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = turn, place
    return found


def about(axis: Any, angle: float) -> Any:
    """The turn about a unit vector (Rodrigues)."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * (across @ across)


def from_quaternion(q: Any) -> Any:
    """The turn of a quaternion, scalar first, of any length but zero."""
    w, x, y, z = np.asarray(q) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
