"""A session: one problem's solver graph, layout, frozen plan and inputs, and its verbs.

Everything that is asked of a mechanism goes through the four verbs *close*, *follow*, *search* and
*run*. What a session has found it keeps: `once` for all sessions of its structure, whatever their
rows, first assembly, size or packing; `own` for itself alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import Demand, Layout, OutputPlan, Readout
from mechkin_cli.session.following import (
    Followed,
    follow as follow_path,
    follow_way as follow_along,
)
from mechkin_cli.session.inputs import KernelInputs, TurnSlots, input_unit, kernel_inputs
from mechkin_cli.session.kernel_run import RESIDUAL_TESTS, Batch, Chart, run as run_kernel
from mechkin_cli.structure import SolverGraph, build_graph, is_redundant

if TYPE_CHECKING:
    from typing import Self

    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Assembly, Attached, Problem, Wanted
    from mechkin_cli.search import Assemblies, Within
    from mechkin_cli.session.double_double import Precise, PreciseBatch
    from mechkin_cli.session.path import FollowedPath, InputTie, Route
    from mechkin_cli.show import Floats


# What has been found and is kept: a question asked twice does its work once.

T = TypeVar("T")


class Keeping:
    """Keeps what it has found, by keys: `once` for all objects of one structure, which share it,
    `own` for one object alone."""

    def __init__(self) -> None:
        self._kept: dict[object, object] = {}
        self._own: dict[object, object] = {}

    def once(self, key: object, find: Callable[[], T]) -> T:
        """What `find` gives, found once for each key and all that share the structure."""
        if key not in self._kept:
            self._kept[key] = find()
        return cast("T", self._kept[key])

    def own(self, key: object, find: Callable[[], T]) -> T:
        """What `find` gives, found once for each key and this object."""
        if key not in self._own:
            self._own[key] = find()
        return cast("T", self._own[key])


Coordinate = tuple[str, str]
"""(joint, coordinate)."""


@dataclass(frozen=True)
class Packing:
    """How the kernel packs rows: `lanes` at a time (0: the most that the machine has) on `threads`
    (0: all cores, for work worth it). No result depends on either."""

    lanes: int = 0
    threads: int = 0


class Continued(NamedTuple):
    """A first assembly that is not to be chosen: continued from that of another variant. Without
    states (states,) the branch was lost on the way; `row` is the one where it stands."""

    state: Floats | None
    row: int


class Session(Keeping):
    """A problem in the kernel.

    Args:
        problem: mechanism, motion and assembly.
        graph: its solver graph; None builds the best one.
        driven: the inputs, where they are not those of the problem's motion and what is held.
        closed_at: closing joints to use instead of the best ones.
        packing: how rows are packed.

    `text` gives the numbers as the file says them, where the problem is that of a file.

    Raises:
        UnsolvableGraph: the mechanism cannot be solved as it is driven.
    """

    def __init__(
        self,
        problem: Problem,
        graph: SolverGraph | None = None,
        *,
        driven: Sequence[Coordinate] | None = None,
        closed_at: Sequence[str] | None = None,
        packing: Packing = Packing(),
    ) -> None:
        super().__init__()
        self.problem = problem
        self.driven = list(problem.driven if driven is None else driven)
        self.closed_at = closed_at
        self.packing = packing
        self.size: float | None = None
        self.continued: Continued | None = None
        self.text: Callable[[], Precise] | None = None
        self.graph = graph or build_graph(problem.solved_mechanism, self.driven, closed_at)
        self._readouts: dict[object, Readout] = {}

    @cached_property
    def layout(self) -> Layout:
        """How the mechanism lies in the kernel."""
        return Layout(self.problem.laid_mechanism, self.graph, laws=self.problem.laws)

    @cached_property
    def plan(self) -> Plan:
        """The frozen plan; residual and condition in parts of `size` (m; None: the drawing's)."""
        return self.layout.build()

    @cached_property
    def turn_slots(self) -> TurnSlots:
        """Where the turns of angles stand among `Followed.turns`."""
        return TurnSlots.of(self.plan)

    @cached_property
    def inputs(self) -> KernelInputs:
        """The inputs of all rows of the problem's motion."""
        return kernel_inputs(self.problem, self.layout)

    @cached_property
    def route(self) -> Route | None:
        """The way along all rows; None where it goes straight from each to the next."""
        course = self.problem.motion.course
        if course is None:
            return None
        from mechkin_cli.session.path import Route

        units = [input_unit(self.layout, item) for item in self.problem.motion.inputs]
        return Route(course, self.inputs.values, np.array(units))

    def tie(self, number: int, row: int = 0) -> InputTie | None:
        """What follows input `number` where all others stand as in a row; None where nothing
        does."""
        name = self.problem.motion.inputs[number].name
        tapes = dict(self.problem.motion.ties)
        if name not in tapes:
            return None
        from mechkin_cli.session.path import InputTie

        return self.once(("tie", number, row), lambda: InputTie(self, tapes[name], number, row))

    @cached_property
    def tie_rates(self) -> Floats | None:
        """Rates of tied inputs by those of their leaders in kernel units (ties, rows)."""
        drives, motion = self.layout.drives, self.problem.motion
        if drives is None or motion.tie_rates is None:
            return None
        units = [input_unit(self.layout, item) for item in motion.inputs]
        factors = [units[leader] / units[tied] for tied, leader in motion.tied]
        rates: Floats = motion.tie_rates * np.array(factors)[:, None]
        return rates

    @property
    def is_redundant(self) -> bool:
        """Whether some loop has more closing equations than unknowns."""
        return is_redundant(self.graph)

    def reading(self, text: Callable[[], Precise]) -> Self:
        """This session, which now knows where its numbers are written."""
        self.text = text
        return self

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

    def of(self, problem: Problem, graph: SolverGraph | None = None) -> Session:
        """A session of another problem with the same choices."""
        other = Session(problem, graph, closed_at=self.closed_at, packing=self.packing)
        other.text = self.text
        return other

    def loaded(self, problem: Problem) -> Session:
        """A session of a problem that differs in masses and loads alone: the same states serve."""
        other = self.of(problem, self.graph)
        other.__dict__["layout"] = Layout(
            problem.laid_mechanism, self.graph, self.layout.length, laws=problem.laws
        )
        # efforts that actuators share go by the size
        return other if self.size is None else other.sized(self.size)

    def derived(self, make: Callable[[Session], Problem]) -> Session:
        """The session of a problem that follows from this session's."""
        return self.of(make(self))

    def packed(self, packing: Packing) -> Session:
        """The same session with rows packed otherwise."""
        if packing == self.packing:
            return self
        return self.own(("packed", packing), lambda: self._changed(packing=packing))

    def sized(self, size: float) -> Session:
        """The same session with residual and condition in parts of another size (m)."""
        if size == self.size:
            return self
        other = self._changed(size=size)
        other.__dict__["plan"] = self.plan.with_size(size)
        return other

    def with_constants(self, constants: Floats) -> Session:
        """The same session with other constants of its plan."""
        other = self._changed()
        other.__dict__["plan"] = self.plan.with_constants(constants)
        return other

    def assembled(self, assembly: Assembly) -> Session:
        """The same session with another choice of the first assembly."""
        return self._changed(problem=replace(self.problem, assembly=assembly), continued=None)

    def moved(self, problem: Problem) -> Session:
        """The same session with other values of its inputs: of a problem that differs in its motion
        alone."""
        other = self._changed(problem=problem)
        other.__dict__.pop("inputs", None)
        other.__dict__.pop("route", None)
        return other

    def _changed(self, **changes: object) -> Session:
        """A session that shares graph, layout, plan, inputs and what was found."""
        _ = self.plan  # made before it is shared: outputs belong to one structure
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.__dict__.update(changes)
        other._own = {}
        return other

    def readout(self, wanted: Iterable[Wanted], points: Iterable[Attached] = ()) -> Readout:
        """The outputs that give some quantities, and the places of some points."""
        wanted, points = tuple(wanted), tuple(points)
        key = (tuple(quantity.name for quantity in wanted), points)
        if key not in self._readouts:
            outputs = OutputPlan(self.layout, self.plan, self.driven)
            for quantity in wanted:
                outputs.add(quantity)
            slots = [outputs.add_point(at, 0) for at in points]
            self._readouts[key] = Readout(outputs.outputs, outputs.slots, slots)
        return self._readouts[key]

    def close(self, inputs: Floats, guess: Floats, demand: Demand = Demand.POSITION) -> Batch:
        """Closes the loops at some inputs (inputs, places) from guesses (states, places)."""
        return self.run(inputs, guess, demand=demand)

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
        those of `solver.follow.follow`."""
        return follow_path(
            self.plan,
            path,
            start,
            every_row=every_row,
            turns=turns,
            turn=turn,
            straight=self.problem.assembly.straight,
            whole=whole,
        )

    def follow_rows(
        self, start: Floats, row: int = 0, step: int = 1, *, every_row: bool = False
    ) -> Followed:
        """Follows the branch through `start` (states,) at a row along the rows from there on, or
        with step -1 back from there, with the turns of angles; between the rows the inputs follow
        their laws and ties."""
        if self.route is None:
            inputs, rows = self.inputs, slice(row, None, step)
            path, whole = inputs.reduced[:, rows], inputs.whole[:, rows]
            return self.follow(path, start, every_row=every_row, turns=True, whole=whole)
        straight = self.problem.assembly.straight
        route = self.route
        way = self.own(("way", row, step), lambda: route.way(row, step))
        return follow_along(self.plan, way, start, every_row=every_row, straight=straight)

    def follow_way(self, way: FollowedPath, start: Floats) -> Followed:
        """Follows the branch through `start` (states,) along a way of all inputs."""
        return follow_along(self.plan, way, start, straight=self.problem.assembly.straight)

    def search(
        self, inputs: Floats, within: Within | None = None, *, thorough: bool = True
    ) -> Assemblies:
        """All assemblies at some inputs (inputs,) that random starts find, or those `within` a box;
        not `thorough`: most of them, where one is wanted."""
        from mechkin_cli.search import assemblies

        turns, about = self.problem.assembly.turns, self._named_turns()
        if within is not None:
            return assemblies(self.layout, self.plan, inputs, turns, within, about, thorough)

        def find(thorough: bool) -> Assemblies:
            key = ("search", inputs.tobytes(), turns, about.tobytes(), thorough)
            return self.once(
                key,
                lambda: assemblies(self.layout, self.plan, inputs, turns, None, about, thorough),
            )

        quick = find(thorough=False)
        final = quick.complete or quick.cut or not thorough
        return quick if final else find(thorough=True)

    def _named_turns(self) -> Floats:
        """States (states,): the turns of threads that the assembly's `near` names, else zero."""
        states: Floats = np.zeros(self.layout.states)
        for name, value in self.problem.assembly.near.items():
            owner, _, coordinate = name.rpartition(".")
            joint, edge = self.layout.mechanism.joints[owner], self.layout.edge_number.get(owner)
            if edge is not None and joint.type.is_threaded:
                number = self.layout.state(edge, joint.type.freedom_of[coordinate])
                states[number] = value / joint.unit_of(coordinate, self.layout.length)
        return states

    def run(
        self,
        inputs: Floats,
        guess: Floats,
        *,
        readout: Readout | None = None,
        demand: Demand = Demand.POSITION,
        rates: Floats | None = None,
        accelerations: Floats | None = None,
        jerks: Floats | None = None,
        ties: Floats | None = None,
        turned: Floats | None = None,
        whole: Floats | None = None,
        chart: Chart | None = None,
        full: Floats | None = None,
        time: Floats | None = None,
        derivatives: bool = False,
        shift: int = 0,
        iterations: int = tolerances.NEWTON_ITERATIONS,
        tests: tuple[float, float, float] = RESIDUAL_TESTS,
    ) -> Batch:
        """Closes all rows and computes what is demanded; arguments as those of
        `solver.batch.run`."""
        return run_kernel(
            self.plan,
            inputs,
            guess,
            rates=rates,
            accelerations=accelerations,
            jerks=jerks,
            ties=ties,
            turned=turned,
            whole=whole,
            chart=chart,
            full=full,
            time=time,
            demand=demand,
            outputs=None if readout is None else readout.outputs,
            derivatives=derivatives,
            shift=shift,
            iterations=iterations,
            tests=tests,
            lanes=self.packing.lanes,
            threads=self.packing.threads,
        )

    def run_precise(
        self, inputs: Floats, guess: Floats, *, readout: Readout | None = None, **given: Any
    ) -> PreciseBatch:
        """Closes rows that are closed in doubles, and computes what is demanded, in double-double;
        arguments as those of `solver.precise_run.run_precise`, constants as
        `session.precise.constants(session)` and `session.precise.outputs(session, wanted)`."""
        from mechkin_cli.session.double_double import run_precise

        return run_precise(
            self.plan,
            inputs,
            guess,
            outputs=None if readout is None else readout.outputs,
            lanes=self.packing.lanes,
            threads=self.packing.threads,
            **given,
        )
