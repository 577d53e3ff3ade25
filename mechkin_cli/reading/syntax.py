"""Errors of YAML's own grammar in plain words, the same for the C parser and for the Python parser.

Both parsers name the rule that failed in slightly different words; the table below knows the part
they have in common. Whatever it doesn't know gets one general message, never the parser's own.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from yaml import MarkedYAMLError, YAMLError

from mechkin_cli.diagnostics import Diagnostic, Place

_QUOTE = "put the text in quotes"
_COLON = "a ':' cannot stand here"
_NO_COLON = "a ':' is missing after this key"
_WITH_COLON = "write key: value, with a blank after the colon"
_INDENT = "indent keys of one mapping equally, and put a value that holds ': ' in quotes"


class _Rule(NamedTuple):
    pattern: re.Pattern[str]
    message: str
    hint: str
    at_start: bool = False
    """Report where the unfinished construct starts, not where the parser gave up."""
    open_message: str | None = None
    """The message at the start of the construct, for when the parser gave up on a later line."""


def _rule(
    pattern: str, message: str, hint: str, at_start: bool = False, open_message: str | None = None
) -> _Rule:
    return _Rule(re.compile(pattern), message, hint, at_start, open_message)


_RULES = (
    _rule(
        r"quoted scalar.*(end of stream|document)",
        "this quoted text is never closed",
        "add the closing quote",
        at_start=True,
    ),
    _rule(
        r"(double-)?quoted scalar",
        "an unknown escape sequence in a double-quoted text",
        "write \\\\ for a backslash, or use single quotes",
        at_start=True,
    ),
    _rule(r"cannot start any token", "this character cannot start a value", _QUOTE),
    _rule(
        r"flow sequence",
        "',' or ']' was expected here",
        "close the list with ], and put an expression with commas or brackets in quotes",
        open_message="this list is not closed on its line and goes wrong further down",
    ),
    _rule(
        r"flow mapping",
        "',' or '}' was expected here",
        "close the mapping with }, and put an expression with commas or brackets in quotes",
        open_message="this mapping is not closed on its line and goes wrong further down",
    ),
    _rule(r"mapping values are not allowed", _COLON, _INDENT),
    _rule(
        r"sequence entries are not allowed",
        "a '-' cannot start a list here",
        "start the list on a new line, or put the text in quotes",
    ),
    _rule(r"mapping keys are not allowed", "a '?' cannot stand here", _QUOTE),
    _rule(
        r"simple key",
        _NO_COLON,
        _WITH_COLON,
        at_start=True,
    ),
    _rule(
        r"block mapping",
        "a key was expected here",
        "give all keys of a mapping the same indentation, and check brackets and quotes before it",
    ),
    _rule(
        r"block (collection|sequence)",
        "an item of the list ('- ') was expected here",
        "give all items of a list the same indentation",
    ),
    _rule(r"block scalar", "a block text (| or >) cannot start or continue like this", _QUOTE),
    _rule(r"(anchor|alias|tag)", "anchors, aliases and tags (& * !) are not used here", _QUOTE),
    _rule(
        r"plain scalar.*':'", "a blank is missing after this ':'", "write key: value, or use quotes"
    ),
    _rule(r"node", "a value is missing here", "write the value, or remove the comma or colon"),
    _rule(
        r"document start",
        "the file goes on after its mapping has ended",
        "check indentation and brackets before this place",
    ),
)
_GENERAL = _rule("", "the text is not valid YAML here", "check indentation, quotes and brackets")


def syntax_diagnostic(error: YAMLError, file: str, text: str) -> Diagnostic:
    """The message for an error that a YAML parser raised about a text."""
    if not isinstance(error, MarkedYAMLError):
        return Diagnostic("yaml", "error", _GENERAL.message, Place(file, 1, 1), hint=_GENERAL.hint)
    words = f"{error.context} {error.problem}"
    rule = next((rule for rule in _RULES if rule.pattern.search(words)), _GENERAL)
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
