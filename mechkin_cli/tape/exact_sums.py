"""Sums of products of what exact numbers are made of, in a form in which equal ones meet.

A term is a rational number times e(t), a root of unity, times exp(i a) for a real a, times powers
of generators. e(t) = exp(2 pi i t) stands for the sines of parts of a turn, exp(i a) for those of
other angles. Roots of unity are told in the basis of powers below (p - 1)/p of a turn in each prime
p (L. C. Washington, Introduction to Cyclotomic Fields, 1997, chapter 2), so that a sum of them is
zero only where it is empty. Between the other factors no relations are known but those of their
products: a sum that comes out empty is zero, one that does not may be.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from math import isqrt
from typing import NamedTuple

Powers = tuple[tuple[int, int], ...]
"""Generators with their exponents, which are not zero, in order."""

Angle = tuple[tuple[Powers, Fraction], ...]
"""The parts of an angle in rad other than parts of a turn, each a product with its factor."""

LARGEST_PRIME = 97
"""Roots of unity of larger primes are left as they are: each would become a long sum."""

MOST_TERMS = 1024
"""Of a sum; longer ones are given up."""


class Monomial(NamedTuple):
    """e(turn) exp(i angle) times powers of generators; the turn is in [0, 1)."""

    turn: Fraction
    angle: Angle
    powers: Powers


Sum = Mapping[Monomial, Fraction]
"""Factors of monomials, none of them zero."""

NO_TURN = Fraction(0)
UNIT = Monomial(NO_TURN, (), ())
ZERO: Sum = {}
ONE: Sum = {UNIT: Fraction(1)}


class Undecided(ValueError):
    """A sum grew too long, or a number is not made of what is known."""


def number(value: Fraction | int) -> Sum:
    """A rational number."""
    return {UNIT: Fraction(value)} if value else ZERO


def phase(turn: Fraction, angle: Angle) -> Sum:
    """e(turn) exp(i angle)."""
    return _collected((Monomial(t, angle, ()), sign) for t, sign in _told(turn % 1))


def power(generator: int) -> Sum:
    """A generator."""
    return {Monomial(NO_TURN, (), ((generator, 1),)): Fraction(1)}


def added(a: Sum, b: Sum) -> Sum:
    """a + b."""
    return _collected((*a.items(), *b.items()))


def scaled(factor: Fraction, a: Sum) -> Sum:
    """A rational number times a sum."""
    return {monomial: factor * value for monomial, value in a.items()} if factor else ZERO


def multiplied(a: Sum, b: Sum) -> Sum:
    """a b; powers of generators just add."""
    if len(a) * len(b) > MOST_TERMS * 4:
        raise Undecided("a product has too many terms")
    return _collected(_products(a, b))


def merged(a: tuple[tuple[Powers, Fraction], ...], b: Angle) -> Angle:
    """The sum of two angles."""
    found = dict(a)
    for key, value in b:
        found[key] = found.get(key, NO_TURN) + value
    return tuple(sorted((key, value) for key, value in found.items() if value))


def opposite(angle: Angle) -> Angle:
    """The angle reversed."""
    return tuple((key, -value) for key, value in angle)


def with_powers(a: Powers, b: Powers) -> Powers:
    """The product of two products of generators."""
    found = dict(a)
    for generator, exponent in b:
        found[generator] = found.get(generator, 0) + exponent
    return tuple(sorted((key, value) for key, value in found.items() if value))


def rational(a: Sum) -> Fraction | None:
    """The rational number that a sum is; None where it is not told as one."""
    if not a:
        return Fraction(0)
    return a[UNIT] if len(a) == 1 and UNIT in a else None


def _products(a: Sum, b: Sum) -> Iterator[tuple[Monomial, Fraction]]:
    for one, factor in a.items():
        for other, second in b.items():
            angle = merged(one.angle, other.angle)
            powers = with_powers(one.powers, other.powers)
            for turn, sign in _told((one.turn + other.turn) % 1):
                yield Monomial(turn, angle, powers), sign * factor * second


def _collected(terms: Iterable[tuple[Monomial, Fraction | int]]) -> Sum:
    found: dict[Monomial, Fraction] = {}
    for monomial, value in terms:
        found[monomial] = found.get(monomial, NO_TURN) + value
    found = {monomial: value for monomial, value in found.items() if value}
    if len(found) > MOST_TERMS:
        raise Undecided("a sum has too many terms")
    return found


@lru_cache(maxsize=4096)
def _told(turn: Fraction) -> tuple[tuple[Fraction, int], ...]:
    """A root of unity in the basis: its members with their signs."""
    found = [(turn, 1)]
    for prime in _primes(turn.denominator):
        found = [part for t, sign in found for part in _without_last(t, sign, prime)]
    return tuple(found)


def _without_last(turn: Fraction, sign: int, prime: int) -> list[tuple[Fraction, int]]:
    """The p roots of order p add up to zero: the last is the sum of the others, reversed."""
    if _part(turn, prime) * prime < prime - 1:
        return [(turn, sign)]
    return [((turn - Fraction(j, prime)) % 1, -sign) for j in range(1, prime)]


def _part(turn: Fraction, prime: int) -> Fraction:
    """What a turn is in the powers of a prime, in [0, 1)."""
    whole, rest = 1, turn.denominator
    while rest % prime == 0:
        whole, rest = whole * prime, rest // prime
    if whole == 1:
        return NO_TURN
    return Fraction(turn.numerator * pow(rest, -1, whole) % whole, whole)


def _primes(count: int) -> list[int]:
    return [p for p in range(2, LARGEST_PRIME + 1) if count % p == 0 and _is_prime(p)]


def _is_prime(count: int) -> bool:
    return all(count % k for k in range(2, isqrt(count) + 1))
