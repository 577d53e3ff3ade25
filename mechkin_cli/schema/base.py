"""Sections and the rules of their values; how annotations become validators and help texts.

A section is declared by its annotations: `Annotated[str, Rule(...), ...]`. `validation` makes
functions of them when the first value of that section is met, so that a run pays only for the
sections that its file uses, and `errors` finds the errors of a value. Both obey `Limits`, `Rule`
and `FormChoice`; the JSON Schema shows them, and the other rules, too. A text in parentheses among
the rules is the tag of a form that is not a section.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import cache
from inspect import get_annotations
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeVar, get_args, get_origin

from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from pydantic_core import PydanticCustomError

NOTHING: Any = {}
"""Default of a mapping that may be left out; sections are read, never changed."""


class Renamed(NamedTuple):
    """What a key of an earlier version is called now, by which version, and the version that takes
    only the new one."""

    new: str
    since: str
    until: str


OLD_KEYS: set[str] = set()
"""Keys that some section has renamed."""


class Section:
    """A mapping of the file with fixed keys; frozen.

    The text below a field is its help text. `keys` are the keys of fields, by the field's name,
    where they cannot be names in Python. `advice` answers keys that people are likely to try and
    that the format does not have; `renamed` keys are read, with a warning; `editors` is added to
    the mapping in the JSON Schema. `tag` names the section among several forms of a value: by
    default its word at `type` or `law`. It starts with a parenthesis, which no key does, so that an
    error's location shows which steps are tags.
    """

    __slots__ = (
        "__dict__",
        "__pydantic_extra__",
        "__pydantic_fields_set__",
        "__pydantic_private__",
    )
    keys: ClassVar[dict[str, str]] = {"first": "from", "last": "to"}
    advice: ClassVar[dict[str, str]] = {}
    renamed: ClassVar[dict[str, Renamed]] = {}
    editors: ClassVar[dict[str, Any]] = {}
    tag: ClassVar[str] = ""

    def __init_subclass__(cls) -> None:
        OLD_KEYS.update(cls.renamed)
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


def section_with(section: AnySection, **values: Any) -> AnySection:
    """A section with other values, which are known to be valid."""
    known = {key: getattr(section, one.name) for key, one in fields_of(type(section)).items()}
    return section_of(type(section), **{**known, **values})


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
    fields: dict[str, FieldOfSection] = {}
    for model in reversed(section.__mro__):
        for name, annotation in get_annotations(model).items():
            if name in Section.__annotations__:
                continue
            key, default = section.keys.get(name, name), getattr(section, name, _REQUIRED)
            fields[key] = FieldOfSection(name, annotation, default is _REQUIRED, default)
    _FIELDS[section] = fields
    return fields


_REQUIRED = object()


def refuse(code: str, message: str, hint: str | None = None, *at: str | int) -> PydanticCustomError:
    """The error that a validator raises.

    `at` leads from the validated value to the key or item in it that is wrong.
    """
    from pydantic_core import PydanticCustomError  # its import takes longer than reading a file

    context: dict[str, Any] = {"text": message, "hint": hint, "at": at}
    return PydanticCustomError(code, "{text}", context)


def one_of(section: Section, *keys: str) -> None:
    """Refuses a section that has none of some keys, or more than one.

    Raises:
        PydanticCustomError: not exactly one of them is there.
    """
    given = [key for key in keys if getattr(section, key) is not None]
    if not given:
        raise refuse("missing-key", f"one of {', '.join(keys)} is needed", "add one of them")
    if len(given) > 1:
        text = f"{' and '.join(given)} are two choices"
        raise refuse("two-choices", text, "keep one of them", given[1])


def each_once(names: tuple[str, ...]) -> tuple[str, ...]:
    """The names, if no two are the same."""
    for index, name in enumerate(names):
        if name in names[:index]:
            raise refuse("named-twice", f"{name} is named twice", "name it once", index)
    return names


class Spaced(Section):
    """A section with `from`, `to` and one of `step` and `count`, which counts the `counted`."""

    editors: ClassVar[dict[str, Any]] = {"oneOf": [{"required": ["step"]}, {"required": ["count"]}]}
    counted = "rows"
    if TYPE_CHECKING:
        step: Any
        count: Any

    def check(self) -> None:
        """Exactly one of step and count."""
        if self.step is None and self.count is None:
            raise refuse("missing-key", "from and to need a step or a count", "add one of them")
        if self.step is not None and self.count is not None:
            text = f"step and count both define the number of {self.counted}"
            raise refuse("two-choices", text, "keep one of them", "count")


def tagged(member: Any) -> tuple[str, Any, tuple[Any, ...]]:
    """The tag of a form (empty: none), the form, and its rules."""
    form, *rules = get_args(member) if get_origin(member) is Annotated else (member,)
    tag = next((rule for rule in rules if isinstance(rule, str)), getattr(form, "tag", ""))
    return tag, form, tuple(rules)


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


class Rule(NamedTuple):
    """A function that returns or refuses the valid value; `before`: one from the value as written
    to the value to validate. `barred` is a pattern of texts that it refuses, for editors."""

    function: Callable[[Any], Any]
    before: bool = False
    barred: str | None = None


class Shown(NamedTuple):
    """For editors: the JSON types that a scalar may have, a help text, examples, a pattern. With
    `is_short` it is the scalar that may be written instead of a section."""

    types: tuple[str, ...]
    description: str
    examples: tuple[str | float, ...] = ()
    pattern: str | None = None
    is_short: bool = False


class DimensionRule(NamedTuple):
    """The dimension of an expression in words, with examples, and the name of its definition in
    the JSON Schema: for readers and editors."""

    name: str
    examples: tuple[str | float, ...]
    schema_name: str


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
    import ast
    import inspect
    from textwrap import dedent

    definition = ast.parse(dedent(inspect.getsource(model))).body[0]
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    texts = {}
    for field, below in pairwise(body):
        if not (isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            texts[field.target.id] = inspect.cleandoc(str(below.value.value)).replace("\n", " ")
    return texts
