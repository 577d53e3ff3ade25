"""The rows of a sweep: states, what is known of each row, and continuous angles.

The kernel gives angles within a turn; following the branch counts whole turns
(`session.turn_slots`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import ldexp, pi
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism import REACTION_LEVEL, Problem, is_angle
from mechkin_cli.memo import remembered
from mechkin_cli.plan import PLACING, flatten, plan_records
from mechkin_cli.record import dataclass, field
from mechkin_cli.session import POSITIONS, Ask, Batch, KernelInputs, continuous_angle
from mechkin_cli.structure import SolverGraph
from mechkin_cli.units import FORCE
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import PlacesBefore
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.kernel.functions import RandomStarts
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import Ending, Followed, Session
    from mechkin_cli.show import Bools, Floats


def sections(followed: Followed, rows: int) -> NDArray[np.int64]:
    """The number of branch points that a way passed before each row (rows,)."""
    if not followed.crossings:
        return np.zeros(rows, dtype=np.int64)
    passed = [row for row, _ in followed.crossings]
    return np.searchsorted(np.sort(np.array(passed)), np.arange(rows), side="right")


@dataclass
class SweepRows:
    """The rows of a sweep while they are followed, closed and judged.

    Attributes:
        states: (states, rows), guesses until they are closed.
        limit: (rows,) the largest correction that a guess may still need.
        nodes: steps with which the rows were followed.
        numbers: (rows,) counts them from 0 as the file does.
        turns: (turn slots, rows) angles and quaternions of cut joints as following carried
            them along.
        section: (rows,) differs between rows between which a branch point was passed.
        ends: the dead centres beyond which rows are missing, each behind the last row before it.
        dead_centres: rows that stand at one, twice where either of two branches may be meant.
    """

    states: Floats
    limit: Floats
    reached: Bools
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Diagnostic]
    numbers: NDArray[np.int64]
    turns: Floats
    section: NDArray[np.int64]
    ends: list[tuple[int, Ending]]
    dead_centres: list[PlacesBefore] = field(default_factory=list)

    @classmethod
    def without_guesses(cls, states: int, turns: int, rows: int) -> SweepRows:
        """Rows of which nothing is known yet; none is reached."""
        return cls(
            states=np.zeros((states, rows)),
            limit=np.zeros(rows),
            reached=np.zeros(rows, dtype=bool),
            status=np.full(rows, int(Status.ok), dtype=np.int8),
            nodes=0,
            diagnostics=[],
            numbers=np.arange(rows),
            turns=np.full((turns, rows), np.nan),
            section=np.zeros(rows, dtype=np.int64),
            ends=[],
        )

    @classmethod
    def followed(cls, found: Followed) -> SweepRows:
        """The rows of one way from the first, whose arrays become theirs."""
        count = found.limit.size
        turns = np.empty((0, count)) if found.turns is None else found.turns
        return cls(
            states=found.guess,
            limit=found.limit,
            reached=np.arange(count) < found.reached,
            status=np.zeros(count, dtype=np.int8),
            nodes=found.steps,
            diagnostics=[],
            numbers=np.arange(count),
            turns=turns,
            section=sections(found, count),
            ends=[],
        )

    def take(self, found: Followed, first: int) -> None:
        """Takes what a way found from its row `first` on."""
        known = slice(first, found.reached)
        self.states[:, first:] = found.guess[:, first:]
        self.limit[first:] = found.limit[first:]
        if found.turns is not None:
            self.turns[:, known] = found.turns[:, known]
        self.reached[first:] = np.arange(first, self.reached.size) < found.reached
        self.section[first:] = sections(found, self.reached.size)[first:]

    def part(self, rows: slice) -> SweepRows:
        """Some of the rows, in the slice's order: views of the same arrays."""
        arrays = (self.states[:, rows], self.limit[rows], self.reached[rows], self.status[rows])
        more = (self.nodes, self.diagnostics, self.numbers[rows], self.turns[:, rows])
        return SweepRows(*arrays, *more, self.section[rows], self.ends)

    @property
    def has_failed(self) -> bool:
        """Whether some row did not close."""
        return bool((self.status == Status.not_converged).any())


