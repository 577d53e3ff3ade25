"""A session's constants as the file's text says them, in double-double and enclosed.

The file is recorded once with all its numbers exact (`building.recording.record_exactly`); the
layout of the session is laid over that recording, and what reaches the kernel is replayed. Tree,
blocks, the choice of frames, length unit and origin are the session's own, in doubles; so is the
size in whose parts residuals are told. They are conventions, not measures.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.plan import plan_records
from mechkin_cli.solver.precise_inputs import PreciseInputs, enclosed_inputs, precise_inputs
from mechkin_cli.solver.records import flatten
from mechkin_cli.solver.same_structure import graph_of
from mechkin_cli.tape.decimal_replay import NotEnclosed, double_doubles, enclosures
from mechkin_cli.tape.traced import TraceLost, register

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.exact_motion import ExactMoments, ExactMotion
    from mechkin_cli.mechanism.model import Attached
    from mechkin_cli.mechanism.motion import Assembly
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session
    from mechkin_cli.tape.exact_recorder import ExactRecorder, ExactTape


class Precise:
    """The numbers of a file's sessions as its text says them.

    Args:
        recorder: that holds the exact numbers.
        problem: the file's problem on that recorder.
        motion: the file's motion over its rows.
        base: the same problem in doubles, of which the sessions are.
        moments: of the rows of a response, whose first moment `problem` is.
    """

    def __init__(
        self,
        recorder: ExactRecorder,
        problem: Problem,
        motion: ExactMotion,
        base: Problem,
        moments: ExactMoments | None = None,
    ) -> None:
        self.recorder = recorder
        self.problem = problem
        self.motion = motion
        self.base = base
        self.moments = moments
        self._layouts: dict[int, tuple[Session, Layout]] = {}
        self._inputs: dict[int, tuple[Problem, PreciseInputs]] = {}

    def constants(self, session: Session) -> Floats:
        """The constants of the session's plan in double-double (constants, 2), in the order in
        which the kernel numbers them: high and low, |low| <= ulp(high)/2.

        The session may be any of the file's: of the whole mechanism, of the loops that are
        followed, with other loads left out, sized or packed otherwise.
        """
        return double_doubles(self.tape(self._constants(session)))

    def enclosed_constants(self, session: Session) -> Floats:
        """The same enclosed (constants, 3): high and low parts, and radii about their sums.

        Raises:
            TraceLost: loads are read from tables (`rounds_tables`).
            NotEnclosed: a constant is not defined.
        """
        if self.rounds_tables(session):
            raise TraceLost("the curve through a table of a load is known in doubles alone")
        return enclosures(self.tape(self._constants(session)))

    def rounds_tables(self, session: Session) -> bool:
        """Whether loads of the session are read from tables. The curves through these are structure
        of a plan, not constants: they stay doubles."""
        laws = self.layout(session).laws
        return laws is not None and any(law.curve is not None for law in laws.laws)

    def outputs(
        self, session: Session, wanted: Iterable[Wanted], points: Iterable[Attached] = ()
    ) -> Floats:
        """The constants of `session.readout(wanted, points)` in double-double (constants, 2)."""
        return double_doubles(self.tape(self._outputs(session, wanted, points)))

    def enclosed_outputs(
        self, session: Session, wanted: Iterable[Wanted], points: Iterable[Attached] = ()
    ) -> Floats:
        """The same enclosed (constants, 3)."""
        return enclosures(self.tape(self._outputs(session, wanted, points)))

    def inputs(self, session: Session) -> PreciseInputs:
        """The inputs of all rows in double-double, as `session.inputs` has them in doubles; kept.

        Rows that a call asked for in place of the file's are the doubles that it gave, in the
        file's units.
        """
        problem = session.problem
        if id(problem) not in self._inputs:
            self._inputs[id(problem)] = (problem, precise_inputs(self, session))
        return self._inputs[id(problem)][1]

    def enclosed_inputs(self, session: Session) -> PreciseInputs:
        """The same enclosed: a third part is the radius about the two."""
        return enclosed_inputs(self, session)

    @cached_property
    def parameters(self) -> Mapping[str, Floats]:
        """The file's parameters in SI and double-double (2,), by name; nan where the text says no
        number, as where it divides by zero."""
        return self._parameters()

    def _parameters(self) -> dict[str, Floats]:
        known = self.problem.parameters
        try:
            values = double_doubles(self.tape([quantity.value for quantity in known.values()]))
        except NotEnclosed:
            return {name: self._parameter(quantity.value) for name, quantity in known.items()}
        return dict(zip(known, values, strict=True))

    def _parameter(self, value: Any) -> Floats:
        try:
            found: Floats = double_doubles(self.tape([value]))[0]
        except NotEnclosed:
            return np.full(2, np.nan)
        return found

    def tape(self, numbers: Iterable[Any]) -> ExactTape:
        """The tape to some numbers of the recording."""
        return self.recorder.exact_tape([register(self.recorder, n) for n in numbers])

    def layout(self, session: Session) -> Layout:
        """The session's layout over the recording; kept."""
        if id(session) not in self._layouts:
            problem = self.problem_of(session)
            own = session.layout
            graph = graph_of(problem.solved_mechanism, session.graph)
            layout = Layout(problem.laid_mechanism, graph, own.length, problem.laws)
            # a choice of the drawing, as the length unit
            layout.__dict__["origin"] = own.origin
            self._layouts[id(session)] = (session, layout)
        return self._layouts[id(session)][1]

    def _constants(self, session: Session) -> list[Any]:
        size = session.size or session.layout.mechanism.box_diagonal()
        return flatten(plan_records(self.layout(session), size))

    def _outputs(
        self, session: Session, wanted: Iterable[Wanted], points: Iterable[Attached]
    ) -> list[Any]:
        plan = OutputPlan(self.layout(session), None, session.driven)
        for quantity in wanted:
            plan.add(quantity)
        for at in points:
            plan.add_point(at, 0)
        return flatten(plan.records)

    def problem_of(self, session: Session) -> Problem:
        """The recorded problem of what the session's problem is made of."""
        own = session.problem
        mechanism = own.mechanism
        parts: dict[str, Any] = {
            name: {key: self._recorded(part) for key, part in getattr(mechanism, name).items()}
            for name in ("links", "joints", "points", "directions")
        }
        for name in ("loads", "frictions"):
            parts[name] = tuple(map(self._recorded, getattr(mechanism, name)))
        parts["gravity"] = self._recorded(mechanism.gravity)
        return replace(
            own,
            mechanism=replace(mechanism, **parts),
            assembly=self._assembly(own.assembly),
            parameters=self.problem.parameters,
            load_laws=tuple(map(self._recorded, own.load_laws)),
            held=tuple(map(self._recorded, own.held)),
        )

    def _assembly(self, own: Assembly) -> Assembly:
        """The recorded assembly; what a session names of the file's coordinates."""
        near = self.problem.assembly.near
        return replace(own, near={name: near.get(name, own.near[name]) for name in own.near})

    def _recorded(self, part: Any) -> Any:
        """A part of the file's problem as it is recorded; another one must be of whole numbers, as
        what is left out and what has the size 1."""
        found = self._counterparts.get(id(part))
        if found is not None:
            return found[1]
        if any(number != int(number) for number in _numbers(part)):
            raise ValueError(f"{part} stands in no text")
        return part

    @cached_property
    def _counterparts(self) -> dict[int, tuple[Any, Any]]:
        """Each part of the problem with the recorded one, by its identity."""
        own, recorded = self.base, self.problem
        pairs: list[tuple[Any, Any]] = [
            (own.mechanism.gravity, recorded.mechanism.gravity),
            *zip(own.mechanism.loads, recorded.mechanism.loads, strict=True),
            *zip(own.mechanism.frictions, recorded.mechanism.frictions, strict=True),
            *zip(own.load_laws, recorded.load_laws, strict=True),
            *zip(own.held, recorded.held, strict=True),
        ]
        for name in ("links", "joints", "points", "directions"):
            parts = getattr(recorded.mechanism, name)
            pairs += [(part, parts[key]) for key, part in getattr(own.mechanism, name).items()]
        return {id(one): (one, other) for one, other in pairs}


def _numbers(part: Any) -> Iterator[float]:
    if isinstance(part, float):
        yield part
    elif isinstance(part, tuple):
        for item in part:
            yield from _numbers(item)
    elif is_dataclass(part):
        for field in fields(part):
            yield from _numbers(getattr(part, field.name))
    elif isinstance(part, Mapping):
        for item in part.values():
            yield from _numbers(item)
