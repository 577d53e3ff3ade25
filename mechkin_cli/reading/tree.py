"""From YAML events to nodes, with every problem that is not a matter of YAML's grammar.

A stack holds the lists and mappings that are still open; their children are gathered in one flat
list (key, value, key, value for a mapping) and judged when the collection closes. No recursion, so
that deep nesting ends in a message and not in a full stack.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from yaml import events

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.reading.commas import (
    cut_at_comma,
    is_cut_off,
    is_empty,
    pieces_of_mapping,
    pieces_of_sequence,
)
from mechkin_cli.reading.limits import MOST_LEVELS
from mechkin_cli.reading.nodes import Entry, Mapping, Mark, Node, Scalar, Sequence, Style
from mechkin_cli.reading.text import INVISIBLE, character_name

_STYLES = {"'": Style.SINGLE_QUOTED, '"': Style.DOUBLE_QUOTED, "|": Style.BLOCK, ">": Style.BLOCK}


class TooDeepError(Exception):
    """Raised when the nesting exceeds `MOST_LEVELS`; the diagnostic is already noted."""


@dataclass(slots=True)
class _Open:
    mark: Mark
    is_mapping: bool
    children: list[Node] = field(default_factory=list)


class TreeBuilder:
    """Takes the events of one document in order; afterwards `root` is its node.

    `diagnostics` holds what was wrong; the tree is meant to be used only where it stayed empty.
    """

    def __init__(self, lines: list[str], file: str) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.root: Node | None = None
        self._lines = lines
        self._file = file
        self._stack: list[_Open] = []
        self._last: Node | None = None

    def take(self, event: events.Event) -> None:
        """Add one scalar, alias, or the start or end of a list or mapping."""
        if isinstance(event, events.ScalarEvent):
            has_properties = self._check_properties(event)
            self._check_escapes(event)
            style = _STYLES.get(event.style or "", Style.PLAIN)
            if has_properties and not event.value:
                style = Style.SINGLE_QUOTED  # one message about this scalar is enough
            self._add(Scalar(event.value, mark_of(event), style))
        elif isinstance(event, (events.SequenceStartEvent, events.MappingStartEvent)):
            self._check_properties(event)
            self._open(mark_of(event), isinstance(event, events.MappingStartEvent))
        elif isinstance(event, (events.SequenceEndEvent, events.MappingEndEvent)):
            self._add(self._close(self._stack.pop()))
        elif isinstance(event, events.AliasEvent):
            hint = (
                "write the value out, or use a parameter; put a text that starts with * in quotes"
            )
            self._report("alias", "aliases (*) are not used here", mark_of(event), hint)
            self._add(Scalar(f"*{event.anchor}", mark_of(event), Style.SINGLE_QUOTED))

    def cut_off_value(self) -> Diagnostic | None:
        """The message for the scalar taken last, if it was cut off inside its parentheses."""
        if isinstance(self._last, Scalar) and is_cut_off(self._last):
            return self._cut_at_comma(self._last)
        return None

    def _open(self, mark: Mark, is_mapping: bool) -> None:
        if len(self._stack) >= MOST_LEVELS:
            self._report(
                "too-deep",
                f"lists and mappings lie more than {MOST_LEVELS} deep inside one another",
                mark,
                "format 1 needs no such depth; check the brackets",
            )
            raise TooDeepError
        self._stack.append(_Open(mark, is_mapping))

    def _add(self, node: Node) -> None:
        self._last = node
        if self._stack:
            self._stack[-1].children.append(node)
        else:
            self.root = node

    def _close(self, collection: _Open) -> Node:
        if collection.is_mapping:
            return self._mapping(collection)
        return self._sequence(collection)

    def _sequence(self, collection: _Open) -> Sequence:
        items = collection.children
        index = 0
        while index < len(items):
            item = items[index]
            if is_empty(item):
                # the parsers disagree on where nothing stands, but not on where the list starts
                hint = "write a value or remove the item"
                message = f"item {index + 1} of this list is empty"
                self._report("empty-value", message, collection.mark, hint)
            elif isinstance(item, Scalar) and is_cut_off(item):
                pieces = pieces_of_sequence(items, index)
                if pieces:
                    self.diagnostics.append(self._cut_at_comma(item))
                index += pieces
            index += 1
        return Sequence(tuple(items), collection.mark)

    def _mapping(self, collection: _Open) -> Mapping:
        children = collection.children
        pairs = list(zip(children[::2], children[1::2], strict=True))
        entries: dict[str, Entry] = {}
        index = 0
        while index < len(pairs):
            key, value = pairs[index]
            pieces = 0
            if isinstance(value, Scalar) and is_cut_off(value):
                pieces = pieces_of_mapping(pairs, index)
                if pieces:
                    self.diagnostics.append(self._cut_at_comma(value))
            if self._accepts_key(key, entries) and isinstance(key, Scalar):
                if is_empty(value):
                    self._report_empty(key)
                entries[key.text] = Entry(key.mark, value)
            index += 1 + pieces
        return Mapping(entries, collection.mark)

    def _accepts_key(self, key: Node, entries: dict[str, Entry]) -> bool:
        if not isinstance(key, Scalar):
            hint = "write key: value; put an expression with brackets in quotes"
            self._report("bad-key", "a list or mapping cannot be a key", key.mark, hint)
        elif key.text == "" and key.style is Style.PLAIN:
            self._report("bad-key", "a key is missing before the ':'", key.mark, "write key: value")
        elif key.text == "<<" and key.style is Style.PLAIN:
            hint = "write the keys out"
            self._report("merge-key", "merge keys (<<) are not used here", key.mark, hint)
        elif key.text in entries:
            message = f"the key {_quoted(key.text)} is written twice in one mapping"
            first = entries[key.text].mark
            hint = f"keep one of them; the first is at line {first.line}, column {first.column}"
            self._report("duplicate-key", message, key.mark, hint)
        else:
            return True
        return False

    def _report_empty(self, key: Scalar) -> None:
        name, colon, rest = key.text.partition(":")
        if key.style is Style.PLAIN and colon and rest:
            hint = f"write a blank after the colon: {name}: {rest}"
        else:
            hint = "write a value, {} for an empty mapping, or remove the key"
        message = f"the key {_quoted(key.text)} has no value"
        self._report("empty-value", message, key.mark, hint)

    def _check_properties(
        self, event: events.ScalarEvent | events.SequenceStartEvent | events.MappingStartEvent
    ) -> bool:
        if event.anchor is not None:
            hint = (
                "write the value out, or use a parameter; put a text that starts with & in quotes"
            )
            self._report("anchor", "anchors (&) are not used here", mark_of(event), hint)
        if event.tag is not None:
            hint = "remove it, or put a text that starts with ! in quotes"
            self._report("tag", "YAML tags (!) are not used here", mark_of(event), hint)
        return event.anchor is not None or event.tag is not None

    def _check_escapes(self, event: events.ScalarEvent) -> None:
        """Escape sequences must not bring in what a text cannot hold as it stands."""
        if event.style == '"' and (found := INVISIBLE.search(event.value)):
            message = f"an escape sequence stands for {character_name(found[0])}"
            hint = "remove it; names and titles are plain text"
            self._report("bad-character", message, mark_of(event), hint)

    def _cut_at_comma(self, scalar: Scalar) -> Diagnostic:
        return cut_at_comma(scalar, self._lines[scalar.mark.line - 1], self._file)

    def _report(self, code: str, message: str, mark: Mark, hint: str) -> None:
        place = Place(self._file, *mark)
        self.diagnostics.append(Diagnostic(code, "error", message, place, hint=hint))


def mark_of(event: events.Event) -> Mark:
    """Where an event starts."""
    start = event.start_mark
    return Mark(start.line + 1, start.column + 1) if start else Mark(1, 1)


def _quoted(text: str) -> str:
    return f"'{text if len(text) <= 40 else text[:37] + '...'}'"
