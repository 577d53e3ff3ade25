"""What is wrong with one value, in words: a phrase per kind of validation error.

The kinds are the names that validators give (`missing`, `too_short`, ...). The phrases speak of
what is written in the file, never of the validator's types.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from mechkin_cli.nearest import nearest
from mechkin_cli.reading.nodes import Mapping, Node, Scalar, Sequence

_LONGEST_LIST = 16
"""A message lists the known words up to this many."""


class Wording(NamedTuple):
    """The code, message and hint of a diagnostic."""

    code: str
    message: str
    hint: str | None


def missing_key(key: str, context: dict[str, Any]) -> Wording:
    """A mapping lacks a key; `context` may say the key's `purpose`."""
    purpose = context.get("purpose")
    hint = f"add {key}: {_lower_first(purpose)}" if purpose else f"add {key}"
    return Wording("missing-key", f"the key {key} is missing", hint.rstrip("."))


def unknown_key(key: str, context: dict[str, Any]) -> Wording:
    """A mapping has a key that it cannot have; `context` may hold the `known` keys and `advice`."""
    known = context.get("known") or []
    hint = context.get("advice") or choice_hint(key, known, "keys") or "remove it"
    return Wording("unknown-key", f"there is no key {shown(key)} here", hint)


def unknown_word(found: Node | None, known: list[str], advice: str | None = None) -> Wording:
    """A value is none of the words possible at its place; `advice` says what to do instead."""
    if not isinstance(found, Scalar):
        text = f"expected one of the words {', '.join(known)}, found {kind(found)}"
        return Wording("unknown-word", text, None)
    hint = advice or choice_hint(found.text, known, "words")
    return Wording("unknown-word", f"{shown(found.text)} is none of the words possible here", hint)


def wrong_value(error: dict[str, Any], found: Node | None) -> Wording:
    """A value that is of the wrong kind, too long, too short, or not of the form wanted."""
    name, context = str(error["type"]), error.get("ctx") or {}
    if name in ("too_short", "too_long"):
        return _wrong_length(context, found)
    if name in _KINDS:
        expected, hint = _KINDS[name]
        return Wording("wrong-kind", f"expected {expected}, found {kind(found)}", hint)
    if name == "string_pattern_mismatch":
        return _wrong_form(context, found)
    if name in _BOUNDS:
        key, relation, direction = _BOUNDS[name]
        limit = context.get(key)
        message = f"{kind(found)} is {relation} the limit {limit}"
        return Wording("out-of-range", message, f"write {limit} or {direction}")
    return Wording("invalid-value", f"{kind(found)} cannot stand here", None)


def choice_hint(word: str, known: list[str], what: str) -> str | None:
    """'did you mean ...?' for a close word, else the list of known words where it is short."""
    close = nearest(word, known)
    if close:
        return f"did you mean {close}?"
    if known and len(known) <= _LONGEST_LIST:
        return f"known {what}: {', '.join(known)}"
    return None


def kind(node: Node | None) -> str:
    """What is written at a place, in words."""
    if isinstance(node, Scalar):
        return shown(node.text)
    if isinstance(node, Sequence):
        return "an empty list" if not node.items else f"a list of {len(node.items)}"
    if isinstance(node, Mapping):
        return "a mapping {key: value}" if node.entries else "an empty mapping"
    return "nothing"


def shown(text: str) -> str:
    """A text of the file as messages quote it: on one line, not too long."""
    text = re.sub(r"\s+", " ", text)
    return f"'{text if len(text) <= 40 else text[:37] + '...'}'"


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


def _wrong_length(context: dict[str, Any], found: Node | None) -> Wording:
    least, most = context.get("min_length"), context.get("max_length")
    count = len(found.items) if isinstance(found, Sequence) else context.get("actual_length")
    if isinstance(found, Mapping):
        count = len(found.entries)
    what = "entry" if count == 1 else "entries"
    limit = f"at least {least}" if most is None else f"at most {most}"
    is_vector = 3 in (least, most)
    hint = "a vector has three: [x, y, z]; with plane: xy two" if is_vector else None
    return Wording("wrong-length", f"found {count} {what}, expected {limit}", hint)


def _wrong_form(context: dict[str, Any], found: Node | None) -> Wording:
    expected = context.get("expected") or f"of the form {context.get('pattern')}"
    return Wording("wrong-form", f"{kind(found)} is not {expected}", context.get("hint"))


def _lower_first(text: str) -> str:
    # an abbreviation stays as it is: "CSV file"
    return text if text[1:2].isupper() else text[:1].lower() + text[1:]
