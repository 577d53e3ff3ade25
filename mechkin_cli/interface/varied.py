"""A model under other parameters, without reading or building anew.

The base model records once, for each set of parameters, how its plan depends on them; variants are
replays of that. Where a recording does not hold, the variant is built anew: the same answers and
the same errors, only slower.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis.assembly.anew import AnewSession, structure_of
from mechkin_cli.analysis.sweep import first_assembly
from mechkin_cli.building.build import build
from mechkin_cli.building.recording import record
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.expressions import Quantity
from mechkin_cli.interface.given import parameter_values
from mechkin_cli.interface.model import Model
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.runs import SWEEP
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.session import Session
from mechkin_cli.solver.variation import FirstAssembly, Variation
from mechkin_cli.solver.varied_session import VariedSession
from mechkin_cli.tape.tape import Verdict
from mechkin_cli.tape.traced import TraceLost

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.building.build import Built
    from mechkin_cli.interface.analysis import Analysis
    from mechkin_cli.interface.variants import Reduce, Variants
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.precise import Precise
    from mechkin_cli.view.settings import ViewSettings


class Base:
    """What the variants of a model share: its first assembly, and its recordings by parameters."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._variations: dict[tuple[str, ...], Variation | None] = {}

    @cached_property
    def _assembled(self) -> tuple[Session, FirstAssembly] | None:
        if self.model.problem.follow is not None:
            return None  # which loops are followed depends on what is asked
        if SWEEP not in self.model.runs:
            return None  # there is no first row to continue
        session, start = first_assembly(self.model.session)
        if start.state is None or session.size is None:
            return None
        return session, FirstAssembly(start.state, start.row, session.size)

    @property
    def start(self) -> FirstAssembly:
        """The first assembly of a model that has a variation."""
        assert self._assembled is not None
        return self._assembled[1]

    def variation(self, names: Sequence[str]) -> Variation | None:
        """How the model depends on some parameters; None where every variant is built anew."""
        key = tuple(names)
        if key not in self._variations:
            self._variations[key] = self._recorded(key)
        return self._variations[key]

    def _recorded(self, names: tuple[str, ...]) -> Variation | None:
        if self._assembled is None:
            return None
        try:
            recording = record(self.model.built, names)
            return Variation(self._assembled[0], recording.recorder, recording.problem)
        except (TraceLost, TypeError, ValueError):
            # numpy refuses recorded numbers in words of its own
            return None

    def built(self, values: Mapping[str, float]) -> Built:
        """The model with other parameters (SI), by the ordinary path.

        Raises:
            InvalidFile: with every independent error.
        """
        known = self.model.problem.parameters
        given = {name: Quantity(v, known[name].dimension) for name, v in values.items()}
        return build(self.model.built.read, given)


