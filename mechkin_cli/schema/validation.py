"""Plain data -> `MechanismFile`, `PlaneFile` or `StudyFile`, or all independent errors as records.

A record has `type`, `loc` (keys, list indices and tags in parentheses), `msg` and `ctx`. To the
records of pydantic are added reserved and clashing names, and the keys that a mapping may have.
Joints, links, points, directions, parameters and quantities share one namespace; the check reads
plain data, so that a clash is reported together with all other errors.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final

from mechkin_cli.schema.base import Section
from mechkin_cli.schema.file import AnyFile, MechanismFile
from mechkin_cli.schema.reader import validated
from mechkin_cli.schema.scalars import FORMS

if TYPE_CHECKING:
    from mechkin_cli.schema.study import StudyFile


_WORDS = ("ground", "row", "time", "pi", "turn", "nan", "inf", "infinity")
_OPERATORS = ("and", "or", "not", "if", "derivative")
_VECTOR_FUNCTIONS = ("dot", "cross", "det", "norm", "unit_vector", "angle_between")
_ANGLE_FUNCTIONS = ("wrap", "sin", "cos", "tan", "asin", "acos", "atan", "atan2")
_NUMBER_FUNCTIONS = ("sqrt", "abs", "sign", "min", "max", "exp", "log", "pow", "clip", "hypot")
_STEPS = ("floor", "ceil", "round", "mod")
_HYPERBOLIC_FUNCTIONS = ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh")
RESERVED: Final = frozenset(
    (
        *(*_WORDS, *_OPERATORS, *_STEPS),
        *(*_VECTOR_FUNCTIONS, *_ANGLE_FUNCTIONS, *_NUMBER_FUNCTIONS, *_HYPERBOLIC_FUNCTIONS),
    )
)
"""Words that cannot be the name of anything in a file."""

_SECTIONS = ("parameters", "quantities", "links", "joints", "chain", "points", "directions")


def name_errors(data: object) -> list[dict[str, Any]]:
    """Reserved words and clashes among the names that a file defines, as error records.

    A clash is reported at the second place in the order of the file.
    """
    errors: list[dict[str, Any]] = []
    first_use: dict[str, str] = {}
    for section, name, location in _definitions(data):
        if name in RESERVED:
            text = f"the name {name} is reserved"
            errors.append(_error("reserved-name", location, text, "choose another name"))
        elif name in first_use:
            text = f"the name {name} is already used in {first_use[name]}:"
            hint = (
                "joints, links, points, directions, parameters and quantities share one namespace; "
                "rename one"
            )
            errors.append(_error("name-clash", location, text, hint))
        else:
            first_use[name] = section
    return errors


def _definitions(data: object) -> Iterator[tuple[str, str, tuple[str | int, ...]]]:
    sections = data if isinstance(data, dict) else {}
    for section, content in sections.items():
        if section in _SECTIONS and isinstance(content, dict):
            for name in content:
                if isinstance(name, str):
                    yield section, name, (section, name, "[key]")
        elif section == "chain" and isinstance(content, list):
            for index, row in enumerate(content):
                if isinstance(row, dict):
                    yield from _chain_definitions(row, index, sections.get("links"))


def _chain_definitions(
    row: dict[str, Any], index: int, links: object
) -> Iterator[tuple[str, str, tuple[str | int, ...]]]:
    """A row names its joint, and its link where that is neither ground nor listed in links."""
    if isinstance(row.get("joint"), str):
        yield "chain", row["joint"], ("chain", index, "joint")
    link = row.get("link")
    listed = links if isinstance(links, dict) else {}
    if isinstance(link, str) and link != "ground" and link not in listed:
        yield "chain", link, ("chain", index, "link")


def _error(code: str, location: tuple[str | int, ...], text: str, hint: str) -> dict[str, Any]:
    return {"type": code, "loc": location, "msg": text, "ctx": {"text": text, "hint": hint}}


class InvalidDataError(Exception):
    """Data that is not a mechanism file of format 1; `errors` holds the records."""

    def __init__(self, errors: list[dict[str, Any]]) -> None:
        self.errors = errors
        super().__init__(f"{len(errors)} errors in the data of a mechanism file")


def validate(data: object) -> AnyFile:
    """The mechanism file that plain data describes, with `plane:` one in a plane; raises
    `InvalidDataError`."""
    errors = name_errors(data)
    form: type[AnyFile] = MechanismFile
    if isinstance(data, dict) and "plane" in data:
        from mechkin_cli.schema.plane import PlaneFile

        form = PlaneFile
    try:
        file = validated(form, data)
    except ValueError as failure:
        errors = _records(failure, data, form) + errors
    if errors:
        raise InvalidDataError(errors)
    return file


def validate_study(data: object) -> StudyFile:
    """The study that plain data describes; raises `InvalidDataError`."""
    from mechkin_cli.schema.study import StudyFile  # only for studies

    try:
        return validated(StudyFile, data)
    except ValueError as failure:
        raise InvalidDataError(_records(failure, data, StudyFile)) from None


def _records(failure: ValueError, data: object, form: type[Section]) -> list[dict[str, Any]]:
    from pydantic_core import ValidationError  # only for messages

    if not isinstance(failure, ValidationError):
        raise failure
    errors = failure.errors(include_url=False, include_input=False)
    return [_completed(dict(error), data, form) for error in errors]


def _completed(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record with the context that a message needs beyond pydantic's own."""
    if error["type"] == "string_pattern_mismatch":
        expected, hint = FORMS[error["ctx"]["pattern"]]
        return error | {"ctx": {"expected": expected, "hint": hint}}
    if error["type"] == "unknown-word":
        return _with_advice(error, data, form)
    if error["type"] not in ("missing", "extra_forbidden"):
        return error
    from mechkin_cli.schema.advice import advice_for_key, known_keys  # only for messages

    *mapping, key = error["loc"]
    known = known_keys(form, tuple(mapping))
    if known is None:
        return error
    section, descriptions = known
    context = {
        "known": list(descriptions),
        "advice": section.advice.get(str(key)) or advice_for_key(section.__name__, str(key)),
        "purpose": descriptions.get(str(key)),
    }
    return error | {"ctx": context}


def _with_advice(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record of an unknown type, with advice on what to write instead."""
    from mechkin_cli.schema.advice import advice_for_type

    value: Any = data
    try:
        for step in (*error["loc"], error["ctx"]["key"]):
            value = value[step]
    except (KeyError, IndexError, TypeError):
        return error
    advice = advice_for_type(str(error["loc"][0]), str(value), getattr(form, "in_plane", False))
    return error | {"ctx": error["ctx"] | {"advice": advice}}