class RunRows(Protocol):
    """What is read of a run of rows; `Result` is one."""

    row_states: SweepRows
    residual: Floats
    shifts: tuple[int, ...]

    @property
    def session(self) -> Session:
        """The part of the mechanism that was followed."""

    @property
    def problem(self) -> Problem:
        """Mechanism, motion and assembly of that part."""

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks."""

    @property
    def rows(self) -> int:
        """Number of rows asked for."""

    @property
    def status(self) -> NDArray[np.int8]:
        """Verdict of every row, codes of `Status` (rows,)."""

    @property
    def solved(self) -> Bools:
        """Rows that have a position (rows,)."""

    @property
    def sound(self) -> bool:
        """Whether every row is `ok`."""

    @property
    def power_error(self) -> Floats:
        """|sum of powers| / sum of |powers| of every row (rows,)."""

    @property
    def columns(self) -> Mapping[str, Floats]:
        """What has been read."""

    @property
    def alternatives(self) -> Sequence[RunRows]:
        """The same rows with other reactions in equilibrium."""

    @property
    def disturbed(self) -> Sequence[RunRows]:
        """The same rows with reactions off by their rounding."""

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by name, in SI."""

    def read(self, wanted: Iterable[Wanted]) -> None:
        """Evaluates the quantities that have not been read yet."""

    def evaluated(self, wanted: Sequence[Wanted], *, shift: int = 0) -> Columns:
        """Quantities on the stored states, not kept, with the reactions of a `shift`."""

    def run(
        self, ask: Ask, *, session: Session | None = None, inputs: KernelInputs | None = None
    ) -> Batch:
        """One call of the kernel over all rows on their states."""


Columns = dict[str, "Floats"]
"""Quantities by name: (1, rows), vectors (3, rows); SI, nan where a row has none."""


Angles = list[tuple[str, int, int]]
"""Names of angles, their outputs, and the rows of `SweepRows.turns` that count their turns."""


def make_continuous(result: RunRows, wanted: Sequence[Wanted], outputs: Floats) -> Columns:
    """Makes the angles among some outputs (outputs, rows) continuous from the first row, in place.

    Returns:
        What they are within a turn, of those that have turns.
    """
    rows, session = result.row_states, result.session
    driven, tree, closing = _angles(session, tuple(wanted))
    reached = rows.reached
    for _, output, number in driven:
        values = result.problem.motion.inputs[number].values
        outputs[output] = np.where(reached, values, outputs[output])
    rests: Columns = {}
    for angles in (tree, closing):
        if not angles:
            continue
        names, slots, counters = map(list, zip(*angles, strict=True))
        rest, turns = outputs[slots], rows.turns[counters]
        if angles is closing:
            continuous = continuous_angle(rest, turns)
        else:
            continuous = rest + turns * (2.0 * pi)
        outputs[slots] = continuous
        turned = ((continuous != rest) & reached).any(axis=1)
        rests |= {names[k]: rest[k] for k in np.flatnonzero(turned)}
    return rests


@remembered
def _angles(session: Session, wanted: tuple[Wanted, ...]) -> tuple[Angles, Angles, Angles]:
    """The angles of inputs, with the inputs' numbers; of the tree; of cut joints."""
    driven, tree, closing = Angles(), Angles(), Angles()
    layout, slots = session.layout, session.readout(wanted).slots
    inputs = {item.name: number for number, item in enumerate(session.problem.motion.inputs)}
    for quantity in filter(has_turns, wanted):
        name, output = quantity.name, slots[quantity.name].start
        turn = session.turn_slots.of_angle(layout, quantity)
        if name in inputs:
            driven.append((name, output, inputs[name]))
        elif turn is not None:
            angles = closing if layout.joint_reference[quantity.owner] < 0 else tree
            angles.append((name, output, turn))
    return driven, tree, closing


def has_turns(quantity: Wanted) -> bool:
    """Whether a quantity is an angle, which may have whole turns."""
    return quantity.kind == "coordinate" and is_angle(quantity.coordinate) and quantity.order == 0


# What reactions may be besides those of least norm: others in equilibrium, and those that are off
# by rounding. Where constraints are redundant, a cell is unique if it changes no more with the
# former than with the latter (`tables.unique_cells`).

SHIFTS = (1, 2)
"""Parts of the null space by which other reactions in equilibrium differ, where constraints are
redundant. Two: one alone may leave a cell unchanged by chance."""

DISTURBANCES = ((1.0, 0.829, -0.617), (-0.731, 1.0, 0.517))
"""Parts of a rounding by which components of reactions are off at once: two, of which one alone may
leave an expression unchanged by chance."""


def reaction_rounding(result: RunRows) -> Floats:
    """Rounding of reactions in each row (rows,): of forces in N, of moments in N by the length
    unit.

    It goes with the largest reaction of the run. A row without any load has none but those of the
    null space, whose rounding decides what is zero.
    """
    level = _level(result, 0)
    largest = float(np.max(level[np.isfinite(level)], initial=0.0))
    rounding = np.full(level.shape, largest)
    for shift in result.shifts if (level == 0.0).any() else ():
        rounding[level == 0.0] = np.fmax(rounding, _level(result, shift))[level == 0.0]
    return np.asarray(tolerances.REACTION_ROUNDING * rounding, dtype=np.float64)


