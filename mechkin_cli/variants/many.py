"""Many variants of a run at once.

Of a sweep: chunks through the kernel, what takes more one at a time (`_SweepRun`). Of a response:
each is built as `with_parameters` builds it, and those of one structure are integrated together,
several to a pack of the kernel's lanes (`_ResponseRun`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis import Analysis, Solvable, a_packing, run_name
from mechkin_cli.arguments import a_text
from mechkin_cli.building import without_collection
from mechkin_cli.diagnostics import MechkinError, UsageError
from mechkin_cli.expressions import Expression, Quantity, UnknownName, Vector
from mechkin_cli.kernel._kernel import VariantEnd
from mechkin_cli.kernel.functions import threads_for
from mechkin_cli.mechanism import (
    BEARING_KINDS,
    DERIVED_KINDS,
    bearing_load,
    friction_states,
    read_for,
    response_problem,
)
from mechkin_cli.plan import REACTION_KINDS, Demand, demand_of
from mechkin_cli.response import integrated, prepare, read
from mechkin_cli.session import Packing, input_rest
from mechkin_cli.show import Bools, Floats
from mechkin_cli.statics import balanced
from mechkin_cli.sweep import has_turns, is_slack, limited, slack_quantities
from mechkin_cli.tolerances import MOST_KEPT
from mechkin_cli.variants.design import Base, VariedDesign, base_of
from mechkin_cli.variants.result import (
    Reduce,
    Reductions,
    Variants,
    Verdicts,
    expressions_of,
    need_places,
    read_by,
    reduced,
    reductions_of,
    sample_of,
    swept_parameter,
    varied_parameters,
)
from mechkin_cli.variants.variation import Runs, SessionVariation, VariantReadout, run_variants
from mechkin_cli.verdict import SWEEP, Status, by_condition, has_forces, rates_are_clear

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.response import FreeResult, Prepared
    from mechkin_cli.session import Session


CHUNK_NUMBERS = 2_000_000
"""Numbers that a chunk of variants holds at most: memory stays flat."""


REST = " within a turn"
"""Suffix of the names of angles without whole turns."""

PERIODIC = re.compile(r"\b(?:wrap|sin|cos|tan)\s*\(")
"""Functions to which whole turns of an angle do not matter."""


class _SweepRun:
    """One call of `vary` for a sweep."""

    def __init__(
        self,
        model: Solvable,
        names: tuple[str, ...],
        asked: Mapping[str, Expression],
        reductions: Mapping[str, Reductions],
        packing: Packing,
    ) -> None:
        self.model, self.base, self.packing = model, base_of(model.design), packing
        self.names, self.asked, self.reductions = names, asked, reductions
        self.texts = tuple(asked)
        self.problem = self.base.design.problem
        swept = swept_parameter(self.problem) if need_places(reductions) else None
        self.along = None if swept is None else swept[0]
        if self.along is not None and self.along not in asked:
            parse = self.problem.definitions.parse
            self.asked = {**asked, self.along: parse(self.along)}
        self.rows = self.problem.motion.rows
        known = self.problem.quantities()
        self.read = tuple(read_for(read_by(self.asked.values(), known), known))
        self.wanted = tuple(known[name] for name in self.read)
        self.errors: dict[int, MechkinError] = {}

    def run(self, values: Floats) -> tuple[dict[str, Floats], Verdicts, dict[int, MechkinError]]:
        """All variants, chunk by chunk: what was asked for, the verdicts, the errors."""
        count = values.shape[1]
        verdicts = []
        parts: dict[str, list[Floats]] = {text: [] for text in self.texts}
        variation = self.base.variation(self.names)
        native = self._native_once(variation) if variation is not None else None
        chunk = self._chunk()
        for begin in range(0, max(count, 1), chunk):
            part = values[:, begin : begin + chunk]
            codes = np.empty((part.shape[1], self.rows), dtype=np.int8)
            for text, array in self._chunk_values(variation, native, part, begin, codes).items():
                parts[text].append(array)
            verdicts.append(Verdicts.of(codes))
        found = {}
        for text in self.texts:
            arrays = parts.pop(text)
            # what is the same in all variants is a view that nobody may write to
            whole = len(arrays) == 1 and arrays[0].flags.writeable
            found[text] = arrays[0] if whole else np.concatenate(arrays)
        return found, Verdicts.joined(verdicts), self.errors

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

    def _native_once(self, variation: SessionVariation) -> tuple[VariantReadout, Any] | None:
        """`_native`, found once for the pieces of a study."""
        memo, key = self.base.memo, (_SweepRun._native, self.names, tuple(self.asked))
        if key not in memo:
            memo[key] = self._native(variation)
        found: tuple[VariantReadout, Any] | None = memo[key]
        return found

    def _native(self, variation: SessionVariation) -> tuple[VariantReadout, Any] | None:
        """The kernel's variants of what is read; None where the rows take more than its run."""
        problem = self.problem
        session = variation.base
        if (
            problem.motion.rest is not None  # where it rests is found row by row
            or any(q.kind in DERIVED_KINDS or q.kind == "power_error" for q in self.wanted)
            or (session.is_redundant and any(q.kind in REACTION_KINDS for q in self.wanted))
            or self._forces_are_judged(session)
            or self._led_by_rates()
            or variation.moves_limits
            or self.problem.mechanism.has_arcs
        ):
            return None
        reading = variation.reading(self._computed())
        demand = demand_of(problem.mechanism, self._computed())
        if session.graph.blocks:
            demand |= Demand.CONDITION
        return reading, reading.runs(demand)

    def _forces_are_judged(self, session: Session) -> bool:
        """Whether forces rest on more than the kernel's run tells: constraints that may not hold
        the loads, or friction that goes by arbitrary reactions or drives an idle freedom."""
        if not demand_of(self.problem.mechanism, self.wanted) & Demand.FORCES:
            return False
        frictions = self.problem.mechanism.frictions
        return bool(
            self.problem.stopped or (frictions and (session.is_redundant or self.problem.has_idle))
        )

    def _led_by_rates(self) -> bool:
        """Whether forces go by the rates of inputs that others drive, which differ by rows."""
        forces = demand_of(self.problem.mechanism, self.wanted) & Demand.FORCES
        return bool(forces and self.problem.motion.constraints)

    def _read_or_judged(self) -> list[Wanted]:
        """What is asked for, and the coordinates whose limits judge the rows."""
        return list(dict.fromkeys((*self.wanted, *limited(self.problem))))

    def _computed(self) -> list[Wanted]:
        """What the kernel computes: no verdicts but on friction, and no inputs."""
        inputs = self._prescribed()
        every = self._read_or_judged()
        computed = [q for q in every if q.owner != "row" and q.name not in inputs]
        if demand_of(self.problem.mechanism, computed) & Demand.FORCES:
            computed += friction_states(self.problem.mechanism)
            computed += slack_quantities(self.problem)
        if any(map(PERIODIC.search, self.asked)):
            # angles within a turn, which the kernel gives before it adds whole turns
            computed += [q._replace(name=q.name + REST) for q in computed if has_turns(q)]
        return computed

    def _prescribed(self) -> set[str]:
        """Time, inputs and their rates."""
        motion = self.problem.motion
        names = {name for driven in motion.inputs for name in driven.orders}
        return names if motion.time is None else {"time", *names}

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
            threads = threads_for(count * self.rows, self.packing.threads)
            runs = run_variants(kernel, variation.inputs_of(values), self.packing.lanes, threads)
            frictions = friction_states(self.problem.mechanism)
            states = [reading.slots[q.name].start for q in frictions if q.name in reading.slots]
            strands = [q.name for q in slack_quantities(self.problem) if q.name in reading.slots]
            slots = [reading.slots[name].start for name in strands]
            codes[:] = _verdicts(runs, states, slots)
            self._judge_limits(_Resolver(self, variation, reading, runs, values, codes), codes)
            found = self._evaluated(variation, reading, runs, values, codes)
            # what may stand at a dead centre is judged as in a run of its own
            alone = np.flatnonzero((runs.end != int(VariantEnd.COMPLETE)) | _doubtful(runs))
        for number in alone:
            self._alone(values[:, number], int(begin + number), int(number), found, codes)
        places = None if self.along is None else found[self.along]
        return {t: reduced(t, found[t], self.reductions[t], places) for t in self.texts}

    def _judge_limits(self, resolve: _Resolver, codes: NDArray[np.int8]) -> None:
        """Gives the rows beyond limits of coordinates their status."""
        length = resolve.reading.variation.layout.length
        for wanted, limit in limited(self.problem).items():
            values = np.asarray(resolve(wanted.name).value).reshape(codes.shape)
            codes[(np.abs(limit.beyond(values, length)) > 0.0) & has_forces(codes)] = int(
                Status.beyond_limit
            )

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
            written = resolve.written(text)
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
        variation = self.base.variation(self.names)
        try:
            if variation is not None:
                self._check_rows(variation.other_rows(values) or self.rows, number)
            model = self.model.of(VariedDesign(self.base, named, warned=False))
            analysis = model.analyze(self.read, tables=[], lanes=self.packing.lanes)
            self._check_rows(analysis.rows, number)
            codes[place] = analysis.result.status
            for text in self.asked:
                found[text][place] = analysis[text]
        except MechkinError as error:
            self.errors[number] = error
            codes[place] = int(Status.not_assembled)
            for text in self.asked:
                found[text][place] = np.nan

    def _check_rows(self, rows: int, number: int) -> None:
        if rows != self.rows:
            raise UsageError(
                f"variant {number} has {rows} rows, the file has {self.rows}; vary parameters that "
                "keep their number, or take with_parameters for each"
            )

    def _empty(self, expression: Expression, count: int) -> Floats:
        value = expression.evaluate(sample_of(self.problem), self.problem.units).value
        width = (len(value.components),) if isinstance(value, Vector) else ()
        return np.full((count, self.rows, *width), np.nan)


