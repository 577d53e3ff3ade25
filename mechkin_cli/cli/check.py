"""`mechkin check`: validates files and computes nothing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import Record, put, put_json, refusal, say_diagnostics
from mechkin_cli.cli.options import Files, Json, Quiet, Set
from mechkin_cli.cli.parameters import parameters
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.interface import Model


def check(files: Files, set_: Set = None, json: Json = False, quiet: Quiet = False) -> None:
    """Validate mechanism files; every error with its line and column."""
    settings = parameters(set_)
    code = ExitCode.OK
    records: list[Record] = []
    for path in files:
        outcome, record = _one(path, settings, quiet or json)
        code = max(code, outcome)
        records.append(record | {"valid": outcome == ExitCode.OK})
    if json:
        put_json({"files": records})
    if code:
        raise typer.Exit(code)


def _one(path: Path, settings: dict[str, str], silent: bool) -> tuple[ExitCode, Record]:
    from mechkin_cli.interface import load

    try:
        model = load(path, settings)
        text = f"{path}: ok ({_sentence(model)})\n"
    except (InvalidFile, UsageError) as error:
        return refusal(path, error)
    found = (*model.diagnostics, *_input_faults(model))
    say_diagnostics(found)
    if not silent:
        put(text)
    diagnostics = [diagnostic.record() for diagnostic in found]
    return ExitCode.OK, {"file": str(path), "diagnostics": diagnostics}


def _input_faults(model: Model) -> list[Diagnostic]:
    """What the drawing of an overconstrained mechanism tells of its inputs; by the count of their
    equations its loops would be driven."""
    from mechkin_cli.solver.graph import is_redundant

    if not is_redundant(model.graph):
        return []
    from mechkin_cli.analysis.mobility.drawn import drawn_faults

    path = ("motion", "inputs") if model.problem.motion.inputs else ("joints",)
    place = model.built.read.document.place(path)
    return [fault._replace(place=place) for fault in drawn_faults(model.problem)]


def _sentence(model: Model) -> str:
    counts = (len(model.graph.closings), model.problem.motion.rows, len(model.tables))
    nouns = ("loop", "row", "table")
    return ", ".join(
        f"{count} {noun}{'s' * (count != 1)}" for count, noun in zip(counts, nouns, strict=True)
    )
