"""Small motions of a model about a row of one of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import view
from mechkin_cli.analysis import Analysis, Solvable
from mechkin_cli.arguments import a_whole_number, texts
from mechkin_cli.expressions import parse
from mechkin_cli.tables import ColumnLayout, TableLayout
from mechkin_cli.vibration import Vibration, freed, played

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike
    from pathlib import Path

    from mechkin_cli.analysis import Design
    from mechkin_cli.arguments import Setting


class Moving(Solvable, Protocol):
    """What is asked of a model."""

    @property
    def design(self) -> Design:
        """The checked file with the values of its parameters."""
        ...

    @property
    def runs(self) -> tuple[str, ...]:
        """The names of its runs."""
        ...

    def analyses(self, run: str | None = None, mode: str | None = None) -> list[Analysis]:
        """All runs, or one."""
        ...

    def with_parameters(self, parameters: Mapping[str, Setting]) -> Moving:
        """The model with other values of some parameters."""
        ...


def vibration(
    model: Moving,
    run: str | None,
    row: int,
    coordinates: Sequence[str] | None,
    held: Sequence[str],
) -> Vibration:
    """Arguments and errors are those of `Model.vibration`."""
    held = texts("held", held, '["A.theta"]')
    a_whole_number("row", row, "", 0)
    if coordinates is not None:
        coordinates = texts("coordinates", coordinates, '["A.theta"]')
    name = run or _first_run(model)
    (analysis,) = model.analyses(name)
    units, parameters = analysis.result.units, analysis.result.problem.parameters

    def again(parameter: str, factor: float) -> Vibration:
        value = parameters[parameter]
        own = units.from_si(factor * float(value.value), value.dimension)  # type: ignore[arg-type]
        other = model.with_parameters({parameter: float(own)})
        return vibration(other, name, row, coordinates, held)

    place = freed(analysis.result, row, coordinates, held)

    def shown(found: Vibration, path: str | PathLike[str] | None) -> view.Page | Path:
        page, _ = view.view_page(list(modes(found)), modes=False)
        return view.Page(page) if path is None else view.write_view(path, page)

    def modes(found: Vibration) -> Iterator[Analysis]:
        for number, (shape, frequency) in enumerate(
            zip(found.shapes.T, found.frequencies, strict=True)
        ):
            parts = np.asarray(shape.real), np.asarray(shape.imag)
            rows = played(place, analysis.result, row, parts, float(frequency))
            name = f"mode {number + 1}, {frequency:.4g} Hz"
            yield Analysis(model, (_swung(name, found.coordinates),), rows, name)

    return Vibration(place, again, shown)


def _swung(run: str, coordinates: Sequence[str]) -> TableLayout:
    columns = tuple(ColumnLayout(name, parse(name)) for name in ("time", *coordinates))
    return TableLayout(run, "Coordinates over a period", columns, run=run)


def _first_run(model: Moving) -> str:
    """The first equilibria of the file, else its first run."""
    responses = model.design.at_responses.problem.responses
    resting = (run for run, one in responses.items() if getattr(one, "search", None) is not None)
    return next(resting, model.runs[0])