class _Resolver:
    """Names of expressions over a chunk: (variants * rows,) in SI."""

    def __init__(
        self,
        run: _SweepRun,
        variation: SessionVariation,
        reading: VariantReadout,
        runs: Runs,
        values: Floats,
        codes: NDArray[np.int8],
    ) -> None:
        self.run, self.reading, self.runs = run, reading, runs
        self.count, self.rows = values.shape[1], run.rows
        self.known = run.problem.quantities()
        motion = run.problem.motion
        self.orders = variation.orders(values)
        if motion.time is not None:
            self.orders["time"] = motion.time.values, motion.time.written
        self.unclear = codes == int(Status.rank_unclear)
        self.solved = runs.end == int(VariantEnd.COMPLETE)
        parameters = variation.parameters(values)
        self.parameters = dict(zip(run.problem.parameters, parameters, strict=True))

    def __call__(self, name: str) -> Quantity:
        if name in self.parameters:
            dimension = self.run.problem.parameters[name].dimension
            return Quantity(np.repeat(self.parameters[name], self.rows), dimension)
        if name not in self.known:
            raise UnknownName(name, list(self.known), self.run.problem.why_not(name))
        wanted = self.known[name]
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self)
        if wanted.owner == "row" and name != "time":
            array = self.runs.residual if wanted.kind == "residual" else self.runs.condition
            return Quantity(array.reshape(-1), wanted.dimension)
        if name in self.orders:
            variation = self.reading.variation
            # inputs that move with the parameters have no whole turns here
            rest = None if variation.moving_inputs else input_rest(variation.base, name)
            if rest is not None:
                rest = np.broadcast_to(rest, (self.count, self.rows)).reshape(-1)
            return Quantity(self._over_rows(name), wanted.dimension, rest)
        slot = self.reading.slots[name]
        columns = [self._column(wanted, k) for k in range(slot.start, slot.stop)]
        if wanted.vector:
            return Quantity(wanted.value(columns), wanted.dimension)
        place = self.reading.slots.get(name + REST)
        within = None if place is None else self._column(wanted, place.start)
        return Quantity(columns[0], wanted.dimension, within)

    def written(self, text: str) -> Floats | None:
        """An input's values, or time, exactly as written: (rows,) or (variants, rows)."""
        names = {driven.name for driven in self.run.problem.motion.inputs} | {"time"}
        return self.orders[text][1] if text in names and text in self.orders else None

    def _over_rows(self, name: str) -> Floats:
        rows = np.broadcast_to(self.orders[name][0], (self.count, self.rows))
        values = {driven.name for driven in self.run.problem.motion.inputs} | {"time"}
        if name not in values:
            rows = np.where(self.solved[:, None], rows, np.nan)
        return rows.reshape(-1)

    def _column(self, wanted: Wanted, slot: int) -> Floats:
        column = self.runs.outputs[:, slot, :]
        if self.unclear.any() and demand_of(self.run.problem.mechanism, [wanted]):
            column = np.where(self.unclear, np.nan, column)
        return column.reshape(-1)


