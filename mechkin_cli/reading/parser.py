"""YAML text -> nodes, by a walk over the parser's events.

The tree is never built by YAML itself: a composer recurses, and a file of two hundred thousand open
brackets would overflow the stack of the C library. Limits are tested while the events come in.
"""

from __future__ import annotations

from typing import Any

import yaml
from yaml import events

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place
from mechkin_cli.reading.limits import MOST_DIAGNOSTICS, MOST_EVENTS
from mechkin_cli.reading.nodes import Mapping
from mechkin_cli.reading.text import check_characters, lines_of
from mechkin_cli.reading.tree import TooDeepError, TreeBuilder, mark_of

FASTEST_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""PyYAML's wrapper of libyaml where it was built, else the parser in Python."""

_LIBRARY_DEPTH = "exceeded maximum nesting depth"

CORRECT_FIRST = "correct these first"

_START_OF_A_FILE = "a mechanism file starts with the line format: 1, a study with study: 1"


class _BeyondLibraryError(Exception):
    """The parser in C gives up at its own depth, before it tells of the brackets that lead there;
    that in Python tells at which one the limit is passed."""


def parse(text: str, file: str, *, loader: Any = FASTEST_LOADER) -> Mapping:
    """The top-level mapping of a YAML text.

    Raises `InvalidFile` with every independent problem found up to the first break of YAML's
    grammar: empty values, duplicate keys, anchors, aliases, merge keys, tags, several documents, an
    empty file, another top level than a mapping.
    """
    check_characters(text, file)
    lines = lines_of(text)
    whole = f"{text}\n"  # both parsers agree on the end of a whole last line
    builder = TreeBuilder(lines, file)
    try:
        _walk(whole, file, loader, builder)
    except _BeyondLibraryError:
        builder = TreeBuilder(lines, file)
        _walk(whole, file, yaml.SafeLoader, builder)
    diagnostics = builder.diagnostics
    if not diagnostics and isinstance(builder.root, Mapping):
        return builder.root
    if not diagnostics:
        diagnostics = [_not_a_mapping(builder, file)]
    raise InvalidFile(in_order([_inside(found, lines) for found in diagnostics]))


def _inside(diagnostic: Diagnostic, lines: list[str]) -> Diagnostic:
    """The diagnostic at the end of the text, where a parser complains behind it."""
    place = diagnostic.place
    if place is None or place.line <= len(lines):
        return diagnostic
    end = Place(place.file, len(lines), len(lines[-1]) + 1)
    return diagnostic._replace(place=end)


def in_order(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics by place: at most `MOST_DIAGNOSTICS`, and one that counts the rest."""
    first = Place("", 0, 0)
    ordered = sorted(diagnostics, key=lambda found: _position(found.place or first))
    rest = len(ordered) - MOST_DIAGNOSTICS
    if rest <= 0:
        return ordered
    message = f"{rest} more problems are not shown"
    return [*ordered[:MOST_DIAGNOSTICS], Diagnostic("more", "note", message, hint=CORRECT_FIRST)]


def _position(place: Place) -> tuple[int, int]:
    return place.line, place.column


def _walk(text: str, file: str, loader: Any, builder: TreeBuilder) -> None:
    documents = 0
    try:
        for count, event in enumerate(yaml.parse(text, Loader=loader)):
            if isinstance(event, events.DocumentStartEvent):
                documents += 1
            if documents > 1 or count > MOST_EVENTS:
                place = Place(file, *mark_of(event))
                builder.diagnostics.append(_too_many(place, documents))
                return
            builder.take(event)
    except TooDeepError:
        return
    except yaml.YAMLError as error:
        if _LIBRARY_DEPTH in str(error) and loader is not yaml.SafeLoader:
            raise _BeyondLibraryError from None
        from mechkin_cli.reading.syntax import syntax_diagnostic  # only on the way to messages

        builder.diagnostics.append(builder.cut_off_value() or syntax_diagnostic(error, file, text))


def _too_many(place: Place, documents: int) -> Diagnostic:
    if documents > 1:
        message, hint = "a second YAML document starts here", "write one mechanism in one file"
        return Diagnostic("several-documents", "error", message, place, hint=hint)
    hint = "keep long tables of numbers in CSV files"
    limit = f"{MOST_EVENTS} values and brackets"
    message = "the file is too long for a mechanism file"
    return Diagnostic("file-too-long", "error", f"{message} (limit {limit})", place, hint=hint)


def _not_a_mapping(builder: TreeBuilder, file: str) -> Diagnostic:
    if builder.root is None:
        message = "the file is empty"
        return Diagnostic("empty-file", "error", message, Place(file, 1, 1), hint=_START_OF_A_FILE)
    place = Place(file, *builder.root.mark)
    message = "the top level must be a mapping of keys such as format, links, joints"
    return Diagnostic("not-a-mapping", "error", message, place, hint=_START_OF_A_FILE)
