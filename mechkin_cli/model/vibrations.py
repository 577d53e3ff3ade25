"""Small motions of a model about a row of one of its runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.arguments import a_whole_number, texts
from mechkin_cli.vibration import Vibration, freed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from mechkin_cli.analysis import Analysis, Design
    from mechkin_cli.arguments import Setting
    from mechkin_cli.show import Floats


class Moving(Protocol):
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
    load: Callable[[Mapping[str, Any]], Moving],
) -> Vibration:
    """Arguments and errors are those of `Model.vibration`; `load` makes a model of sections."""
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
        return vibration(other, name, row, coordinates, held, load)

    def play(places: Mapping[str, Floats]) -> Moving:
        return load(_swept(model.design, analysis, row, places))

    return Vibration(freed(analysis.result, row, coordinates, held), again, play)


def _swept(
    design: Design, analysis: Analysis, row: int, places: Mapping[str, Floats]
) -> dict[str, Any]:
    """The file with a sweep along some places (rad, m), assembled as in a row of a run, with the
    loads that act in all runs."""
    data = dict(design.built.document.data)
    units, known = analysis.result.units, analysis.result.problem.quantities()

    def texts_of(values: Any) -> list[str]:
        return [repr(float(x)) for x in np.ravel(values)]

    inputs: dict[str, Any] = {
        name: {"values": texts_of(units.from_si(values, known[name].dimension))}
        for name, values in places.items()
    }
    for driven in analysis.result.problem.motion.inputs:
        (at,) = texts_of(driven.written[row])
        inputs.setdefault(driven.name, {"at": at})
    near = {
        name: texts_of(analysis[name][row])[0]
        for name, wanted in known.items()
        if wanted.kind == "coordinate" and not wanted.order and name not in inputs
    }
    for section in ("responses", "equilibria", "tables", "balances", "actuators", "view"):
        data.pop(section, None)
    data["loads"] = [load for load in data.get("loads", ()) if "runs" not in load]
    data["motion"] = {"inputs": inputs}
    return data | ({"assembly": {"near": near}} if near else {})


def _first_run(model: Moving) -> str:
    """The first equilibria of the file, else its first run."""
    responses = model.design.at_responses.problem.responses
    resting = (run for run, one in responses.items() if getattr(one, "search", None) is not None)
    return next(resting, model.runs[0])
