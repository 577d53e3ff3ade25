"""A session: one problem's structure in the kernel, its inputs, and its verbs.

Everything that is computed about a mechanism goes through three verbs: *close*, *follow* and *run*;
the room `search` finds all assemblies by them. A session is a frozen value: other rows, another
first assembly, size or packing make another session, by `replace`. What follows from it is
remembered with it, by the arguments of the question (`memo.remembered`); only a `Structure` is
shared between sessions, and it knows nothing of rows or of the first assembly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import LongRun
from mechkin_cli.memo import Memo, remembered
from mechkin_cli.plan import Demand, Layout, PassageEnd, Readout
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.session.assembled_places import Coordinate, Structure, solver_graph
from mechkin_cli.session.following import (
    Ending,
    Followed,
    Runaway,
    find_runaway,
    follow as follow_path,
    follow_way as follow_along,
    step_limits,
)
from mechkin_cli.session.inputs import (
    KernelInputs,
    input_unit,
    kernel_inputs,
    turned_quaternion,
)
from mechkin_cli.session.kernel_run import (
    POSITIONS,
    Ask,
    Batch,
    PreciseConstants,
    RowInputs,
    run as run_kernel,
)
from mechkin_cli.structure import SolverGraph, exchanged, is_redundant, structure_of
from mechkin_cli.tolerances import FREE_INPUT_MISS, FREE_INPUT_STEP, STOPPED_MISS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Assembly, Attached, Problem, Wanted
    from mechkin_cli.session.double_double import Precise
    from mechkin_cli.session.path import FollowedPath, Route
    from mechkin_cli.show import Floats


class Packing(NamedTuple):
    """How the kernel packs rows: `lanes` at a time (0: the most that the machine has) on `threads`
    (0: all cores, for work worth it). No result depends on either."""

    lanes: int = 0
    threads: int = 0


class Continued(NamedTuple):
    """A first assembly that is not to be chosen: continued from that of another variant. Without
    states (states,) the branch was lost on the way; `row` is the one where it stands, and `turns`
    (turn slots,) are those of angles there, where they are known. `chosen` is the assembly (an
    `AssemblyStart`) of which it is another place of the same branch, whose words it takes."""

    state: Floats | None
    row: int
    turns: Floats | None = None
    chosen: Any = None


class Between:
    """What lies between a base (0) and the session that continues it (1).

    Args:
        session: at a place.
    """

    def __init__(self, session: Callable[[float], Session]) -> None:
        self.session = session

    def plan(self, place: float, structure: object, length: float) -> Plan:
        """The plan at a place, of a structure (`structure_of`) and in a length unit (m).

        Raises:
            MechkinError: the file has an error there, or is solved in another way.
        """
        there = self.session(place)
        if structure_of(there.graph) != structure:
            raise MechkinError("another structure on the way")
        return there.measured_in(length).structure.plan

    def derived(self, make: Callable[[Session], Problem]) -> Between:
        """What lies between sessions that follow from these, as `Session.derived`."""
        return Between(lambda place: self.session(place).derived(make))


@dataclass(frozen=True, eq=False)
class Session:
    """A problem in the kernel; `Session.of` makes one.

    Attributes:
        problem: mechanism, motion and assembly.
        structure: the mechanism in the kernel.
        first: the first assembly; None: it is brought from that of `base`, or chosen as
            `problem.assembly` says (home, near or mode).
        base: the session of the file's own parameters from whose first assembly this one's is
            brought, and those between.
        size: residual and condition are in parts of it (m); None: of the drawing's.
        packing: how rows are packed.
        text: gives the numbers as the file says them, where the problem is that of a file.
        constants: of the plan, where they are not those of the structure.
        own_inputs: the inputs of all rows, where they are known.
    """

    problem: Problem
    structure: Structure
    first: Continued | None = None
    base: tuple[Session, Between] | None = None
    size: float | None = None
    packing: Packing = Packing()
    text: Callable[[], Precise] | None = None
    constants: Floats | None = None
    own_inputs: KernelInputs | None = None
    memo: Memo = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of(
        cls,
        problem: Problem,
        graph: SolverGraph | None = None,
        *,
        driven: Sequence[Coordinate] | None = None,
        closed_at: Sequence[str] | None = None,
        known: Structure | None = None,
        packing: Packing = Packing(),  # noqa: B008 - frozen
    ) -> Session:
        """The session of a problem.

        Args:
            problem: mechanism, motion and assembly.
            graph: its solver graph; None builds the best one.
            driven: the inputs, where they are not those of the problem's motion and what is locked.
            closed_at: cut joints to use instead of the best ones.
            known: a structure that was made before, which is taken where it is of this mechanism,
                graph and inputs, and no load varies.
            packing: how rows are packed.

        Raises:
            UnsolvableGraph: the mechanism cannot be solved as it is driven.
        """
        inputs = list(problem.driven if driven is None else driven)
        if known is not None and problem.laws is None and closed_at is None:
            of = known.layout
            is_same = of.mechanism is problem.laid_mechanism and of.graph is graph
            if is_same and of.laws is None and known.driven == tuple(inputs):
                return cls(problem, known, packing=packing)
        graph = graph or solver_graph(problem.solved_mechanism, inputs, closed_at)
        layout = Layout(problem.laid_mechanism, graph, laws=problem.laws)
        cuts = None if closed_at is None else tuple(closed_at)
        return cls(problem, Structure(layout, tuple(inputs), cuts), packing=packing)

    @property
    def layout(self) -> Layout:
        """How the mechanism lies in the kernel."""
        return self.structure.layout

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks."""
        return self.structure.layout.graph

    @property
    def driven(self) -> tuple[Coordinate, ...]:
        """The inputs (joint, coordinate), with what is locked."""
        return self.structure.driven

    @property
    def closed_at(self) -> tuple[str, ...] | None:
        """Cut joints that were asked for instead of the best ones."""
        return self.structure.closed_at

    @cached_property
    def plan(self) -> Plan:
        """The frozen plan; residual and condition in parts of `size` (m; None: the drawing's)."""
        plan = self.structure.plan
        if self.constants is not None:
            plan = plan.with_constants(self.constants)
        return plan if self.size is None else plan.with_size(self.size)

    @cached_property
    def inputs(self) -> KernelInputs:
        """The inputs of all rows of the problem's motion."""
        if self.own_inputs is not None:
            return self.own_inputs
        return kernel_inputs(self.problem, self.layout)

    @property
    def _known_inputs(self) -> KernelInputs | None:
        """The inputs, of a short run or where they have been asked for."""
        if isinstance(self.problem.motion, LongRun):
            return self.__dict__.get("inputs", self.own_inputs)
        return self.inputs

    @cached_property
    def route(self) -> Route | None:
        """The way along all rows; None where it goes straight from each to the next."""
        course = self.problem.motion.course
        if course is None:
            return None
        from mechkin_cli.session.path import Route

        units = [input_unit(self.layout, item) for item in self.problem.motion.inputs]
        return Route(course, self.inputs.values, np.array(units))

    @cached_property
    def constraint_rates(self) -> Floats | None:
        """Rates of inputs by those that lead them in kernel units (constraints, rows)."""
        drives, motion = self.layout.drives, self.problem.motion
        if drives is None or motion.constraint_rates is None:
            return None
        units = [input_unit(self.layout, item) for item in motion.inputs]
        factors = [units[c.leader] / units[c.input] for c in motion.constraints]
        rates: Floats = motion.constraint_rates * np.array(factors)[:, None]
        return rates

    def row_inputs(
        self, states: Floats, turned: Floats, inputs: KernelInputs | None = None
    ) -> RowInputs:
        """What a run is given for all rows on their states (states, rows) and turns (turn slots,
        rows); with other rates where `inputs` have them."""
        moments = self.problem.motion.time
        time = None if moments is None else moments.values
        return (inputs or self.inputs).at(states, turned, time, self.constraint_rates)

    @cached_property
    def is_redundant(self) -> bool:
        """Whether some loop has more closing equations than unknowns."""
        return is_redundant(self.graph)

    def reading(self, text: Callable[[], Precise]) -> Session:
        """This session with where its numbers are written."""
        return replace(self, text=text)

    @property
    def precise(self) -> Precise:
        """What gives this session's constants and inputs in double-double, as the file's text says
        them: `session.precise.constants(session)`.

        Raises:
            LookupError: the session is of no file.
            TraceLost: a number depends on the text in a way that no tape holds.
        """
        if self.text is None:
            raise LookupError("this session is of no file")
        return self.text()

    def loaded(self, problem: Problem) -> Session:
        """The session of a problem that differs only in masses and loads; the same states serve."""
        own = self.layout
        laid = Layout(problem.laid_mechanism, self.graph, own.length, laws=problem.laws)
        structure = Structure(laid, tuple(problem.driven), self.closed_at)
        # efforts that actuators share go by the size
        return Session(problem, structure, size=self.size, packing=self.packing, text=self.text)

    def moved_along(self, states: Floats, columns: Floats) -> Floats:
        """States (states, places) after increments of the columns (columns, places): those of balls
        are rotation vectors in the axes of the carrying frame (kernel/core/rows/advance.hpp)."""
        moved = np.array(states)
        for carrier in self.layout.carriers:
            kind, at, by = carrier.part.type, carrier.state, columns[carrier.column :]
            if kind.is_ball:
                moved[at : at + 4] = turned_quaternion(states[at : at + 4], by[:3])
            else:
                count = len(kind.freedoms)
                moved[at : at + count] = states[at : at + count] + by[:count]
        return moved

    def exchanged(self, graph: SolverGraph) -> Session:
        """The same mechanism with other inputs: those of a graph with the same edges."""
        own = self.layout
        laid = Layout(own.mechanism, graph, own.length, laws=own.laws)
        structure = Structure(laid, tuple(graph.driven), self.closed_at)
        return Session(
            self.problem, structure, size=self.size, packing=self.packing, text=self.text
        )

    def derived(self, make: Callable[[Session], Problem]) -> Session:
        """The session of a problem that follows from this session's; a first assembly that is
        continued comes from the session that follows in the same way from its base."""
        other = Session.of(make(self), closed_at=self.closed_at, packing=self.packing)
        other = replace(other, text=self.text)
        if self.base is None:
            return other
        base, between = self.base
        return other.continuing(base._derived_once(make), between.derived(make))

    def _derived_once(self, make: Callable[[Session], Problem]) -> Session:
        """As `derived`, one session for the same joints and links: many continue its assembly."""
        problem = make(self)
        mechanism = problem.mechanism
        key = Session.derived, tuple(mechanism.joints), tuple(mechanism.links)
        if key not in self.memo:
            self.memo[key] = self.derived(lambda session: problem)
        found: Session = self.memo[key]
        return found

    def continuing(self, base: Session, between: Between) -> Session:
        """This session with its first assembly, and its length unit, from those of a base."""
        own = self.measured_in(base.layout.length)
        return replace(own, first=None, base=(base, between))

    def measured_in(self, length: float) -> Session:
        """The same session with another length unit (m) in the kernel."""
        own = self.layout
        if length == own.length:
            return self
        laid = Layout(own.mechanism, self.graph, length, own.laws)
        return replace(self, structure=replace(self.structure, layout=laid), own_inputs=None)

    @remembered
    def packed(self, packing: Packing) -> Session:
        """The same session with rows packed otherwise."""
        if packing == self.packing:
            return self
        return replace(self, packing=packing, own_inputs=self._known_inputs)

    def sized(self, size: float) -> Session:
        """The same session with residual and condition in parts of another size (m)."""
        if size == self.size:
            return self
        return replace(self, size=size, own_inputs=self._known_inputs)

    def with_constants(self, constants: Floats) -> Session:
        """The same session with other constants of its plan."""
        return replace(self, constants=constants, own_inputs=self._known_inputs)

    def assembled(self, assembly: Assembly) -> Session:
        """The same session with another choice of the first assembly."""
        problem = replace(self.problem, assembly=assembly)
        return replace(self, problem=problem, first=None, base=None, own_inputs=None)

    @remembered
    def in_mode(self, mode: str) -> Session:
        """The same session with the first assembly in a mode by its letter."""
        return self.assembled(replace(self.problem.assembly, mode=mode))

    def moved(self, problem: Problem) -> Session:
        """The same session with other values of its inputs: of a problem that differs in its motion
        alone."""
        return replace(self, problem=problem, own_inputs=None)

    def part(self, first: int, last: int) -> Session:
        """The session of the rows from `first` to `last`, both included."""
        return self.moved(self.problem.part(first, last))

    def readout(self, wanted: Iterable[Wanted], points: Iterable[Attached] = ()) -> Readout:
        """The outputs that give some quantities, and the places of some points."""
        return self.structure.readout(tuple(wanted), tuple(points))

    def close(self, inputs: Floats, guess: Floats, demand: Demand = Demand.POSITION) -> Batch:
        """Closes the loops at some inputs (inputs, places) from guesses (states, places)."""
        return self.run(RowInputs(inputs, guess), Ask(demand))

    def follow(
        self,
        path: Floats,
        start: Floats,
        *,
        every_row: bool = False,
        turns: bool = False,
        turn: Floats | None = None,
        whole: Floats | None = None,
    ) -> Followed:
        """Follows the branch through `start` (states,) along a path (inputs, rows); arguments as
        those of `following.follow`."""
        return follow_path(
            self.plan,
            path,
            start,
            every_row=every_row,
            turns=turns,
            turn=turn,
            straight=self.problem.assembly.straight,
            whole=whole,
            slots=self.structure.turns,
        )

    def follow_rows(
        self,
        start: Floats,
        row: int = 0,
        step: int = 1,
        *,
        every_row: bool = False,
        turn: Floats | None = None,
        last: int | None = None,
    ) -> Followed:
        """Follows the branch through `start` (states,) at a row along the rows from there on, or
        with step -1 back from there, to the `last` one or to the end, with the turns of angles,
        which are `turn` at the row where they are known; between the rows the inputs follow their
        laws."""
        if self.route is None:
            end = None if last is None or last + step < 0 else last + step
            inputs, rows = self.inputs, slice(row, end, step)
            path, whole = inputs.reduced[:, rows], inputs.whole[:, rows]
            return self.follow(path, start, every_row=every_row, turns=True, turn=turn, whole=whole)
        straight = self.problem.assembly.straight
        way = self._path(row, step, last)
        return follow_along(
            self.plan, way, start, every_row=every_row, straight=straight, turn=turn
        )

    @remembered
    def _path(self, row: int, step: int, last: int | None) -> FollowedPath:
        """The path along the rows from a row on, or with step -1 back, to the last."""
        assert self.route is not None
        return self.route.way(row, step, last)

    def follow_way(self, way: FollowedPath, start: Floats) -> Followed:
        """Follows the branch through `start` (states,) along a way of all inputs."""
        return follow_along(self.plan, way, start, straight=self.problem.assembly.straight)

    def run(
        self, rows: RowInputs, ask: Ask = POSITIONS, constants: PreciseConstants | None = None
    ) -> Batch:
        """Closes all rows and computes what is asked for; arguments as those of `kernel_run.run`,
        the constants `session.precise.constants(session)` and
        `session.precise.outputs(session, wanted)`."""
        packing = self.packing
        return run_kernel(
            self.plan, rows, ask, constants, lanes=packing.lanes, threads=packing.threads
        )