def _verdicts(
    runs: Runs, states: Sequence[int] = (), strands: Sequence[int] = ()
) -> NDArray[np.int8]:
    """Codes of `Status` (variants, rows) of those that are complete; others are not read.

    `states` are the slots of friction's states, zero where there is an answer; `strands` those of
    `slack_quantities`.
    """
    # without loops there is no condition
    loops = not np.isnan(runs.condition).all()
    codes = by_condition(runs.condition if loops else np.zeros_like(runs.condition))
    for slot in states:
        undecided = ~(runs.outputs[:, slot, :] == 0.0) & (codes != int(Status.rank_unclear))
        codes[undecided] = int(Status.friction_undecided)
    for slot in strands[1:]:
        pushes = is_slack(runs.outputs[:, slot, :], runs.outputs[:, strands[0], :])
        codes[pushes & (codes == int(Status.ok))] = int(Status.slack)
    return codes


def _doubtful(runs: Runs) -> Bools:
    """Variants (variants,) with a row whose rates may be rounding."""
    if np.isnan(runs.condition).all():
        return np.zeros(len(runs.condition), dtype=bool)
    return np.asarray((~rates_are_clear(runs.condition)).any(axis=1))


TIME = "time"

CHUNK = 512
"""Variants that are held at a time: memory stays flat, and packs are full."""


