"""Coefficients and right side of the dense system, and its solution.

Rows: force and moment of every moving link, then the pairs' conditions. Columns: all components of
all reactions, then the efforts. Rows by columns times unknowns equal the right side: what pairs and
drives exert on a link is the opposite of loads, gravity and inertia.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.analysis.dense.loads import borne_wrenches
from mechkin_cli.analysis.dense.row_motion import row_motion
from mechkin_cli.analysis.dense.unknowns import Along, Condition, Unknown, effort, pair_terms
from mechkin_cli.mechanism.model import GROUND_NAME
from mechkin_cli.tolerances import DENSE_PIVOT
from mechkin_cli.units import FORCE, MOMENT, Dimension

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result

Matrix = list[list[float]]


class Equation(NamedTuple):
    """One row: its name and dimension."""

    name: str
    dimension: Dimension


class DenseSystem(NamedTuple):
    """`coefficients` (equations, unknowns) and `right` (equations,), in SI."""

    equations: tuple[Equation, ...]
    unknowns: tuple[Unknown, ...]
    coefficients: Matrix
    right: list[float]


def dense_system(
    result: Result, row: int, along: Mapping[str, Along] = MappingProxyType({})
) -> DenseSystem:
    """The system at a row (counted from 0) that has a position; `along` as in `pair_terms`."""
    mechanism, motion = result.problem.mechanism, row_motion(result, row)
    pairs = [pair_terms(joint, motion, along) for joint in mechanism.joints.values()]
    drives = mechanism.drives
    # a motor that carries what a tie transmits gives another effort than acts at its own coordinate
    word = "drive" if drives is not None and drives.ties else "effort"
    inputs = [effort(mechanism.joints[j], c, motion, word) for j, c in result.problem.acting]
    terms = [*(unknown for pair in pairs for unknown in pair.unknowns), *inputs]
    unknowns = tuple(sorted(terms, key=lambda unknown: unknown.rank))
    conditions = [condition for pair in pairs for condition in pair.conditions]
    ends = {joint.name: (joint.first, joint.second) for joint in mechanism.joints.values()}
    borne = borne_wrenches(result, motion, row)
    equations: list[Equation] = []
    coefficients: Matrix = []
    right: list[float] = []
    for name in mechanism.links:
        if name == GROUND_NAME:
            continue
        signs = [
            float(ends[u.joint][1] == name) - float(ends[u.joint][0] == name) for u in unknowns
        ]
        for part, dimension in (("force", FORCE), ("moment", MOMENT)):
            for k, letter in enumerate("xyz"):
                equations.append(Equation(f"{name}: {part} {letter}", dimension))
                row_of = [
                    s * getattr(u.wrench, part)[k] for s, u in zip(signs, unknowns, strict=True)
                ]
                coefficients.append(row_of)
                right.append(-getattr(borne[name], part)[k])
    for condition in conditions:
        equations.append(Equation(condition.name, condition.dimension))
        coefficients.append([_in_condition(condition, unknown) for unknown in unknowns])
        right.append(0.0)
    return DenseSystem(tuple(equations), unknowns, coefficients, right)


def _in_condition(condition: Condition, unknown: Unknown) -> float:
    """Conditions hold for F and M of their pair, not for what stands apart, nor for its drive."""
    if unknown.joint != condition.joint or unknown.rank not in _OF_CONDITIONS:
        return 0.0
    return condition.coefficient(unknown.wrench)


_OF_CONDITIONS = (0, 1, 3)


def solved(system: DenseSystem) -> list[float] | None:
    """The unknowns in SI, by elimination with row pivots; None where they are not as many as the
    equations or not independent of one another."""
    size = len(system.unknowns)
    if len(system.equations) != size:
        return None
    rows = [_scaled([*c, r]) for c, r in zip(system.coefficients, system.right, strict=True)]
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if abs(rows[pivot][k]) <= DENSE_PIVOT:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            if factor:
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    values = [0.0] * size
    for k in reversed(range(size)):
        rest = rows[k][size]
        for j in range(k + 1, size):
            rest -= rows[k][j] * values[j]
        values[k] = rest / rows[k][k]
    return values


def _scaled(row: list[float]) -> list[float]:
    """An equation with its largest coefficient 1, so that pivots compare."""
    largest = max(abs(value) for value in row[:-1]) or 1.0
    return [value / largest for value in row]
