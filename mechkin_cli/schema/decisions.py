"""Which of several forms an editor holds a value against: decided by one look, as the reader does.

A list of alternatives (`oneOf`) leaves editors to guess which one was meant, and their messages are
those of the wrong one. So forms are told apart by `if`: by the kind of the value, by the word that
stands at a key (`type`, `law`), or by a key that only one form has. Where nothing decides yet, as
while a mapping is being typed, all forms are offered.
"""

from __future__ import annotations

from typing import Any

Schema = dict[str, Any]


def decided(forms: list[Schema], key: str | None, definitions: Schema) -> Schema:
    """The schema that chooses among forms; `key` holds the word that tells them apart, if any."""
    if key is not None:
        return _by_word(forms, key, definitions)
    groups: dict[frozenset[str], list[Schema]] = {}
    for form in forms:
        groups.setdefault(frozenset(_kinds(form, definitions)), []).append(form)
    kinds = list(groups)
    if sum(map(len, kinds)) == len(frozenset().union(*kinds)):
        return _by_kind([_by_key(group, definitions) for group in groups.values()], kinds)
    return _by_key(forms, definitions)


def _by_kind(forms: list[Schema], kinds: list[frozenset[str]]) -> Schema:
    """By the JSON type of the value; all types that none has go to the last form."""
    (*others, last) = forms
    schema = last
    for form, kind in zip(reversed(others), reversed(kinds[:-1]), strict=True):
        names = sorted(kind)
        condition = {"type": names[0] if len(names) == 1 else names}
        schema = {"if": condition, "then": form, "else": schema}
    return schema


def _by_word(forms: list[Schema], key: str, definitions: Schema) -> Schema:
    groups: dict[str | None, list[Schema]] = {}
    for form in forms:
        for word in _words(form, key, definitions):
            groups.setdefault(word, []).append(form)
    words = [word for word in groups if word is not None]
    without = groups.get(None)
    rules = [
        {
            "if": {"required": [key], "properties": {key: {"const": word}}},
            "then": _by_key(groups[word], definitions),
        }
        for word in words
    ]
    schema: Schema = {
        "type": "object",
        "properties": {key: _choice(key, words, forms, definitions)},
    }
    if without is None:
        return schema | {"required": [key], "allOf": rules}
    rules.append({"if": {"required": [key]}, "else": _by_key(without, definitions)})
    return schema | {"allOf": rules}


def _choice(key: str, words: list[str], forms: list[Schema], definitions: Schema) -> Schema:
    """The key that decides, with what each of its words means."""
    described: dict[str | None, str] = {}
    for form in forms:
        for word in _words(form, key, definitions):
            described.setdefault(word, _resolved(form, definitions).get("description", ""))
    said = "; ".join(str(described[word]).partition("\n")[0].rstrip(".") for word in words)
    return {"type": "string", "enum": words, "description": f"{said}."}


def _by_key(forms: list[Schema], definitions: Schema) -> Schema:
    """By a key that one form needs and no other has."""
    if len(forms) == 1:
        return forms[0]
    known = [_resolved(form, definitions) for form in forms]
    schema: Schema = {"anyOf": forms}
    for number in reversed(range(len(forms))):
        others = {
            name
            for place, other in enumerate(known)
            if place != number
            for name in other.get("properties", {})
        }
        own = [name for name in known[number].get("required", []) if name not in others]
        if own:
            needed = [{"required": [name]} for name in own]
            condition = needed[0] if len(needed) == 1 else {"anyOf": needed}
            schema = {"if": condition, "then": forms[number], "else": schema}
    return schema


def _words(form: Schema, key: str, definitions: Schema) -> list[str | None]:
    """The words of a form at a key; None where it does not need the key."""
    found = _resolved(form, definitions)
    if key not in found.get("required", []):
        return [None]
    word = found["properties"][key]
    return [word["const"]] if "const" in word else list(word["enum"])


def _kinds(form: Schema, definitions: Schema) -> list[str]:
    found = _resolved(form, definitions)
    if "if" in found or "type" not in found:
        return []
    kinds = found["type"]
    return [kinds] if isinstance(kinds, str) else list(kinds)


def _resolved(form: Schema, definitions: Schema) -> Schema:
    """The schema that a reference leads to."""
    while "$ref" in form:
        form = definitions[form["$ref"].rpartition("/")[2]]
    return form
