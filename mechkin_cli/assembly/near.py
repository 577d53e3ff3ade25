"""How far assemblies are from what the file names and from the drawing; the assembly nearest to
the coordinates that `near` names, or the report that there is none.

If all unknowns are named, Newton's method from them ends at an assembly x at a distance d. With
the closing equations f, the Jacobian J there and a bound L of their second derivatives, two
solutions x and y obey 0 = J^+ (f(y) - f(x)), hence |y - x| >= 2 sigma / L with the smallest
singular value sigma of J (Kantorovich). Another assembly within a times d of what is named would
lie within (1 + a) d of x; if that is less than 2 sigma / L there is none. Turns count in rad,
slides in parts of the size.

L: in a loop of n unknowns the position of one closing frame in the other has second derivatives of
at most the loop's reach, directions of at most 1; by Cauchy the sum over pairs of unknowns is at
most n times the root of the sum of both squares.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly.home import is_cyclic, probe_of, wrapped
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.kernel.functions import total
from mechkin_cli.mechanism import GROUND_NAME, Problem, dimension_of, is_angle, norm
from mechkin_cli.plan import Demand, Layout, home_state
from mechkin_cli.record import dataclass, field
from mechkin_cli.search import Assemblies, Within, single_assembly
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


NEAR = "near"
"""In place of the letter of an assembly that was found without all others."""


def far_notes(session: Session, inputs: Floats, state: Floats, row: int = 0) -> list[Diagnostic]:
    """A warning where an assembly (states,) at a row lies far from what `near` names."""
    problem = session.problem
    coordinates, _ = probe_of(session).read(inputs, state[:, None])
    places = {name: float(coordinates[name][0]) for name in problem.assembly.near}
    motion = problem.motion
    whole = {item.name: float(session.inputs.whole[k, row]) for k, item in enumerate(motion.inputs)}
    far = []
    for name, target in problem.assembly.near.items():
        if abs(_miss(problem, name, places[name], target)) > tolerances.NEAR_FAR:
            dimension = dimension_of(name.rpartition(".")[2])
            # inputs are told with their whole turns, as the row shows them
            place = places[name] + 2.0 * pi * whole.get(name, 0.0)
            value = float(problem.units.from_si(place, dimension))
            far.append(Number(name, value, problem.units.label(dimension)))
    if not far:
        return []
    told = ", ".join(f"{n.name} = {n.value:.6g}" for n in far)
    resting = () if motion.rest is None else [motion.inputs[k].name for k in motion.rest.inputs]
    if all(one.name in resting for one in far):
        return [
            Diagnostic(
                "nearest-far",
                "warning",
                "no equilibrium was found near what near names",
                measured=f"that of the first row has {told}",
                limit=f"{tolerances.NEAR_FAR:g} rad or sizes",
                hint="equilibria: {NAME: {window: {...}}} finds all in a window",
                numbers=tuple(far),
            )
        ]
    return [
        Diagnostic(
            "nearest-far",
            "warning",
            "no assembly was found near what near names",
            measured=f"the nearest has {told}",
            limit=f"{tolerances.NEAR_FAR:g} rad or sizes",
            hint="see mechkin modes for the assemblies at the first row",
            numbers=tuple(far),
        )
    ]


def _miss(problem: Problem, name: str, value: float, target: float) -> float:
    """How far a coordinate is off: angles the shorter way round, slides in sizes."""
    miss = value - target
    if is_cyclic(problem.mechanism, name):
        return wrapped(miss)
    if is_angle(name.rpartition(".")[2]):
        return miss
    return miss / problem.mechanism.box_diagonal()


def distances_of(
    session: Session, inputs: Floats, states: Floats
) -> tuple[list[float], list[float]]:
    """Of assemblies (states, number) from what `near` names, and from the drawing."""
    coordinates, points = probe_of(session).read(inputs, states)
    return distances_near(session.problem, coordinates), distances_home(session, points)


def in_order(distances: list[float], home: list[float]) -> list[int]:
    """Numbers of assemblies, the nearest first; among those as near but for rounding, the nearest
    to the drawing."""
    least = min(distances, default=0.0)
    equal = [i for i, d in enumerate(distances) if d <= least + tolerances.SAME_MODE]
    rest = [i for i in range(len(distances)) if i not in equal]
    rest.sort(key=lambda i: distances[i])
    return [*sorted(equal, key=lambda i: home[i]), *rest]


def is_unclear(best: float, second: float) -> bool:
    """Whether a runner-up is about as near as the nearest."""
    return second < max(tolerances.NEAR_RUNNER_UP * best, best + tolerances.SAME_MODE)


def distances_near(problem: Problem, coordinates: Mapping[str, Floats]) -> list[float]:
    """Of every assembly from what `near` names."""
    distances = []
    for i in range(len(next(iter(coordinates.values())))):
        total = 0.0
        for name, target in problem.assembly.near.items():
            miss = _miss(problem, name, float(coordinates[name][i]), target)
            total += miss * miss
        distances.append(sqrt(total))
    return distances


def nearer_clearly(session: Session, inputs: Floats, states: Floats) -> int | None:
    """Which of two assemblies (states, 2) lies where `near` points from between them; None where it
    names nothing, or nothing that tells them apart.

    What it names may be far from both: it tells them apart where its distances from them differ by
    a good part of their own distance.
    """
    problem = session.problem
    if not problem.assembly.near:
        return None
    coordinates, _ = probe_of(session).read(inputs, states)
    one, other = distances_near(problem, coordinates)
    total = 0.0
    for name in problem.assembly.near:
        first, second = (float(value) for value in coordinates[name])
        miss = _miss(problem, name, first, second)
        total += miss * miss
    if abs(one - other) <= tolerances.NEAR_SIDE * sqrt(total):
        return None
    return 0 if one < other else 1


def distances_home(session: Session, points: Floats) -> list[float]:
    """Root mean square over the moving links' joint points, in parts of the size."""
    home = np.array([at.vector for at in probe_of(session).points])[:, :, None]
    miss = (points - home) / session.problem.mechanism.box_diagonal()
    total = np.zeros(points.shape[2])
    for x, y, z in miss:
        total = total + (x * x + y * y + z * z)
    return [sqrt(float(squares) / len(home)) for squares in total]


