"""Sections and the rules of their values; how annotations become validators and help texts.

A section is declared by its annotations: `Annotated[str, BeforeRule(...), ...]`. The validator
obeys `Limits`, `BeforeRule`, `After` and `FormChoice`; the JSON Schema shows them, and the other
rules, too. `pydantic.BaseModel` builds the same validators from the same annotations, but it
inspects and compiles every class when it is defined: for the sections of format 1 that took longer
than the analysis of a mechanism. Here a validator is built when the first value of its section is
met, so that a section which a file does not use costs its class body alone.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Collection
from functools import cache, partial
from inspect import get_annotations
from itertools import pairwise
from textwrap import dedent
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    TypeVar,
    Union,
    get_args,
    get_origin,
)

from pydantic_core import PydanticCustomError, SchemaValidator, core_schema as core

NOTHING: Any = {}
"""Default of a mapping that may be left out; sections are read, never changed."""


class Section:
    """A mapping of the file with fixed keys; frozen.

    The text below a field is its help text. `advice` answers keys that people are likely to try and
    that the format does not have; `editors` is added to the mapping in the JSON Schema. `tag` names
    the section among several forms of a value: by default its word at `type` or `law`. It starts
    with a parenthesis, which no key does, so that an error's location shows which steps are tags.
    """

    __slots__ = (
        "__dict__",
        "__pydantic_extra__",
        "__pydantic_fields_set__",
        "__pydantic_private__",
    )
    advice: ClassVar[dict[str, str]] = {}
    editors: ClassVar[dict[str, Any]] = {}
    tag: ClassVar[str] = ""

    def __init_subclass__(cls) -> None:
        annotations = get_annotations(cls)
        word = get_args(annotations.get("type") or annotations.get("law"))
        if len(word) == 1 and "tag" not in cls.__dict__:
            cls.tag = f"({word[0]})"

    def check(self) -> None:
        """Raises an error of `refuse` where valid fields do not go together."""

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} is frozen")


AnySection = TypeVar("AnySection", bound=Section)


def section_of(kind: type[AnySection], **values: Any) -> AnySection:
    """A section made of values that are known to be valid, and of the defaults of the others."""
    section = object.__new__(kind)
    for key, field in fields_of(kind).items():
        section.__dict__[field.name] = values.pop(key) if key in values else field.default
    if values:
        raise TypeError(f"{kind.__name__} has no {', '.join(values)}")
    return section


class Key(NamedTuple):
    """The key in the file, where it cannot be the name of a field in Python."""

    key: str


class FieldOfSection(NamedTuple):
    """A key of a section: the name of its field, the values it may have, its default."""

    name: str
    annotation: Any
    required: bool
    default: Any


def fields_of(section: type[Section]) -> dict[str, FieldOfSection]:
    """The fields of a section by key, those of its base classes first."""
    fields: dict[str, FieldOfSection] = {}
    for model in reversed(section.__mro__):
        for name, annotation in get_annotations(model).items():
            if name in Section.__annotations__:
                continue
            metadata = getattr(annotation, "__metadata__", ())
            key = next((item.key for item in metadata if isinstance(item, Key)), name)
            default = getattr(section, name, _REQUIRED)
            fields[key] = FieldOfSection(name, annotation, default is _REQUIRED, default)
    return fields


_REQUIRED = object()


def refuse(code: str, message: str, hint: str | None = None, *at: str | int) -> PydanticCustomError:
    """The error that a validator raises.

    `at` leads from the validated value to the key or item in it that is wrong.
    """
    context: dict[str, Any] = {"text": message, "hint": hint, "at": at}
    return PydanticCustomError(code, "{text}", context)


def each_once(names: tuple[str, ...]) -> tuple[str, ...]:
    """The names, if no two are the same."""
    for index, name in enumerate(names):
        if name in names[:index]:
            raise refuse("named-twice", f"{name} is named twice", "name it once", index)
    return names


STEP_OR_COUNT: dict[str, Any] = {"oneOf": [{"required": ["step"]}, {"required": ["count"]}]}
"""For editors, of sections with `from` and `to`."""


def check_step_or_count(step: Any, count: Any, what: str) -> None:
    """Raises an error unless exactly one of the two is there; `what` they count is for messages."""
    if step is None and count is None:
        raise refuse("missing-key", "from and to need a step or a count", "add one of them")
    if step is not None and count is not None:
        text = f"step and count both define the number of {what}"
        raise refuse("two-choices", text, "keep one of them", "count")


class Tag(NamedTuple):
    """The tag of one form that is not a section."""

    tag: str


def tagged(member: Any) -> tuple[str, Any, tuple[Any, ...]]:
    """The tag of a form (empty: none), the form, and its rules."""
    form, *rules = get_args(member) if get_origin(member) is Annotated else (member,)
    tags = [rule.tag for rule in rules if isinstance(rule, Tag)]
    return (tags[0] if tags else getattr(form, "tag", "")), form, tuple(rules)


class FormChoice(NamedTuple):
    """How the form of a value is chosen among several: `choose` gives its tag, or None if the word
    at `key` is not one of `words`.

    `key` and `words` are None where every value has a form.
    """

    choose: Callable[[Any], str | None]
    key: str | None = None
    words: str | None = None


def by_word(
    key: str,
    words: Collection[str],
    choose: Callable[[dict[str, Any]], str | None] | None = None,
) -> FormChoice:
    """The choice for mappings whose form is defined by the word at `key`, one of `words`.

    `choose` gives the tag of a mapping, None where the word is unknown (None: the word itself in
    parentheses); the error then names the `words`.
    """

    def tag(value: Any) -> str | None:
        # Python callers may pass a section that is already built
        mapping = value if isinstance(value, dict) else getattr(value, "__dict__", {})
        if choose is not None:
            return choose(mapping)
        word = mapping.get(key)
        return f"({word})" if isinstance(word, str) and word in words else None

    return FormChoice(tag, key, ", ".join(words))


class SchemaName(NamedTuple):
    """The name in the JSON Schema of the type with the rules before it."""

    name: str


class Limits(NamedTuple):
    """Bounds of a number, of a length, or the form of a text; None: no such bound."""

    min_length: int | None = None
    max_length: int | None = None
    ge: int | None = None
    le: int | None = None
    pattern: str | None = None


class BeforeRule(NamedTuple):
    """A function from the value as written to the value to validate."""

    function: Callable[[Any], Any]


class After(NamedTuple):
    """A function that returns or refuses the valid value."""

    function: Callable[[Any], Any]


class Shown(NamedTuple):
    """For editors, of a scalar: the JSON types it may have, a help text, examples."""

    types: tuple[str, ...]
    description: str
    examples: tuple[str | float, ...] = ()


class DimensionRule(NamedTuple):
    """The dimension of an expression in words, with examples, and the name of its definition in
    the JSON Schema: for readers and editors."""

    name: str
    examples: tuple[str | float, ...]
    schema_name: str


class ShortForm(NamedTuple):
    """For editors: a section may be written as a single value."""

    types: tuple[str, ...]
    description: str
    pattern: str | None = None


class Barred(NamedTuple):
    """A pattern that editors refuse; the reader has a rule with words of its own."""

    pattern: str


_VALIDATORS: dict[type[Section], SchemaValidator] = {}


def validated(section: type[AnySection], data: object) -> AnySection:
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


def field_descriptions(section: type[Section]) -> dict[str, str]:
    """Help texts by field name, those of base classes included: the strings below the fields in the
    source. Reading it costs more than a validation: only for messages and the JSON Schema."""
    descriptions: dict[str, str] = {}
    for model in reversed(section.__mro__):
        if model is not Section and Section in model.__mro__:
            descriptions |= _below_fields(model)
    return descriptions


@cache
def _below_fields(model: type) -> dict[str, str]:
    definition = ast.parse(dedent(inspect.getsource(model))).body[0]
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    texts = {}
    for field, below in pairwise(body):
        if not (isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            texts[field.target.id] = inspect.cleandoc(str(below.value.value)).replace("\n", " ")
    return texts
