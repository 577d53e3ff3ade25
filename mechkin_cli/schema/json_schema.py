"""The JSON Schemas of mechanism files and of studies, for editors: completion, help texts, checks.

Read from the same annotations as the validator, in a fixed order of keys, with help texts from the
sources of the sections and names as patterns. Fixed-length lists are `items` with `minItems` and
`maxItems`, which every editor understands; null, which no file may hold, does not occur.

A list of alternatives (`oneOf`) leaves editors to guess which one was meant, and their messages are
those of the wrong one. So forms are decided by `if`, as the reader decides them: by the kind of the
value, by the word at a key (`type`, `law`), or by a key that only one form has. Where nothing
decides yet, as while a mapping is being typed, all forms are offered.
"""

from __future__ import annotations

import inspect
import json
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

from mechkin_cli.schema.base import (
    DimensionRule,
    FormChoice,
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    field_descriptions,
    fields_of,
)
from mechkin_cli.schema.curves import EXAMPLES
from mechkin_cli.schema.file import AnyFile, MechanismFile
from mechkin_cli.schema.loads import EXAMPLES_OF_LOADS
from mechkin_cli.schema.plane import PlaneFile
from mechkin_cli.schema.renamed import with_old_keys
from mechkin_cli.schema.responses import EXAMPLES_BY_KEY, EXAMPLES_OF_EQUILIBRIA
from mechkin_cli.schema.scalars import TAKEN_FOR_EDITORS
from mechkin_cli.schema.study import StudyFile
from mechkin_cli.schema.validation import RESERVED

Schema = dict[str, Any]


def decided(forms: list[Schema], key: str | None, definitions: Schema) -> Schema:
    """The schema that chooses among forms; `key` holds the word that decides, if any."""
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
    """By the JSON type of the value; types of no form go to the last one."""
    (*others, schema) = forms
    for form, kind in zip(reversed(others), reversed(kinds[:-1]), strict=True):
        schema = {"if": {"type": _types(tuple(sorted(kind)))}, "then": form, "else": schema}
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
    # the key that decides, with the meaning of each of its words
    described: dict[str | None, str] = {}
    for form in forms:
        for name in _words(form, key, definitions):
            described.setdefault(name, _resolved(form, definitions).get("description", ""))
    meanings = "; ".join(str(described[word]).partition("\n")[0].rstrip(".") for word in words)
    choice = {"type": "string", "enum": words, "description": f"{meanings}."}
    schema: Schema = {"type": "object", "properties": {key: choice}}
    if without is None:
        return schema | {"required": [key], "allOf": rules}
    rules.append({"if": {"required": [key]}, "else": _by_key(without, definitions)})
    return schema | {"allOf": rules}


def _by_key(forms: list[Schema], definitions: Schema) -> Schema:
    """By a key that one form needs and no other has."""
    if len(forms) == 1:
        return forms[0]
    resolved = [_resolved(form, definitions) for form in forms]
    schema: Schema = {"anyOf": forms}
    for number in reversed(range(len(forms))):
        others = {
            name
            for place, other in enumerate(resolved)
            if place != number
            for name in other.get("properties", {})
        }
        own = [name for name in resolved[number].get("required", []) if name not in others]
        if own:
            needed = [{"required": [name]} for name in own]
            condition = needed[0] if len(needed) == 1 else {"anyOf": needed}
            schema = {"if": condition, "then": forms[number], "else": schema}
    return schema


def _words(form: Schema, key: str, definitions: Schema) -> list[str | None]:
    """The words of a form at a key; None where it does not need the key."""
    resolved = _resolved(form, definitions)
    if key not in resolved.get("required", []):
        return [None]
    word = resolved["properties"][key]
    return [word["const"]] if "const" in word else list(word["enum"])


def _kinds(form: Schema, definitions: Schema) -> list[str]:
    resolved = _resolved(form, definitions)
    if "if" in resolved or "type" not in resolved:
        return []
    kinds = resolved["type"]
    return [kinds] if isinstance(kinds, str) else list(kinds)


def _resolved(form: Schema, definitions: Schema) -> Schema:
    while "$ref" in form:
        form = definitions[form["$ref"].rpartition("/")[2]]
    return form


