"""Many variants of one response at once: each is built as `with_parameters` builds it, and those of
one structure are integrated together, several to a pack of the kernel's lanes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis import Analysis, Design, Solvable
from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.mechanism import response_problem
from mechkin_cli.response import integrated, prepare, read
from mechkin_cli.variants.design import base_of, file_values, parameter_arrays
from mechkin_cli.variants.result import (
    Reduce,
    Variants,
    expressions_of,
    need_places,
    reduced,
    reductions_of,
    with_held,
)
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.response import Prepared, ResponseResult
    from mechkin_cli.session import Packing
    from mechkin_cli.show import Floats


TIME = "time"

CHUNK = 512
"""Variants that are held at a time: memory stays flat, and packs are full."""


def vary_response(
    model: Solvable,
    parameters: Mapping[str, Any],
    quantities: Iterable[str] | None,
    reduce: Reduce | Sequence[Reduce] | Mapping[str, Any] | None,
    run: str,
    packing: Packing,
) -> Variants:
    """`Model.vary` of a response, whose arguments these are.

    Rows are the moments asked for; where a stop ends a variant its row takes the place of the next
    moment (`time` tells), and those behind it hold nan.
    """
    problem = base_of(model.design).design.problem
    names, values = parameter_arrays(problem, parameters)
    given = file_values(values, problem, names)
    names, values = with_held(list(problem.parameters), names, values, model.design.values)
    known = response_problem(problem, problem.responses[run])
    asked = expressions_of(
        problem.mechanism.coordinates if quantities is None else quantities, known
    )
    reductions = reductions_of(asked, reduce)
    read = dict.fromkeys((*asked, TIME)) if need_places(reductions) else asked
    study = _Study(model, names, list(read), run, packing)
    found = study.run(values)
    kept = {text: reduced(text, found[text], reductions[text], found.get(TIME)) for text in asked}
    return Variants(given, kept, study.codes, study.errors)


class _Study:
    """One call: arrays (variants, rows) or (variants, rows, 3) by the texts asked for."""

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
            models: dict[int, tuple[Solvable, Prepared]] = {}
            for number in range(begin, min(begin + CHUNK, count)):
                self._prepare(number, values[:, number], models)
            results = integrated([one for _, one in models.values()], self.packing)
            for number, result in zip(models, results, strict=True):
                self._take(number, models[number][0], result, found, count)
        for text in self.asked:
            found.setdefault(text, np.full((count, self.rows), np.nan))
        return found

    def _prepare(
        self, number: int, row: Floats, models: dict[int, tuple[Solvable, Prepared]]
    ) -> None:
        try:
            built = self.base.built(dict(zip(self.names, row.tolist(), strict=True)))
            design = Design(built, self.base.design.stem)
            session = design.session_of(self.name)
            response = built.problem.responses[self.name]
            prepared = prepare(built.problem, response, self.packing, session)
            models[number] = self.model.of(design), prepared
        except MechkinError as error:
            self.errors[number] = error

    def _take(
        self,
        number: int,
        model: Solvable,
        result: ResponseResult,
        found: dict[str, Floats],
        count: int,
    ) -> None:
        known = result.problem.quantities()
        parse = result.problem.definitions.parse
        used = (name for text in self.asked for name in sorted(parse(text).names))
        whole = (name if name in known else name.rpartition(".")[0] for name in used)
        read(result, [name for name in dict.fromkeys(whole) if name in known])
        analysis = Analysis(model, (), result, self.name)
        rows = min(result.rows, self.rows)
        self.codes[number] = int(Status.ok)
        self.codes[number, :rows] = result.status[:rows]
        for text in self.asked:
            array = np.asarray(analysis[text], dtype=np.float64)[:rows]
            if text not in found:
                found[text] = np.full((count, self.rows, *array.shape[1:]), np.nan)
            found[text][number, :rows] = array
