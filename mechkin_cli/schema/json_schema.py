"""The JSON Schema of format 1, for editors: completion, help texts and checks while writing.

Derived from the models, then put into one form that doesn't depend on the version of pydantic: keys
in a fixed order, help texts from the models' sources, names as patterns. Fixed-length lists are
`items` with `minItems` and `maxItems`, which every editor understands.
"""

import json
from typing import Any, Final

from mechkin_cli.schema.base import Section
from mechkin_cli.schema.descriptions import field_descriptions
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.schema.names import RESERVED

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_FIRST_KEYS = ("description", "$ref", "type", "const", "enum", "required")
_NAMED_SECTIONS = ("parameters", "links", "joints", "points", "directions")
_RENAMED = {"ge": "minimum", "le": "maximum"}
_BY_NAME = ("properties", "patternProperties", "$defs")


def json_schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a mechanism file as plain data in a stable order.

    It cannot say what crosses sections: one namespace for all names, tables and labels that differ,
    places per link that name the joint's own links, laws that need `time`.
    """
    raw = MechanismFile.model_json_schema(by_alias=True, mode="validation")
    definitions = raw["$defs"]
    for section in _subclasses(Section):
        target = raw if section is MechanismFile else definitions.get(section.__name__)
        if target is not None:
            _describe(target, section)
    definitions["ReservedName"] = {"enum": sorted(RESERVED)}
    raw["$defs"] = dict(sorted(definitions.items()))
    for name in _NAMED_SECTIONS:
        raw["properties"][name]["propertyNames"]["not"] = {"$ref": "#/$defs/ReservedName"}
    raw["anyOf"] = [_non_empty("joints", "minProperties"), _non_empty("chain", "minItems")]
    top = {"$schema": DIALECT, "title": "mechkin mechanism file, format 1"}
    return top | dict(_normalised(raw, definitions))


def json_schema_text() -> str:
    """The JSON Schema as the text of `schemas/mechanism.schema.json`."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"


def _non_empty(key: str, least: str) -> dict[str, Any]:
    return {"required": [key], "properties": {key: {least: 1}}}


def _subclasses(model: type[Section]) -> list[type[Section]]:
    return [deeper for child in model.__subclasses__() for deeper in (child, *_subclasses(child))]


def _describe(schema: dict[str, Any], section: type[Section]) -> None:
    texts = field_descriptions(section)
    for name, field in section.model_fields.items():
        if name in texts:
            schema["properties"][field.alias or name]["description"] = texts[name]


def _normalised(schema: Any, definitions: dict[str, Any], by_name: bool = False) -> Any:
    """The schema in the project's form; where `by_name`, keys are names and keep their order."""
    if isinstance(schema, list):
        return [_normalised(item, definitions) for item in schema]
    if not isinstance(schema, dict):
        return schema
    if by_name:
        return {name: _normalised(value, definitions) for name, value in schema.items()}
    schema = _cleaned(schema)
    _names_as_patterns(schema, definitions)
    first = [key for key in _FIRST_KEYS if key in schema]
    rest = sorted(schema.keys() - set(first) - {"$defs"})
    keys = [*first, *rest, *(["$defs"] if "$defs" in schema else [])]
    return {key: _normalised(schema[key], definitions, key in _BY_NAME) for key in keys}


def _cleaned(schema: dict[str, Any]) -> dict[str, Any]:
    """Without what pydantic derives from Python names, and without null, which no file may hold."""
    alternatives = [item for item in schema.get("anyOf", []) if item != {"type": "null"}]
    if len(alternatives) == 1:
        schema = alternatives[0] | schema
    cleaned = {_RENAMED.get(key, key): value for key, value in schema.items() if key != "title"}
    cleaned.pop("anyOf", None)
    if len(alternatives) > 1:
        cleaned["anyOf"] = alternatives
    if not isinstance(cleaned.get("default"), (str, int)):
        cleaned.pop("default", None)
    if "description" in cleaned:
        paragraphs = cleaned["description"].split("\n\n")
        cleaned["description"] = "\n\n".join(text.replace("\n", " ") for text in paragraphs)
    return cleaned


def _names_as_patterns(schema: dict[str, Any], definitions: dict[str, Any]) -> None:
    """Turn `propertyNames: {$ref: ...}` into the pattern it stands for."""
    names = schema.get("propertyNames", {})
    if "$ref" in names:
        pattern = definitions[names["$ref"].rpartition("/")[2]]["pattern"]
        schema["patternProperties"] = {pattern: schema.pop("additionalProperties")}
        schema["additionalProperties"] = False
        rest = {key: value for key, value in names.items() if key != "$ref"}
        schema.pop("propertyNames")
        if rest:
            schema["propertyNames"] = rest