# An example for editors of every key whose kind of value has none of its own: by the key, or by
# section and key where sections mean different things by one key.

_R: Final = {"type": "R", "links": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]}
_TURN: Final = {"from": 0, "to": 360, "step": 5, "rate": "10 rad/s"}

BY_KEY: Final[dict[str, Any]] = {
    **EXAMPLES_BY_KEY,
    "accept": ["unphysical-inertia"],
    "actuators": ["leg1.s", "leg2.s"],
    "across": [0, 0, 1],
    "along": {"O3": ["B", "C"]},
    "assembly": {"near": {"O4.theta": 37}},
    "axes": {"x": [1, 0, 0], "y": [0, 1, 0]},
    "axis": [0, 0, 1],
    "axis2": [0, 1, 0],
    "balances": [{"name": "work", "type": "work"}],
    "between": ["P", "Q"],
    "camera": [1, -2, 1],
    "chain": [
        {"joint": "A", "type": "R", "link": "one", "theta": 0, "s": 0, "alpha": 40, "a": 1},
        {"joint": "B", "type": "R", "link": "ground", "theta": 0, "s": 0, "alpha": -40, "a": 1},
    ],
    "coefficients": [{"name": "system", "row": 1}],
    "colours": {"crank": "#c0392b"},
    "columns": ["O1.theta", {"label": "torque", "value": "O1.effort", "decimals": 2}],
    "count": 73,
    "counted": 24,
    "couplings": {"K": {"type": "gear", "joints": ["A", "B"], "teeth": [20, 40]}},
    "data": ["m2"],
    "decimals": 3,
    "direction": [0, -1, 0],
    "directions": {"d": {"link": "crank", "vector": [1, 0, 0]}},
    "driven": {"A.theta": {"at": "30 deg"}},
    "efforts": {"A.theta": "8 N*m - 0.4 N*m*s/rad*A.theta_dot"},
    "equations": ["crank", "rocker", "-O1"],
    "follow": ["O1"],
    "follower": {"type": "translating", "contact": "flat", "base_radius": "40 mm"},
    "force": [0, 0, "-10 N"],
    "groove": [1, 0, 0],
    "hidden": ["frame"],
    "inertia": {"xx": "2 kg*mm^2", "yy": 20, "zz": 20},
    "inputs": {"O1.theta": _TURN},
    "joints": {"O1": _R},
    "label": "theta [of the crank]",
    "links": ["ground", "crank"],
    "loads": [{"type": "gravity", "g": "standard"}],
    "mode": "A",
    "motion": {"inputs": {"O1.theta": _TURN}},
    "name": "RSSR with a long coupler",
    "near": {"O4.theta": 37},
    "normal": [0, 0, 1],
    "of": ["ground.shaking_force"],
    "orders": [0, 1, 2, 4],
    "over": "O1.theta_dot",
    "parameters": {"r": "40 mm", "k": "2 N/mm"},
    "paths": ["coupler_point"],
    "pin": [1, 0, 0],
    "plot": {"x": "theta", "y": ["torque"]},
    "cylinders": {"C": {"from": "P", "to": "Q", "stroke": ["0.6 m", "1 m"]}},
    "limits": {"A.theta": ["-30 deg", "60 deg"], "S.s": {"max": "200 mm"}},
    "points": {"P": {"link": "crank", "at": ["r", 0, 0]}},
    "published": "published/table_3.csv",
    "quantities": {"gap": "norm(P.position - Q.position)"},
    "remarks": [{"text": "The source rounds to six digits."}],
    "responses": {"fall": {"start": {"A.theta": 80}, "time": {"from": 0, "to": 3, "step": 0.1}}},
    "radii": ["20 mm", "40 mm"],
    "rows_by": "theta",
    "runs": ["sweep", "fall"],
    "shapes": {"coupler": "plate"},
    "slot": [0, 0, 1],
    "source": "A textbook, page 12",
    "start": {"A.theta": "80 deg", "A.theta_dot": "0 rad/s"},
    "stop": [{"turns": "A.theta", "count": 3}],
    "summary": ["max", "min", "rms"],
    "sum": "10 deg",
    "tables": [{"name": "drive", "columns": ["O1.theta", "O1.effort"]}],
    "teeth": [20, 40],
    "terms": {"A.theta": 1, "B.theta": 2},
    "text": "The source rounds to six digits.",
    "time": {"from": 0, "to": "2 s", "step": 0.1},
    "title": "Torque of the motor",
    "torque": [0, 0, "5 N*m"],
    "units": {"length": "mm", "angle": "deg", "mass": "kg", "force": "N"},
    "unknowns": ["O1.F", "O1.M", "-O1.FA"],
    "values": [0, 15, "40 deg"],
    "vector": [1, 0, 0],
    "view": {"hidden": ["frame"]},
    "x": [1, 0, 0],
    "y": [0, 1, 0],
    "zero": {"ground": [1, 0, 0], "crank": [0, 1, 0]},
}

