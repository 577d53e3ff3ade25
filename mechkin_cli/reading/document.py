"""One mechanism file as plain data, the place in its text of every value and character, and what is
wrong with them in words.

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
from collections.abc import Iterable, Iterator
from functools import cached_property
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Any, TypeAlias, cast

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError, nearest
from mechkin_cli.reading.text import (
    INVISIBLE,
    MOST_EVENTS,
    MOST_LEVELS,
    character_name,
    check_size,
    lines_of,
    read_text,
    shortened,
)
from mechkin_cli.reading.yaml import (
    Mapping,
    Mark,
    Node,
    PlainData,
    ScalarNode,
    Sequence,
    Style,
    in_order,
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
    another process, builds the same; `notes` are what there is to say of how it is written.
    """

    file: str
    text: str
    root: Mapping
    overrides: dict[str, str] = field(default_factory=dict)
    folder: Path | None = None
    is_data: bool = False
    tables: dict[str, bytes] = field(default_factory=dict)
    notes: tuple[Diagnostic, ...] = ()

    @property
    def files(self) -> tuple[Path, ...]:
        """The file itself and those of the tables read so far; none for a text or for data."""
        if self.folder is None:
            return ()
        return (Path(self.file), *(self.folder / name for name in self.tables))

    @cached_property
    def data(self) -> dict[str, PlainData]:
        """The file as dict, list and str, with the overrides in place."""
        data = {key: plain_data(value) for key, (_, value) in self.root.entries.items()}
        parameters = data.get(_PARAMETERS)
        if isinstance(parameters, dict):
            data[_PARAMETERS] = parameters | self.overrides
        return data

    def node(self, path: KeyPath) -> Node | None:
        """The node at a path, None where there is nothing; overrides count."""
        _, node, depth = self._reach(path)
        return node if depth == len(path) else None

    def place(self, path: KeyPath) -> Place:
        """Where the value at a path stands; for a missing one, its nearest ancestor that exists."""
        if override := self._override(path):
            return self._outside(override, 0)
        _, node, depth = self._reach(path)
        return self._at(path[:depth], node.mark)

    def key_place(self, path: KeyPath) -> Place:
        """Where the key at a path stands (of a list item, the item); missing keys as in `place`."""
        mark, _, depth = self._reach(path)
        return self._at(path, mark) if depth == len(path) else self.place(path)

    def place_in(self, path: KeyPath, offset: int) -> Place:
        """Where the character `offset` (from 0) of the scalar at a path, or at its nearest ancestor
        that exists, stands in the source."""
        if override := self._override(path):
            return self._outside(override, offset)
        # a number that stands for several has one text
        _, node, _ = self._reach(path)
        if not isinstance(node, ScalarNode):
            return self.place(path)
        if self.is_data:
            return self.place(path)._replace(column=offset + 1)
        return Place(self.file, *source_mark(node, offset, self._lines))

    def with_parameters(self, parameters: collections.abc.Mapping[str, str]) -> Document:
        """The document with other values for some of its `parameters`.

        Raises `UsageError` for a name that the file does not define.
        """
        section = self.node((_PARAMETERS,))
        defined = section.entries if isinstance(section, Mapping) else {}
        for name, value in parameters.items():
            if name not in defined:
                raise UsageError(_unknown_parameter(name, list(defined), self.file))
            if not value.strip():
                raise UsageError(f"--set {name}: the value is empty; write --set {name}=0.6in")
        return replace(self, overrides=self.overrides | dict(parameters))

    @cached_property
    def _lines(self) -> list[str]:
        return lines_of(self.text)

    def _reach(self, path: KeyPath) -> tuple[Mark, Node, int]:
        """The last node on the path that exists, with the place of its key, and the number of steps
        that lead to it."""
        mark, node = self.root.mark, cast(Node, self.root)
        for depth, step in enumerate(path):
            child = _child(node, step)
            if child is None:
                return mark, node, depth
            mark, node = child
        if override := self._override(path):
            node = ScalarNode(self.overrides[override], node.mark, Style.PLAIN)
        return mark, node, len(path)

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