# Why a branch cannot be followed further: a dead centre, a branch point, a slide that grows out of
# bounds, or no clear reason.
#
# Dead centres and branch points are located while the branch is followed, by arclength
# (kernel/core/stepping/passage.cpp); never as minima of a determinant.


def find_limit(session: Session, followed: Followed) -> Ending | Runaway | None:
    """What ended a branch, or None where it is not known."""
    found = followed.ending
    if found is not None and found.is_dead_centre:
        return found
    runaway = find_runaway(session.layout, followed.state)
    if runaway is None and found is not None and found.kind == PassageEnd.BRANCH_POINT:
        return found
    return runaway


def moves_freely(session: Session, inputs: Floats, state: Floats) -> bool:
    """Whether the loops still close, to third order, a little further on each input in turn, with
    the others held; False also where the rates are not known, as next to a dead centre. What is
    held because the loops stop it is no input.

    Args:
        session: the mechanism as it is driven.
        inputs: (inputs,) in kernel units.
        state: (states,) closed there.
    """
    stopped = _stopped(session)
    return all(
        _open_beside(session, inputs, state, number) <= FREE_INPUT_MISS
        for number in range(inputs.size)
        if number not in stopped
    )


def lies_in_family(session: Session, inputs: Floats, states: Floats) -> NDArray[np.bool_]:
    """Assemblies (assemblies,) at which the loops do not stop what is held to keep the mechanism in
    its family, to first order: elsewhere they stop it themselves. Also those at which rates are not
    known.

    Args:
        session: the mechanism as it is driven.
        inputs: (inputs,) in kernel units.
        states: (states, assemblies) closed there.
    """
    stopped = _stopped(session)
    lies = [
        not any(_open_beside(session, inputs, state, k) > STOPPED_MISS for k in stopped)
        for state in states.T
    ]
    return np.array(lies, dtype=np.bool_)


