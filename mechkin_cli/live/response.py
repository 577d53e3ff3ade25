"""The record from which a page computes a response with other parameters.

Its first assembly is continued from the file's own, as variants of a sweep are; from there the
motion is integrated anew. What a page leaves to the command: coordinates that laws of time drive,
limits with a restitution, and functions whose slopes jump.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli import tolerances
from mechkin_cli.expressions import Quantity
from mechkin_cli.kernel.plan_text import plan_text
from mechkin_cli.live.cells import MEASURES, scalar_of
from mechkin_cli.live.recording import LeftOut, Recording, factor_of
from mechkin_cli.mechanism import (
    DRIVEN_KINDS,
    ORDERS,
    CrossingEnd,
    MotionInputs,
    Varying,
    response_quantities,
)
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.record import replace
from mechkin_cli.response import ENERGIES, free_session, watched_stop
from mechkin_cli.session import RESIDUAL_TESTS, angle_slots
from mechkin_cli.sweep import bends
from mechkin_cli.tables import size_of_rate
from mechkin_cli.units import TIME
from mechkin_cli.variants import SessionVariation
from mechkin_cli.verdict import CLEAR_CONDITION

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.mechanism import JointLoad, Wanted
    from mechkin_cli.structure import SolverGraph
    from mechkin_cli.tables import ColumnLayout

    Plain = dict[str, Any]


class ResponseRecording(Recording):
    """Everything that is recorded of one response for its page.

    Args:
        analysis: the response in the file's own mode.
        data: of the page without this record.
        start: how its first moment depends on the parameters.
    """

    measures = (*MEASURES, *response_quantities())

    def __init__(
        self, analysis: Analysis, data: Mapping[str, Any], start: SessionVariation
    ) -> None:
        response = start.recorded.response
        assert response is not None
        self.response, self.start = response, start
        motion = MotionInputs((), response.rows, response.moments)
        free = free_session(start.base, response.independent)
        free = free.moved(replace(free.problem, motion=motion))
        recorded = replace(start.recorded, motion=motion)
        first = (start.state, 0, start.size)
        super().__init__(analysis, data, SessionVariation(free, first, start.recorder, recorded))
        self.known = {**self.known, **response_quantities()}

    def why_left(self) -> str | None:
        """As of a sweep."""
        limits = (stop.limit for stop in self.response.stops if isinstance(stop, CrossingEnd))
        if any(limit and limit.restitution is not None for limit in limits):
            return "something in it rebounds, by a restitution"
        rates = {(one.joint, one.coordinate) for one in self.response.start if one.rate is not None}
        if rates - set(self.response.independent):
            return "its start gives the rate of a coordinate that follows from others"
        if bends(self.problem):
            return "functions in it have corners, where their slopes jump"
        return super().why_left()

    # What columns read.

    def refusal(self, wanted: Wanted) -> str | None:
        """As of a sweep."""
        if wanted.kind in DRIVEN_KINDS:
            return "it goes by coordinates that are not driven here"
        return super().refusal(wanted)

    def need(self, names: Sequence[str]) -> None:
        """As of a sweep; an effort that the file gives is what its law reads."""
        computed = []
        for name in names:
            given = self._given_efforts(name)
            if given:  # the command computes forces for it all the same
                self.beside |= demand_of(self.problem.mechanism, [self.known[name]])
            for effort in given:
                if isinstance(effort.amount, Varying):
                    self.need(self._law_reads(effort.amount))
            if not given:
                computed.append(name)
        super().need(computed)

    def _needs(self) -> None:
        self.need(ENERGIES)  # which every response is judged by
        self.need(list(self._rates_of_start()))
        super()._needs()

    def _given_efforts(self, name: str) -> list[JointLoad]:
        wanted = self.known.get(name)
        if wanted is None or wanted.kind != "effort":
            return []
        at = (wanted.owner, wanted.coordinate)
        return [effort for effort in self.response.efforts if effort.acts_at == at]

    def _law_reads(self, amount: Varying) -> list[str]:
        law = self.response.load_laws[amount.number]
        if law.expression is None:
            raise LeftOut("it is read from a table")
        return [n if n in self.known else n.rpartition(".")[0] for n in law.expression.names]

    def resolve(self, name: str) -> Quantity:
        """A quantity by its name, on the tape of cells."""
        given = self._given_efforts(name)
        if not given:
            return super().resolve(name)
        total: Any = 0.0
        for effort in given:
            amount: Any = effort.amount
            if isinstance(amount, Varying):
                law = self.response.load_laws[amount.number]
                assert law.expression is not None
                amount = law.expression.evaluate(self.resolve, through_infinity=True).value
            total = total + amount
        return Quantity(total, self.known[name].dimension)

    # Tables.

    @property
    def _rows_name(self) -> str:
        """The table of verdicts."""
        return f"{self.analysis.run}.rows"

    @property
    def _first_graph(self) -> SolverGraph:
        """The structure in which the first assembly is found."""
        return self.start.base.graph

    def _column_record(self, table: str, layout: ColumnLayout) -> Plain | None:
        record = super()._column_record(table, layout)
        first = self._starts.get(layout.expression.text.strip())
        if record is not None and first is not None:
            record["first"] = first
        return record

    @property
    def _starts(self) -> dict[str, Plain]:
        """The start's coordinates and rates, which the first row has as the file writes them: by
        name, the place of the number in SI and the conversion to it."""
        found = {}
        for one in self.response.start:
            for order, number in enumerate((one.value, one.rate)):
                if number is not None:
                    name = one.name + ORDERS[order]
                    factor = factor_of(self.problem.units.conversion(self.known[name].dimension))
                    found[name] = {"si": self.number(number), "factor": factor}
        return found

    def _rates_of_start(self) -> Iterator[str]:
        """Those by which tables measure rounding."""
        for name in self._starts:
            if size_of_rate(self.known[name].dimension, self.analysis.result) is not None:
                yield name

    def _rates(self) -> Iterator[tuple[str, Plain]]:
        """Those of the start's coordinates."""
        for name in self._rates_of_start():
            value = self.problem.units.from_si(
                scalar_of(self.resolve(name)), self.known[name].dimension
            )
            yield name, {"cell": self.cell(value), "first": self._starts[name]}

    # The record.

    def _plan(self, demand: Demand) -> Plain:
        response, start, reading = self.response, self.start, self.reading
        calls, outputs, tape = reading.parts()
        limits = (*RESIDUAL_TESTS, tolerances.JUMP_LIMIT, tolerances.SPECTRAL_RADIUS)
        layout, graph = start.layout, start.base.graph
        values = (
            [float(time) for time in response.moments.values],
            [
                (kind, way, count, float(at), *powers)
                for kind, way, count, at, *powers in map(watched_stop, response.stops)
            ],
            float(response.tolerance),
            float(response.fixed_step or 0.0),
            tolerances.MOST_RESPONSE_STEPS,
            tolerances.DENSE_ROWS,
            [float(limit) for limit in limits],
            tolerances.NEWTON_ITERATIONS,
            int(start.base.problem.assembly.straight),
            [layout.state(edge, freedom) for edge, freedom in graph.inputs],
            int(demand),
            [(slot, turn, int(of)) for slot, turn, of in angle_slots(reading.base, reading.slots)],
            float(tolerances.SAME_MOMENT),
            float(CLEAR_CONDITION),
        )
        return {
            "start": start.reading(()).text(Demand.POSITION),
            "plan": plan_text(calls, outputs, tape, [("response", values)]),
        }

    def _run_record(self) -> Plain:
        """What only a response has."""
        moments = self.response.moments
        reading = self.reading
        return {
            "response": {
                "stops": [stop.words for stop in self.response.stops],
                "time": self.column("time", moments.values),
                "written": self.column("time as written", moments.written),
                "factor": factor_of(self.problem.units.conversion(TIME)),
                "energies": [reading.slots[name].start for name in ENERGIES],
                "rounding": float(tolerances.ENERGY_ROUNDING),
                "table": self._rows_name,
            },
            "sizes": self._sizes(),
        }
