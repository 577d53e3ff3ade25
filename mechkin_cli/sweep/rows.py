"""The rows of a sweep: states, what is known of each row, and continuous angles.

The kernel gives angles within a turn; following the branch counts whole turns
(`Structure.closing_slots`, `tree_slots`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import proofs, tolerances
from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism import (
    REACTION_LEVEL,
    Problem,
    Span,
    coordinate_quantities,
    is_angle,
)
from mechkin_cli.memo import remembered
from mechkin_cli.record import dataclass, field
from mechkin_cli.row_notes import RowSet
from mechkin_cli.session import Ask, Batch, KernelInputs, continuous_angle
from mechkin_cli.structure import SolverGraph
from mechkin_cli.units import FORCE
from mechkin_cli.verdict import Status, are

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import PlacesBefore
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.row_notes import Note
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
        span: where the rows lie in the run that they are a part of.
        dead_centres: rows that stand at one, twice where either of two branches may be meant.
        signs: (rows,) of the quaternion of each spherical joint, as far as it was read.
        signs_before: those of the first row where it goes on from others.
        arrivals: of a grid the rows at which the lines on either side of the start were come to
            last: those from which the lines before the first and behind the last one go on.
    """

    states: Floats
    limit: Floats
    reached: Bools
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Note]
    numbers: NDArray[np.int64]
    turns: Floats
    section: NDArray[np.int64]
    ends: list[tuple[int, Ending]]
    span: Span
    dead_centres: list[PlacesBefore] = field(default_factory=list)
    signs: dict[str, Floats] = field(default_factory=dict)
    signs_before: Mapping[str, float] = field(default_factory=dict)
    arrivals: tuple[int, int] = (0, 0)

    @classmethod
    def without_guesses(
        cls, states: int, turns: int, rows: int, span: Span | None = None
    ) -> SweepRows:
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
            span=span or Span(0, rows, rows),
        )

    @classmethod
    def followed(cls, found: Followed, span: Span | None = None) -> SweepRows:
        """The rows of one way from the first, whose arrays become theirs."""
        count = found.limit.size
        turns = np.empty((0, count)) if found.turns is None else found.turns
        numbers = np.arange(count)
        return cls(
            states=found.guess,
            limit=found.limit,
            reached=numbers < found.reached,
            status=np.zeros(count, dtype=np.int8),
            nodes=found.steps,
            diagnostics=[],
            numbers=numbers,
            turns=turns,
            section=sections(found, count),
            ends=[],
            span=span or Span(0, count, count),
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
        return SweepRows(*arrays, *more, self.section[rows], self.ends, self.span)

    def named(self, rows: Sequence[int] | NDArray[np.intp] | Bools) -> str:
        """Some of the rows, by their numbers or by which of them, as messages name them."""
        found = np.asarray(rows)
        if found.dtype == np.bool_:
            found = np.flatnonzero(found)
        return str(RowSet.of(found + self.span.first))

    @property
    def has_failed(self) -> bool:
        """Whether some row did not close."""
        return bool(np.count_nonzero(are(self.status, Status.not_converged)) > 0)


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
    is_whole = np.count_nonzero(reached) == reached.size
    for _, output, number in driven:
        values = result.problem.motion.inputs[number].values
        if is_whole:
            outputs[output] = values
        else:
            np.copyto(outputs[output], values, where=reached)
    rests: Columns = {}
    for angles in (tree, closing):
        for name, slot, counter in angles:
            turns = rows.turns[counter]
            if angles is tree and not np.count_nonzero(turns):
                # of long runs most parts have none; as with turns no zero has a sign
                outputs[slot] += 0.0
                continue
            rest = outputs[slot].copy()
            if angles is closing:
                outputs[slot] = continuous_angle(rest, turns)
            else:
                outputs[slot] += turns * (2.0 * pi)
            if np.count_nonzero((outputs[slot] != rest) & reached):
                rests[name] = rest
    return rests


@remembered
def _angles(session: Session, wanted: tuple[Wanted, ...]) -> tuple[Angles, Angles, Angles]:
    """The angles of inputs, with the inputs' numbers; of the tree; of cut joints."""
    driven, tree, closing = Angles(), Angles(), Angles()
    layout, slots = session.layout, session.readout(wanted).slots
    inputs = {item.name: number for number, item in enumerate(session.problem.motion.inputs)}
    for quantity in filter(has_turns, wanted):
        name, output = quantity.name, slots[quantity.name].start
        turn = session.structure.turn_slot(quantity)
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
    """A reaction (numbers, rows) whose numbers are `off` by rounding (rows,); `length` in m."""
    off = off if wanted.dimension == FORCE else off * length
    by = np.array(DISTURBANCES[number])[: len(columns), None]
    return np.asarray(columns + off * by)


# A bound of the errors of every row's position.


def error_bound(result: RunRows) -> Floats:
    """How far states and coordinates of each row can be from the file's position (rows,): in rad,
    and slides in parts of the mechanism's length unit (the power of two next to the size of its
    drawing).

    It is proven, in intervals over a box that holds exactly one position (`proofs`). A loop with
    more equations than unknowns that, by the file's numbers, does not close exactly has no exact
    position: there it holds for any at which the equations are as small as where those solved for
    are zero, of which the least square is one.

    nan in rows without a position, and where none is proven; at a dead centre, where doubles do
    not tell which of two positions is meant; and where numbers cannot be followed to the text.
    """
    rows = result.row_states
    there = rows.reached & result.solved & (result.status != Status.dead_centre)
    if not there.any():
        return np.full(result.rows, np.nan)
    known = result.problem.quantities()
    wanted = [q for q in coordinate_quantities(result.problem.mechanism) if q.name in known]
    result.read(wanted)
    values = {q: np.asarray(result.quantity(q.name).value) for q in wanted}
    with np.errstate(all="ignore"):
        bound, beyond = proofs.position_bounds(
            result.session, rows.states, there, values, rows.turns
        )
        open_ = beyond > 0.0
        if (open_ & there).any():
            condition = np.asarray(result.quantity("row.condition").value)
            equations = max(block.equations for block in result.graph.blocks)
            apart = tolerances.APART_BY_CLOSURE * condition * np.sqrt(equations) * beyond
            bound = np.where(open_, bound + apart, bound)
    return np.where(np.isfinite(bound), bound, np.nan)
