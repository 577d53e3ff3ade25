"""Valid plain data to sections.

Most files are valid, and to see that takes less than to load what can tell all errors of one that
is not. So a value is taken here if it is surely valid: of the very type that an annotation names,
within its limits. Of all else the validator judges, which knows more forms of a value (a number in
a text, a section made in Python) and tells every error with its place.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from types import UnionType
from typing import Any, Literal, Union

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

Read = Callable[[Any], Any]
"""A value as it was given to the value that a section has."""


class NotSure(Exception):
    """A value of which the validator is to judge."""


def validated(section: type[AnySection], data: object) -> AnySection:
    """The section that plain data describes; raises pydantic's ValidationError."""
    try:
        found: AnySection = _section(section)(data)
        return found
    except (NotSure, ValueError, AssertionError):
        from mechkin_cli.schema.validator import judged

        return judged(section, data)


_SECTIONS: dict[type[Section], Read] = {}
_SHARED: dict[int, tuple[Any, Read]] = {}
"""What reads the values of an annotation, by its identity, which goes on with the annotation."""


def _section(section: type[Section]) -> Read:
    """What reads a section."""
    known = _SECTIONS.get(section)
    if known is not None:
        return known
    declared = fields_of(section).items()
    fields = {key: (field.name, _value(field.annotation)) for key, field in declared}
    required = {key for key, field in declared if field.required}
    defaults = {field.name: field.default for _, field in declared if not field.required}
    check = None if section.check is Section.check else section.check

    def read(data: Any) -> Section:
        if type(data) is not dict or not required <= data.keys():
            raise NotSure
        found = object.__new__(section)
        values = found.__dict__
        values.update(defaults)
        for key, value in data.items():
            field = fields.get(key)
            if field is None:
                raise NotSure
            values[field[0]] = field[1](value)
        if check is not None:
            check(found)
        return found

    _SECTIONS[section] = read
    return read


def _value(annotation: Any) -> Read:
    """What reads a value; made when the first one is met."""
    known = _SHARED.get(id(annotation))
    if known is not None:
        return known[1]

    def first(value: Any) -> Any:
        if _SHARED[id(annotation)][1] is first:
            _SHARED[id(annotation)] = annotation, _made(annotation)
        return _SHARED[id(annotation)][1](value)

    _SHARED[id(annotation)] = annotation, first
    return first


def _made(annotation: Any) -> Read:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return _section(annotation)
    rules = getattr(annotation, "__metadata__", None)
    if rules is not None:
        return _with_rules(annotation.__origin__, rules)
    if isinstance(annotation, UnionType) or getattr(annotation, "__origin__", None) is Union:
        (inner,) = (member for member in annotation.__args__ if member is not type(None))
        read = _value(inner)
        return lambda value: None if value is None else read(value)
    return _plain(annotation, Limits())


def _with_rules(inner: Any, rules: tuple[Any, ...]) -> Read:
    """What reads a value to which rules apply; one before it is shown what those behind it see."""
    read = next((_one_of(inner, rule) for rule in rules if isinstance(rule, FormChoice)), None)
    if read is None:
        limits = next((rule for rule in rules if isinstance(rule, Limits)), None)
        read = _value(inner) if limits is None else _plain(inner, limits)
    for rule in rules:
        if isinstance(rule, BeforeRule):
            read = _composed(rule.function, read)
        elif isinstance(rule, After):
            read = _composed(read, rule.function)
    return read


def _composed(first: Read, second: Read) -> Read:
    return lambda value: second(first(value))


def _one_of(union: Any, choice: FormChoice) -> Read:
    """What reads a union whose members each carry their tag."""
    readers: dict[str | None, Read] = {tagged(form)[0]: _value(form) for form in union.__args__}

    def read(value: Any) -> Any:
        form = readers.get(choice.choose(value))
        if form is None:
            raise NotSure
        return form(value)

    return read


def _plain(annotation: Any, limits: Limits) -> Read:
    """What reads a scalar, a fixed word, a list or a mapping of values of one kind."""
    if annotation is str:
        return _text(limits.pattern)
    if annotation is int:
        return _whole(limits.ge, limits.le)
    origin, arguments = annotation.__origin__, annotation.__args__
    if origin is Literal:
        return _word({value: type(value) for value in arguments})
    least, most = limits.min_length or 0, limits.max_length
    if origin is tuple:
        return _list(_value(arguments[0]), least, most)
    if origin is dict:
        return _mapping(_value(arguments[0]), _value(arguments[1]), least, most)
    raise TypeError(f"no reader for {annotation}")


def _text(pattern: str | None) -> Read:
    matches = None if pattern is None else re.compile(pattern).search

    def read(value: Any) -> Any:
        if type(value) is not str or not (value.isascii() or value.encode()):
            raise NotSure
        # a `$` of Python's also stands before the last line's end
        if matches is not None and ("\n" in value or not matches(value)):
            raise NotSure
        return value

    return read


def _whole(least: int | None, most: int | None) -> Read:
    def read(value: Any) -> Any:
        if type(value) is not int:
            raise NotSure
        if (least is not None and value < least) or (most is not None and value > most):
            raise NotSure
        return value

    return read


def _word(words: dict[Any, type]) -> Read:
    def read(value: Any) -> Any:
        if type(value) not in (str, int) or words.get(value) is not type(value):
            raise NotSure
        return value

    return read


def _list(item: Read, least: int, most: int | None) -> Read:
    def read(value: Any) -> Any:
        if type(value) not in (list, tuple) or len(value) < least:
            raise NotSure
        if most is not None and len(value) > most:
            raise NotSure
        return tuple([item(one) for one in value])

    return read


def _mapping(key: Read, item: Read, least: int, most: int | None) -> Read:
    def read(value: Any) -> Any:
        if type(value) is not dict or len(value) < least:
            raise NotSure
        if most is not None and len(value) > most:
            raise NotSure
        return {key(name): item(one) for name, one in value.items()}

    return read