class _ResponseRun:
    """One call of `vary` for a response, or for equilibria: arrays (variants, rows) or (variants,
    rows, 3) by the texts asked for. A window has as many rows as the most equilibria of a variant,
    those without one nan."""

    def __init__(
        self, model: Solvable, names: tuple[str, ...], asked: list[str], run: str, packing: Packing
    ) -> None:
        self.model, self.base = model, base_of(model.design)
        self.names, self.asked = names, asked
        self.name, self.packing = run, packing
        self.rows = self.base.design.problem.responses[run].rows
        self.errors: dict[int, MechkinError] = {}
        self.codes: NDArray[np.int8] = np.empty((0, self.rows), dtype=np.int8)

    def run(self, values: Floats) -> dict[str, Floats]:
        """All variants, chunk by chunk."""
        count = values.shape[1]
        self.codes = np.full((count, self.rows), int(Status.not_assembled), dtype=np.int8)
        found: dict[str, Floats] = {}
        for begin in range(0, count, CHUNK):
            with without_collection():  # what is made of variants lives as long as their chunk
                self._run_chunk(range(begin, min(begin + CHUNK, count)), values, found)
        for text in self.asked:
            found.setdefault(text, np.full((count, self.rows), np.nan))
        return found

    def _run_chunk(self, numbers: range, values: Floats, found: dict[str, Floats]) -> None:
        models: dict[int, tuple[Solvable, Prepared]] = {}
        for number in numbers:
            self._prepare(number, values[:, number], models)
        prepared = [one for _, one in models.values()]
        results: Sequence[FreeResult] = [balanced(one) for one in prepared if one.response.search]
        if not results:
            results = integrated(prepared, self.packing)
        for number, result in zip(models, results, strict=True):
            self._take(number, models[number][0], result, found, values.shape[1])

    def _prepare(
        self, number: int, row: Floats, models: dict[int, tuple[Solvable, Prepared]]
    ) -> None:
        try:
            values = dict(zip(self.names, row.tolist(), strict=True))
            design = VariedDesign(self.base, values)
            session, response = design.session_of(self.name), design.response(self.name)
            prepared = prepare(design.at_responses.problem, response, self.packing, session)
            models[number] = self.model.of(design), prepared
        except MechkinError as error:
            self.errors[number] = error

    def _take(
        self,
        number: int,
        model: Solvable,
        result: FreeResult,
        found: dict[str, Floats],
        count: int,
    ) -> None:
        known = result.problem.quantities()
        parse = result.problem.definitions.parse
        read(result, read_by(map(parse, self.asked), known))
        analysis = Analysis(model, (), result, self.name)
        if result.response.search is not None and result.rows > self.rows:
            self._widen(result.rows, found)
        rows = min(result.rows, self.rows)
        self.codes[number] = int(Status.ok)
        self.codes[number, :rows] = result.status[:rows]
        for text in self.asked:
            array = np.asarray(analysis[text], dtype=np.float64)[:rows]
            if text not in found:
                found[text] = np.full((count, self.rows, *array.shape[1:]), np.nan)
            found[text][number, :rows] = array

    def _widen(self, rows: int, found: dict[str, Floats]) -> None:
        """Makes room for more rows of each variant."""
        more = rows - self.rows
        for text, array in found.items():
            none = np.full((len(array), more, *array.shape[2:]), np.nan)
            found[text] = np.concatenate([array, none], axis=1)
        # a variant without a place has no row; of others there are no more
        last = np.where((self.codes == int(Status.not_assembled)).all(axis=1), self.codes[:, -1], 0)
        behind = np.repeat(last[:, None], more, axis=1).astype(np.int8)
        self.codes = np.concatenate([self.codes, behind], axis=1)
        self.rows = rows


