"""YAML text -> nodes, by a walk over the parser's events, with a message for every mistake.

The tree is never built by YAML itself: a composer recurses, and a file of two hundred thousand open
brackets would overflow the stack of the C library. Limits are tested while the events come in.
Scalars, sequences and mappings know their places. Scalars stay text, so that `1e-3`, `on` and `010`
mean what the schema defines and not what YAML guesses.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from enum import Enum
from functools import lru_cache
from itertools import accumulate
from typing import Any, TypeAlias

import yaml
from yaml import MarkedYAMLError, YAMLError, events

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place
from mechkin_cli.reading.text import (
    INVISIBLE,
    LONGEST_EXPRESSION,
    MOST_DIAGNOSTICS,
    MOST_EVENTS,
    MOST_LEVELS,
    MOST_PIECES,
    character_name,
    check_characters,
    lines_of,
    shortened,
)
from mechkin_cli.record import NamedTuple

Mark: TypeAlias = tuple[int, int]
"""A position in a text: line and column, from 1, columns in characters."""


class Style(Enum):
    """How a scalar is written; decides how its characters lie in the source text."""

    PLAIN = "plain"
    SINGLE_QUOTED = "single quoted"
    DOUBLE_QUOTED = "double quoted"
    BLOCK = "block"


class ScalarNode(NamedTuple):
    """One value as text; `mark` is its first character (the quote, where there is one)."""

    text: str
    mark: Mark
    style: Style


class Sequence(NamedTuple):
    """A list; `mark` is its bracket, or its first dash in block style."""

    items: tuple[Node, ...]
    mark: Mark


class Mapping(NamedTuple):
    """Keys in the order written, each with the place of its first character and its value; `mark`
    is the brace, in block style the first key."""

    entries: dict[str, tuple[Mark, Node]]
    mark: Mark


Node: TypeAlias = ScalarNode | Sequence | Mapping
PlainData: TypeAlias = "str | list[PlainData] | dict[str, PlainData]"


def plain_data(node: Node) -> PlainData:
    """The node as dict, list and str, without places.

    >>> plain_data(Sequence((ScalarNode("1", (1, 2), Style.PLAIN),), (1, 1)))
    ['1']
    """
    if isinstance(node, ScalarNode):
        return node.text
    if isinstance(node, Sequence):
        return [plain_data(item) for item in node.items]
    return {key: plain_data(value) for key, (_, value) in node.entries.items()}


# The classic mistake of one-line mappings: `{value: det(a, b, c)}` without quotes. Inside braces
# and brackets YAML ends an unquoted scalar at the comma, so the example has the keys `value`, `b`
# and `c)`. A scalar with an open parenthesis gives the mistake away.

_OPENING, _CLOSING = "([{", ")]}"
_ENDS_AN_EXPRESSION = ",}]"


def is_cut_off(node: Node) -> bool:
    """Whether the node is an unquoted scalar in which a parenthesis stays open."""
    return _open_parentheses(node) > 0


def pieces_of_mapping(pairs: list[tuple[Node, Node]], first: int) -> int:
    """The number of entries after `pairs[first]` that are pieces of its cut off value.

    A piece is a key without a value; the pieces end where the parentheses are closed.
    """
    still_open = _open_parentheses(pairs[first][1])
    end = first + 1
    last = min(len(pairs), end + MOST_PIECES)
    while end < last and still_open > 0 and is_empty(pairs[end][1]):
        still_open += _open_parentheses(pairs[end][0])
        end += 1
    return end - first - 1


def pieces_of_sequence(items: list[Node], first: int) -> int:
    """The number of items after `items[first]` that are pieces of it; 0 where nothing closes it."""
    still_open = _open_parentheses(items[first])
    for end in range(first + 1, min(len(items), first + 1 + MOST_PIECES)):
        still_open += _open_parentheses(items[end])
        if still_open <= 0:
            return end - first
    return 0


_NOTHING = frozenset(("", "~", "null", "Null", "NULL"))


def is_empty(node: Node) -> bool:
    """Whether YAML reads the node as 'no value'."""
    return isinstance(node, ScalarNode) and node.style is Style.PLAIN and node.text in _NOTHING


def _is_questionable(node: Node) -> bool:
    """Whether a node might be empty or cut off; of most one sees at once that they are not."""
    return isinstance(node, ScalarNode) and (node.text in _NOTHING or "(" in node.text)


def cut_at_comma(scalar: ScalarNode, line: str, file: str) -> Diagnostic:
    """The message for a cut off scalar; `line` is the source line on which it starts."""
    whole = _whole_expression(line, scalar.mark[1] - 1)
    hint = f'put it in quotes: "{whole}"' if whole else "put the whole expression in quotes"
    return Diagnostic(
        "comma-without-quotes",
        "error",
        f"YAML ends the value {shortened(scalar.text)} at the comma or bracket that follows",
        Place(file, *scalar.mark),
        hint=hint,
    )


def _open_parentheses(node: Node) -> int:
    if not isinstance(node, ScalarNode) or node.style is not Style.PLAIN:
        return 0
    return node.text.count("(") - node.text.count(")")


def _whole_expression(line: str, start: int) -> str | None:
    depths, ends = _nesting(line)
    level = depths[min(start, len(line))]
    places = ends.get(level, [])
    first = bisect_left(places, start)
    if first < len(places) and places[first] < start + LONGEST_EXPRESSION:
        return line[start : places[first]].strip()
    source = line[start:]
    return source.strip() if depths[-1] == level and len(source) <= LONGEST_EXPRESSION else None


@lru_cache(maxsize=1)
def _nesting(line: str) -> tuple[list[int], dict[int, list[int]]]:
    """The depth in brackets of each character of a line and of its end; and by depth the places
    where an expression could end. Remembered, since a line may have thousands of values."""
    steps = ((c in _OPENING) - (c in _CLOSING) for c in line)
    depths = list(accumulate(steps, initial=0))
    ends: dict[int, list[int]] = {}
    for index, character in enumerate(line):
        if character in _ENDS_AN_EXPRESSION or line.startswith(" #", index):
            ends.setdefault(depths[index], []).append(index)
    return depths, ends


_WRITE_OUT = "write the value out, or use a parameter; put a text that starts with {} in quotes"
_STYLES: dict[str | None, Style] = {
    "'": Style.SINGLE_QUOTED,
    '"': Style.DOUBLE_QUOTED,
    "|": Style.BLOCK,
    ">": Style.BLOCK,
}


class TooDeepError(Exception):
    """Raised when the nesting exceeds `MOST_LEVELS`; the diagnostic exists already."""


class TreeBuilder:
    """Takes the events of one document in order; afterwards `root` is its node.

    `diagnostics` has every problem that is not one of YAML's grammar; without any the tree is
    valid. A stack holds the lists and mappings that are still open, with their marks and whether
    they are mappings; their children are gathered in one flat list (key, value, key, value for a
    mapping) and judged when the collection closes.
    Without recursion deep nesting ends in a message and not in a full stack.
    """

    def __init__(self, lines: list[str], file: str) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.root: Node | None = None
        self._lines = lines
        self._file = file
        self._stack: list[tuple[Mark, bool, list[Node]]] = []
        self._last: Node | None = None

    def take(self, event: events.Event) -> None:
        """Add one scalar, alias, or the start or end of a list or mapping."""
        if isinstance(event, events.ScalarEvent):
            written, mark = event.style, mark_of(event)
            style = _STYLES.get(written, Style.PLAIN)
            if event.anchor is not None or event.tag is not None:
                self._check_properties(event)
                if not event.value:
                    style = Style.SINGLE_QUOTED  # one message about this scalar is enough
            if written == '"':
                self._check_escapes(event)
            self._add(ScalarNode(event.value, mark, style))
        elif isinstance(event, (events.SequenceStartEvent, events.MappingStartEvent)):
            self._check_properties(event)
            self._open(mark_of(event), isinstance(event, events.MappingStartEvent))
        elif isinstance(event, (events.SequenceEndEvent, events.MappingEndEvent)):
            mark, is_mapping, children = self._stack.pop()
            close = self._mapping if is_mapping else self._sequence
            self._add(close(children, mark))
        elif isinstance(event, events.AliasEvent):
            hint = _WRITE_OUT.format("*")
            self._report("alias", "aliases (*) are not used here", mark_of(event), hint)
            self._add(ScalarNode(f"*{event.anchor}", mark_of(event), Style.SINGLE_QUOTED))

    def cut_off_value(self) -> Diagnostic | None:
        """The message for the scalar taken last, if it was cut off inside its parentheses."""
        if isinstance(self._last, ScalarNode) and is_cut_off(self._last):
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
        self._stack.append((mark, is_mapping, []))

    def _add(self, node: Node) -> None:
        self._last = node
        if self._stack:
            self._stack[-1][2].append(node)
        else:
            self.root = node

    def _sequence(self, items: list[Node], mark: Mark) -> Sequence:
        if any(map(_is_questionable, items)):
            self._judge_items(items, mark)
        return Sequence(tuple(items), mark)

    def _judge_items(self, items: list[Node], mark: Mark) -> None:
        index = 0
        while index < len(items):
            item = items[index]
            if is_empty(item):
                # the parsers disagree on the place of nothing, but not on that of the list
                hint = "write a value or remove the item"
                message = f"item {index + 1} of this list is empty"
                self._report("empty-value", message, mark, hint)
            elif isinstance(item, ScalarNode) and is_cut_off(item):
                pieces = pieces_of_sequence(items, index)
                if pieces:
                    self.diagnostics.append(self._cut_at_comma(item))
                index += pieces
            index += 1

    def _mapping(self, children: list[Node], mark: Mark) -> Mapping:
        keys, values = children[::2], children[1::2]
        entries: dict[str, tuple[Mark, Node]] = {}
        for key, value in zip(keys, values, strict=True):
            if not isinstance(key, ScalarNode) or _is_questionable(value):
                break
            entries[key.text] = key.mark, value
        if len(entries) < len(keys) or "" in entries or "<<" in entries:
            entries = self._judged_entries(list(zip(keys, values, strict=True)))
        return Mapping(entries, mark)

    def _judged_entries(self, pairs: list[tuple[Node, Node]]) -> dict[str, tuple[Mark, Node]]:
        entries: dict[str, tuple[Mark, Node]] = {}
        index = 0
        while index < len(pairs):
            key, value = pairs[index]
            pieces = 0
            if isinstance(value, ScalarNode) and is_cut_off(value):
                pieces = pieces_of_mapping(pairs, index)
                if pieces:
                    self.diagnostics.append(self._cut_at_comma(value))
            if self._accepts_key(key, entries) and isinstance(key, ScalarNode):
                if is_empty(value):
                    self._report_empty(key)
                entries[key.text] = key.mark, value
            index += 1 + pieces
        return entries

    def _accepts_key(self, key: Node, entries: dict[str, tuple[Mark, Node]]) -> bool:
        if not isinstance(key, ScalarNode):
            hint = "write key: value; put an expression with brackets in quotes"
            self._report("bad-key", "a list or mapping cannot be a key", key.mark, hint)
        elif key.text == "" and key.style is Style.PLAIN:
            self._report("bad-key", "a key is missing before the ':'", key.mark, "write key: value")
        elif key.text == "<<" and key.style is Style.PLAIN:
            hint = "write the keys out"
            self._report("merge-key", "merge keys (<<) are not used here", key.mark, hint)
        elif key.text in entries:
            message = f"the key '{shortened(key.text)}' is written twice in one mapping"
            (line, column), _ = entries[key.text]
            hint = f"keep one of them; the first is at line {line}, column {column}"
            self._report("duplicate-key", message, key.mark, hint)
        else:
            return True
        return False

    def _report_empty(self, key: ScalarNode) -> None:
        name, colon, rest = key.text.partition(":")
        message = f"the key '{shortened(key.text)}' has no value"
        line, column = key.mark
        before, after = self._lines[line - 1][: column - 1], self._lines[line - 1][column - 1 :]
        if key.style is Style.PLAIN and colon and rest:
            hint = f"write a blank after the colon: {name}: {rest}"
        elif before.rstrip().endswith(",") and not after[len(key.text) :].lstrip().startswith(":"):
            message = f"the comma before '{shortened(key.text)}' ends the value, and a key follows"
            hint = "write a list in brackets, [1, 2], and a decimal with a dot, 0.5"
        else:
            hint = "write a value, {} for an empty mapping, or remove the key"
        self._report("empty-value", message, key.mark, hint)

    def _check_properties(
        self, event: events.ScalarEvent | events.SequenceStartEvent | events.MappingStartEvent
    ) -> None:
        if event.anchor is not None:
            hint = _WRITE_OUT.format("&")
            self._report("anchor", "anchors (&) are not used here", mark_of(event), hint)
        if event.tag is not None:
            hint = "remove it, or put a text that starts with ! in quotes"
            self._report("tag", "YAML tags (!) are not used here", mark_of(event), hint)

    def _check_escapes(self, event: events.ScalarEvent) -> None:
        """Escape sequences must not bring in characters that a text cannot hold directly."""
        if found := INVISIBLE.search(event.value):
            message = f"an escape sequence stands for {character_name(found[0])}"
            hint = "remove it; names and titles are plain text"
            self._report("bad-character", message, mark_of(event), hint)

    def _cut_at_comma(self, scalar: ScalarNode) -> Diagnostic:
        return cut_at_comma(scalar, self._lines[scalar.mark[0] - 1], self._file)

    def _report(self, code: str, message: str, mark: Mark, hint: str) -> None:
        place = Place(self._file, *mark)
        self.diagnostics.append(Diagnostic(code, "error", message, place, hint=hint))


def mark_of(event: events.Event) -> Mark:
    """Where an event starts."""
    start = event.start_mark
    return (start.line + 1, start.column + 1) if start else (1, 1)


FASTEST_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""PyYAML's wrapper of libyaml where it was built, else the parser in Python."""

