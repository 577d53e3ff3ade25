"""The runs behind `Model.vary`: chunks through the kernel, what takes more one at a time."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.sweep.closing_angles import has_turns
from mechkin_cli.diagnostics import MechkinError, UsageError
from mechkin_cli.expressions import Expression, Quantity, UnknownName, Vector
from mechkin_cli.interface.reduced_values import Reductions, need_places, reduced
from mechkin_cli.interface.varied import Base, VariedModel
from mechkin_cli.interface.way import way_of
from mechkin_cli.kernel._kernel import VariantEnd
from mechkin_cli.kernel.width import threads_for
from mechkin_cli.mechanism.bearing_loads import BEARING_KINDS, bearing_load, read_for
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.quantities import friction_states
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import WRENCH_KINDS, demand_of
from mechkin_cli.solver.inputs import input_rest
from mechkin_cli.solver.variation import Reading, Runs, Variation, run_variants
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session

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
"""What the names of angles without whole turns end in."""

PERIODIC = re.compile(r"\b(?:wrap|sin|cos|tan)\s*\(")
"""Functions to which whole turns of an angle do not matter."""


class Study:
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
        self.kept = tuple(asked)
        self.lanes, self.threads = lanes, threads
        self.problem = base.model.problem
        self.way = way_of(self.problem) if need_places(reductions) else None
        if self.way is not None and self.way.name not in asked:
            parse = self.problem.definitions.parse
            self.asked = {**asked, self.way.name: parse(self.way.name)}
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
        parts: dict[str, list[Floats]] = {text: [] for text in self.kept}
        variation = self.base.variation(self.names)
        native = self._native(variation) if variation is not None else None
        chunk = self._chunk()
        for begin in range(0, max(count, 1), chunk):
            part = values[:, begin : begin + chunk]
            found = self._chunk_values(variation, native, part, begin, codes)
            for text, array in found.items():
                parts[text].append(array)
        return {text: np.concatenate(arrays) for text, arrays in parts.items()}, codes, self.errors

    def numbers_kept(self) -> int:
        """Numbers that come back of a variant: parameters, verdicts, what was asked for."""
        kept = len(self.names) + -(-self.rows // 8)
        for text in self.kept:
            value = self.asked[text].evaluate(sample_of(self.problem), self.problem.units).value
            width = len(value.components) if isinstance(value, Vector) else 1
            reduction = self.reductions[text]
            each = len(reduction) if isinstance(reduction, tuple) else 1
            kept += width * (self.rows if reduction is None else each)
        return kept

    def _chunk(self) -> int:
        width = 2 + sum(3 if quantity.vector else 1 for quantity in self.wanted)
        return max(1, CHUNK_NUMBERS // (self.rows * width))

    # --- by the kernel --------------------------------------------------------------------

    def _native(self, variation: Variation) -> tuple[Reading, Any] | None:
        """The kernel's variants of what is read; None where the rows take more than its run."""
        problem = self.problem
        given = {driven.name for driven in problem.motion.inputs}
        given |= {name for driven in problem.motion.inputs for name in driven.orders}
        session = variation.base
        if (
            any(q.kind in DERIVED_KINDS or q.kind == "power_error" for q in self.wanted)
            or (session.is_redundant and any(q.kind in WRENCH_KINDS for q in self.wanted))
            or self._friction_takes_more(session)
            or (variation.moving_inputs and given & {q.name for q in self.wanted})
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

    def _states(self, reading: Reading) -> list[Wanted]:
        """What tells the rows without an answer of friction."""
        return [q for q in friction_states(self.problem.mechanism) if q.name in reading.slots]

    def _computed(self) -> list[Wanted]:
        """What the kernel computes: no verdicts but on friction, and nothing that is given."""
        given = self._given()
        found = [q for q in self.wanted if q.owner != "row" and q.name not in given]
        if demand_of(self.problem.mechanism, found) & Demand.FORCES:
            found += friction_states(self.problem.mechanism)
        if any(map(PERIODIC.search, self.asked)):
            # angles within a turn, which the kernel gives before it adds whole turns
            found += [q._replace(name=q.name + REST) for q in found if has_turns(q)]
        return found

    def _given(self) -> dict[str, Floats]:
        """Time, inputs and their rates over the rows, in SI."""
        motion = self.problem.motion
        found = {} if motion.time is None else {"time": motion.time.values}
        for driven in motion.inputs:
            found |= {name: in_si for name, (in_si, _) in driven.orders.items()}
        return found

    def _chunk_values(
        self,
        variation: Variation | None,
        native: tuple[Reading, Any] | None,
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
            states = [reading.slots[q.name].first for q in self._states(reading)]
            codes[begin : begin + count] = _verdicts(runs, states)
            found = self._evaluated(variation, reading, runs, values, codes[begin : begin + count])
            # what may stand at a dead centre is judged as in a run of its own
            alone = np.flatnonzero((runs.end != int(VariantEnd.COMPLETE)) | _doubtful(runs))
        for number in alone:
            self._alone(values[:, number], int(begin + number), int(number), found, codes)
        places = None if self.way is None else found[self.way.name]
        return {t: reduced(t, found[t], self.reductions[t], places) for t in self.kept}

    def _evaluated(
        self,
        variation: Variation,
        reading: Reading,
        runs: Runs,
        values: Floats,
        codes: NDArray[np.int8],
    ) -> dict[str, Floats]:
        """The expressions in the file's units, (variants, rows) or (variants, rows, 3)."""
        units, count = self.problem.units, values.shape[1]
        resolve = _Resolve(self, variation, reading, runs, values, codes)
        found = {}
        for text, expression in self.asked.items():
            written = self._written(text)
            if written is not None:
                found[text] = np.broadcast_to(written, (count, self.rows))
                continue
            result = expression.evaluate(resolve, units)
            value = result.value
            parts = value.components if isinstance(value, Vector) else (value,)
            columns = [
                np.asarray(
                    units.from_si(
                        np.array(np.broadcast_to(part, (count * self.rows,))), result.dimension
                    )
                ).reshape(count, self.rows)
                for part in parts
            ]
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

    # --- one at a time --------------------------------------------------------------------

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
                found[text] = _writable(found[text])
                found[text][place] = analysis[text]
        except MechkinError as error:
            self.errors[number] = error
            codes[number] = int(Status.not_assembled)
            for text in self.asked:
                found[text] = _writable(found[text])
                found[text][place] = np.nan

    def _empty(self, expression: Expression, count: int) -> Floats:
        value = expression.evaluate(sample_of(self.problem), self.problem.units).value
        width = (len(value.components),) if isinstance(value, Vector) else ()
        return np.full((count, self.rows, *width), np.nan)


class _Resolve:
    """Names of expressions over a chunk: (variants * rows,) in SI."""

    def __init__(
        self,
        study: Study,
        variation: Variation,
        reading: Reading,
        runs: Runs,
        values: Floats,
        codes: NDArray[np.int8],
    ) -> None:
        self.study, self.reading, self.runs = study, reading, runs
        self.count, self.rows = values.shape[1], study.rows
        self.known = study.problem.quantities()
        self.given = study._given()
        self.unclear = codes == int(Status.rank_unclear)
        self.solved = runs.end == int(VariantEnd.COMPLETE)
        parameters = variation.parameters(values)
        self.parameters = dict(zip(study.problem.parameters, parameters, strict=True))

    def __call__(self, name: str) -> Quantity:
        if name in self.parameters:
            dimension = self.study.problem.parameters[name].dimension
            return Quantity(np.repeat(self.parameters[name], self.rows), dimension)
        if name not in self.known:
            raise UnknownName(name, list(self.known))
        wanted = self.known[name]
        if wanted.kind in BEARING_KINDS:
            return bearing_load(wanted, self)
        if wanted.owner == "row" and name != "time":
            array = self.runs.residual if wanted.kind == "residual" else self.runs.condition
            return Quantity(array.reshape(-1), wanted.dimension)
        if name in self.given:
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
        rows = np.broadcast_to(self.given[name], (self.count, self.rows))
        values = {driven.name for driven in self.study.problem.motion.inputs} | {"time"}
        if name not in values:
            rows = np.where(self.solved[:, None], rows, np.nan)
        return rows.reshape(-1)

    def _column(self, wanted: Wanted, slot: int) -> Floats:
        column = self.runs.outputs[:, slot, :]
        if self.unclear.any() and demand_of(self.study.problem.mechanism, [wanted]):
            column = np.where(self.unclear, np.nan, column)
        return column.reshape(-1)


def _verdicts(runs: Runs, states: Sequence[int] = ()) -> NDArray[np.int8]:
    """Codes of `Status` (variants, rows) of those that are complete; others are not read.

    `states` are the slots that tell the rows without an answer of friction.
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
    doubtful: Bools = np.any(~(runs.condition <= tolerances.CONDITION_RATES_UNCLEAR), axis=1)
    return doubtful


def _writable(array: Floats) -> Floats:
    return array if array.flags.writeable else array.copy()
