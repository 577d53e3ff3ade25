"""The rows of a run by the kernel's double-double unit, with the numbers of the file's text.

The kernel starts from the converged doubles, closes the loops in double-double, and computes what
is wanted there (`KernelRows`). Constants and inputs are those of the text (`session.precise`), so
results are true to about 1e-31 times the condition.

Nothing is decided again (`Repeated`): which rows there are, their branch, the whole turns of angles
and which reactions are unique are those of the run. Its quantities are those of the same code, for
derived ones line by line (`tape.double_doubles`). `reason_of` gives why a quantity is not repeated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.derived import BasisQuantities, basis_of, derived_columns
from mechkin_cli.exact import PI
from mechkin_cli.expressions import Quantity, UnknownName
from mechkin_cli.mechanism import (
    BEARING_KINDS,
    DERIVED_KINDS,
    DRIVEN_KINDS,
    FINITE_KINDS,
    LEDGER_KINDS,
    TIME_OF_ROW,
    bearing_load,
    friction_states,
    is_angle,
    rubbing_words,
)
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.session import Ask, KernelInputs, PreciseConstants, RowInputs
from mechkin_cli.tape import DoubleDoubles, TraceLost, exactly
from mechkin_cli.units import TIME
from mechkin_cli.verdict import has_rates

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.session import Precise, PreciseInputs, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Result


def as_number(parts: Floats) -> DoubleDoubles:
    """(numbers, 2, rows) as double-doubles (numbers, rows)."""
    return DoubleDoubles(parts[:, 0], parts[:, 1])


def as_parts(numbers: Any) -> Floats:
    """Double-doubles (numbers, rows) as (numbers, 2, rows)."""
    exact = exactly(numbers)
    return np.stack([exact.high, exact.low], axis=1)


# why a quantity is not repeated
VERDICT = "a verdict"
WORDS = "words"
INTEGRAL = "an integral over the rows"
TABLE_LOADS = "the effort of a table alone, whose curve is known in doubles"
IMPACTS = "the motion rebounds from a limit"
CROSSED = "the motion passes a branch point"
OTHER_RATES = "the start gives rates of other coordinates"
STOP = "the moment of a stop"
NOT_RESOLVED = "beyond the moment at which the steps of the repetition run out"
DRAWING = "measured from the drawing in doubles"
DENSE = "a dense system"
BALANCE = "a balance over all rows"
SUMMARY = "a summary: off by no more than twice the worst cell of its column"
AS_DRIVEN = "read as if the start's coordinates were driven"


def sticking(problem: Problem) -> str:
    """Why a response that rubs is not repeated."""
    named = rubbing_words(problem.mechanism.frictions)
    return f"{named}: when what rubs sticks and slips is found in doubles"


_NUMBERS_OF_ROWS = {"time", "kinetic_energy", "potential_energy", "work", "dissipated"}


def reason_of(problem: Problem, quantity: Wanted) -> str:
    """Why the quantity is not repeated; "" where it is."""
    if quantity.owner == "row" and quantity.kind not in _NUMBERS_OF_ROWS:
        return VERDICT
    if quantity.kind in LEDGER_KINDS:
        return INTEGRAL
    if problem.response is not None and quantity.kind in DRIVEN_KINDS:
        return AS_DRIVEN
    if quantity.kind in FINITE_KINDS - {"finite_angle"}:
        return DRAWING
    return ""


Wide = dict[str, DoubleDoubles]
"""Quantities by name: (1, rows), vectors (3, rows); SI."""


class NotRepeated(Exception):
    """A quantity is not repeated; the message says why."""


class Repeated:
    """A run in double-double.

    Args:
        result: the run.
        wide: its rows in double-double.

    Attributes:
        session: the mechanism in the kernel.
        problem: mechanism, motion and assembly.
        units: of the file.
        rows: number of rows.
    """

    shifts: tuple[int, ...] = ()

    def __init__(self, result: Result, wide: KernelRows) -> None:
        self.result, self.wide, self.row_states = result, wide, result.row_states
        self.session, self.problem = result.session, result.problem
        self.units, self.rows = result.units, result.rows
        self._columns: Wide = {}
        self._rests: Wide = {}

    @property
    def rough(self) -> Repeated | None:
        """The same less finely repeated, where the repetition has errors of its own."""
        return None

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated; "" where that is not known."""
        return ""

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """Time and inputs of the rows, in the file's units."""
        return self.wide.written

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI.

        Raises:
            UnknownName: nothing has this name.
            NotRepeated: it is not repeated.
        """
        if name in self.problem.parameters:
            return self.wide.parameters[name]
        time: Any = self.wide.time
        if name == TIME_OF_ROW.name and time is not None:
            return Quantity(time, TIME)
        wanted = self.problem.quantities().get(name)
        if wanted is None:
            raise UnknownName(name, (), None)
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self.quantity)
        if name not in self._columns:
            self.read([wanted])
        columns = self._columns[name]
        if wanted.vector:
            return Quantity(wanted.value(columns), wanted.dimension)
        value: Any = columns[0]
        rest: Any = self._rests.get(name)
        return Quantity(value, wanted.dimension, rest)

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Repeats quantities, as many as possible in one run.

        Raises:
            NotRepeated: one is not repeated.
        """
        known = self._columns.keys() | {TIME_OF_ROW.name}
        new = [q for q in dict.fromkeys(wanted) if q.name not in known]
        for quantity in new:
            reason = reason_of(self.problem, quantity)
            if reason:
                raise NotRepeated(reason)
        plain = [quantity for quantity in new if quantity.kind not in DERIVED_KINDS]
        derived = [quantity for quantity in new if quantity.kind in DERIVED_KINDS]
        basis = basis_of(self.problem.mechanism, derived)
        plain += [q for q in basis if q.name not in self._columns and q not in plain]
        if plain:
            columns = self.evaluated(plain)
            self._rests |= self._turned(plain, columns)
            self._columns |= columns
        if derived:
            run = BasisQuantities(self, self._columns, self.wide.inputs)  # type: ignore[arg-type]
            try:
                of_run: Any = derived_columns(run, derived)
            except TypeError as error:
                raise NotRepeated(f"computed in doubles alone ({error})") from None
            self._columns |= of_run

    def evaluated(
        self,
        wanted: Sequence[Wanted],
        *,
        session: Session | None = None,
        inputs: KernelInputs | None = None,
        demand: Demand = Demand.POSITION,
        shift: int = 0,
    ) -> Wide:
        """Quantities on the rows, as `Result.evaluated`; of the balance of least norm alone."""
        session = session or self.session
        demand |= demand_of(session.problem.mechanism, wanted)
        read = list(wanted)
        if demand & Demand.FORCES:
            read += friction_states(session.problem.mechanism)
        columns = self.wide.run(read, session, self._exact(inputs), demand)
        # codes of `FrictionState`, 0 where friction has its forces
        states = [columns.pop(state.name)[0] for state in read[len(wanted) :]]
        rows = self.row_states
        without = np.zeros(self.rows, dtype=bool)
        for state in states:
            without |= state.high != 0.0
        unclear = ~has_rates(rows.status)
        for quantity in wanted:
            own = columns[quantity.name]
            own[:, ~rows.reached] = np.nan
            asked = demand_of(self.problem.mechanism, [quantity])
            if asked:
                own[:, unclear] = np.nan
            if asked & Demand.FORCES:
                own[:, without] = np.nan
        return columns

    def _exact(self, inputs: KernelInputs | None) -> KernelInputs:
        """The rows' inputs, with those rates of `inputs` that are not the rows' own: of whole
        numbers, as those of a unit motion."""
        own, exact = self.session.inputs, self.wide.inputs
        if inputs is None or inputs is exact:
            return exact
        moving = ("rates", "accelerations", "jerks")
        others = {name: getattr(inputs, name) for name in moving}
        known = {id(getattr(one, name)) for one in (own, exact) for name in moving}
        return exact._replace(**{k: v for k, v in others.items() if id(v) not in known})

    def _turned(self, wanted: Sequence[Wanted], columns: Wide) -> Wide:
        """Gives angles the whole turns that they have in the run, in place; returns what they are
        within a turn."""
        rests: Wide = {}
        for quantity in wanted:
            if quantity.kind != "coordinate" or quantity.order or not is_angle(quantity.coordinate):
                continue
            in_run = np.asarray(self.result.quantity(quantity.name).value)
            within = columns[quantity.name][0]
            turns = np.rint((in_run - within.high) / (2.0 * pi))
            turns = np.where(np.isfinite(turns), turns, 0.0)
            if turns.any():
                turned = within + turns * DoubleDoubles.of_fraction(2 * PI)
                rests[quantity.name] = within.copy()
                columns[quantity.name] = np.stack([turned])  # type: ignore[assignment]
        return rests


