"""One position at a time: `Model.solve`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis import input_values
from mechkin_cli.arguments import Setting
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.expressions import Vector
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import DERIVED_KINDS
from mechkin_cli.memo import remembered
from mechkin_cli.plan import REACTION_KINDS, Demand, demand_of
from mechkin_cli.record import replace
from mechkin_cli.session import (
    angle_slots,
    held_values,
    input_unit,
    reduce_angle,
    step_limits,
    turn_of,
)
from mechkin_cli.show import Listing
from mechkin_cli.sweep import analyze, closed_rows
from mechkin_cli.units import ANGLE
from mechkin_cli.verdict import Status, rates_are_clear

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis import Design
    from mechkin_cli.mechanism import MotionInputs, Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Result


Cell = "float | NDArray[np.float64]"


class Position(dict[str, "float | NDArray[np.float64]"]):
    """Quantities by name in the file's units, vectors as arrays (3,), of a plane (2,); nan without
    a solution.

    Attributes:
        status: the verdict, as of a row: `ok`; `near-singular` or `dead-centre` close to a place
            where rates grow without bound; `beyond-limit`; `branch-lost` where the branch does not
            lead to the inputs.
    """

    __slots__ = ("status",)

    def __init__(self, values: Mapping[str, float | NDArray[np.float64]], status: str) -> None:
        super().__init__(values)
        self.status = status

    @property
    def listing(self) -> Listing:
        """Names and values, and the verdict."""
        rows = tuple((name, np.array2string(np.asarray(v))) for name, v in self.items())
        return Listing(f"Position: {self.status}", ("quantity", "value"), rows)

    def __repr__(self) -> str:
        return self.listing.text()

    def _repr_html_(self) -> str:
        return self.listing.html()


class Solver:
    """Positions of a design, each continued from the nearest row of its sweep."""

    def __init__(self, design: Design, names: tuple[str, ...]) -> None:
        problem = design.problem
        wanted = _wanted(design, names)
        result = analyze(design.session, [q.name for q in wanted])
        known = problem.quantities()
        session = result.session
        units = problem.units
        readout = session.readout(wanted)
        # where the kernel tells what users see of a quantity: name, slots, conversion
        self.columns = [
            (
                q.name,
                tuple(readout.slots[q.name].start + place for place in q.places),
                units.conversion(q.dimension),
            )
            for q in wanted
        ]
        self.inputs = [item.name for item in problem.motion.inputs]
        self.following = {item.name for item in problem.motion.inputs if item.follows}
        self.first = [float(item.written[0]) for item in problem.motion.inputs]
        self.to_kernel = [
            (units.conversion(known[item.name].dimension), unit, turn_of(problem, item))
            for item, unit in zip(
                problem.motion.inputs,
                [input_unit(session.layout, item) for item in problem.motion.inputs],
                strict=True,
            )
        ]
        self.held = held_values(problem, session.layout)
        self.problem, self.wanted, self.result = problem, wanted, result
        self.starts = _starts(result)
        self.native = _native(result, session, readout.outputs, wanted, readout.slots, self.starts)

    def solve(self, inputs: Setting | Mapping[str, Setting]) -> Position:
        """The position at some inputs."""
        places = dict(zip(self.inputs, self.first, strict=True))
        given = _plain(inputs, places) or input_values(self.problem, inputs)
        if self.following:
            self._check_following(given)
        places.update(given)
        values, whole, full = [], [], []
        for name, (conversion, unit, turn) in zip(self.inputs, self.to_kernel, strict=True):
            rest, turns = (places[name], 0.0) if turn is None else reduce_angle(places[name], turn)
            values.append(conversion.apply(rest) / unit)
            whole.append(turns)
            full.append(conversion.apply(places[name]) / unit)
        values += self.held
        whole += [0.0] * len(self.held)
        full += self.held
        found = None if self.native is None else self.native.solve(values, whole, full)
        if found is None or self.problem.limits or not rates_are_clear(found[1]):
            return self._judged(places, values)
        outputs = found[0]
        cells: dict[str, float | NDArray[np.float64]] = {}
        for name, slots, conversion in self.columns:
            if len(slots) == 1:
                cells[name] = conversion.reverse(outputs[slots[0]])
            else:
                cells[name] = conversion.reverse(np.array([outputs[slot] for slot in slots]))
        return Position(cells, "ok")

    def _judged(self, places: Mapping[str, float], values: Sequence[float]) -> Position:
        """The position where it is near a singular one, or is not reached at once."""
        if not self.starts.size:
            return Position(self._nothing(), Status.branch_lost.label)

        known = self.result.session.inputs
        away = np.abs(known.reduced[:, self.starts] - np.array(values)[:, None]).max(axis=0)
        # what is infinite at a dead centre shows from a distance
        far = away > tolerances.BEFORE_DEAD_CENTRE[0]
        row = int(self.starts[np.where(far, away, away + 2.0 * pi).argmin()])
        given = np.array([places[name] for name in self.inputs])
        status, found = judged_position(self.result, row, given, self.wanted)
        cells = self._nothing()
        for (name, slots, conversion), parts in zip(self.columns, found, strict=False):
            told = conversion.reverse(parts)
            cells[name] = told if len(slots) > 1 else float(told[0])
        return Position(cells, status.label)

    def _check_following(self, given: Mapping[str, float]) -> None:
        """Refuses to leave an input at its first row whose law makes it follow one that moves."""
        missing = sorted(self.following - given.keys())
        if missing:
            raise UsageError(
                f"{', '.join(missing)} follows other inputs by its law, which solve does not "
                "evaluate; give its value, too, or use analyze"
            )

    def _nothing(self) -> dict[str, float | NDArray[np.float64]]:
        """The cells of a position that was not reached."""
        return {
            name: np.nan if len(slots) == 1 else np.full(len(slots), np.nan)
            for name, slots, _ in self.columns
        }


def _plain(inputs: object, known: Mapping[str, float]) -> dict[str, float] | None:
    """Numbers of known inputs, not too large; None for what has to be looked at more closely."""
    if type(inputs) is not dict:
        return None
    for name, value in inputs.items():
        if name not in known or type(value) is not float:
            return None
        if not abs(value) <= tolerances.LARGEST_TURNS:
            return None
    return inputs


def _wanted(design: Design, names: tuple[str, ...]) -> list[Wanted]:
    problem = design.problem
    known = problem.quantities()
    found = []
    for name in names:
        if name not in known:
            hint = problem.why_not(name) or nearest_hint(name, problem.told_quantities)
            hint = hint or "quantities are names such as J.theta; analyze takes expressions"
            raise UsageError(f"there is no quantity {name[:LONGEST_NAME]}; {hint}")
        quantity = known[name]
        forces = demand_of(problem.mechanism, [quantity]) & Demand.FORCES
        unsure = quantity.kind in REACTION_KINDS and design.session.is_redundant
        if quantity.owner == "row" or quantity.kind in DERIVED_KINDS or unsure:
            raise UsageError(f"solve does not give {name}; analyze does, at the rows of the file")
        if forces and any("time" in law.reads for law in problem.load_laws):
            raise UsageError(f"{name} depends on a load that varies with time; analyze gives it")
        if forces and problem.motion.constraints:
            text = "depends on the rates of inputs that others drive (drive: tie)"
            raise UsageError(f"{name} {text}, which solve does not evaluate; analyze gives it")
        found.append(quantity)
    return found


def _starts(result: Result) -> NDArray[np.intp]:
    """The rows to continue from. From those at a dead centre two branches lead on, so they serve
    only where there are no others."""
    sure = np.flatnonzero(result.status == Status.ok)
    return sure if sure.size else np.flatnonzero(result.solved)


def _native(
    result: Result,
    session: Session,
    outputs: _kernel.Outputs,
    wanted: list[Wanted],
    readout_slots: Mapping[str, slice],
    solved: NDArray[np.intp],
) -> _kernel.Positions | None:
    """The kernel's rows to start from; None where no row has a solution."""
    if not solved.size:
        return None
    plan, inputs = session.plan, session.inputs
    angles = angle_slots(session, readout_slots)
    turns = np.ascontiguousarray(result.row_states.turns[:, solved])

    def rows(table: Floats) -> Floats:
        return np.ascontiguousarray(table[:, solved])

    return _kernel.Positions(
        plan=plan,
        outputs=outputs,
        inputs=rows(inputs.reduced),
        whole=rows(inputs.whole),
        rates=rows(inputs.rates),
        accelerations=rows(inputs.accelerations),
        jerks=rows(inputs.jerks),
        states=rows(result.row_states.states),
        turns=turns,
        demand=int(demand_of(session.problem.mechanism, wanted) | _judging(session)),
        iterations=tolerances.NEWTON_ITERATIONS,
        limits=step_limits(straight=session.problem.assembly.straight),
        angles=angles,
    )