def unclear(both: str, distances: tuple[float, float]) -> Diagnostic:
    """A warning that two assemblies are about as near."""
    return Diagnostic(
        "nearest-unclear",
        "warning",
        f"{both} are about equally near",
        measured=f"distances {distances[0]:.4g} and {distances[1]:.4g}",
        limit=f"ratio {tolerances.NEAR_RUNNER_UP}",
        hint="give more coordinates under assembly: near",
        numbers=tuple(Number("distance", distance) for distance in distances),
    )


@dataclass(frozen=True)
class AssemblyStart:
    """States at a row (the first, or the one nearest to an assembled home) and the mode's name,
    where it is known (else `near` or `home`); `how` it was found, in words. Without states `status`
    is the reason why there are none, and `stuck` whether the inputs did not move from the drawing
    at all. `off` is the distance from what `near` names and `condition` that of the assembly, as
    far as the choice has needed them. Where rows go on from others `turn` (turn slots,) are the
    turns of angles at the row, and `signs` those of quaternions in the first row."""

    state: Floats | None
    mode: str
    how: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    status: Status = Status.not_assembled
    row: int = 0
    stuck: bool = False
    off: float = inf
    condition: float | None = None
    turn: Floats | None = None
    signs: Mapping[str, float] = field(default_factory=dict)


Named = tuple["Floats", frozenset[int], bool]
"""What `near` names: states (states,), the others as drawn; the states that are named unknowns;
whether these are all unknowns."""


def named_by(session: Session) -> Named:
    """What the problem's `near` names."""
    layout = session.layout
    state, named = home_state(layout), set()
    left = {freedom for block in session.graph.blocks for freedom in block.unknowns}
    complete = True
    for name, value in session.problem.assembly.near.items():
        joint_name, _, coordinate = name.rpartition(".")
        joint = session.problem.mechanism.joints[joint_name]
        edge = layout.edge_number.get(joint_name)
        if edge is None:
            complete = False
            continue
        freedom = edge, joint.type.freedom_of[coordinate]
        number = layout.state(*freedom)
        state[number] = value / joint.unit_of(coordinate, layout.length)
        if freedom in left:
            named.add(number)
            left.discard(freedom)
    return state, frozenset(named), complete and not left


def newton_from(
    session: Session, inputs: Floats, named: Named
) -> tuple[Floats, float, float] | None:
    """The assembly (states,) that Newton's method reaches from what is named, the distance from it
    within which there is no other, 0 where none is known, and the condition of its loops; None if
    it reaches none.

    `inputs` (inputs,) in kernel units.
    """
    drawn, _, complete = named
    start = single_assembly(session.layout, session.plan, inputs, drawn)
    batch = session.close(inputs[:, None], start[:, None], Demand.CONDITION)
    if not batch.good[0] or batch.condition is None:
        return None
    state, condition = batch.states[:, 0], float(batch.condition[0])
    if not condition < tolerances.SEARCH_CONDITION:
        return None
    unique = _unique(session, state, condition) if complete else 0.0
    return state, unique, condition


def box_about(session: Session, named: Named, radius: float) -> Within:
    """The box of all states whose named unknowns lie within `radius` (rad, parts of the size)."""
    layout, (drawn, unknowns, _) = session.layout, named
    size = layout.mechanism.box_diagonal() / layout.length
    radii = np.full(drawn.size, inf)
    for block in layout.graph.blocks:
        for edge, freedom in block.unknowns:
            k, local = layout.carrier_of(edge, freedom)
            carrier = layout.carriers[k]
            if carrier.state + local in unknowns:
                slide = carrier.part.type.slides[local]
                radii[carrier.state + local] = radius * size if slide else radius
    return drawn, radii


