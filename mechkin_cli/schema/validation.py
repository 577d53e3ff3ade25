"""Plain data -> `MechanismFile`, `PlaneFile` or `StudyFile`, or all independent errors as records.

A record has `type`, `loc` (keys, list indices and tags in parentheses), `msg` and `ctx`. To the
records of pydantic are added reserved and clashing names, and the keys that a mapping may have.
Joints, couplings, links, points, directions, parameters and quantities share one namespace; the
check reads plain data, so that a clash is reported together with all other errors.

Most files are valid, and to see that takes less than to load what can tell all errors of one that
is not. So a value is taken here if it is surely valid: of the very type that an annotation names,
within its limits. Of all else the validator judges, which knows more forms of a value (a number in
a text, a section made in Python) and tells every error with its place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from types import UnionType
from typing import Any, Final, Literal, Union

from mechkin_cli.diagnostics import nearest
from mechkin_cli.schema.base import (
    AnySection,
    FormChoice,
    Limits,
    Rule,
    Section,
    fields_of,
    tagged,
)
from mechkin_cli.schema.file import AnyFile, MechanismFile

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

_SECTIONS = (
    "parameters",
    "quantities",
    "links",
    "joints",
    "couplings",
    "cylinders",
    "chain",
    "points",
    "directions",
)


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
                "joints, couplings, links, points, directions, parameters and quantities share one "
                "namespace; rename one"
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
        elif section == "loads" and isinstance(content, list):
            for index, load in enumerate(content):
                name = load.get("name") if isinstance(load, dict) else None
                if isinstance(name, str):
                    yield section, name, (section, index, "name")


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
    return validated(form_of(data), data, name_errors(data))


def form_of(data: object) -> type[AnyFile]:
    """The form of a file that plain data has, or is meant to have."""
    if isinstance(data, dict) and any(_is_plane(*entry) for entry in data.items()):
        from mechkin_cli.schema.plane import PlaneFile

        return PlaneFile
    return MechanismFile


def _is_plane(key: object, value: object) -> bool:
    """Whether an entry of the file is `plane: xy`, or this misspelt."""
    return key == "plane" or (value == "xy" and nearest(str(key), ["plane"]) is not None)


def validated(
    form: type[AnySection], data: object, errors: Sequence[dict[str, Any]] = ()
) -> AnySection:
    """The section that plain data describes; raises `InvalidDataError` with all its errors, and
    with those found before."""
    found: AnySection | None
    own: list[dict[str, Any]] = []
    try:
        found = _section(form)(data)
    except (NotSure, ValueError, AssertionError):
        from mechkin_cli.schema.errors import section_or_errors

        found, own = section_or_errors(form, data)
    if errors or own or found is None:
        raise InvalidDataError([*own, *errors])
    return found


Read = Callable[[Any], Any]
"""A value as it was given to the value that a section has."""


class NotSure(Exception):
    """A value of which the validator is to judge."""


_READERS: dict[type[Section], Read] = {}
_SHARED: dict[int, tuple[Any, Read]] = {}
"""What reads the values of an annotation, by its identity, which goes on with the annotation."""


def _section(section: type[Section]) -> Read:
    known = _READERS.get(section)
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

    _READERS[section] = read
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
        if isinstance(rule, Rule):
            read = _composed(rule.function, read) if rule.before else _composed(read, rule.function)
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
    if annotation is bool:
        return _flag
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


def _flag(value: Any) -> Any:
    if type(value) is not bool:
        raise NotSure
    return value


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