def _stopped(session: Session) -> list[int]:
    """Numbers of the inputs that are held since the loops stop them, but not to first order."""
    held = {one.coordinate for one in session.problem.stopped}
    return [number for number, coordinate in enumerate(session.driven) if coordinate in held]


def _open_beside(session: Session, inputs: Floats, state: Floats, number: int) -> float:
    """How far the loops are open a little further on one input, where its first and second
    derivatives lead; nan where these are not known."""
    direction = np.zeros(inputs.size)
    direction[number] = 1.0
    stepper = _kernel.Stepper.straight(
        session.plan, inputs.tolist(), direction.tolist(), step_limits()
    )
    node = stepper.close(0.0, state.tolist())
    if node is None:
        return nan
    guess = np.asarray(stepper.predict(node, FREE_INPUT_STEP))[:, None]
    moved = (inputs + FREE_INPUT_STEP * direction)[:, None]
    return float(session.run(RowInputs(moved, guess), Ask(iterations=0)).residual[0])


# Beyond a dead centre: a joint coordinate is driven in place of one input, which is found instead.
#
# Near a dead centre of the input the branch is a function of the coordinate, and not of the input.
# Tree, states and columns are those of the session that it was made of.


class ExchangedCoordinate(NamedTuple):
    """A coordinate that the mechanism is driven by or solved for: (edge, freedom), (joint,
    coordinate), its column and state, and whether a full turn of it is the same place."""

    at: tuple[int, int]
    name: tuple[str, str]
    column: int
    state: int
    is_cyclic: bool


