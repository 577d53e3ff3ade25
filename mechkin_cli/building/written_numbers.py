"""Numbers in the text of a file without parameters that a page changes as it changes parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from mechkin_cli.expressions import literal
from mechkin_cli.reading import Document, KeyPath, value_spans
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import FORCE, LENGTH, MASS, STIFFNESS

if TYPE_CHECKING:
    from mechkin_cli.units import Dimension

_AXES = "xyz"

_OF_SPRINGS = {"stiffness": STIFFNESS, "free": LENGTH, "preload": FORCE}


class FileNumber(NamedTuple):
    """A number of a file: its path there, what it is told as, its text and its dimension."""

    path: KeyPath
    name: str
    text: str
    dimension: Dimension

    @property
    def value(self) -> float:
        """As written, in the file's unit."""
        value = literal(self.text)
        assert value is not None
        return value

    @property
    def is_place(self) -> bool:
        """Whether it is a component of a place."""
        return isinstance(self.path[-1], int)


def file_numbers(document: Document) -> Iterator[FileNumber]:
    """The numbers of a file that are written without unit or expression: places of joints and
    points, masses, and what springs between points are."""
    data: Any = document.data
    spans = value_spans(document.text)
    for path, dimension in _paths(data):
        text = spans[path].text if path in spans else ""
        if literal(text) is not None:
            *way, last = path
            steps = [*way, _AXES[last] if isinstance(last, int) else last]
            yield FileNumber(path, ".".join(map(str, steps)), text, dimension)


def _paths(data: Mapping[str, Any]) -> Iterator[tuple[KeyPath, Dimension]]:
    for name, joint in _entries(data, "joints"):
        point = joint.get("point")
        places = point.items() if isinstance(point, dict) else [(None, point)]
        for link, place in places:
            path = ("joints", name, "point") if link is None else ("joints", name, "point", link)
            yield from _components(path, place)
    for name, point in _entries(data, "points"):
        yield from _components(("points", name, "at"), point.get("at"))
    for name, _ in _entries(data, "links"):
        yield ("links", name, "mass"), MASS
    loads = data.get("loads")
    for at, load in enumerate(loads if isinstance(loads, list) else ()):
        if isinstance(load, dict) and load.get("type") == "spring" and "between" in load:
            for key, dimension in _OF_SPRINGS.items():
                yield ("loads", at, key), dimension


def _entries(data: Mapping[str, Any], section: str) -> Iterator[tuple[str, dict[str, Any]]]:
    entries = data.get(section)
    for name, entry in entries.items() if isinstance(entries, dict) else ():
        if isinstance(entry, dict):
            yield name, entry


def _components(path: KeyPath, place: Any) -> Iterator[tuple[KeyPath, Dimension]]:
    for k in range(len(place)) if isinstance(place, list) else ():
        yield (*path, k), LENGTH
