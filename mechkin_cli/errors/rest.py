"""Places at which loads balance in double-double: equilibria, and the rows of a sweep at rest.

The place in doubles is corrected by Newton's steps: forces that are left are those of the text's
numbers in double-double, the stiffness is that of doubles, so that each step gains eight digits or
more. With K dq = -Q the last one tells how far the place is off. Where the stiffness is zero, as of
an indifferent equilibrium or at a fold, there is no such place.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.errors.motion import MotionPlaces, state_rates
from mechkin_cli.errors.response import FreeRows, RepeatedFree
from mechkin_cli.errors.rows import KernelRows, as_number, as_parts
from mechkin_cli.exact import PI
from mechkin_cli.mechanism import dimension_of
from mechkin_cli.plan import Demand
from mechkin_cli.session import Ask, KernelInputs, PreciseConstants, input_unit
from mechkin_cli.statics import Place, Statics
from mechkin_cli.tape import DoubleDoubles, eliminate

if TYPE_CHECKING:
    from mechkin_cli.session import PreciseInputs, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics import EquilibriumResult
    from mechkin_cli.sweep import Result


class EquilibriumRows(FreeRows):
    """The rows of equilibria in double-double.

    Args:
        result: the equilibria.
        precise: the numbers of its session's text.
    """

    result: EquilibriumResult

    @cached_property
    def of_text(self) -> PreciseInputs:
        """The moment of the rows, and what is held."""
        moments = self.precise.moments[:, :, :1]
        in_si, written = np.repeat(moments, self.result.rows, axis=2)
        return self.of_moments(in_si, written)

    @cached_property
    def places(self) -> tuple[MotionPlaces, Bools]:
        """The rows where the loads balance; those that friction holds elsewhere are unknown."""
        result = self.result
        every, known = self.unknown(), result.row_states.reached & ~result.held
        rows = np.flatnonzero(known)
        time = self.of_text.time
        assert time is not None
        if not rows.size:
            return every, known
        still = DoubleDoubles(np.zeros((result.session.plan.columns, rows.size)))
        places = MotionPlaces(
            DoubleDoubles(time[0, rows], time[1, rows]),
            DoubleDoubles(result.row_states.states[:, rows]),
            still,
            still,
            np.ascontiguousarray(result.row_states.turns[:, rows]),
        )
        charts = self.charts[:, :, rows]
        stiffness = np.stack([result.stiffness(k) for k in rows.tolist()])
        size = np.full(rows.size, np.inf)
        for _ in range(tolerances.BALANCE_CORRECTIONS):
            closed, forces, good = self.motion.closed(places, charts)
            with np.errstate(all="ignore"):
                step = -eliminate(stiffness, forces.high.T).T
            before, size = size, np.where(good, np.max(np.abs(step), axis=0), np.nan)
            step = np.where(np.isfinite(step), step, 0.0)
            moved = DoubleDoubles(sum(charts[k] * step[k] for k in range(len(step))))
            states = closed.states + state_rates(result.session.layout, closed.states, moved)
            # steps that no longer shrink are rounding
            better = size < before
            places = closed._replace(
                states=DoubleDoubles(
                    np.where(better, states.high, places.states.high),
                    np.where(better, states.low, places.states.low),
                ),
                rates=still,
                accelerations=still,
            )
            if not (size > tolerances.REPEATED_BALANCE).any():
                break
        known[rows] = size <= tolerances.BALANCED_PLACE
        for part, new in zip(every[:4], places[:4], strict=True):
            part[..., rows] = new
        return every, known


class RepeatedEquilibria(RepeatedFree):
    """As `Repeated`, of equilibria."""

    wide: EquilibriumRows

    @property
    def lost_why(self) -> str:
        """Why rows are not repeated."""
        return "" if self.wide.known.all() else NO_STIFFNESS


NO_STIFFNESS = "the loads balance without a stiffness that tells where, or friction holds it there"


class RestRows(KernelRows):
    """The rows of a sweep at rest in double-double.

    Args:
        result: the sweep.
        unsolved: its session before the coordinates at rest were found, which is of the text.
    """

    def __init__(self, result: Result, unsolved: Session) -> None:
        super().__init__(result, unsolved.precise)
        rest = result.problem.motion.rest
        assert rest is not None
        self.unsolved, self.free = unsolved, list(rest.inputs)
        self.statics = Statics(result.session, self.free)

    @cached_property
    def of_text(self) -> PreciseInputs:
        """Inputs and time of the text, with the coordinates at rest where the loads balance."""
        return self._with(self._balanced[0])

    @property
    def known(self) -> Bools:
        """Rows that are repeated (rows,)."""
        return super().known & self._balanced[1]

    def _with(self, values: DoubleDoubles) -> PreciseInputs:
        """The text's, with values of the coordinates at rest (free, rows) in kernel units."""
        problem, inputs = self.result.problem, self.result.session.inputs
        text = self.precise.inputs(self.unsolved)
        every, reduced, written = text.values.copy(), text.reduced.copy(), dict(text.written)
        for k, number in enumerate(self.free):
            item, own = problem.motion.inputs[number], values[k]
            whole = inputs.whole[number]
            within: Any = own - whole * DoubleDoubles.of_fraction(2 * PI) if whole.any() else own
            unit, dimension = input_unit(self.result.session.layout, item), item.coordinate
            factor = problem.units.unit(dimension_of(dimension)).factor
            in_file: Any = own * unit / DoubleDoubles.of_fraction(factor)
            every[number], reduced[number] = as_parts(own[None])[0], as_parts(within[None])[0]
            written[item.name] = as_parts(in_file[None])[0]
        return text._replace(
            values=every,
            rates=np.zeros_like(text.rates),
            accelerations=np.zeros_like(text.accelerations),
            jerks=np.zeros_like(text.jerks),
            reduced=reduced,
            whole=inputs.whole,
            written=written,
        )

    @cached_property
    def _balanced(self) -> tuple[DoubleDoubles, Bools]:
        """The coordinates at rest (free, rows), and in which rows they are known."""
        session, rows = self.result.session, self.result.row_states
        values = DoubleDoubles(session.inputs.values[self.free].copy())
        known = rows.reached.copy()
        at = np.flatnonzero(known)
        if not at.size:
            return values, known
        stiffness = np.stack([self._stiffness(k) for k in at.tolist()])
        readout = self.statics.readout
        slots = [readout.slots[quantity.name].start for quantity in readout.wanted]
        numbers = PreciseConstants(
            self._constants(session), self.precise.outputs(session, readout.wanted)
        )
        demand = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES
        size = np.full(at.size, np.inf)
        for _ in range(tolerances.BALANCE_CORRECTIONS):
            own = self._with(values)
            parts = own.values, own.rates, own.accelerations, own.jerks, own.reduced
            given = KernelInputs(*parts, own.whole).at(
                rows.states, rows.turns, own.time, own.constraint_rates
            )
            batch = session.run(given.at(at), Ask(demand, readout), numbers)
            assert batch.outputs is not None
            forces = as_number(batch.outputs[slots]).high * self.statics.units[:, None]
            with np.errstate(all="ignore"):
                step = -eliminate(stiffness, forces.T).T
            before, size = size, np.where(batch.good, np.max(np.abs(step), axis=0), np.nan)
            better = size < before
            step = np.where(np.isfinite(step) & better, step, 0.0)
            for k in range(len(self.free)):
                values[k, at] = values[k, at] + step[k]
            if not (size > tolerances.REPEATED_BALANCE).any():
                break
        known[at] = size <= tolerances.BALANCED_PLACE
        return values, known

    def _stiffness(self, row: int) -> Floats:
        """The slopes (free, free) of the forces by the coordinates at rest in a row, in doubles."""
        rows, time = self.result.row_states, self.result.problem.motion.time
        moment = 0.0 if time is None else float(time.values[row])
        inputs = self.result.session.inputs.values[:, row]
        found = self.statics.slopes(Place(inputs, rows.states[:, row], rows.turns[:, row]), moment)
        count = self.statics.count
        return np.full((count, count), np.nan) if found is None else found[1]
