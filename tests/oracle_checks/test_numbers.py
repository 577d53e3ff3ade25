"""The oracle's numbers against those of mpmath, which shares no arithmetic with them."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from oracle.numerics import Numbers, UnsolvableError, mp, mpmath_context as other

UNIT = mp.mpf(2) ** -199
"""A sixteenth of a unit in the 60th digit."""
PLACES = ("0.3", "0.01", "-0.7", "1e-30", "0.999")
NUMBERS = (*PLACES, "-12.5", "3141592.65358979", "1e40", "-0.5", "1.5", "2.5", "0")


def compare(found: Any, expected: Any) -> None:
    expected = mp.mpf(expected)
    assert abs(found - expected) <= UNIT * abs(expected)


@pytest.mark.parametrize("text", NUMBERS)
def test_texts_and_operations(text: str) -> None:
    a, b = mp.mpf(text), other.mpf(text)
    compare(a, b)
    for power in (2, 3, 7):
        compare(a**power, b**power)
    compare(a * mp.mpf("0.7") + 3, b * other.mpf("0.7") + 3)
    compare(a / 7 - 1, b / 7 - 1)
    assert float(a) == float(text)


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "atan", "floor", "nint", "sign", "radians"])
@pytest.mark.parametrize("text", NUMBERS)
def test_functions_of_any_number(name: str, text: str) -> None:
    compare(getattr(mp, name)(text), getattr(other, name)(other.mpf(text)))


@pytest.mark.parametrize("name", ["exp", "asin", "acos", "degrees"])
@pytest.mark.parametrize("text", PLACES)
def test_functions_of_small_numbers(name: str, text: str) -> None:
    compare(getattr(mp, name)(text), getattr(other, name)(other.mpf(text)))


@pytest.mark.parametrize("name", ["sqrt", "log"])
@pytest.mark.parametrize("text", [n for n in NUMBERS if float(n) > 0])
def test_functions_of_positive_numbers(name: str, text: str) -> None:
    compare(getattr(mp, name)(text), getattr(other, name)(other.mpf(text)))


@pytest.mark.parametrize("x", PLACES)
@pytest.mark.parametrize("y", PLACES)
def test_functions_of_two(x: str, y: str) -> None:
    a, b, c, d = mp.mpf(x), mp.mpf(y), other.mpf(x), other.mpf(y)
    compare(mp.atan2(a, b), other.atan2(c, d))
    compare(mp.hypot(a, b), other.hypot(c, d))
    compare(mp.fmod(a, b), other.fmod(c, d))
    compare(mp.fsum([a, b, 1]), other.fsum([c, d, 1]))
    compare(mp.fdot([a, b], [b, 3]), other.fdot([c, d], [d, 3]))
    compare(mp.norm([a, b, 2]), other.norm(other.matrix([c, d, 2])))
    for one, known in zip(mp.cos_sin(a), other.cos_sin(c), strict=True):
        compare(one, known)


def test_zeros() -> None:
    compare(
        mp.findroot(lambda x: mp.cos(x) - x, 0.7), other.findroot(lambda x: other.cos(x) - x, 0.7)
    )
    compare(mp.findroot(lambda x: x * x - 2, 1.4), other.sqrt(2))
    with pytest.raises(UnsolvableError):
        mp.findroot(lambda x: x * x + 1, 0.3)


def test_constants() -> None:
    compare(mp.pi, +other.pi)
    compare(mp.factorial(25), other.factorial(25))
    assert mp.zero == 0
    assert mp.one == 1
    assert mp.inf > 10**400
    assert float(mp.nstr(mp.pi, 4)) == 3.142


def test_digits_are_those_that_are_asked_for() -> None:
    third = mp.one / 3
    with mp.workdps(80):
        more = mp.one / 3
        assert abs(3 * more - 1) < mp.mpf(10) ** -79
        assert abs(mp.pi - mp.mpf(str(mp.pi))) == 0
    assert abs(third - more) > mp.mpf(10) ** -70
    assert mp.one / 3 == third


def test_what_is_no_number_is_an_exception() -> None:
    with pytest.raises(ZeroDivisionError):
        mp.one / mp.zero
    for wrong in (lambda: mp.sqrt(-1), lambda: mp.acos(2), lambda: mp.inf - mp.inf):
        with pytest.raises(ArithmeticError):
            wrong()


def test_another_thread_gets_no_number_of_fewer_digits() -> None:
    caught: list[BaseException] = []

    def work() -> None:
        try:
            mp.mpf("0.1")
        except RuntimeError as error:
            caught.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert len(caught) == 1
    assert isinstance(mp, Numbers)
