"""What `mechkin mobility` does: says what can move, by count and in truth."""

from __future__ import annotations

import sys
from collections import Counter
from typing import TYPE_CHECKING

from mechkin_cli.cli.answer import answer
from mechkin_cli.cli.messages import ExitCode, Record, fitted, put

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.mobility import Mobility

INDENT = 13
"""Characters before what a line says."""


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
        show=lambda _, found: _print(found, quiet),
    )


def _print(found: Mobility, quiet: bool) -> None:
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
        "families": [
            {
                "dimension": family.dimension,
                "excess": family.excess,
                "rests": list(family.rests),
                "inputs": list(family.inputs),
                "sentence": family.sentence,
            }
            for family in found.families
        ],
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
    rows += [("family", family.sentence) for family in found.families]
    return [*lines, *(f"  {name:<{INDENT - 2}}{text}" for name, text in rows)]
