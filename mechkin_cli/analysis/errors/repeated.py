"""The rows of a run once more, in double-double numbers.

Nothing is decided again: which rows there are, their branch, the whole turns of angles and which
reactions are unique are those of the run. Its quantities are those of the same code, for derived
ones line by line (`tape.double_doubles`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import pi
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.analysis.errors.reasons import reason_of
from mechkin_cli.expressions import Quantity, UnknownName
from mechkin_cli.mechanism.bearing_loads import BEARING_KINDS, bearing_load
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.quantities import TIME_OF_ROW
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.status import Status
from mechkin_cli.tape.double_doubles import DoubleDoubles
from mechkin_cli.units import TIME, UnitSystem
from mechkin_cli.units.table import PI

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.inputs import KernelInputs
    from mechkin_cli.solver.session import Session

Wide = dict[str, DoubleDoubles]
"""Quantities by name: (1, rows), vectors (3, rows); SI."""


class WideRun(Protocol):
    """What gives the rows in double-double."""

    @property
    def inputs(self) -> KernelInputs:
        """Of the rows, as `Session.inputs`; the arrays are double-double."""
        ...

    @property
    def parameters(self) -> Mapping[str, Quantity]:
        """The file's parameters, in SI."""
        ...

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """Time and inputs with their rates, by the names of their quantities, in the file's
        units."""
        ...

    @property
    def time(self) -> DoubleDoubles | None:
        """Time of the rows in s (rows,); None of a run without time."""
        ...

    @property
    def states(self) -> DoubleDoubles:
        """The states of the plan (states, rows); nan in rows that did not close."""
        ...

    def run(
        self,
        wanted: Sequence[Wanted],
        session: Session,
        inputs: KernelInputs,
        demand: Demand,
    ) -> Wide:
        """Quantities of the kernel on the rows of the run; nan in rows that did not close."""
        ...


class NotRepeated(Exception):
    """A quantity is not repeated; the message says why."""


class Repeated:
    """A run in double-double.

    Args:
        result: the run.
        wide: what gives its rows.
    """

    shifts: tuple[int, ...] = ()

    def __init__(self, result: Result, wide: WideRun) -> None:
        self.result = result
        self.wide = wide
        self.row_states = result.row_states
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
    def session(self) -> Session:
        """The mechanism in the kernel."""
        return self.result.session

    @property
    def problem(self) -> Problem:
        """Mechanism, motion and assembly."""
        return self.session.problem

    @property
    def units(self) -> UnitSystem:
        """The file's units."""
        return self.problem.units

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.result.rows

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """What the rows were given, in the file's units."""
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
        if derived:
            from mechkin_cli.analysis.derived import basis_of

            basis = basis_of(self.problem.mechanism, derived)
            plain += [q for q in basis if q.name not in self._columns and q not in plain]
        if plain:
            found = self.evaluated(plain)
            self._rests |= self._turned(plain, found)
            self._columns |= found
        if derived:
            self._columns |= self._derived(derived)

    def _derived(self, wanted: list[Wanted]) -> Wide:
        from mechkin_cli.analysis.derived import Reading, derived_columns

        run: Any = Reading(self, self._columns, self.wide.inputs)  # type: ignore[arg-type]
        try:
            found: Any = derived_columns(run, wanted)
        except TypeError as error:
            raise NotRepeated(f"computed in doubles alone ({error})") from None
        return dict(found)

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
        found = self.wide.run(wanted, session, self._exact(inputs), demand)
        rows = self.row_states
        unclear = np.isin(rows.status, (Status.rank_unclear, Status.dead_centre))
        for quantity in wanted:
            own = found[quantity.name]
            own[:, ~rows.reached] = np.nan
            if unclear.any() and demand_of(self.problem.mechanism, [quantity]):
                own[:, unclear] = np.nan
        return found

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

    def _turned(self, wanted: Sequence[Wanted], found: Wide) -> Wide:
        """Gives angles the whole turns that they have in the run, in place; returns what they are
        within a turn."""
        rests: Wide = {}
        for quantity in wanted:
            if quantity.kind != "coordinate" or quantity.order or not is_angle(quantity.coordinate):
                continue
            said = np.asarray(self.result.quantity(quantity.name).value)
            within = found[quantity.name][0]
            turns = np.rint((said - within.high) / (2.0 * pi))
            turns = np.where(np.isfinite(turns), turns, 0.0)
            if turns.any():
                turned = within + turns * DoubleDoubles.of_fraction(2 * PI)
                rests[quantity.name] = within.copy()
                found[quantity.name] = np.stack([turned])  # type: ignore[assignment]
        return rests
