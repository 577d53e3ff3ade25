"""What is zero by an identity is found to be, and nothing else; mpmath tells which is which."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
from oracle import mp

from mechkin_cli.exact import PI
from mechkin_cli.tape.exact import ExactRecorder
from mechkin_cli.tape.identities import Identities
from mechkin_cli.tape.scalars import cos, of_one, of_two, sin, square_root


class Text:
    """Numbers as a file says them."""

    def __init__(self) -> None:
        self.recorder = ExactRecorder()
        self.is_zero = Identities(self.recorder).is_zero

    def number(self, text: str | Fraction) -> Any:
        return self.recorder.written(float(Fraction(text)), Fraction(text))

    def degrees(self, text: str) -> Any:
        return self.number(Fraction(text) * PI / 180)


@pytest.fixture
def text() -> Text:
    return Text()


ANGLES = ("0", "30", "60", "13.37", "-90", "180", "359.999", "1e-9", "123456.789")
RADIANS = ("0.3", "-2", "1e-12", "7")


@pytest.mark.parametrize("angle", [*ANGLES, *(f"{r} rad" for r in RADIANS)])
def test_sums_of_angles(text: Text, angle: str) -> None:
    number, _, unit = angle.partition(" ")
    a = text.number(number) if unit else text.degrees(number)
    b = text.degrees("17.5") + text.number("0.1")
    assert text.is_zero(sin(a) * sin(a) + cos(a) * cos(a) - 1.0)
    assert text.is_zero(sin(2 * a) - 2 * sin(a) * cos(a))
    assert text.is_zero(cos(a + b) - (cos(a) * cos(b) - sin(a) * sin(b)))
    assert text.is_zero(sin(-a) + sin(a))
    for off in ("1e-6", "1e-15", "1e-60"):
        assert not text.is_zero(sin(a) * sin(a) + cos(a) * cos(a) - 1.0 + text.number(off))


@pytest.mark.parametrize(
    ("angle", "function", "value"),
    [
        ("60", cos, "1/2"),
        ("30", sin, "1/2"),
        ("210", sin, "-1/2"),
        ("180", sin, "0"),
        ("90", cos, "0"),
        ("360", cos, "1"),
    ],
)
def test_rational_sines(text: Text, angle: str, function: Any, value: str) -> None:
    assert text.is_zero(function(text.degrees(angle)) - text.number(value))
    assert not text.is_zero(function(text.degrees(angle + ".000000001")) - text.number(value))


def test_roots(text: Text) -> None:
    root = {
        n: square_root(text.number(n)) for n in ("2", "3", "5", "6", "8", "11", "22", "1/2", "4")
    }
    assert text.is_zero(root["2"] * root["3"] - root["6"])
    assert text.is_zero(root["8"] - 2 * root["2"])
    assert text.is_zero(root["2"] * root["1/2"] - 1)
    assert text.is_zero(root["2"] * root["11"] - root["22"])
    assert text.is_zero(root["4"] - 2)
    assert text.is_zero(2 * cos(text.degrees("45")) - root["2"])
    assert text.is_zero(4 * cos(text.degrees("36")) - 1 - root["5"])
    with mp.workdps(60):
        near = text.number(Fraction(str(mp.sqrt(2))))
    assert not text.is_zero(root["2"] - near)
    assert not text.is_zero(root["2"] + root["3"] - square_root(text.number("10")))


def test_arcs(text: Text) -> None:
    angle = of_two("ATAN2", text.number("3"), text.number("4"))
    assert text.is_zero(sin(angle) - text.number("0.6"))
    assert text.is_zero(cos(2 * angle) - text.number("0.28"))
    assert text.is_zero(sin(of_one("ASIN", text.number("0.3"))) - text.number("0.3"))
    assert text.is_zero(of_one("TAN", of_one("ATAN", text.number("-2.5"))) + text.number("2.5"))
    assert not text.is_zero(sin(angle) - text.number("0.6000000000000000000001"))


def test_a_quotient_by_zero_is_nothing(text: Text) -> None:
    assert not text.is_zero(text.number("0") / sin(text.degrees("180")))


@pytest.mark.parametrize("seed", range(40))
def test_random_expressions(text: Text, seed: int) -> None:
    """What is found to be zero is below 1e-40 at 50 digits."""
    rng = random.Random(seed)
    leaves = [(text.number(n), mp.mpf(n)) for n in ("2", "3", "0.5")]
    with mp.workdps(50):
        for angle in ("30", "45", "20", "50"):
            x = mp.mpf(angle) * mp.pi / 180
            leaves += [(sin(text.degrees(angle)), mp.sin(x)), (cos(text.degrees(angle)), mp.cos(x))]
        leaves += [(square_root(text.number(n)), mp.sqrt(int(n))) for n in ("2", "3", "6")]
        for _ in range(60):
            (a, x), (b, y) = rng.choice(leaves), rng.choice(leaves)
            leaves.append(rng.choice([(a + b, x + y), (a - b, x - y), (a * b, x * y)]))
        zeros = [bool(abs(x) < mp.mpf("1e-40")) for _, x in leaves]
        assert [text.is_zero(a) for a, _ in leaves] == zeros
