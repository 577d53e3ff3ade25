"""Plain data -> `MechanismFile`, `PlaneFile` or `StudyFile`, or every independent error as a plain
record.

A record has `type`, `loc` (keys, list indices and tags in parentheses), `msg` and `ctx`. To the
records of pydantic are added the reserved and clashing names, and what a mapping's keys could have
been.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pydantic_core import ValidationError

from mechkin_cli.schema.base import Section
from mechkin_cli.schema.compiled import validated
from mechkin_cli.schema.file import AnyFile, MechanismFile
from mechkin_cli.schema.names import name_errors
from mechkin_cli.schema.scalars import FORMS

if TYPE_CHECKING:
    from mechkin_cli.schema.study import StudyFile


class InvalidDataError(Exception):
    """Data that is not a mechanism file of format 1; `errors` holds the records."""

    def __init__(self, errors: list[dict[str, Any]]) -> None:
        self.errors = errors
        super().__init__(f"{len(errors)} errors in the data of a mechanism file")


def validate(data: object) -> AnyFile:
    """The mechanism file that plain data describes, with `plane:` one in a plane; raises
    `InvalidDataError`."""
    errors = name_errors(data)
    form = _form(data)
    try:
        file = validated(form, data)
    except ValidationError as failure:
        errors = _told(failure, data, form) + errors
    if errors:
        raise InvalidDataError(errors)
    return file


def validate_study(data: object) -> StudyFile:
    """The study that plain data describes; raises `InvalidDataError`."""
    from mechkin_cli.schema.study import StudyFile  # only for studies

    try:
        return validated(StudyFile, data)
    except ValidationError as failure:
        raise InvalidDataError(_told(failure, data, StudyFile)) from None


def _told(failure: ValidationError, data: object, form: type[Section]) -> list[dict[str, Any]]:
    """The errors of a validation as records."""
    found = failure.errors(include_url=False, include_input=False)
    return [_completed(dict(error), data, form) for error in found]


def _form(data: object) -> type[AnyFile]:
    if isinstance(data, dict) and "plane" in data:
        from mechkin_cli.schema.plane import PlaneFile

        return PlaneFile
    return MechanismFile


def _completed(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record with what a message needs beyond pydantic's own context."""
    if error["type"] == "string_pattern_mismatch":
        expected, hint = FORMS[error["ctx"]["pattern"]]
        return error | {"ctx": {"expected": expected, "hint": hint}}
    if error["type"] == "unknown-word":
        return _with_advice(error, data, form)
    if error["type"] not in ("missing", "extra_forbidden"):
        return error
    from mechkin_cli.schema.known_keys import known_keys  # reads sources: only for messages
    from mechkin_cli.schema.other_keys import advice_for_key

    *mapping, key = error["loc"]
    known = known_keys(form, tuple(mapping))
    if known is None:
        return error
    context = {
        "known": list(known.descriptions),
        "advice": known.advice.get(str(key)) or advice_for_key(known.section, str(key)),
        "purpose": known.descriptions.get(str(key)),
    }
    return error | {"ctx": context}


def _with_advice(error: dict[str, Any], data: object, form: type[Section]) -> dict[str, Any]:
    """The record of an unknown type, with what to write instead where that is known."""
    from mechkin_cli.schema.other_words import advice_for_type

    found: Any = data
    try:
        for step in error["loc"]:
            found = found[step]
        word = found[error["ctx"]["key"]]
    except (KeyError, IndexError, TypeError):
        return error
    advice = advice_for_type(str(error["loc"][0]), str(word), getattr(form, "in_plane", False))
    return error | {"ctx": error["ctx"] | {"advice": advice}}
