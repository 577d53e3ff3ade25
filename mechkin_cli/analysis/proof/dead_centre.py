"""Dead centres at which a sweep ends: proven where they are, with the branch of the rows that leads
to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.proof.bridge import bridge
from mechkin_cli.analysis.proof.distance import FULL_TURN
from mechkin_cli.analysis.proof.fold import Fold, prove_fold
from mechkin_cli.analysis.proof.turned import Turned
from mechkin_cli.solver.exchanged import exchange
from mechkin_cli.solver.proofs import Boxes, Enclosed, Nodes, prove_boxes

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.branch_limit import EndOfRows
    from mechkin_cli.solver.follow import Ending
    from mechkin_cli.solver.session import Session

WhyNot = Literal["inputs", "balls", "box", "closure", "branch"]
"""Why a dead centre is not proven: several inputs move there together; no joint coordinate leads
through it; no box could be proven to hold exactly one; its loops are only proven to closure; it is
proven to exist, but not that the branch of the rows leads to it."""


@dataclass(frozen=True, slots=True, eq=False)
class DeadCentre:
    """What is proven of a dead centre at which a way along the rows ends.

    Attributes:
        row: the last row before it, counted from 0.
        number: of the input that has it.
        place: the inputs there in doubles, with their whole turns (inputs,), kernel units.
        fold: what is proven to exist; None where nothing is.
        tubes: how many tubes lead there from the row.
        turned: how far the coordinates go from the row to there; None where the branch is not
            proven to lead there.
        why: why it is not proven; None where it is.
    """

    row: int
    number: int
    place: Floats
    fold: Fold | None
    tubes: int
    turned: Turned | None
    why: WhyNot | None


class Lead(NamedTuple):
    """The tubes along a way, and how far the coordinates go on it."""

    tubes: int
    turned: Turned


def prove_dead_centre(enclosed: Enclosed, row: Nodes, box: Boxes, end: EndOfRows) -> DeadCentre:
    """What is proven of a dead centre.

    Args:
        enclosed: the mechanism as it is driven.
        row: the last row before the dead centre.
        box: of that row.
        end: what following found.
    """
    session, ending = enclosed.session, end.ending
    way = ending.inputs - row.values[:, 0]
    moved = np.flatnonzero(np.abs(way) > row.off[:, 0])
    number = int(np.abs(way).argmax())

    def found(fold: Fold | None, lead: Lead | None, why: WhyNot | None) -> DeadCentre:
        tubes, turned = lead or (0, None)
        return DeadCentre(end.row, number, ending.inputs, fold, tubes, turned, why)

    if moved.size > 1:
        return found(None, None, "inputs")
    exchanged = exchange(session, number, ending.block, ending.first)
    if exchanged is None:
        return found(None, None, "balls")
    inputs = row.reduced[:, 0].copy()
    inputs[number] += way[number]
    guess = _guess(session, row, inputs, number, ending)
    fold = prove_fold(exchanged, inputs, row.off[:, 0], guess)
    if fold is None:
        return found(None, None, "box")
    if fold.boxes.beyond[0] > 0.0:
        return found(None, None, "closure")
    lead = _lead(enclosed, row, box, fold) if box.proven[0] else None
    return found(fold, lead, None if lead else "branch")


def _guess(session: Session, row: Nodes, inputs: Floats, number: int, ending: Ending) -> Floats:
    """States (states,) at a dead centre: of the block that has it as following found them, all
    others at a place just before it, since the walk of one block may leave others behind."""
    before = inputs[:, None].copy()
    gap = float(inputs[number] - row.reduced[number, 0])
    before[number] -= np.copysign(min(abs(gap), tolerances.DEAD_CENTRE_NEAR), gap)
    place = _place_on_way(session, row, before)
    state: Floats = (row if place is None else place[0]).states[:, 0].copy()
    for edge, freedom in session.graph.blocks[ending.block].unknowns:
        carrier = session.layout.carriers[session.layout.carrier_of(edge, freedom)[0]]
        own = slice(carrier.state, carrier.state + carrier.part.type.states)
        state[own] = ending.state[own]
    return state


def _lead(enclosed: Enclosed, row: Nodes, box: Boxes, fold: Fold) -> Lead | None:
    """From a row to a dead centre, None where the branch is not proven to lead there: with the
    input as parameter to a place before it, and from there with the exchanged coordinate."""
    number = fold.exchanged.number
    gap = fold.value - float(row.reduced[number, 0])
    for far in tolerances.DEAD_CENTRE_APPROACH:
        ahead = 0.5 * abs(fold.bend) * far * far
        if ahead < abs(gap):
            inputs = row.reduced.copy()
            inputs[number] += gap - np.copysign(ahead, gap)
            found = _place_on_way(enclosed.session, row, inputs)
            if found is None:
                continue
            place, turned = found
            way = Nodes(*(np.concatenate(pair, axis=1) for pair in zip(row, place, strict=True)))
            near = prove_boxes(enclosed, place)
            before = bridge(enclosed, way._replace(values=way.reduced)) if near.proven[0] else 0
            behind = _lead_exchanged(place, near, fold) if before else None
            if behind:
                return Lead(before + behind.tubes, turned.and_on(behind.turned))
        else:
            behind = _lead_exchanged(row, box, fold)
            if behind:
                return behind
    return None


def _place_on_way(session: Session, row: Nodes, inputs: Floats) -> tuple[Nodes, Turned] | None:
    """The closed place at some inputs (inputs, 1) to which the branch leads from a row, and how far
    the coordinates go to there."""
    path = np.concatenate([row.reduced, inputs], axis=1)
    followed = session.follow(path, row.states[:, 0], every_row=True, turns=True)
    if followed.reached < 2:
        return None
    closed = session.close(inputs, followed.guess[:, 1:])
    if not closed.good[0]:
        return None
    place = Nodes.of(session, inputs, inputs, closed.states)
    return place, Turned.along(session, followed)


def _lead_exchanged(place: Nodes, box: Boxes, fold: Fold) -> Lead | None:
    """From a place before a dead centre to it, with the exchanged coordinate as parameter.

    The place's position has that coordinate only as near as its box says: the first node is all of
    the box, in which each value of the coordinate has one position; that of the place is among
    them.
    """
    exchanged = fold.exchanged
    number, driven, freed = exchanged.number, exchanged.driven, exchanged.freed
    value = float(place.states[driven.state, 0])
    if driven.is_cyclic:
        value += FULL_TURN * np.rint((fold.node.values[number, 0] - value) / FULL_TURN)
    values, states, off = place.reduced.copy(), place.states.copy(), place.off.copy()
    least = box.radius.copy()
    rounding = tolerances.INPUT_ROUNDING * (FULL_TURN + abs(value))
    values[number], off[number] = value, box.radius[driven.column] + rounding
    states[freed.state], states[driven.state] = place.reduced[number], value
    least[freed.column], least[driven.column] = place.off[number], 0.0
    start = Nodes(values, values, states, off, least)
    ends = Nodes(*(np.concatenate(pair, axis=1) for pair in zip(start, fold.node, strict=True)))
    session = exchanged.session
    followed = session.follow(ends.reduced, states[:, 0], every_row=True, turns=True)
    tubes = bridge(fold.enclosed, ends) if followed.reached == 2 else 0
    return Lead(tubes, Turned.along(session, followed)) if tubes else None
