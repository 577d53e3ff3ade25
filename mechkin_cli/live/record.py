"""The record from which a page computes a run with other parameters.

Parameters that are numbers in the file vary; what they lead to in plan, tables, arrows and drawing
is recorded once. Not everything can be: what rests on several runs (coefficients, screws), on
reactions that redundant constraints leave open, or on a parameter by which the file is computed in
another way. That is listed with its reason.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.expressions import ExpressionError, Quantity, parse
from mechkin_cli.live.numbers import with_numbers
from mechkin_cli.live.recording import LeftOut, Recording, factor_of
from mechkin_cli.live.response import ResponseRecording
from mechkin_cli.reading import value_spans
from mechkin_cli.tape import TraceLost, Verdict
from mechkin_cli.tolerances import LARGEST_NUMBER, SMALLEST_SIZE
from mechkin_cli.units import LENGTH, UnitSystem
from mechkin_cli.variants import VariedDesign, base_of
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis, Design, Solvable
    from mechkin_cli.building import FileNumber
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.reading import Document, KeyPath
    from mechkin_cli.variants import SessionVariation

    Plain = dict[str, Any]

MOST_PARAMETERS = 60
"""Parameters that a page has sliders for."""

OF_SIZE = 0.1
"""How far a slider moves a place to either side, in parts of the mechanism's size."""

NUMBERS = "Points, masses and springs"
"""What the numbers of a file without parameters are called."""


def live_record(analysis: Analysis, data: Mapping[str, Any]) -> Plain:
    """What the page of a run computes by itself; where it can compute nothing, `why`, with the
    command that does.

    Args:
        analysis: the sweep, or the response, in the file's own mode, whose page it is.
        data: of the page without this record.
    """
    try:
        return _record(analysis, data)
    except (LeftOut, TraceLost) as lost:
        why = str(lost)
    except (TypeError, ValueError):  # numpy refuses recorded numbers in words of its own
        why = "what follows from its numbers cannot be recorded"
    named = bool(analysis.model.design.problem.parameters)
    return {
        "run": analysis.run,
        "why": why,
        "named": named,
        "command": _command(data, "NAME=VALUE"),
    }


def _command(data: Mapping[str, Any], setting: str) -> str:
    return f"mechkin analyze {data['file']} --set {setting}"


def _record(analysis: Analysis, data: Mapping[str, Any]) -> Plain:
    """The record.

    Raises:
        LeftOut, TraceLost, TypeError, ValueError: there is none, and why.
    """
    design = analysis.model.design
    solved = analysis.result.solved
    if isinstance(design, VariedDesign):
        raise LeftOut("it is shown with other values of parameters than the file has")
    if not (solved.any() if analysis.run == SWEEP else solved.all()):
        raise LeftOut(
            "no row has a solution" if analysis.run == SWEEP else "it ends before its last row"
        )
    lost = _why_fixed(design.problem, analysis.run)
    if lost is not None:
        raise LeftOut(lost)
    numbers = None
    varied, fixed = _variation(design, analysis.run, list(design.problem.parameters))
    if varied is None:
        # of a file without parameters, or with such alone as how many rows there are
        numbers = with_numbers(design, MOST_PARAMETERS)
        if numbers is None:
            raise LeftOut(
                "the file has nothing to change but what it is computed in another way by"
            )
        varied, _ = _variation(numbers.design, analysis.run, list(numbers.numbers))
        if varied is not None:
            varied = _changeable(_varied_by(numbers.design, analysis.run), varied)
    if varied is None:
        raise LeftOut("with any one of its numbers changed the file is computed in another way")
    names = list(varied.recorder.inputs)
    record = recording_of(analysis, data, varied).record()
    file = analysis.model.built.document
    if numbers is None:
        paths: dict[str, KeyPath] = {name: ("parameters", name) for name in names}
        parameters = [_parameter(analysis.model, name, file.data) for name in names]
    else:
        chosen = {name: numbers.numbers[name] for name in names}
        paths = {one.name: one.path for one in chosen.values()}
        reach = OF_SIZE * data["size"]
        parameters = [
            _file_number(numbers.design.problem, name, one, reach) for name, one in chosen.items()
        ]
        record["left"] = [one | {"command": None} for one in record["left"]]
    return {
        "run": analysis.run,
        "parameters": parameters,
        "folded": None if numbers is None else NUMBERS,
        "fixed": [
            {"name": name, "why": why, "command": _command(data, f"{name}=...")}
            for name, why in fixed.items()
        ],
        **record,
        "file": None if file.is_data else {"text": file.text, "spans": _spans(file, paths)},
    }


def recording_of(
    analysis: Analysis, data: Mapping[str, Any], varied: SessionVariation
) -> Recording:
    """The recording of a sweep or a response, of which `varied` is the session or its first
    moment."""
    if analysis.run == SWEEP:
        return Recording(analysis, data, varied)
    return ResponseRecording(analysis, data, varied)


