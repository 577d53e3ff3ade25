"""The result of a fit, measured again on the mechanism that it gives.

In reading order: values that are lacking although rows have positions (infinite at a dead centre,
or empty), the result, and the call.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.arguments import a_whole_number
from mechkin_cli.fit.measure import (
    TIME,
    FitModels,
    FitSlopes,
    FitValues,
    deviations,
    margins_of,
    nearest_places,
)
from mechkin_cli.fit.request import FitConstraint, Target, request
from mechkin_cli.fit.search import Measured, Progress, SearchResult, best_of
from mechkin_cli.mechanism import response_problem
from mechkin_cli.record import NamedTuple
from mechkin_cli.show import Bools, Floats, Listed, Listing
from mechkin_cli.tables import run_parameter
from mechkin_cli.tolerances import FIT_AT_BOUND, FIT_HELD
from mechkin_cli.variants import read_by, vary, with_parameters
from mechkin_cli.verdict import SWEEP, Status, has_solution

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mechkin_cli.analysis import Analysis, Solvable
    from mechkin_cli.mechanism import Problem


END_BEFORE = "end the sweep before it, or vary a dimension that moves the dead centre"
ASK_BEFORE = "ask for it before that, or vary a dimension that moves the dead centre"
OTHERWISE = "ask for another quantity there, or end the run before it"
NOT_REACHED = "ask for it at inputs that are reached, or widen the bounds"


Lack = tuple[str, bool, str]
"""A value that is not finite, and where; whether it is infinite; and what to do."""


def lack_of(analysis: Analysis, texts: Iterable[str]) -> Lack | None:
    """The first of some expressions that has no finite value in some row, infinite ones first."""
    lacks = [lack for text in texts if (lack := _lack(analysis, text)) is not None]
    return min(lacks, key=lambda lack: not lack[1], default=None)


def lack_at(text: str, values: Floats, inputs: Floats, along: str, unit: str) -> Lack | None:
    """The same of values (points, width) at inputs (points,)."""
    for value, place in zip(values, inputs.tolist(), strict=True):
        where = f"at {along} = {place:.9g} {unit}".rstrip()
        if np.isinf(value).any():
            return f"{text} is infinite {where}, a dead centre", True, ASK_BEFORE
        if np.isnan(value).any():
            return f"{text} has no value {where}", False, NOT_REACHED
    return None


def _lack(analysis: Analysis, text: str) -> Lack | None:
    values = np.asarray(analysis[text])
    values = values.reshape(len(values), -1)
    infinite = np.isinf(values).any(axis=1)
    without = infinite if infinite.any() else np.isnan(values).any(axis=1)
    if not without.any():
        return None
    row = int(np.argmax(without))
    where = f"in row {row + 1}"
    if (along := run_parameter(analysis.result)) is not None:
        where += f" ({along.name} = {along.values[row]:.9g} {along.unit}".rstrip() + ")"
    if int(analysis.result.status[row]) == Status.dead_centre:
        where += ", which stands at a dead centre"
    if infinite.any():
        return f"{text} is infinite {where}", True, END_BEFORE
    return f"{text} has no value {where}", False, OTHERWISE


FITTED = "fitted"
NOT_CONVERGED = "not-converged"
VIOLATED = "violated"
NOT_ASSEMBLED = "not-assembled"
INFINITE = "infinite"


class Met(NamedTuple):
    """How a target is met.

    Attributes:
        label, unit: of the target.
        inputs: (points,) where its values stand, in the file's units; empty where it is least.
        values: (points, width); of what is least its peak or rms (1, 1).
        deviations: from what was wanted, as values, in the file's units.
    """

    label: str
    unit: str
    inputs: Floats
    values: Floats
    deviations: Floats

    @property
    def largest(self) -> float:
        """The largest distance from what was wanted; of what is least, its value."""
        return float(np.linalg.norm(self.deviations, axis=1).max())

    @property
    def rms(self) -> float:
        """The root of the mean of the distances squared."""
        return float(np.sqrt(np.square(self.deviations).sum(axis=1).mean()))


class ConstraintCheck(NamedTuple):
    """Whether a constraint holds: the value nearest to its bound, the bound, the row (from 0)."""

    label: str
    unit: str
    bound: float
    value: float
    row: int
    holds: bool


class Fit(Listed):
    """The fitted dimensions.

    Attributes:
        parameters: values by name, in the file's units.
        units: their units.
        model: the mechanism that has them.
        evaluations: variants that were computed, those of derivatives among them.
        slopes_taken, exact_taken: Jacobians of the searches, by differences; exact ones, with
            which the best of them was finished.
        slopes: `exact`, or which of the last Jacobian's numbers are differences, and why.
        costs: what each local search reached: half the sum of the squares of what was asked, in
            parts of `within`; nan where nothing assembled.
    """

    def __init__(
        self, values: FitValues, best: SearchResult, measured: Measured, why: dict[str, str]
    ) -> None:
        self._values, self._best = values, best
        self._analyses: dict[str, Analysis] = {}
        columns = values.values(best.unknowns[:, None])
        self.parameters = {name: float(column[0]) for name, column in columns.items()}
        self.units = {one.name: one.unit for one in values.parameters}
        self.model: Solvable = with_parameters(values.models.model, self.parameters)
        self.evaluations, self.slopes_taken = measured.evaluations, measured.slopes_taken
        self.exact_taken = measured.exact_taken
        self.slopes = _slopes_text(measured, why)
        self.costs = best.costs

    @property
    def cost(self) -> float:
        """Half the sum of the squares of what was asked, in parts of `within`."""
        return float(self._best.measures.costs[0])

    @cached_property
    def rows_not_ok(self) -> int:
        """Rows of the sweep, and of responses that were asked for, without a solution."""
        return sum(int((~self._solved(run)).sum()) for run in self._values.runs)

    @cached_property
    def at_bounds(self) -> dict[str, str]:
        """The parameters that lie at a bound, and at which: `lower` or `upper`."""
        sides = {}
        for one, part in zip(self._values.parameters, self._best.unknowns, strict=True):
            if part <= FIT_AT_BOUND or part >= 1.0 - FIT_AT_BOUND:
                sides[one.name] = "lower" if part < 0.5 else "upper"
        return sides

    @property
    def status(self) -> str:
        """`fitted`; `not-converged` where the search stopped early; `violated` where a constraint
        does not hold; `not-assembled` where rows or targets have no solution; `infinite` where they
        have, but what is asked for has no bound at a dead centre."""
        if self.rows_not_ok or self._best.measures.missing[0] > 0.0:
            return INFINITE if self._lack is not None and self._lack[1] else NOT_ASSEMBLED
        if not all(one.holds for one in self.constraints):
            return VIOLATED
        return FITTED if self._best.ended else NOT_CONVERGED

    @property
    def reason(self) -> str:
        """Why that is the status, in a sentence."""
        status = self.status
        if status in (NOT_ASSEMBLED, INFINITE) and self._lack is not None:
            text, _, hint = self._lack
            return (
                "no variant that was tried has a finite value of all that is asked for; in the "
                f"best {text}; {hint}"
            )
        if status == NOT_ASSEMBLED:
            runs = self._values.runs
            rows = sum(self._solved(run).size for run in runs)
            names = " and ".join("the sweep" if run == SWEEP else run for run in runs)
            missed = f"misses {self.rows_not_ok} of {rows} rows of {names}"
            if not self.rows_not_ok:
                missed = f"has all {rows} rows of {names}, but not all of the curve between them"
            return (
                f"no variant that was tried has a solution everywhere; the best {missed}; widen "
                "the bounds, shorten the way, or take more generations"
            )
        if status == VIOLATED:
            worst = next(one for one in self.constraints if not one.holds)
            return (
                f"{worst.label} reaches {worst.value:.6g} {worst.unit} in row {worst.row + 1}, its "
                f"bound is {worst.bound:g}; within these bounds no variant that was tried holds "
                "all constraints"
            )
        return self._best.reason

    @cached_property
    def targets(self) -> tuple[Met, ...]:
        """How each target is met, in the order in which they were given."""
        return tuple(self._met(target) for target in self._values.targets)

    @cached_property
    def constraints(self) -> tuple[ConstraintCheck, ...]:
        """How each bound is held, where it is nearest to be exceeded."""
        constraints = self._values.constraints
        return tuple(check for one in constraints for check in self._checks(one))

    @property
    def yaml(self) -> str:
        """The lines of `parameters:` that have changed, to paste into the file."""
        units = self.units
        lines = [f"  {n}: {v!r} {units[n]}".rstrip() for n, v in self.parameters.items()]
        return "\n".join(["parameters:", *lines, ""])

    @property
    def listing(self) -> Listing:
        """Parameters, targets and constraints."""
        rows = []
        for one in self._values.parameters:
            side = self.at_bounds.get(one.name)
            words = f"{one.lower:g} to {one.upper:g}" + (f", at the {side} bound" if side else "")
            rows.append((one.name, f"{self.parameters[one.name]:.9g}", one.unit, words))
        for met, target in zip(self.targets, self._values.targets, strict=True):
            digits, words = ".3g", f"largest deviation of {len(target.wanted)}"
            if target.least:
                digits, words = ".6g", f"least {target.least}"
            rows.append((met.label, f"{met.largest:{digits}}", met.unit, words))
        for check in self.constraints:
            words = f"bound {check.bound:g} {'holds' if check.holds else 'DOES NOT HOLD'}"
            rows.append((check.label, f"{check.value:.6g}", check.unit, words))
        head = f"{self.model.name}, fit: {self.status}"
        notes = (
            self.reason,
            f"{self.evaluations} variants, {self.slopes_taken} Jacobians by differences and "
            f"{self.exact_taken} of sensitivities, {len(self.costs)} starts",
            f"slopes: {self.slopes}",
        )
        return Listing(head, ("what", "value", "unit", ""), tuple(rows), notes)

    def _solved(self, run: str) -> Bools:
        """Which of the rows that were asked for have a solution at their places."""
        rows = self._rows(run)
        solved = has_solution(rows.result.status)
        if run == SWEEP:
            return solved
        times = self._padded(run, TIME)
        reached = np.zeros(len(times), dtype=np.bool_)
        reached[: rows.rows] = solved[: len(times)]
        return np.asarray(reached & self._values.on_time(run, times))

    def _padded(self, run: str, text: str) -> Floats:
        """A quantity at the moments of a run, nan behind the end of a response."""
        values = self._rows(run)[text]
        if run == SWEEP:
            return values
        count = self.model.design.response(run).rows
        padded = np.full((count, *values.shape[1:]), np.nan)
        padded[: len(values)] = values[:count]
        return padded

    @cached_property
    def _lack(self) -> Lack | None:
        """What has no finite value although all rows have positions."""
        if self.rows_not_ok:
            return None
        values = self._values
        lacks = [lack_of(self._rows(run), values.texts(run)) for run in values.runs]
        for met, target in zip(self.targets, values.targets, strict=True):
            if target in self._values.at_inputs:
                along = values.models.moved.name, values.models.unit
                lacks.append(lack_at(target.of, met.values, met.inputs, *along))
        return next((lack for lack in lacks if lack is not None), None)

    def _rows(self, run: str) -> Analysis:
        """The rows of a run of the fitted mechanism."""
        if run not in self._analyses:
            texts = self._values.texts(run)
            if run == SWEEP:
                found = self.model.analyze(_names(self.model.problem, texts), tables=[])
            else:
                known = response_problem(self.model.problem, self.model.design.response(run))
                found = self.model.run_free(run, _names(known, texts), tables=[])
            self._analyses[run] = found
        return self._analyses[run]

    def _met(self, target: Target) -> Met:
        none = np.zeros(0)
        if target.least:
            values = self._rows(target.run)[target.of]
            if target.least == "peak":
                size = np.array([[np.nanmax(np.abs(values), initial=0.0)]])
            else:
                weights = self._values.weights[target.run]
                parts = values.reshape(len(values), -1) * weights[: len(values), None]
                size = np.array([[np.sqrt(np.nansum(np.square(parts)))]])
            return Met(target.label, target.unit, none, size, size)
        if target in self._values.at_moments:
            rows = self._padded(target.run, target.of)[self._values.rows_of(target)]
            values = rows.reshape(-1, target.width)
            away = deviations(target, values[None])[0].reshape(values.shape) * target.within
            return Met(target.label, target.unit, np.array(target.at), values, away)
        inputs = np.array(target.at) if target.at is not None else self._nearest(target)
        # each by itself from the first row, in the order in which they are passed
        order = np.argsort(inputs if self._values.models.ends[1] >= inputs.min() else -inputs)
        listed = self._values.models.listed(tuple(inputs[order].tolist()))
        analysis = with_parameters(listed, self.parameters).analyze(
            _names(listed.problem, [target.of]), tables=[]
        )
        values = np.empty((len(inputs), target.width))
        values[order] = analysis[target.of][1:].reshape(-1, target.width)
        away = deviations(target, values[None])[0].reshape(values.shape) * target.within
        return Met(target.label, target.unit, inputs, values, away)

    def _nearest(self, target: Target) -> Floats:
        """The inputs at which the curve comes nearest to the points."""
        models = self._values.models
        single = {name: np.array([value]) for name, value in self.parameters.items()}
        run = vary(models.curve, single, [target.of])
        rows, _ = nearest_places(np.nan_to_num(run[target.of]), target.wanted)
        found: Floats = np.interp(rows[0], np.arange(len(models.curve_inputs)), models.curve_inputs)
        return found

    def _checks(self, constraint: FitConstraint) -> list[ConstraintCheck]:
        values = self._rows(constraint.run)[constraint.of]
        checks = []
        all_margins = margins_of(constraint, values)
        for (bound, _), margins in zip(constraint.bounds, all_margins, strict=True):
            row = int(np.argmin(np.where(np.isnan(margins), np.inf, margins)))
            holds, value = bool((margins >= -FIT_HELD).all()), float(values[row])
            label, unit = constraint.label, constraint.unit
            checks.append(ConstraintCheck(label, unit, bound, value, row, holds))
        return checks


def _slopes_text(measured: Measured, why: dict[str, str]) -> str:
    """Which derivatives the search ended with."""
    if not measured.exact_taken:
        return "differences: no search found where everything has a value"
    if not measured.filled:
        return "exact"
    reasons = "; ".join(f"{text}: {reason}" for text, reason in why.items())
    some = f"differences in {measured.filled} of {measured.entries} derivatives"
    return f"{some}, which have no sensitivity ({reasons})"


def _names(problem: Problem, texts: list[str]) -> list[str]:
    """Quantities that expressions read."""
    return read_by(map(problem.definitions.parse, texts), problem.quantities())


def fit_of(
    model: Solvable,
    targets: Any,
    parameters: Any,
    constraints: Any,
    starts: int,
    generations: int,
    seed: int,
    progress: Progress | None,
) -> Fit:
    """`Model.fit`, whose arguments these are."""
    starts = a_whole_number("starts", starts, "local searches", 1)
    generations = a_whole_number("generations", generations, "generations", 0)
    seed = a_whole_number("seed", seed, "", 0)
    models = FitModels(model)
    values = FitValues(models, *request(model.problem, targets, parameters, constraints))
    slopes = FitSlopes(values)
    measured = Measured(values.measure, slopes.stacked)
    own = np.array([one.own for one in values.parameters])
    start = (own - values.lower) / values.width
    best = best_of(measured, start, seed, starts, generations, progress)
    return Fit(values, best, measured, slopes.why)
