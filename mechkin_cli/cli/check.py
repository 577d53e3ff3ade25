"""`mechkin check`: validates files and computes nothing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import mobility, structure
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    model_of,
    parameters,
    put,
    put_json,
    refusal,
    say_diagnostics,
    shown,
    tell_as,
)
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Severity, UsageError
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.model import Model
    from mechkin_cli.structure import SolverGraph


def check(
    files: list[Path],
    set_: list[str] | None = None,
    messages: str | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """Validates mechanism files; every error with its line and column."""
    tell_as(messages)
    settings = parameters(set_)
    code = ExitCode.OK
    records: list[Record] = []
    for path in files:
        outcome, record = _one(path, settings, quiet or json)
        code = max(code, outcome)
        records.append(record | {"valid": outcome == ExitCode.OK})
    if json:
        put_json({"files": records})
    return code


def _one(path: Path, settings: dict[str, str], silent: bool) -> tuple[ExitCode, Record]:
    try:
        model = model_of(path, settings)
        text = f"{shown(path)}: ok ({_sentence(model)})\n"
    except (InvalidFile, UsageError) as error:
        return refusal(path, error)
    diagnostics = (*model.diagnostics, *_input_faults(model), *_missing_print(model))
    say_diagnostics(diagnostics, shown(path))
    if not silent:
        put(text)
    return ExitCode.OK, {"file": shown(path), "diagnostics": [d.record() for d in diagnostics]}


def _input_faults(model: Model) -> list[Diagnostic]:
    """Inputs of an overconstrained mechanism that cannot move in its drawing; by the count of their
    equations its loops would be driven."""
    faults = []
    for run in model.runs:
        if run == SWEEP:
            inputs = model.problem.motion.inputs
            path: tuple[str, ...] = ("motion", "inputs") if inputs else ("joints",)
        else:
            response = model.response(run)
            path = (response.section, run, response.named)
        if structure.is_redundant(_graph(model, run)):
            place = model.built.document.place(path)
            found = mobility.drawn_faults(model.session_of(run))
            faults += [fault._replace(place=place) for fault in found]
    return faults


def _missing_print(model: Model) -> list[Diagnostic]:
    """One warning of all missing files of printed values, which tables only need for comparison;
    a note where none is there, as beside a copied mechanism file."""
    document, tables = model.built.document, model.built.file.tables
    folder = document.folder
    printed = {i: table.published.file for i, table in enumerate(tables) if table.published}
    if folder is None:
        return []
    missing = [i for i, file in printed.items() if not (folder / file).is_file()]
    if not missing:
        return []
    first, *others = missing
    path: tuple[str | int, ...] = ("tables", first, "published")
    at = path if document.node((*path, "file")) is None else (*path, "file")
    more = f", nor in {len(others)} other{'s' * (len(others) > 1)}" if others else ""
    text = f"there are no printed values in {folder / printed[first]}{more}"
    hint = "the path leads from the folder of the mechanism file; put the file there"
    severity: Severity = "note" if len(missing) == len(printed) else "warning"
    place = document.place(at)
    return [Diagnostic("published-missing", severity, text, place, hint=hint)]


def _sentence(model: Model) -> str:
    graphs = [_graph(model, run) for run in model.runs]
    rows = sum(model.problem.responses[run].rows for run in model.runs if run != SWEEP)
    rows += model.problem.motion.rows if SWEEP in model.runs else 0
    # couplings and what cables are made of are no loops of the file
    mechanism = model.problem.mechanism
    unseen = mechanism.loops - mechanism.told_loops
    loops = max(sum(not closing.terms for closing in graph.closings) for graph in graphs)
    counts = {"loop": max(loops - unseen, 0), "row": rows}
    rests = sum(one.search is not None for one in model.problem.responses.values())
    moves = len(model.problem.responses) - rests
    counts |= {"response": moves} if moves else {}
    counts |= {"run of equilibria": rests} if rests else {}
    counts |= {"table": len(model.tables)}
    return ", ".join(f"{n} {noun}{'s' * (n != 1)}" for noun, n in counts.items())


def _graph(model: Model, run: str) -> SolverGraph:
    return model.graph if run == SWEEP else model.response_graph(run)
