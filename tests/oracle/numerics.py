"""Numbers of 60 digits, and linear equations by elimination.

They are those of MPFR, whose operations are rounded correctly and take a tenth of the time that
those of mpmath take; `oracle_checks/test_numbers.py` compares the functions with mpmath's. What is
no number (a root of -1, 1/0) is an exception.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from typing import Any

import gmpy2
import mpmath
from mpmath import MPContext
from mpmath.libmp import from_man_exp

Number = Any  # of `mp.mpf`


class Numbers:
    """Numbers of so many digits: their constants and functions by the names of mpmath."""

    zero, one, inf = gmpy2.mpfr(0), gmpy2.mpfr(1), gmpy2.inf()

    def __init__(self, digits: int) -> None:
        self.dps = digits

    @property
    def dps(self) -> int:
        """Digits of everything computed afterwards."""
        return self._digits

    @dps.setter
    def dps(self, digits: int) -> None:
        self._digits = digits
        self._bits = math.ceil((digits + 1) * math.log2(10))
        context = gmpy2.get_context()
        context.precision = self._bits
        context.trap_divzero = context.trap_invalid = True

    @contextmanager
    def workdps(self, digits: int) -> Iterator[None]:
        before = self.dps
        self.dps = digits
        try:
            yield
        finally:
            self.dps = before

    def mpf(self, value: Any = 0) -> Number:
        """A number of a text, an integer, a float, a fraction or a number of mpmath."""
        if gmpy2.get_context().precision != self._bits:
            raise RuntimeError("numbers have their digits in the thread that imports the oracle")
        if not isinstance(value, gmpy2.mpfr) and hasattr(value, "_mpf_"):
            sign, digits, power, _ = value._mpf_
            whole = gmpy2.mpfr(-int(digits) if sign else int(digits))
            return gmpy2.mul_2exp(whole, power) if power > 0 else gmpy2.div_2exp(whole, -power)
        return gmpy2.mpfr(value)

    @property
    def pi(self) -> Number:
        return _pi(self._bits)

    def cos_sin(self, angle: Any) -> tuple[Number, Number]:
        sine, cosine = gmpy2.sin_cos(self.mpf(angle))
        return cosine, sine

    def atan2(self, y: Any, x: Any) -> Number:
        return gmpy2.atan2(self.mpf(y), self.mpf(x))

    def hypot(self, x: Any, y: Any) -> Number:
        return gmpy2.hypot(self.mpf(x), self.mpf(y))

    def factorial(self, count: int) -> Number:
        return self.mpf(math.factorial(count))

    def radians(self, angle: Any) -> Number:
        return self.mpf(angle) * self.pi / 180

    def degrees(self, angle: Any) -> Number:
        return self.mpf(angle) * 180 / self.pi

    def nint(self, value: Any) -> Number:
        """The nearest integer, the even one of two."""
        return gmpy2.rint(self.mpf(value))

    def fsum(self, values: Iterable[Any]) -> Number:
        return gmpy2.fsum([self.mpf(value) for value in values])

    def fdot(self, first: Iterable[Any], second: Iterable[Any]) -> Number:
        return self.fsum(self.mpf(a) * b for a, b in zip(first, second, strict=True))

    def norm(self, vector: Iterable[Any]) -> Number:
        return self.sqrt(self.fsum(self.mpf(value) ** 2 for value in vector))

    def fmod(self, value: Any, by: Any) -> Number:
        return self.mpf(value) % self.mpf(by)

    def findroot(self, function: Callable[[Number], Number], near: Any) -> Number:
        """A simple zero, by the secant method from a place and from a quarter more.

        Raises:
            UnsolvableError: it is not found, or only to half of the digits.
        """
        here, there = self.mpf(near), self.mpf(near) + self.one / 4
        value, other = function(here), function(there)
        for _ in range(100):
            if other in (value, 0):
                break
            step = other * (there - here) / (other - value)
            here, there, value = there, there - step, other
            other = function(there)
        if abs(other) > self.mpf(10) ** (-self.dps // 2):
            raise UnsolvableError(f"no zero near {self.nstr(near, 10)}")
        return there

    def nstr(self, value: Any, digits: int) -> str:
        return f"{self.mpf(value):.{digits}g}"

    @staticmethod
    def in_mpmath(value: Number) -> mpmath.mpf:
        """The same number for mpmath, which does not know these: it takes zero for another."""
        if not gmpy2.is_finite(value):
            raise ValueError(f"{value} is no number")
        digits, power = value.as_mantissa_exp()
        return mpmath.mp.make_mpf(from_man_exp(int(digits), int(power)))


def _function(name: str) -> Any:
    compute = getattr(gmpy2, name)
    return lambda self, value: compute(self.mpf(value))


for _name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "log", "floor", "sign"):
    setattr(Numbers, _name, _function(_name))


@cache
def _pi(bits: int) -> Number:
    return gmpy2.const_pi(bits)


mp = Numbers(60)

mpmath_context = MPContext()
"""mpmath with as many digits: for matrices, roots and derivatives of closed forms. Its numbers and
those of `mp` are not mixed: `mp.mpf` and `mp.in_mpmath` turn one into the other."""
mpmath_context.dps = 60


class UnsolvableError(ArithmeticError):
    """No solution, more than one, or Newton's method did not reach it."""


def linear_solve(matrix: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number]:
    """Solve `matrix` x = `right`; with more equations than unknowns in the sense of least squares.

    Least squares go through the normal equations: half of the 60 digits remain, and consistent
    equations are solved exactly by the Newton steps around them.
    """
    unknowns = len(matrix[0]) if matrix else 0
    if len(matrix) < unknowns:
        raise UnsolvableError(f"{len(matrix)} equations for {unknowns} unknowns")
    if len(matrix) > unknowns:
        columns = list(zip(*matrix, strict=True))
        right = [mp.fsum(a * b for a, b in zip(c, right, strict=True)) for c in columns]
        matrix = [
            [mp.fsum(a * b for a, b in zip(c, d, strict=True)) for d in columns] for c in columns
        ]
    return _eliminate([[*row, value] for row, value in zip(matrix, right, strict=True)])


def _eliminate(rows: list[list[Number]]) -> list[Number]:
    """Gaussian elimination with partial pivoting on rows scaled by their largest entry."""
    count = len(rows)
    for row in rows:
        largest = max((abs(value) for value in row[:count]), default=mp.zero)
        if largest == 0:
            raise UnsolvableError("an equation without unknowns: the matrix is singular")
        row[:] = [value / largest for value in row]
    for k in range(count):
        pivot = max(range(k, count), key=lambda i: abs(rows[i][k]))
        if abs(rows[pivot][k]) < mp.mpf(10) ** (-mp.dps * 3 // 4):
            raise UnsolvableError("the matrix is singular")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, count):
            if rows[i][k] != 0:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    solution = [mp.zero] * count
    for k in reversed(range(count)):
        known = mp.fsum(rows[k][j] * solution[j] for j in range(k + 1, count))
        solution[k] = (rows[k][count] - known) / rows[k][k]
    return solution
