"""A dead centre proven to exist, alone in an interval of a joint coordinate.

With the input u an unknown, a dead centre is a zero of (F, F_x v, v_s - 1): a position, a motion v
of the unknowns while the input rests, and its length in a joint coordinate s. Over an interval of s
the box of all other unknowns, u among them, holds exactly one position for every s, so F is solved
and v = x'(s). What is left is u'(s) = 0, and is put to Newton's method in intervals (R. E. Moore,
Interval analysis, 1966): if s0 - u'(s0) / u''(S) lies within S, there is exactly one zero in S.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import Demand
from mechkin_cli.proofs.boxes import Boxes, Enclosed, Nodes, differences, enclosed_of, prove_boxes
from mechkin_cli.proofs.enclose import Positions, enclose_derivatives
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, Exchanged, RowInputs

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


ROUNDED = 1.0 + 1.0 / (1 << 40)
"""Above what a handful of roundings take away."""


class Fold(NamedTuple):
    """A dead centre that is proven to exist, in the kernel's units.

    Attributes:
        exchanged: the mechanism driven at another coordinate.
        enclosed: the same with its constants enclosed.
        node: the interval of that coordinate in which there is exactly one dead centre.
        boxes: the box of the dead centre's position about that interval's middle.
        reach: how far from the middle the dead centre may be.
        bend: the second derivative of the input by that coordinate there, in doubles.
    """

    exchanged: Exchanged
    enclosed: Enclosed
    node: Nodes
    boxes: Boxes
    reach: float
    bend: float

    @property
    def value(self) -> float:
        """The input next to the dead centre, without its whole turns."""
        return float(self.node.states[self.exchanged.freed.state, 0])


def prove_fold(exchanged: Exchanged, inputs: Floats, off: Floats, state: Floats) -> Fold | None:
    """The dead centre next to a place; None where it could not be proven.

    Args:
        exchanged: the mechanism driven at another coordinate.
        inputs: (inputs,) there in doubles, angles without their whole turns.
        off: as in `Nodes` (inputs,).
        state: (states,) there in doubles.
    """
    session, freed = exchanged.session, exchanged.freed
    place = _closed_fold(exchanged, inputs, state)
    if place is None:
        return None
    values, states = place
    enclosed = enclosed_of(session)
    off = off[:, None].copy()
    off[exchanged.number] = 0.0
    node = Nodes(values, values, states, off, np.zeros((session.plan.columns, 1)))
    middle = prove_boxes(enclosed, node)
    (slope, slope_off), (bend, _) = _derivatives(exchanged, enclosed, node, middle)
    steep = (abs(slope) + slope_off) * ROUNDED
    if not (middle.proven[0] and np.isfinite(steep + bend) and bend):
        return None
    for wider in tolerances.DEAD_CENTRE_INTERVALS:
        off = node.off.copy()
        off[exchanged.number] = wider * steep / abs(bend) + tolerances.DEAD_CENTRE_LEAST
        # it holds the box about the middle, and so the same position there
        over = node._replace(off=off, least=middle.radius)
        boxes = prove_boxes(enclosed, over)
        if not boxes.proven[0]:
            return None
        _, (bends, bends_off) = _derivatives(exchanged, enclosed, over, boxes)
        least_bend = (abs(bends) - bends_off) / ROUNDED
        reach = steep / least_bend * ROUNDED if least_bend > 0.0 else np.inf
        if reach < off[exchanged.number, 0]:
            # at the dead centre the input is off by the integral of its derivative to there
            bent = (abs(bends) + bends_off) * reach * reach
            radius = (middle.radius[freed.column, 0] + bent) * ROUNDED
            boxes.radius[freed.column, 0] = min(boxes.radius[freed.column, 0], radius)
            return Fold(exchanged, enclosed, over, boxes, float(reach), bend)
    return None


def are_one(one: Fold, other: Fold) -> bool:
    """Whether two dead centres of one mechanism are proven to be the same: all over a box that
    holds both, each value of the coordinate has one position and the input bends the same way, so
    that it has one dead centre there at most."""
    exchanged = one.exchanged
    session, number, driven = exchanged.session, exchanged.number, exchanged.driven
    theirs = other.exchanged
    if (
        session.problem.mechanism is not theirs.session.problem.mechanism
        or session.graph != theirs.session.graph
        or number != theirs.number
    ):
        return False
    between = differences(session.layout, one.node.states[:, 0], other.node.states)
    least = 2.0 * (between + one.boxes.radius + other.boxes.radius)
    least[driven.column] = 0.0
    off = np.abs(one.node.values - other.node.values) + one.node.off + other.node.off
    off[number] = (between[driven.column] + one.reach + other.reach) * ROUNDED
    off[number] += tolerances.DEAD_CENTRE_LEAST
    both = one.node._replace(off=off, least=least)
    boxes = prove_boxes(one.enclosed, both)
    _, (bend, bend_off) = _derivatives(exchanged, one.enclosed, both, boxes)
    return bool(boxes.proven[0] and bend_off < abs(bend))


def _closed_fold(
    exchanged: Exchanged, inputs: Floats, state: Floats
) -> tuple[Floats, Floats] | None:
    """Inputs (inputs, 1) and states (states, 1) of the exchanged session where the freed input's
    derivative is zero, by Newton's method in doubles."""
    session, driven, freed = exchanged.session, exchanged.driven, exchanged.freed
    values, states = inputs[:, None].copy(), state[:, None].copy()
    states[freed.state] = inputs[exchanged.number]
    values[exchanged.number] = state[driven.state]
    rates = np.zeros_like(values)
    rates[exchanged.number] = 1.0
    for _ in range(tolerances.NEWTON_ITERATIONS):
        rows = RowInputs(values, states, rates, np.zeros_like(values))
        batch = session.run(rows, Ask(Demand.VELOCITY | Demand.ACCELERATION, derivatives=True))
        assert batch.first is not None
        assert batch.second is not None
        step = batch.first[freed.column, 0] / (batch.second[freed.column, 0] or np.nan)
        if not (batch.good[0] and abs(step) < tolerances.DEAD_CENTRE_MISS):
            return None
        states = batch.states
        if abs(step) < tolerances.DEAD_CENTRE_LEAST:
            break
        values[exchanged.number] -= step
    # the kernel reads the driven coordinate from the states
    states[driven.state] = values[exchanged.number]
    return values, states


def _derivatives(
    exchanged: Exchanged, enclosed: Enclosed, node: Nodes, boxes: Boxes
) -> list[tuple[float, float]]:
    """First and second derivative of the input by the coordinate that is driven instead, over a
    box: each with a radius."""
    positions = Positions(enclosed.plan, enclosed.constants, node.states, boxes.radius)
    inputs = np.stack([node.values, np.zeros_like(node.values), node.off], axis=1)
    column = exchanged.freed.column
    return [
        (float(derivative.high[column, 0]), float(derivative.about_high[column, 0]))
        for derivative in enclose_derivatives(positions, inputs, exchanged.number)
    ]
