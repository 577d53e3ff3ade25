"""The form of the data that pages read, as a JSON Schema: the two sides of it are written apart."""

from __future__ import annotations

from typing import Any

from jsonschema.validators import validator_for


def _object(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": sorted(properties),
        "additionalProperties": False,
    }


def _list(items: Any, **more: Any) -> dict[str, Any]:
    return {"type": "array", "items": items, **more}


def _or_null(schema: dict[str, Any]) -> dict[str, Any]:
    return {"anyOf": [schema, {"type": "null"}]}


def _packed(kind: str) -> dict[str, Any]:
    return _object(**{kind: {"type": "string", "contentEncoding": "base64"}})


TEXT = {"type": "string"}
NUMBER = {"type": "number"}
SWITCH = {"type": "boolean"}
LENGTH = {"type": "number", "exclusiveMinimum": 0}
INDEX = {"type": "integer", "minimum": 0}
VECTOR = _list(NUMBER, minItems=3, maxItems=3)
COLUMN = _object(label=TEXT, unit=TEXT)
ENDS = _list(_or_null(NUMBER), minItems=2, maxItems=2)
HALF = _object(point=VECTOR, axis=VECTOR, x=VECTOR, axis2=_or_null(VECTOR))


def _shape(kind: Any, **more: Any) -> dict[str, Any]:
    return _object(kind=kind, points=_list(VECTOR), **more)


SHAPE = {
    "oneOf": [
        _shape({"const": "none"}),
        _shape({"enum": ["rod", "cylinder"]}, radius=_or_null(LENGTH)),
        _shape({"const": "wheel"}, normal=VECTOR, radius=LENGTH, width=LENGTH),
        _shape({"const": "plate"}, normal=VECTOR),
        _shape({"const": "star"}, centre=VECTOR),
    ]
}
BRANCH = _object(
    name=TEXT,
    own=SWITCH,
    rows=INDEX,
    x=_packed("f64"),
    poses=_object(rows=_packed("i32"), values=_packed("f32")),
    status=_object(words=_list(TEXT), doubts=_list({"enum": [0, 1, 2]}), codes=_packed("u8")),
    marks=_list(
        _object(x=NUMBER, kind={"enum": ["dead-centre", "branch-point", "event"]}, text=TEXT)
    ),
    columns=_list(
        _object(label=TEXT, unit=TEXT, table=TEXT, rounding=NUMBER, values=_packed("f64"))
    ),
    arrows=_list(
        _object(
            name=TEXT,
            kind={"enum": ["force", "moment"]},
            unit=TEXT,
            link=INDEX,
            place=VECTOR,
            values=_packed("f32"),
        )
    ),
)
DATA = _object(
    format={"const": 1},
    program={"type": "string", "pattern": "^mechkin "},
    file=TEXT,
    name=TEXT,
    units=_object(length=TEXT, angle=TEXT, force=TEXT, moment=TEXT),
    size={"type": "number", "exclusiveMinimum": 0},
    centre=VECTOR,
    up=VECTOR,
    planar=SWITCH,
    links=_list(
        _object(
            name=TEXT,
            colour=_or_null({"type": "string", "pattern": "^#[0-9A-Fa-f]{6}$"}),
            hidden=SWITCH,
            shape=SHAPE,
        )
    ),
    joints=_list(
        _object(
            name=TEXT,
            type=TEXT,
            links=_list(INDEX, minItems=2, maxItems=2),
            halves=_list(HALF, minItems=2, maxItems=2),
            lead=_or_null(NUMBER),
            travel=_or_null(_list(NUMBER, minItems=2, maxItems=2)),
            radius=_or_null({"type": "number", "exclusiveMinimum": 0}),
            track=_or_null(
                _object(rows=_list(_list(VECTOR, minItems=3), minItems=1), closed=SWITCH)
            ),
            stops=_object(turn=_or_null(ENDS), slide=_or_null(ENDS)),
        )
    ),
    points=_list(_object(name=TEXT, link=INDEX, place=VECTOR, path=SWITCH)),
    wheels=_list(
        _object(
            link=INDEX,
            centre=VECTOR,
            axis=VECTOR,
            x=VECTOR,
            radius=LENGTH,
            width=LENGTH,
            teeth=INDEX,
            inner=SWITCH,
            apex=NUMBER,
            lean=NUMBER,
            reach=_or_null(_list(NUMBER, minItems=2, maxItems=2)),
        )
    ),
    discs=_list(
        _object(
            link=INDEX,
            centre=VECTOR,
            axis=VECTOR,
            x=VECTOR,
            outline=_list(_list(NUMBER, minItems=2, maxItems=2), minItems=3),
            width=LENGTH,
        )
    ),
    cables=_list(
        _object(
            links=_list(INDEX, minItems=2),
            places=_list(VECTOR, minItems=2),
            beside=_list(NUMBER, minItems=2),
            axes=_list(VECTOR, minItems=2),
            swivels=_list({"enum": [-1, 0, 1, 2]}, minItems=2),
        )
    ),
    screws=_list(
        _object(
            link=INDEX,
            centre=VECTOR,
            axis=VECTOR,
            x=VECTOR,
            lead=NUMBER,
            reach=_list(NUMBER, minItems=2, maxItems=2),
            nut=_object(link=INDEX, centre=VECTOR, axis=VECTOR),
        )
    ),
    belts=_list(_object(link=INDEX, line=_list(VECTOR, minItems=3), axis=VECTOR, width=LENGTH)),
    runs=_list(
        _object(
            name=TEXT,
            kind={"enum": ["sweep", "response"]},
            title=TEXT,
            x=COLUMN,
            ties=_list(
                _object(
                    kind={"enum": ["spring", "damper", "cylinder"]},
                    joint=_or_null(INDEX),
                    turns=SWITCH,
                    links=_list(INDEX, minItems=2, maxItems=2),
                    places=_list(VECTOR, maxItems=2),
                    radius=_or_null(LENGTH),
                    stroke=_or_null(_list(LENGTH, minItems=2, maxItems=2)),
                )
            ),
            branches=_list(BRANCH, minItems=1),
        )
    ),
    tables=_list(
        _object(
            name=TEXT,
            title=TEXT,
            run=TEXT,
            columns=_list(_object(label=TEXT, unit=TEXT, exact=_or_null(_packed("f64")))),
            rows=_list(_list(TEXT)),
            status=_list(INDEX),
        )
    ),
    notes=_list(
        _object(severity={"enum": ["note", "warning", "error"]}, text=TEXT, place=_or_null(TEXT))
    ),
    assumed=_list(TEXT),
    view=_object(
        camera=_or_null(VECTOR),
        speed=_or_null(NUMBER),
        forces=SWITCH,
        arrow_length=_or_null(NUMBER),
    ),
)

FORM = validator_for(DATA)(DATA)
"""Validates data; that `DATA` itself is a schema is tested once, not every time."""
