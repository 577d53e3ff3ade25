"""The rows of equilibria, read as those of a sweep are: each row is one equilibrium, at which all
inputs stand still."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism import (
    DrivenInput,
    Moments,
    MotionInputs,
    Problem,
    ResponseProblem,
    dimension_of,
    is_angle,
    resting_quantities,
)
from mechkin_cli.response import FreeResult
from mechkin_cli.session import input_unit, turn_count
from mechkin_cli.statics.newton import Search
from mechkin_cli.statics.stability import Stability, Verdict
from mechkin_cli.sweep import SweepRows
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats




class EquilibriumResult(FreeResult):
    """The equilibria of a run.

    Args:
        chosen: the session at the start of the search.
        start: the first assembly.
        response: the file's entry.
        found: the equilibria with their verdicts; without any there is one row without a place.
        notes: of the search.
    """

    def __init__(
        self,
        chosen: Session,
        start: AssemblyStart,
        response: ResponseProblem,
        found: Sequence[tuple[Search, Verdict]],
        notes: Sequence[Diagnostic],
    ) -> None:
        session = chosen.moved(_moved(chosen, response, [one.place.inputs for one, _ in found]))
        count = max(len(found), 1)
        rows = SweepRows.without_guesses(
            chosen.layout.states, turn_count(chosen.plan), count
        )
        rows.diagnostics += notes
        for number, (one, _) in enumerate(found):
            rows.states[:, number] = one.place.state
            rows.turns[:, number] = one.place.turns
            rows.reached[number] = True
        if not found:
            rows.status[:] = Status.no_equilibrium
            if start.state is None and response.search is not None and not response.search.window:
                rows.status[:] = Status.not_assembled
        super().__init__(session, start, rows)
        self.run_start = chosen, start
        self.response, self.found = response, tuple(found)
        self.events = tuple(_words(response, verdict) for _, verdict in found) or ("",)

    @property
    def mode(self) -> str:
        """As of a sweep; the equilibria of a window are of any mode."""
        return "" if self._in_window else super().mode

    @property
    def letter(self) -> str:
        """As of a sweep; the equilibria of a window are of any mode."""
        return "" if self._in_window else super().letter

    @property
    def _in_window(self) -> bool:
        return self.response.search is not None and bool(self.response.search.window)

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        own = self._own.get(name)
        if own is not None:
            return Quantity(getattr(self, own.kind), own.dimension)
        wanted = self.problem.quantities().get(name)
        if wanted is not None and self.is_given(wanted):
            return Quantity(self._effort(wanted), wanted.dimension)
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""
        super().read(one for one in wanted if one.name not in self._own and not self.is_given(one))

    @property
    def _own(self) -> dict[str, Wanted]:
        return resting_quantities([name for _, name in self.response.independent])

    def _told(self, values: Sequence[float]) -> Floats:
        return np.array(values) if values else np.full(1, np.nan)

    @property
    def least_stiffness(self) -> Floats:
        """Against motions of the independent coordinates (rows,): N/m of slides alone, else N*m/rad
        where slides count in parts of the mechanism's length unit."""
        slides = not any(is_angle(name) for _, name in self.response.independent)
        unit = self.session.layout.length if slides else 1.0
        return self._told([verdict.least / (unit * unit) for _, verdict in self.found])

    @property
    def frequency(self) -> Floats:
        """The lowest natural one (rows,), 1/s; nan where there is none."""
        return self._told([verdict.frequency for _, verdict in self.found])

    @property
    def imbalance(self) -> Floats:
        """The largest force left (rows,), in parts of the largest of one load and of what the
        stiffness gives for a unit."""
        return self._told(
            [
                float(np.max(np.abs(one.forces))) / max(one.largest, verdict.size) or 0.0
                for one, verdict in self.found
            ]
        )


def _words(response: ResponseProblem, verdict: Verdict) -> str:
    """The stability; of one without stiffness also along which coordinate most."""
    words = verdict.stability.value
    if verdict.stability in (Stability.MARGINAL, Stability.INDIFFERENT):
        joint, name = response.independent[int(np.argmax(np.abs(verdict.direction)))]
        words += f" along {joint}.{name}"
    return words


def _moved(chosen: Session, response: ResponseProblem, places: Sequence[Floats]) -> Problem:
    """The problem with a row for each place; without any one row, at the start."""
    problem, layout, units = chosen.problem, chosen.layout, chosen.problem.units
    count = max(len(places), 1)
    inputs = []
    for number, item in enumerate(problem.motion.inputs):
        unit = input_unit(layout, item)
        values = np.array([place[number] * unit for place in places])
        values = values if len(places) else item.values[:1]
        if number >= len(response.independent):
            values = np.full(count, item.values[0])
        still = np.zeros((3, count))
        written = np.zeros((4, count))
        written[0] = units.from_si(values.copy(), dimension_of(item.coordinate))
        if number >= len(response.independent):
            written[0] = item.written[0]
        inputs.append(
            DrivenInput(item.joint, item.coordinate, values, still[0], still[1], still[2], written)
        )
    moments = Moments(
        np.repeat(response.moments.values, count), np.repeat(response.moments.written, count)
    )
    return problem.moved(MotionInputs(tuple(inputs), count, moments, leader=0))