def _parameter(model: Solvable, name: str, data: Mapping[str, Any]) -> Plain:
    problem = model.design.problem
    quantity, units = problem.parameters[name], problem.units
    value = float(units.from_si(float(quantity.value), quantity.dimension))  # type: ignore[arg-type]
    text = str(data.get("parameters", {}).get(name, ""))
    written = parse(text).number
    if written is not None and text.strip().removeprefix(written.text).strip() in (
        "",
        units.label(quantity.dimension),
    ):
        value = float(
            written.value
        )  # as it was written, without the rounding of a way to SI and back
    ends = model.view_settings.parameters.get(name, _about(value))
    return _slider(quantity, units, {"name": name, "value": value, "text": text}, ends)


def _file_number(problem: Problem, parameter: str, number: FileNumber, reach: float) -> Plain:
    """A number of the file; a place is moved by up to `reach`, in the file's unit."""
    value = number.value
    ends = (value - reach, value + reach) if number.is_place else _about(value)
    told = {"name": number.name, "value": value, "text": number.text}
    return _slider(problem.parameters[parameter], problem.units, told, ends)


def _about(value: float) -> tuple[float, float]:
    """From half to twice a value."""
    return (min(0.5 * value, 2.0 * value), max(0.5 * value, 2.0 * value)) if value else (-1.0, 1.0)


def _slider(quantity: Quantity, units: UnitSystem, told: Plain, ends: tuple[float, float]) -> Plain:
    conversion = units.conversion(quantity.dimension)
    return {
        **told,
        "unit": units.label(quantity.dimension),
        "low": ends[0],
        "high": ends[1],
        "si": float(quantity.value),  # type: ignore[arg-type]
        "least": SMALLEST_SIZE if quantity.dimension == LENGTH else 0.0,
        "most": LARGEST_NUMBER,
        "factor": factor_of(conversion),
    }


def _spans(file: Document, paths: Mapping[str, KeyPath]) -> dict[str, list[int]]:
    """Where values stand in the file's text, characters from 0, their quotes among them."""
    spans = value_spans(file.text)
    return {
        name: [spans[path].start, spans[path].end]
        for name, path in paths.items()
        if path in spans and name not in file.overrides
    }


Varied = Callable[[Sequence[str]], "SessionVariation | None"]
"""How a run depends on some parameters; None where no recording holds that."""


def _varied_by(design: Design, run: str) -> Varied:
    base = base_of(design)
    if run == SWEEP:
        return lambda names: _by_operations(base.variation(names))
    return lambda names: base.response_variation(names, run)


def _by_operations(varied: SessionVariation | None) -> SessionVariation | None:
    """A recording with inputs that follow from others by no operation is none for a page."""
    return None if varied is None or varied.recorder.given_rows else varied


def _why_fixed(problem: Problem, run: str) -> str | None:
    """Why no number of a run may change in a page; None where some may."""
    if run == SWEEP:
        if problem.follow is not None:
            return "the file leaves loops out, and which ones depends on what is asked for"
        if problem.motion.rest is not None:
            return "coordinates rest in it where the loads balance"
        return None
    response = problem.responses.get(run)
    if response is None:
        return "it is a mode of vibration about a place"
    if response.search is not None:
        return "its rows are where the loads balance"
    if response.driven:
        return "laws of time drive coordinates in it"
    return "coordinates are held in it" if response.held else None


def _variation(
    design: Design, run: str, names: Sequence[str]
) -> tuple[SessionVariation | None, dict[str, str]]:
    """How a run depends on all of some parameters that a recording holds, and why others are
    fixed."""
    fixed = {}
    document = design.built.document
    free: list[str] = []
    for name in names:
        try:
            expression = parse(str(document.data["parameters"][name]))  # type: ignore[index, call-overload]
        except (ExpressionError, KeyError, TypeError):
            continue
        if expression.names:
            fixed[name] = f"follows from {', '.join(sorted(expression.names))}"
        elif len(free) == MOST_PARAMETERS:
            fixed[name] = f"the page has sliders for {MOST_PARAMETERS} parameters"
        else:
            free.append(name)
    varied = _varied_by(design, run)
    held = _recordable(varied, free)
    for name in free:
        if name not in held:
            fixed[name] = "with another value the file is computed in another way"
    return (varied(held) if held else None), fixed


def _changeable(of: Varied, varied: SessionVariation) -> SessionVariation | None:
    """The recording of those parameters that may become a little larger or smaller by themselves:
    others, such as a place on a line about which a rod spins, make the file another."""
    own = varied.values
    largest = np.abs(own).max()
    step = np.diag(tolerances.TRIED_DIMENSION * np.where(own == 0.0, largest, np.abs(own)))
    verdicts = varied.verdicts(np.hstack([own[:, None] + step, own[:, None] - step]))
    other = (verdicts == Verdict.OTHER_WAY).reshape(2, own.size).all(axis=0)
    names = [name for name, no in zip(varied.recorder.inputs, other, strict=True) if not no]
    return of(names) if names else None


def _recordable(varied: Varied, names: Sequence[str]) -> list[str]:
    if not names:
        return []
    if varied(names) is not None:
        return list(names)
    if len(names) == 1:
        return []
    half = len(names) // 2
    held = [*_recordable(varied, names[:half]), *_recordable(varied, names[half:])]
    return held if len(held) == len(names) or varied(held) is not None else held[:1]
