"""From a row of a run to a place that is left to move: the free mechanism, what drives it still,
and the coordinates that name its motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response import ResponseResult, free_session, with_loads
from mechkin_cli.session import Ask, RowInputs, turn_count
from mechkin_cli.statics import DrivenAt, Forces, FreePlace
from mechkin_cli.vibration.inputs import InputForces
from mechkin_cli.vibration.linear import SmallMotions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.mechanism import Problem
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Result


class Freed(NamedTuple):
    """A row that is left to move: its small motions, the session of the free mechanism, the driven
    coordinates, and whether friction is left out."""

    motions: SmallMotions
    session: Session
    driven: tuple[str, ...]
    friction: bool


def freed(
    result: Result, row: int, coordinates: Sequence[str] | None, held: Sequence[str]
) -> Freed:
    """A row of a sweep whose inputs, but those `held`, are left to move, or one of a response or of
    equilibria, at rest but for its drives.

    Args:
        coordinates: that name the motion; None: the inputs, or those of the start.

    Raises:
        UsageError: unknown rows or coordinates, or such as do not tell the motion there.
    """
    if row >= result.rows:
        raise UsageError(f"there is no row {row}; the run has {result.rows} rows, from 0")
    if not result.solved[row]:
        raise UsageError(f"row {row} has no position: see row.status")
    if isinstance(result, ResponseResult) or hasattr(result, "chart"):
        session, driven = _of_free(result, row, held)
        own = [f"{joint}.{name}" for joint, name in result.response.independent]  # type: ignore[attr-defined]
        held_by: list[str] | None = None
    else:
        session, driven, own = _of_sweep(result, row, held)
        held_by = own
    names = own if coordinates is None else list(coordinates)
    inputs = _by_inputs(result, row, session) if names == held_by else None
    small = SmallMotions(
        session, driven, lambda forces: _place(forces, result, row), names, held_by, inputs
    )
    if inputs is None:
        _check(small, own)
    return Freed(
        small,
        session,
        tuple(f"{joint}.{name}" for joint, name in session.problem.motion.driven),
        bool(result.problem.mechanism.frictions),
    )


def _without_friction(problem: Problem) -> Problem:
    return replace(problem, mechanism=replace(problem.mechanism, frictions=(), drives=None))


def _of_free(result: Result, row: int, held: Sequence[str]) -> tuple[Session, DrivenAt]:
    if held:
        raise UsageError("held: names inputs of a sweep; what is driven elsewhere stays so")
    session = result.session
    driven = DrivenAt.row(session, row, moving=True)
    if session.problem.mechanism.frictions:
        session = with_loads(session, _without_friction(session.problem))
    return session, driven


def _of_sweep(result: Result, row: int, held: Sequence[str]) -> tuple[Session, DrivenAt, list[str]]:
    """The session in which the inputs that are not held are free, and these."""
    session = result.session
    motion = session.problem.motion
    names = [item.name for item in motion.inputs]
    if motion.rest is not None and not held:
        # of a sweep at rest what nothing drives is free
        held = [name for number, name in enumerate(names) if number not in motion.rest.inputs]
    for name in held:
        if name not in names:
            hint = nearest_hint(name, names) or f"inputs are {', '.join(names) or 'none'}"
            raise UsageError(f"held: {name[:LONGEST_NAME]} is no input; {hint}")
    stay = [k for k, item in enumerate(motion.inputs) if item.name in held]
    free = [item for item in motion.inputs if item.name not in held]
    if not free:
        raise UsageError("nothing is free to move: all inputs are held; leave one out of held")
    own = _without_friction(session.problem)
    kept = motion._replace(
        inputs=tuple(motion.inputs[k] for k in stay),
        paths=(),
        constraints=(),
        constraint_rates=None,
        course=None,
        grid=None,
        leader=None,
        rest=None,
    )
    inputs = session.inputs
    # behind the inputs is what is held as idle
    stay += range(len(motion.inputs), len(inputs.values))
    driven = DrivenAt(
        inputs.reduced[stay, row],
        inputs.whole[stay, row],
        inputs.values[stay, row],
        inputs.rates[stay, row],
        inputs.accelerations[stay, row],
        0.0 if motion.time is None else float(motion.time.values[row]),
    )
    problem = own.moved(kept)
    left = free_session(
        replace(session, problem=problem), [(item.joint, item.coordinate) for item in free]
    )
    return left, driven, [item.name for item in free]


def _place(forces: Forces, result: Result, row: int) -> FreePlace:
    """The row's place, with directions of the chart that tell its motion."""
    states, session = result.row_states, forces.session
    state, turns = states.states[:, row], states.turns[:, row]
    chart = getattr(result, "chart", None)
    n = forces.freedoms
    if chart is not None:
        return forces.place(state, turns, chart.direction[:, row].reshape(n, -1))
    return forces.place(state, _turns(result, row, session), _directions(result, row, session))


