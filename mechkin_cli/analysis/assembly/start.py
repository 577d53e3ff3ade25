"""The assembly at the first row: near given coordinates, a named mode, the home drawing, or
nearest to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.home import (
    follow_from_home,
    is_home_assembled,
    nearest_to_home,
)
from mechkin_cli.analysis.assembly.named_modes import NamedModes, is_cyclic, name_modes, wrapped
from mechkin_cli.analysis.assembly.near import Near, box_about, named_by, newton_from
from mechkin_cli.analysis.assembly.probe import Probe
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number
from mechkin_cli.mechanism.joint_table import dimension_of, is_angle
from mechkin_cli.solver.clusters import pose_keys, same_poses
from mechkin_cli.solver.dead_centre import DeadCentre
from mechkin_cli.solver.follow import TrackEnd
from mechkin_cli.solver.inputs import input_numbers, input_text
from mechkin_cli.solver.search import Found, with_assemblies
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.session import Continued, Session

NEAR = "near"
"""Stands for the letter of an assembly that was found without all others."""

HOME = "home"
"""The same for an assembled drawing."""

LOOP_SHOWN = 12
"""Joints of a loop that are named one by one."""

MAY_BE_RIGID = (
    "an overconstrained loop moves only if its dimensions are exact (write expressions); else "
    "this is a branch point or a special position"
)


@dataclass(frozen=True)
class Start:
    """States at a row (the first, or the one nearest to an assembled home) and the mode's name,
    where it is known (`near` and `home` stand for one that nobody asked for); `how` says how it was
    found. Without states `status` says why there are none."""

    state: Floats | None
    mode: str
    how: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    status: Status = Status.not_assembled
    row: int = 0


def choose_start(session: Session) -> Start:
    """The assembly that the file means, found once; or the one that is continued."""
    if session.continued is not None:
        return _continued(session.continued)
    key = ("start", str(session.problem.assembly))
    return session.once(key, lambda: _choose_start(session))


def _continued(continued: Continued) -> Start:
    """From the variant of the file's own parameters."""
    if continued.state is not None:
        return Start(continued.state, NEAR, "continued in the parameters", row=continued.row)
    diagnostic = Diagnostic(
        "variant-lost",
        "error",
        "the assembly of the file's own parameters ends before it comes to these",
        hint="take parameters nearer to the file's, or choose the assembly in the file itself",
    )
    return Start(None, NEAR, "", [diagnostic], Status.branch_lost, continued.row)


def _choose_start(session: Session) -> Start:
    path, wanted = session.inputs.values, session.problem.assembly
    if not wanted.near and wanted.mode is None and is_home_assembled(session):
        return _from_home(session, path)
    if wanted.near and wanted.mode is None:
        start = _from_near(session, path[:, 0])
        if start is not None:
            return _told_if_far(session, path[:, 0], start)
    modes = name_modes(session, path[:, 0], thorough=wanted.mode is not None)
    if modes.number == 0:
        return Start(None, "", "", [nothing_found(session, modes.found)])
    if wanted.mode is not None:
        return _by_name(modes, wanted.mode)
    home = _distances_home(session, modes.points)
    if not wanted.near:
        return _nearest(modes, home, home, "nearest to home")
    start = _nearest(modes, _distances_near(session.problem, modes.coordinates), home, "near")
    return _told_if_far(session, path[:, 0], start)


def mode_letter(session: Session, start: Start, *, thorough: bool = True) -> str:
    """The letter of an assembly at the first row, by a search if it is not known yet; its own name
    where no letter's branch has it, or where only a `thorough` search tells all modes."""
    if start.mode not in (NEAR, HOME) or start.state is None:
        return start.mode
    first = session.inputs.values[:, 0]
    state = state_at_first_row(session, start)
    if state is None:
        return start.mode
    modes = name_modes(session, first, thorough=thorough)
    if not modes.letters:
        return start.mode
    keys = pose_keys(session.layout, modes.found.states)
    same = same_poses(keys, pose_keys(session.layout, state[:, None]))[:, 0]
    return modes.letters[int(np.argmax(same))] if same.any() else start.mode


def state_at_first_row(session: Session, start: Start) -> Floats | None:
    """States of the first assembly's branch at the first row; an assembled drawing may be followed
    from another."""
    if start.state is None or start.row == 0:
        return start.state
    values = session.inputs.values
    path = np.stack([values[:, start.row], values[:, 0]], axis=1)
    followed = session.follow(path, start.state)
    return followed.state if followed.end == TrackEnd.FINISHED else None


