"""Many variants of a model at once: `Model.vary`.

In reading order: reductions over the rows; the run, by chunks through the kernel, and one variant
at a time where the kernel's run does not do; the results, and the call.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances, variants
from mechkin_cli.arguments import a_text, a_whole_number, shown, texts
from mechkin_cli.diagnostics import LONGEST_NAME, MechkinError, UsageError
from mechkin_cli.expressions import Expression, ExpressionError, Quantity, UnknownName, Vector
from mechkin_cli.kernel._kernel import VariantEnd
from mechkin_cli.kernel.functions import check_threads, check_width, threads_for
from mechkin_cli.mechanism import (
    BEARING_KINDS,
    DERIVED_KINDS,
    bearing_load,
    find_legs,
    friction_states,
    read_for,
)
from mechkin_cli.model import response_name
from mechkin_cli.plan import WRENCH_KINDS, Demand, demand_of
from mechkin_cli.session import input_rest
from mechkin_cli.show import Bools, Floats
from mechkin_cli.sweep import has_turns
from mechkin_cli.tables import (
    OVER_THE_WAY,
    REDUCTIONS,
    ROW_TEXTS,
    Reduction,
    mean,
    root_mean_square,
)
from mechkin_cli.tolerances import MOST_KEPT
from mechkin_cli.variants.model import Base, VariedModel, file_values, parameter_arrays
from mechkin_cli.variants.variation import Runs, SessionVariation, VariantReadout, run_variants
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Problem, Wanted
    from mechkin_cli.session import Session


Reductions = tuple[Reduction, ...] | Reduction | None
"""Several, one, or none: all rows."""


def need_places(reductions: Mapping[str, Reductions]) -> bool:
    """Whether one of them is taken over what the run goes along."""
    own = (each if isinstance(each, tuple) else (each,) for each in reductions.values())
    return any(one in OVER_THE_WAY for several in own for one in several)


def reduced(
    text: str, values: Floats, reduction: Reductions, places: Floats | None = None
) -> Floats:
    """Reduces (variants, rows) or (variants, rows, components), the reductions last where there are
    several.

    Args:
        text: names the values in messages.
        places: of the rows (variants, rows); None where nothing moves.

    Raises:
        UsageError: a function of the caller fails, or gives something else.
    """
    if reduction is None:
        return values
    if isinstance(reduction, tuple):
        return np.stack([_by(each, text, values, places) for each in reduction], axis=-1)
    return _by(reduction, text, values, places)


def _by(reduction: Reduction, text: str, values: Floats, places: Floats | None) -> Floats:
    if values.ndim == 3:
        parts = [_by(reduction, text, c, places) for c in np.moveaxis(values, 2, 0)]
        return np.stack(parts, axis=1)
    if reduction is mean or reduction is root_mean_square:
        return reduction(values, places)
    view = values.view()
    view.flags.writeable = False  # the next reduction reads the same
    try:
        result = np.asarray(reduction(view), dtype=np.float64)
    except Exception as error:
        raise UsageError(
            f"the reduction of {text} failed with {type(error).__name__}: "
            f"{str(error)[:LONGEST_NAME]}; it takes (variants, rows) = {values.shape}"
        ) from error
    if result.shape[:1] != values.shape[:1]:
        raise UsageError(
            f"the reduction of {text} gives an array of shape {result.shape}; it takes "
            f"(variants, rows) = {values.shape} and gives one value a variant"
        )
    return result


def swept_parameter(problem: Problem) -> tuple[str, Floats] | None:
    """The name of time where the sweep has one, else of its first input that moves, and its values
    over the rows (rows,) in the file's units as written; None where nothing moves."""
    motion = problem.motion
    if motion.time is not None:
        return "time", motion.time.written
    for driven in motion.inputs:
        if np.ptp(driven.written) > 0.0:
            return driven.name, driven.written
    return None


CHUNK_NUMBERS = 2_000_000
"""Numbers that a chunk of variants holds at most: memory stays flat."""