def _turns(result: Result, row: int, free: Session) -> Floats:
    """The turns (turn slots,) of a row of a sweep, as the plan of the free mechanism counts them:
    also those of angles that were inputs."""
    session, turns = result.session, result.row_states.turns[:, row]
    found = np.zeros(turn_count(free.plan))
    own = {(c, f): slot for c, f, slot, _ in _kernel.closing_turns(session.plan)}
    for closing, freedom, slot, width in _kernel.closing_turns(free.plan):
        first = own.get((closing, freedom))
        if first is None and width > 1:
            # an orientation that the drives tell part of: either sign of it will do
            continue
        if first is None:
            raise UsageError(
                "the turns of some joint are not known in this row; name a response or equilibria, "
                "or hold other inputs"
            )
        found[slot : slot + width] = turns[first : first + width]
    states = dict(_kernel.tree_turns(session.plan))
    for number, (edge, freedom) in enumerate(session.graph.inputs):
        state = session.layout.state(edge, freedom)
        for counted, slot in _kernel.tree_turns(free.plan):
            if counted == state:
                found[slot] = session.inputs.whole[number, row]
    for state, slot in _kernel.tree_turns(free.plan):
        if state in states:
            found[slot] = turns[states[state]]
    return found


def _directions(result: Result, row: int, free: Session) -> Floats:
    """Rates of the columns at a row of a sweep where one free input after the other moves alone."""
    session = result.session
    numbers = [k for k, pair in enumerate(session.driven) if pair not in free.driven]
    count = len(numbers)
    rates = np.zeros((len(session.driven), count))
    for place, number in enumerate(numbers):
        rates[number, place] = 1.0
    reduced = np.repeat(session.inputs.reduced[:, row : row + 1], count, axis=1)
    guess = np.repeat(result.row_states.states[:, row : row + 1], count, axis=1)
    batch = session.run(
        RowInputs(reduced, guess, rates), Ask(Demand.VELOCITY, derivatives=True, iterations=0)
    )
    assert batch.first is not None
    return np.ascontiguousarray(batch.first.T)


def _by_inputs(result: Result, row: int, free: Session) -> InputForces | None:
    """What the drives of the free inputs exert about a row of a sweep, where these tell its motion
    well and efforts act at them alone."""
    problem = result.session.problem
    drives = problem.mechanism.drives
    if drives is not None and (drives.actuators or drives.constraints):
        return None
    if not np.abs(_directions(result, row, free)).max(initial=0.0) <= tolerances.WELL_TOLD:
        return None
    motion = problem.motion.driven
    return InputForces(result, row, [k for k, at in enumerate(motion) if at not in free.driven])


def _check(small: SmallMotions, own: Sequence[str]) -> None:
    """That the named coordinates tell the motion; `own` are such as do elsewhere.

    Raises:
        UsageError: they are unknown, too few or too many, or do not.
    """
    names, known, freedoms = small.coordinates, small.known, small.forces.freedoms
    coordinates = [name for name, wanted in known.items() if wanted.kind == "coordinate"]
    for name in names:
        if name not in known or known[name].kind != "coordinate" or known[name].order:
            hint = nearest_hint(name, coordinates) or f"for example {', '.join(own)}"
            raise UsageError(f"{name[:LONGEST_NAME]} is no coordinate; {hint}")
    if len(set(names)) != len(names) or len(names) != freedoms:
        told = "1 freedom" if freedoms == 1 else f"{freedoms} freedoms"
        raise UsageError(
            f"{told} are told by as many coordinates, and {len(names)} are named; for example "
            f"coordinates={list(own)}"
        )
    if not np.isfinite(small.inverse).all():
        raise UsageError(
            f"{', '.join(names)} do not tell the motion in this row, as at a dead centre: name "
            "other coordinates"
        )
