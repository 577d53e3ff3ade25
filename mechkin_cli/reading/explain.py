"""Errors of a validation -> diagnostics with file, line and column.

An error is a plain record: `type` (its kind), `loc` (the way to the value), `ctx` (numbers and
words for the message). Three conventions let a rule say more than where the validator stood:

- a step of `loc` in parentheses that is no key of the file names one of several forms;
- a last step `[key]` means the key itself and not its value;
- `ctx["at"]` leads on from `loc`, `ctx["text"]` is the whole message, `ctx["hint"]` what to do.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.nearest import nearest
from mechkin_cli.reading import wording
from mechkin_cli.reading.document import Document, KeyPath
from mechkin_cli.reading.nodes import Mapping, Scalar, Sequence
from mechkin_cli.reading.parser import in_order

_KEY = "[key]"


def explain(errors: Iterable[dict[str, Any]], document: Document) -> list[Diagnostic]:
    """One diagnostic per error, in the order of the file."""
    errors = list(errors)
    misspelt = _misspelt(errors)
    told = (
        _diagnostic(error, document)
        for error in errors
        if not _is_echo(error, document)
        and not (error["type"] == "missing" and tuple(error["loc"]) in misspelt)
    )
    return in_order(list(dict.fromkeys(told)))


def _misspelt(errors: list[dict[str, Any]]) -> set[tuple[str | int, ...]]:
    """The ways to keys that are missing only because they are misspelt, which is told."""
    found = set()
    for error in errors:
        if error["type"] == "extra_forbidden":
            *mapping, key = error["loc"]
            close = nearest(str(key), (error.get("ctx") or {}).get("known") or [])
            found.add((*mapping, close or ""))
    return found


def _is_echo(error: dict[str, Any], document: Document) -> bool:
    """Whether a list counts as too short only because items of it were refused for themselves."""
    if error["type"] != "too_short":
        return False
    node = document.node(_path(error["loc"], document))
    if isinstance(node, Scalar):
        return True  # it stands for a list of one
    if isinstance(node, Mapping):
        return bool(error["ctx"].get("field_type") != "Dictionary")  # so does this
    return isinstance(node, Sequence) and len(node.items) >= error["ctx"]["min_length"]


def _path(steps: Iterable[str | int], document: Document) -> KeyPath:
    """The steps without the names of forms, and without the number of an item where one value
    stands for a list; a key that somebody wrote in parentheses stays."""
    path: KeyPath = ()
    for step in steps:
        if isinstance(step, int) and isinstance(document.node(path), Scalar | Mapping):
            continue
        is_form = str(step).startswith("(") and document.node((*path, step)) is None
        path = path if is_form else (*path, step)
    return path


def _diagnostic(error: dict[str, Any], document: Document) -> Diagnostic:
    context = error.get("ctx") or {}
    path = _path([*error["loc"], *context.get("at", ())], document)
    kind = str(error["type"])
    if kind == "missing":
        words = wording.missing_key(str(path[-1]), context)
        return _told(words, path[:-1], document.place(path[:-1]))
    if kind == "extra_forbidden":
        words = wording.unknown_key(str(path[-1]), context)
        return _told(words, path[:-1], document.key_place(path))
    if kind in ("unknown-word", "literal_error"):
        return _unknown_word(kind, path, context, document)
    at_key = path[-1:] == (_KEY,)
    path = path[:-1] if at_key else path
    place = document.key_place(path) if at_key else document.place(path)
    if "text" in context:
        words = _own_words(kind, context, path, document)
    elif at_key:
        text = f"{wording.shown(str(path[-1]))} is not {context.get('expected', 'a key')}"
        words = wording.Wording("wrong-form", text, context.get("hint"))
    else:
        words = wording.wrong_value(error, document.node(path))
    return _told(words, path[:-1] if at_key else path, place)


def _unknown_word(
    kind: str, path: KeyPath, context: dict[str, Any], document: Document
) -> Diagnostic:
    if kind == "literal_error":
        known = re.findall(r"'([^']*)'", str(context.get("expected")))
    else:
        known = str(context["words"]).split(", ")
        if not _is_mapping(path, document):
            words = wording.wrong_value({"type": "model_type"}, document.node(path))
            return _told(words, path, document.place(path))
        key = str(context["key"])
        if document.node((*path, key)) is None:
            words = wording.missing_key(key, {"purpose": f"one of {', '.join(known)}"})
            return _told(words, path, document.place(path))
        path = (*path, key)
    words = wording.unknown_word(document.node(path), known, context.get("advice"))
    return _told(words, path, document.place(path))


def _is_mapping(path: KeyPath, document: Document) -> bool:
    return isinstance(document.node(path), Mapping)


def _own_words(
    code: str, context: dict[str, Any], path: KeyPath, document: Document
) -> wording.Wording:
    text = str(context["text"])
    if text.startswith("expected"):
        text += f", found {wording.kind(document.node(path))}"
    return wording.Wording(code, text, context.get("hint"))


def _told(words: wording.Wording, path: KeyPath, place: Place) -> Diagnostic:
    where = "".join(f"#{step + 1}" if isinstance(step, int) else f".{step}" for step in path)
    message = f"{where[1:]}: {words.message}" if where else words.message
    return Diagnostic(words.code, "error", message, place, hint=words.hint)


def is_study(document: Document) -> list[Diagnostic]:
    """One message where a mechanism is needed and the file is a study; none where it is not."""
    if not _begins(document, "study", "format"):
        return []
    text = "this is a study, and a mechanism file is needed"
    hint = f"run it with mechkin study {document.file}"
    named = document.data.get("mechanism")
    if isinstance(named, str):
        hint += f", or give its mechanism, {named}"
    return [Diagnostic("a-study", "error", text, document.place(("study",)), hint=hint)]


def is_mechanism(document: Document) -> list[Diagnostic]:
    """One message where a study is needed and the file is a mechanism; none where it is not."""
    if not _begins(document, "format", "study"):
        return []
    text = "this is a mechanism file, and a study is needed"
    hint = (
        "write study: 1, mechanism: FILE, vary: {NAME: [VALUES]} and keep: into a file of its own "
        f"(docs/studies.md), or run this one with mechkin analyze {document.file}"
    )
    return [Diagnostic("a-mechanism", "error", text, document.place(("format",)), hint=hint)]


def _begins(document: Document, key: str, other: str) -> bool:
    return key in document.data and other not in document.data