def _level(result: RunRows, shift: int) -> Floats:
    """The largest reaction of each row (rows,), of those of a `shift`."""
    return np.asarray(result.evaluated([REACTION_LEVEL], shift=shift)[REACTION_LEVEL.name][0])


def disturbed(columns: Floats, wanted: Wanted, off: Floats, length: float, number: int) -> Floats:
    """A reaction (3, rows) whose components are `off` by rounding (rows,); `length` unit in m."""
    off = off if wanted.dimension == FORCE else off * length
    return np.asarray(columns + off * np.array(DISTURBANCES[number])[:, None])


# A bound of the rounding errors of every row's states, without numbers more precise than doubles.
#
# What rounding leaves is, seen backwards, the exact row of a mechanism whose constants and inputs
# are off by a few roundings. How far such changes move a row is measured: the row is closed again
# for constants and inputs off by random parts of `ERROR_PROBE`, `ERROR_PROBES` times, which takes
# blocks that hang on each other along as they are (small-sample statistical condition estimation,
# C. Kenney and A. Laub, SIAM J. Sci. Comput. 15, 1994, section 3: of three samples the largest is a
# tenth of the true size or less once in a thousand times). The bound is
#
#     ERROR_FACTOR u (|x| + largest |move| / ERROR_PROBE) + condition residual,    u = 2^-53,
#
# the largest over the states x of a row: angles in rad, slides in parts of the mechanism's length
# unit (the power of two next to the size of its drawing), components of unit quaternions.

_ROUNDING = ldexp(1.0, -53)


def error_bound(result: RunRows) -> Floats:
    """The bound (rows,); nan in rows without a position, and where none is known."""
    rows = result.row_states
    if not rows.reached.any():
        return np.full(result.rows, np.nan)
    with np.errstate(all="ignore"):
        moved = largest_move(result) / tolerances.ERROR_PROBE
        states = np.abs(rows.states) if rows.states.size else np.zeros((1, result.rows))
        sizes = np.maximum(np.max(states, axis=0), 1.0)
        bound = tolerances.ERROR_FACTOR * _ROUNDING * (sizes + moved)
        if result.graph.blocks:
            condition = np.asarray(result.quantity("row.condition").value)
            bound = bound + condition * result.residual
    return np.where(rows.reached & np.isfinite(bound), bound, np.nan)


def largest_move(result: RunRows) -> Floats:
    """The largest move of any state (rows,) in some runs with constants and inputs slightly off;
    nan where one of them did not close."""
    from mechkin_cli.kernel.functions import RandomStarts

    session, rows = result.session, result.row_states
    stream = RandomStarts()
    largest = np.zeros(result.rows)
    if not rows.states.size:
        return largest
    sizes = _input_sizes(session)
    constants, placing = _constants(session)
    for _ in range(tolerances.ERROR_PROBES):
        off = constants.copy()
        count = int(np.count_nonzero(placing))
        off[placing] *= 1.0 + _signed(stream, count) * tolerances.ERROR_PROBE
        other = session.with_constants(off)
        inputs = session.inputs
        shift = _signed(stream, len(sizes))[:, None] * tolerances.ERROR_PROBE * sizes
        batch = result.run(
            POSITIONS, session=other, inputs=inputs._replace(reduced=inputs.reduced + shift)
        )
        move = np.max(np.abs(batch.states - rows.states), axis=0)
        # of a row far from its place the move says nothing
        largest = np.where(move <= tolerances.ERROR_MOVE, np.fmax(largest, move), np.nan)
    return largest


def _input_sizes(session: Session) -> Floats:
    """By what each input is rounded in every row (inputs, rows), in parts of u: by its size with
    its whole turns, unless it is a whole number in the file's unit that no law gave."""
    motion, inputs = session.problem.motion, session.inputs
    sizes = np.abs(inputs.reduced)
    for number, item in enumerate(motion.inputs):
        rounded = (item.written != np.rint(item.written)) | (motion.time is not None)
        full = np.maximum(np.abs(inputs.values[number]), sizes[number])
        sizes[number] = np.where(rounded, full, sizes[number])
    return sizes


def _constants(session: Session) -> tuple[Floats, NDArray[np.bool_]]:
    """The plan's constants, and which of them place links: masses, loads and what else no position
    reads must not change a random number."""
    records = plan_records(session.layout)
    placing = [record[0] in PLACING for record in records for _ in flatten([record])]
    return np.array(flatten(records), dtype=np.float64), np.array(placing, dtype=np.bool_)


def _signed(stream: RandomStarts, count: int) -> Floats:
    """Uniform in [-1, 1)."""
    return 2.0 * stream.fractions(count) - 1.0
