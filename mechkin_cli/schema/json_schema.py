"""The JSON Schemas of mechanism files and of studies, for editors: completion, help texts, checks.

Read from the same annotations as the validator, in a fixed order of keys, with help texts from the
sources of the sections and names as patterns. Fixed-length lists are `items` with `minItems` and
`maxItems`, which every editor understands; null, which no file may hold, does not occur.
"""

from __future__ import annotations

import inspect
import json
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

from mechkin_cli.schema.alternatives import Choice
from mechkin_cli.schema.base import Section, fields_of
from mechkin_cli.schema.decisions import decided
from mechkin_cli.schema.descriptions import field_descriptions
from mechkin_cli.schema.examples import BY_KEY, own_example
from mechkin_cli.schema.file import AnyFile, MechanismFile
from mechkin_cli.schema.names import RESERVED
from mechkin_cli.schema.plane import PlaneFile
from mechkin_cli.schema.rules import Barred, Dimension, Limits, Named, ShortForm, Shown
from mechkin_cli.schema.runs import TAKEN_FOR_EDITORS

IDENTITY: Final = "urn:mechkin:schema:mechanism:1"
"""The name of the schema of format 1, wherever its file lies."""

STUDY_IDENTITY: Final = "urn:mechkin:schema:study:1"
"""The name of the schema of studies."""

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_FIRST_KEYS = (
    "$schema",
    "$id",
    "title",
    "description",
    "$ref",
    "type",
    "const",
    "enum",
    "required",
)
_NAMED_SECTIONS = ("parameters", "links", "joints", "points", "directions")
_BY_NAME = ("properties", "patternProperties", "$defs")
_JSON_TYPES = {str: "string", int: "integer"}
# JSON Schema has no flag for ignoring case
_NOT_A_NUMBER = r"^[+-]?\.?([Nn][Aa][Nn]|[Ii][Nn][Ff]([Ii][Nn][Ii][Tt][Yy])?)$"

_MEASURED = ": a number in the file's units"

Schema = dict[str, Any]


def json_schema() -> Schema:
    """The JSON Schema (draft 2020-12) of a mechanism file as plain data in a stable order.

    It cannot say what crosses sections: one namespace for all names, tables and labels that differ,
    places per link that name the joint's own links, laws that need `time`.
    """
    definitions: Schema = {"ReservedName": {"enum": sorted(RESERVED)}}
    space, plane = (_file(form, definitions) for form in (MechanismFile, PlaneFile))
    space["anyOf"] = [_non_empty("joints", "minProperties"), _non_empty("chain", "minItems")]
    plane["anyOf"] = [_non_empty("joints", "minProperties")]
    # offered while writing; where it stands the other form is meant
    space["properties"]["plane"] = plane["properties"]["plane"]
    definitions |= {form.__name__: s for form, s in ((MechanismFile, space), (PlaneFile, plane))}
    top: Schema = {"$schema": DIALECT, "$id": IDENTITY, "title": "mechkin mechanism file, format 1"}
    top |= {
        "description": "A mechanism in space, or with `plane: xy` in a plane.",
        "if": {"required": ["plane"]},
        "then": {"$ref": f"#/$defs/{PlaneFile.__name__}"},
        "else": {"$ref": f"#/$defs/{MechanismFile.__name__}"},
    }
    return _whole(top, definitions)


def study_schema() -> Schema:
    """The JSON Schema of a study file, as `json_schema` that of a mechanism file.

    It cannot say what the mechanism has, nor that something varies and what is drawn is counted.
    """
    from mechkin_cli.schema.study import StudyFile

    definitions: Schema = {}
    top: Schema = {"$schema": DIALECT, "$id": STUDY_IDENTITY, "title": "mechkin study file, form 1"}
    return _whole(top | _section(StudyFile, definitions), definitions)


SCHEMAS: Final = {"mechanism": json_schema, "study": study_schema}
"""By the names of the files `schemas/NAME.schema.json`."""


def json_schema_text(name: str = "mechanism") -> str:
    """A JSON Schema as the text of its file."""
    return json.dumps(SCHEMAS[name](), indent=2, ensure_ascii=False) + "\n"


def _whole(top: Schema, definitions: Schema) -> Schema:
    """The schema and its definitions in a stable order."""
    ordered = _ordered(dict(sorted(definitions.items())), True)
    return dict(_ordered(top)) | {"$defs": ordered}


def _file(form: type[AnyFile], definitions: Schema) -> Schema:
    """One form of the file, with the rules for its names."""
    found = _section(form, definitions)
    for name in _NAMED_SECTIONS:
        reserved = {"not": {"$ref": "#/$defs/ReservedName"}}
        found["properties"][name]["propertyNames"] = reserved
    barred = {"not": {"pattern": TAKEN_FOR_EDITORS}}
    found["properties"]["responses"]["propertyNames"] = barred
    return found


def _non_empty(key: str, least: str) -> Schema:
    return {"required": [key], "properties": {key: {least: 1}}}


def _section(section: type[Section], definitions: Schema) -> Schema:
    """The mapping that a section is."""
    texts = field_descriptions(section)
    properties: Schema = {}
    required = []
    for key, field in fields_of(section).items():
        schema = _value(field.annotation, definitions)
        if field.name in texts:
            measure = _measure(schema, definitions)
            of_what = f" Unit: that of {measure}, the file's or its own." if measure else ""
            schema["description"] = texts[field.name] + of_what
        elif "const" in schema:
            schema["description"] = _paragraphs(section)[0]
        if field.required:
            required.append(key)
        elif isinstance(field.default, (str, int)):
            schema["default"] = field.default
        own = own_example(section.__name__, key)
        if own is None and not has_example(schema, definitions):
            own = BY_KEY.get(key)
        if own is not None:
            schema = schema | {"examples": [own]}
        properties[key] = schema
    words = "\n\n".join(_paragraphs(section))
    found = {"description": words, "type": "object", "additionalProperties": False}
    found |= {"properties": properties} | ({"required": required} if required else {})
    return found | section.editors


