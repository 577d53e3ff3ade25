"""What a file leaves out and mechkin assumes, in sentences for the reader of a page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.model import GROUND_NAME, is_written
from mechkin_cli.runs import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.units import UnitSystem
    from mechkin_cli.view.readable import ShownRun


def assumed(problem: Problem, runs: Sequence[ShownRun]) -> list[str]:
    """The sentences; those about a run are of its own branch."""
    sentences = [_units(problem.units), *_assemblies(runs), *_motion(problem, runs)]
    sentences += [*_bodies(problem), *_arrows(runs), *_idle(problem)]
    return list(dict.fromkeys(sentences))


def _units(units: UnitSystem) -> str:
    names = f"{units.length}, {units.angle}, {units.mass}, {units.force} and {units.time}"
    return f"Bare numbers are in {names}, angular rates in {units.angular_rate}."


def _assemblies(runs: Sequence[ShownRun]) -> Iterator[str]:
    for run in runs:
        result = run.branches[0].analysis.result
        if result.how:
            yield f"{run.title}: the assembly at the first row is {result.how}."


def _motion(problem: Problem, runs: Sequence[ShownRun]) -> Iterator[str]:
    if not any(run.name == SWEEP for run in runs):
        return
    inputs = problem.motion.inputs
    still = [one.name for one in inputs if not np.any(one.rates)]
    if still:
        yield f"The rates of {', '.join(still)} are zero: none are given."
    if inputs and problem.mechanism.drives is None:
        names = ", ".join(one.name for one in inputs)
        yield f"Drives act at the inputs: {names}."


def _bodies(problem: Problem) -> Iterator[str]:
    mechanism = problem.mechanism
    links = [name for name in mechanism.links if name != GROUND_NAME and is_written(name)]
    light = [name for name in links if not mechanism.links[name].has_mass]
    if light and len(light) == len(links):
        yield "No link has mass."
    elif light:
        yield f"Links without mass: {', '.join(light)}."
    if not any(mechanism.gravity):
        yield "No gravity acts in the sweep." if problem.responses else "No gravity acts."
    yield "Bodies are rigid, and joints have no play."
    if not mechanism.frictions:
        yield "Joints do not rub."


def _arrows(runs: Sequence[ShownRun]) -> Iterator[str]:
    if any(run.branches[0].forces for run in runs):
        yield (
            "Arrows at joints are what the first link exerts on the second, without the drive; one "
            "with axes behind its name, such as (x, y), has these components alone: redundant "
            "constraints leave the others arbitrary."
        )


def _idle(problem: Problem) -> Iterator[str]:
    for leg in find_legs(problem.mechanism):
        yield f"{leg.words}: where it stands about that line is told by convention."
    for held in problem.held:
        yield f"{held.words}: {held.convention}."