BY_SECTION: Final[dict[tuple[str, str], Any]] = {
    **EXAMPLES_OF_LOADS,
    ("Kept", "as"): ["peak", "rms"],
    ("MotionSection", "grid"): True,
    **EXAMPLES_OF_EQUILIBRIA,
    ("Column", "value"): "norm(O1.force)",
    ("Cylinder", "bore"): "50 mm",
    ("Cylinder", "from"): "P",
    ("Cylinder", "rod"): "28 mm",
    ("Cylinder", "stroke"): ["0.6 m", "1 m"],
    ("Cylinder", "to"): "Q",
    ("LimitSection", "restitution"): 0.6,
    **{
        (kind, key): value
        for kind in (
            *("GearCoupling", "RackCoupling", "ChainCoupling", "ScrewCoupling", "LinearCoupling"),
        )
        for key, value in (("backlash", "0.1 mm"), ("restitution", 0.4))
    },
    ("Crossing", "value"): "O1.theta - O2.theta",
    **EXAMPLES,
    ("DeadCentre", "dead_centre"): "O4.theta",
    ("ExpressionLaw", "value"): "20 deg*sin(360 deg*time/(1 s))",
    ("FollowingInput", "with"): "2*O1.theta",
    **{("FollowerSection", key): "40 mm" for key in ("arm", "base_radius", "distance")},
    **{("FollowerSection", key): "8 mm" for key in ("offset", "radius")},
    ("FunctionCoupling", "law"): {"law": "cycloidal", "from": 0, "to": "20 mm"},
    ("Kept", "of"): "O1.effort",
    ("Kept", "at"): "90 deg",
    ("Kept", "label"): "largest torque",
    ("Normal", "mean"): "0.5 in",
    ("Normal", "deviation"): "0.01 in",
    ("RangeOfValues", "from"): "0.4 in",
    ("RangeOfValues", "to"): "0.6 in",
    ("RangeOfValues", "step"): "0.05 in",
    ("StudyFile", "name"): "lengths of the coupler",
    ("StudyFile", "table"): "variants.csv",
    ("Uniform", "between"): ["0.4 in", "0.6 in"],
    ("UnitsSection", "length"): "mm",
    ("UnitsSection", "angle"): "deg",
    ("UnitsSection", "mass"): "kg",
    ("UnitsSection", "force"): "N",
    ("UnitsSection", "time"): "s",
    ("UnitsSection", "angular_rate"): "deg/s",
    ("ViewSection", "speed"): "4 s",
    ("Segment", "for"): "0.2 s",
    ("Segment", "to"): "20 mm",
    ("Sequence", "from"): 0,
    ("Sequence", "segments"): [
        {"for": "0.2 s", "law": "cycloidal", "to": "20 mm"},
        {"for": "0.1 s", "law": "dwell"},
    ],
    ("Sequence", "start"): "0.1 s",
    ("Sine", "amplitude"): "20 deg",
    ("Sine", "frequency"): "2 Hz",
    ("Sine", "offset"): "5 deg",
    ("Sine", "period"): "0.5 s",
    ("Sine", "phase"): "90 deg",
    **{
        (rise, key): value
        for rise in (
            *("Cycloidal", "Harmonic", "ModifiedSine", "ModifiedTrapezoid"),
            *("Rise345", "Rise4567"),
        )
        for key, value in (
            ("duration", "0.5 s"),
            ("from", 0),
            ("start", "0.1 s"),
            ("to", "40 mm"),
        )
    },
    ("SweptInput", "from"): 0,
    ("SweptInput", "step"): 5,
    ("SweptInput", "to"): 360,
    ("TimeSection", "from"): 0,
    ("TimeSection", "step"): "5 ms",
    ("TimeSection", "to"): "2 s",
    ("ListedTime", "values"): [0, 0.1, "0.5 s"],
    ("MechanismFile", "links"): {
        "crank": {"mass": "0.4 kg", "center_of_mass": ["r/2", 0, 0]},
        "rod": {},
    },
    ("GearCoupling", "ideal"): True,
    ("GearCoupling", "internal"): True,
    ("GearCoupling", "helix"): "15 deg",
    ("GearCoupling", "joints"): ["A", "B"],
    ("GearCoupling", "module"): "2 mm",
    ("GearCoupling", "pressure_angle"): "20 deg",
    ("BeltCoupling", "joints"): ["A", "B"],
    ("BeltCoupling", "radii"): ["30 mm", "50 mm"],
    ("BeltCoupling", "crossed"): True,
    ("BeltCoupling", "outside"): ["C"],
    ("BeltCoupling", "pretension"): "200 N",
    ("BeltCoupling", "tensioner"): "C",
    ("ChainCoupling", "joints"): ["A", "B"],
    ("ChainCoupling", "teeth"): [17, 38],
    ("ChainCoupling", "pitch"): "12.7 mm",
    ("ChainCoupling", "outside"): ["C"],
    ("ChainCoupling", "pretension"): "20 N",
    ("ChainCoupling", "tensioner"): "C",
    ("CableCoupling", "path"): ["P", {"pulley": "A", "radius": "50 mm", "side": "left"}, "Q"],
    ("PathPart", "axis"): [0, 1, 0],
    ("PathPart", "drum"): "D",
    ("PathPart", "free"): True,
    ("PathPart", "point"): "P",
    ("PathPart", "pulley"): "A",
    ("PathPart", "radius"): "50 mm",
    ("PathPart", "side"): "left",
    ("PathPart", "swivel"): [0, 0, 1],
    ("ScrewCoupling", "joints"): ["A", "S"],
    ("ScrewCoupling", "lead"): "5 mm",
    ("Plot", "x"): "theta",
    ("Plot", "y"): ["torque"],
    ("Polynomial", "coefficients"): [0, "10 deg/s", "2 deg/s^2"],
    ("PinInSlotJoint", "point"): [0, "r"],
    ("PlanePrismaticJoint", "point"): [0, "r"],
    ("PlaneRevoluteJoint", "point"): [0, "r"],
    ("PinInSlotJoint", "slot"): [0, 1],
    ("PlaneDirectionOfLink", "vector"): [1, 0],
    ("PlaneFile", "directions"): {"d": {"link": "crank", "vector": [1, 0]}},
    ("PlaneFile", "joints"): {"O1": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]}},
    ("PlaneFile", "links"): {"crank": {"mass": "0.4 kg", "center_of_mass": ["r/2", 0]}, "rod": {}},
    ("PlaneFile", "plane"): "xy",
    ("PlaneFile", "points"): {"P": {"link": "crank", "at": ["r", 0]}},
    ("PlaneForce", "force"): [0, "-10 N"],
    ("PlaneForce", "point"): [0, "r"],
    ("PlaneGravity", "direction"): [0, -1],
    ("PlaneLink", "center_of_mass"): ["r/2", 0],
    ("PlaneLink", "inertia"): "20 kg*mm^2",
    ("PlanePointOfLink", "at"): ["r", 0],
    ("PlanePrismaticJoint", "axis"): [1, 0],
    ("PlaneRevoluteJoint", "zero"): {"ground": [1, 0], "crank": [0, 1]},
    ("PlaneTorque", "torque"): "5 N*m",
    ("PointOfLink", "at"): ["r", 0, 0],
    ("PrintedRemark", "columns"): ["theta4"],
    ("StudyFile", "keep"): [{"of": "O1.effort", "as": "peak"}],
    ("StudyFile", "rows"): ["O4.theta"],
    ("StudyFile", "sample"): {"count": 1024, "method": "sobol"},
    ("StudyFile", "set"): {"P3": "0.4 in"},
    ("StudyFile", "vary"): {"P1": [0.48, "0.5 in"], "P2": {"tolerance": "0.01 in"}},
    ("Tolerance", "tolerance"): ["-0.1 mm", "0.2 mm"],
    ("RackCoupling", "at"): "contact",
    ("RackCoupling", "ideal"): True,
    ("RackCoupling", "helix"): "15 deg",
    ("RackCoupling", "joints"): ["P", "S"],
    ("RackCoupling", "pressure_angle"): "20 deg",
    ("ShapeOfLink", "points"): ["O1", [0, 10, 0]],
    ("PartBetween", "kind"): "spring",
    ("PartBetween", "points"): ["P", "Q"],
    ("ViewSection", "between"): [{"kind": "spring", "points": ["P", "Q"]}],
    ("ViewSection", "parameters"): {"r": ["30 mm", "60 mm"]},
}

