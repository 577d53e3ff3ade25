"""What a sweep found: rows with their verdicts, and quantities by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.expressions import Quantity, UnknownName, Vector
from mechkin_cli.mechanism.derived_quantities import hint_of
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import Slot
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.status import has_solution
from mechkin_cli.units import DIMENSIONLESS, UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


@dataclass(frozen=True)
class Result:
    """Arrays have the shape (rows,), `outputs` (slots, rows) in SI; nan where a row has no
    solution."""

    problem: Problem
    graph: SolverGraph
    demand: Demand
    mode: str
    how: str
    status: NDArray[np.int8]
    residual: Floats
    condition: Floats
    power_error: Floats
    outputs: Floats
    slots: Mapping[str, Slot]
    nodes: int
    diagnostics: tuple[Diagnostic, ...]
    shifted: tuple[Floats, ...] = ()
    unloaded: NDArray[np.bool_] | None = None

    @cached_property
    def _known(self) -> Mapping[str, Wanted]:
        return self.problem.quantities()

    @property
    def rows(self) -> int:
        """Number of rows asked for."""
        return self.problem.motion.rows

    @property
    def units(self) -> UnitSystem:
        """The file's units."""
        return self.problem.units

    @property
    def coordinates(self) -> Sequence[str]:
        """All joint coordinates in joint order."""
        return self.problem.mechanism.coordinates

    @property
    def inputs(self) -> Mapping[str, Floats]:
        """What the rows were given, in the file's units exactly as written: time where there is
        one, then the inputs' values."""
        time = self.problem.motion.time
        inputs = {i.name: i.written for i in self.problem.motion.inputs}
        return inputs if time is None else {"time": time.written, **inputs}

    @cached_property
    def input_rates(self) -> Mapping[str, Floats]:
        """The inputs' rates of all orders in the file's units as written, nan in rows without a
        solution."""
        rates = {}
        for driven in self.problem.motion.inputs:
            for name, (_, written) in driven.orders.items():
                if name in self._known and name != driven.name:
                    rates[name] = np.where(self._solved, written, np.nan)
        return rates

    @cached_property
    def _solved(self) -> NDArray[np.bool_]:
        return has_solution(self.status)

    @cached_property
    def alternatives(self) -> tuple[Result, ...]:
        """The same rows with other reactions that are in equilibrium too (redundant
        constraints)."""
        return tuple(replace(self, outputs=outputs, shifted=()) for outputs in self.shifted)

    @property
    def complete(self) -> bool:
        """Whether every row has a solution, and a value of every load that forces need."""
        return bool(self._solved.all()) and (self.unloaded is None or not self.unloaded.any())

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name, or it was not asked for in this run.
        """
        if name in self.problem.parameters:
            return self.problem.parameters[name]
        if name in ("row.residual", "row.condition", "row.power_error"):
            return Quantity(getattr(self, name[4:]), DIMENSIONLESS)
        wanted = self._known.get(name)
        if wanted is not None and (given := self._given(name)) is not None:
            return Quantity(given, wanted.dimension)
        slot = self.slots.get(name)
        if slot is None or wanted is None:
            raise UnknownName(name, sorted(self.slots), hint_of(name))
        columns = self.outputs[slot.first : slot.first + slot.width]
        if wanted.vector:
            return Quantity(Vector(columns[0], columns[1], columns[2]), wanted.dimension)
        return Quantity(columns[0], wanted.dimension)

    def _given(self, name: str) -> Floats | None:
        """Time, an input's value or its rates in SI; None for what is computed."""
        motion = self.problem.motion
        if name == "time" and motion.time is not None:
            return motion.time.values
        for driven in motion.inputs:
            if name == driven.name:
                return driven.values
            if name in driven.orders:
                return np.where(self._solved, driven.orders[name][0], np.nan)
        return None
