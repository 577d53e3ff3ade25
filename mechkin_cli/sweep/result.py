"""A finished run: the states of all rows, their verdicts, and every quantity computed from them.

Quantities are evaluated on the stored states when they are asked for, at the first reading or
later; nothing is searched or followed again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np

from mechkin_cli import assembly, derived, proofs
from mechkin_cli.expressions import Quantity, UnknownName
from mechkin_cli.mechanism import BEARING_KINDS, DERIVED_KINDS, bearing_load
from mechkin_cli.plan import REACTION_KINDS, Demand, Readout, demand_of, forces_demand
from mechkin_cli.row_notes import told
from mechkin_cli.session import Ask, RowInputs, input_number, input_rest
from mechkin_cli.sweep.friction import FrictionRows
from mechkin_cli.sweep.messages import is_held, undefined_loads
from mechkin_cli.sweep.rows import (
    DISTURBANCES,
    SHIFTS,
    Columns,
    SweepRows,
    disturbed,
    error_bound,
    make_continuous,
    reaction_rounding,
)
from mechkin_cli.units import DIMENSIONLESS, UnitSystem
from mechkin_cli.verdict import Proof, Status, are, are_ok, has_solution

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.derived import OtherMoments
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Mechanism, Problem, Wanted
    from mechkin_cli.proofs import SweepProofs
    from mechkin_cli.session import Batch, KernelInputs, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.structure import SolverGraph
    from mechkin_cli.tables import Columns as TableColumns, TableLayout


def columns_of(rows: SweepRows, mechanism: Mechanism, readout: Readout, batch: Batch) -> Columns:
    """The outputs of a run by name, (width, rows); nan in rows without a position, and what depends
    on a rank that is unclear."""
    values = batch.outputs
    assert values is not None
    if not rows.reached.all():
        values[:, ~rows.reached] = np.nan
    unclear = are(rows.status, Status.rank_unclear)
    some_unclear = np.count_nonzero(unclear) > 0
    columns = {}
    for quantity in readout.wanted:
        slot = readout.slots[quantity.name]
        column = values[slot]
        if some_unclear and demand_of(mechanism, [quantity]):
            column[:, unclear] = np.nan
        columns[quantity.name] = column
    return columns


ROW_NUMBERS = {f"row.{n}": n for n in ("residual", "condition", "power_error", "error_bound")}
"""Verdicts that are numbers, by the names of their quantities."""


def _join(columns: Columns, parts: Sequence[Columns], own: Sequence[slice], rows: int) -> None:
    """Joins the columns that all parts have, each of its `own` rows, in one array: the system gives
    large pages to large arrays alone, and small ones take longer to come by than to fill."""
    names = [name for name in parts[0] if all(name in part for part in parts)]
    room = np.empty((sum(len(parts[0][name]) for name in names), rows))
    first = 0
    for name in names:
        place = room[first : first + len(parts[0][name])]
        values = [part[name][:, some] for part, some in zip(parts, own, strict=True)]
        columns[name] = np.concatenate(values, axis=-1, out=place)
        first += len(place)


class Result:
    """The rows of a sweep with a position and a verdict each.

    Args:
        session: the part of the mechanism that was followed, in parts of the first row's size.
        start: the first assembly.
        rows: the rows, closed.
        between: the motion between the rows, where it is known.
    """

    def __init__(
        self,
        session: Session,
        start: AssemblyStart,
        rows: SweepRows,
        between: Callable[[Result], OtherMoments | None] | None = None,
    ) -> None:
        self._between = between
        self.session = session
        self.start = start
        self.row_states = rows
        self.run_start = session, start
        self.events: tuple[str, ...] = ()
        self.run_events: tuple[str, ...] = ()
        self.measure = ""
        self.demand = Demand.POSITION
        self.residual = np.empty(rows.reached.size)
        self.residual.fill(np.nan)
        self.shifts: tuple[int, ...] = SHIFTS if session.is_redundant else ()
        self._columns: Columns = {}
        self._rests: Columns = {}
        self._shifted: tuple[Columns, ...] = tuple({} for _ in self.shifts)
        self._alternative: int | None = None
        self._disturbance: int | None = None
        self._condition: Floats | None = None
        self._power_error: Floats | None = None
        self._error_bound: Floats | None = None
        self._unloaded: bool | None = None
        self._certificate: SweepProofs | None = None
        self.friction = FrictionRows()

    @property
    def problem(self) -> Problem:
        """Mechanism, motion and assembly of the part that was followed."""
        return self.session.problem

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks."""
        return self.session.graph

    @cached_property
    def mode(self) -> str:
        """The letter of the rows' assembly mode where a short search proves that it knows all
        modes; else `near` or `home`."""
        return assembly.mode_letter(*self.run_start, thorough=False)

    @cached_property
    def letter(self) -> str:
        """The letter of the assembly mode, searched for if it is not known yet."""
        return assembly.mode_letter(*self.run_start)

    @property
    def how(self) -> str:
        """How the first assembly was found."""
        return self.start.how

    @property
    def nodes(self) -> int:
        """Steps with which the branch was followed."""
        return self.row_states.nodes

    @property
    def rows(self) -> int:
        """Number of rows asked for."""
        return self.problem.motion.rows

    @property
    def status(self) -> NDArray[np.int8]:
        """Verdict of every row, codes of `Status` (rows,)."""
        return self.row_states.status

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All messages of the run."""
        rows = self.row_states
        own = told(rows.diagnostics, rows.span.first, rows.span.run_rows)
        return (*self.problem.diagnostics, *self.start.diagnostics, *own)

    @property
    def units(self) -> UnitSystem:
        """The file's units."""
        return self.problem.units

    @property
    def coordinates(self) -> Sequence[str]:
        """All joint coordinates in joint order."""
        return self.problem.mechanism.coordinates

    @cached_property
    def inputs(self) -> Mapping[str, Floats]:
        """Time where there is one, then the inputs' values, in the file's units exactly as
        written."""
        time = self.problem.motion.time
        inputs = {i.name: i.written for i in self.problem.motion.inputs}
        for number in self._resting:
            name = self.problem.motion.inputs[number].name
            inputs[name] = np.where(self.solved, inputs[name], np.nan)
        return inputs if time is None else {"time": time.written, **inputs}

    @property
    def _resting(self) -> tuple[int, ...]:
        """The numbers of the inputs that nothing drives."""
        rest = self.problem.motion.rest
        return () if rest is None else rest.inputs

    @property
    def length(self) -> float:
        """About the size of the mechanism, in m."""
        return self.session.layout.length

    @cached_property
    def input_rates(self) -> Mapping[str, Floats]:
        """The inputs' rates of all orders in the file's units as written, nan in rows without a
        solution."""
        known, rates = self.problem.quantities(), {}
        for driven in self.problem.motion.inputs:
            for name, (_, written) in driven.orders.items():
                if name in known and name != driven.name:
                    rates[name] = self._where_solved(written)
        return rates

    @cached_property
    def solved(self) -> Bools:
        """Rows that have a position (rows,)."""
        return has_solution(self.status)

    def _where_reached(self, values: Floats) -> Floats:
        """The values with nan in rows without a position, and themselves where there are none."""
        reached = self.row_states.reached
        if np.count_nonzero(reached) == reached.size:
            return values
        return np.where(reached, values, np.nan)

    def _where_solved(self, values: Floats) -> Floats:
        """The values with nan in rows without a solution, and themselves where there are none."""
        if np.count_nonzero(self.solved) == self.solved.size:
            return values
        return np.where(self.solved, values, np.nan)

    @property
    def complete(self) -> bool:
        """Whether every row has a solution, and all loads, friction and actuators it needs."""
        lost = self._unloaded or self.friction.is_lost
        return bool(self.solved.all()) and not lost and is_held(self)

    @property
    def sound(self) -> bool:
        """Whether every row is `ok`."""
        return are_ok(self.status)

    @property
    def condition(self) -> Floats:
        """1 / smallest singular value of every row's scaled blocks (rows,); nan where it was not
        computed."""
        return self._nothing if self._condition is None else self._condition

    @property
    def power_error(self) -> Floats:
        """|sum of powers| / sum of |powers| of every row (rows,); nan where nothing works, or where
        it was not computed."""
        return self._nothing if self._power_error is None else self._power_error

    @cached_property
    def _nothing(self) -> Floats:
        return np.full(self.rows, np.nan)

    def _verdict(self, name: str) -> Floats:
        """A number of the row by its name, computed now if it was not."""
        if name == "condition" and self._condition is None and self.graph.blocks:
            self._store_verdicts(self.run(Ask(Demand.CONDITION, iterations=0)))
        if name == "power_error" and self._power_error is None:
            demand = forces_demand(self.problem.mechanism) | Demand.VELOCITY | Demand.POWER
            self._store_verdicts(self.run(Ask(demand, iterations=0)))
        if name == "error_bound":
            if self._error_bound is None:
                self._error_bound = error_bound(self)
            return self._error_bound
        found: Floats = getattr(self, name)
        return found

    @property
    def certificate(self) -> SweepProofs:
        """What is proven of the rows."""
        if self._certificate is None:
            rows = self.row_states
            solved = self.solved & rows.reached
            self._certificate = proofs.certify(self.session, rows.states, solved, rows.ends)
        return self._certificate

    @property
    def is_certified(self) -> bool:
        """Whether proofs have been asked for."""
        return self._certificate is not None

    @property
    def proven_way(self) -> tuple[bool, int]:
        """Whether all rows are proven to lie on one branch, and how many tubes join them."""
        return bool(self.certificate.is_complete), int(self.certificate.tubes)

    @property
    def proven_dead_centres(self) -> list[dict[str, object]]:
        """What is proven of the dead centres beyond which rows are missing, as plain data in the
        file's units: bounds are None where none is proven to exist; rows count from 1."""
        records, session = [], self.session
        for found in self.certificate.dead_centres:
            place = float(found.place[found.number])
            record = input_number(session.problem, session.layout, found.number, place).record()
            low, high = (x if isfinite(x) else None for x in proofs.input_bounds(session, found))
            record |= {"low": low, "high": high, "last_row": found.row + 1, "tubes": found.tubes}
            proof = Proof.not_proven if found.why else Proof.proven
            records.append(record | {"proof": proof.label})
        return records

    @property
    def proof(self) -> NDArray[np.int8]:
        """What is proven of every row, codes of `Proof` (rows,)."""
        return self.certificate.status

    @property
    def impact_table(self) -> TableColumns | None:
        """The impacts of a response; None where there are none, and of a sweep."""
        return None

    @property
    def columns(self) -> Mapping[str, Floats]:
        """What has been read, see `Columns`."""
        return self._columns

    @cached_property
    def alternatives(self) -> tuple[Result, ...]:
        """The same rows with other reactions in equilibrium (redundant constraints)."""
        return self._with_other_reactions("_alternative", len(self.shifts))

    @cached_property
    def disturbed(self) -> tuple[Result, ...]:
        """The same rows with reactions off by their rounding, where some may not be unique."""
        return self._with_other_reactions("_disturbance", len(DISTURBANCES) if self.shifts else 0)

    def _with_other_reactions(self, attribute: str, count: int) -> tuple[Result, ...]:
        results = []
        for number in range(count):
            other = copy(self)  # of the same rows, with what has been read of them
            other.alternatives = other.disturbed = ()
            setattr(other, attribute, number)
            results.append(other)
        return tuple(results)

    @cached_property
    def _rounding(self) -> Floats:
        return reaction_rounding(self)

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """
        problem = self.problem
        if name in problem.parameters:
            return problem.parameters[name]
        if name in ROW_NUMBERS:
            return Quantity(self._verdict(ROW_NUMBERS[name]), DIMENSIONLESS)
        wanted = problem.quantities().get(name)
        if wanted is None:
            raise UnknownName(name, problem.told_quantities, problem.why_not(name))
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self.quantity)
        if (values := self._prescribed(name)) is not None:
            return Quantity(values, wanted.dimension, input_rest(self.session, name))
        if name not in self._columns:
            self.read([wanted])
        columns = self._columns[name]
        if self._alternative is not None:
            columns = self._shifted[self._alternative].get(name, columns)
        if self._disturbance is not None and wanted.kind in REACTION_KINDS:
            unit = self.session.layout.length
            columns = disturbed(columns, wanted, self._rounding, unit, self._disturbance)
        if wanted.vector:
            return Quantity(wanted.value(columns), wanted.dimension)
        return Quantity(columns[0], wanted.dimension, self._rests.get(name))

    def _prescribed(self, name: str) -> Floats | None:
        """Time, an input's value or its rates in SI; None for what is computed."""
        motion = self.problem.motion
        if name == "time" and motion.time is not None:
            return motion.time.values
        for number, driven in enumerate(motion.inputs):
            if name == driven.name and number in self._resting:
                return np.where(self.solved, driven.values, np.nan)
            if name == driven.name:
                return driven.values
            if name.startswith(driven.name) and name in driven.orders:
                return self._where_solved(driven.orders[name][0])
        return None

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""
        wanted = list({quantity.name: quantity for quantity in wanted}.values())
        for name in (ROW_NUMBERS[q.name] for q in wanted if q.name in ROW_NUMBERS):
            self._verdict(name)
        new = [q for q in wanted if q.name not in self._columns and q.owner != "row"]
        later = [quantity for quantity in new if quantity.kind in DERIVED_KINDS]
        plain = [quantity for quantity in new if quantity.kind not in DERIVED_KINDS]
        if later:
            basis = derived.basis_of(self.problem.mechanism, later)
            plain += [quantity for quantity in basis if quantity.name not in self._columns]
        if plain:
            self._read_plain(plain)
        if later:
            self._columns |= derived.derived_columns(self.basis, later)

    @property
    def basis(self) -> derived.BasisQuantities:
        """What derived quantities are computed from."""
        between = None if self._between is None else self._between(self)
        return derived.BasisQuantities(self, self._columns, self.session.inputs, between)

    def take(self, columns: Columns) -> None:
        """Takes quantities of these rows that go by those of the run before and behind them."""
        self._columns |= columns

    def _read_plain(self, wanted: list[Wanted]) -> None:
        demand = demand_of(self.problem.mechanism, wanted)
        wanted += self.friction.beside(self.problem, wanted, demand)
        if demand & Demand.FORCES and demand & Demand.VELOCITY and self._power_error is None:
            demand |= Demand.POWER
        ask = Ask(demand, self.session.readout(wanted), iterations=0)
        self._keep_read(self.run(ask), ask)

    def keep(self, batch: Batch, ask: Ask) -> None:
        """Keeps what the run that closed the rows found."""
        self.residual = self._where_reached(batch.residual)
        self._keep_read(batch, ask)

    def _keep_read(self, batch: Batch, ask: Ask) -> None:
        if self.demand != ask.demand:  # flags are slow, and short runs are many
            self.demand = self.demand | ask.demand if self.demand else ask.demand
        self._store_verdicts(batch)
        if ask.readout is None:
            return
        columns, outputs = self._split(ask.readout, batch), batch.outputs
        assert outputs is not None
        wanted = ask.readout.wanted
        self._rests |= make_continuous(self, wanted, outputs)
        self._columns |= columns
        self.friction.judge(self, wanted, ask.demand)
        reactions = [quantity for quantity in wanted if quantity.kind in REACTION_KINDS]
        for shift, others in zip(self.shifts if reactions else (), self._shifted, strict=False):
            others |= self.evaluated(reactions, shift=shift)

    def join(self, results: Sequence[Result], own: Sequence[slice]) -> None:
        """Takes what was found of the rows in parts, of which this result has all: in each `own`
        rows are in no part before it."""

        def joined(arrays: Sequence[Floats | None]) -> Floats | None:
            if all(each is None for each in arrays):
                return None
            parts = [
                (each._nothing if array is None else array)[..., rows]
                for array, each, rows in zip(arrays, results, own, strict=True)
            ]
            return np.ascontiguousarray(np.concatenate(parts, axis=-1))

        self.residual = cast("Floats", joined([each.residual for each in results]))
        self._condition = joined([each._condition for each in results])
        self._power_error = joined([each._power_error for each in results])
        if all(each._error_bound is not None for each in results):
            # boxes of a part are those of its own rows
            self._error_bound = joined([each._error_bound for each in results])
        lost = [each._unloaded for each in results if each._unloaded is not None]
        self._unloaded = any(lost) if lost else None
        for each in results:
            self.demand |= each.demand
        _join(self._columns, [each._columns for each in results], own, self.rows)
        for number, others in enumerate(self._shifted):
            _join(others, [each._shifted[number] for each in results], own, self.rows)
        for name in dict.fromkeys(name for each in results for name in each._rests):
            rest = joined([each._rests.get(name, each._columns[name][0]) for each in results])
            assert rest is not None
            self._rests[name] = rest
        self.friction.join([each.friction.verdict for each in results], own)

    def evaluated(
        self,
        wanted: Sequence[Wanted],
        *,
        session: Session | None = None,
        inputs: KernelInputs | None = None,
        demand: Demand = Demand.POSITION,
        shift: int = 0,
    ) -> Columns:
        """Quantities on the stored states, without storing them: with other `inputs` (rates), of a
        session that differs in masses and loads alone, or with the reactions of a `shift`."""
        own = session or self.session
        demand |= demand_of(own.problem.mechanism, wanted)
        readout = own.readout(wanted)
        ask = Ask(demand, readout, shift=shift, iterations=0)
        return self._split(readout, self.run(ask, session=session, inputs=inputs))

    def run(
        self, ask: Ask, *, session: Session | None = None, inputs: KernelInputs | None = None
    ) -> Batch:
        """One call of the kernel over all rows on their states; rows without a state repeat
        another's."""
        session, states = session or self.session, self.row_states
        rows = self._row_inputs(session, inputs or self.session.inputs)
        rows = rows._replace(limit=states.limit)
        if not states.reached.all():
            reached = states.reached
            rows = rows.at(np.where(reached, np.arange(reached.size), reached.argmax()))
        batch = session.run(rows, ask)
        if states.dead_centres and ask.readout is not None:
            from mechkin_cli.sweep.dead_centre import put_unbounded

            put_unbounded(session, states, rows, ask, batch)
        return batch

    def _row_inputs(self, session: Session, inputs: KernelInputs) -> RowInputs:
        """What a run of a session is given for the rows."""
        return session.row_inputs(self.row_states.states, self.row_states.turns, inputs)

    def _split(self, readout: Readout, batch: Batch) -> Columns:
        return columns_of(self.row_states, self.problem.mechanism, readout, batch)

    def _store_verdicts(self, batch: Batch) -> None:
        if batch.condition is not None and self._condition is None:
            self._condition = self._where_reached(batch.condition)
        if batch.power_error is not None and self._power_error is None:
            self._power_error = self._where_reached(batch.power_error)
        if batch.undefined is not None and self._unloaded is None:
            lost = batch.undefined.astype(bool) & self.row_states.reached
            self._unloaded = bool(lost.any())
            if self._unloaded:
                self.row_states.diagnostics += undefined_loads(self, lost)


# An analysis is put together above: other rooms know it as follows.


class HasName(Protocol):
    """A model, by its name."""

    @property
    def name(self) -> str:
        """The mechanism's name."""
        ...


class Readable(Protocol):
    """An analysis, as the rooms that read one know it."""

    @property
    def model(self) -> HasName:
        """Of the file."""
        ...

    @property
    def run(self) -> str:
        """`sweep`, or the name of a response."""
        ...

    @property
    def rows(self) -> int:
        """Number of rows."""
        ...

    @property
    def result(self) -> Result:
        """States and verdicts of all rows."""
        ...

    @property
    def layouts(self) -> tuple[TableLayout, ...]:
        """Layouts of the tables."""
        ...

    @property
    def tables(self) -> tuple[TableColumns, ...]:
        """The tables of the run, evaluated in the file's units."""
        ...

    @property
    def coefficients(self) -> tuple[TableColumns, ...]:
        """The tables of dense systems of reactions."""
        ...

    @property
    def balance_tables(self) -> tuple[TableColumns, ...]:
        """The balances of the run."""
        ...

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that the run has to say."""
        ...

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity in the file's units, (rows,), or (rows, 3) of a vector."""
        ...
