"""The rows of equilibria, read as those of a response are: each row is one equilibrium, about which
nothing moves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism import (
    DrivenInput,
    Moments,
    MotionInputs,
    ResponseProblem,
    is_angle,
)
from mechkin_cli.plan import FORCE_KINDS, Demand
from mechkin_cli.response import FreeResult
from mechkin_cli.session import Chart, input_unit, turn_count
from mechkin_cli.statics.friction import friction_left_out
from mechkin_cli.statics.newton import Balancing, Search
from mechkin_cli.statics.stability import Stability, Verdict
from mechkin_cli.sweep import SweepRows
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import Ask, Batch, KernelInputs, Session
    from mechkin_cli.show import Floats
    from mechkin_cli.statics.friction import RestInterval


class EquilibriumResult(FreeResult):
    """The equilibria of a run.

    Args:
        response: the file's entry.
        balancing: the forces of the run.
        start: the first assembly.
        found: the equilibria with their verdicts; without any there is one row without a place.
        notes: of the search.
        rests: the intervals in which friction holds the mechanism, one for each that was found;
            () without friction.
    """

    def __init__(
        self,
        response: ResponseProblem,
        balancing: Balancing,
        start: AssemblyStart,
        found: Sequence[tuple[Search, Verdict]],
        notes: Sequence[Diagnostic],
        rests: Sequence[RestInterval | None] = (),
    ) -> None:
        free = balancing.forces.session
        count = max(len(found), 1)
        session = free.moved(free.problem.moved(_rows(response, count)))
        rows = SweepRows.without_guesses(free.layout.states, turn_count(free.plan), count)
        rows.turns[:] = 0.0
        rows.diagnostics += [*notes, *friction_left_out(response)]
        freedoms, columns = balancing.forces.freedoms, free.plan.columns
        directions = np.zeros((freedoms * columns, count))
        for number, (one, _) in enumerate(found):
            rows.states[:, number] = one.place.state
            rows.turns[:, number] = one.place.turns
            rows.reached[number] = True
            directions[:, number] = one.place.tangents.ravel()
        if not found:
            rows.status[:] = Status.no_equilibrium
            if start.state is None and not self._is_window(response):
                rows.status[:] = Status.not_assembled
        still = np.zeros((freedoms, count))
        super().__init__(
            session,
            start,
            rows,
            chosen=balancing.chosen,
            chart=Chart(directions, still, still, np.zeros((0, count))),
            response=response,
        )
        self.balancing = balancing
        self.found, self.rests = tuple(found), tuple(rests)
        self.held = np.zeros(count, dtype=bool)
        for number, (_, verdict) in enumerate(found):
            self.held[number] = verdict.stability is Stability.HELD
        # what friction of several joints takes there is not one value alone
        rows.status[self.held] = Status.friction_undecided
        self.events = tuple(_words(response, verdict) for _, verdict in found) or ("",)

    @property
    def mode(self) -> str:
        """As of a response; the equilibria of a window are of any mode."""
        return "" if self._is_window(self.response) else super().mode

    @property
    def letter(self) -> str:
        """As of a response; the equilibria of a window are of any mode."""
        return "" if self._is_window(self.response) else super().letter

    @staticmethod
    def _is_window(response: ResponseProblem) -> bool:
        return response.search is not None and bool(response.search.window)

    def run(
        self, ask: Ask, *, session: Session | None = None, inputs: KernelInputs | None = None
    ) -> Batch:
        """As of a response, at rest whatever is left of forces."""
        demand = ask.demand | Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES
        ask = ask._replace(demand=demand, balance=True)
        return super().run(ask, session=session, inputs=inputs)

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        own = self._own.get(name)
        if own is not None:
            return Quantity(getattr(self, own.kind), own.dimension)
        return super().quantity(name)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""
        super().read(one for one in wanted if one.name not in self._own)

    @property
    def _own(self) -> dict[str, Wanted]:
        return self.response.resting

    def _told(self, values: Sequence[float]) -> Floats:
        return np.array(values) if values else np.full(1, np.nan)

    def stiffness(self, row: int) -> Floats:
        """How the forces change along the chart of a row (freedoms, freedoms), kernel units."""
        return self.balancing.forces.stiffness(self.found[row][0].place).matrix

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
    def rest_from(self) -> Floats:
        """The least value of the coordinate in the interval in which friction holds the mechanism
        (rows,); nan where that is not known."""
        return self._rest(0)

    @property
    def rest_to(self) -> Floats:
        """As `rest_from`, the largest value."""
        return self._rest(1)

    def _rest(self, side: int) -> Floats:
        unit = input_unit(self.session.layout, self.chosen.problem.motion.inputs[0])
        return self._told(
            [np.nan if one is None else unit * (one.low, one.high)[side] for one in self.rests]
        )

    def _keep_read(self, batch: Batch, ask: Ask) -> None:
        super()._keep_read(batch, ask)
        if not self.held.any() or ask.readout is None:
            return
        for quantity in ask.readout.wanted:
            if quantity.kind in FORCE_KINDS and quantity.name in self.columns:
                self.columns[quantity.name][:, self.held] = np.nan

    @property
    def imbalance(self) -> Floats:
        """The largest force left (rows,), in parts of the largest force or stiffness of one
        load."""
        return self._told(
            [
                float(np.max(np.abs(one.forces))) / verdict.size if verdict.size > 0.0 else 0.0
                for one, verdict in self.found
            ]
        )


def _words(response: ResponseProblem, verdict: Verdict) -> str:
    """The stability; of one without stiffness also along which coordinate most."""
    words = verdict.stability.value
    if verdict.stability in (Stability.MARGINAL, Stability.INDIFFERENT):
        joint, name = response.independent[verdict.along]
        words += f" along {joint}.{name}"
    return words


def _rows(response: ResponseProblem, count: int) -> MotionInputs:
    """The driven coordinates and the moment, the same in each row."""

    def repeated(item: DrivenInput) -> DrivenInput:
        return item.part(slice(0, 1))._replace(
            values=np.repeat(item.values[:1], count),
            rates=np.zeros(count),
            accelerations=np.zeros(count),
            jerks=np.zeros(count),
            written_orders=np.repeat(item.written_orders[:, :1], count, axis=1),
        )

    moments = response.moments
    time = Moments(np.repeat(moments.values, count), np.repeat(moments.written, count))
    return MotionInputs(tuple(map(repeated, response.driven)), count, time)
