"""The errors of plain data, by pydantic's core, with advice on unknown keys and types.

`pydantic.BaseModel` builds the same validators from the same annotations, but it inspects and
compiles every class when it is defined: for the sections of format 1 that took longer than the
analysis of a mechanism. Here a validator is built when the first value of its section is met, so
that a section which a file does not use costs its class body alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial
from types import NoneType, UnionType
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

from pydantic_core import SchemaValidator, ValidationError, core_schema as core

from mechkin_cli.schema.base import (
    AnySection,
    FormChoice,
    Limits,
    Rule,
    Section,
    field_descriptions,
    fields_of,
    tagged,
)
from mechkin_cli.schema.coupling_words import BELT, COUPLING_ADVICE, ELSEWHERE
from mechkin_cli.schema.scalars import FORMS


def section_or_errors(
    form: type[AnySection], data: object
) -> tuple[AnySection | None, list[dict[str, Any]]]:
    """The section that plain data describes, or None and the records of all its errors."""
    try:
        return judged(form, data), []
    except ValidationError as failure:
        errors = failure.errors(include_url=False, include_input=False)
        return None, [_completed(dict(error), data, form) for error in errors]


def _completed(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record with the context that a message needs beyond pydantic's own."""
    if error["type"] == "string_pattern_mismatch":
        expected, hint = FORMS[error["ctx"]["pattern"]]
        return error | {"ctx": {"expected": expected, "hint": hint}}
    if error["type"] == "unknown-word":
        noun = _noun(error["loc"], error["ctx"]["key"])
        return _with_advice(error | {"ctx": error["ctx"] | {"noun": noun}}, data, form)
    if error["type"] == "literal_error":
        key = next((step for step in reversed(error["loc"]) if isinstance(step, str)), "")
        return error | {"ctx": error["ctx"] | {"noun": _noun(error["loc"], key)}}
    if error["type"] not in ("missing", "extra_forbidden"):
        return error
    *mapping, key = error["loc"]
    known = known_keys(form, tuple(mapping))
    if known is None:
        return error
    section, descriptions = known
    context = {
        "known": list(descriptions),
        "advice": None
        if str(key).casefold() in descriptions
        else section.advice.get(str(key)) or advice_for_key(section.__name__, str(key)),
        "purpose": descriptions.get(str(key)),
    }
    return error | {"ctx": context}


_TYPES = {
    "joints": "joint",
    "couplings": "coupling",
    "chain": "joint",
    "loads": "load",
    "balances": "balance",
}
_NOUNS = {
    "law": "law",
    "interpolation": "interpolation",
    "direction": "direction",
    "distribution": "distribution",
    "method": "sampling method",
    "kind": "shape",
}


def _noun(location: tuple[str | int, ...], key: str) -> str | None:
    """What the word at a key is; None where there is no plain noun for it."""
    return f"{_TYPES[str(location[0])]} type" if key == "type" else _NOUNS.get(key)


