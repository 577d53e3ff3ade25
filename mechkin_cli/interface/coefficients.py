"""The dense system of reactions as two tables: coefficients and right side, unknowns and values.

Numbers are in the file's units, so that an unknown in its unit times a coefficient has the unit of
its equation; moments are about the ground origin. What the system's own solution gives stands
beside the unknowns where it is square: the reactions of the other tables, found another way.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.dense.system import DenseSystem, dense_system, solved
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.columns import Column, Columns, words_of
from mechkin_cli.tolerances import DENSE_ROUNDING
from mechkin_cli.units import DIMENSIONLESS, FORCE, LENGTH, MOMENT, Dimension

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.tables.layout import CoefficientsLayout
    from mechkin_cli.units import UnitSystem


def coefficient_tables(layout: CoefficientsLayout, result: Result) -> tuple[Columns, Columns]:
    """The coefficients with their right side, and the unknowns with their values.

    Raises:
        UsageError: the row has no solution.
    """
    row = layout.row - 1
    if not result.solved[row]:
        raise UsageError(
            f"the coefficients {layout.name} are wanted at row {layout.row}, which has no "
            "solution; give another row"
        )
    named = result.problem.mechanism.directions
    along = {
        name: ((one, named[one]), (two, named[two])) for name, (one, two) in layout.along.items()
    }
    system = dense_system(result, row, along)
    name, of_unknowns = layout.names
    title = f"{layout.title}; {_counts(layout, system, result)}"
    coefficients = Columns(name, title, _coefficients(system, result.units), of_rows=False)
    title = f"{layout.title}; unknowns at row {layout.row}"
    unknowns = Columns(of_unknowns, title, _unknowns(system, result.units), of_rows=False)
    return coefficients, unknowns


def _counts(layout: CoefficientsLayout, system: DenseSystem, result: Result) -> str:
    """Row, size, the source's count and the sizes really solved."""
    text = f"{len(system.equations)} equations in {len(system.unknowns)} unknowns"
    if layout.counted is not None:
        text += f" (the source counts {layout.counted})"
    sizes = " and ".join(str(len(block.unknowns)) for block in result.graph.blocks)
    solved_in = f", solved here with {sizes} unknowns" if sizes else ", solved here link by link"
    return f"row {layout.row}: {text}{solved_in}"


def _coefficients(system: DenseSystem, units: UnitSystem) -> tuple[Column, ...]:
    """Number and name of each equation, a column per unknown, the right side."""
    matrix = np.array(system.coefficients)
    columns = [
        _numbers("i", range(1, len(system.equations) + 1)),
        _words("equation", [equation.name for equation in system.equations]),
    ]
    dimensions = [equation.dimension for equation in system.equations]
    for unknown, values in zip(system.unknowns, matrix.T, strict=True):
        told = [
            units.from_si(float(value), _per(dimension, unknown.dimension))
            for value, dimension in zip(values, dimensions, strict=True)
        ]
        columns.append(_numbers(unknown.name, told))
    right = [units.from_si(v, d) for v, d in zip(system.right, dimensions, strict=True)]
    return (*columns, _numbers("right side", right))


def _per(equation: Dimension, unknown: Dimension) -> Dimension:
    """The dimension of a coefficient."""
    return LENGTH if (equation, unknown) == (MOMENT, FORCE) else DIMENSIONLESS


def _unknowns(system: DenseSystem, units: UnitSystem) -> tuple[Column, ...]:
    dimensions = [unknown.dimension for unknown in system.unknowns]
    values = _without_rounding(solved(system), dimensions)
    return (
        _numbers("j", range(1, len(system.unknowns) + 1)),
        _words("unknown", [unknown.name for unknown in system.unknowns]),
        _numbers("value", [units.from_si(v, d) for v, d in zip(values, dimensions, strict=True)]),
        _words("unit", [units.label(dimension) for dimension in dimensions]),
    )


def _without_rounding(
    values: Sequence[float] | None, dimensions: Sequence[Dimension]
) -> Sequence[float]:
    """The values with zeros for what is rounding; empty cells where there is no solution."""
    if values is None:
        return [float("nan")] * len(dimensions)
    largest: dict[Dimension, float] = {}
    for value, dimension in zip(values, dimensions, strict=True):
        largest[dimension] = max(abs(value), largest.get(dimension, 0.0))
    return [
        value if abs(value) > DENSE_ROUNDING * largest[dimension] else 0.0
        for value, dimension in zip(values, dimensions, strict=True)
    ]


def _numbers(label: str, values: Sequence[float] | range) -> Column:
    return Column(label, "", np.array(values, dtype=np.float64))


def _words(label: str, texts: Sequence[str]) -> Column:
    return Column(label, "", words_of(texts))
