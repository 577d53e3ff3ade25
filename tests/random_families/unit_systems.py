"""Random unit systems, and mechanism files whose numbers can be written in any of them.

A template holds its dimensional numbers in SI as `<0.04 length>`; `<0.04 length!>` is a number that
always carries its unit (a parameter has no unit of its own). All factors are this module's own.
"""

from __future__ import annotations

import random
import re
from fractions import Fraction
from math import pi

_INCH, _POUND, _GRAVITY = Fraction(254, 10000), Fraction(45359237, 10**8), Fraction(980665, 10**5)

WORDS: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": 0.0254, "ft": 0.3048},
    "angle": {"rad": 1.0, "deg": pi / 180, "turn": 2 * pi},
    "mass": {"kg": 1.0, "g": 1e-3, "t": 1e3, "lbm": float(_POUND)},
    "force": {
        "N": 1.0,
        "mN": 1e-3,
        "kN": 1e3,
        "lbf": float(_POUND * _GRAVITY),
        "lbm*in/s^2": float(_POUND * _INCH),
        "kg*m/s^2": 1.0,
    },
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "angular_rate": {"rad/s": 1.0, "rpm": pi / 30, "deg/s": pi / 180, "turn/min": pi / 30},
}
"""SI value of each unit, by entry of `units:`."""

KINDS = {
    "length": "length",
    "angle": "angle",
    "mass": "mass",
    "force": "force",
    "time": "time",
    "moment": "force length",
    "power": "force length time^-1",
    "inertia": "mass length^2",
    "velocity": "length time^-1",
    "acceleration": "length time^-2",
    "jerk": "length time^-3",
    "angular_rate": "angular_rate",
    "angular_acceleration": "angular_rate s^-1",
    "angular_jerk": "angular_rate s^-2",
    "stiffness": "force length^-1",
    "torsional_stiffness": "force length rad^-1",
    "damping": "force time length^-1",
    "torsional_damping": "force length s rad^-1",
    "viscosity": "force time length^-2",
    "pressure": "force length^-2",
    "number": "",
}
"""What a bare number of a kind is counted in: powers of the file's entries, of s and of rad."""

_NUMBER = re.compile(r"<([-+0-9.e]+) ([a-z_]+)(!?)>")


def random_words(rng: random.Random) -> dict[str, str]:
    """A unit for every entry of `units:`."""
    return {entry: rng.choice(list(words)) for entry, words in WORDS.items()}


def factor(kind: str, words: dict[str, str]) -> float:
    """The SI value of the bare number 1 of a kind, or of powers of units, in a file of these
    units."""
    value = 1.0
    for part in KINDS.get(kind, kind).split():
        entry, _, power = part.partition("^")
        base = WORDS[entry][words[entry]] if entry in WORDS else 1.0
        value *= base ** int(power or 1)
    return value


def unit_text(kind: str, words: dict[str, str]) -> str:
    """The unit of a kind composed of these words, as text behind a number."""
    above, below = [], []
    for part in KINDS[kind].split():
        entry, _, power = part.partition("^")
        exponent = int(power or 1)
        for word, own in re.findall(r"([*/]?[A-Za-z]+)(?:\^(\d+))?", words.get(entry, entry)):
            size = int(own or 1) * exponent * (-1 if word.startswith("/") else 1)
            symbol = word.strip("*/")
            (above if size > 0 else below).append(f"{symbol}^{abs(size)}")
    text = "*".join(above) or "1"
    return text + "".join(f"/{symbol}" for symbol in below)


def written(template: str, words: dict[str, str], rng: random.Random, explicit: float) -> str:
    """The template in a unit system; a number carries a unit of its own with the chance
    `explicit`."""

    def number(found: re.Match[str]) -> str:
        value, kind, always = float(found[1]), found[2], found[3]
        if kind == "number" or not (always or rng.random() < explicit):
            return repr(value / factor(kind, words))
        own = random_words(rng)
        unit = unit_text(kind, own)
        # 1/s is no word that a number can carry
        return f"{value / factor(kind, own)!r} {unit}"

    listed = ", ".join(f'{entry}: "{word}"' for entry, word in words.items())
    return _NUMBER.sub(number, template).replace("UNITS", f"units: {{{listed}}}")


def places(template: str) -> list[re.Match[str]]:
    """The numbers of a template."""
    return list(_NUMBER.finditer(template))


def with_number(template: str, place: re.Match[str], change: float) -> str:
    """The template with one number multiplied."""
    number = f"<{float(place[1]) * change!r} {place[2]}{place[3]}>"
    return template[: place.start()] + number + template[place.end() :]
