"""Designs with other values of parameters, without reading or building the file again.

The file's own design records once, for each set of parameters, how its plan depends on them;
variants are replays of that. Where a recording does not hold, the variant is built again: the same
answers and the same errors, only slower. First, values of parameters as a caller gives them, to SI.

Last, numbers in (0, 1) for the samples of a study. Any stretch of samples is drawn by itself and is
the same whatever was drawn before, so that the bytes of a study do not depend on the pieces in
which it is computed.
"""

from __future__ import annotations

import warnings
from _thread import RLock  # as the recorder
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from mechkin_cli.analysis import Design, Solvable
from mechkin_cli.arguments import Setting, a_setting, a_text, settings, shown
from mechkin_cli.building import (
    build,
    graph_as_built,
    is_tiny_length,
    motion_as_built,
    record,
    record_response,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, InvalidFile, UsageError, nearest_hint
from mechkin_cli.expressions import ExpressionError, Quantity, constant
from mechkin_cli.mechanism import Problem
from mechkin_cli.memo import Memo, remembered
from mechkin_cli.record import replace
from mechkin_cli.session import Between, Session
from mechkin_cli.structure import SolverGraph, structure_of
from mechkin_cli.sweep import first_assembly
from mechkin_cli.tape import TraceLost, Verdict
from mechkin_cli.tolerances import LARGEST_NUMBER, SMALLEST_SIZE
from mechkin_cli.units import LENGTH
from mechkin_cli.variants.variation import (
    Recording,
    SessionVariation,
    varied_response,
    varied_session,
)
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building import Built, ViewSettings
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import MotionInputs
    from mechkin_cli.show import Floats
    from mechkin_cli.units import Dimension, UnitSystem


def parameter_values(problem: Problem, given: Mapping[str, Any]) -> dict[str, float]:
    """One value of each parameter, in SI and in the file's order.

    Raises:
        UsageError: no mapping, an unknown parameter, or an invalid value.
    """
    values = settings("parameters", given, '{"P1": "0.6 in"}')
    return {
        name: one_value(name, values[name], known.dimension, problem.units)
        for name, known in _known(problem, values)
    }


def parameter_arrays(problem: Problem, given: Mapping[str, Any]) -> tuple[tuple[str, ...], Floats]:
    """Names in the file's order, and values (parameters, variants) in SI; one value stands for all
    variants.

    Raises:
        UsageError: as `parameter_values`; arrays of more than one dimension or different lengths.
    """
    if not isinstance(given, Mapping):
        settings("parameters", given, '{"P1": [0.5, 0.6]}')
    for name in given:
        a_text("a key of parameters", name, '"P1"')
    columns = {
        name: _column(name, given[name], known.dimension, problem.units)
        for name, known in _known(problem, given)
    }
    if not columns:
        raise UsageError('vary takes values of at least one parameter, such as {"P1": [0.5, 0.6]}')
    lengths = {name: column.size for name, column in columns.items() if column.ndim}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {n}" for name, n in lengths.items())
        raise UsageError(f"values of parameters need equally many variants, found {words}")
    count = next(iter(lengths.values()), 1)
    rows = [np.broadcast_to(column, (count,)) for column in columns.values()]
    return tuple(columns), np.stack(rows)


def _known(problem: Problem, given: Mapping[str, Any]) -> list[tuple[str, Quantity]]:
    """Names and quantities, in the file's order."""
    known = problem.parameters
    for name in given:
        if name not in known:
            listed = ", ".join(list(known)[:10])
            hint = nearest_hint(name, list(known)) or (
                f"parameters are {listed}" if known else "write parameters: into the file"
            )
            raise UsageError(f"there is no parameter {name[:LONGEST_NAME]}; {hint}")
    return [(name, known[name]) for name in known if name in given]


def one_value(name: str, value: Setting, dimension: Dimension, units: UnitSystem) -> float:
    """A value in SI; a number is in the file's units, a text carries its own.

    Raises:
        UsageError: it is none, or no number that can be computed with.
    """
    if not isinstance(value, str):
        in_si = units.to_si(float(value), dimension)
        if in_si == 0.0 and value != 0.0:
            raise UsageError(
                f"{name} = {value} is too small: in SI units it would be zero; write 0 or another "
                "value or unit"
            )
        return _bounded(name, in_si, value, dimension)
    try:
        return _bounded(name, constant(value, dimension, units), value, dimension)
    except ExpressionError as error:
        unit = units.label(dimension)
        hint = error.hint or f"write a number with its unit, such as 1 {unit}".rstrip()
        raise UsageError(f"{name} = {value[:LONGEST_NAME]}: {error.message}; {hint}") from None


def _column(name: str, value: Any, dimension: Dimension, units: UnitSystem) -> Floats:
    try:
        array = np.asarray(value)
    except Exception:
        # whatever a foreign object's conversion raises
        array = np.empty((0, 0))
    if isinstance(value, str) or array.ndim == 0:
        return np.array(one_value(name, a_setting(name, value), dimension, units))
    if array.ndim > 1:
        raise UsageError(
            f"{name}: expected a value a variant, an array of one dimension, not {shown(value)}"
        )
    if array.dtype.kind not in "fiu":
        items = [a_setting(f"{name}[{k}]", item) for k, item in enumerate(value)]
        return np.array([one_value(name, item, dimension, units) for item in items], np.float64)
    in_si = units.to_si(array.astype(np.float64), dimension)
    sizes = np.abs(in_si)
    least = SMALLEST_SIZE if dimension == LENGTH else 0.0
    large = (sizes >= least) & (sizes > 0.0) | (array == 0)
    wrong = np.flatnonzero(~((sizes <= LARGEST_NUMBER) & large))
    if wrong.size:
        one_value(f"{name}[{wrong[0]}]", array[wrong[0]].item(), dimension, units)
        _bounded(f"{name}[{wrong[0]}]", float(in_si[wrong[0]]), array[wrong[0]], dimension)
    return in_si


def _bounded(name: str, in_si: float, value: object, dimension: Dimension) -> float:
    if is_tiny_length(in_si, dimension):
        raise UsageError(
            f"{name} = {str(value)[:LONGEST_NAME]} is a length below {SMALLEST_SIZE:g} m; write "
            "another value or unit"
        )
    if not abs(in_si) <= LARGEST_NUMBER:
        raise UsageError(
            f"{name} = {str(value)[:LONGEST_NAME]} is no finite number below {LARGEST_NUMBER:g} in "
            "SI units; write another value or unit"
        )
    return in_si


MOST_RECORDINGS = 32
"""Recordings that a design keeps for some parameters. Each costs as much as some builds: a file
that is built in ever other ways is not worth more."""


class Base:
    """What the variants of a design share: its first assembly, and its recordings by parameters."""

    def __init__(self, design: Design) -> None:
        self.design = design
        self.memo: Memo = {}
        self._lock = RLock()  # threads that share a design record it once
        self._recordings: dict[tuple[str, ...], list[Recording | None]] = {}
        self._variations: dict[tuple[str, ...], SessionVariation | None] = {}
        self._responses: dict[tuple[str, ...], SessionVariation | None] = {}

    @cached_property
    def _assembled(self) -> tuple[Session, tuple[Floats, int, float]] | None:
        if self.design.problem.follow is not None:
            return None  # which loops are followed depends on what is asked
        if SWEEP not in self.design.built.runs:
            return None  # there is no first row to continue
        if isinstance(self.design.built.graph, Diagnostic):
            return None  # nothing is solved of what is not driven: a cam, or mobility
        session, start = first_assembly(self.design.session)
        if start.state is None or session.size is None:
            return None
        return session, (start.state, start.row, session.size)

    def variation(self, names: Sequence[str]) -> SessionVariation | None:
        """How the design depends on some parameters; None where each variant is built by itself."""
        key = tuple(names)
        with self._lock:
            if key not in self._variations:
                self._variations[key] = self._recorded(key)
            return self._variations[key]

    def _recorded(self, names: tuple[str, ...]) -> SessionVariation | None:
        if self._assembled is None:
            return None
        try:
            return SessionVariation(*self._assembled, *record(self.design.built, names))
        except (TraceLost, TypeError, ValueError):
            # numpy refuses recorded numbers in words of its own
            return None

    def recording(self, values: Mapping[str, float]) -> Recording | None:
        """How the design depends on some parameters (SI) about these values: the recording of its
        own values or of others, where its guards hold, or a new one; None where no tape holds it.

        Raises:
            InvalidFile: a new one, of values with which the file has errors.
        """
        names = tuple(values)
        if not names:
            return None
        row = np.array(list(values.values()))
        with self._lock:
            if names not in self._recordings:
                own = self.variation(names)
                self._recordings[names] = [] if own is None else [own]
            kept = self._recordings[names]
            for one in kept:
                if one is not None and one.plan_constants(row) is not None:
                    return one
            if None in kept or len(kept) >= MOST_RECORDINGS:
                return None
            kept.append(self._recorded_at(names, values))
            return kept[-1]

    def _recorded_at(self, names: tuple[str, ...], values: Mapping[str, float]) -> Recording | None:
        own = self.design.session
        built = self.built(values)
        if isinstance(built.graph, Diagnostic):
            return None
        session = Session.of(
            built.problem, built.graph, closed_at=own.closed_at, packing=own.packing
        ).measured_in(own.layout.length)
        for motion in (True, False):
            # of laws of time no tape holds the rows
            with suppress(TraceLost, TypeError, ValueError):
                return Recording(session, *record(built, names, motion=motion), moves=motion)
        return None

    def response_variation(self, names: Sequence[str], run: str) -> SessionVariation | None:
        """How the first moment of a response depends on some parameters; None where each variant
        chooses its assembly by itself."""
        key = (run, *names)
        with self._lock:
            if key not in self._responses:
                self._responses[key] = self._recorded_response(tuple(names), run)
            return self._responses[key]

    def _recorded_response(self, names: tuple[str, ...], run: str) -> SessionVariation | None:
        session, start = first_assembly(self.design.session_of(run))
        if start.state is None or session.size is None:
            return None
        first = (start.state, start.row, session.size)
        try:
            return SessionVariation(session, first, *record_response(self.design.built, names, run))
        except (TraceLost, TypeError, ValueError):
            return None

    def built(self, values: Mapping[str, float]) -> Built:
        """The file with other parameters (SI), by the ordinary path.

        Raises:
            InvalidFile: with every independent error.
        """
        built = self.design.built
        return build(built.file, built.document, self.given(values), built.problem.stopped)

    def given(self, values: Mapping[str, float]) -> dict[str, Quantity]:
        """Parameters by their values in SI, as `Design.given`."""
        known = self.design.problem.parameters
        return {name: Quantity(v, known[name].dimension) for name, v in values.items()}


def base_of(design: Design) -> Base:
    """What the variants of a design share with those of all others of its file."""
    return design.base if isinstance(design, VariedDesign) else _own_base(design)


@remembered
def _own_base(design: Design) -> Base:
    return Base(design)


class _Line(Between):
    """What lies between a file's own parameters and others on the straight line in them."""

    def __init__(
        self,
        base: Base,
        values: Mapping[str, float],
        make: Callable[[Session], Problem] | None = None,
    ) -> None:
        super().__init__(self._session)
        known = base.design.problem.parameters
        self.base, self.values, self.make = base, values, make
        self.own = {name: float(known[name].value) for name in values}  # type: ignore[arg-type]

    def _values(self, place: float) -> dict[str, float]:
        return {
            name: start + place * (self.values[name] - start) for name, start in self.own.items()
        }

    def derived(self, make: Callable[[Session], Problem]) -> Between:
        """As `Between.derived`."""
        return super().derived(make) if self.make else _Line(self.base, self.values, make)

    def _session(self, place: float) -> Session:
        session = self._whole(place)
        return session.derived(self.make) if self.make else session

    def _whole(self, place: float) -> Session:
        values = self._values(place)
        recording = self.base.recording(values)
        if recording is not None and recording.moves:
            row = np.array(list(values.values()))
            if recording.verdicts(row[:, None])[0] != Verdict.OTHER_WAY:
                problem = recording.problem(row)
                graph = graph_as_built(problem, self.base.design.built.problem.stopped)
                if graph is not None:
                    return Session.of(problem, graph)
        built = self.base.built(values)
        if isinstance(built.graph, Diagnostic):
            raise InvalidFile([*built.problem.diagnostics, built.graph])
        return Session.of(built.problem, built.graph)

    def plan(self, place: float, structure: object, length: float) -> Plan:
        """As `Between.plan`; by a replay where a recording holds, as in every continuation of
        variants."""
        values = self._values(place)
        if not values:  # the file's own, wherever on the line
            own = self.base.design.session
            return (own.derived(self.make) if self.make else own).measured_in(length).structure.plan
        recording = self._recording(values, length)
        if recording is not None and structure_of(recording.base.graph) == structure:
            constants = recording.plan_constants(np.array(list(values.values())))
            if constants is not None:
                return recording.base.structure.plan.with_constants(constants)
        return super().plan(place, structure, length)

    def _recording(self, values: Mapping[str, float], length: float) -> Recording | None:
        recording = self.base.recording(values)
        if recording is None or self.make is None:
            return recording
        try:
            return recording.part(self.make, length)
        except (TraceLost, TypeError, ValueError):
            return None


class VariedDesign(Design):
    """A design with other values of some parameters.

    Args:
        base: of the design as its file has it.
        values: by name, in SI.
        warned: whether the file's warnings on these values are asked for.
    """

    def __init__(self, base: Base, values: Mapping[str, float], *, warned: bool = True) -> None:
        known = base.design.problem.parameters
        variation = base.variation(tuple(values))
        if variation is None:
            # what has the file's own value need not be named, and may be what no tape holds
            values = {name: v for name, v in values.items() if v != known[name].value}
            variation = base.variation(tuple(values)) if values else None
        self.base, self._values = base, dict(values)
        self._at_starts: dict[str, Session] = {}
        self._row = np.array(list(values.values()))
        verdict = Verdict.OTHER_WAY
        if variation is not None:
            verdict = variation.verdicts(self._row[:, None])[0]
        self._variation = None if verdict == Verdict.OTHER_WAY else variation
        self._recording: Recording | None = self._variation
        self._graph: SolverGraph | None = None
        self._motion: MotionInputs | None = None
        if self._recording is None:
            verdict = self._record_again()
        self._advised = warned and verdict == Verdict.OTHER_ADVICE
        anew = self._recording is None and self._values
        built = base.built(values) if anew else base.design.built
        super().__init__(built, base.design.stem, base.given(values))

    def _record_again(self) -> Verdict:
        """Takes the recording of other values that holds with these, and the graph."""
        design = self.base.design
        if isinstance(design.built.graph, Diagnostic):
            return Verdict.OTHER_WAY
        recording = self.base.recording(self._values)
        if recording is None:
            return Verdict.OTHER_WAY
        verdict = Verdict(recording.verdicts(self._row[:, None])[0])
        if verdict == Verdict.OTHER_WAY:  # other rows
            return verdict
        problem = recording.problem(self._row)
        if not recording.moves:
            given = self.base.given(self._values)
            self._motion = motion_as_built(design.built, problem, given)
            if self._motion is None:
                return Verdict.OTHER_WAY
            problem = replace(problem, motion=self._motion)
        self._graph = graph_as_built(problem, design.built.problem.stopped)
        if self._graph is None:
            return Verdict.OTHER_WAY
        self._recording = recording
        # a warning may name numbers of the values that were recorded
        warnings = recording.base.problem.diagnostics
        return verdict if warnings == design.problem.diagnostics else Verdict.OTHER_ADVICE

    @property
    def values(self) -> Mapping[str, float]:
        """The parameters that were set, by name, in SI."""
        return self._values

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as the file's design and the values."""
        return _revaried, (self.base.design, self._values)

    @cached_property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        if self._recording is None:
            return self.built.problem
        problem = self._recording.problem(self._row)
        if self._motion is not None:
            problem = replace(problem, motion=self._motion)
            problem = problem.with_quantities_of(self.base.design.problem)
        if self._advised:
            fresh = self.base.built(self._values).problem
            problem = replace(problem, diagnostics=fresh.diagnostics)
        elif problem.diagnostics != self.base.design.problem.diagnostics:
            problem = replace(problem, diagnostics=self.base.design.problem.diagnostics)
        return problem

    @cached_property
    def session(self) -> Session:
        """The mechanism in the kernel."""
        if self._variation is None:
            base = self.base.design.session
            graph = self._graph or self.graph
            own = Session.of(self.problem, graph, closed_at=base.closed_at, packing=base.packing)
            line = _Line(self.base, self._values)
            return own.continuing(base, line).reading(lambda: self.precise)
        varied = varied_session(self._variation, self._row, self.problem)
        if varied.first is not None and varied.first.state is None:
            # the branch ends on the way: the same structure, or another problem?
            own_graph = graph_as_built(self.problem, self.base.design.built.problem.stopped)
            if own_graph is not None and structure_of(own_graph) == structure_of(varied.graph):
                return varied.reading(lambda: self.precise)
            fresh = self.base.built(self._values)
            if isinstance(fresh.graph, Diagnostic):
                raise InvalidFile([*fresh.problem.diagnostics, fresh.graph])
            if structure_of(fresh.graph) != structure_of(varied.graph):
                return Session.of(fresh.problem, fresh.graph)
        return varied.reading(lambda: self.precise)

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks."""
        return super().graph if self._recording is None else self.session.graph

    @cached_property
    def at_responses(self) -> Design:
        """The same design built from the file."""
        built = self.built if self._recording is None else self.base.built(self._values)
        return Design(built, self.stem, self.given)

    def session_of(self, run: str) -> Session:
        """As `Design.session_of`; the first assembly of a response, too, is continued from that of
        the file's own parameters."""
        if run == SWEEP:
            return self.session
        if run not in self._at_starts:
            self._at_starts[run] = self._at_start(run)
        return self._at_starts[run]

    def _at_start(self, run: str) -> Session:
        known = self.base.design.problem.parameters
        changed = {name: v for name, v in self._values.items() if v != known[name].value}
        own = self.at_responses.session_of(run)
        for values in (self._values, changed):
            # what has the file's own value need not be named, and may be what no tape holds
            variation = self.base.response_variation(tuple(values), run) if values else None
            if variation is not None:
                return varied_response(variation, np.array(list(values.values())), own) or own
        return own

    @property
    def view_settings(self) -> ViewSettings:
        """As `Design.view_settings`; its lengths are those of these parameters."""
        return super().view_settings if self.built.view is None else self.at_responses.view_settings


def _revaried(design: Design, values: Mapping[str, float]) -> Design:
    """A design with the values that another had."""
    return VariedDesign(base_of(design), values) if values else design


def varied_design(design: Design, parameters: Mapping[str, Any]) -> Design:
    """The design with other values of some parameters; values that were set before stay unless
    they are given again."""
    base = base_of(design)
    known = base.design.problem
    values = {**design.values, **parameter_values(known, parameters)}
    if not parameters or not values:
        return design
    return VariedDesign(base, {name: values[name] for name in known.parameters if name in values})


def with_parameters(model: Solvable, parameters: Mapping[str, Any]) -> Solvable:
    """`Model.with_parameters`, whose arguments and errors these are."""
    design = varied_design(model.design, parameters)
    return model if design is model.design else model.of(design)


def file_values(values: Floats, problem: Problem, names: Sequence[str]) -> dict[str, Floats]:
    """Parameters (parameters, variants) in the file's units, by name."""
    known = problem.parameters
    return {
        name: np.asarray(problem.units.from_si(row, known[name].dimension), dtype=np.float64)
        for name, row in zip(names, values, strict=True)
    }


Method = Literal["random", "latin", "sobol"]

BLOCK = 4096
"""Independent samples that come from one generator."""

_INSIDE = (2.0**-54, 1.0 - 2.0**-53)
"""Between these, so that a normal distribution gives a finite value."""


Draws = Callable[[int, int], "Floats"]
"""Samples `begin` to `end` (without it), (samples, dimensions), between 0 and 1."""


def needs_scipy(method: Method, distributions: Iterable[object]) -> bool:
    """Whether something is drawn that numpy does not draw."""
    normals = any(isinstance(one, partial) and one.func is normal for one in distributions)
    return method != "random" or normals


def has_scipy() -> bool:
    """Whether scipy is installed, which is optional."""
    try:
        import scipy.special  # noqa: F401
    except ImportError:
        return False
    return True


def draws(method: Method, count: int, dimensions: int, seed: int) -> Draws:
    """The samples of a method; `random` ones do not depend on how many there are.

    `latin`: a Latin hypercube (McKay, Beckman, Conover 1979), one sample in each of `count` slices
    of every dimension, drawn whole. `sobol`: a scrambled Sobol sequence (Owen 1998).
    """
    if method == "random":
        return partial(_random, dimensions, seed)
    if method == "sobol":
        return partial(_sobol, dimensions, seed)
    from scipy.stats import qmc

    points = _inside(_seeded(qmc.LatinHypercube, dimensions, seed).random(count))
    return lambda begin, end: points[begin:end]


def _random(dimensions: int, seed: int, begin: int, end: int) -> Floats:
    first, last = begin // BLOCK, -(-end // BLOCK)
    blocks = [np.empty((0, dimensions))]
    for number in range(first, last):  # a generator for each block
        sequence = np.random.SeedSequence([seed, number])
        blocks.append(np.random.Generator(np.random.Philox(sequence)).random((BLOCK, dimensions)))
    return _inside(np.concatenate(blocks)[begin - first * BLOCK : end - first * BLOCK])


def _sobol(dimensions: int, seed: int, begin: int, end: int) -> Floats:
    from scipy.stats import qmc

    engine = _seeded(qmc.Sobol, dimensions, seed)
    if begin:
        engine.fast_forward(begin)
    with warnings.catch_warnings():
        # of a stretch, which need not be balanced
        warnings.simplefilter("ignore", UserWarning)
        return _inside(engine.random(end - begin))


def _seeded(engine: Any, dimensions: int, seed: int) -> Any:
    """An engine of scipy; older ones call the generator's argument `seed`."""
    try:
        return engine(dimensions, rng=seed)
    except TypeError:
        return engine(dimensions, seed=seed)


def _inside(values: Floats) -> Floats:
    return np.clip(values, *_INSIDE)


def uniform(samples: Floats, least: float, most: float) -> Floats:
    """Samples (n,) to values evenly between two."""
    return least + samples * (most - least)


def normal(samples: Floats, mean: float, deviation: float) -> Floats:
    """Samples (n,) to values of a normal distribution."""
    from scipy.special import ndtri

    return np.asarray(mean + deviation * ndtri(samples))