def _judging(session: Session) -> Demand:
    """What tells whether a position is near a singular one: loops alone have such."""
    return Demand.CONDITION if session.graph.blocks else Demand.POSITION


@remembered
def solver_of(design: Design, quantities: tuple[str, ...] | None) -> Solver:
    """The solver of some quantities; of all joint coordinates if None."""
    names = design.problem.mechanism.coordinates if quantities is None else quantities
    return Solver(design, names)


# One position near a singular one: a row behind the one that it is continued from, so that it gets
# its verdict, and what is infinite there, as rows of a sweep do.


def judged_position(
    result: Result, row: int, places: Floats, wanted: Sequence[Wanted]
) -> tuple[Status, list[Floats]]:
    """The verdict and the quantities at some inputs.

    Args:
        result: the sweep.
        row: the one that the position is continued from, its rates are taken.
        places: (inputs,) in the file's units.
        wanted: quantities.

    Returns:
        The verdict, and the numbers (parts,) of each quantity in SI, none without a position.
    """
    motion = _pair(result, row, places)
    session = result.session.moved(replace(result.problem, motion=motion))
    state = np.ascontiguousarray(result.row_states.states[:, row])
    found = closed_rows(session, replace(result.start, state=state, row=0), wanted, verdicts=True)
    status = Status(int(found.status[1]))
    cells = [_cells(result, row, found, q) for q in wanted] if status.has_solution else []
    return status, cells


