"""A session in which a joint coordinate is driven in place of one input, which is found instead.

Near a dead centre of the input the branch is a function of the coordinate, and not of the input.
Tree, states and columns are those of the session that it was made of.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Attached,
    Frame,
    Mechanism,
    add,
    cross,
    find_legs,
    frame_on,
    norm,
    scale,
    subtract,
)
from mechkin_cli.plan import Layout, home_inputs, home_state
from mechkin_cli.session.session import Session
from mechkin_cli.structure import RandomStarts, SolverGraph, UnsolvableGraph, exchanged, whole_link

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class ExchangedCoordinate(NamedTuple):
    """A coordinate that the mechanism is driven by or solved for: (edge, freedom), (joint,
    coordinate), its column and state, and whether a full turn of it is the same place."""

    at: tuple[int, int]
    name: tuple[str, str]
    column: int
    state: int
    is_cyclic: bool


class Exchanged(NamedTuple):
    """A session, and what was exchanged in it: the input `number` is now the coordinate `driven`,
    and `freed` is found."""

    session: Session
    number: int
    driven: ExchangedCoordinate
    freed: ExchangedCoordinate


def exchange(session: Session, number: int, block: int, first: Floats) -> Exchanged | None:
    """The session driven at that unknown of a block which moves most, in place of input `number`;
    None where all unknowns of the block are turns of balls.

    Args:
        session: the mechanism as it is driven.
        number: of the input.
        block: the one that has a dead centre.
        first: derivatives of the columns along the branch (columns,).
    """
    graph = session.graph
    unknowns = [_scalar(session, at) for at in graph.blocks[block].unknowns]
    scalars = [unknown for unknown in unknowns if unknown is not None]
    freed = _scalar(session, graph.inputs[number])
    if not scalars or freed is None:
        return None
    driven = max(scalars, key=lambda unknown: abs(float(first[unknown.column])))
    other = exchanged(graph, number, driven.at, driven.name)
    found = session.exchanged(other)
    return Exchanged(found, number, driven, freed)


def _scalar(session: Session, at: tuple[int, int]) -> ExchangedCoordinate | None:
    """A freedom of the tree as a coordinate; None for one of a ball."""
    layout, (edge, freedom) = session.layout, at
    joint = session.graph.edges[edge].joint
    kernel_joint, local = layout.carrier_of(edge, freedom)
    kind = layout.carriers[kernel_joint].part.type
    if kind.is_ball:
        return None
    names = [name for name, of in joint.type.scalars.items() if of == freedom]
    unnamed = f"{'slide' if kind.slides[local] else 'turn'} {freedom}"
    name = (joint.name, names[0] if names else unnamed)
    column, state = layout.column(edge, freedom), layout.state(edge, freedom)
    return ExchangedCoordinate(at, name, column, state, kind.freedoms[local].is_cyclic)


# Places where a mechanism is assembled, next to its drawing, to take ranks at.
#
# The drawing itself if it is assembled; else what Newton's method makes of it, all loops of a
# component in one block. A drawing may be a special position, so places with the inputs moved a
# little follow. If nothing closes, the drawing has to do as it is.

Poses = Callable[[str], Frame]


def assembled_places(mechanism: Mechanism, graph: Callable[[], SolverGraph]) -> Iterator[Poses]:
    """Where the links' drawings stand; `graph` closes all loops of a component at once."""
    yield from closed_places(mechanism, graph)
    if not is_drawn_assembled(mechanism):
        yield _as_drawn


def closed_places(
    mechanism: Mechanism, graph: Callable[[], SolverGraph], at: Sequence[float] = ()
) -> Iterator[Poses]:
    """As `assembled_places`, without a drawing that is not assembled; beside it the inputs stand
    `at` these values (rad, m), or at zero."""
    drawn = is_drawn_assembled(mechanism)
    if drawn:
        yield _as_drawn
    session = _session(mechanism, graph)
    if session is not None:
        moves = [(move, off) for off in (1.0, 0.0) for move in tolerances.PLACE_MOVES]
        for move, off in moves if drawn else [(0.0, 0.0), *moves]:
            poses = _closed(session, at, move, off * move)
            if poses is not None:
                yield poses


