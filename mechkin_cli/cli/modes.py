"""What `mechkin modes` does: lists the ways to assemble a mechanism."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mechkin_cli import tables
from mechkin_cli.cli.answer import answer
from mechkin_cli.cli.messages import ExitCode, Record, put, say, values_by_name

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.model import Model
    from mechkin_cli.modes import Modes
    from mechkin_cli.tables import Columns


def modes(
    file: Path,
    at: list[str] | None = None,
    run: str | None = None,
    certify: bool = False,
    set_: list[str] | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """The assembly modes: the ways to put a mechanism together."""
    return answer(
        file,
        set_,
        json,
        "searching for assembly modes",
        ask=lambda model: model.modes(_place(at), run=run, certify=certify),
        is_answered=lambda found: bool(found.modes),
        record_of=_record,
        show=lambda model, found: _print(model, found, quiet),
    )


def _place(texts: list[str] | None) -> str | dict[str, str] | None:
    if not texts:
        return None
    if len(texts) == 1 and "=" not in texts[0]:
        return texts[0]
    return values_by_name("--at", texts, "INPUT=VALUE, for example O1.theta=50")


def _record(model: Model, found: Modes) -> Record:
    record = _found_record(model, found)
    if found.proofs is not None:
        for mode, proof in zip(record["modes"], found.proofs.modes, strict=True):
            mode["proof"] = proof.label
        record["proofs"] = found.proofs.sentence
    return record


def _found_record(model: Model, found: Modes) -> dict[str, Any]:
    return {
        "name": model.name,
        "inputs": found.inputs,
        "modes": [mode._asdict() for mode in found.modes],
        "assembly": found.picked,
        "search": {
            "starts": found.starts,
            "closed": found.closed,
            "chance": found.chance,
            "confidence": found.confidence,
            "stopped": found.stopped,
            "cut": found.is_cut,
            "turns": found.turns,
        },
        "bound": found.bound,
        "complete": found.complete,
        "completeness": found.sentence,
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _print(model: Model, found: Modes, quiet: bool) -> None:
    from mechkin_cli.cli.show import shown_table
    from mechkin_cli.modes import UNNAMED

    if found.modes:
        put(shown_table(_table(model, found), len(found.modes)))
    if quiet:
        return
    place = ", ".join(f"{name} = {value:.12g}" for name, value in found.inputs.items())
    say(f"{model.name}{' at ' if place else ''}{place}: {found.sentence}")
    if found.proofs is not None:
        say(f"  proofs: {found.proofs.sentence}")
    if found.picked:
        say(f"  * mode {found.picked} is the one that the file takes")
    if any(mode.name == UNNAMED for mode in found.modes):
        say(f"  {UNNAMED} no branch from the first row comes here")


def _table(model: Model, found: Modes) -> Columns:
    """Name (with a star where the file takes the mode), coordinates, residual, condition."""
    import numpy as np

    from mechkin_cli.mechanism import dimension_of
    from mechkin_cli.units import LENGTH

    modes, units = found.modes, model.problem.units
    names = tuple(mode.name + ("*" if mode.name == found.picked else " ") for mode in modes)
    columns = [
        tables.TableColumn("mode", "", tables.Words(np.arange(len(modes), dtype=np.int32), names))
    ]
    for name in modes[0].numbers:
        is_place = name in modes[0].places
        unit = units.label(LENGTH if is_place else dimension_of(name.rpartition(".")[2]))
        columns.append(
            tables.TableColumn(name, unit, np.array([mode.numbers[name] for mode in modes]))
        )
    columns.append(tables.TableColumn("residual", "", np.array([mode.residual for mode in modes])))
    columns.append(
        tables.TableColumn("condition", "", np.array([mode.condition for mode in modes]))
    )
    return tables.Columns("modes", "assembly modes", tuple(columns))
