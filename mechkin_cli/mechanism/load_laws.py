"""Loads that vary: laws of coordinates, rates and time, evaluated over all rows before the forces.

A law is an expression of quantities that are known without forces, or a table's curve over one of
them. Where a law has no value (a row outside its table, a root of a negative number) the row keeps
its position and rates; what depends on the load has no value either.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.expressions import Expression, Quantity
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.tolerances import LARGEST_NUMBER, TABLE_END
from mechkin_cli.units import UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.curve import Curve

Resolve = Callable[[str], Quantity]


class LoadLaw(NamedTuple):
    """The value of a load in SI: `expression`, or `curve` over the one quantity that is read.

    `reads` are the names of the quantities that the law depends on; `place` is where the file
    says it.
    """

    reads: tuple[str, ...]
    place: Place
    expression: Expression | None = None
    curve: Curve | None = None


class LawValues(NamedTuple):
    """Values (laws, rows) in SI, nan where a law has none; what to say about those rows."""

    values: Floats
    diagnostics: list[Diagnostic]


def quantities_read(problem: Problem) -> list[str]:
    """Names of the quantities that the laws of a problem depend on."""
    return list(dict.fromkeys(name for law in problem.load_laws for name in law.reads))


def law_values(problem: Problem, resolve: Resolve, reached: Bools) -> LawValues:
    """Evaluates the laws of a problem.

    Args:
        problem: its laws, and the units of messages.
        resolve: the quantity of a name over the rows, in SI.
        reached: rows (rows,) that have a position; nothing is said about others.
    """
    values, diagnostics = np.empty((len(problem.load_laws), reached.size)), []
    for number, law in enumerate(problem.load_laws):
        place = _Places(law, resolve, problem.units, reached.size)
        if law.curve is not None:
            x = place.rows(law.reads[0])
            slack = TABLE_END * (law.curve.last - law.curve.first)
            inside = (x >= law.curve.first - slack) & (x <= law.curve.last + slack)
            clipped = np.clip(x, law.curve.first, law.curve.last)
            values[number] = np.where(inside, law.curve.evaluate(clipped)[0], np.nan)
            words, limit = "lies outside its table", place.limit(law.curve)
            hint = "extend the table, or keep the motion within it"
        else:
            assert law.expression is not None
            found = np.asarray(law.expression.evaluate(resolve).value, dtype=np.float64)
            inside = np.broadcast_to(np.abs(found) <= LARGEST_NUMBER, reached.shape)
            values[number] = np.where(inside, found, np.nan)
            words, limit = "has no finite value", None
            hint = "write an expression that holds in all rows, or move the rows"
        lost = np.flatnonzero(reached & ~inside)
        if lost.size:
            text = f"this load {words} in {_count(lost)}; cells that depend on it stay empty"
            at = place.measured(int(lost[0]))
            diagnostics.append(
                Diagnostic("load-undefined", "error", text, law.place, at, limit, hint)
            )
    return LawValues(values, diagnostics)


def _count(rows: Sequence[int] | NDArray[np.intp]) -> str:
    first = f"row {rows[0] + 1}"
    return first if len(rows) == 1 else f"{len(rows)} rows, first in {first}"


class _Places(NamedTuple):
    """What a law reads, row by row and in words."""

    law: LoadLaw
    resolve: Resolve
    units: UnitSystem
    size: int

    def rows(self, name: str) -> Floats:
        """A scalar quantity over the rows, in SI."""
        value = np.asarray(self.resolve(name).value, dtype=np.float64)
        return np.broadcast_to(value, (self.size,))

    def measured(self, row: int) -> str:
        """`O1.theta = 90 deg, time = 1 s`: what the law reads in a row; vectors are left out."""
        words = []
        for name in self.law.reads:
            quantity = self.resolve(name)
            if isinstance(quantity.value, float | np.ndarray):
                words.append(f"{name} = {self._text(float(self.rows(name)[row]), name)}")
        return ", ".join(words) or f"row {row + 1}"

    def limit(self, curve: Curve) -> str:
        """The range of a table."""
        name = self.law.reads[0]
        return f"{self._text(curve.first, name)} to {self._text(curve.last, name)}"

    def _text(self, value: float, name: str) -> str:
        dimension = self.resolve(name).dimension
        in_file = float(self.units.from_si(value, dimension))
        return f"{in_file:.12g} {self.units.label(dimension)}".rstrip()
