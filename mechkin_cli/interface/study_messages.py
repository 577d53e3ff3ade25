"""What a study says of a variant that is not ok, in one line."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import InvalidFile, MechkinError
from mechkin_cli.status import Status
from mechkin_cli.studies.records import Heading, empty_values

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.variants import Variants
    from mechkin_cli.studies.records import Values

LONGEST_MESSAGE = 300


def messages(
    found: Variants, texts: Iterable[str], along: Heading | None, places: Floats | None
) -> Values:
    """Why variants are not ok (variants,), "" of those that are: what was said where one cannot be
    built, else the verdict of the first row that is not ok, with what is infinite.

    Args:
        found: all rows of the variants.
        texts: what is kept of them.
        along: what the run goes along, None where nothing moves.
        places: its values in the rows (variants, rows).
    """
    told = empty_values("text", len(found))
    not_ok = found.codes != Status.ok
    infinite = _infinite(found, texts)
    for number in np.flatnonzero(not_ok.any(axis=1)).tolist():
        row = int(np.argmax(not_ok[number]))
        place = "" if places is None else _place(along, float(places[number, row]))
        reason = _reason(Status(int(found.codes[number, row])))
        text = f"row {row + 1}{place}: {reason}{infinite.get(number, '')}"
        told[number] = text[:LONGEST_MESSAGE]
    for number, error in found.errors.items():
        told[number] = _said(error)
    return told


def _reason(status: Status) -> str:
    """Without what becomes of cells where those that are infinite are named."""
    sentence = status.sentence.rstrip(".")
    return sentence.partition(":")[0] if status is Status.dead_centre else sentence


def _infinite(found: Variants, texts: Iterable[str]) -> dict[int, str]:
    """Which of what is kept is infinite, and in which row first, by the number of the variant."""
    at = found.codes == Status.dead_centre
    numbers = np.flatnonzero(at.any(axis=1))
    told: dict[int, str] = {}
    for text in texts if numbers.size else ():
        rows = np.isinf(found[text][numbers])
        for number, where in zip(numbers.tolist(), rows, strict=True):
            if where.any():
                one = f"{text} in row {int(np.argmax(where)) + 1}"
                told[number] = f"{told[number]}, {one}" if number in told else f"; infinite: {one}"
    return told


def _place(along: Heading | None, place: float) -> str:
    if along is None or np.isnan(place):
        return ""
    return f" ({along.label} = {place:.9g} {along.unit}".rstrip() + ")"


def _said(error: MechkinError) -> str:
    """What was said of a variant that cannot be built."""
    text = str(error)
    if isinstance(error, InvalidFile):
        first = next((d for d in error.diagnostics if d.severity == "error"), None)
        text = str(first._replace(place=None)) if first is not None else text
    return " ".join(text.split())[:LONGEST_MESSAGE]
