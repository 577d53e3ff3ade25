"""Other values of parameters in the text of a mechanism file, in the units that stand there."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from math import isfinite
from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.building.written_numbers import file_numbers
from mechkin_cli.diagnostics import UsageError, nearest
from mechkin_cli.expressions import ExpressionError, NumberNode, evaluate_parameters, parse_nodes
from mechkin_cli.reading import KeyPath, edited, value_spans
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import UnitSystem, conversion

if TYPE_CHECKING:
    from mechkin_cli.building.builder import Built

_UNIT_BEHIND = re.compile(r"[ \t]*[-+]?[ \t]*(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")

_MOST_DIGITS = 15
"""Digits of a value in another unit than the file's: more would write down its rounding."""


class Edited(NamedTuple):
    """A text with other values of parameters.

    Attributes:
        text: of the file.
        written: what parameters say now, by name.
        expressions: what those say that were left alone, since they are written with others and do
            not have their values by following these.
    """

    text: str
    written: dict[str, str]
    expressions: dict[str, str]


def edit_parameters(
    text: str, built: Built, values: Mapping[str, float], replace: Collection[str] = ()
) -> Edited:
    """A file's text with other values of some parameters: comments, order and quotes stay, and so
    do units: `4 cm` becomes `4.4 cm` for 44 in a file of mm.

    Args:
        text: of the file, with its byte order mark if it has one.
        built: the same file, checked.
        values: by name, in the file's units; those that the file has already change nothing. The
            numbers that are no parameters have the names of `file_numbers`.
        replace: those whose expressions are replaced by numbers; others are left alone.

    Raises:
        UsageError: an unknown parameter, a number that is not finite.
    """
    document, units = built.document, built.problem.units
    spans = value_spans(document.text)
    known = {
        str(path[1]): span.text.strip() for path, span in spans.items() if path[:-1] == _SECTION
    }
    numbers = {number.name: number for number in file_numbers(document)}
    written, expressions = {}, {}
    changed: dict[KeyPath, str] = {}
    for name, value in values.items():
        if name in numbers and isfinite(value):
            if value != numbers[name].value:
                changed[numbers[name].path] = _shortest(value)
            continue
        if name not in known:
            close = nearest(name, known)
            hint = f"did you mean {close}?" if close else f"it has {', '.join(known) or 'none'}"
            raise UsageError(f"{document.file} defines no parameter {name!r}; {hint}")
        if not isfinite(value):
            raise UsageError(f"{name}: {value!r} is not a number that a file can hold")
        quantity = built.problem.parameters[name]
        if value == units.from_si(float(quantity.value), quantity.dimension):  # type: ignore[arg-type]
            continue
        new = value_text(known[name], value, units)
        if new is None and name in replace:
            new = f"{_shortest(value)} {units.label(quantity.dimension)}".rstrip()
        if new is None:
            expressions[name] = known[name]
        else:
            written[name] = new
    found = evaluate_parameters(known | written, units)
    for name in list(expressions):
        follows = units.from_si(float(found[name].value), found[name].dimension)  # type: ignore[arg-type]
        if abs(follows - values[name]) <= tolerances.FOLLOWS * abs(values[name]):
            del expressions[name]
    places: dict[KeyPath, str] = {(*_SECTION, name): new for name, new in written.items()}
    written |= {one.name: changed[one.path] for one in numbers.values() if one.path in changed}
    return Edited(edited(text, places | changed), written, expressions)


_SECTION = ("parameters",)


def value_text(written: str, value: float, units: UnitSystem) -> str | None:
    """Another value in the form of a written one: with its unit, and with a blank before it or not.

    Args:
        written: a number, with a unit or without.
        value: in the file's unit of the same dimension.
        units: of the file.

    Returns:
        The text, which reads as the value; in another unit than the file's but for a rounding in
        the 15th digit. None where the text is an expression.

    Example:
        >>> value_text("4cm", 44.0, UnitSystem.from_mapping({"length": "mm"}))
        '4.4cm'
        >>> value_text("r/2", 44.0, UnitSystem())
    """
    try:
        nodes = parse_nodes(written)
    except ExpressionError:
        return None
    number = nodes[0]
    if len(nodes) != 1 or not isinstance(number, NumberNode) or number.in_pi:
        return None
    if number.unit is None:
        return _shortest(value)
    prefix = _UNIT_BEHIND.match(written)
    if prefix is None:
        return None
    unit = written[prefix.end() :].rstrip()
    dimension = number.unit.dimension
    own = conversion(number.unit.factor)
    if own != units.conversion(dimension):
        value = float(f"{own.reverse(units.to_si(value, dimension)):.{_MOST_DIGITS}g}")
    return _shortest(value) + unit


def _shortest(value: float) -> str:
    """The shortest decimal of a number, a whole one without a point."""
    return repr(float(value)).removesuffix(".0")
