"""What all sections share: frozen, no unknown keys; and how a rule of ours refuses a value.

A section is declared by its annotations; `reader` turns them into functions when the first value
of that section is met, so that a run pays only for what its file uses, and `validator` tells what
is wrong with a value.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from inspect import get_annotations
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from pydantic_core import PydanticCustomError

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


_FIELDS: dict[type[Section], dict[str, FieldOfSection]] = {}


def fields_of(section: type[Section]) -> dict[str, FieldOfSection]:
    """The fields of a section by key, those of its base classes first."""
    if section in _FIELDS:
        return _FIELDS[section]
    found: dict[str, FieldOfSection] = {}
    for model in reversed(section.__mro__):
        for name, annotation in get_annotations(model).items():
            if name in Section.__annotations__:
                continue
            metadata = getattr(annotation, "__metadata__", ())
            key = next((item.key for item in metadata if isinstance(item, Key)), name)
            default = getattr(section, name, _REQUIRED)
            found[key] = FieldOfSection(name, annotation, default is _REQUIRED, default)
    _FIELDS[section] = found
    return found


_REQUIRED = object()


def refuse(code: str, message: str, hint: str | None = None, *at: str | int) -> PydanticCustomError:
    """The error that a validator raises.

    `at` leads from the validated value to the key or item in it that is wrong.
    """
    from pydantic_core import PydanticCustomError  # its import takes longer than reading a file

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
# Reader and validator obey `Limits`, `BeforeRule`, `After` and `FormChoice`; the JSON Schema shows
# them, and `SchemaName` and `Shown`, too.


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
    import ast
    import inspect
    from textwrap import dedent

    definition = ast.parse(dedent(inspect.getsource(model))).body[0]
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    found = {}
    for field, below in pairwise(body):
        if not (isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            found[field.target.id] = inspect.cleandoc(str(below.value.value)).replace("\n", " ")
    return found