def _child(node: Node, step: str | int) -> tuple[Mark, Node] | None:
    if isinstance(node, Mapping) and isinstance(step, str):
        return node.entries.get(step)
    if isinstance(node, Sequence) and isinstance(step, int) and 0 <= step < len(node.items):
        return node.items[step].mark, node.items[step]
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

    >>> source_mark(ScalarNode("a''b", (1, 4), Style.DOUBLE_QUOTED), 3, ["x: \\"a''b\\""])
    (1, 8)
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
            return mark[0], mark[1] + width + blanks
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
                yield (number, index + 1), width
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


# Errors of a validation as diagnostics with file, line and column. An error is a plain record:
# `type` (its kind, by the names that validators use: `missing`, `too_short`, ...), `loc` (the path
# to the value), `ctx` (numbers and words for the message). Three conventions let a rule refer to
# another place than that of the validator: a step of `loc` in parentheses that is not a key of the
# file names one of several forms; a last step `[key]` means the key itself and not its value;
# `ctx["at"]` leads on from `loc`, `ctx["text"]` is the whole message, `ctx["hint"]` what to do.
# Messages name what is written in the file, never the validator's types.

_KEY = "[key]"


def explain(errors: Iterable[dict[str, Any]], document: Document) -> list[Diagnostic]:
    """One diagnostic per error, in the order of the file."""
    errors = list(errors)
    # keys that are missing only because they are misspelt, which has its own message
    misspelt = set()
    for error in errors:
        if error["type"] == "extra_forbidden":
            *mapping, key = error["loc"]
            context = error.get("ctx") or {}
            known = context.get("known") or []
            misspelt.add((*mapping, nearest(str(key), known) or ""))
            advice = str(context.get("advice"))
            misspelt |= {(*mapping, each) for each in known if f"{each}:" in advice.split()}
    diagnostics = (
        _diagnostic(error, document)
        for error in errors
        if not _is_echo(error, document)
        and not (error["type"] == "missing" and tuple(error["loc"]) in misspelt)
    )
    return in_order(list(dict.fromkeys(diagnostics)))


def _is_echo(error: dict[str, Any], document: Document) -> bool:
    """Whether a list counts as too short only because some of its items were refused."""
    if error["type"] != "too_short":
        return False
    node = document.node(_path(error["loc"], document))
    if isinstance(node, ScalarNode):
        return True  # it stands for a list of one
    if isinstance(node, Mapping):
        return bool(error["ctx"].get("field_type") != "Dictionary")  # so does this
    return isinstance(node, Sequence) and len(node.items) >= error["ctx"]["min_length"]


def _path(steps: Iterable[str | int], document: Document) -> KeyPath:
    """The steps without the names of forms, and without the number of an item where one value
    stands for a list; a key in parentheses stays."""
    path: KeyPath = ()
    for step in steps:
        if isinstance(step, int) and isinstance(document.node(path), ScalarNode | Mapping):
            continue
        is_form = str(step).startswith("(") and document.node((*path, step)) is None
        path = path if is_form else (*path, step)
    return path


def _diagnostic(error: dict[str, Any], document: Document) -> Diagnostic:
    context = error.get("ctx") or {}
    path = _path([*error["loc"], *context.get("at", ())], document)
    code = str(error["type"])
    if code == "missing":
        words = _missing_key(str(path[-1]), context)
        return _at_path(words, path[:-1], document.place(path[:-1]))
    if code == "extra_forbidden":
        words = _unknown_key(str(path[-1]), context)
        return _at_path(words, path[:-1], document.key_place(path))
    if code in ("unknown-word", "literal_error"):
        return _unknown_word(code, path, context, document)
    at_key = path[-1:] == (_KEY,)
    # the key's own fault, or a short form, whose word stands for a key that is not written
    if at_key or isinstance(document.node(path[:-1]), ScalarNode):
        path = path[:-1]
    place = document.key_place(path) if at_key else document.place(path)
    if "text" in context:
        text = str(context["text"])
        if text.startswith("expected"):
            text += f", found {_kind(document.node(path))}"
        words = code, text, context.get("hint")
    elif at_key:
        text = f"{_shown(str(path[-1]))} is not {context.get('expected', 'a key')}"
        words = "wrong-form", text, context.get("hint")
    else:
        words = _wrong_value(error, document.node(path))
    return _at_path(words, path[:-1] if at_key else path, place)


