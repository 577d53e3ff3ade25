"""The assembly nearest to given coordinates by Newton's method, where it is proven to be that.

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

from math import inf, pi, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.home import home_state
from mechkin_cli.mechanism.joint_types import tree_types
from mechkin_cli.mechanism.model import GROUND_NAME
from mechkin_cli.mechanism.vectors import norm
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.layout import is_slide
from mechkin_cli.solver.search import Within, single_assembly

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session


class Near(NamedTuple):
    """The assembly (states,) that Newton's method finds, its distance from what is named, and the
    distance from it within which there is no other."""

    state: Floats
    distance: float
    unique: float

    @property
    def is_nearest(self) -> bool:
        """Whether no other assembly is nearer, or about as near."""
        return (1.0 + tolerances.NEAR_RUNNER_UP) * self.distance < self.unique


def named_state(session: Session) -> Floats | None:
    """States where `near` names every unknown, the others as drawn; None where it does not."""
    layout, near = session.layout, session.problem.assembly.near
    state = home_state(layout)
    left = {freedom for block in session.graph.blocks for freedom in block.unknowns}
    for name, value in near.items():
        place = _unknown(session, name)
        if place is None:
            return None
        left.discard(place[0])
        state[layout.state(*place[0])] = value / place[1]
    return None if left else state


def _unknown(session: Session, name: str) -> tuple[tuple[int, int], float] | None:
    """The freedom (edge, freedom) of a coordinate in the tree and the SI value of its unit."""
    joint_name, _, coordinate = name.partition(".")
    joint = session.problem.mechanism.joints[joint_name]
    edge = session.layout.edge_number.get(joint_name)
    if edge is None or not joint.type.freedom_of:
        return None
    unit = 1.0
    if is_slide(coordinate):
        unit = joint.lead / (2.0 * pi) if joint.letter == "H" else session.layout.length
    return (edge, joint.type.freedom_of[coordinate]), unit


def newton_from(session: Session, inputs: Floats, state: Floats) -> Near | None:
    """The assembly that Newton's method reaches from a state (states,); None if it reaches none.

    Args:
        session: a mechanism all of whose unknowns are scalars.
        inputs: (inputs,) in kernel units.
        state: where to start; distances count from it.
    """
    start = single_assembly(session.layout, session.plan, inputs, state)
    batch = session.close(inputs[:, None], start[:, None], Demand.CONDITION)
    if not batch.good[0] or batch.condition is None:
        return None
    found = batch.states[:, 0]
    miss = _scaled(session.layout, found - state)
    distance = sqrt(float(sum(part * part for part in miss)))
    return Near(found, distance, _unique(session, found, float(batch.condition[0])))


def box_about(session: Session, state: Floats, radius: float) -> Within:
    """The box of all unknowns within `radius` (rad, parts of the size) of a state (states,)."""
    layout = session.layout
    size = layout.mechanism.box_diagonal() / layout.length
    radii = np.full(state.size, inf)
    for number, slide in _unknown_states(layout):
        radii[number] = radius * size if slide else radius
    return Within(state, radii)


def _unknown_states(layout: Layout) -> list[tuple[int, bool]]:
    """State and whether it is a length, of every unknown."""
    found = []
    for block in layout.graph.blocks:
        for edge, freedom in block.unknowns:
            k, local = layout.carrier_of(edge, freedom)
            carrier = layout.carriers[k]
            found.append((carrier.state + local, tree_types()[carrier.part.letter].slides[local]))
    return found


def _scaled(layout: Layout, step: Floats) -> list[float]:
    """A difference of states by unknown: turns in rad, the shorter way round; slides in sizes."""
    size = layout.mechanism.box_diagonal() / layout.length
    parts = []
    for number, slide in _unknown_states(layout):
        value = float(step[number])
        parts.append(value / size if slide else value)
    return parts


def _unique(session: Session, state: Floats, condition: float) -> float:
    """Distance from an assembly (states,) within which there is no other; 0 where none is known."""
    if any(closing.leg is not None for closing in session.graph.closings):
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
    bend = unknowns * sum(sqrt(reach * reach + 1.0) for reach in reaches)
    return 2.0 * (1.0 - tolerances.CONDITION_DIGITS) / (condition * bend)


def _reach(layout: Layout, number: int, state: Floats) -> tuple[float, float]:
    """The way round a loop through its joints' points and along its slides, in parts of the size,
    and by how much it grows at most for a ball of radius 1: no point of the loop is farther from
    any of its axes."""
    closing = layout.graph.closings[number]
    size = layout.mechanism.box_diagonal()
    total = slides = 0.0
    edges = {edge for edge, _ in closing.loop}
    for carrier in layout.carriers:
        if carrier.edge not in edges:
            continue
        if carrier.parent >= 0:
            total += norm(layout.body_frame[carrier.parent].local(carrier.part.before.o))
        pitch = abs(layout.graph.edges[carrier.edge].joint.lead) / (2.0 * pi)
        for local, slide in enumerate(tree_types()[carrier.part.letter].slides):
            value = abs(float(state[carrier.state + local]))
            if slide:
                total, slides = total + value * layout.length, slides + 1.0
            elif pitch:
                total, slides = total + (value + 1.0) * pitch, slides + pitch / size
    joint = closing.joint
    for link, frame in ((joint.first, joint.on_first), (joint.second, joint.on_second)):
        if link != GROUND_NAME:
            total += norm(layout.link_frame[link].local(frame.o))
    return total / size, slides
