"""What a mapping of the file may hold, found by following an error's location through the models.

Used only on the way to a message: the validation reports an unknown key, but not the known ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import UnionType
from typing import Annotated, Any, NamedTuple, Union, get_args, get_origin

from mechkin_cli.schema.alternatives import Tag
from mechkin_cli.schema.base import Section, fields_of
from mechkin_cli.schema.descriptions import field_descriptions


class KnownKeys(NamedTuple):
    """The keys of one kind of mapping: what each is for, answers for keys it doesn't have, and the
    name of its class."""

    descriptions: dict[str, str]
    advice: dict[str, str]
    section: str


def known_keys(top: type[Section], location: tuple[str | int, ...]) -> KnownKeys | None:
    """The keys of the mapping at a validation error's location (which includes the tags of forms).

    None where the location is no mapping with fixed keys.
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
    descriptions = {key: texts.get(field.name, "") for key, field in fields_of(section).items()}
    return KnownKeys(descriptions, section.advice, section.__name__)


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
    """The annotation without aliases and metadata, each member of a union by itself."""
    if hasattr(annotation, "__value__"):
        yield from _alternatives(annotation.__value__)
    elif get_origin(annotation) is Annotated:
        yield from _alternatives(get_args(annotation)[0])
    elif get_origin(annotation) in (Union, UnionType):
        for member in get_args(annotation):
            yield from _alternatives(member)
    else:
        yield annotation


def _tagged(annotation: Any) -> Iterator[tuple[str, Any]]:
    if hasattr(annotation, "__value__"):
        yield from _tagged(annotation.__value__)
    elif get_origin(annotation) is Annotated:
        form, *metadata = get_args(annotation)
        tags = [item.tag for item in metadata if isinstance(item, Tag)]
        if tags:
            yield tags[0], form
        else:
            yield from _tagged(form)
    elif get_origin(annotation) in (Union, UnionType):
        for member in get_args(annotation):
            yield from _tagged(member)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Section)
