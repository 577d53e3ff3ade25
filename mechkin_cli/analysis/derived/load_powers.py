"""The powers of single loads and efforts, at the rates of the rows or along a virtual motion."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.coefficients import without_friction
from mechkin_cli.mechanism.model import GROUND_NAME, Damper, Link, Spring
from mechkin_cli.mechanism.quantities import Wanted, effort_quantity
from mechkin_cli.mechanism.vectors import ZERO
from mechkin_cli.units import POWER

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.model import Load
    from mechkin_cli.solver.inputs import KernelInputs
    from mechkin_cli.solver.session import Session

GRAVITY = "gravity"


def effort_powers(run: Reading, along: KernelInputs) -> dict[str, Floats]:
    """Of every effort (W, rows) by its name, as it acts in the rows, at the rates of `along`."""
    problem = run.session.problem
    known, acting = problem.quantities(), problem.acting
    efforts = [effort_quantity(*pair) for pair in acting]
    rates = [known[f"{joint}.{coordinate}_dot"] for joint, coordinate in acting]
    columns = run.result.evaluated(efforts)
    moving = run.result.evaluated(rates, inputs=along)
    return {
        effort.name: _power(columns[effort.name][0], moving[rate.name][0])
        for effort, rate in zip(efforts, rates, strict=True)
    }


def power_against(
    run: Reading, along: KernelInputs, loaded: Session, inputs: KernelInputs | None = None
) -> Floats:
    """Of what acts in a session that differs in masses and loads (W, rows): against the efforts
    that the inputs would need, at the rates of `inputs`, by the rates of `along`."""
    session = run.session
    efforts = [effort_quantity(*driven) for driven in session.problem.motion.driven]
    columns = run.result.evaluated(efforts, session=loaded, inputs=inputs)
    power = np.zeros(along.rates.shape[1])
    for number, effort in enumerate(efforts):
        joint = session.problem.mechanism.joints[effort.owner]
        unit = joint.unit_of(effort.coordinate, session.layout.length)
        power = power - _power(columns[effort.name][0], along.rates[number] * unit)
    return power


def friction_power(run: Reading, along: KernelInputs) -> Floats | None:
    """Of the friction of all joints (W, rows) by the rates of `along`: what efforts need less
    without it; None where nothing rubs."""
    smooth = without_friction(run.session, at_inputs=True)
    if smooth is None:
        return None
    power = -power_against(run, along, smooth)
    for own in effort_powers(run, along).values():
        power = power - own
    return power


def _power(effort: Floats, rate: Floats) -> Floats:
    """What stands still takes no part, whatever its effort is."""
    return np.where(rate == 0.0, 0.0, effort * rate)


def load_powers(run: Reading) -> list[tuple[Load | str, Floats]]:
    """Of gravity and every load (W, rows) at the rates of the rows."""
    wanted = [
        Wanted(f"power of load {k}", "load_power", GROUND_NAME, POWER, False, str(k))
        for _, k in _numbered(run)
    ]
    columns = run.result.evaluated(wanted) if wanted else {}
    loads = _numbered(run)
    return [(load, columns[own.name][0]) for (load, _), own in zip(loads, wanted, strict=True)]


def load_powers_along(run: Reading, along: KernelInputs) -> list[tuple[Load | str, Floats]]:
    """Of gravity and every load, with the forces of the rows and the rates of `along`: against the
    efforts that hold it alone."""
    found = []
    for load, number in _numbered(run):
        session = run.session.once(("one load", number), partial(_with_load, run, number))
        still = run.inputs.at_rest() if number < 0 else None
        found.append((load, power_against(run, along, session, still)))
    return found


def _numbered(run: Reading) -> list[tuple[Load | str, int]]:
    """Gravity, where there is some, as -1, and the loads by their numbers."""
    mechanism = run.session.problem.mechanism
    gravity = [(GRAVITY, -1)] if mechanism.gravity != ZERO else []
    return [*gravity, *((load, k) for k, load in enumerate(mechanism.loads))]


def _with_load(run: Reading, number: int) -> Session:
    """The mechanism with one load alone; with gravity, its masses are at rest."""
    problem = run.session.problem
    mechanism = replace(problem.mechanism, drives=None, frictions=())
    if number < 0:
        mechanism = replace(mechanism, loads=())
    else:
        links = {name: Link(name) for name in mechanism.links}
        loads = (mechanism.loads[number],)
        mechanism = replace(mechanism, links=links, loads=loads, gravity=ZERO)
    return run.session.loaded(replace(problem, mechanism=mechanism))


def is_stored(load: Load | str) -> bool:
    """Whether its work is potential energy."""
    return load == GRAVITY or isinstance(load, Spring)


def dissipates(load: Load | str) -> bool:
    """Whether it takes energy away for good."""
    return isinstance(load, Damper)
