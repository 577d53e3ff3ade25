"""The short summary that a run prints for a person."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.assembly.start import NEAR
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.runs import SWEEP
from mechkin_cli.status import Status
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis


IDLE_SHOWN = 2
"""Idle freedoms that are named one by one."""


def summary(file: str, analysis: Analysis, *, errors: bool = False) -> list[str]:
    """Lines: driven freedoms, loops, branch, rows, worst residual and power error; of a response
    what is free, and how it ended; with `errors` how many digits are right."""
    result = analysis.result
    name = analysis.model.name
    if analysis.run == SWEEP:
        rows = [("driven", _driven(analysis))]
    else:
        name = f"{name}, response {analysis.run}"
        rows = [("free", _free(analysis))]
    rows.append(("loops", _loops(analysis)))
    if result.mode:
        rows.append(("branch", _branch(analysis)))
    rows += [("rows", _rows(analysis)), ("worst", _worst(analysis))]
    if analysis.run == SWEEP and result.is_certified:
        rows.append(("proof", analysis.certificate.words))
    if analysis.run != SWEEP:
        rows.insert(-1, ("ended", _ended(analysis)))
    if errors:
        from mechkin_cli.cli.errors_line import errors_line

        rows.append(("errors", errors_line(analysis)))
    return [f"{name} ({file})", *(_line(*row) for row in rows)]


def files_line(folder: Path, written: Sequence[Path]) -> str:
    """Where the files are, and how many of each kind."""
    kinds = Counter(file.suffix.removeprefix(".") for file in written)
    counts = ", ".join(f"{count} {kind}" for kind, count in kinds.items())
    return _line("files", f"{folder} ({counts})")


def _line(name: str, text: str) -> str:
    return f"  {name:<9}{text}"


def _free(analysis: Analysis) -> str:
    """How many freedoms move under forces, where they start, what is driven and what acts."""
    response = analysis.model.response(analysis.run)
    free = response.independent
    noun = "freedom" if len(free) == 1 else "freedoms"
    parts = [f"{len(free)} {noun} from {', '.join(f'{joint}.{name}' for joint, name in free)}"]
    if response.efforts:
        parts.append(f"efforts on {', '.join(one.name for one in response.efforts)}")
    if response.driven:
        parts.append(f"driven: {', '.join(one.name for one in response.driven)}")
    return "; ".join(parts)


def _ended(analysis: Analysis) -> str:
    """By which stop, or at the last moment asked for, or before it."""
    from mechkin_cli.analysis.response import ResponseResult

    result = analysis.result
    times = result.inputs["time"]
    unit = result.units.label(TIME)
    solved = np.flatnonzero(result.solved)
    if not solved.size:
        return "before it began"
    last = int(solved[-1])
    at = f"at {times[last]:.9g} {unit}"
    if result.events[last]:
        return f"{at}: {result.events[last]}"
    if last == result.rows - 1:
        return f"{at}, the last moment"
    assert isinstance(result, ResponseResult)
    report = result.report
    moment = times[last] if report is None else float(result.units.from_si(report.time, TIME))
    return f"at {moment:.9g} {unit}: {Status(int(result.status[last + 1])).label}"


def _branch(analysis: Analysis) -> str:
    """The mode by its letter where that is known, and how it was found."""
    result = analysis.result
    if result.mode == NEAR:
        return result.how
    return f"mode {result.mode} ({result.how})" if result.how else result.mode


def _driven(analysis: Analysis) -> str:
    """How many freedoms are driven, by which inputs; a count by Kutzbach's formula that differs is
    told too."""
    mechanism = analysis.model.problem.mechanism
    freedoms = sum(joint.type.freedoms for joint in mechanism.joints.values())
    count = freedoms - mechanism.space * mechanism.loops
    inputs = [driven.name for driven in analysis.model.problem.motion.inputs]
    plural = "freedom" if len(inputs) == 1 else "freedoms"
    text = f"{len(inputs)} {plural} by {', '.join(inputs)}" if inputs else "nothing"
    words = [leg.words for leg in find_legs(mechanism)]
    several = Counter(held.words for held in analysis.model.problem.held)
    words += [text if n == 1 else f"{text} ({n} freedoms)" for text, n in several.items()]
    idle = "".join(f"; {text}" for text in words[:IDLE_SHOWN])
    more = len(words) - IDLE_SHOWN
    idle += f"; and {more} more idle" if more > 0 else ""
    return (text if count == len(inputs) else f"{text} (Kutzbach's count: {count})") + idle


def _loops(analysis: Analysis) -> str:
    graph = analysis.result.graph
    if not graph.closings:
        return "none (open chain)"
    closed = ", ".join(
        "-".join(c.leg.joints) if c.leg else f"{c.joint.name} ({c.joint.letter})"
        for c in graph.closings
    )
    sizes = " then ".join(str(len(block.unknowns)) for block in graph.blocks)
    return f"{analysis.model.problem.mechanism.loops}, closed at {closed}; {sizes} unknowns"


def _rows(analysis: Analysis) -> str:
    result = analysis.result
    text = f"{np.count_nonzero(result.solved)} of {result.rows} solved"
    codes, first, counts = np.unique(result.status, return_index=True, return_counts=True)
    others = [
        f"{counts[k]} {Status(int(codes[k])).label}"
        for k in np.argsort(first)
        if codes[k] != Status.ok
    ]
    return f"{text} ({', '.join(others)})" if others else text


def _worst(analysis: Analysis) -> str:
    result = analysis.result
    parts = []
    measured = {
        "residual": result.residual,
        "power error": result.power_error,
        "condition": result.condition,
    }
    if analysis.run != SWEEP:
        measured["energy error"] = np.asarray(result.quantity("row.energy_error").value)
    for name, values in measured.items():
        finite = values[np.isfinite(values)]
        if finite.size:
            parts.append(f"{name} {float(finite.max()):.1e}")
    return ", ".join(parts) or "nothing was solved"
