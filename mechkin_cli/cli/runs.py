"""The runs of one file: its sweep and its responses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.runs import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis, Model


def run_all(
    model: Model,
    tables: Sequence[str] | None = None,
    mode: str | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> list[Analysis]:
    """Every run that has one of the tables wanted (None: all), the sweep first; `tell` hears which
    is under way.

    Raises:
        UsageError: no run has a table of a name.
        InvalidFile: a run cannot be solved as it is driven.
    """
    runs = dict.fromkeys(model.runs)
    wanted = None if tables is None else {run: _of_run(model, tables, run) for run in runs}
    if wanted is not None:
        _refuse_unknown(model, tables or ())
        runs = {run: None for run in runs if wanted[run]}
    found = []
    for run in runs:
        chosen = None if wanted is None else wanted[run]
        tell(_words(model, run))
        if run == SWEEP:
            found.append(model.analyze(tables=chosen, mode=mode))
        else:
            found.append(model.respond(run, tables=chosen, mode=mode))
    return found


def _words(model: Model, run: str) -> str:
    if run != SWEEP:
        return f"integrating {run}"
    return f"following {model.problem.motion.rows} rows"


def certify_sweeps(analyses: Sequence[Analysis]) -> tuple[Diagnostic, ...]:
    """Makes the proofs of sweeps; a note for each response, whose rows have none."""
    notes = []
    for analysis in analyses:
        if analysis.run == SWEEP:
            _ = analysis.certificate
            continue
        text = f"the rows of response {analysis.run} are not proven: --certify proves sweeps"
        notes.append(Diagnostic("not-proven", "note", text))
    return tuple(notes)


def _of_run(model: Model, tables: Sequence[str], run: str) -> list[str]:
    own = {table.name for table in model.tables if table.run == run}
    own |= {one.name for one in model.built.coefficients} if run == SWEEP else set()
    return [name for name in tables if name in own]


def _refuse_unknown(model: Model, tables: Sequence[str]) -> None:
    known = [table.name for table in model.tables]
    known += sorted(one.name for one in model.built.coefficients)
    for name in tables:
        if name not in known:
            raise UsageError(
                f"there is no table {name[:LONGEST_NAME]}; tables are {', '.join(known)}"
            )