def _measure(schema: Schema, definitions: Schema) -> str | None:
    """What a number, or each number of a list, measures; None where it is no measured number."""
    while "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    if "if" in schema:
        forms = (schema[form] for form in ("then", "else") if form in schema)
        return next((found for form in forms if (found := _measure(form, definitions))), None)
    if "items" in schema:
        return _measure(schema["items"], definitions)
    name, mark, _ = str(schema.get("description", "")).partition(_MEASURED)
    return name if mark and not name.startswith(("dimensionless", "any")) else None


def _paragraphs(section: type[Section]) -> list[str]:
    """What the section is, in words."""
    paragraphs = inspect.cleandoc(section.__doc__ or "").split("\n\n")
    return [text.replace("\n", " ") for text in paragraphs]


def has_example(schema: Schema, definitions: Schema) -> bool:
    """Whether an editor has something to show for a value: an example, or the words it may be."""
    while not schema.keys() & {"examples", "enum", "const", "default"}:
        if "$ref" not in schema:
            return any(
                has_example(schema[form], definitions)
                for form in ("then", "else")
                if form in schema
            )
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    return True


def _value(annotation: Any, definitions: Schema) -> Schema:
    """What may stand at a place; what has a name goes to `definitions` and is referred to."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        name = annotation.__name__
        if name not in definitions:
            definitions[name] = {}  # a place for sections that hold one another
            definitions[name] = _section(annotation, definitions)
        return {"$ref": f"#/$defs/{name}"}
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _with_rules(arguments[0], arguments[1:], definitions)
    if origin in (Union, UnionType):
        members = [_value(m, definitions) for m in arguments if m is not NoneType]
        return members[0] if len(members) == 1 else {"oneOf": members}
    if origin is Literal:
        words = {"const": arguments[0]} if len(arguments) == 1 else {"enum": list(arguments)}
        return {"type": _JSON_TYPES[type(arguments[0])]} | words
    if origin is tuple:
        return {"type": "array", "items": _value(arguments[0], definitions)}
    if origin is dict:
        key, value = (_value(argument, definitions) for argument in arguments)
        pattern = definitions[key["$ref"].rpartition("/")[2]]["pattern"]
        closed = {"additionalProperties": False, "patternProperties": {pattern: value}}
        return {"type": "object"} | closed
    return {"type": _JSON_TYPES[annotation]}


def _with_rules(inner: Any, rules: tuple[Any, ...], definitions: Schema) -> Schema:
    choice = next((rule for rule in rules if isinstance(rule, Choice)), None)
    if choice is None:
        schema = _value(inner, definitions)
    else:
        forms = [_value(member, definitions) for member in get_args(inner)]
        schema = decided(forms, choice.key, definitions)
    for rule in rules:
        if isinstance(rule, Named):
            definitions[rule.name] = schema
            schema = {"$ref": f"#/$defs/{rule.name}"}
        elif isinstance(rule, Limits):
            schema |= _limits(rule, schema)
        elif isinstance(rule, Shown):
            schema |= _shown(rule)
        elif isinstance(rule, Dimension):
            schema |= _dimension(rule)
        elif isinstance(rule, Barred):
            schema |= {"not": {"pattern": rule.pattern}}
        elif isinstance(rule, ShortForm):
            schema = {"anyOf": [_short_form(rule), schema]}
    return schema


def _limits(limits: Limits, schema: Schema) -> Schema:
    of = {"array": "Items", "object": "Properties"}.get(schema["type"], "Length")
    words = {
        f"min{of}": limits.min_length,
        f"max{of}": limits.max_length,
        "minimum": limits.ge,
        "maximum": limits.le,
        "pattern": limits.pattern,
    }
    return {word: value for word, value in words.items() if value is not None}


def _shown(rule: Shown) -> Schema:
    shown = {"type": _types(rule.types), "description": rule.description}
    return shown | ({"examples": list(rule.examples)} if rule.examples else {})


def _dimension(rule: Dimension) -> Schema:
    text = f"{rule.name}{_MEASURED}, a number with its unit, or an expression of parameters"
    not_finite = {"type": "string", "pattern": _NOT_A_NUMBER}
    shown = _shown(Shown(("number", "string"), text, rule.examples))
    return shown | {"minLength": 1, "not": not_finite}


def _short_form(rule: ShortForm) -> Schema:
    form = {"type": _types(rule.types), "description": rule.description}
    return form | ({"pattern": rule.pattern} if rule.pattern else {})


def _types(names: tuple[str, ...]) -> str | list[str]:
    return names[0] if len(names) == 1 else list(names)


def _ordered(schema: Any, by_name: bool = False) -> Any:
    """The schema with its keys in order; where `by_name`, keys are names and keep theirs."""
    if isinstance(schema, list):
        return [_ordered(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    if by_name:
        return {name: _ordered(value) for name, value in schema.items()}
    first = [key for key in _FIRST_KEYS if key in schema]
    rest = sorted(schema.keys() - set(first))
    return {key: _ordered(schema[key], key in _BY_NAME) for key in [*first, *rest]}