def _unique(session: Session, state: Floats, condition: float) -> float:
    """Distance from an assembly (states,) within which there is no other; 0 where none is known."""
    if not all(closing.has_coordinates for closing in session.graph.closings):
        return 0.0
    if session.layout.carried:  # how much a curve bends is not known
        return 0.0
    least = inf
    for block in session.graph.blocks:
        loops = [_reach(session.layout, c, state) for c in block.closings]
        radius = _radius(len(block.unknowns), condition, [reach for reach, _ in loops])
        # within that ball slides reach farther, and H with them
        grown = [reach + slides * radius for reach, slides in loops]
        least = min(least, _radius(len(block.unknowns), condition, grown))
    return least


def _radius(unknowns: int, condition: float, reaches: list[float]) -> float:
    bend: float = unknowns * total(sqrt(reach * reach + 1.0) for reach in reaches)
    return 2.0 * (1.0 - tolerances.CONDITION_DIGITS) / (condition * bend)


def _reach(layout: Layout, number: int, state: Floats) -> tuple[float, float]:
    """The path round a loop through its joints' points and along its slides, in parts of the size,
    and by how much it grows at most for a ball of radius 1: no point of the loop is farther from
    any of its axes."""
    size = layout.mechanism.box_diagonal()
    total = slides = 0.0
    edges = {edge for edge, _ in layout.graph.loops[number]}
    for carrier in layout.carriers:
        if carrier.edge not in edges:
            continue
        if carrier.parent >= 0:
            total += norm(layout.body_frame[carrier.parent].local(carrier.part.before.o))
        pitch = abs(layout.graph.edges[carrier.edge].joint.pitch)
        for local, slide in enumerate(carrier.part.type.slides):
            value = abs(float(state[carrier.state + local]))
            if slide:
                total, slides = total + value * layout.length, slides + 1.0
            elif pitch:
                total, slides = total + (value + 1.0) * pitch, slides + pitch / size
    joint = layout.graph.closings[number].joint
    for link, frame in ((joint.first, joint.on_first), (joint.second, joint.on_second)):
        if link != GROUND_NAME:
            total += norm(layout.link_frame[link].local(frame.o))
    return total / size, slides


LOOP_SHOWN = 12
"""Joints of a loop that are named one by one."""


def nothing_found(
    session: Session, assemblies: Assemblies, place: str = "at the first row"
) -> Diagnostic:
    """Why a mechanism cannot be assembled: which loop does not close."""
    loop, name = _failed_loop(session, assemblies), session.problem.mechanism.name
    hint = "check the dimensions, or start the sweep at another input"
    if any(joint.type.counts_turns for joint in session.problem.mechanism.joints.values()):
        turns = session.problem.assembly.turns
        hint += f"; threads were searched {turns}.5 turns to either side: assembly: {{turns: N}}"
    if session.is_redundant:
        hint = "dimensions of an overconstrained loop must be exact (write expressions)"
    return Diagnostic(
        "not-assembled",
        "error",
        f"{name} cannot be assembled {place}{loop}",
        measured=_missed(assemblies),
        limit=None if assemblies.complete else f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint=hint,
        numbers=(
            Number("starts", assemblies.tried),
            Number("residual", assemblies.closest, limit=tolerances.RESIDUAL_ACCEPT),
        ),
    )


def _missed(assemblies: Assemblies) -> str:
    if assemblies.free:
        return (
            f"of {assemblies.starts} random starts those that closed the loops all ended where "
            "they still move with the inputs held, or in a singular position"
        )
    if assemblies.complete:
        return "its equations have no real root"
    best = f"the best to {assemblies.closest:.2g} of the size"
    return f"none of {assemblies.tried} random starts closed, {best}"


def _failed_loop(session: Session, assemblies: Assemblies) -> str:
    """The joints of the loops that did not close, and whether others were closed before."""
    if assemblies.failed is None or assemblies.free:
        return ""
    graph = session.graph
    names: dict[str, None] = {}
    closings = graph.blocks[assemblies.failed].closings
    for c in closings:
        joints, loop = graph.closings[c].joints, graph.loops[c]
        # outward to the cut joint's first link, and back
        paths = ([e for e, s in loop if e >= 0 and s == sign] for sign in (-1, 1))
        there, back = ([graph.edges[e].joint.name for e in sorted(path)] for path in paths)
        names.update(dict.fromkeys((*there, *joints, *reversed(back))))
    shown = [name for name in names if name in session.problem.mechanism.joints]
    more = f" and {len(shown) - LOOP_SHOWN} more" if len(shown) > LOOP_SHOWN else ""
    loops = "the loop" if len(closings) == 1 else f"the {len(closings)} loops"
    close = "does not close" if len(closings) == 1 else "do not close together"
    places = assemblies.places
    before = f", in none of {places} assemblies before it" if places > 1 else ""
    return f": {loops} through {', '.join(shown[:LOOP_SHOWN])}{more} {close}{before}"