def is_drawn_assembled(mechanism: Mechanism) -> bool:
    """Whether all joints are drawn with their frames on each other, and legs as long as they are
    apart."""
    most = tolerances.LOOP_RANK
    size = mechanism.box_diagonal()
    parts = [part for joint in mechanism.joints.values() for part in joint.parts]
    turns = [
        norm(subtract(one, other))
        for part in parts
        if not part.type.is_ball
        for one, other in zip(part.before[:3], part.after[:3], strict=True)
    ]
    apart = [
        norm(subtract(add(part.before.o, scale(part.drawn, part.before.z)), part.after.o))
        for part in parts
    ]
    for leg in find_legs(mechanism):
        foot, head = frame_on(leg.start, leg.first).o, frame_on(leg.end, leg.second).o
        apart.append(abs(norm(subtract(head, foot)) - norm(leg.span)))
    return max(turns, default=0.0) <= most and max(apart, default=0.0) <= most * size


def _as_drawn(link: str) -> Frame:
    return GROUND


def _session(mechanism: Mechanism, graph: Callable[[], SolverGraph]) -> Session | None:
    """The mechanism in the kernel, where it can be solved as it is driven."""
    from mechkin_cli.mechanism import Assembly, MotionInputs, Problem
    from mechkin_cli.session.session import Session
    from mechkin_cli.units import UnitSystem

    try:
        found = graph()
    except UnsolvableGraph:
        return None
    if any(block.equations > tolerances.MOST_EQUATIONS for block in found.blocks):
        return None
    # no load says where links stand, and the laws of those that vary are the runs'
    unloaded = replace(mechanism, loads=(), frictions=())
    problem = Problem(unloaded, MotionInputs((), 1), Assembly(), UnitSystem())
    return Session.of(problem, found, driven=found.driven)


def _displaced(layout: Layout, move: float) -> Floats:
    """The drawing with all coordinates but those of balls moved, up to so much."""
    state, random = home_state(layout), RandomStarts()
    for carrier in layout.carriers:
        if not carrier.part.type.is_ball:
            count = len(carrier.part.type.freedoms)
            state[carrier.state : carrier.state + count] += move + random.between(move, count)
    return state


def _closed(session: Session, at: Sequence[float], move: float, off: float) -> Poses | None:
    """The poses that Newton's method reaches with all inputs moved from where they stand, from a
    guess that is `off` the drawing; None where it does not close."""
    layout = session.layout
    joints = layout.mechanism.joints
    stand = [
        value / joints[name].unit_of(coordinate, layout.length)
        for (name, coordinate), value in zip(session.driven, at, strict=bool(at))
    ]
    origin, length = layout.origin, layout.length
    ends = (ZERO, scale(length, GROUND.x), scale(length, GROUND.y))
    links = [name for name in layout.mechanism.links if name != GROUND_NAME]
    points = [Attached(name, add(origin, end)) for name in links for end in ends]
    readout = session.readout((), points)
    home = np.array(stand) if at else home_inputs(layout)
    inputs: Floats = home[:, None] + move
    batch = session.run(inputs, _displaced(layout, off)[:, None], readout=readout)
    if not batch.good[0] or batch.outputs is None:
        return None
    values = batch.outputs[:, 0].tolist()
    read = [(values[k], values[k + 1], values[k + 2]) for k in readout.points]
    found = {GROUND_NAME: GROUND}
    for number, name in enumerate(links):
        middle, *others = read[3 * number : 3 * number + 3]
        x, y = (scale(1.0 / length, subtract(end, middle)) for end in others)
        turn = Frame(x, y, cross(x, y), ZERO)
        back = add(add(scale(origin[0], x), scale(origin[1], y)), scale(origin[2], turn.z))
        found[name] = turn._replace(o=subtract(middle, back))
    # the half of a cut link goes with the other
    return lambda link: found[whole_link(link)]
