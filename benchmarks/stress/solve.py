"""The solver's answers to a block of files."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from benchmarks.stress.certify import Proofs, prove, unasked
from benchmarks.stress.judge import Found
from benchmarks.stress.quantity import Cell
from mechkin_cli.analysis.analysis import Analysis
from mechkin_cli.bench.runs import CONDITION, TAKEN
from mechkin_cli.model.model import loads
from mechkin_cli.verdict import Status


class Solved(NamedTuple):
    """The answers, what is proven of them, and what was said of refused files, by their number."""

    found: Found
    proofs: Proofs
    refused: dict[int, str]


BOUND = "row.error_bound"


def solve(
    texts: Sequence[str],
    rows: int,
    cells: Sequence[Cell],
    *,
    response: bool = False,
    proven: Collection[int] = (),
) -> Solved:
    """Runs every file, and proves the rows of those whose numbers are among `proven`."""
    names = list(dict.fromkeys(cell.quantity for cell in cells))
    shape = len(texts), rows
    codes = np.full(shape, Status.not_assembled, np.int8)
    condition, bound = np.full(shape, np.nan), np.full(shape, np.nan)
    values = {cell.key: np.full(shape, np.nan) for cell in cells}
    noted, unit = np.zeros((len(texts), 1), bool), np.full((len(texts), 1), np.nan)
    proofs = unasked(*shape, [cell.key for cell in cells])
    refused = {}
    for k, text in enumerate(texts):
        try:
            analysis = _run(text, names, response=response)
        # whatever a file brings about is a finding, and no end of the others
        except Exception as error:
            refused[k] = f"{type(error).__name__}: {error}"
            continue
        codes[k] = analysis.result.status
        condition[k] = analysis[CONDITION]
        if not response:
            bound[k] = analysis[BOUND]
        for cell in cells:
            values[cell.key][k] = cell.column(analysis[cell.quantity])
        unit[k] = analysis.result.session.layout.length
        noted[k] = any(note.code in TAKEN for note in analysis.diagnostics)
        if k in proven:
            prove(proofs, k, analysis, cells)
    return Solved(Found(codes, condition, bound, values, noted, unit), proofs, refused)


def _run(text: str, names: Sequence[str], *, response: bool) -> Analysis:
    model = loads(text)
    if response:
        return model.respond(quantities=[*names, CONDITION], tables=[], threads=1)
    return model.analyze([*names, CONDITION, BOUND], tables=[], threads=1)