class VariedModel(Model):
    """A model with other values of some parameters.

    Args:
        base: the model as its file has it.
        values: by name, in SI.
    """

    def __init__(self, base: Base, values: Mapping[str, float]) -> None:
        variation = base.variation(tuple(values))
        if variation is None:
            # what has the file's own value need not be named, and may be what no tape holds
            own = base.model.problem.parameters
            values = {name: v for name, v in values.items() if v != own[name].value}
            variation = base.variation(tuple(values)) if values else None
        self._base, self._values = base, dict(values)
        self._variation = variation
        row = np.array(list(values.values()))
        self._row = row
        verdict = Verdict.OTHER_WAY if variation is None else variation.verdicts(row[:, None])[0]
        if variation is None or verdict == Verdict.OTHER_WAY:
            self._variation = None
            super().__init__(base.built(values), base.model.stem)
            return
        super().__init__(base.model.built, base.model.stem)
        self._advised = verdict == Verdict.OTHER_ADVICE

    @property
    def values(self) -> Mapping[str, float]:
        """The parameters that were set, by name, in SI."""
        return self._values

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as the file's model and the values."""
        return _revaried, (self._base.model, self._values)

    @cached_property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        if self._variation is None:
            return self.built.problem
        problem = self._variation.problem(self._row)
        if self._advised:
            fresh = self._base.built(self._values).problem
            problem = replace(problem, diagnostics=fresh.diagnostics)
        return problem

    @cached_property
    def session(self) -> Session:
        """The mechanism in the kernel."""
        if self._variation is None:
            base = self._base.model.session
            anew = AnewSession(self.problem, self.graph, base, self._between)
            return anew.reading(lambda: self.precise)
        varied = VariedSession(self._variation, self._row, self.problem, self._base.start)
        if varied.continued is not None and varied.continued.state is None:
            # the branch ends on the way: the same structure, or another problem?
            fresh = self._base.built(self._values)
            if isinstance(fresh.graph, Diagnostic):
                raise InvalidFile([*fresh.problem.diagnostics, fresh.graph])
            if structure_of(fresh.graph) != structure_of(varied.graph):
                return Session(fresh.problem, fresh.graph)
        return varied.reading(lambda: self.precise)

    @cached_property
    def precise(self) -> Precise:
        """As `Model.precise`; values that were set are the doubles that they are."""
        from mechkin_cli.building.recording import precise

        return precise(self.built, self.problem, self._given)

    @property
    def _given(self) -> dict[str, Quantity]:
        """The values that were set, in SI."""
        known = self._base.model.problem.parameters
        return {name: Quantity(v, known[name].dimension) for name, v in self._values.items()}

    def _between(self, place: float) -> Session:
        """The session between the file's own parameters (0) and these (1), built anew."""
        own = self._base.model.problem.parameters
        values = {}
        for name, value in self._values.items():
            start = float(own[name].value)  # type: ignore[arg-type]
            values[name] = start + place * (value - start)
        built = self._base.built(values)
        if isinstance(built.graph, Diagnostic):
            raise InvalidFile([*built.problem.diagnostics, built.graph])
        return Session(built.problem, built.graph)

    @property
    def graph(self) -> SolverGraph:
        """Tree, closing joints and blocks."""
        return super().graph if self._variation is None else self.session.graph

    @cached_property
    def _fresh(self) -> Model:
        """The same model built anew: no recording holds responses."""
        built = self.built if self._variation is None else self._base.built(self._values)
        return _BuiltAnew(built, self.stem, self._given)

    @property
    def view_settings(self) -> ViewSettings:
        """As `Model.view_settings`; its lengths are those of these parameters."""
        return super().view_settings if self.built.view is None else self._fresh.view_settings

    def response(self, name: str) -> Response:
        """What one of the file's responses asks for, in SI."""
        return self._fresh.response(name)

    def response_graph(self, name: str) -> SolverGraph:
        """Tree, closing joints and blocks at the start of a response."""
        return self._fresh.response_graph(name)

    def session_of(self, run: str) -> Session:
        """As `Model.session_of`."""
        return self.session if run == SWEEP else self._fresh.session_of(run)

    def respond(
        self,
        name: str | None = None,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """As `Model.respond`; the assembly at the start is chosen for these parameters."""
        found = self._fresh.respond(
            name, quantities, tables=tables, mode=mode, lanes=lanes, threads=threads
        )
        found.model = self
        return found

    def with_parameters(self, parameters: Mapping[str, Any]) -> Model:
        """As `Model.with_parameters`; values of before stay unless they are given anew."""
        root = self._base.model
        values = {**self._values, **parameter_values(root.problem, parameters)}
        ordered = {name: values[name] for name in root.problem.parameters if name in values}
        return VariedModel(self._base, ordered) if parameters else self

    def vary(
        self,
        parameters: Mapping[str, Any],
        quantities: Iterable[str] | None = None,
        reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None = None,
        *,
        run: str = SWEEP,
        lanes: int = 0,
        threads: int = 0,
    ) -> Variants:
        """As `Model.vary`; values of before stay unless they are given anew."""
        from mechkin_cli.interface.variants import vary

        return vary(self._base, self._values, parameters, quantities, reduce, run, lanes, threads)


class _BuiltAnew(Model):
    """A model that was built with values, which its file does not have; `given` are those in SI."""

    def __init__(self, built: Built, stem: str, given: Mapping[str, Quantity]) -> None:
        super().__init__(built, stem)
        self._values_given = given

    @property
    def _given(self) -> Mapping[str, Quantity]:
        return self._values_given


def _revaried(model: Model, values: Mapping[str, float]) -> Model:
    """A model with the values that another had."""
    return VariedModel(Base(model), values) if values else model


def with_parameters(base: Base, parameters: Mapping[str, Any]) -> Model:
    """`Model.with_parameters` of a model as its file has it."""
    values = parameter_values(base.model.problem, parameters)
    return VariedModel(base, values) if values else base.model


def file_values(values: Floats, problem: Problem, names: Sequence[str]) -> dict[str, Floats]:
    """Parameters (parameters, variants) in the file's units, by name."""
    known = problem.parameters
    return {
        name: np.asarray(problem.units.from_si(row, known[name].dimension), dtype=np.float64)
        for name, row in zip(names, values, strict=True)
    }