def _from_near(session: Session, inputs: Floats) -> Start | None:
    """By Newton's method: at once if what it finds is proven to be the nearest, else after a search
    about what is named; None where it finds none that narrows the search."""
    named = named_by(session)
    newton = newton_from(session, inputs, named) if named.unknowns else None
    if newton is None:
        return None
    distance = _distances(session, inputs, newton.state[:, None])[0][0]
    if newton.is_nearest(distance):
        how = (
            f"{distance:.2g} rad or sizes off what near names, found by Newton's method; no other "
            f"within {newton.unique:.2g}"
        )
        return Start(newton.state, NEAR, how)
    # what is named exactly is named to rounding
    radius = tolerances.NEAR_RUNNER_UP * max(distance, tolerances.SAME_MODE)
    if radius > tolerances.NEAR_BALL:
        return None
    found = session.search(inputs, box_about(session, named, radius), thorough=False)
    return _nearest_about(session, inputs, newton, found, radius)


def _nearest_about(
    session: Session, inputs: Floats, newton: Near, found: Found, radius: float
) -> Start | None:
    """The nearest of all assemblies about as near as the one that Newton's method found."""
    found = with_assemblies(session.layout, session.plan, inputs, found, newton.state[:, None])
    distances, home = _distances(session, inputs, found.states)
    order = [i for i in _in_order(distances, home) if distances[i] <= radius]
    if not order:
        return None
    best = distances[order[0]]
    how = (
        f"{best:.2g} rad or sizes off what near names, nearest of {len(order)} that "
        f"{found.starts} starts found within {radius:.2g}"
    )
    notes = []
    if len(order) > 1 and _is_unclear(best, distances[order[1]]):
        notes.append(_unclear("two assemblies", (best, distances[order[1]])))
    return Start(found.states[:, order[0]], NEAR, how, notes)


def _told_if_far(session: Session, inputs: Floats, start: Start) -> Start:
    """With a warning where the assembly lies far from what `near` names."""
    if start.state is None:
        return start
    coordinates, _ = Probe.of(session).read(inputs, start.state[:, None])
    problem = session.problem
    far = [
        Number(name, float(coordinates[name][0]))
        for name, target in problem.assembly.near.items()
        if abs(_miss(problem, name, float(coordinates[name][0]), target)) > tolerances.NEAR_FAR
    ]
    if not far:
        return start
    units = problem.units
    shown = (
        f"{at.name} = {units.from_si(at.value, dimension_of(at.name.partition('.')[2])):.6g}"
        for at in far
    )
    note = Diagnostic(
        "nearest-far",
        "warning",
        "no assembly was found near what near names",
        measured=f"the nearest has {', '.join(shown)}",
        limit=f"{tolerances.NEAR_FAR:g} rad or sizes",
        hint="see mechkin modes for all assemblies at the first row",
    )
    return replace(start, diagnostics=[*start.diagnostics, note])


def _miss(problem: Problem, name: str, value: float, target: float) -> float:
    """How far a coordinate is off: angles the shorter way round, slides in sizes."""
    miss = value - target
    if is_cyclic(problem.mechanism, name):
        return wrapped(miss)
    if is_angle(name.partition(".")[2]):
        return miss
    return miss / problem.mechanism.box_diagonal()


def _distances(session: Session, inputs: Floats, states: Floats) -> tuple[list[float], list[float]]:
    """Of assemblies (states, number) from what `near` names, and from the drawing."""
    coordinates, points = Probe.of(session).read(inputs, states)
    return _distances_near(session.problem, coordinates), _distances_home(session, points)


def _in_order(distances: list[float], home: list[float]) -> list[int]:
    """Numbers of assemblies, the nearest first; among those as near but for rounding, the nearest
    to the drawing."""
    least = min(distances, default=0.0)
    tied = [i for i, d in enumerate(distances) if d <= least + tolerances.SAME_MODE]
    rest = [i for i in range(len(distances)) if i not in tied]
    rest.sort(key=lambda i: distances[i])
    return [*sorted(tied, key=lambda i: home[i]), *rest]


def _is_unclear(best: float, second: float) -> bool:
    """Whether a runner-up is about as near as the nearest."""
    return second < max(tolerances.NEAR_RUNNER_UP * best, best + tolerances.SAME_MODE)


def _from_home(session: Session, path: Floats) -> Start:
    """Followed from the drawing to the row whose inputs are nearest to it."""
    problem, layout = session.problem, session.layout
    row = nearest_to_home(path)
    followed = follow_from_home(session, path[:, row])
    if followed.end == TrackEnd.FINISHED:
        return Start(followed.state, HOME, "followed from the home drawing", row=row)
    places = input_numbers(problem, layout, followed.inputs)
    rigid = f"; {MAY_BE_RIGID}" if session.is_redundant else ""
    diagnostic = Diagnostic(
        "home-branch-ends",
        "error",
        "the assembly drawn at home ends before it comes to a row",
        measured=f"followed up to {', '.join(map(input_text, places))}",
        hint=f"choose another assembly with assembly: {{near: ...}}{rigid}",
        numbers=places,
    )
    from mechkin_cli.solver.branch_limit import find_limit

    limit = find_limit(session, followed, followed.inputs, followed.state)
    folds = isinstance(limit, DeadCentre)
    status = Status.beyond_dead_centre if folds else Status.branch_lost
    return Start(None, HOME, "", [diagnostic], status)