INSTEAD_OF_ANY: Final[dict[str, Any]] = {
    "joint": "O1",
    "coordinate": "theta",
    "free": "80 mm",
    "radius": "8 mm",
    "length": "60 mm",
    "collar": "12 mm",
    "width": "90 mm",
    "flank": "15 deg",
    "damping": "0.2 N*s/mm",
    "stiffness": "4 N/mm",
    "unevenness": 0.02,
    "static": 0.15,
    "sliding": 0.1,
    "tolerance": "1e-9",
    "fixed_step": "1 ms",
    "lead": "5 mm",
    "speed": "5 mm/s",
    "jerk": "0 rad/s^3",
    "coefficient": 0.12,
    "mass": "0.4 kg",
    "point": [0, "r", "10 mm"],
    "center_of_mass": ["r/2", 0, "10 mm"],
    "xx": "2 kg*mm^2",
}
"""For keys whose kind of value has an example that explains little of this key."""


IDENTITY: Final = "urn:mechkin:schema:mechanism:1"
"""The name of the schema of format 1, wherever its file lies."""

STUDY_IDENTITY: Final = "urn:mechkin:schema:study:1"
"""The name of the schema of studies."""

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_FIRST_KEYS = "$schema $id title description $ref type const enum required".split()  # noqa: SIM905
_NAMED_SECTIONS = (
    *("parameters", "links", "joints", "couplings", "cylinders", "points", "directions"),
)
_BY_NAME = ("properties", "patternProperties", "$defs")
_JSON_TYPES = {str: "string", int: "integer", bool: "boolean"}
# JSON Schema has no flag for ignoring case
_NOT_A_NUMBER = r"^[+-]?\.?([Nn][Aa][Nn]|[Ii][Nn][Ff]([Ii][Nn][Ii][Tt][Yy])?)$"