class Exchanged(NamedTuple):
    """A session, and what was exchanged in it: the input `number` is now the coordinate `driven`,
    and `freed` is found."""

    session: Session
    number: int
    driven: ExchangedCoordinate
    freed: ExchangedCoordinate


def exchange(session: Session, number: int, block: int, first: Floats) -> Exchanged | None:
    """The session driven at that unknown of a block which moves most, in place of input `number`;
    None where all unknowns of the block are turns of balls.

    Args:
        session: the mechanism as it is driven.
        number: of the input.
        block: the one that has a dead centre.
        first: derivatives of the columns along the branch (columns,).
    """
    graph = session.graph
    unknowns = [_scalar(session, at) for at in graph.blocks[block].unknowns]
    scalars = [unknown for unknown in unknowns if unknown is not None]
    freed = _scalar(session, graph.inputs[number])
    if not scalars or freed is None:
        return None
    driven = max(scalars, key=lambda unknown: abs(float(first[unknown.column])))
    other = exchanged(graph, number, driven.at, driven.name)
    found = session.exchanged(other)
    return Exchanged(found, number, driven, freed)


def _scalar(session: Session, at: tuple[int, int]) -> ExchangedCoordinate | None:
    """A freedom of the tree as a coordinate; None for one of a ball."""
    layout, (edge, freedom) = session.layout, at
    joint = session.graph.edges[edge].joint
    kernel_joint, local = layout.carrier_of(edge, freedom)
    kind = layout.carriers[kernel_joint].part.type
    if kind.is_ball:
        return None
    names = [name for name, of in joint.type.scalars.items() if of == freedom]
    unnamed = f"{'slide' if kind.slides[local] else 'turn'} {freedom}"
    name = (joint.name, names[0] if names else unnamed)
    column, state = layout.column(edge, freedom), layout.state(edge, freedom)
    return ExchangedCoordinate(at, name, column, state, kind.freedoms[local].is_cyclic)
