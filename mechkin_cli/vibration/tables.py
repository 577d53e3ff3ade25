"""The tables of small motions: CSV files with SI units in their heads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.show import Floats
    from mechkin_cli.vibration.vibration import FrequencyResponse, StateSpace, Vibration

    Rows = list[list[str]]


def vibration_tables(
    vibration: Vibration, space: StateSpace | None = None, answer: FrequencyResponse | None = None
) -> dict[str, Rows]:
    """Rows of cells, the first a head, by the stems of their files."""
    named = [f"{n} [{u}]" for n, u in zip(vibration.coordinates, vibration.units, strict=True)]
    found = {"frequencies": _modes(vibration), "shapes": _shapes(vibration, named)}
    for name in ("mass", "damping", "stiffness"):
        found[name] = _matrix(named, named, getattr(vibration, name))
    if space is not None:
        parts = {
            "A": (space.states, space.states),
            "B": (space.states, space.inputs),
            "C": (space.outputs, space.states),
            "D": (space.outputs, space.inputs),
        }
        for name, (rows, columns) in parts.items():
            found[name] = _matrix(rows, columns, getattr(space, name))
    if answer is not None:
        found["response"] = _answer(answer)
    return found


def _cell(number: float) -> str:
    """The shortest text of a number; nothing where there is none."""
    return "" if np.isnan(number) else repr(float(number) + 0.0)


def _modes(vibration: Vibration) -> Rows:
    head = ["mode", "frequency [Hz]", "damping ratio", "eigenvalue [1/s]", "imaginary part [1/s]"]
    columns = zip(
        vibration.frequencies, vibration.damping_ratios, vibration.eigenvalues, strict=True
    )
    rows = [
        [str(k), _cell(f), _cell(zeta), _cell(value.real), _cell(value.imag)]
        for k, (f, zeta, value) in enumerate(columns, 1)
    ]
    return [head, *rows]


def _shapes(vibration: Vibration, named: Sequence[str]) -> Rows:
    """A row for each coordinate: the shapes, their imaginary parts where they have some, and what
    part of a mode's kinetic energy goes with it."""
    shapes = vibration.shapes
    modes = range(1, shapes.shape[1] + 1)
    parts = [("mode", shapes.real)]
    if np.iscomplexobj(shapes):
        parts.append(("imaginary part", shapes.imag))
    parts.append(("energy", vibration.participation))
    head = ["coordinate", *(f"{word} {k}" for word, _ in parts for k in modes)]
    rows = [
        [name, *(_cell(number) for _, part in parts for number in part[k])]
        for k, name in enumerate(named)
    ]
    return [head, *rows]


def _matrix(rows: Sequence[str], columns: Sequence[str], matrix: Floats) -> Rows:
    cells = [[name, *map(_cell, row)] for name, row in zip(rows, matrix, strict=True)]
    return [["", *columns], *cells]


def _answer(answer: FrequencyResponse) -> Rows:
    words = ("amplitude", "phase [deg]")
    head = ["frequency [Hz]", *(f"{name} {word}" for name in answer.outputs for word in words)]
    rows = [
        [_cell(f), *(_cell(x) for pair in zip(a, p, strict=True) for x in pair)]
        for f, a, p in zip(answer.frequencies, answer.amplitude.T, answer.phase.T, strict=True)
    ]
    return [head, *rows]
