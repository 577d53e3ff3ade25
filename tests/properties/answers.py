"""All quantities of a mechanism by name, what kind each is, and how exact it must be.

Errors are counted in units of eps * condition * scale. The scale is the largest value of the
family in the mechanism, lengths in parts of its size: rates of all joints and links together,
wrenches of all joints together. The condition is the oracle's: largest over smallest singular value
of all constraints with six unknowns per link, so it does not depend on how loops are cut.

Why this law: closing equations are evaluated to a few eps, and solving amplifies that by the
condition (positions); every derivative, and the transposed system of the reactions, is one more
system with the same matrix, whose right hand side carries the errors of those before.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from oracle.document import Document, to_text

import mechkin_cli as mk
from mechkin_cli.mechanism.derived import DERIVED_KINDS
from mechkin_cli.units.dimension import ANGLE

EPS = 2.0**-52
Values = dict[str, np.ndarray]

LIMITS = {"order 0": 2.5, "order 1": 3.0, "order 2": 9.0, "order 3": 18.0, "load": 12.0}
"""Largest error of every family, in units of eps * condition * scale.

Over 150 random loops (condition up to 210) and 140 random structures of two and three loops (up to
200) the worst were 1.07, 1.2, 3.6 and 5.2, of jerks 7.3 over 56 of them; rarer
mechanisms may be about twice as bad.
"""

_RATES = {"": 0, "_dot": 1, "_ddot": 2, "_dddot": 3}
_ANGULAR = {c + r: k for c in ("theta", "theta1", "theta2") for r, k in _RATES.items()}
_ANGULAR |= {"omega": 1, "alpha": 2, "axis": 0}
_LINEAR = {c + r: k for c in ("s", "x", "y") for r, k in _RATES.items()}
_LINEAR |= {"position": 0, "velocity": 1, "acceleration": 2, "jerk": 3, "point": 0, "slip": 0}
_FORCES = ("force", "total_force", "shaking_force", "inertia_force")


@dataclass(frozen=True)
class Kind:
    """`order` 0 to 3 of a motion, None for a load; the power of length in it."""

    order: int | None
    lengths: int

    @property
    def family(self) -> str:
        return "load" if self.order is None else f"order {self.order}"


def kind(name: str) -> Kind:
    """The kind of a quantity; an effort on s is a force, on theta a moment."""
    owner, _, last = name.rpartition(".")
    if last in _ANGULAR:
        return Kind(_ANGULAR[last], 0)
    if last in _LINEAR:
        return Kind(_LINEAR[last], 1)
    if last == "effort":
        return Kind(None, 0 if owner.endswith((".s", ".x", ".y")) else 1)
    return Kind(None, 0 if last in _FORCES else 1)


def answers(source: str | Document, **options: Any) -> Values:
    """Every quantity but derived ones over all rows in file units, angles in rad; (rows,) or
    (rows, 3).

    An effort has its long name only: `J1.theta.effort`.
    """
    model = mk.loads(source if isinstance(source, str) else to_text(source))
    names = [
        name
        for name, wanted in model.problem.quantities().items()
        if wanted.owner != "row" and wanted.kind not in DERIVED_KINDS
    ]
    analysis = model.analyze(names, tables=[], **options)
    assert analysis.diagnostics == ()
    assert not analysis.result.status.any()
    radian = float(np.asarray(analysis.result.units.from_si(np.ones(1), ANGLE))[0])
    found = {}
    for name in names:
        if name.endswith(".effort") and name.count(".") == 1:
            continue
        angle = name.endswith((".theta", ".theta1", ".theta2"))
        found[name] = analysis[name] / radian if angle else analysis[name]
    return found


def at_row(values: Values, row: int) -> Values:
    """One row, all quantities as (1,) or (3,)."""
    return {name: value[row].reshape(-1) for name, value in values.items()}


def scales(values: Mapping[str, Any], size: float) -> dict[str, float]:
    """The largest value of every family, lengths in parts of `size`."""
    found = {"order 0": 1.0, "order 1": 0.0, "order 2": 0.0, "order 3": 0.0, "load": 0.0}
    for name, value in values.items():
        its = kind(name)
        if its.order != 0:
            largest = float(np.max(np.abs(value))) / size**its.lengths
            found[its.family] = max(found[its.family], largest)
    # accelerations have parts that are products of two rates, jerks of rates and accelerations
    found["order 2"] = max(found["order 2"], found["order 1"] ** 2)
    found["order 3"] = max(found["order 3"], found["order 1"] * found["order 2"])
    return found


def errors(
    values: Mapping[str, Any], expected: Mapping[str, Any], size: float, condition: float
) -> dict[str, float]:
    """The largest error of every family, in units of eps * condition * scale."""
    assert expected.keys() <= values.keys()
    largest = scales(expected, size)
    found = dict.fromkeys(largest, 0.0)
    for name, wanted in expected.items():
        its = kind(name)
        error = float(np.max(np.abs(values[name] - wanted)))
        unit = EPS * condition * largest[its.family] * size**its.lengths
        # with a rate of zero the scale may be zero, and the value must then be exact
        found[its.family] = max(found[its.family], error / unit if error else 0.0)
    return found


def within(found: Mapping[str, float], factor: float = 1.0) -> bool:
    """Whether all families are within `factor` times their limits."""
    return all(error <= factor * LIMITS[family] for family, error in found.items())
