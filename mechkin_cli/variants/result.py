"""What is asked of many variants, and what comes back: arrays, or reductions over the rows."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from mechkin_cli.arguments import a_text, shown, texts
from mechkin_cli.diagnostics import LONGEST_NAME, MechkinError, UsageError
from mechkin_cli.expressions import Expression, ExpressionError, Quantity, UnknownName
from mechkin_cli.record import NamedTuple
from mechkin_cli.show import Floats, Listed, Listing
from mechkin_cli.tables import (
    OVER_THE_WAY,
    REDUCTIONS,
    ROW_TEXTS,
    Reduction,
    mean,
    root_mean_square,
)
from mechkin_cli.variants.design import file_values, parameter_arrays
from mechkin_cli.verdict import Status, has_solution, labels

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Problem


LONGEST_MESSAGE = 400
"""Characters of an expression's error that a message repeats."""

Reduce = str | Callable[["Floats"], "Floats"]


class Verdicts(NamedTuple):
    """Codes of `Status` of variants and rows. Only those of variants with a row that is not ok are
    held: reduced, a variant is smaller than the verdicts of its rows."""

    variants: int
    rows: int
    numbers: NDArray[np.int64]
    held: NDArray[np.int8]

    @classmethod
    def of(cls, codes: NDArray[np.int8]) -> Verdicts:
        """Of all (variants, rows)."""
        numbers = np.flatnonzero((codes != int(Status.ok)).any(axis=1))
        count, rows = codes.shape
        return cls(count, rows, numbers, codes[numbers])

    @classmethod
    def joined(cls, parts: Sequence[Verdicts]) -> Verdicts:
        """Of parts of the variants, one after the other."""
        begins = np.cumsum([0, *(part.variants for part in parts)])
        numbers = [part.numbers + begin for part, begin in zip(parts, begins, strict=False)]
        held = np.concatenate([part.held for part in parts])
        return cls(int(begins[-1]), parts[0].rows, np.concatenate(numbers), held)

    @property
    def codes(self) -> NDArray[np.int8]:
        """All of them (variants, rows)."""
        found = np.full((self.variants, self.rows), int(Status.ok), dtype=np.int8)
        found[self.numbers] = self.held
        return found


class Variants(Listed):
    """Results of `Model.vary`: `r["O4.theta"]` is an array over the variants, in the file's units.

    Attributes:
        parameters: (variants,) of every parameter that varies, in the file's units.
        errors: of variants that cannot be built, by their number.
    """

    def __init__(
        self,
        parameters: Mapping[str, Floats],
        values: Mapping[str, Floats],
        verdicts: Verdicts,
        errors: Mapping[int, MechkinError],
    ) -> None:
        self.parameters = parameters
        self.errors = errors
        self._values = values
        self._verdicts = verdicts

    @property
    def listing(self) -> Listing:
        """What was varied and what was asked for, with the least and the largest value."""
        count, complete = len(self), int(self.complete.sum())
        head = f"{count} variants, {complete} complete"
        columns = {**self.parameters, **self._values}
        rows = tuple((name, *_extremes(values)) for name, values in columns.items())
        return Listing(head, ("column", "least", "largest"), rows)

    def __len__(self) -> int:
        return self._verdicts.variants

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
        return self._verdicts.codes

    @cached_property
    def status(self) -> NDArray[np.str_]:
        """The verdict of every variant and row, in words (variants, rows)."""
        return labels(self.codes)

    @property
    def complete(self) -> NDArray[np.bool_]:
        """Which variants have a position in every row (variants,), as `Analysis.complete`.

        A row at a dead centre has one: see `status`; what has no bound there is infinite.
        """
        complete = np.ones(len(self), dtype=np.bool_)
        complete[self._verdicts.numbers] = has_solution(self._verdicts.held).all(axis=1)
        return complete


def _extremes(values: Floats) -> tuple[str, str]:
    known = values[np.isfinite(values)]
    return (f"{known.min():.6g}", f"{known.max():.6g}") if known.size else ("", "")


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


def read_by(expressions: Iterable[Expression], known: Container[str]) -> list[str]:
    """The quantities among those `known` that expressions read, without components."""
    names = (name for expression in expressions for name in sorted(expression.names))
    whole = (name if name in known else name.rpartition(".")[0] for name in names)
    return [name for name in dict.fromkeys(whole) if name in known]


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


def sample_of(problem: Problem) -> Any:
    """A resolver of names to one-row stand-ins of the right dimension."""

    def resolve(name: str) -> Quantity:
        one = np.ones(1)
        if name in problem.parameters:
            return Quantity(one, problem.parameters[name].dimension)
        known = problem.quantities()
        if name not in known:
            raise UnknownName(name, [*problem.parameters, *known], problem.why_not(name))
        wanted = known[name]
        return Quantity(wanted.value([one] * 3), wanted.dimension)

    return resolve


Reductions: TypeAlias = tuple[Reduction, ...] | Reduction | None
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
