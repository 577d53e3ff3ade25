"""Random expressions of numbers, written as mechkin and Python both read them, and their values in
mpmath: Python's own parser and operators are the reference."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from typing import Any

from mpmath import mp

NAMES = {"x": (0.4, -1.5, 2.0), "y": (1.7, 0.25, -3.0), "n": (2.0, 1.0, -4.0)}
"""Three rows of each name, exact in binary."""

_LARGEST = 1e4
"""Beyond this a value is not followed: its digits would measure the conditioning of the text."""


class NotFollowed(ArithmeticError):
    """A part of the text has no value, or a large one."""


def _bounded(value: Any) -> Any:
    if isinstance(value, mp.mpc) or not abs(value) < _LARGEST:
        raise NotFollowed
    return value


def _of(function: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *values: _bounded(function(*map(mp.mpf, values)))


def _nearest(x: Any) -> Any:
    """As Python's round: of two the even one."""
    low = mp.floor(x)
    if x - low == 0.5:
        return low if low % 2 == 0 else low + 1
    return mp.floor(x + 0.5)


def _stepping(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function with steps, not followed where its argument is rounded and lies on one."""

    def apply(*values: Any) -> Any:
        at = mp.mpf(values[0]) / mp.mpf(values[1]) if len(values) > 1 else mp.mpf(values[0])
        is_on_step = abs(2 * at - mp.nint(2 * at)) < mp.mpf("1e-30")
        if is_on_step and any(mp.mpf(float(one)) != one for one in (at, *values)):
            raise NotFollowed
        return _of(function)(*values)

    return apply


WORDS: dict[str, Callable[..., Any]] = {
    name: _of(getattr(mp, name))
    for name in ("sqrt", "exp", "log", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh")
}
WORDS |= {"abs": _of(abs), "sign": _of(mp.sign), "min": _of(min), "max": _of(max)}
WORDS |= {
    "hypot": _of(mp.hypot),
    "floor": _stepping(mp.floor),
    "ceil": _stepping(mp.ceil),
    "round": _stepping(_nearest),
    "mod": _stepping(lambda a, b: a - b * mp.floor(a / b)),
    "clip": _of(lambda x, low, high: min(max(x, low), high)),
    "choice": lambda truth, a, b: _bounded(a if truth else b),
}
WORDS |= {
    "sine": _of(mp.sin),
    "wave": _of(mp.cos),
    "slope": _of(mp.atan),
}
ANGLES = {"sine": "sin(1 rad*", "wave": "cos(1 rad*", "slope": "1/(1 rad)*atan("}
"""Functions of or to angles, and how mechkin's begin."""

ARITY = {"min": 2, "max": 2, "hypot": 2, "mod": 2, "clip": 3}


def number(draw: random.Random, depth: int) -> str:
    """A text whose value is a number, its own numbers exact in binary."""
    kind = draw.randrange(9) if depth else draw.randrange(2)
    if kind == 0:
        return draw.choice(["0", "1", "0.5", "3", "2.25", "0.125", "64"])
    if kind == 1:
        return draw.choice([*NAMES])
    if kind <= 4:
        sign = draw.choice(["+", "-", "*", "/", "-", "+"])
        return f"{_part(draw, depth)} {sign} {_part(draw, depth)}"
    if kind == 5:
        return f"-{_part(draw, depth)}" if draw.random() < 0.5 else f"{_part(draw, depth)}^2"
    if kind == 6:
        branches = f"{number(draw, depth - 1)}, {number(draw, depth - 1)}"
        return f"choice({condition(draw, depth - 1)}, {branches})"
    name = draw.choice([name for name in WORDS if name != "choice"])
    arguments = ", ".join(number(draw, depth - 1) for _ in range(ARITY.get(name, 1)))
    return f"({name}(({arguments})))" if name in ANGLES else f"{name}({arguments})"


def condition(draw: random.Random, depth: int) -> str:
    """A text whose value is a truth."""
    kind = draw.randrange(5) if depth else 0
    if kind == 1:
        return f"not {condition(draw, depth - 1)}"
    if kind in (2, 3):
        word = draw.choice(["and", "or"])
        return f"{condition(draw, depth - 1)} {word} {condition(draw, depth - 1)}"
    if kind == 4:
        return f"({condition(draw, depth - 1)})"
    sign = draw.choice(["<", "<=", ">", ">=", "==", "!="])
    return f"{number(draw, max(depth - 1, 0))} {sign} {number(draw, max(depth - 1, 0))}"


def _part(draw: random.Random, depth: int) -> str:
    text = number(draw, depth - 1)
    return f"({text})" if " " in text or text.startswith("-") else text


def written(text: str) -> str:
    """The text as mechkin reads it."""
    for name, beginning in ANGLES.items():
        text = text.replace(f"{name}(", beginning)
    return text.replace("choice(", "if(")


def value(text: str, row: int) -> mp.mpf | None:
    """The value in a row, to the digits of mpmath; None where a part has none."""
    names = {name: mp.mpf(rows[row]) for name, rows in NAMES.items()}
    source = "".join(_exact_numbers(text)).replace("^", "**")
    words = {**WORDS, "mpf": mp.mpf}
    try:
        return _bounded(mp.mpf(eval(source, {"__builtins__": {}}, {**words, **names})))
    except (NotFollowed, ZeroDivisionError, ValueError, TypeError):
        return None


def _exact_numbers(text: str) -> list[str]:
    """The text with decimals as mpmath has them."""
    return [f"mpf('{part}')" if part[:1].isdigit() else part for part in _split(text)]


def _split(text: str) -> list[str]:
    return re.split(r"(?<![\w.])([0-9][0-9.]*(?:e-?[0-9]+)?)", text)