_LIBRARY_DEPTH = "exceeded maximum nesting depth"

CORRECT_FIRST = "correct these first"

_START_OF_A_FILE = "a mechanism file starts with the line format: 1, a study with study: 1"


class _BeyondLibraryError(Exception):
    """The parser in C gives up at its own depth, before it reports the brackets that lead there;
    that in Python reports the one at which the limit is passed."""


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
    raise InvalidFile(in_order([_inside(diagnostic, lines) for diagnostic in diagnostics]))


def _inside(diagnostic: Diagnostic, lines: list[str]) -> Diagnostic:
    """The diagnostic at the end of the text, where a parser's place lies behind it."""
    place = diagnostic.place
    if place is None or place.line <= len(lines):
        return diagnostic
    end = Place(place.file, len(lines), len(lines[-1]) + 1)
    return diagnostic._replace(place=end)


def in_order(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics by place: at most `MOST_DIAGNOSTICS`, and one that counts the rest."""
    ordered = sorted(diagnostics, key=lambda each: each.place[1:3] if each.place else (0, 0))
    rest = len(ordered) - MOST_DIAGNOSTICS
    if rest <= 0:
        return ordered
    message = f"{rest} more problems are not shown"
    return [*ordered[:MOST_DIAGNOSTICS], Diagnostic("more", "note", message, hint=CORRECT_FIRST)]


def _walk(text: str, file: str, loader: Any, builder: TreeBuilder) -> None:
    documents = 0
    try:
        for count, event in enumerate(yaml.parse(text, Loader=loader)):
            documents += isinstance(event, events.DocumentStartEvent)
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


# Errors of YAML's own grammar in plain words, the same for the parsers in C and in Python: both
# name the rule that failed in slightly different words, of which a pattern has the common part.

_QUOTE = "put the text in quotes"
_COLON = "a ':' cannot stand here"
_NO_COLON = "a ':' is missing after this key"
_WITH_COLON = "write key: value, with a blank after the colon"
_INDENT = "indent keys of one mapping equally, and put a value that holds ': ' in quotes"


class _Rule(NamedTuple):
    pattern: str
    message: str
    hint: str
    at_start: bool = False
    """Report where the unfinished construct starts, not where the parser gave up."""
    open_message: str | None = None
    """The message at the start of the construct, for when the parser gave up on a later line."""


_RULES = (
    _Rule(
        r"quoted scalar.*(end of stream|document)",
        "this quoted text is never closed",
        "add the closing quote",
        at_start=True,
    ),
    _Rule(
        r"(double-)?quoted scalar",
        "an unknown escape sequence in a double-quoted text",
        "write \\\\ for a backslash, or use single quotes",
        at_start=True,
    ),
    _Rule(r"cannot start any token", "this character cannot start a value", _QUOTE),
    _Rule(
        r"flow sequence",
        "',' or ']' was expected here",
        "close the list with ], and put an expression with commas or brackets in quotes",
        open_message="this list is not closed on its line and goes wrong further down",
    ),
    _Rule(
        r"flow mapping",
        "',' or '}' was expected here",
        "close the mapping with }, and put an expression with commas or brackets in quotes",
        open_message="this mapping is not closed on its line and goes wrong further down",
    ),
    _Rule(r"mapping values are not allowed", _COLON, _INDENT),
    _Rule(
        r"sequence entries are not allowed",
        "a '-' cannot start a list here",
        "start the list on a new line, or put the text in quotes",
    ),
    _Rule(r"mapping keys are not allowed", "a '?' cannot stand here", _QUOTE),
    _Rule(r"simple key", _NO_COLON, _WITH_COLON, at_start=True),
    _Rule(
        r"block mapping",
        "a key was expected here",
        "give all keys of a mapping the same indentation, and check brackets and quotes before it",
    ),
    _Rule(
        r"block (collection|sequence)",
        "an item of the list ('- ') was expected here",
        "give all items of a list the same indentation",
    ),
    _Rule(r"block scalar", "a block text (| or >) cannot start or continue like this", _QUOTE),
    _Rule(r"(anchor|alias|tag)", "anchors, aliases and tags (& * !) are not used here", _QUOTE),
    _Rule(
        r"plain scalar.*':'", "a blank is missing after this ':'", "write key: value, or use quotes"
    ),
    _Rule(r"node", "a value is missing here", "write the value, or remove the comma or colon"),
    _Rule(
        r"document start",
        "the file goes on after its mapping has ended",
        "check indentation and brackets before this place",
    ),
)


_GENERAL = _Rule("", "the text is not valid YAML here", "check indentation, quotes and brackets")


def syntax_diagnostic(error: YAMLError, file: str, text: str) -> Diagnostic:
    """The message for an error that a YAML parser raised about a text."""
    if not isinstance(error, MarkedYAMLError):
        return Diagnostic("yaml", "error", _GENERAL.message, Place(file, 1, 1), hint=_GENERAL.hint)
    words = f"{error.context} {error.problem}"
    rule = next((rule for rule in _RULES if re.search(rule.pattern, words)), _GENERAL)
    start, stop = error.context_mark, error.problem_mark or error.context_mark
    message, mark = rule.message, stop
    if start and stop and rule.open_message and start.line != stop.line:
        message, mark = rule.open_message, start
    elif start and rule.at_start:
        mark = start
    if stop and rule.message == _COLON:
        before = _line_without_colon(text.split("\n"), stop.line)
        if before is not None:
            return Diagnostic("yaml", "error", _NO_COLON, Place(file, *before), hint=_WITH_COLON)
    place = Place(file, mark.line + 1, mark.column + 1) if mark else Place(file, 1, 1)
    return Diagnostic("yaml", "error", message, place, hint=rule.hint)


def _line_without_colon(lines: list[str], number: int) -> tuple[int, int] | None:
    """Line and column, from 1, of a key without its colon: the line before the one where a second
    value begins, where it is indented as that and has none. YAML takes both for one text."""
    above = number - 1
    while above >= 0 and not lines[above].strip():
        above -= 1
    if above < 0:
        return None
    line, indent = lines[above], len(lines[above]) - len(lines[above].lstrip())
    own = len(lines[number]) - len(lines[number].lstrip())
    is_key = line[indent : indent + 1].isidentifier() and ":" not in line
    return (above + 1, indent + 1) if is_key and indent == own else None