def _pair(result: Result, row: int, places: Floats) -> MotionInputs:
    """The row and the place as a motion of two rows."""
    motion, units = result.problem.motion, result.problem.units
    inputs = []
    for item, place in zip(motion.inputs, places, strict=True):
        orders = np.repeat(item.written_orders[:, [row]], 2, axis=1)
        orders[0, 1] = place
        dimension = result.problem.quantities()[item.name].dimension
        inputs.append(
            item._replace(
                values=units.to_si(orders[0].copy(), dimension),
                rates=np.repeat(item.rates[row], 2),
                accelerations=np.repeat(item.accelerations[row], 2),
                jerks=np.repeat(item.jerks[row], 2),
                written_orders=orders,
            )
        )
    rates = motion.constraint_rates
    rates = None if rates is None else np.repeat(rates[:, [row]], 2, axis=1)
    return motion._replace(
        inputs=tuple(inputs), rows=2, time=None, course=None, constraint_rates=rates, grid=None
    )


def _cells(result: Result, row: int, found: Result, wanted: Wanted) -> Floats:
    """A quantity at the second row; angles go on from those of the sweep, whose turns are counted
    from its own first row."""
    parts = _parts(found, wanted, 1)
    if wanted.kind == "coordinate" and wanted.order == 0 and wanted.dimension == ANGLE:
        apart = _parts(result, wanted, row) - _parts(found, wanted, 0)
        parts = parts + 2.0 * pi * np.rint(apart / (2.0 * pi))
    return parts


def _parts(result: Result, wanted: Wanted, row: int) -> Floats:
    value = result.quantity(wanted.name).value
    parts = value.components if isinstance(value, Vector) else (value,)
    return np.array([np.broadcast_to(part, result.rows)[row] for part in parts])
