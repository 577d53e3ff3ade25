"""The solver's answers to a block of files."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mechkin_cli.benchmark.stress.judge import Found
from mechkin_cli.benchmark.stress.numbers.series import Series
from mechkin_cli.benchmark.stress.quantity import Quantity
from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.interface import Analysis, loads
from mechkin_cli.status import Status

BOUND = "row.error_bound"


def solve(
    texts: Sequence[str], rows: int, quantities: Sequence[Quantity], *, response: bool = False
) -> tuple[Found, dict[int, str]]:
    """Runs every file; with what was said of those that were refused, by their number."""
    names = []
    for quantity in quantities:
        rates = ("_dot", "_ddot") if isinstance(quantity.value, Series) else ()
        names += [quantity.name + suffix for suffix in ("", *rates)]
    shape = len(texts), rows
    codes = np.full(shape, Status.not_assembled, np.int8)
    condition, bound = np.full(shape, np.nan), np.full(shape, np.nan)
    values = {name: np.full(shape, np.nan) for name in names}
    refused = {}
    for k, text in enumerate(texts):
        try:
            analysis = _run(text, names, response=response)
        except MechkinError as error:
            refused[k] = str(error)
            continue
        codes[k] = analysis.result.status
        condition[k] = analysis["row.condition"]
        if BOUND in analysis.model.quantities:
            bound[k] = analysis[BOUND]
        for name in names:
            values[name][k] = analysis[name]
    return Found(codes, condition, bound, values), refused


def _run(text: str, names: Sequence[str], *, response: bool) -> Analysis:
    model = loads(text)
    more = [name for name in ("row.condition", BOUND) if name in model.quantities]
    if response:
        return model.respond(quantities=[*names, *more], tables=[], threads=1)
    return model.analyze([*names, *more], tables=[], threads=1)
