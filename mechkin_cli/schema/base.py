"""What all sections share: frozen, no unknown keys; and how a rule of ours refuses a value.

A section is declared by its annotations; `compiled` turns them into a validator of pydantic's core
when the first value of that section is met, so that a run pays only for what its file uses.
"""

from inspect import get_annotations
from typing import Any, ClassVar, NamedTuple, TypeVar

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