def nothing_found(session: Session, found: Found, place: str = "at the first row") -> Diagnostic:
    """What to say where no start closed: which loop it is."""
    loop, name = _failed_loop(session, found), session.problem.mechanism.name
    hint = "check the dimensions, or start the sweep at another input"
    if any(joint.type.is_threaded for joint in session.problem.mechanism.joints.values()):
        turns = session.problem.assembly.turns
        hint += f"; threads were searched {turns}.5 turns to either side: assembly: {{turns: N}}"
    if session.is_redundant:
        hint = "dimensions of an overconstrained loop must be exact (write expressions)"
    return Diagnostic(
        "not-assembled",
        "error",
        f"{name} cannot be assembled {place}{loop}",
        measured=_missed(found),
        limit=None if found.complete else f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint=hint,
        numbers=(
            Number("starts", found.tried),
            Number("residual", found.closest, limit=tolerances.RESIDUAL_ACCEPT),
        ),
    )


def _missed(found: Found) -> str:
    if found.free:
        return (
            f"{found.free} of {found.starts} random starts closed the loops, all where they still "
            "move with the inputs held, or in a singular position"
        )
    if found.complete:
        return "its equations have no real root"
    return (
        f"none of {found.tried} random starts closed, the best to {found.closest:.2g} of the size"
    )


def _failed_loop(session: Session, found: Found) -> str:
    """The joints of the loops that did not close, and whether others were closed before."""
    if found.failed is None or found.free:
        return ""
    graph = session.graph
    names: dict[str, None] = {}
    closings = graph.blocks[found.failed].closings
    for closing in (graph.closings[c] for c in closings):
        joints = (closing.joint.name,) if closing.leg is None else closing.leg.joints
        ways = {sign: [e for e, s in closing.loop if e >= 0 and s == sign] for sign in (1, -1)}
        # outward to the closing joint's first link, and back
        there, back = ([graph.edges[e].joint.name for e in sorted(ways[s])] for s in (-1, 1))
        names.update(dict.fromkeys((*there, *joints, *reversed(back))))
    shown = [name for name in names if name in session.problem.mechanism.joints]
    more = f" and {len(shown) - LOOP_SHOWN} more" if len(shown) > LOOP_SHOWN else ""
    loops = "the loop" if len(closings) == 1 else f"the {len(closings)} loops"
    close = "does not close" if len(closings) == 1 else "do not close together"
    before = f", in none of {found.places} assemblies before it" if found.places > 1 else ""
    return f": {loops} through {', '.join(shown[:LOOP_SHOWN])}{more} {close}{before}"


def _distances_near(problem: Problem, coordinates: Mapping[str, Floats]) -> list[float]:
    """Of every assembly from what `near` names."""
    distances = []
    for i in range(len(next(iter(coordinates.values())))):
        total = 0.0
        for name, target in problem.assembly.near.items():
            miss = _miss(problem, name, float(coordinates[name][i]), target)
            total += miss * miss
        distances.append(sqrt(total))
    return distances


def _distances_home(session: Session, points: Floats) -> list[float]:
    """Root mean square over the moving links' joint points, in parts of the size."""
    home = np.array([at.vector for at in Probe.of(session).points])[:, :, None]
    miss = (points - home) / session.problem.mechanism.box_diagonal()
    total = np.zeros(points.shape[2])
    for x, y, z in miss:
        total = total + (x * x + y * y + z * z)
    return [sqrt(float(squares) / len(home)) for squares in total]


def _by_name(modes: NamedModes, name: str) -> Start:
    for i, letter in modes.letters.items():
        if letter == name:
            return Start(modes.found.states[:, i], name, "by name")
    diagnostic = Diagnostic(
        "no-such-mode",
        "error",
        f"there is no mode {name[:LONGEST_NAME]} at the first row",
        measured=f"modes {', '.join(modes.letters.values())}",
        hint="take one of these",
    )
    return Start(None, name, "", [diagnostic])


def _nearest(modes: NamedModes, distances: list[float], home: list[float], how: str) -> Start:
    order = _in_order(distances, home)
    best = order[0]
    notes = []
    if len(order) > 1:
        second = order[1]
        if _is_unclear(distances[best], distances[second]):
            both = "two assemblies"
            if modes.letters:
                both = f"modes {modes.letters[best]} and {modes.letters[second]}"
            notes.append(_unclear(both, (distances[best], distances[second])))
    words = f"{how}, 1 of {modes.number} found"
    return Start(modes.found.states[:, best], modes.letters.get(best, NEAR), words, notes)


def _unclear(both: str, distances: tuple[float, float]) -> Diagnostic:
    return Diagnostic(
        "nearest-unclear",
        "warning",
        f"{both} are about equally near",
        measured=f"distances {distances[0]:.4g} and {distances[1]:.4g}",
        limit=f"ratio {tolerances.NEAR_RUNNER_UP}",
        hint="give more coordinates under assembly: near",
        numbers=tuple(Number("distance", distance) for distance in distances),
    )
