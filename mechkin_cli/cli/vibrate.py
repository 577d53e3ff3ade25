"""What `mechkin vibrate` does: small motions about a row of a run, their tables, and the answer to
a harmonic input."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import plots, tables
from mechkin_cli.cli.answer import answer
from mechkin_cli.cli.messages import ExitCode, Record, put, say, stem_of
from mechkin_cli.cli.show import files_line
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.vibration import vibration_tables

if TYPE_CHECKING:
    from mechkin_cli.model import Model
    from mechkin_cli.vibration import FrequencyResponse, StateSpace, Vibration

MOST_FREQUENCIES = 100_000
_FREQUENCIES = "--frequencies takes FROM:TO:COUNT in Hz, for example 0.1:100:400"


def vibrate(
    file: Path,
    run: str | None = None,
    row: int = 0,
    coordinates: list[str] | None = None,
    hold: list[str] | None = None,
    input_: list[str] | None = None,
    output: list[str] | None = None,
    frequencies: str | None = None,
    view: bool = False,
    out: Path | None = None,
    set_: list[str] | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """Small motions about a row: matrices, modes, state space, frequency response."""
    inputs, outputs = _names(input_), _names(output)
    places = None if frequencies is None else _frequencies(frequencies)
    if places is not None and (len(inputs) != 1 or not outputs):
        raise UsageError("--frequencies needs one --input and at least one --output")
    folder = Path("out") / stem_of(file) if out is None else out

    def files(found: Vibration) -> dict[str, bytes]:
        space = found.state_space(inputs, outputs) if inputs or outputs else None
        told = None if places is None else found.response(places, inputs[0], outputs)
        return _files(found, space, told, view)

    return answer(
        file,
        set_,
        json,
        "small motions",
        ask=lambda model: model.vibration(run, row, _names(coordinates) or None, held=_names(hold)),
        is_answered=lambda found: True,
        record_of=lambda model, found: _record(
            model, found, tables.write_files(folder, files(found))
        ),
        show=lambda model, found: _show(
            model, found, folder, tables.write_files(folder, files(found)), quiet
        ),
    )


def _names(texts: list[str] | None) -> list[str]:
    """Names separated by commas that are in no brackets, of repeated options."""
    found: list[str] = []
    for text in texts or ():
        depth, name = 0, ""
        for letter in text:
            depth += (letter in "([") - (letter in ")]")
            if letter == "," and depth == 0:
                found.append(name.strip())
                name = ""
            else:
                name += letter
        found.append(name.strip())
    return [name for name in found if name]


def _frequencies(text: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    parts = text.split(":")
    try:
        first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (ValueError, IndexError):
        raise UsageError(_FREQUENCIES) from None
    if len(parts) != 3 or not 0.0 < first < last < np.inf or not 2 <= count <= MOST_FREQUENCIES:
        raise UsageError(_FREQUENCIES)
    from mechkin_cli.kernel.functions import exp, log

    steps = np.arange(count) / (count - 1.0)
    low, high = float(log(first)), float(log(last))
    places = np.asarray(exp(low + (high - low) * steps))
    places[0], places[-1] = first, last
    return places


def _files(
    found: Vibration, space: StateSpace | None, told: FrequencyResponse | None, view: bool
) -> dict[str, bytes]:
    files = {
        f"{stem}.csv": _csv(rows) for stem, rows in vibration_tables(found, space, told).items()
    }
    files["modes.svg"] = found.picture().encode("utf-8")
    if told is not None:
        try:
            files["response.svg"] = plots.answer_image(told, "svg")
        except UsageError as missing:  # without matplotlib there is the table alone
            say(f"no picture of the response: {missing}")
    if view:
        files["modes.html"] = found.view().html.encode("utf-8")
    return files


def _csv(rows: list[list[str]]) -> bytes:
    stream = io.StringIO(newline="")
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue().encode()


def _record(model: Model, found: Vibration, written: list[Path]) -> Record:
    shapes = np.asarray(found.shapes)
    return {
        "name": model.name,
        "coordinates": list(found.coordinates),
        "units": list(found.units),
        "driven": list(found.driven),
        "holding": _numbers(found.holding),
        "frequencies": _numbers(found.frequencies),
        "damping_ratios": _numbers(found.damping_ratios),
        "shapes": {"real": _numbers(shapes.real), "imaginary": _numbers(shapes.imag)},
        "participation": _numbers(found.participation),
        "mass": _numbers(found.mass),
        "damping": _numbers(found.damping),
        "stiffness": _numbers(found.stiffness),
        "files": [str(path) for path in written],
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _numbers(values: Any) -> Any:
    """Nested lists of numbers, None for what is none."""
    if isinstance(values, np.ndarray):
        return [_numbers(value) for value in values]
    return float(values) if np.isfinite(values) else None


def _show(model: Model, found: Vibration, folder: Path, written: list[Path], quiet: bool) -> None:
    put(found.listing.text())
    if quiet:
        return
    say(f"{model.name}: {'stable' if found.is_stable else 'not stable'}")
    say(files_line(folder, written, []))