def sample_of(problem: Problem) -> Any:
    """A resolver of names to one-row stand-ins of the right dimension."""

    def resolve(name: str) -> Quantity:
        one = np.ones(1)
        if name in problem.parameters:
            return Quantity(one, problem.parameters[name].dimension)
        known = problem.quantities()
        if name not in known:
            raise UnknownName(name, [*problem.parameters, *known])
        wanted = known[name]
        return Quantity(wanted.value([one] * 3), wanted.dimension)

    return resolve


REST = " within a turn"
"""Suffix of the names of angles without whole turns."""

PERIODIC = re.compile(r"\b(?:wrap|sin|cos|tan)\s*\(")
"""Functions to which whole turns of an angle do not matter."""


class VariantRun:
    """One call of `vary`."""

    def __init__(
        self,
        base: Base,
        names: tuple[str, ...],
        asked: Mapping[str, Expression],
        reductions: Mapping[str, Reductions],
        lanes: int,
        threads: int,
    ) -> None:
        self.base, self.names, self.asked, self.reductions = base, names, asked, reductions
        self.texts = tuple(asked)
        self.lanes, self.threads = lanes, threads
        self.problem = base.model.problem
        swept = swept_parameter(self.problem) if need_places(reductions) else None
        self.along = None if swept is None else swept[0]
        if self.along is not None and self.along not in asked:
            parse = self.problem.definitions.parse
            self.asked = {**asked, self.along: parse(self.along)}
        self.rows = self.problem.motion.rows
        known = self.problem.quantities()
        used = (name for expression in self.asked.values() for name in sorted(expression.names))
        own = (name for name in map(self._quantity_of, used) if name is not None)
        self.read = tuple(read_for(own, known))
        self.wanted = tuple(known[name] for name in self.read)
        self.errors: dict[int, MechkinError] = {}

    def _quantity_of(self, name: str) -> str | None:
        if name in self.problem.parameters:
            return None
        return name if name in self.problem.quantities() else name.rpartition(".")[0]

    def run(
        self, values: Floats
    ) -> tuple[dict[str, Floats], NDArray[np.int8], dict[int, MechkinError]]:
        """All variants, chunk by chunk: what was asked for, the verdicts, the errors."""
        count = values.shape[1]
        codes = np.empty((count, self.rows), dtype=np.int8)
        parts: dict[str, list[Floats]] = {text: [] for text in self.texts}
        variation = self.base.variation(self.names)
        native = self._native(variation) if variation is not None else None
        chunk = self._chunk()
        for begin in range(0, max(count, 1), chunk):
            part = values[:, begin : begin + chunk]
            for text, array in self._chunk_values(variation, native, part, begin, codes).items():
                parts[text].append(array)
        return {text: np.concatenate(arrays) for text, arrays in parts.items()}, codes, self.errors

    def numbers_returned(self) -> int:
        """Numbers that come back of a variant: parameters, verdicts, what was asked for."""
        count = len(self.names) + -(-self.rows // 8)
        for text in self.texts:
            value = self.asked[text].evaluate(sample_of(self.problem), self.problem.units).value
            width = len(value.components) if isinstance(value, Vector) else 1
            reduction = self.reductions[text]
            each = len(reduction) if isinstance(reduction, tuple) else 1
            count += width * (self.rows if reduction is None else each)
        return count

    def _chunk(self) -> int:
        width = 2 + sum(3 if quantity.vector else 1 for quantity in self.wanted)
        return max(1, CHUNK_NUMBERS // (self.rows * width))

    def _native(self, variation: SessionVariation) -> tuple[VariantReadout, Any] | None:
        """The kernel's variants of what is read; None where the rows take more than its run."""
        problem = self.problem
        inputs = {driven.name for driven in problem.motion.inputs}
        inputs |= {name for driven in problem.motion.inputs for name in driven.orders}
        session = variation.base
        if (
            any(q.kind in DERIVED_KINDS or q.kind == "power_error" for q in self.wanted)
            or (session.is_redundant and any(q.kind in WRENCH_KINDS for q in self.wanted))
            or self._friction_takes_more(session)
            or (variation.moving_inputs and inputs & {q.name for q in self.wanted})
        ):
            return None
        reading = variation.reading(self._computed())
        demand = demand_of(problem.mechanism, self._computed())
        if session.graph.blocks:
            demand |= Demand.CONDITION
        return reading, reading.runs(demand, self.base.start)

    def _friction_takes_more(self, session: Session) -> bool:
        """Whether friction may go by reactions that are arbitrary, or drive an idle freedom."""
        mechanism = self.problem.mechanism
        if not (mechanism.frictions and demand_of(mechanism, self.wanted) & Demand.FORCES):
            return False
        return bool(session.is_redundant or find_legs(mechanism) or self.problem.held)

    def _computed(self) -> list[Wanted]:
        """What the kernel computes: no verdicts but on friction, and no inputs."""
        inputs = self.prescribed()
        computed = [q for q in self.wanted if q.owner != "row" and q.name not in inputs]
        if demand_of(self.problem.mechanism, computed) & Demand.FORCES:
            computed += friction_states(self.problem.mechanism)
        if any(map(PERIODIC.search, self.asked)):
            # angles within a turn, which the kernel gives before it adds whole turns
            computed += [q._replace(name=q.name + REST) for q in computed if has_turns(q)]
        return computed

    def prescribed(self) -> dict[str, Floats]:
        """Time, inputs and their rates over the rows, in SI."""
        motion = self.problem.motion
        values = {} if motion.time is None else {"time": motion.time.values}
        for driven in motion.inputs:
            values |= {name: in_si for name, (in_si, _) in driven.orders.items()}
        return values

    def _chunk_values(
        self,
        variation: SessionVariation | None,
        native: tuple[VariantReadout, Any] | None,
        values: Floats,
        begin: int,
        codes: NDArray[np.int8],
    ) -> dict[str, Floats]:
        count = values.shape[1]
        if native is None or variation is None:
            found = {t: self._empty(e, count) for t, e in self.asked.items()}
            alone = np.arange(count)
        else:
            reading, kernel = native
            threads = threads_for(count * self.rows, self.threads)
            runs = run_variants(kernel, values, self.lanes, threads)
            frictions = friction_states(self.problem.mechanism)
            states = [reading.slots[q.name].first for q in frictions if q.name in reading.slots]
            codes[begin : begin + count] = _verdicts(runs, states)
            found = self._evaluated(variation, reading, runs, values, codes[begin : begin + count])
            # what may stand at a dead centre is judged as in a run of its own
            alone = np.flatnonzero((runs.end != int(VariantEnd.COMPLETE)) | _doubtful(runs))
        for number in alone:
            self._alone(values[:, number], int(begin + number), int(number), found, codes)
        places = None if self.along is None else found[self.along]
        return {t: reduced(t, found[t], self.reductions[t], places) for t in self.texts}

    def _evaluated(
        self,
        variation: SessionVariation,
        reading: VariantReadout,
        runs: Runs,
        values: Floats,
        codes: NDArray[np.int8],
    ) -> dict[str, Floats]:
        """The expressions in the file's units, (variants, rows) or (variants, rows, 3)."""
        units, count = self.problem.units, values.shape[1]
        resolve = _Resolver(self, variation, reading, runs, values, codes)
        found = {}
        for text, expression in self.asked.items():
            written = self._written(text)
            if written is not None:
                found[text] = np.broadcast_to(written, (count, self.rows))
                continue
            result = expression.evaluate(resolve, units)
            value = result.value
            columns = []
            for part in value.components if isinstance(value, Vector) else (value,):
                in_si = np.array(np.broadcast_to(part, (count * self.rows,)))
                in_units = np.asarray(units.from_si(in_si, result.dimension))
                columns.append(in_units.reshape(count, self.rows))
            found[text] = np.stack(columns, axis=2) if len(columns) > 1 else columns[0]
        return found

    def _written(self, text: str) -> Floats | None:
        """An input's values, or time, exactly as written."""
        motion = self.problem.motion
        if text == "time" and motion.time is not None:
            return motion.time.written
        for driven in motion.inputs:
            if text == driven.name:
                return driven.written
        return None

    def _alone(
        self,
        values: Floats,
        number: int,
        place: int,
        found: dict[str, Floats],
        codes: NDArray[np.int8],
    ) -> None:
        """One variant as `with_parameters(...).analyze()` gives it."""
        named = dict(zip(self.names, values.tolist(), strict=True))
        for text in self.asked:
            if not found[text].flags.writeable:
                found[text] = found[text].copy()
        try:
            model = VariedModel(self.base, named)
            analysis = model.analyze(self.read, tables=[], lanes=self.lanes)
            if analysis.rows != self.rows:
                raise UsageError(
                    f"variant {number} has {analysis.rows} rows, the file has {self.rows}; vary "
                    "parameters that keep their number, or take with_parameters for each"
                )
            codes[number] = analysis.result.status
            for text in self.asked:
                found[text][place] = analysis[text]
        except MechkinError as error:
            self.errors[number] = error
            codes[number] = int(Status.not_assembled)
            for text in self.asked:
                found[text][place] = np.nan

    def _empty(self, expression: Expression, count: int) -> Floats:
        value = expression.evaluate(sample_of(self.problem), self.problem.units).value
        width = (len(value.components),) if isinstance(value, Vector) else ()
        return np.full((count, self.rows, *width), np.nan)


class _Resolver:
    """Names of expressions over a chunk: (variants * rows,) in SI."""

    def __init__(
        self,
        run: VariantRun,
        variation: SessionVariation,
        reading: VariantReadout,
        runs: Runs,
        values: Floats,
        codes: NDArray[np.int8],
    ) -> None:
        self.run, self.reading, self.runs = run, reading, runs
        self.count, self.rows = values.shape[1], run.rows
        self.known = run.problem.quantities()
        self.prescribed = run.prescribed()
        self.unclear = codes == int(Status.rank_unclear)
        self.solved = runs.end == int(VariantEnd.COMPLETE)
        parameters = variation.parameters(values)
        self.parameters = dict(zip(run.problem.parameters, parameters, strict=True))

    def __call__(self, name: str) -> Quantity:
        if name in self.parameters:
            dimension = self.run.problem.parameters[name].dimension
            return Quantity(np.repeat(self.parameters[name], self.rows), dimension)
        if name not in self.known:
            raise UnknownName(name, list(self.known))
        wanted = self.known[name]
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self)
        if wanted.owner == "row" and name != "time":
            array = self.runs.residual if wanted.kind == "residual" else self.runs.condition
            return Quantity(array.reshape(-1), wanted.dimension)
        if name in self.prescribed:
            rest = input_rest(self.reading.variation.base, name)
            if rest is not None:
                rest = np.broadcast_to(rest, (self.count, self.rows)).reshape(-1)
            return Quantity(self._over_rows(name), wanted.dimension, rest)
        slot = self.reading.slots[name]
        columns = [self._column(wanted, slot.first + k) for k in range(slot.width)]
        if wanted.vector:
            return Quantity(wanted.value(columns), wanted.dimension)
        place = self.reading.slots.get(name + REST)
        within = None if place is None else self._column(wanted, place.first)
        return Quantity(columns[0], wanted.dimension, within)

    def _over_rows(self, name: str) -> Floats:
        rows = np.broadcast_to(self.prescribed[name], (self.count, self.rows))
        values = {driven.name for driven in self.run.problem.motion.inputs} | {"time"}
        if name not in values:
            rows = np.where(self.solved[:, None], rows, np.nan)
        return rows.reshape(-1)

    def _column(self, wanted: Wanted, slot: int) -> Floats:
        column = self.runs.outputs[:, slot, :]
        if self.unclear.any() and demand_of(self.run.problem.mechanism, [wanted]):
            column = np.where(self.unclear, np.nan, column)
        return column.reshape(-1)


def _verdicts(runs: Runs, states: Sequence[int] = ()) -> NDArray[np.int8]:
    """Codes of `Status` (variants, rows) of those that are complete; others are not read.

    `states` are the slots of friction's states, zero where there is an answer.
    """
    codes = np.full(runs.condition.shape, int(Status.ok), dtype=np.int8)
    if not np.isnan(runs.condition).all():
        codes[~(runs.condition <= tolerances.CONDITION_NEAR_SINGULAR)] = int(Status.near_singular)
        codes[~(runs.condition <= tolerances.CONDITION_RANK_UNCLEAR)] = int(Status.rank_unclear)
    for slot in states:
        undecided = ~(runs.outputs[:, slot, :] == 0.0) & (codes != int(Status.rank_unclear))
        codes[undecided] = int(Status.friction_undecided)
    return codes


def _doubtful(runs: Runs) -> Bools:
    """Variants (variants,) with a row whose rates may be rounding."""
    if np.isnan(runs.condition).all():
        return np.zeros(len(runs.condition), dtype=bool)
    return np.asarray((~(runs.condition <= tolerances.CONDITION_RATES_UNCLEAR)).any(axis=1))


LONGEST_MESSAGE = 400
"""Characters of an expression's error that a message repeats."""

Reduce = str | Callable[["Floats"], "Floats"]


class Variants:
    """Results of `Model.vary`: `r["O4.theta"]` is an array over the variants, in the file's units.

    Attributes:
        parameters: (variants,) of every parameter that varies, in the file's units.
        errors: of variants that cannot be built, by their number.
    """

    def __init__(
        self,
        parameters: Mapping[str, Floats],
        values: Mapping[str, Floats],
        codes: NDArray[np.int8],
        errors: Mapping[int, MechkinError],
    ) -> None:
        self.parameters = parameters
        self.errors = errors
        self._values = values
        self._codes = codes

    def __len__(self) -> int:
        return len(self._codes)

    def __getitem__(self, text: str) -> Floats:
        """A quantity or expression that was asked for.

        Returns (variants, rows), of a vector (variants, rows, 3), nan where a row has no solution;
        where it was reduced without the rows, and with several reductions they come last.

        Raises:
            UsageError: it was not asked for.
        """
        if a_text("a quantity or expression", text, '"O4.theta"') not in self._values:
            asked = ", ".join(self._values)
            raise UsageError(f"{text[:LONGEST_NAME]} was not asked for; quantities are {asked}")
        return self._values[text]

    @property
    def codes(self) -> NDArray[np.int8]:
        """The verdict of every variant and row, codes of `Status` (variants, rows)."""
        return self._codes

    @cached_property
    def status(self) -> NDArray[np.str_]:
        """The verdict of every variant and row, in words (variants, rows)."""
        return np.array([status.label for status in Status])[self._codes]

    @property
    def complete(self) -> NDArray[np.bool_]:
        """Which variants have a position in every row (variants,), as `Analysis.complete`.

        A row at a dead centre has one: see `status`; what has no bound there is infinite.
        """
        solved = np.array([status.has_solution for status in Status])
        return np.asarray(np.logical_and.reduce(solved[self._codes], axis=1))


def vary(
    base: Base,
    held: Mapping[str, float],
    parameters: Mapping[str, Any],
    quantities: Iterable[str] | None,
    reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None,
    run: str,
    lanes: int,
    threads: int,
) -> Variants:
    """`Model.vary`, whose arguments these are; `held` are values (SI) that are set already."""
    if a_text("run", run, f'"{SWEEP}"') != SWEEP:
        name = response_name(base.model, run)
        return variants.vary_response(
            base, held, parameters, quantities, reduce, name, lanes, threads
        )
    lanes = a_whole_number("lanes", lanes, "rows at a time")
    threads = a_whole_number("threads", threads, "threads")
    check_width(lanes)
    check_threads(threads)
    if SWEEP not in base.model.runs:
        raise UsageError(
            f"{base.model.name} has no sweep to vary; vary a response one by one: "
            f'with_parameters({{...}}).respond("{base.model.runs[0]}")'
        )
    problem = base.model.problem
    varied, names, values = varied_parameters(problem, parameters, held)
    asked = expressions_of(quantities, problem)
    call = VariantRun(base, names, asked, reductions_of(asked, reduce), lanes, threads)
    numbers = values.shape[1] * call.numbers_returned()
    if numbers > MOST_KEPT:
        raise UsageError(
            f"the results of {values.shape[1]} variants are {numbers} numbers (limit {MOST_KEPT}); "
            "ask for less, reduce over the rows, or take fewer variants at a time"
        )
    return Variants(varied, *call.run(values))


def varied_parameters(
    problem: Problem, parameters: Mapping[str, Any], held: Mapping[str, float]
) -> tuple[dict[str, Floats], tuple[str, ...], Floats]:
    """Values (variants,) of what varies by name, in the file's units; and all that is set, `held`
    values (SI) included: names in the file's order and values (parameters, variants) in SI."""
    names, values = parameter_arrays(problem, parameters)
    varied = file_values(values, problem, names)
    rows = {name: np.full(values.shape[1], value) for name, value in held.items()}
    rows |= dict(zip(names, values, strict=True))
    names = tuple(name for name in problem.parameters if name in rows)
    return varied, names, np.stack([rows[name] for name in names])


def expressions_of(quantities: Iterable[str] | None, problem: Problem) -> dict[str, Expression]:
    """Quantities and expressions by their text; None: all coordinates.

    Raises:
        UsageError: no such quantity, or a text.
    """
    if quantities is None:
        quantities = problem.mechanism.coordinates
    found = {}
    for text in texts("quantities", quantities, '["O4.theta"]'):
        if text.strip() in ROW_TEXTS:
            raise UsageError(f"{text} is a text, no number; read .status of the result")
        try:
            found[text] = problem.definitions.parse(text)
            found[text].evaluate(sample_of(problem), problem.units)
        except ExpressionError as error:
            hint = error.hint or "write an expression of quantities and parameters"
            shortened = text[:LONGEST_NAME]
            raise UsageError(f"{shortened}: {error.message[:LONGEST_MESSAGE]}; {hint}") from None
    return found


def reductions_of(asked: Iterable[str], reduce: Any) -> dict[str, Reductions]:
    """What is done with each quantity.

    Raises:
        UsageError: no such reduction.
    """
    if isinstance(reduce, Mapping):
        for text in reduce:
            if text not in asked:
                asked_for = ", ".join(asked)
                raise UsageError(
                    f"reduce: {shown(text)} was not asked for; quantities are {asked_for}"
                )
        return {text: _reduction(reduce.get(text)) for text in asked}
    return dict.fromkeys(asked, _reduction(reduce))


def _reduction(reduce: Any) -> Reductions:
    if reduce is None:
        return None
    if isinstance(reduce, str):
        if reduce not in REDUCTIONS:
            known = ", ".join(REDUCTIONS)
            raise UsageError(f"there is no reduction {reduce[:LONGEST_NAME]}; they are {known}")
        return REDUCTIONS[reduce]
    if callable(reduce):
        return reduce  # type: ignore[no-any-return]
    if isinstance(reduce, Sequence) and reduce:
        return tuple(_reduction(each) for each in reduce)  # type: ignore[misc]
    known = ", ".join(REDUCTIONS)
    raise UsageError(
        f"reduce: expected one of {known}, a function, several of these or a mapping by quantity, "
        f"not {shown(reduce)}"
    )
