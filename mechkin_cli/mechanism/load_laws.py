"""Loads that vary: laws of coordinates, rates and time.

The kernel evaluates them row by row before the forces (`solver.quantity_program`); here is what
they are over rows of numbers.

A law is an expression of quantities that are known without forces, or a table's curve over one of
them. Where a law has no value (a row outside its table, a root of a negative number) the row keeps
its position and rates; what depends on the load has no value either.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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
    from mechkin_cli.mechanism.quantities import Wanted

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


class Laws(NamedTuple):
    """The laws of the loads that vary, and what the names in them stand for; `watched` are values
    that a motion is watched for beside them."""

    laws: tuple[LoadLaw, ...]
    parameters: Mapping[str, Quantity]
    quantities: Mapping[str, Wanted]
    watched: tuple[LoadLaw, ...] = ()


def quantities_read(problem: Problem) -> list[str]:
    """Names of the quantities that the laws of a problem depend on."""
    return list(dict.fromkeys(name for law in problem.load_laws for name in law.reads))


def law_value(law: LoadLaw, resolve: Resolve, rows: int) -> Floats:
    """The value of a law (rows,) in SI, nan where it has none.

    Args:
        law: an expression or a curve.
        resolve: the quantity of a name over the rows, in SI.
        rows: how many there are.
    """
    if law.curve is not None:
        x = np.broadcast_to(np.asarray(resolve(law.reads[0]).value, dtype=np.float64), (rows,))
        slack = TABLE_END * (law.curve.last - law.curve.first)
        inside = (x >= law.curve.first - slack) & (x <= law.curve.last + slack)
        clipped = np.clip(x, law.curve.first, law.curve.last)
        return np.where(inside, law.curve.evaluate(clipped)[0], np.nan)
    assert law.expression is not None
    quantity = law.expression.evaluate(resolve, through_infinity=True)
    found = np.asarray(quantity.value, dtype=np.float64)
    inside = np.broadcast_to(np.abs(found) <= LARGEST_NUMBER, (rows,))
    return np.where(inside, found, np.nan)


def undefined_laws(problem: Problem, resolve: Resolve, lost: Bools) -> list[Diagnostic]:
    """What to say of rows in which a law has no value.

    Args:
        problem: its laws, and the units of messages.
        resolve: the quantity of a name over the rows, in SI.
        lost: the rows (rows,) to look at.
    """
    diagnostics = []
    for law in problem.load_laws:
        rows = np.flatnonzero(lost & np.isnan(law_value(law, resolve, lost.size)))
        if not rows.size:
            continue
        place = _Places(law, resolve, problem.units, lost.size)
        if law.curve is not None:
            words, limit = "lies outside its table", place.limit(law.curve)
            hint = "extend the table, or keep the motion within it"
        else:
            words, limit = "has no finite value", None
            hint = "write an expression that holds in all rows, or move the rows"
        text = f"this load {words} in {_count(rows)}; cells that depend on it stay empty"
        at = place.measured(int(rows[0]))
        diagnostics.append(Diagnostic("load-undefined", "error", text, law.place, at, limit, hint))
    return diagnostics


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
