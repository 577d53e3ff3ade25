"""What all sections share: frozen, no unknown keys; and how a rule of ours refuses a value.

A section is declared by its annotations; `compiled` turns them into a validator of pydantic's core
when the first value of that section is met, so that a run pays only for what its file uses.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from functools import cache, partial
from inspect import get_annotations
from itertools import pairwise
from textwrap import dedent
from types import NoneType, UnionType
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin

from pydantic_core import PydanticCustomError, SchemaValidator, core_schema as core

from mechkin_cli.record import NamedTuple

NOTHING: Any = {}
"""Default of a mapping that may be left out; sections are read, never changed."""


class Section:
    """A mapping of the file with fixed keys.

    The text below a field is its help text. `advice` answers keys that people are likely to try and
    that the format does not have; `editors` is what the JSON Schema says of the mapping beside its
    keys.
    """

    __slots__ = (
        "__dict__",
        "__pydantic_extra__",
        "__pydantic_fields_set__",
        "__pydantic_private__",
    )
    advice: ClassVar[dict[str, str]] = {}
    editors: ClassVar[dict[str, Any]] = {}

    def check(self) -> None:
        """Raises what `refuse` makes where valid fields do not go together."""

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} is frozen")


AnySection = TypeVar("AnySection", bound=Section)


def section_of(kind: type[AnySection], **values: Any) -> AnySection:
    """A section made of values that are known to be valid, and of the defaults of the others."""
    found = object.__new__(kind)
    for key, field in fields_of(kind).items():
        found.__dict__[field.name] = values.pop(key) if key in values else field.default
    if values:
        raise TypeError(f"{kind.__name__} has no {', '.join(values)}")
    return found


class Key(NamedTuple):
    """The key in the file, where it is no name for a field of Python."""

    key: str


class FieldOfSection(NamedTuple):
    """A key of a section: the name of its field, the values it may have, its default."""

    name: str
    annotation: Any
    required: bool
    default: Any


def fields_of(section: type[Section]) -> dict[str, FieldOfSection]:
    """The fields of a section by key, those of its base classes first."""
    found: dict[str, FieldOfSection] = {}
    for model in reversed(section.__mro__):
        for name, annotation in get_annotations(model).items():
            if name in Section.__annotations__:
                continue
            metadata = getattr(annotation, "__metadata__", ())
            key = next((item.key for item in metadata if isinstance(item, Key)), name)
            default = getattr(section, name, _REQUIRED)
            found[key] = FieldOfSection(name, annotation, default is _REQUIRED, default)
    return found


_REQUIRED = object()


def refuse(code: str, message: str, hint: str | None = None, *at: str | int) -> PydanticCustomError:
    """The error that a validator raises.

    `at` leads from the validated value to the key or item in it that is wrong.
    """
    context: dict[str, Any] = {"text": message, "hint": hint, "at": at}
    return PydanticCustomError(code, "{text}", context)


# Values that come in several forms: which form is meant is told by one look at the value.
#
# Each form carries a tag. Tags start with a parenthesis, which no key of the format does, so that
# they can be told apart from keys in the location of an error.


class Tag(NamedTuple):
    """The tag of one form."""

    tag: str


class FormChoice(NamedTuple):
    """Which form a value has: `choose` gives its tag, None where the word is none of `words`.

    `key` is the key that holds the word; both are None where every value has a form.
    """

    choose: Callable[[Any], str | None]
    key: str | None = None
    words: str | None = None


def by_word(key: str, choose: Callable[[dict[str, Any]], str | None], words: str) -> FormChoice:
    """The choice for mappings in which the value of `key` says the form.

    `choose` is shown the mapping and gives the tag, None where the word is unknown; the error then
    names the `words` possible.
    """

    def tag(value: Any) -> str | None:
        return choose(_as_mapping(value))

    return FormChoice(tag, key, words)


def _as_mapping(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    # a section that is already built, as Python callers may pass
    return getattr(value, "__dict__", {})


# What an annotation may say of a value beside its Python type: `Annotated[str, Before(...), ...]`.
#
# The validator (`compiled`) obeys `Limits`, `Before`, `After` and the discriminators of
# `alternatives`; the JSON Schema shows them, and `Named` and `Shown`, too.


class SchemaName(NamedTuple):
    """The definition of the JSON Schema that the type and the rules before it make up."""

    name: str


class Limits(NamedTuple):
    """Bounds of a number, of a length, or the form of a text; None: no such bound."""

    min_length: int | None = None
    max_length: int | None = None
    ge: int | None = None
    le: int | None = None
    pattern: str | None = None


class BeforeRule(NamedTuple):
    """A function that is shown the value as it was given, and returns what is validated."""

    function: Callable[[Any], Any]


class After(NamedTuple):
    """A function that is shown the valid value, and returns or refuses it."""

    function: Callable[[Any], Any]


class Shown(NamedTuple):
    """What editors are told about a scalar: the JSON types it may have, a help text, examples."""

    types: tuple[str, ...]
    description: str
    examples: tuple[str | float, ...] = ()


class DimensionRule(NamedTuple):
    """The dimension an expression must have, in words, with examples: for readers and editors."""

    name: str
    examples: tuple[str | float, ...]


class ShortForm(NamedTuple):
    """Tells editors that a section may be written as a single value."""

    types: tuple[str, ...]
    description: str
    pattern: str | None = None


class Barred(NamedTuple):
    """A pattern that editors refuse; the reader has a rule with words of its own."""

    pattern: str


# Annotations to validators of pydantic's core, each built when its first value is met.
#
# `pydantic.BaseModel` builds the same validators from the same annotations, but it inspects and
# compiles every class when it is defined: for the sections of format 1 that took longer than the
# analysis of a mechanism. Here a section of which a file has none costs its class body alone.

_VALIDATORS: dict[type[Section], SchemaValidator] = {}


def validated(section: type[AnySection], data: object) -> AnySection:
    """The section that plain data describes; raises pydantic's ValidationError.

    The places of its errors go on from that of the section in which it stands.
    """
    validator = _VALIDATORS.get(section)
    if validator is None:
        validator = _VALIDATORS[section] = _built(section)
    found: AnySection = validator.validate_python(data)
    return found


def _built(section: type[Section]) -> SchemaValidator:
    fields = {
        field.name: core.model_field(
            _with_default(_schema(field.annotation), field.required, field.default),
            validation_alias=key,
        )
        for key, field in fields_of(section).items()
    }
    keys = core.model_fields_schema(fields, extra_behavior="forbid")
    schema: core.CoreSchema = core.model_schema(section, keys)
    if section.check is not Section.check:
        schema = core.no_info_after_validator_function(_checked, schema)
    return SchemaValidator(schema)


def _checked(section: Section) -> Section:
    section.check()
    return section


def _with_default(schema: core.CoreSchema, required: bool, default: Any) -> core.CoreSchema:
    return schema if required else core.with_default_schema(schema, default=default)


@cache
def _schema(annotation: Any) -> core.CoreSchema:
    """The schema of a value; equal annotations share one."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return core.no_info_plain_validator_function(partial(validated, annotation))
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
    choices: dict[Any, core.CoreSchema] = {}
    for member in get_args(union):
        form, *rules = get_args(member)
        tag = next(rule.tag for rule in rules if isinstance(rule, Tag))
        choices[tag] = _with_rules(form, tuple(rules))
    if choice.words is None:
        return core.tagged_union_schema(choices, choice.choose)
    return core.tagged_union_schema(
        choices,
        choice.choose,
        custom_error_type="unknown-word",
        custom_error_message=f"expected one of {choice.words}",
        custom_error_context={"key": str(choice.key), "words": choice.words},
    )


# The help text of each key: the string that stands below the field in the model's source.
#
# Read only for messages and for the JSON Schema; reading the sources costs more than a validation.


def field_descriptions(section: type[Section]) -> dict[str, str]:
    """Help texts by field name, those of base classes included."""
    descriptions: dict[str, str] = {}
    for model in reversed(section.__mro__):
        if model is not Section and Section in model.__mro__:
            descriptions |= _below_fields(model)
    return descriptions


@cache
def _below_fields(model: type) -> dict[str, str]:
    definition = ast.parse(dedent(inspect.getsource(model))).body[0]
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    found = {}
    for field, below in pairwise(body):
        if not (isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            found[field.target.id] = inspect.cleandoc(str(below.value.value)).replace("\n", " ")
    return found
