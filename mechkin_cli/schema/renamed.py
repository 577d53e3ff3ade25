"""Keys that were called otherwise in an earlier version: read as the new ones, with a warning.

A section names them in `renamed`. A file is brought up to date before it is checked, so that all
that follows knows the new keys alone; places stay those of what is written. Where no section that
is loaded has such a key, as in most versions, nothing is looked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.reading import Document, KeyPath, Mapping, Node, Sequence, plain_data
from mechkin_cli.record import replace
from mechkin_cli.schema.base import OLD_KEYS, FormChoice, Renamed, Section, fields_of, tagged


def up_to_date(form: type[Section], document: Document) -> Document:
    """The document with the keys of today; its `notes` have a warning for each that was renamed,
    and an error where the old and the new one are both there."""
    if not OLD_KEYS or document.notes or not OLD_KEYS & {*_keys(document.root)}:
        return document
    notes: list[Diagnostic] = []
    root = _renamed(form, document.root, (), document, notes)
    assert isinstance(root, Mapping)
    return replace(document, root=root, notes=tuple(notes))


def _note(key: str, word: Renamed, place: Place, is_double: bool) -> Diagnostic:
    if is_double:
        text = f"'{key}' is the old name of '{word.new}', and both are there"
        return Diagnostic("renamed-key", "error", text, place, hint=f"keep {word.new}:")
    text = f"the key '{key}' is called '{word.new}' since mechkin {word.since}"
    hint = f"write {word.new}: before mechkin {word.until}, which refuses {key}:"
    return Diagnostic("renamed-key", "warning", text, place, hint=hint)


def with_old_keys(section: type[Section], schema: dict[str, Any]) -> dict[str, Any]:
    """The JSON Schema of a section that takes its old keys, too, marked as deprecated."""
    properties, needed = dict(schema["properties"]), set(schema.get("required", ()))
    either: list[dict[str, Any]] = []
    for old, word in section.renamed.items():
        text = f"Deprecated since {word.since}: write `{word.new}`. {word.until} refuses it."
        properties[old] = properties[word.new] | {"description": text, "deprecated": True}
        if word.new in needed:
            needed.remove(word.new)
            either.append({"anyOf": [{"required": [word.new]}, {"required": [old]}]})
        either.append({"not": {"required": [word.new, old]}})
    changed = schema | {"properties": properties, "required": sorted(needed)}
    if "dependentRequired" in schema:  # the program itself sees which of the two is missing
        news = {word.new for word in section.renamed.values()}
        depends = schema["dependentRequired"].items()
        kept = {key: [one for one in others if one not in news] for key, others in depends}
        changed["dependentRequired"] = kept
    return changed | ({"allOf": [*schema.get("allOf", ()), *either]} if either else {})


def _keys(node: Node) -> Iterator[str]:
    waiting = [node]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Mapping):
            yield from node.entries
            waiting += [value for _, value in node.entries.values()]
        elif isinstance(node, Sequence):
            waiting += node.items


def _renamed(
    annotation: Any, node: Node, path: KeyPath, document: Document, notes: list[Diagnostic]
) -> Node:
    """The node with the keys of today; as deep as an annotation leads, which is not far."""
    section, inner = _form(annotation, node)
    if isinstance(node, Sequence) and inner is not None:
        items = enumerate(node.items)
        new = (_renamed(inner, item, (*path, i), document, notes) for i, item in items)
        return node._replace(items=tuple(new))
    if not isinstance(node, Mapping) or (section is None and inner is None):
        return node
    entries = {}
    renamed = {} if section is None else section.renamed
    fields = {} if section is None else fields_of(section)
    for key, (mark, value) in node.entries.items():
        name = key
        if word := renamed.get(key):
            name, is_double = word.new, word.new in node.entries
            notes.append(_note(key, word, document.key_place((*path, key)), is_double))
            if is_double:
                continue
        of_value = fields[name].annotation if name in fields else inner
        entries[name] = mark, _renamed(of_value, value, (*path, key), document, notes)
    return node._replace(entries=entries)


def _form(annotation: Any, node: Node) -> tuple[type[Section] | None, Any]:
    """The section that a node is read as, or else what its values or items are; None: neither."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        inner, *rules = arguments
        choice = next((rule for rule in rules if isinstance(rule, FormChoice)), None)
        if choice is None:
            return _form(inner, node)
        tag = choice.choose(plain_data(node))
        forms = (one for one in get_args(inner) if tagged(one)[0] == tag)
        return _form(next(forms, None), node)
    if origin in (Union, UnionType):
        found = (_form(one, node) for one in arguments)
        return next((form for form in found if form != (None, None)), (None, None))
    if (
        isinstance(node, Mapping)
        and isinstance(annotation, type)
        and issubclass(annotation, Section)
    ):
        return annotation, None
    if isinstance(node, Mapping) and origin is dict:
        return None, arguments[1]
    return None, arguments[0] if isinstance(node, Sequence) and origin is tuple else None
