"""Many variants of a model at once: what a caller asks for, and what comes back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import LONGEST_NAME, MechkinError, UsageError
from mechkin_cli.expressions import Expression, ExpressionError
from mechkin_cli.interface.arguments import a_text, a_whole_number, shown, texts
from mechkin_cli.interface.given import parameter_arrays
from mechkin_cli.interface.reduced_values import Reductions
from mechkin_cli.interface.responses import response_name
from mechkin_cli.interface.variant_runs import Study, sample_of
from mechkin_cli.interface.varied import Base, file_values
from mechkin_cli.kernel.width import check_threads, check_width
from mechkin_cli.reductions import REDUCTIONS
from mechkin_cli.runs import SWEEP
from mechkin_cli.status import Status
from mechkin_cli.tables.layout import ROW_TEXTS
from mechkin_cli.tolerances import MOST_KEPT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem

LONGEST_MESSAGE = 400
"""Characters of an expression's error that a message repeats."""

Reduce = str | Callable[["Floats"], "Floats"]


class Variants:
    """Results of `Model.vary`: `r["O4.theta"]` is an array over the variants, in the file's units.

    Attributes:
        parameters: (variants,) of every parameter given, in the file's units.
        errors: what was said of variants that cannot be built, by their number.
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
        words = np.array([status.label for status in Status])
        found: NDArray[np.str_] = words[self._codes]
        return found

    @property
    def complete(self) -> NDArray[np.bool_]:
        """Which variants have a position in every row (variants,), as `Analysis.complete`.

        A row at a dead centre has one: `status` tells it, and what has no bound there is infinite.
        """
        solved = np.array([status.has_solution for status in Status])
        found: NDArray[np.bool_] = np.logical_and.reduce(solved[self._codes], axis=1)
        return found


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
        from mechkin_cli.interface.response_variants import vary_response

        name = response_name(base.model, run)
        return vary_response(base, held, parameters, quantities, reduce, name, lanes, threads)
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
    names, values = parameter_arrays(problem, parameters)
    given = file_values(values, problem, names)
    names, values = with_held(list(problem.parameters), names, values, held)
    asked = expressions_of(
        problem.mechanism.coordinates if quantities is None else quantities, problem
    )
    study = Study(base, names, asked, reductions_of(asked, reduce), lanes, threads)
    _check_memory(values.shape[1], study)
    return Variants(given, *study.run(values))


def _check_memory(variants: int, study: Study) -> None:
    """Whether all that comes back fits into memory."""
    kept = variants * study.numbers_kept()
    if kept > MOST_KEPT:
        raise UsageError(
            f"the results of {variants} variants are {kept} numbers (limit {MOST_KEPT}); ask for "
            "less, reduce over the rows, or take fewer variants at a time"
        )


def with_held(
    order: Sequence[str], names: tuple[str, ...], values: Floats, held: Mapping[str, float]
) -> tuple[tuple[str, ...], Floats]:
    """Names and values of all parameters that are set, in the file's order."""
    rows = dict(zip(names, values, strict=True))
    count = values.shape[1]
    rows = {name: np.full(count, value) for name, value in held.items()} | rows
    names = tuple(name for name in order if name in rows)
    return names, np.stack([rows[name] for name in names])


def expressions_of(quantities: Iterable[str], problem: Problem) -> dict[str, Expression]:
    """What is asked for, by its text.

    Raises:
        UsageError: no such quantity, or a text.
    """
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
