"""Other values in the text of a file: only the characters of the values change.

Comments, order, blanks, line breaks and quotes stay as somebody wrote them. What has been edited is
read again before it is given out, so that a value never becomes something else than was meant.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import yaml

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.reading.document import Document, KeyPath, document_from_text, key_words
from mechkin_cli.reading.text import character_name
from mechkin_cli.reading.yaml import FASTEST_LOADER, PlainData, Style
from mechkin_cli.record import NamedTuple

_LINES = re.compile(r"\r\n|\r|\n")
_BLOCK_HEADER = re.compile(r"[|>][-+0-9]*(?P<comment>[ \t]+#[^\r\n]*)?")
_PLAIN = re.compile(r"[\w.+][^\s,\[\]{}#:&*!|>'\"%@`]*(?: [^\s,\[\]{}#:&*!|>'\"%@`]+)*")
"""Texts that mean themselves without quotes wherever they stand; some others would, too."""

_EMPTY = {"", "~", "null", "Null", "NULL"}
_STYLES = {"'": Style.SINGLE_QUOTED, '"': Style.DOUBLE_QUOTED, "|": Style.BLOCK, ">": Style.BLOCK}


class Span(NamedTuple):
    """Where a value stands in a text: the characters from `start` up to `end`, its quotes among
    them; `text` is what it says."""

    start: int
    end: int
    text: str
    style: Style


def value_spans(text: str) -> dict[KeyPath, Span]:
    """The places of all values of a text that are neither lists nor mappings, by their paths.

    Args:
        text: YAML that the reader takes, without a byte order mark.

    Example:
        >>> value_spans("parameters: {r: 40 mm, l: 'r/2'}")[("parameters", "l")][:3]
        (26, 31, 'r/2')
    """
    starts = [0, *(found.end() for found in _LINES.finditer(text))]

    def index(mark: Any) -> int:
        at = starts[mark.line] if mark.line < len(starts) else len(text)
        return int(min(at + mark.column, len(text)))

    return {
        path: Span(index(event.start_mark), index(event.end_mark), event.value, _style(event))
        for path, event in _scalars(text)
    }


def edited(text: str, values: Mapping[KeyPath, str]) -> str:
    """The text with other values in some places.

    A value keeps the quotes that it has; one without gets them where it would mean something else.

    Args:
        text: of a mechanism file; a byte order mark stays.
        values: what the values are to say, by their paths.

    Raises:
        InvalidFile: the text is not the YAML of a mechanism file.
        UsageError: there is no such value, or the text cannot be one.

    Example:
        >>> edited("parameters: {r: 40 mm, l: 'r/2'} # ours", {("parameters", "l"): "3 in"})
        "parameters: {r: 40 mm, l: '3 in'} # ours"
    """
    plain = text.removeprefix("\ufeff")
    before = document_from_text(plain, "the file")
    spans = value_spans(plain)
    for path, value in values.items():
        if path not in spans:
            raise UsageError(f"there is no value at {key_words(path)} to be replaced")
        if value.strip() in _EMPTY or not value.isprintable():
            bad = next((each for each in value if not each.isprintable()), "")
            why = f"it holds {character_name(bad)}" if bad else "it is empty"
            raise UsageError(f"{key_words(path)}: this cannot be a value: {why}")
    result = plain
    for path in sorted(values, key=lambda each: spans[each].start, reverse=True):
        span = spans[path]
        source = plain[span.start : span.end]
        result = result[: span.start] + _written(values[path], source, span) + result[span.end :]
    _check(before, document_from_text(result, "the edited file"), values)
    return text[: len(text) - len(plain)] + result


def _scalars(text: str) -> Iterator[tuple[KeyPath, yaml.ScalarEvent]]:
    """All values with their paths. A stack has the steps to the collection that is open: the number
    of the next item in a list, in a mapping its last key, None where a key is next."""
    steps: list[str | int | None] = []
    in_list: list[bool] = []
    # both parsers agree on the end of a whole last line
    for event in yaml.parse(f"{text}\n", Loader=FASTEST_LOADER):
        if isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            is_list = isinstance(event, yaml.SequenceStartEvent)
            steps.append(0 if is_list else None)
            in_list.append(is_list)
            continue
        if isinstance(event, yaml.ScalarEvent):
            if steps and steps[-1] is None:
                steps[-1] = event.value
                continue
            yield tuple(step for step in steps if step is not None), event
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            steps.pop()
            in_list.pop()
        else:
            continue
        if steps:  # the value at the last step is complete
            last = steps[-1]
            steps[-1] = last + 1 if in_list[-1] and isinstance(last, int) else None


def _style(event: yaml.ScalarEvent) -> Style:
    return _STYLES.get(event.style or "", Style.PLAIN)


def _written(value: str, source: str, span: Span) -> str:
    """A value as it stands in the place of another."""
    if span.style is Style.DOUBLE_QUOTED:
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if span.style is Style.SINGLE_QUOTED:
        return _quoted(value)
    new = value if _PLAIN.fullmatch(value.removeprefix("-")) else _quoted(value)
    if span.style is Style.BLOCK:
        # the lines of the block go, what stands behind its sign and its last line break stay
        header = _BLOCK_HEADER.match(source)
        comment = (header["comment"] or "") if header else ""
        new += comment + source[len(source.rstrip()) :]
    return new


def _quoted(value: str) -> str:
    return "'" + value.replace("'", "''") + "'"


def _check(before: Document, after: Document, values: Mapping[KeyPath, str]) -> None:
    """Refuses what would have changed anything else than the values, or these in another way."""
    wanted = before.data
    for path, value in values.items():
        _put(wanted, path, value)
    if after.data != wanted:
        names = ", ".join(key_words(path) for path in values)
        raise UsageError(f"the file is written in a way that {names} cannot be replaced in it")


def _put(data: PlainData, path: KeyPath, value: str) -> None:
    for step in path[:-1]:
        data = data[step]  # type: ignore[index]
    data[path[-1]] = value  # type: ignore[index]