def _unknown_word(
    code: str, path: KeyPath, context: dict[str, Any], document: Document
) -> Diagnostic:
    if code == "literal_error":
        known = re.findall(r"'([^']*)'", str(context.get("expected")))
    else:
        known = str(context["words"]).split(", ")
        if not isinstance(document.node(path), Mapping):
            words = _wrong_value({"type": "model_type"}, document.node(path))
            return _at_path(words, path, document.place(path))
        key = str(context["key"])
        if document.node((*path, key)) is None:
            words = _missing_key(key, {"purpose": f"one of {', '.join(known)}"})
            return _at_path(words, path, document.place(path))
        path = (*path, key)
    words = _not_a_known_word(document.node(path), known, context)
    return _at_path(words, path, document.place(path))


def _at_path(words: Wording, path: KeyPath, place: Place) -> Diagnostic:
    where = "".join(f"#{step + 1}" if isinstance(step, int) else f".{step}" for step in path)
    code, message, hint = words
    text = f"{where[1:]}: {message}" if where else message
    return Diagnostic(code, "error", text, place, hint=hint)


_LONGEST_LIST = 16
"""Known words up to this number are listed in a message."""


Wording = tuple[str, str, str | None]
"""The code, message and hint of a diagnostic."""


def _missing_key(key: str, context: dict[str, Any]) -> Wording:
    """A mapping lacks a key; `context` may say the key's `purpose`."""
    purpose = context.get("purpose")
    hint = f"add {key}: {_lower_first(purpose)}" if purpose else f"add {key}"
    return "missing-key", f"the key {key} is missing", hint.rstrip(".")


def _unknown_key(key: str, context: dict[str, Any]) -> Wording:
    """A key is not known; `context` may hold the `known` keys and `advice`."""
    known = context.get("known") or []
    hint = context.get("advice") or _choice_hint(key, known, "keys") or "remove it"
    return "unknown-key", f"there is no key {_shown(key)} here", hint


def _not_a_known_word(node: Node | None, known: list[str], context: dict[str, Any]) -> Wording:
    """A value is not a known word of its place; `context` may hold the `noun` for what stands there
    and `advice` on what to write instead."""
    if not isinstance(node, ScalarNode):
        text = f"expected one of the words {', '.join(known)}, found {_kind(node)}"
        return "unknown-word", text, None
    hint = context.get("advice") or _choice_hint(node.text, known, "words")
    noun = context.get("noun")
    expected = f"a known {noun}" if noun else "one of the words allowed here"
    return "unknown-word", f"{_shown(node.text)} is not {expected}", hint


def _wrong_value(error: dict[str, Any], node: Node | None) -> Wording:
    """A value is of the wrong kind, too long, too short, or not of the expected form."""
    name, context = str(error["type"]), error.get("ctx") or {}
    if name in ("too_short", "too_long"):
        return _wrong_length(context, node)
    if name in _KINDS:
        expected, hint = _KINDS[name]
        if _KINDS[name] is _LIST and isinstance(node, ScalarNode) and _may_be_an_entry(node.text):
            hint = f"write it in brackets: [{node.text}]"
        elif _KINDS[name] is _LIST and isinstance(node, Mapping):
            hint = "write it in brackets, [{key: value}], or behind a dash"
        return "wrong-kind", f"expected {expected}, found {_kind(node)}", hint
    if name == "string_pattern_mismatch":
        expected = context.get("expected") or f"of the form {context.get('pattern')}"
        return "wrong-form", f"{_kind(node)} is not {expected}", context.get("hint")
    if name in _BOUNDS:
        key, relation, direction = _BOUNDS[name]
        limit = context.get(key)
        message = f"{_kind(node)} is {relation} the limit {limit}"
        return "out-of-range", message, f"write {limit} or {direction}"
    return "invalid-value", f"{_kind(node)} cannot stand here", None