def _with_advice(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record of an unknown type, with advice on what to write instead."""
    value: Any = data
    try:
        for step in (*error["loc"], error["ctx"]["key"]):
            value = value[step]
    except (KeyError, IndexError, TypeError):
        return error
    advice = advice_for_type(str(error["loc"][0]), str(value), getattr(form, "in_plane", False))
    return error | {"ctx": error["ctx"] | {"advice": advice}}


_VALIDATORS: dict[type[Section], SchemaValidator] = {}


def judged(section: type[AnySection], data: object) -> AnySection:
    """The section that plain data describes; raises pydantic's ValidationError.

    The locations of its errors continue that of the section around it.
    """
    if section not in _VALIDATORS:
        _VALIDATORS[section] = _built(section)
    return _VALIDATORS[section].validate_python(data)  # type: ignore[no-any-return]


def _built(section: type[Section]) -> SchemaValidator:
    fields = {}
    for key, field in fields_of(section).items():
        value = _schema(field.annotation)
        if not field.required:
            value = core.with_default_schema(value, default=field.default)
        fields[field.name] = core.model_field(value, validation_alias=key)
    keys = core.model_fields_schema(fields, extra_behavior="forbid")
    schema: core.CoreSchema = core.model_schema(section, keys)
    if section.check is not Section.check:
        schema = core.no_info_after_validator_function(_checked, schema)
    return SchemaValidator(schema)


def _checked(section: Section) -> Section:
    section.check()
    return section


@cache
def _schema(annotation: Any) -> core.CoreSchema:
    """The schema of a value; equal annotations share one."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return core.no_info_plain_validator_function(partial(judged, annotation))
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _with_rules(arguments[0], arguments[1:])
    if origin in (Union, UnionType):
        (inner,) = (member for member in arguments if member is not NoneType)
        return core.nullable_schema(_schema(inner))
    return _plain(annotation, Limits())


def _with_rules(inner: Any, rules: tuple[Any, ...]) -> core.CoreSchema:
    choice = next((rule for rule in rules if isinstance(rule, FormChoice)), None)
    limits = next((rule for rule in rules if isinstance(rule, Limits)), None)
    if choice is not None:
        schema: core.CoreSchema = _one_of(inner, choice)
    else:
        schema = _schema(inner) if limits is None else _plain(inner, limits)
    for rule in rules:
        if isinstance(rule, Rule) and rule.before:
            schema = core.no_info_before_validator_function(rule.function, schema)
        elif isinstance(rule, Rule):
            schema = core.no_info_after_validator_function(rule.function, schema)
    return schema


def _plain(annotation: Any, limits: Limits) -> core.CoreSchema:
    """A scalar, a fixed word, a list or a mapping of values of one kind."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    least, most = limits.min_length, limits.max_length
    if annotation is str:
        return core.str_schema(pattern=limits.pattern)
    if annotation is int:
        return core.int_schema(ge=limits.ge, le=limits.le)
    if annotation is bool:
        return core.bool_schema(strict=True)
    if origin is Literal:
        return core.literal_schema(list(arguments))
    if origin is tuple:
        return core.tuple_schema(
            [_schema(arguments[0])], variadic_item_index=0, min_length=least, max_length=most
        )
    if origin is dict:
        return core.dict_schema(
            _schema(arguments[0]), _schema(arguments[1]), min_length=least, max_length=most
        )
    raise TypeError(f"no validator for {annotation}")


def _one_of(union: Any, choice: FormChoice) -> core.CoreSchema:
    """A union whose members each carry their tag."""
    choices: dict[Any, core.CoreSchema] = {
        tag: _with_rules(form, rules) for tag, form, rules in map(tagged, get_args(union))
    }
    if choice.words is None:
        return core.tagged_union_schema(choices, choice.choose)
    return core.tagged_union_schema(
        choices,
        choice.choose,
        custom_error_type="unknown-word",
        custom_error_message=f"expected one of {choice.words}",
        custom_error_context={"key": str(choice.key), "words": choice.words},
    )


def known_keys(
    top: type[Section], location: tuple[str | int, ...]
) -> tuple[type[Section], dict[str, str]] | None:
    """The section at a validation error's location (which includes the tags of forms), and its keys
    with their help texts.

    None where no mapping with fixed keys is there.
    """
    current: Any = top
    for step in location:
        current = _step_into(current, step)
        if current is None:
            return None
    section = next((item for item in _alternatives(current) if _is_section(item)), None)
    if section is None:
        return None
    texts = field_descriptions(section)
    return section, {key: texts.get(field.name, "") for key, field in fields_of(section).items()}


def _step_into(annotation: Any, step: str | int) -> Any:
    if isinstance(step, str) and step.startswith("("):
        return next((form for tag, form in _tagged(annotation) if tag == step), None)
    for item in _alternatives(annotation):
        if _is_section(item):
            for key, field in fields_of(item).items():
                if step in (key, field.name):
                    return field.annotation
        elif get_origin(item) in (dict, tuple):
            arguments = get_args(item)
            return arguments[1] if get_origin(item) is dict else arguments[0]
    return None


def _alternatives(annotation: Any) -> Iterator[Any]:
    """The annotation without metadata, each member of a union by itself."""
    if get_origin(annotation) is Annotated:
        yield from _alternatives(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, UnionType):
        for member in get_args(annotation):
            yield from _alternatives(member)
    else:
        yield annotation


def _tagged(annotation: Any) -> Iterator[tuple[str, Any]]:
    tag, form, _ = tagged(annotation)
    if tag:
        yield tag, form
    elif form is not annotation:
        yield from _tagged(form)
    elif get_origin(annotation) in (Union, UnionType):
        for member in get_args(annotation):
            yield from _tagged(member)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Section)


# Advice on keys and types of other programs, misplaced ones and missing features; it is looked up
# before the nearest known word is.


def advice_for_key(section: str, key: str) -> str | None:
    """What to do instead of a key that a section, by the name of its class, does not have."""
    known = JOINT_KEYS if section.endswith("Joint") else {}
    word = key.casefold()
    return _SECTIONS.get(section, known).get(word) or _MISSING.get(word)


def advice_for_type(section: str, word: str, in_plane: bool = False) -> str | None:
    """What to do instead of a type that `loads`, `joints` or `couplings` do not have."""
    joints = PLANE_JOINT_ADVICE if in_plane else JOINT_ADVICE
    tables = {"loads": LOAD_ADVICE, "joints": joints, "couplings": {**OUTSIDE, **COUPLING_ADVICE}}
    return tables.get(section, {}).get(word.casefold())


FRICTION = "friction is a load: loads: [{type: friction, joint: A, coefficient: 0.1, ...}]"
CONTACT = (
    "mechkin has no contact of bodies: those that stay in touch are a joint (in a plane Ps, a pin "
    "in a slot; in space Sp, a sphere on a plane, and Sg, one in a groove); a coordinate strikes "
    "its limit with limits: {S.s: {max: 200 mm, restitution: 0.6}}, flanks of a gear with "
    "backlash: 0.1 mm"
)
RIGID = "links are rigid; put a spring between two of them: {type: spring, joint: A, ...}"
CONTROL = (
    "an effort may be an expression of coordinates, rates and time: responses: {NAME: {efforts: "
    '{A.theta: "-k*(A.theta - 1 rad) - c*A.theta_dot"}}}'
)
ROPE = (
    "a cable over points and pulleys is a coupling: couplings: {K: {type: cable, path: [P, "
    "{pulley: A, radius: 50 mm, side: left}, Q]}}"
)
GENEVA = (
    "the wheel's angle is a function of the crank's: couplings: {K: {type: function, of: A.theta, "
    'gives: W.theta, value: "if(abs(theta) < 45 deg, ..., ...)"}}; while the pin is in its slot, '
    "the two are also a joint (Ps in a plane, Ss in space)"
)
GROOVE = (
    "a groove or slot is a joint (Ps in a plane, Sg in space), whose curve: is a line, an arc, a "
    "circle, points or expressions of u: joints: {D: {type: Ps, links: [pin, slotted], point: [30, "
    "0], curve: {at: [30 mm*cos(u), 20 mm*sin(u)], from: 0 deg, to: 360 deg, closed: true}}}"
)
ROLLING = (
    "a wheel that rolls without slip is a tie: motion: {inputs: {D.s: {with: -20 mm*A.theta, "
    "drive: tie}, ...}} of a wheel of radius 20 mm"
)
OIL_FILM = (
    "an oil film is a law of friction: {type: friction, joint: A, law: viscous, viscosity: 0.03 "
    "Pa*s, clearance: 0.05 mm, radius: 20 mm, length: 40 mm}, or law: stribeck with a coefficient, "
    "too; a coefficient may fall with the speed: {static: .15, sliding: .1, speed: 5 mm/s}"
)
BRAKE = (
    'a brake is a load that opposes the motion: {type: torque, joint: A, value: "-3 '
    'N*m*sign(A.theta_dot)"}'
)
CYLINDER = (
    "a cylinder stands between two named points in a section of the file: cylinders: {C: {from: P, "
    "to: Q, stroke: [600 mm, 900 mm], bore: 80 mm}}; its length C.s may be an input: mechkin new "
    "lift --template excavator"
)
MOTOR = (
    "prescribe a motion under motion: inputs:, or give a torque or force under responses: {NAME: "
    "{efforts: {A.theta: 10 N*m}}}"
)
STUDY = (
    "give another value with --set NAME=VALUE, or many from Python: load(FILE).vary({NAME: values})"
)
RESPONSE = (
    "a motion under forces stands under responses: {NAME: {start: {A.theta: 20}, time: {from: 0, "
    "to: 2, step: 0.1}}}"
)
PLANE = (
    "write plane: xy, then points and forces as [x, y], inertias and torques as one number, and "
    "hinges as R without an axis"
)
COEFFICIENT = (
    "give it to a friction of its joint: loads: [{type: friction, joint: A, coefficient: 0.1, "
    "radius: 8 mm}]"
)
DAMPER = (
    "a damper is a load: loads: [{type: damper, joint: A, coordinate: theta, damping: 0.1 "
    "N*m*s/rad}]"
)
ROWS_IN_TIME = (
    "moments stand under time: {from: 0, to: 2, step: 0.1}, of motion: or of a response under "
    "responses:"
)
STEPS = (
    "a response takes its own steps: responses: {NAME: {tolerance: 1e-10}}, or fixed_step: 1e-3 s"
)
ACTUATORS = "coordinates at which efforts act: actuators: [leg1.s, leg2.s]"
NOTE = "write name: and source:, or a comment behind #"
TABLES = "what is written stands under tables: [{name: t, columns: [A.theta, A.effort]}]"
PARAMETERS = "named values stand under parameters: {r: 40 mm}"
LIMITS = "ends of coordinates stand in a section of the file: limits: {A.theta: [-30 deg, 60 deg]}"
LOAD = "write loads: [{type: gravity, g: standard}], likewise force, torque, spring, damper"

_MISSING: Final = {
    **dict.fromkeys(("ratchet", "pawl", "escapement", "clutch", "freewheel", "bumper"), CONTACT),
    **dict.fromkeys(("rope", "ropes", "cable", "cables", "tendon", "winch", "string"), ROPE),
    **dict.fromkeys(("wire", "tackle", "block_and_tackle", "hoist", "strings"), ROPE),
    **dict.fromkeys(("geneva", "maltese", "geneva_drive", "maltese_cross"), GENEVA),
    **dict.fromkeys(("curved_groove", "curved_slot", "groove_curve", "slot_curve"), GROOVE),
    **dict.fromkeys(("grooves", "guide_curve", "path_curve"), GROOVE),
    **dict.fromkeys(("rolling", "rolls", "roller"), ROLLING),
    **dict.fromkeys(("hydrodynamic", "hydrodynamics", "lubrication", "oil_film"), OIL_FILM),
    **dict.fromkeys(("viscosity", "bearing_friction", "stribeck_curve"), OIL_FILM),
    **dict.fromkeys(("brake", "brakes"), BRAKE),
    **dict.fromkeys(("flexible", "elastic", "beam", "beams", "bushing", "bushings"), RIGID),
    **dict.fromkeys(("compliant", "compliance", "flexure", "deformable", "fem"), RIGID),
    **dict.fromkeys(("control", "controls", "controller", "controllers", "pid"), CONTROL),
    **dict.fromkeys(("servo", "servos", "feedback", "regulator"), CONTROL),
    **dict.fromkeys(("hydraulic", "hydraulics", "piston", "pistons", "ram", "jack"), CYLINDER),
    **dict.fromkeys(("pneumatic", "linear_actuator", "telescope"), CYLINDER),
}
"""Keys of what mechkin does otherwise, that people try in any section."""

OUTSIDE: Final = {
    **_MISSING,
    **dict.fromkeys(("contact", "contacts", "collision", "impact", "clearance"), CONTACT),
    **ELSEWHERE,
    **dict.fromkeys(("wheel", "wheels", "tyre", "tire"), ROLLING),
    **dict.fromkeys(("cylinder", "cylinders"), CYLINDER),
    **dict.fromkeys(("motor", "motors", "drive", "drives", "engine"), MOTOR),
    "friction": FRICTION,
}
"""Keys and types that people try at any place."""


TOP_KEYS: Final = {
    **OUTSIDE,
    **dict.fromkeys(("study", "studies", "sweep", "optimize", "optimization"), STUDY),
    **dict.fromkeys(
        ("simulate", "simulation", "dynamics", "transient", "initial", "initial_conditions"),
        RESPONSE,
    ),
    **dict.fromkeys(("start", "driven", "response", "free_motion", "integrate"), RESPONSE),
    **dict.fromkeys(("gravity", "force", "forces", "torque", "torques", "springs"), LOAD),
    **dict.fromkeys(("g", "spring", "damper", "dampers", "moment", "moments"), LOAD),
    **dict.fromkeys(("planar", "dimension", "2d", "dimensions"), PLANE),
    **dict.fromkeys(("mu", "coulomb", "stiction", "friction_coefficient"), COEFFICIENT),
    "frictions": FRICTION,
    **dict.fromkeys(("viscous", "damping", "dissipation"), DAMPER),
    **dict.fromkeys(("actuator", "actuation", "actuated"), ACTUATORS),
    **dict.fromkeys(("t_end", "t_start", "tspan", "t_span", "end_time", "tend"), ROWS_IN_TIME),
    **dict.fromkeys(("duration", "time", "times", "dt", "timestep", "time_step"), ROWS_IN_TIME),
    **dict.fromkeys(("solver", "integrator", "tolerance", "tolerances"), STEPS),
    **dict.fromkeys(("rtol", "atol", "fixed_step", "max_step", "method"), STEPS),
    **dict.fromkeys(("output", "outputs", "plot", "plots", "columns", "results"), TABLES),
    **dict.fromkeys(("variables", "constants", "variable", "constant"), PARAMETERS),
    **dict.fromkeys(("title", "description", "author", "comment", "notes"), NOTE),
    **dict.fromkeys(("limit", "stops", "end_stops"), LIMITS),
    "version": "the version of the format stands in format: 1",
    "bodies": "bodies are links:",
    "body": "bodies are links:",
    "constraints": "constraints are joints:",
    "pairs": "pairs are joints:",
    **dict.fromkeys(
        ("mass", "masses", "inertia"), "mass and inertia stand with their link: links:"
    ),
    **dict.fromkeys(("input", "inputs"), "inputs stand under motion: {inputs: {A.theta: ...}}"),
    **dict.fromkeys(("mode", "near"), "write assembly: {near: {A.theta: 20}}, or mode: A there"),
    **dict.fromkeys(
        ("work", "harmonics", "flywheel", "fourier"),
        "write balances: [{name: work, type: work}], likewise harmonics and flywheel",
    ),
    **dict.fromkeys(
        ("published", "rows_by", "printed"),
        "printed values belong to a table: tables: [{name: t, published: {file: printed.csv, "
        "rows_by: t}, columns: ...}]",
    ),
    "run": "a run is named where it is read: tables: [{name: t, run: NAME, ...}], or --run NAME",
    "runs": "a load names its runs: loads: [{type: gravity, g: standard, runs: [NAME]}]",
    "efforts": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "events": "a response ends at its stop: [{value: A.theta, at: 45}]",
    "stop": "a response ends at its own stop:; write it under responses: {NAME: ...}",
}
"""Keys of the file."""

JOINT_KEYS: Final = {
    **ELSEWHERE,
    "friction": FRICTION,
    "damping": "a damper is a load: loads: [{type: damper, joint: A, coordinate: theta, ...}]",
    "stiffness": "a spring is a load: loads: [{type: spring, joint: A, coordinate: theta, ...}]",
    **dict.fromkeys(
        ("mu", "coulomb", "stiction", "coefficient", "friction_coefficient"), COEFFICIENT
    ),
    **dict.fromkeys(("viscous", "dampings"), DAMPER),
    **dict.fromkeys(("limit", "limits", "min", "max", "range", "stops"), LIMITS),
    **dict.fromkeys(("motor", "drive", "actuator", "actuated"), MOTOR),
    **dict.fromkeys(
        ("parent", "child", "bodies", "body1", "body2", "from", "to", "between"),
        "the two links stand in links: [first, second]; coordinates are of the second against the "
        "first",
    ),
    **dict.fromkeys(
        ("at", "position", "location", "origin"), "write point: and its place, a vector"
    ),
    "direction": "write axis: [0, 0, 1]",
    "axis": "this pair has no axis; leave it out",
    **dict.fromkeys(
        ("initial", "initial_value", "value", "theta0", "angle"),
        "every coordinate is zero as drawn; assembly: {near: ...} selects the assembly",
    ),
}
"""Keys of every joint."""

FRICTION_KEYS: Final = {
    "mu": "the key is coefficient: a number, or {static: .15, sliding: .1, speed: 5 mm/s}",
    **dict.fromkeys(
        ("static", "sliding", "speed", "mu_s", "mu_k", "kinetic", "stribeck"),
        "they belong to the coefficient: {static: .15, sliding: .1, speed: 5 mm/s}",
    ),
    **dict.fromkeys(("viscous", "petroff", "film"), OIL_FILM),
    "damping": DAMPER,
    "diameter": "radius is half of it",
    "force": "a constant force of friction is a load: {type: force, joint: A, value: "
    "-3 N*sign(A.s_dot)}",
    "torque": "a constant torque of friction is a load: {type: torque, joint: A, value: "
    "-3 N*m*sign(A.theta_dot)}",
    "coordinate": "friction acts on all that the joint leaves free; leave it out",
}
"""Keys of friction."""

RESPONSE_KEYS: Final = {
    **dict.fromkeys(
        ("t_end", "t_start", "tspan", "t_span", "duration", "end", "to", "end_time"),
        "write time: {from: 0, to: 2, step: 0.1}",
    ),
    **dict.fromkeys(
        ("count", "dt", "timestep", "time_step"),
        "rows stand under time: {from, to, step}, the integrator's own step under fixed_step",
    ),
    **dict.fromkeys(
        ("initial_conditions", "initial", "x0", "state", "begin"),
        "write start: {A.theta: 20, A.theta_dot: 0 rad/s}",
    ),
    **dict.fromkeys(
        ("rtol", "atol", "accuracy", "epsilon", "error"), "the key is tolerance: 1e-10"
    ),
    **dict.fromkeys(
        ("solver", "method", "integrator"),
        "the integrator is chosen by itself: DOP853, where it is stiff Radau IIA; leave it out",
    ),
    **dict.fromkeys(
        ("effort", "forces", "force", "torque", "torques", "motor", "motors"),
        "write efforts: {A.theta: 10 N*m}",
    ),
    **dict.fromkeys(
        ("drive", "drives", "prescribed", "motion", "law"),
        "coordinates that move by laws stand under driven: {A.theta: {law: harmonic, ...}}",
    ),
    "assembly": "write near: {A.theta: 20} or mode: A here",
    "at_branch_points": "write assembly: {at_branch_points: straight} in the file",
    "friction": FRICTION,
    "actuators": "in a response efforts act where efforts: names them; leave it out",
    "columns": "columns stand in tables: [{name: t, run: NAME, columns: [...]}]",
    "rates": "rates stand in start: {A.theta: 20, A.theta_dot: 1 rad/s}",
    "gravity": LOAD,
}
"""Keys of a response."""

MOTION_KEYS: Final = {
    **ELSEWHERE,
    "driven": "in the sweep they are inputs:; driven: belongs to a response",
    "efforts": "in the sweep efforts follow from the motion; as given they belong to a response",
    "start": RESPONSE,
    **dict.fromkeys(
        ("input", "drive", "drives"), "write inputs: {A.theta: {from: 0, to: 90, step: 5}}"
    ),
    **dict.fromkeys(
        ("from", "to", "step", "count", "values"),
        "rows belong to an input: inputs: {A.theta: {from: 0, to: 90, step: 5}}, or to time:",
    ),
}
"""Keys of the motion."""

TABLE_KEYS: Final = {
    "rows_by": "it stands with the file: published: {file: printed.csv, rows_by: t}",
    "remarks": "they stand with the file: published: {file: printed.csv, remarks: [...]}",
    "file": "printed values are published: {file: printed.csv}; its own file is called by name:",
    "runs": "a table reads one run: run: NAME",
    "response": "the key is run: NAME",
    **dict.fromkeys(
        ("values", "quantities", "outputs", "rows"), "the key is columns: [A.theta, ...]"
    ),
    "summary": "from Python: r = m.analyze(); max(r[NAME]); a table has the rows of its run",
}
"""Keys of a table."""

_SECTIONS: Final = {
    "MechanismFile": TOP_KEYS,
    "PlaneFile": TOP_KEYS,
    "FrictionAtJoint": FRICTION_KEYS,
    "PlaneFriction": FRICTION_KEYS,
    "Response": RESPONSE_KEYS,
    "MotionSection": MOTION_KEYS,
    "Table": TABLE_KEYS,
}


LOAD_ADVICE: Final = {
    **OUTSIDE,
    **dict.fromkeys(
        ("bush", "mount", "flexure", "silentblock"),
        "links are rigid; what gives between two is {type: bushing, links: [a, b], point: [...], "
        "stiffness: {x: 200 N/mm, ...}}",
    ),
    "moment": "a moment is a torque: {type: torque, ...}",
    "couple": "a couple is a torque: {type: torque, ...}",
    "viscous": DAMPER,
    "chain": BELT,
    "weight": "weights follow from the masses and {type: gravity, g: standard}",
    "acceleration": "write {type: gravity, g: [x, y, z]}",
    "damping": "write {type: damper, ..., damping: c}",
    "stiffness": "write {type: spring, ..., stiffness: k}",
    "effort": "efforts belong to a response: responses: {NAME: {efforts: {A.theta: 10 N*m}}}",
    "actuator": MOTOR,
}
"""Types of a load."""

JOINT_ADVICE: Final = {
    **OUTSIDE,
    **dict.fromkeys(("revolute", "hinge", "pin", "turning", "pivot", "bearing"), "a hinge is R"),
    **dict.fromkeys(("prismatic", "slider", "sliding", "translational"), "a slider is P"),
    **dict.fromkeys(("cylindrical", "cylindric"), "turning and sliding is C"),
    "cylinder": f"turning and sliding is C; {CYLINDER}",
    "chain": BELT,
    **dict.fromkeys(("groove", "curve", "track"), GROOVE),
    **dict.fromkeys(("viscous", "journal"), OIL_FILM),
    **dict.fromkeys(("wheel", "roller"), ROLLING),
    "actuator": MOTOR,
    **dict.fromkeys(("helical", "screw", "thread"), "a screw is H, with lead: length per turn"),
    **dict.fromkeys(("spherical", "ball", "sphere", "globe"), "a ball joint is S"),
    **dict.fromkeys(("universal", "cardan", "hooke"), "a universal joint is U"),
    **dict.fromkeys(("planar", "plane"), "a plane on a plane is E"),
    **dict.fromkeys(("fixed", "weld", "rigid", "welded"), "what is one body is W"),
    "spring": "a spring is a load: loads: [{type: spring, ...}]",
    "damper": "a damper is a load: loads: [{type: damper, ...}]",
    "motor": "a motor is no joint: give the type of the pair that it turns, and its effort",
}
"""Types of a joint."""


_SPATIAL = "it is a pair in space; a plane has R, P, Ps (a pin in a slot) and W"
_POSE = (
    "a pose in a plane is P along x, P along y and R, one after the other through two links "
    "without mass; their coordinates may be inputs"
)
PLANE_JOINT_ADVICE: Final = {
    **JOINT_ADVICE,
    **dict.fromkeys(("c", "h", "s", "sp", "u", "e", "ss", "sc", "cp"), _SPATIAL),
    **dict.fromkeys(("f", "free", "pose"), _POSE),
    "sg": "a pin in a slot is Ps, with slot: [x, y]",
    **dict.fromkeys(
        ("pin_in_slot", "slot", "half", "pinslot"), "a pin in a slot is Ps, with slot: [x, y]"
    ),
    **dict.fromkeys(("cylindrical", "cylindric", "spherical"), _SPATIAL),
    "cylinder": CYLINDER,
    **dict.fromkeys(("helical", "screw", "thread", "universal", "cardan"), _SPATIAL),
    **dict.fromkeys(("hooke", "ball", "sphere", "globe", "planar", "plane"), _SPATIAL),
}
"""Types of a joint in a plane file."""
