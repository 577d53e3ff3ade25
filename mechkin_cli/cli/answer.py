"""How a command answers a question about one mechanism file, in words or JSON, with its exit code:
mobility, modes and ranges.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from mechkin_cli import tables
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    fitted,
    model_of,
    parameters,
    put,
    put_json,
    refusal,
    say,
    say_diagnostics,
    shown,
)
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.mobility import Mobility
    from mechkin_cli.model import Model
    from mechkin_cli.modes import Modes, Ranges
    from mechkin_cli.tables import Columns


INDENT = 13
"""Characters before what a line of `mechkin mobility` says."""


class _Answer(Protocol):
    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]: ...


Found = TypeVar("Found", bound=_Answer)


def answer(
    file: Path,
    settings: list[str] | None,
    json: bool,
    words: str,
    *,
    ask: Callable[[Model], Found],
    is_answered: Callable[[Found], bool],
    record_of: Callable[[Model, Found], Record],
    show: Callable[[Model, Found], None],
) -> ExitCode:
    """Asks the file's model, and shows the answer or writes one JSON object to stdout; the exit
    code.

    Args:
        words: for a person who waits.
        is_answered: whether the answer holds anything.
    """
    record: Record = {}
    try:
        model = model_of(file, parameters(settings))
        with working(f"{shown(file)}: {words}"):
            found = ask(model)
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    else:
        say_diagnostics(found.diagnostics, shown(file))
        code = ExitCode.OK if is_answered(found) else ExitCode.ROWS_MISSING
        if json:
            record = {"file": shown(file), **record_of(model, found)}
        else:
            show(model, found)
    if json:
        put_json(record)
    return code


# `mechkin mobility`: what can move, by count and in truth.


def mobility(
    file: Path, set_: list[str] | None = None, json: bool = False, quiet: bool = False
) -> ExitCode:
    """The mobility, idle freedoms and redundant constraints."""
    return answer(
        file,
        set_,
        json,
        "looking for what can move",
        ask=lambda model: model.mobility(),
        is_answered=lambda found: found.mobility is not None,
        record_of=lambda _, found: _record(found),
        show=lambda _, found: _print_mobility(found, quiet),
    )


def _print_mobility(found: Mobility, quiet: bool) -> None:
    head, *lines = _lines(found, quiet)
    texts = (fitted(head, sys.stdout), *(fitted(line, sys.stdout, INDENT) for line in lines))
    put("\n".join(texts) + "\n")


def _record(found: Mobility) -> Record:
    return {
        "name": found.name,
        "count": found.count,
        "mobility": found.mobility,
        "first_order": found.first_order,
        "dimensions": list(found.dimensions),
        "loops": found.loops,
        "configurations": found.configurations,
        "inputs": list(found.inputs),
        "idle": [{"links": list(i.links), "sentence": i.sentence} for i in found.idle],
        "redundant": [
            {
                "number": item.number,
                "joints": list(item.joints),
                "wrenches": item.wrenches or None,
                "sentence": item.sentence,
            }
            for item in found.redundant
        ],
        "fixed": list(found.fixed),
        "verdict": found.verdict,
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _truth(found: Mobility) -> str:
    """Finite and first-order freedom, inputs among them."""
    from mechkin_cli.mobility import meeting

    first = "" if found.first_order is None else f"; to first order {found.first_order}"
    if found.mobility is None:
        return f"unclear{first}"
    text = str(found.mobility)
    if len(found.dimensions) > 1:
        text += f", where motions of {meeting(found.dimensions)} freedoms meet"
    same = found.first_order == found.mobility and len(found.dimensions) == 1
    return f"{text}, to first order, too" if same else text + first


def _idle(found: Mobility) -> list[str]:
    several = Counter(item.sentence for item in found.idle)
    return [text if n == 1 else f"{text} ({n} freedoms)" for text, n in several.items()]


def _lines(found: Mobility, quiet: bool) -> list[str]:
    lines = [f"{found.name}: {found.verdict}"]
    if quiet:
        return lines
    rows = [
        ("count", f"{found.count} (Kutzbach)"),
        ("mobility", _truth(found)),
        ("loops", str(found.loops)),
        ("inputs", ", ".join(found.inputs) or "none"),
        *(("idle", text) for text in _idle(found)),
        *(("redundant", item.sentence) for item in found.redundant),
    ]
    if found.fixed:
        rows.append(("fixed", f"{', '.join(found.fixed)} never move"))
    return [*lines, *(f"  {name:<{INDENT - 2}}{text}" for name, text in rows)]


# `mechkin modes`: the ways to assemble a mechanism.


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
        record_of=_modes_record,
        show=lambda model, found: _print(model, found, quiet),
    )


def _place(texts: list[str] | None) -> str | dict[str, str] | None:
    if not texts:
        return None
    if len(texts) == 1 and "=" not in texts[0]:
        return texts[0]
    place = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not value.strip():
            raise UsageError(f"--at {text}: expected INPUT=VALUE, for example O1.theta=50")
        place[name.strip()] = value.strip()
    return place


def _modes_record(model: Model, found: Modes) -> Record:
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
    from mechkin_cli.tables import Columns, TableColumn, Words

    modes, units = found.modes, model.problem.units
    names = tuple(mode.name + ("*" if mode.name == found.picked else " ") for mode in modes)
    columns = [TableColumn("mode", "", Words(np.arange(len(modes), dtype=np.int32), names))]
    for name in modes[0].coordinates:
        unit = units.label(dimension_of(name.rpartition(".")[2]))
        columns.append(
            TableColumn(name, unit, np.array([mode.coordinates[name] for mode in modes]))
        )
    columns.append(TableColumn("residual", "", np.array([mode.residual for mode in modes])))
    columns.append(TableColumn("condition", "", np.array([mode.condition for mode in modes])))
    return Columns("modes", "assembly modes", tuple(columns))


# `mechkin ranges`: from where to where an input can go in each assembly mode.

RANGE_DECIMALS = 6
"""Decimals shown; JSON has all digits."""

LIMIT_WORDS = {
    "dead-centre": "dead centre",
    "branch-point": "branch point",
    "unbounded": "a slide grows out of bounds",
    "branch-lost": "could not be followed further",
    "far": "no end found so far",
}


def ranges(
    file: Path,
    input: str | None = None,
    output: list[str] | None = None,
    set_: list[str] | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """The range of an input in each assembly mode, and the circuits that the modes form."""
    return answer(
        file,
        set_,
        json,
        "following each mode to its ends",
        ask=lambda model: model.ranges(input, output or ()),
        is_answered=lambda found: bool(found.ranges),
        record_of=_ranges_record,
        show=lambda model, found: _print_ranges(model, found, quiet),
    )


def _ranges_record(model: Model, found: Ranges) -> Record:
    return {
        "name": model.name,
        "input": found.input,
        "unit": found.unit,
        "held": found.at,
        "ranges": [
            {
                "mode": item.mode,
                "from": item.lower._asdict(),
                "to": item.upper._asdict(),
                "full_turn": item.turns > 0,
                "turns": item.turns,
                "circuit": item.circuit,
                "extremes": [extreme._asdict() for extreme in item.extremes],
            }
            for item in found.ranges
        ],
        "circuits": [list(circuit) for circuit in found.circuits],
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _print_ranges(model: Model, found: Ranges, quiet: bool) -> None:
    from mechkin_cli.cli.show import shown_table

    if found.ranges:
        put(shown_table(_ranges_table(found), len(found.ranges)))
        if any(item.extremes for item in found.ranges):
            count = sum(len(item.extremes) for item in found.ranges)
            put(shown_table(_extremes(found), count))
    if quiet:
        return
    held = "".join(f", {name} held at {value:.12g}" for name, value in found.at.items())
    say(f"{model.name}: ranges of {found.input}{held}")
    for number, circuit in enumerate(found.circuits, 1):
        modes = "mode" if len(circuit) == 1 else "modes"
        say(f"  circuit {number}: {modes} {', '.join(circuit)}{_closing(found, circuit)}")


def _closing(found: Ranges, circuit: tuple[str, ...]) -> str:
    turns = next(item.turns for item in found.ranges if item.mode == circuit[0])
    if turns == 1:
        return "; turns fully, back at its start after one turn"
    return f"; turns fully, back at its start after {turns} turns" if turns else ""


def _ranges_table(found: Ranges) -> Columns:
    """Mode, both ends with what is there, circuit."""
    items = found.ranges
    columns = [tables.TableColumn("mode", "", tables.words_of([item.mode for item in items]))]
    for label, end, limits in (
        ("from", "lower end", [item.lower for item in items]),
        ("to", "upper end", [item.upper for item in items]),
    ):
        pairs = list(zip(items, limits, strict=True))
        values = [float("nan") if item.turns else limit.value for item, limit in pairs]
        kinds = ["turns fully" if item.turns else LIMIT_WORDS[limit.kind] for item, limit in pairs]
        columns.append(tables.column_of_numbers(label, found.unit, values, RANGE_DECIMALS))
        columns.append(tables.TableColumn(end, "", tables.words_of(kinds)))
    columns.append(tables.column_of_numbers("circuit", "", [item.circuit for item in items], 0))
    return tables.Columns("ranges", f"ranges of {found.input}", tuple(columns))


def _extremes(found: Ranges) -> Columns:
    """Mode, output, its extreme value and the input there."""
    rows = [(item.mode, extreme) for item in found.ranges for extreme in item.extremes]
    columns = (
        tables.TableColumn("mode", "", tables.words_of([mode for mode, _ in rows])),
        tables.TableColumn("output", "", tables.words_of([e.output for _, e in rows])),
        tables.column_of_numbers("value", "", [e.value for _, e in rows], RANGE_DECIMALS),
        tables.column_of_numbers(
            found.input, found.unit, [e.input for _, e in rows], RANGE_DECIMALS
        ),
    )
    return tables.Columns("extremes", "dead centres of the outputs", columns)