_MEASURED = ": a number in the file's units"


def json_schema() -> Schema:
    """The JSON Schema (draft 2020-12) of a mechanism file as plain data in a stable order.

    It cannot say what crosses sections: one namespace for all names, tables and labels that differ,
    places per link that name the joint's own links, laws that need `time`.
    """
    definitions: Schema = {"ReservedName": {"enum": sorted(RESERVED)}}
    space, plane = (_file(form, definitions) for form in (MechanismFile, PlaneFile))
    plane["anyOf"] = [_non_empty(key, "minProperties") for key in ("joints", "cylinders")]
    space["anyOf"] = [*plane["anyOf"], _non_empty("chain", "minItems")]
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
    schema = _section(form, definitions)
    for name in _NAMED_SECTIONS:
        reserved = {"not": {"$ref": "#/$defs/ReservedName"}}
        schema["properties"][name]["propertyNames"] = reserved
    barred = {"not": {"pattern": TAKEN_FOR_EDITORS}}
    for name in ("responses", "equilibria"):
        schema["properties"][name]["propertyNames"] = barred
    return schema


def _non_empty(key: str, least: str) -> Schema:
    return {"required": [key], "properties": {key: {least: 1}}}


def _section(section: type[Section], definitions: Schema) -> Schema:
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
        elif isinstance(field.default, (str, int)) and field.default is not False:
            schema["default"] = field.default
        example = BY_SECTION.get((section.__name__, key), INSTEAD_OF_ANY.get(key))
        if example is None and not has_example(schema, definitions):
            example = BY_KEY.get(key)
        if example is not None:
            schema = schema | {"examples": [example]}
        properties[key] = schema
    words = "\n\n".join(_paragraphs(section))
    mapping = {"description": words, "type": "object", "additionalProperties": False}
    mapping |= {"properties": properties} | ({"required": required} if required else {})
    mapping |= section.editors
    return with_old_keys(section, mapping) if section.renamed else mapping


