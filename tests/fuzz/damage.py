"""Small damage to the values of a sound file, most of which can still be read and means something
else: a number, a name or a unit becomes another, a key is left out, written otherwise or added."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

_WORD = r"[A-Za-z_][A-Za-z0-9_]*(?:\.[a-z_0-9]+)*"
_NUMBER = re.compile(r"(?<![\w.])-?\d*\.?\d+(?:e-?\d+)?(?![\w.])")
_NAME = re.compile(rf"(?<![\w.]){_WORD}(?!:|\w)")
_KEY = re.compile(rf"(?<![\w.]){_WORD}(?=: )")
_PAIR = re.compile(r"(?<=[{,]) *[a-zA-Z_.]+: *(?:\[[^][{}]*\]|\{[^{}]*\}|[^][{},]+)(?=[,}])")
_LINE = re.compile(r"^ +(?:- )?\S.*\n", re.MULTILINE)
_NUMBERS = ("0", "-1", "1", "1e-9", "-1e9", "1e30", "1e-320", "1e999", "0.5", "7", "-40", "2.5")
_UNITS = ("mm", "deg", "N", "s", "N*mm", "rad/s", "kg", "mm/s", "N/mm", "rpm")
_FORMS = ("abs({})", "sqrt({})", "1/({})", "-({})", "2*({})", "sin({})", "min({0}, 0)", "({})^2")


def damaged(text: str, words: Sequence[str], dice: random.Random) -> str:
    """The text with one or two changes."""
    for _ in range(dice.choice((1, 1, 1, 2))):
        start, end, new = _change(text, words, dice)
        text = text[:start] + new + text[end:]
    return text


def _change(text: str, words: Sequence[str], dice: random.Random) -> tuple[int, int, str]:
    kind = dice.choices(
        (_NUMBER, _NAME, _KEY, _PAIR, _LINE), weights=(8, 8, 1, 3, 2 if text.count("\n") > 9 else 0)
    )[0]
    places = list(kind.finditer(text))
    found = dice.choice(places)
    own, other = found.group(), dice.choice(places).group()
    if kind is _NUMBER:
        scaled = repr(float(own) * dice.choice((-1, 0.01, 100, 3)))
        new = dice.choice((dice.choice(_NUMBERS), scaled, f"{own} {dice.choice(_UNITS)}", other))
    elif kind is _NAME:
        dotted = [m.group() for m in places if ("." in m.group()) == ("." in own)]
        form = dice.choice(_FORMS).format(own)
        new = dice.choice((dice.choice(dotted), dice.choice(dotted), other, form))
    elif kind is _KEY:
        new = dice.choice((other, dice.choice(words), "x"))
    elif kind is _PAIR:
        new = dice.choice(("", f"{own},{other}", other))
    else:
        new = dice.choice(("", own + other, other))
    return found.start(), found.end(), new