def _may_be_an_entry(text: str) -> bool:
    """Whether a scalar where a list belongs may be its one entry: no number, answer or axis."""
    is_axis = text.lstrip("+-").lower() in ("x", "y", "z")
    is_number = text[:1].isdigit() and len(text) < 3
    return 0 < len(text) < 40 and not is_axis and not is_number and text not in ("true", "false")


def _choice_hint(word: str, known: list[str], what: str) -> str | None:
    """'did you mean ...?' for a close word, else the list of known words where it is short."""
    close = nearest(word, known)
    if close:
        return f"did you mean {close}?"
    if known and len(known) <= _LONGEST_LIST:
        return f"known {what}: {', '.join(known)}"
    return None


def _kind(node: Node | None) -> str:
    """The value of a node in words."""
    if isinstance(node, ScalarNode):
        return _shown(node.text)
    if isinstance(node, Sequence):
        return "an empty list" if not node.items else f"a list of {len(node.items)}"
    if isinstance(node, Mapping):
        return "a mapping {key: value}" if node.entries else "an empty mapping"
    return "nothing"


def _shown(text: str) -> str:
    """A text of the file as messages quote it."""
    return f"'{shortened(text)}'"


_LIST = ("a list [...]", "write it in brackets: [x, y, z]")
_MAPPING = ("a mapping", "write {key: value}, or key: value on indented lines")
_KINDS = {
    "tuple_type": _LIST,
    "list_type": _LIST,
    "dict_type": _MAPPING,
    "model_type": _MAPPING,
    "model_attributes_type": _MAPPING,
    "string_type": ("a word", "write a name"),
}
_BOUNDS = {
    "greater_than_equal": ("ge", "below", "more"),
    "less_than_equal": ("le", "above", "less"),
}


def _wrong_length(context: dict[str, Any], node: Node | None) -> Wording:
    least, most = context.get("min_length"), context.get("max_length")
    count = len(node.items) if isinstance(node, Sequence) else context.get("actual_length")
    if isinstance(node, Mapping):
        count = len(node.entries)
    what = "entry" if count == 1 else "entries"
    limit = f"at least {least}" if most is None else f"at most {most}"
    is_vector = 3 in (least, most)
    hint = "a vector has three: [x, y, z]; with plane: xy two" if is_vector else None
    return "wrong-length", f"found {count} {what}, expected {limit}", hint


def _lower_first(text: str) -> str:
    # an abbreviation stays as it is: "CSV file"
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]


def is_study(document: Document) -> list[Diagnostic]:
    """One message where a mechanism is needed and the file is a study; none where it is not."""
    if "study" not in document.data or "format" in document.data:
        return []
    text = "this is a study, and a mechanism file is needed"
    hint = f"run it with mechkin study {document.file}"
    mechanism = document.data.get("mechanism")
    if isinstance(mechanism, str):
        hint += f", or give its mechanism, {mechanism}"
    return [Diagnostic("a-study", "error", text, document.place(("study",)), hint=hint)]


def is_mechanism(document: Document) -> list[Diagnostic]:
    """One message where a study is needed and the file is a mechanism; none where it is not."""
    if "format" not in document.data or "study" in document.data:
        return []
    text = "this is a mechanism file, and a study is needed"
    hint = (
        "write study: 1, mechanism: FILE, vary: {NAME: [VALUES]} and keep: into a file of its own "
        f"(docs/studies.md), or run this one with mechkin analyze {document.file}"
    )
    return [Diagnostic("a-mechanism", "error", text, document.place(("format",)), hint=hint)]