def vary(
    model: Solvable,
    parameters: Mapping[str, Any],
    quantities: Iterable[str] | None = None,
    reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None = None,
    run: str = SWEEP,
    lanes: int = 0,
    threads: int = 0,
) -> Variants:
    """`Model.vary`, whose arguments these are; values that were set before stay unless they are
    set again."""
    packing = a_packing(lanes, threads)
    if a_text("run", run, f'"{SWEEP}"') != SWEEP:
        name = run_name((SWEEP, *model.problem.responses), run)
        return _vary_response(model, parameters, quantities, reduce, name, packing)
    if SWEEP not in model.runs:
        raise UsageError(
            f"{model.name} has no sweep to vary; vary a response one by one: "
            f'with_parameters({{...}}).respond("{model.runs[0]}")'
        )
    base = base_of(model.design)
    problem = base.design.problem
    varied, names, values = varied_parameters(problem, parameters, model.design.values)
    asked = _expressions_once(base, quantities)
    call = _SweepRun(model, names, asked, reductions_of(asked, reduce), packing)
    numbers = values.shape[1] * call.numbers_returned()
    if numbers > MOST_KEPT:
        raise UsageError(
            f"the results of {values.shape[1]} variants are {numbers} numbers (limit {MOST_KEPT}); "
            "ask for less, reduce over the rows, or take fewer variants at a time"
        )
    return Variants(varied, *call.run(values))


def _expressions_once(base: Base, quantities: Iterable[str] | None) -> dict[str, Expression]:
    """`expressions_of` quantities, found once for the pieces of a study."""
    problem = base.design.problem
    if not isinstance(quantities, list) or not all(type(text) is str for text in quantities):
        return expressions_of(quantities, problem)
    key = expressions_of, tuple(quantities)
    if key not in base.memo:
        base.memo[key] = expressions_of(quantities, problem)
    found: dict[str, Expression] = base.memo[key]
    return found


def _vary_response(
    model: Solvable,
    parameters: Mapping[str, Any],
    quantities: Iterable[str] | None,
    reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None,
    run: str,
    packing: Packing,
) -> Variants:
    """`vary` for a response.

    Rows are the moments asked for; where a stop ends a variant its row takes the place of the next
    moment (see `time`), and those behind it hold nan.
    """
    problem = base_of(model.design).design.problem
    varied, names, values = varied_parameters(problem, parameters, model.design.values)
    if quantities is None:
        quantities = problem.mechanism.coordinates
    asked = expressions_of(quantities, response_problem(problem, problem.responses[run]))
    reductions = reductions_of(asked, reduce)
    read = dict.fromkeys((*asked, TIME)) if need_places(reductions) else asked
    call = _ResponseRun(model, names, list(read), run, packing)
    rows = call.run(values)
    results = {text: reduced(text, rows[text], reductions[text], rows.get(TIME)) for text in asked}
    return Variants(varied, results, Verdicts.of(call.codes), call.errors)
