"""Values of loads that vary: expressions of quantities known without forces, and tables.

An expression is checked once on a stand-in of one row; its quantities are positions and rates, so
that it can be evaluated before any force is.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Set
from dataclasses import replace

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.expressions import (
    Expression,
    ExpressionError,
    Quantity,
    UnknownName,
    Vector,
    parse,
)
from mechkin_cli.expressions.fields import scalar
from mechkin_cli.mechanism.load_laws import LoadLaw
from mechkin_cli.mechanism.model import Varying
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.schema.loads import TableValue
from mechkin_cli.tape.rows import is_traced
from mechkin_cli.units import Dimension

_KINDS = {"coordinate", "point", "direction", "omega", "axis", "joint_point", "slip", "time"}
ALLOWED = (
    " may read joint coordinates and their rates, positions, velocities, omegas, axes, "
    "directions, parameters and time"
)
NO_TIME = (
    "time is not known: the motion has no time",
    "give the motion time: {from: ..., to: ..., step: ...}, with laws for its inputs",
)
OWN_RUNS = "give the motion time: {from: ..., to: ..., step: ...}, or let the load act in "


class LoadLaws:
    """Collects the laws of varying loads; what is wrong with one is noted in `fields`.

    Args:
        fields: knows units and parameters.
        runs: the quantities of each run by name; only some runs have a time.
        reader: what the laws are of, for messages.
    """

    def __init__(
        self,
        fields: Fields,
        runs: Mapping[str, Mapping[str, Wanted]],
        *,
        reader: str = "a load",
    ) -> None:
        self.fields = fields
        self.runs = runs
        self.reader = reader
        self.laws: list[LoadLaw] = []
        self.acting(runs.keys())

    def acting(self, runs: Collection[str]) -> None:
        """The runs in which the next laws hold."""
        found = [self.runs[name] for name in runs if name in self.runs]
        found = found or list(self.runs.values())
        self.quantities = next((q for q in found if "time" not in q), found[0])
        timed = [name for name, q in self.runs.items() if "time" in q]
        alone = f"{OWN_RUNS}responses alone: runs: [{', '.join(timed)}]" if timed else NO_TIME[1]
        self.time_hint = alone

    def by_expression(self, path: Path, expression: Expression, dimension: Dimension) -> Varying:
        """The value of an expression of a dimension."""
        try:
            scalar(expression.in_doubles, dimension, self.fields.units, self._sample)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return Varying(0)
        reads = [self.quantities[name] for name in self._read(expression.names)]
        place = self.fields.document.place(path)
        self.laws.append(LoadLaw(tuple(q.name for q in reads), place, expression))
        return Varying(len(self.laws) - 1, any(_is_moving(q) for q in reads))

    def watched(self, path: Path, text: str) -> tuple[LoadLaw, Dimension] | None:
        """The law of an expression of any dimension, which is no load; None where an error was
        noted."""
        try:
            expression = self.fields.definitions.parse(text)
            if expression.names <= self.fields.parameters.keys():
                hint = "write an expression of coordinates, rates, positions, velocities or time"
                raise ExpressionError("this value never changes", 0, hint)
            found = expression.in_doubles.evaluate(self._sample, self.fields.units)
            if isinstance(found.value, Vector):
                hint = "write one component: .x, .y or .z"
                raise ExpressionError(f"{self.reader} takes one number, this is a vector", 0, hint)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return None
        names = tuple(self._read(expression.names))
        return LoadLaw(names, self.fields.document.place(path), expression), found.dimension

    def by_table(self, path: Path, value: TableValue, over: str, dimension: Dimension) -> Varying:
        """The value of a dimension in a table, which runs over the quantity `over` unless it names
        another."""
        path, wanted = (*path, "table"), self._runs_over(path, value, over)
        if wanted is None:
            return Varying(0)
        from mechkin_cli.building.curves import joining_of, read_curve

        curve = read_curve(
            self.fields, path, value.table, wanted.dimension, dimension, joining_of(value)
        )
        if curve is not None:
            place = self.fields.document.place(path)
            self.laws.append(LoadLaw((wanted.name,), place, curve=curve))
        return Varying(len(self.laws) - 1, _is_moving(wanted))

    def _runs_over(self, path: Path, value: TableValue, usual: str) -> Wanted | None:
        """The quantity of a table's first column; None where an error was noted."""
        if value.over is not None:
            try:
                over = parse(value.over)
                found = _one_name(over, over.evaluate(self._sample, self.fields.units))
            except ExpressionError as error:
                self.fields.expression_error((*path, "over"), error)
                return None
            if found not in self.quantities:
                hint = "name a coordinate, a rate or time"
                self.fields.error("load-table", (*path, "over"), f"{found} is a parameter", hint)
                return None
            return self.quantities[found]
        if self.fields.is_refused(usual):
            return None
        wanted = self.quantities.get(usual)
        if wanted is None:
            text = "a table of a load on a link runs over time, and the motion has none"
            self.fields.error("load-table", (*path, "table"), text, self.time_hint)
        return wanted

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
            raise ExpressionError(NO_TIME[0], 0, self.time_hint)
        allowed = self.reader + ALLOWED
        if name.startswith("row."):
            raise ExpressionError(f"{self.reader} cannot read {name}: it is a verdict", 0, allowed)
        wanted = self.quantities.get(name)
        if wanted is None:
            known = [q.name for q in self.quantities.values() if is_known(q)]
            raise UnknownName(name, [*self.fields.parameters, *known])
        if not is_known(wanted):
            accelerated = wanted.order >= 2 or wanted.kind == "alpha"
            why = "it is an acceleration" if accelerated else "it follows from the loads"
            raise ExpressionError(f"{self.reader} cannot read {name}: {why}", 0, allowed)
        one = np.ones(1)
        return Quantity(wanted.value([one] * 3), wanted.dimension)


def is_known(wanted: Wanted) -> bool:
    """Whether a quantity is known before any force is."""
    return wanted.kind in _KINDS and wanted.order <= 1


def _is_moving(wanted: Wanted) -> bool:
    return wanted.order == 1 or wanted.kind == "omega"


def _one_name(expression: Expression, found: Quantity) -> str:
    """The name of the one number that an expression is.

    Raises:
        ExpressionError: it is more than a name, or a vector.
    """
    name = expression.text.strip()
    if expression.names != {name}:
        hint = "name one quantity, such as O1.theta, O1.theta_dot or time"
        raise ExpressionError("a table runs over one quantity, this is an expression", 0, hint)
    if isinstance(found.value, Vector):
        hint = "name a coordinate, a rate or time"
        raise ExpressionError(f"a table runs over one number, {name} is a vector", 0, hint)
    return name
