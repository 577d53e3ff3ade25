"""Small motions of a model about a row of one of its runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import view
from mechkin_cli.analysis import Analysis, Solvable
from mechkin_cli.arguments import a_whole_number, texts
from mechkin_cli.expressions import parse
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import ColumnLayout, TableLayout
from mechkin_cli.vibration import Vibration, freed, played, swung

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike
    from pathlib import Path

    from mechkin_cli.analysis import Design
    from mechkin_cli.arguments import Setting
    from mechkin_cli.building import ViewSettings
    from mechkin_cli.sweep import Result
    from mechkin_cli.vibration import Freed


MOST_PANELS = 60
"""Modes on a picture, of the lowest frequencies."""


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

    @property
    def view_settings(self) -> ViewSettings:
        """How its pictures are drawn."""
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
        coordinates = tuple(texts("coordinates", coordinates, '["A.theta"]'))
    return _Source(model, run or _first_run(model), row, coordinates, tuple(held)).vibration()


class _Source(NamedTuple):
    """The row of a run that small motions are about: from it they are made again."""

    model: Moving
    run: str
    row: int
    coordinates: tuple[str, ...] | None
    held: tuple[str, ...]

    def vibration(self) -> Vibration:
        """The small motions."""
        return Vibration(self._freed(self._result()), self)

    def again(self, parameter: str, factor: float) -> Vibration:
        """Those with another value of a parameter, a `factor` of its own."""
        result = self._result()
        value = result.problem.parameters[parameter]
        in_si = factor * float(value.value)  # type: ignore[arg-type]
        own = float(result.units.from_si(in_si, value.dimension))
        return self._replace(model=self.model.with_parameters({parameter: own})).vibration()

    def shown(self, found: Vibration, path: str | PathLike[str] | None) -> view.Page | Path:
        """A page in which the modes are played."""
        page, _ = view.view_page(list(self._modes(found)), modes=False)
        return view.Page(page) if path is None else view.write_view(path, page)

    def pictured(self, found: Vibration) -> str:
        """A picture of the modes, with arrows along which they move."""
        result = self._result()
        place = self._freed(result)
        modes = [
            view.ShownMode(
                f"mode {k + 1}: {frequency:.4g} Hz",
                swung(place, result, self.row, np.asarray(shape.real)),
            )
            for k, (shape, frequency) in enumerate(
                zip(found.shapes.T[:MOST_PANELS], found.frequencies, strict=False)
            )
        ]
        return view.mode_picture(modes, self.model.view_settings)

    def _result(self) -> Result:
        (analysis,) = self.model.analyses(self.run)
        return analysis.result

    def _freed(self, result: Result) -> Freed:
        return freed(result, self.row, self.coordinates, self.held)

    def _modes(self, found: Vibration) -> Iterator[Analysis]:
        result = self._result()
        place = self._freed(result)
        for number, (shape, frequency) in enumerate(
            zip(found.shapes.T, found.frequencies, strict=True)
        ):
            parts = np.asarray(shape.real), np.asarray(shape.imag)
            rows = played(place, result, self.row, parts, float(frequency))
            name = f"mode {number + 1}, {frequency:.4g} Hz"
            yield Analysis(self.model, (_swung(name, found.coordinates),), rows, name)


def _swung(run: str, coordinates: Sequence[str]) -> TableLayout:
    columns = tuple(ColumnLayout(name, parse(name)) for name in ("time", *coordinates))
    return TableLayout(run, "Coordinates over a period", columns, run=run)


def _first_run(model: Moving) -> str:
    """The first equilibria of the file, else its first run."""
    responses = model.design.at_responses.problem.responses
    resting = (run for run, one in responses.items() if getattr(one, "search", None) is not None)
    return next(resting, model.runs[0])
