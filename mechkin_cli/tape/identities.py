"""Whether exact numbers are zero, decided by identities and never by rounding.

A recorded number is a quotient of two sums: numbers of the text are rational, parts of a turn
become roots of unity, other angles exponentials, for which sin^2 + cos^2 = 1 and the sums of angles
hold by themselves; roots are generators whose squares are known. A number is zero where its
numerator comes out empty. One that is off in any digit of the text is another rational number; a
number that is zero by an identity that is not known here is not found to be zero.

A term of a sum is a rational number times e(t), a root of unity, times exp(i a) for a real a, times
powers of generators. e(t) = exp(2 pi i t) stands for the sines of parts of a turn, exp(i a) for
those of other angles. Roots of unity are written in the basis of powers below (p - 1)/p of a turn
in each prime p (L. C. Washington, Introduction to Cyclotomic Fields, 1997, chapter 2), so that a
sum of them is zero only where it is empty. Between the other factors no relations are known but
those of their products: a sum that comes out empty is zero, one that does not may be.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache, reduce
from math import isqrt
from typing import TYPE_CHECKING, Any

from mechkin_cli.exact import PI
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape.recorder import register
from mechkin_cli.tape.tape import Operation

if TYPE_CHECKING:
    from mechkin_cli.tape.exact import ExactRecorder


Powers = tuple[tuple[int, int], ...]
"""Generators with their exponents, which are not zero, in order."""

Angle = tuple[tuple[Powers, Fraction], ...]
"""The parts of an angle in rad other than parts of a turn, each a product with its factor."""

LARGEST_PRIME = 97
"""Roots of unity of larger primes are left as they are: each would become a long sum."""

MOST_TERMS = 1024
"""Of a sum; longer ones are not decided."""


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


class SumUndecided(ValueError):
    """A sum grew too long, or a number has no form as a sum."""


def rational_sum(value: Fraction | int) -> Sum:
    """A rational number."""
    return {UNIT: Fraction(value)} if value else ZERO


def phase(turn: Fraction, angle: Angle) -> Sum:
    """e(turn) exp(i angle)."""
    return _collected((Monomial(t, angle, ()), sign) for t, sign in _in_basis(turn % 1))


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
        raise SumUndecided("a product has too many terms")
    return _collected(_products(a, b))


def opposite(angle: Angle) -> Angle:
    """The angle reversed."""
    return tuple((key, -value) for key, value in angle)


def merged(*terms: tuple[Any, Any]) -> tuple[tuple[Any, Any], ...]:
    """The sum of angles, or the product of products of generators, from all their parts."""
    return tuple(sorted(_totals(terms).items()))


def _totals(terms: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
    """The sums of the values of equal keys that are not zero."""
    total: dict[Any, Any] = {}
    for key, value in terms:
        total[key] = total.get(key, 0) + value
    return {key: value for key, value in total.items() if value}


def rational(a: Sum) -> Fraction | None:
    """The rational number that a sum is; None where it has another form."""
    if not a:
        return Fraction(0)
    return a[UNIT] if len(a) == 1 and UNIT in a else None


def _products(a: Sum, b: Sum) -> Iterator[tuple[Monomial, Fraction]]:
    for one, factor in a.items():
        for other, second in b.items():
            angle = merged(*one.angle, *other.angle)
            powers = merged(*one.powers, *other.powers)
            for turn, sign in _in_basis((one.turn + other.turn) % 1):
                yield Monomial(turn, angle, powers), sign * factor * second


def _collected(terms: Iterable[tuple[Monomial, Fraction | int]]) -> Sum:
    total = _totals(terms)
    if len(total) > MOST_TERMS:
        raise SumUndecided("a sum has too many terms")
    return total


@lru_cache(maxsize=4096)
def _in_basis(turn: Fraction) -> tuple[tuple[Fraction, int], ...]:
    """A root of unity as the members of the basis with their signs."""
    members = [(turn, 1)]
    for prime in range(2, LARGEST_PRIME + 1):
        if turn.denominator % prime == 0 and all(prime % k for k in range(2, isqrt(prime) + 1)):
            members = [part for t, sign in members for part in _without_last(t, sign, prime)]
    return tuple(members)


def _without_last(turn: Fraction, sign: int, prime: int) -> list[tuple[Fraction, int]]:
    """The p roots of order p add up to zero: the last is the sum of the others, reversed."""
    if _part(turn, prime) * prime < prime - 1:
        return [(turn, sign)]
    return [((turn - Fraction(j, prime)) % 1, -sign) for j in range(1, prime)]


def _part(turn: Fraction, prime: int) -> Fraction:
    """The part of a turn in the powers of a prime, in [0, 1)."""
    whole, rest = 1, turn.denominator
    while rest % prime == 0:
        whole, rest = whole * prime, rest // prime
    if whole == 1:
        return NO_TURN
    return Fraction(turn.numerator * pow(rest, -1, whole) % whole, whole)


_PI = 0
"""The generator of pi."""

_BITS_OF_A_PART = 100
"""Of the denominator of a part of pi at most: in a number that is not one, the digits of pi are
left, which have twice as many."""

_LARGEST_FACTOR = 1000
"""Prime factors up to this one are separated in the root of a rational number."""

_LARGEST_GAUSS = 7
"""Roots of primes up to this one are sums of roots of unity: cos(30 deg) is root(3)/2."""

_HALF = Fraction(1, 2)


class Quotient(NamedTuple):
    """above / below, where below is not zero."""

    above: Sum
    below: Sum = ONE


class Identities:
    """The numbers of a recording that are identically zero.

    Args:
        recorder: that holds the numbers.
    """

    def __init__(self, recorder: ExactRecorder) -> None:
        self.recorder = recorder
        self._read: dict[int, Quotient | None] = {}
        self._generators: dict[object, int] = {"pi": _PI}
        self._squares: dict[int, Sum] = {}
        self._circles: dict[int, tuple[Quotient, Quotient]] = {}

    def is_zero(self, value: object) -> bool:
        """Whether a recorded number, or a constant, is zero by an identity; False where it is not
        zero, and where no identity is found."""
        number = self.recorder.origin(register(self.recorder, value))
        for step, operation, operands in self.recorder.steps_to(number):
            if step not in self._read:
                self._read[step] = None
                with suppress(SumUndecided):
                    self._read[step] = self._quotient(step, operation, operands)
        quotient = self._read[number]
        return quotient is not None and not quotient.above

    def _quotient(
        self, number: int, operation: Operation | None, operands: Iterable[int]
    ) -> Quotient | None:
        """A number whose operands have been read; None where it has no form as a quotient."""
        if operation is None:
            return self._written(number)
        quotients = [self._read[operand] for operand in operands]
        rule = _RULES.get(operation)
        return None if rule is None or None in quotients else rule(self, *quotients)

    def _written(self, number: int) -> Quotient | None:
        value = self.recorder.exact.get(number)
        if value is None:  # not finite
            return None
        part = value / PI
        if part and part.denominator.bit_length() <= _BITS_OF_A_PART:
            return Quotient(scaled(part, power(_PI)))
        return Quotient(rational_sum(value))

    def _times(self, a: Sum, b: Sum) -> Sum:
        """a b, with the squares of roots put in."""
        total: Sum = {}
        for monomial, factor in multiplied(a, b).items():
            powers, squares = [], []
            for generator, exponent in monomial.powers:
                if generator in self._squares:
                    squares += [self._squares[generator]] * (exponent // 2)
                    exponent %= 2
                if exponent:
                    powers.append((generator, exponent))
            term: Sum = {Monomial(monomial.turn, monomial.angle, tuple(powers)): factor}
            for square in squares:
                term = self._times(term, square)
            total = added(total, term)
        return total

    def total(self, a: Quotient, b: Quotient) -> Quotient:
        """a + b."""
        if a.below == b.below:
            return self.shortened(added(a.above, b.above), a.below)
        above = added(self._times(a.above, b.below), self._times(b.above, a.below))
        return self.shortened(above, self._times(a.below, b.below))

    def product(self, a: Quotient, b: Quotient) -> Quotient:
        """a b."""
        return self.shortened(self._times(a.above, b.above), self._times(a.below, b.below))

    def ratio(self, a: Quotient, b: Quotient) -> Quotient:
        """a / b.

        Raises:
            SumUndecided: b is zero.
        """
        if not b.above:
            raise SumUndecided("a quotient by zero")
        return self.shortened(self._times(a.above, b.below), self._times(a.below, b.above))

    def shortened(self, above: Sum, below: Sum) -> Quotient:
        """A quotient, whose single term below becomes a factor above."""
        if not above:
            return Quotient(ZERO)
        if above == below:
            return Quotient(ONE)
        if len(below) != 1:
            return Quotient(above, below)
        ((monomial, factor),) = below.items()
        inverse = scaled(1 / factor, phase(-monomial.turn, ()))
        left, powers = ONE, []
        for generator, exponent in monomial.powers:
            if generator in self._squares:
                powers.append((generator, exponent))
                left = self._times(left, self._squares[generator])
            else:
                powers.append((generator, -exponent))
        rest: Sum = {Monomial(UNIT.turn, opposite(monomial.angle), tuple(powers)): Fraction(1)}
        above = self._times(self._times(above, inverse), rest)
        return Quotient(above) if left == ONE else self.shortened(above, left)

    def generator(self, key: object) -> int:
        """The generator of a key."""
        return self._generators.setdefault(key, len(self._generators))

    def root(self, a: Quotient) -> Quotient:
        """The square root of a number that is not negative."""
        if not a.above:
            return Quotient(ZERO)
        value = rational(a.above) if a.below == ONE else None
        if value is not None:
            return Quotient(self._root_of(value))
        # g = below root(above / below), of whichever sign: g^2 = above below
        key = (frozenset(a.above.items()), frozenset(a.below.items()))
        generator = self.generator(("root", key))
        self._squares[generator] = self._times(a.above, a.below)
        return self.shortened(power(generator), a.below)

    def _root_of(self, value: Fraction) -> Sum:
        if value < 0:
            raise SumUndecided("the root of a negative number")
        rest = value.numerator * value.denominator
        outside, root = Fraction(1, value.denominator), ONE
        for prime in range(2, _LARGEST_FACTOR + 1):
            count = 0
            while rest % prime == 0:
                rest, count = rest // prime, count + 1
            outside *= prime ** (count // 2)
            if count % 2:
                root = self._times(root, self._root_of_whole(prime))
        whole = isqrt(rest)
        if whole * whole == rest:
            return scaled(outside * whole, root)
        return scaled(outside, self._times(root, self._root_of_whole(rest)))

    def _root_of_whole(self, value: int) -> Sum:
        if value <= _LARGEST_GAUSS:
            return _gauss(value)
        generator = self.generator(("root", value))
        self._squares[generator] = rational_sum(value)
        return power(generator)

    def magnitude(self, a: Quotient) -> Quotient:
        """|a|: known by its square only, unless it is rational."""
        value = rational(a.above) if a.below == ONE else None
        if value is not None:
            return Quotient(rational_sum(abs(value)))
        return self.root(self.product(a, a))

    def circle(self, a: Quotient) -> tuple[Quotient, Quotient]:
        """exp(i a) and exp(-i a).

        Raises:
            SumUndecided: the angle is not a sum of rational multiples of real products.
        """
        if a.below != ONE:
            raise SumUndecided("the sine of a quotient")
        turn, angle = Fraction(0), []
        forward, back = Quotient(ONE), Quotient(ONE)
        for monomial, factor in a.above.items():
            if monomial.turn or monomial.angle:
                raise SumUndecided("the sine of sines")
            powers = monomial.powers
            single = powers[0][0] if len(powers) == 1 and powers[0][1] == 1 else None
            circle = self._circles.get(single) if single is not None else None
            if powers == ((_PI, 1),):
                turn += factor * _HALF
            elif circle is not None and factor.denominator == 1:
                one, other = circle if factor > 0 else circle[::-1]
                for _ in range(abs(factor.numerator)):
                    forward, back = self.product(forward, one), self.product(back, other)
            else:
                angle.append((powers, factor))
        parts = merged(*angle)
        return (
            self.product(forward, Quotient(phase(turn, parts))),
            self.product(back, Quotient(phase(-turn, opposite(parts)))),
        )

    def cosine(self, a: Quotient) -> Quotient:
        """cos a."""
        return self.product(Quotient(rational_sum(_HALF)), self.total(*self.circle(a)))

    def sine(self, a: Quotient) -> Quotient:
        """sin a."""
        forward, back = self.circle(a)
        half_over_i = scaled(_HALF, phase(Fraction(-1, 4), ()))
        return self.product(Quotient(half_over_i), self.total(forward, _negative(back)))

    def angle_of(self, y: Quotient, x: Quotient) -> Quotient:
        """The angle of a point, by its sine and cosine."""
        far = self.root(self.total(self.product(x, x), self.product(y, y)))
        turned = self.product(Quotient(phase(Fraction(1, 4), ())), y)
        forward, back = self.total(x, turned), self.total(x, _negative(turned))
        key = tuple(frozenset(part.items()) for quotient in (y, x) for part in quotient)
        circle = self.ratio(forward, far), self.ratio(back, far)
        generator = self.generator(("angle", key))
        self._circles[generator] = circle
        return Quotient(power(generator))

    def other_side(self, a: Quotient) -> Quotient:
        """sqrt(1 - a^2)."""
        return self.root(self.total(Quotient(ONE), _negative(self.product(a, a))))


def _negative(a: Quotient) -> Quotient:
    return Quotient(scaled(Fraction(-1), a.above), a.below)


def _gauss(prime: int) -> Sum:
    """The root of a small prime, or of 1, by Gauss's sum over e(k k / p): i root(p) where p is 3
    more than a multiple of 4."""
    if prime == 1:
        return ONE
    if prime == 2:
        eighth = Fraction(1, 8)
        return added(phase(eighth, ()), phase(-eighth, ()))
    back = Fraction(-1, 4) if prime % 4 == 3 else Fraction(0)
    return reduce(added, (phase(Fraction(k * k, prime) + back, ()) for k in range(prime)), ZERO)


_RULES: dict[Operation, Callable[..., Quotient]] = {
    Operation.ADD: Identities.total,
    Operation.SUBTRACT: lambda own, a, b: own.total(a, _negative(b)),
    Operation.MULTIPLY: Identities.product,
    Operation.DIVIDE: Identities.ratio,
    Operation.NEGATE: lambda own, a: _negative(a),
    Operation.MAGNITUDE: Identities.magnitude,
    Operation.SQUARE_ROOT: Identities.root,
    Operation.SIN: Identities.sine,
    Operation.COS: Identities.cosine,
    Operation.TAN: lambda own, a: own.ratio(own.sine(a), own.cosine(a)),
    Operation.ASIN: lambda own, a: own.angle_of(a, own.other_side(a)),
    Operation.ACOS: lambda own, a: own.angle_of(own.other_side(a), a),
    Operation.ATAN: lambda own, a: own.angle_of(a, Quotient(ONE)),
    Operation.ATAN2: Identities.angle_of,
}