def _measure(schema: Schema, definitions: Schema) -> str | None:
    """The dimension of a number, or of each number of a list, in words; None for other values."""
    schema = _resolved(schema, definitions)
    if "if" in schema:
        forms = (schema[form] for form in ("then", "else") if form in schema)
        return next(filter(None, (_measure(form, definitions) for form in forms)), None)
    if "items" in schema:
        return _measure(schema["items"], definitions)
    name, mark, _ = str(schema.get("description", "")).partition(_MEASURED)
    return name if mark and not name.startswith(("dimensionless", "any")) else None


def _paragraphs(section: type[Section]) -> list[str]:
    paragraphs = inspect.cleandoc(section.__doc__ or "").split("\n\n")
    return [text.replace("\n", " ") for text in paragraphs]


def has_example(schema: Schema, definitions: Schema) -> bool:
    """Whether an editor has something to show for a value: an example, or the words it may be."""
    while not schema.keys() & {"examples", "enum", "const", "default"}:
        if "$ref" not in schema:
            forms = (schema[form] for form in ("then", "else") if form in schema)
            return any(has_example(form, definitions) for form in forms)
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    return True


def _value(annotation: Any, definitions: Schema) -> Schema:
    """The schema of a value; one with a name goes to `definitions`, with a reference to it."""
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
    choice = next((rule for rule in rules if isinstance(rule, FormChoice)), None)
    if choice is None:
        schema = _value(inner, definitions)
    else:
        forms = [_value(member, definitions) for member in get_args(inner)]
        schema = decided(forms, choice.key, definitions)
    for rule in rules:
        if isinstance(rule, SchemaName):
            definitions[rule.name] = schema
            schema = {"$ref": f"#/$defs/{rule.name}"}
        elif isinstance(rule, Limits):
            schema |= _limits(rule, schema)
        elif isinstance(rule, Shown):
            schema = {"anyOf": [_shown(rule), schema]} if rule.is_short else schema | _shown(rule)
        elif isinstance(rule, DimensionRule):
            definitions[rule.schema_name] = schema | _dimension(rule)
            schema = {"$ref": f"#/$defs/{rule.schema_name}"}
        elif isinstance(rule, Rule) and rule.barred is not None:
            schema |= {"not": {"pattern": rule.barred}}
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
    shown |= {"pattern": rule.pattern} if rule.pattern else {}
    return shown | ({"examples": list(rule.examples)} if rule.examples else {})


def _dimension(rule: DimensionRule) -> Schema:
    text = f"{rule.name}{_MEASURED}, a number with its unit, or an expression of parameters"
    not_finite = {"type": "string", "pattern": _NOT_A_NUMBER}
    shown = _shown(Shown(("number", "string"), text, rule.examples))
    return shown | {"minLength": 1, "not": not_finite}


def _types(names: tuple[str, ...]) -> str | list[str]:
    return names[0] if len(names) == 1 else list(names)


def _ordered(schema: Any, by_name: bool = False) -> Any:
    """The schema with its keys in order; with `by_name` keys are names, in the order they have."""
    if isinstance(schema, list):
        return [_ordered(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    if by_name:
        return {name: _ordered(value) for name, value in schema.items()}
    first = [key for key in _FIRST_KEYS if key in schema]
    rest = sorted(schema.keys() - set(first))
    return {key: _ordered(schema[key], key in _BY_NAME) for key in [*first, *rest]}
