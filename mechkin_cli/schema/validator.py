"""The errors of plain data, by pydantic's core.

`pydantic.BaseModel` builds the same validators from the same annotations, but it inspects and
compiles every class when it is defined: for the sections of format 1 that took longer than the
analysis of a mechanism. Here a validator is built when the first value of its section is met, so
that a section which a file does not use costs its class body alone.
"""

from __future__ import annotations

from functools import cache, partial
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic_core import SchemaValidator, core_schema as core

from mechkin_cli.schema.base import (
    After,
    AnySection,
    BeforeRule,
    FormChoice,
    Limits,
    Section,
    fields_of,
    tagged,
)

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
        if isinstance(rule, BeforeRule):
            schema = core.no_info_before_validator_function(rule.function, schema)
        elif isinstance(rule, After):
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
