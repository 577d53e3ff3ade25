"""`mechkin ranges`: from where to where an input can go in each assembly mode."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.cli.answer import Question, answer
from mechkin_cli.cli.messages import ExitCode, Record, put, say

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.model import Model
    from mechkin_cli.modes import Range, Ranges
    from mechkin_cli.tables import Columns


DECIMALS = 6
"""Decimals shown; JSON has all digits."""

WORDS = {
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
    question = Question(
        ask=lambda model: model.ranges(input, output or ()),
        is_answered=lambda found: bool(found.ranges),
        record=_record,
        show=lambda model, found: _print(model, found, quiet),
        words="following each mode to its ends",
    )
    return answer(file, set_, json, question)


def _record(model: Model, found: Ranges) -> Record:
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
    import numpy as np

    from mechkin_cli.tables import Columns, TableColumn, Words

    def words(texts: list[str]) -> Words:
        return Words(np.arange(len(texts), dtype=np.int32), tuple(texts))

    def ends(upper: bool) -> list[TableColumn]:
        limits = [item.upper if upper else item.lower for item in found.ranges]
        values = [
            _value(item, limit.value) for item, limit in zip(found.ranges, limits, strict=True)
        ]
        label, end = ("to", "upper end") if upper else ("from", "lower end")
        kinds = [
            "turns fully" if item.turns else WORDS[limit.kind]
            for item, limit in zip(found.ranges, limits, strict=True)
        ]
        return [
            TableColumn(label, found.unit, np.array(values), DECIMALS),
            TableColumn(end, "", words(kinds)),
        ]

    columns = (
        TableColumn("mode", "", words([item.mode for item in found.ranges])),
        *ends(False),
        *ends(True),
        TableColumn("circuit", "", np.array([float(item.circuit) for item in found.ranges]), 0),
    )
    return Columns("ranges", f"ranges of {found.input}", columns)


def _value(item: Range, value: float) -> float:
    return float("nan") if item.turns else value


def _extremes(found: Ranges) -> Columns:
    """Mode, output, its extreme value and the input there."""
    import numpy as np

    from mechkin_cli.tables import Columns, TableColumn, Words

    rows = [(item.mode, extreme) for item in found.ranges for extreme in item.extremes]
    number = np.arange(len(rows), dtype=np.int32)
    return Columns(
        "extremes",
        "dead centres of the outputs",
        (
            TableColumn("mode", "", Words(number, tuple(mode for mode, _ in rows))),
            TableColumn("output", "", Words(number, tuple(e.output for _, e in rows))),
            TableColumn("value", "", np.array([e.value for _, e in rows]), DECIMALS),
            TableColumn(found.input, found.unit, np.array([e.input for _, e in rows]), DECIMALS),
        ),
    )