def wide_run(result: Result) -> KernelRows:
    """The rows of a run in double-double.

    Raises:
        NotRepeated: a number depends on the file's text in a way that no tape holds.
    """
    try:
        return KernelRows(result, result.session.precise)
    except (TraceLost, LookupError) as lost:
        raise NotRepeated(str(lost)) from None


class KernelRows:
    """The rows of a run in double-double.

    Args:
        result: the run.
        precise: the numbers of its session's text.
        chosen: rows that are wanted (rows,); None: all.

    Attributes:
        residual: (rows,) the largest residual of closing a row so far, as a row's own; nan where
            nothing was closed.
    """

    def __init__(self, result: Result, precise: Precise, chosen: Bools | None = None) -> None:
        self.result, self.precise, self.chosen = result, precise, chosen
        self.residual: Floats = np.full(result.rows, np.nan)

    @property
    def of_text(self) -> PreciseInputs:
        """Inputs and time of the text over the rows."""
        return self.precise.inputs(self.result.session)

    @property
    def known(self) -> Bools:
        """Rows that are repeated (rows,)."""
        reached = self.result.row_states.reached
        return reached if self.chosen is None else reached & self.chosen

    @cached_property
    def inputs(self) -> KernelInputs:
        """Of the rows, as `Session.inputs`; the arrays are double-double."""
        names = ("values", "rates", "accelerations", "jerks", "reduced")
        numbers: dict[str, Any] = {name: as_number(getattr(self.of_text, name)) for name in names}
        return KernelInputs(**numbers, whole=self.of_text.whole)

    @cached_property
    def parameters(self) -> Mapping[str, Quantity]:
        """The file's parameters, in SI."""
        known = self.result.problem.parameters
        parameters: dict[str, Quantity] = {}
        for name, (high, low) in self.precise.parameters.items():
            value: Any = DoubleDoubles(high, low)
            parameters[name] = Quantity(value, known[name].dimension)
        return parameters

    @cached_property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """Time and inputs with their rates, by the names of their quantities, in the file's
        units."""
        return {name: DoubleDoubles(*parts) for name, parts in self.of_text.written.items()}

    @property
    def time(self) -> DoubleDoubles | None:
        """Time of the rows in s (rows,); None of a run without time."""
        time = self.of_text.time
        return None if time is None else DoubleDoubles(*time)

    @cached_property
    def states(self) -> DoubleDoubles:
        """The states of the plan (states, rows); nan in rows that did not close."""
        return self._run((), self.result.session, self.inputs, Demand.POSITION)[0]

    def run(
        self, wanted: Sequence[Wanted], session: Session, inputs: KernelInputs, demand: Demand
    ) -> Wide:
        """Quantities of the kernel on the rows of the run; nan in rows that did not close."""
        try:
            values = self._run(wanted, session, inputs, demand)[1]
        except (TraceLost, LookupError, ValueError) as lost:
            raise NotRepeated(str(lost)) from None
        assert values is not None
        slots = session.readout(wanted).slots
        return {
            quantity.name: values[slot].copy()
            for quantity, slot in ((q, slots[q.name]) for q in wanted)
        }

    def _run(
        self, wanted: Sequence[Wanted], session: Session, inputs: KernelInputs, demand: Demand
    ) -> tuple[DoubleDoubles, DoubleDoubles | None]:
        known = self.known
        at = np.flatnonzero(known) if known.any() else np.zeros(1, dtype=np.intp)
        ask = Ask(demand & ~Demand.CONDITION, session.readout(wanted) if wanted else None)
        written = self.precise.outputs(session, wanted) if wanted else None
        numbers = PreciseConstants(self._constants(session), written)
        batch = session.run(self._row_inputs(inputs, session).at(at), ask, numbers)
        # what the text does not close exactly is solved by least squares, as in doubles
        closed = (batch.good | session.is_redundant) & known[at]
        self.residual[at] = np.fmax(self.residual[at], batch.residual[0])
        outputs = batch.outputs
        values = None if outputs is None else _put_back(outputs, at, closed, known.size)
        return _put_back(batch.states, at, closed, known.size), values

    def _row_inputs(self, inputs: KernelInputs, session: Session) -> RowInputs:
        """The rows of a run of `session`."""
        of_text, rows = self.of_text, self.result.row_states
        values, rates, accelerations, jerks, reduced, _ = map(as_parts, inputs)
        in_parts = KernelInputs(values, rates, accelerations, jerks, reduced, of_text.whole)
        return in_parts.at(rows.states, rows.turns, of_text.time, of_text.constraint_rates)

    def _constants(self, session: Session) -> Floats:
        """The constants of a session's plan in the text (constants, 2)."""
        return self.precise.constants(session)


def _put_back(some: Floats, at: NDArray[np.intp], closed: Bools, rows: int) -> DoubleDoubles:
    """Numbers (numbers, 2, places) of the rows `at` among all; nan elsewhere and where a row did
    not close."""
    numbers = np.full((len(some), 2, rows), np.nan)
    numbers[..., at[closed]] = some[..., closed]
    return as_number(numbers)
