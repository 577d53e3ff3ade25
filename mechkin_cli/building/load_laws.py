"""Values of loads that vary: expressions of quantities known without forces, and tables.

An expression is checked once on a stand-in of one row; its quantities are positions and rates, so
that it can be evaluated before any force is.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.expressions import Expression, ExpressionError, Quantity, UnknownName, Vector
from mechkin_cli.expressions.fields import scalar
from mechkin_cli.mechanism.load_laws import LoadLaw
from mechkin_cli.mechanism.model import Varying
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.tape.rows import is_traced
from mechkin_cli.units import Dimension

_KINDS = {"coordinate", "point", "direction", "omega", "axis", "joint_point", "slip", "time"}
ALLOWED = (
    "a load may read joint coordinates and their rates, positions, velocities, omegas, axes, "
    "directions, parameters and time"
)
NO_TIME = (
    "time is not known: the motion has no time",
    "give the motion time: {from: ..., to: ..., step: ...}, with laws for its inputs",
)


class LoadLaws:
    """Collects the laws of varying loads; what is wrong with one is noted in `fields`."""

    def __init__(self, fields: Fields, quantities: Mapping[str, Wanted]) -> None:
        self.fields = fields
        self.quantities = quantities
        self.laws: list[LoadLaw] = []

    def by_expression(self, path: Path, expression: Expression, dimension: Dimension) -> Varying:
        """The value of an expression of a dimension."""
        try:
            scalar(expression, dimension, self.fields.units, self._sample)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return Varying(0)
        reads = [self.quantities[name] for name in self._read(expression.names)]
        place = self.fields.document.place(path)
        self.laws.append(LoadLaw(tuple(q.name for q in reads), place, expression))
        moving = any(q.order == 1 or q.kind == "omega" for q in reads)
        return Varying(len(self.laws) - 1, moving)

    def by_table(self, path: Path, file: str, name: str, dimension: Dimension) -> Varying:
        """The value of a dimension in a table over the quantity `name`."""
        if self.fields.is_refused(name):
            return Varying(0)
        wanted = self.quantities.get(name)
        if wanted is None:
            text = "a table of a load on a link runs over time, and the motion has none"
            self.fields.error("load-table", path, text, NO_TIME[1])
            return Varying(0)
        from mechkin_cli.building.curves import read_curve

        curve = read_curve(self.fields, path, file, wanted.dimension, dimension)
        if curve is not None:
            place = self.fields.document.place(path)
            self.laws.append(LoadLaw((name,), place, curve=curve))
        return Varying(len(self.laws) - 1)

    def _read(self, names: Set[str]) -> list[str]:
        """The quantities behind the names of an expression, parameters left out."""
        found = []
        for name in sorted(names - self.fields.parameters.keys()):
            whole = name if name in self.quantities else name.rpartition(".")[0]
            found.append(whole)
        return found

    def _sample(self, name: str) -> Quantity:
        """One row of a quantity, of its dimension."""
        if name in self.fields.parameters:
            parameter = self.fields.parameters[name]
            # a recorded number stands for itself only where the law is evaluated
            return replace(parameter, value=np.ones(1)) if is_traced(parameter.value) else parameter
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        if name == "time" and name not in self.quantities:
            raise ExpressionError(NO_TIME[0], 0, NO_TIME[1])
        if name.startswith("row."):
            raise ExpressionError(f"a load cannot read {name}: it is a verdict", 0, ALLOWED)
        wanted = self.quantities.get(name)
        if wanted is None:
            known = [q.name for q in self.quantities.values() if is_known(q)]
            raise UnknownName(name, [*self.fields.parameters, *known])
        if not is_known(wanted):
            accelerated = wanted.order >= 2 or wanted.kind == "alpha"
            why = "it is an acceleration" if accelerated else "it follows from the loads"
            raise ExpressionError(f"a load cannot read {name}: {why}", 0, ALLOWED)
        one = np.ones(1)
        return Quantity(Vector(one, one, one) if wanted.vector else one, wanted.dimension)


def is_known(wanted: Wanted) -> bool:
    """Whether a quantity is known before any force is."""
    return wanted.kind in _KINDS and wanted.order <= 1
