"""What may stand at a key, in a few words, and the sections that lie below it."""

from __future__ import annotations

from typing import Any, NamedTuple

Schema = dict[str, Any]
MEASURED = ": a number in the file's units"


class Form(NamedTuple):
    """A mapping that may stand at a key, by the word or the keys that tell it from others."""

    named: str
    schema: Schema


class Definitions:
    """The named parts of a schema."""

    def __init__(self, schema: Schema) -> None:
        self.parts: dict[str, Schema] = schema["$defs"]

    def resolved(self, schema: Schema) -> Schema:
        """What a reference leads to; of what stands beside it only a description counts."""
        while "$ref" in schema:
            schema = self.parts[schema["$ref"].rpartition("/")[2]]
        return schema

    def kind(self, schema: Schema) -> str:
        """What may stand there: `length`, `3 numbers`, `one of a, b`."""
        found = self.resolved(schema)
        branches = _branches(found)
        if branches:
            words = dict.fromkeys(self.kind(branch) for branch in branches)
            return ", or ".join(words)
        if "const" in found:
            return f"`{found['const']}`"
        if "enum" in found:
            return ", ".join(f"`{word}`" for word in found["enum"])
        if MEASURED in found.get("description", ""):
            return str(found["description"]).partition(MEASURED)[0]
        kinds = {"array": self._list, "object": self._mapping, "integer": _whole}
        if isinstance(found.get("type"), str) and found["type"] in kinds:
            return kinds[found["type"]](found)
        if found.get("type") == "boolean":
            return "`true`, `false`"
        words = str(found["description"]).partition(":")[0]
        return {"a text for people": "text"}.get(words, words.removeprefix("a "))

    def forms(self, schema: Schema) -> list[Form]:
        """The mappings with keys of their own that may stand there, or in a list or mapping."""
        found = self.resolved(schema)
        if "properties" in found and "allOf" not in found:
            return [Form("", found)]
        if "items" in found:
            return self.forms(found["items"])
        if "patternProperties" in found:
            return [
                one for inner in found["patternProperties"].values() for one in self.forms(inner)
            ]
        sections = [one.schema for branch in _branches(found) for one in self.forms(branch)]
        if not sections and found.get("properties"):
            return [Form("", found)]
        different = [one for k, one in enumerate(sections) if one not in sections[:k]]
        if len(different) == 1:
            return [Form("", different[0])]
        return [Form(_told_by(one, different), one) for one in different]

    def _list(self, found: Schema) -> str:
        one = self.kind(found["items"])
        least, most = found.get("minItems"), found.get("maxItems")
        if least == most and least is not None:
            return f"list of {least}: {one}"
        return f"list: {one}"

    def _mapping(self, found: Schema) -> str:
        if "patternProperties" not in found:
            return "mapping"
        (inner,) = found["patternProperties"].values()
        of = "links" if found.get("maxProperties") == 2 else "names"
        return f"mapping from {of}: {self.kind(inner)}"


def _branches(found: Schema) -> list[Schema]:
    """The alternatives of a place, however it is decided between them."""
    if "anyOf" in found and "properties" not in found:
        return list(found["anyOf"])
    if "if" in found and "properties" not in found:
        return [b for key in ("then", "else") if key in found for b in _flat(found[key])]
    if "allOf" in found and all("if" in rule for rule in found["allOf"]):
        inner = [r[key] for r in found["allOf"] for key in ("then", "else") if key in r]
        return [b for one in inner for b in _flat(one)]
    return []


def _flat(schema: Schema) -> list[Schema]:
    return _branches(schema) or [schema]


def _whole(found: Schema) -> str:
    least, most = found.get("minimum"), found.get("maximum")
    if least is None:
        return "whole number"
    return f"whole number from {least}" + ("" if most is None else f" to {most}")


def _told_by(form: Schema, others: list[Schema]) -> str:
    """By its word at `type` or `law`, and where others have the same by a key that they lack."""
    words = {key: _word(form, key) for key in ("type", "law")}
    same = [one for one in others if all(_word(one, key) == words[key] for key in words)]
    own = [key for key in form["required"] if not any(_needs(one, key, form) for one in same)]
    told = [f"{word}" for word in words.values() if word]
    if len(same) > 1:
        told.append(f"with `{own[0]}`" if told else f"`{own[0]}`")
        return " ".join([*(f"`{word}`" for word in told[:-1]), told[-1]])
    return f"`{told[0]}`" if told else ""


def _needs(other: Schema, key: str, form: Schema) -> bool:
    return other is not form and key in other["properties"]


def _word(form: Schema, key: str) -> str | None:
    word = form.get("properties", {}).get(key, {}).get("const")
    return str(word) if word is not None else None
