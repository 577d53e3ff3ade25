"""The rows of a run by the kernel's double-double unit, with the numbers of the file's text.

The kernel starts from the converged doubles, closes the loops in double-double, and computes what
is wanted there. Constants and inputs are those of the text (`solver.precise`), so what is found is
true to about 1e-31 times the condition.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis.errors.parts import as_number, as_parts
from mechkin_cli.analysis.errors.repeated import NotRepeated
from mechkin_cli.expressions import Quantity
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.inputs import KernelInputs
from mechkin_cli.tape.double_doubles import DoubleDoubles
from mechkin_cli.tape.traced import TraceLost

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.errors.repeated import Wide
    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.precise import Precise
    from mechkin_cli.solver.precise_inputs import PreciseInputs
    from mechkin_cli.solver.session import Session


def wide_run(result: Result) -> KernelRows:
    """What repeats the rows of a run.

    Raises:
        NotRepeated: a number depends on the file's text in a way that no tape holds.
    """
    try:
        return KernelRows(result, result.session.precise)
    except (TraceLost, LookupError) as lost:
        raise NotRepeated(str(lost)) from None


class KernelRows:
    """The rows of a run in double-double, as `repeated.WideRun`.

    Args:
        result: the run.
        precise: the numbers of its session as the text says them.
        chosen: rows that are wanted (rows,); None: all.

    Attributes:
        residual: (rows,) the largest residual of closing a row so far, as a row's own; nan where
            nothing was closed.
    """

    def __init__(self, result: Result, precise: Precise, chosen: Bools | None = None) -> None:
        self.result = result
        self.precise = precise
        self.chosen = chosen
        self.residual: Floats = np.full(result.rows, np.nan)
        self._known: dict[int, tuple[Session, Floats]] = {}

    @property
    def given(self) -> PreciseInputs:
        """Inputs and time over the rows, as the text says them."""
        return self.precise.inputs(self.result.session)

    @property
    def known(self) -> Bools:
        """Rows that are repeated (rows,)."""
        reached = self.result.row_states.reached
        return reached if self.chosen is None else reached & self.chosen

    @cached_property
    def inputs(self) -> KernelInputs:
        """Of the rows, double-double."""
        given = self.given
        names = ("values", "rates", "accelerations", "jerks", "reduced")
        numbers: dict[str, Any] = {name: as_number(getattr(given, name)) for name in names}
        return KernelInputs(**numbers, whole=given.whole)

    @cached_property
    def parameters(self) -> Mapping[str, Quantity]:
        """The file's parameters, in SI."""
        known = self.result.problem.parameters
        found: dict[str, Quantity] = {}
        for name, (high, low) in self.precise.parameters.items():
            value: Any = DoubleDoubles(high, low)
            found[name] = Quantity(value, known[name].dimension)
        return found

    @cached_property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """Time and inputs with their rates, in the file's units."""
        return {name: DoubleDoubles(*parts) for name, parts in self.given.written.items()}

    @property
    def time(self) -> DoubleDoubles | None:
        """Time of the rows in s (rows,); None of a run without time."""
        time = self.given.time
        return None if time is None else DoubleDoubles(*time)

    @cached_property
    def states(self) -> DoubleDoubles:
        """The states of the plan (states, rows)."""
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
            quantity.name: values[slot.first : slot.first + slot.width].copy()
            for quantity, slot in ((q, slots[q.name]) for q in wanted)
        }

    def _run(
        self, wanted: Sequence[Wanted], session: Session, inputs: KernelInputs, demand: Demand
    ) -> tuple[DoubleDoubles, DoubleDoubles | None]:
        rows, given, forces = self.result.row_states, self.given, demand & Demand.FORCES
        known = self.known
        at = np.flatnonzero(known) if known.any() else np.zeros(1, dtype=np.intp)

        def parts(numbers: Any) -> Floats:
            return as_parts(numbers)[..., at]

        batch = session.run_precise(
            parts(inputs.reduced),
            **self._start(at, session),
            readout=session.readout(wanted) if wanted else None,
            constants=self._constants(session),
            output_constants=self.precise.outputs(session, wanted) if wanted else None,
            demand=demand & ~Demand.CONDITION,
            rates=parts(inputs.rates) if demand & Demand.VELOCITY else None,
            accelerations=parts(inputs.accelerations) if demand & Demand.ACCELERATION else None,
            jerks=parts(inputs.jerks) if demand & Demand.JERK else None,
            ties=None if given.tie_rates is None or not forces else given.tie_rates[..., at],
            turned=np.ascontiguousarray(rows.turns[:, at]),
            whole=np.ascontiguousarray(given.whole[:, at]),
            full=parts(inputs.values),
            time=None if given.time is None else np.ascontiguousarray(given.time[:, at]),
        )
        # what the text does not close exactly is solved by least squares, as in doubles
        closed = (batch.good | session.is_redundant) & known[at]
        self.residual[at] = np.fmax(self.residual[at], batch.residual[0])
        outputs = batch.outputs
        values = None if outputs is None else _put_back(outputs, at, closed, known.size)
        return _put_back(batch.states, at, closed, known.size), values

    def _start(self, at: NDArray[np.intp], session: Session) -> dict[str, Any]:
        """What `Session.run_precise` starts `session` from at the rows `at`."""
        return {"guess": np.ascontiguousarray(self.result.row_states.states[:, at])}

    def _constants(self, session: Session) -> Floats:
        """The constants of a session's plan as the text says them (constants, 2); kept."""
        if id(session) not in self._known:
            self._known[id(session)] = (session, self.precise.constants(session))
        return self._known[id(session)][1]


def _put_back(found: Floats, at: NDArray[np.intp], closed: Bools, rows: int) -> DoubleDoubles:
    """Numbers (numbers, 2, places) of the rows `at` among all; nan elsewhere and where a row did
    not close."""
    numbers = np.full((len(found), 2, rows), np.nan)
    numbers[..., at[closed]] = found[..., closed]
    return as_number(numbers)
