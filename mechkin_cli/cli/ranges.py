"""What `mechkin ranges` does: says from where to where an input can go in each assembly mode."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from mechkin_cli import tables
from mechkin_cli.cli.answer import answer
from mechkin_cli.cli.messages import ExitCode, Record, put, say

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.model import Model
    from mechkin_cli.modes import Ranges
    from mechkin_cli.tables import Columns

RANGE_DECIMALS = 6
"""Decimals shown; JSON has all digits."""

LIMIT_WORDS = {
    "dead-centre": "dead centre",
    "branch-point": "branch point",
    "hold-ends": "hold of an idle freedom",
    "limit": "limit",
    "nowhere": "nowhere within the limits",
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
        record_of=_record,
        show=lambda model, found: _print(model, found, quiet),
    )


def _record(model: Model, found: Ranges) -> Record:
    return {
        "name": model.name,
        "input": found.input,
        "unit": found.unit,
        "held": found.at,
        "ranges": [
            {
                "mode": item.mode,
                "from": _end(*item.lower),
                "to": _end(*item.upper),
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


def _end(kind: str, value: float) -> Record:
    return {"kind": kind, "value": value if isfinite(value) else None}


def _print(model: Model, found: Ranges, quiet: bool) -> None:
    from mechkin_cli.cli.show import shown_table

    if found.ranges:
        put(shown_table(_table(found), len(found.ranges)))
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


def _table(found: Ranges) -> Columns:
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
