"""One namespace: joints, links, points, directions and parameters must not share a name.

The check reads plain data, so that a clash is reported together with whatever else is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

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

_SECTIONS = ("parameters", "quantities", "links", "joints", "chain", "points", "directions")


def name_errors(data: object) -> list[dict[str, Any]]:
    """Reserved words and clashes among the names that a file defines, as error records with `loc`.

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
                "joints, links, points, directions, parameters and quantities share one namespace; "
                "rename one"
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


def _chain_definitions(
    row: dict[str, Any], index: int, links: object
) -> Iterator[tuple[str, str, tuple[str | int, ...]]]:
    """A row names its joint, and its link where that is neither ground nor listed in links."""
    if isinstance(row.get("joint"), str):
        yield "chain", row["joint"], ("chain", index, "joint")
    link = row.get("link")
    if (
        isinstance(link, str)
        and link != "ground"
        and not (isinstance(links, dict) and link in links)
    ):
        yield "chain", link, ("chain", index, "link")


def _error(code: str, location: tuple[str | int, ...], text: str, hint: str) -> dict[str, Any]:
    return {"type": code, "loc": location, "msg": text, "ctx": {"text": text, "hint": hint}}
