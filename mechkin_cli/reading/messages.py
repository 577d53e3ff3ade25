"""Errors of a validation -> diagnostics with file, line and column.

An error is a plain record: `type` (its kind, by the names that validators use: `missing`,
`too_short`, ...), `loc` (the path to the value), `ctx` (numbers and words for the message). Three
conventions let a rule refer to another place than that of the validator:

- a step of `loc` in parentheses that is not a key of the file names one of several forms;
- a last step `[key]` means the key itself and not its value;
- `ctx["at"]` leads on from `loc`, `ctx["text"]` is the whole message, `ctx["hint"]` what to do.

Messages name what is written in the file, never the validator's types.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from mechkin_cli.diagnostics import Diagnostic, Place, nearest
from mechkin_cli.reading.document import Document, KeyPath
from mechkin_cli.reading.text import shortened
from mechkin_cli.reading.yaml import Mapping, Node, ScalarNode, Sequence, in_order

_LONGEST_LIST = 16
"""Known words up to this number are listed in a message."""


Wording = tuple[str, str, str | None]
"""The code, message and hint of a diagnostic."""


def missing_key(key: str, context: dict[str, Any]) -> Wording:
    """A mapping lacks a key; `context` may say the key's `purpose`."""
    purpose = context.get("purpose")
    hint = f"add {key}: {_lower_first(purpose)}" if purpose else f"add {key}"
    return "missing-key", f"the key {key} is missing", hint.rstrip(".")


def unknown_key(key: str, context: dict[str, Any]) -> Wording:
    """A key is not known; `context` may hold the `known` keys and `advice`."""
    known = context.get("known") or []
    hint = context.get("advice") or choice_hint(key, known, "keys") or "remove it"
    return "unknown-key", f"there is no key {shown(key)} here", hint


def unknown_word(node: Node | None, known: list[str], context: dict[str, Any]) -> Wording:
    """A value is not a known word of its place; `context` may hold the `noun` for what stands there
    and `advice` on what to write instead."""
    if not isinstance(node, ScalarNode):
        text = f"expected one of the words {', '.join(known)}, found {kind(node)}"
        return "unknown-word", text, None
    hint = context.get("advice") or choice_hint(node.text, known, "words")
    noun = context.get("noun")
    expected = f"a known {noun}" if noun else "one of the words allowed here"
    return "unknown-word", f"{shown(node.text)} is not {expected}", hint


def wrong_value(error: dict[str, Any], node: Node | None) -> Wording:
    """A value is of the wrong kind, too long, too short, or not of the expected form."""
    name, context = str(error["type"]), error.get("ctx") or {}
    if name in ("too_short", "too_long"):
        return _wrong_length(context, node)
    if name in _KINDS:
        expected, hint = _KINDS[name]
        return "wrong-kind", f"expected {expected}, found {kind(node)}", hint
    if name == "string_pattern_mismatch":
        expected = context.get("expected") or f"of the form {context.get('pattern')}"
        return "wrong-form", f"{kind(node)} is not {expected}", context.get("hint")
    if name in _BOUNDS:
        key, relation, direction = _BOUNDS[name]
        limit = context.get(key)
        message = f"{kind(node)} is {relation} the limit {limit}"
        return "out-of-range", message, f"write {limit} or {direction}"
    return "invalid-value", f"{kind(node)} cannot stand here", None


def choice_hint(word: str, known: list[str], what: str) -> str | None:
    """'did you mean ...?' for a close word, else the list of known words where it is short."""
    close = nearest(word, known)
    if close:
        return f"did you mean {close}?"
    if known and len(known) <= _LONGEST_LIST:
        return f"known {what}: {', '.join(known)}"
    return None


def kind(node: Node | None) -> str:
    """The value of a node in words."""
    if isinstance(node, ScalarNode):
        return shown(node.text)
    if isinstance(node, Sequence):
        return "an empty list" if not node.items else f"a list of {len(node.items)}"
    if isinstance(node, Mapping):
        return "a mapping {key: value}" if node.entries else "an empty mapping"
    return "nothing"


def shown(text: str) -> str:
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


_KEY = "[key]"


def explain(errors: Iterable[dict[str, Any]], document: Document) -> list[Diagnostic]:
    """One diagnostic per error, in the order of the file."""
    errors = list(errors)
    # keys that are missing only because they are misspelt, which has its own message
    misspelt = set()
    for error in errors:
        if error["type"] == "extra_forbidden":
            *mapping, key = error["loc"]
            close = nearest(str(key), (error.get("ctx") or {}).get("known") or [])
            misspelt.add((*mapping, close or ""))
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
        words = missing_key(str(path[-1]), context)
        return _at_path(words, path[:-1], document.place(path[:-1]))
    if code == "extra_forbidden":
        words = unknown_key(str(path[-1]), context)
        return _at_path(words, path[:-1], document.key_place(path))
    if code in ("unknown-word", "literal_error"):
        return _unknown_word(code, path, context, document)
    at_key = path[-1:] == (_KEY,)
    path = path[:-1] if at_key else path
    place = document.key_place(path) if at_key else document.place(path)
    if "text" in context:
        text = str(context["text"])
        if text.startswith("expected"):
            text += f", found {kind(document.node(path))}"
        words = code, text, context.get("hint")
    elif at_key:
        text = f"{shown(str(path[-1]))} is not {context.get('expected', 'a key')}"
        words = "wrong-form", text, context.get("hint")
    else:
        words = wrong_value(error, document.node(path))
    return _at_path(words, path[:-1] if at_key else path, place)


def _unknown_word(
    code: str, path: KeyPath, context: dict[str, Any], document: Document
) -> Diagnostic:
    if code == "literal_error":
        known = re.findall(r"'([^']*)'", str(context.get("expected")))
    else:
        known = str(context["words"]).split(", ")
        if not isinstance(document.node(path), Mapping):
            words = wrong_value({"type": "model_type"}, document.node(path))
            return _at_path(words, path, document.place(path))
        key = str(context["key"])
        if document.node((*path, key)) is None:
            words = missing_key(key, {"purpose": f"one of {', '.join(known)}"})
            return _at_path(words, path, document.place(path))
        path = (*path, key)
    words = unknown_word(document.node(path), known, context)
    return _at_path(words, path, document.place(path))


def _at_path(words: Wording, path: KeyPath, place: Place) -> Diagnostic:
    where = "".join(f"#{step + 1}" if isinstance(step, int) else f".{step}" for step in path)
    code, message, hint = words
    text = f"{where[1:]}: {message}" if where else message
    return Diagnostic(code, "error", text, place, hint=hint)


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
