"""Dead centres at which a sweep ends: proven to exist, alone in an interval of a joint coordinate
(`prove_fold`), and to be on the branch of the rows.

With the input u an unknown, a dead centre is a zero of (F, F_x v, v_s - 1): a position, a motion v
of the unknowns while the input rests, and its length in a joint coordinate s. Over an interval of s
the box of all other unknowns, u among them, holds exactly one position for every s, so F is solved
and v = x'(s). What is left is u'(s) = 0, and is put to Newton's method in intervals (R. E. Moore,
Interval analysis, 1966): if s0 - u'(s0) / u''(S) lies within S, there is exactly one zero in S.

`bridge` joins two places that no one tube joins, by closing the mechanism at places between them;
`Turned` counts the whole turns along a path, which its ends do not show.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import Demand
from mechkin_cli.proofs.boxes import (
    FULL_TURN,
    Boxes,
    Enclosed,
    Nodes,
    differences,
    enclosed_of,
    prove_boxes,
    prove_tubes,
)
from mechkin_cli.proofs.enclose import Positions, enclose_derivatives
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.session import (
    Ask,
    Ending,
    Exchanged,
    Followed,
    RowInputs,
    Session,
    exchange,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
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


def bridge(enclosed: Enclosed, ends: Nodes) -> int:
    """The tubes that join two nodes; 0 where the branch is not proven to lead from one to the
    other.

    A long path is cut into parts at once. Where a tube is missing its middle is closed, and both
    halves are tried: near a dead centre each place halves the distance that is left.
    """
    nodes = _cut(enclosed.session, ends)
    if nodes is None:
        return 0
    most = nodes.states.shape[1] + tolerances.BRIDGE_NODES
    while True:
        boxes = prove_boxes(enclosed, nodes)
        joined, tubes = prove_tubes(enclosed, nodes, boxes)
        if joined.all():
            return tubes
        missing = np.flatnonzero(~joined)
        length = np.abs(np.diff(nodes.values, axis=1)).max(axis=0, initial=0.0)
        is_hopeless = (
            not boxes.proven.all()
            or nodes.states.shape[1] + missing.size > most
            or bool((length[missing] < tolerances.BRIDGE_STEP).any())
        )
        middle = None if is_hopeless else _middles(enclosed.session, nodes, missing)
        if middle is None:
            return 0
        nodes = nodes.inserted(missing, middle)


def _cut(session: Session, ends: Nodes) -> Nodes | None:
    """Two nodes and closed places between them, so that no input goes farther than `BRIDGE_PART`
    from one to the next; None where these would be more than `BRIDGE_PARTS`, or the branch ends."""
    length = float(np.abs(np.diff(ends.values, axis=1)).max(initial=0.0))
    parts = int(min(length / tolerances.BRIDGE_PART, tolerances.BRIDGE_PARTS)) + 1
    if parts == 1:
        return ends
    if parts > tolerances.BRIDGE_PARTS:
        return None
    shares = np.arange(1, parts) / parts
    values = ends.values[:, :1] + shares * (ends.values[:, 1:] - ends.values[:, :1])
    places = ends.between(np.zeros(parts - 1, dtype=np.intp), values, ends.states[:, :1])
    reduced = np.concatenate([ends.reduced[:, :1], places.reduced], axis=1)
    followed = session.follow(reduced, ends.states[:, 0], every_row=True)
    if followed.reached < parts:
        return None
    closed = session.close(places.reduced, followed.guess[:, 1:])
    if not closed.good.all():
        return None
    return ends.inserted(np.zeros(parts - 1, dtype=np.intp), places._replace(states=closed.states))


def _middles(session: Session, nodes: Nodes, before: NDArray[np.intp]) -> Nodes | None:
    """The closed places half way between nodes and the next, followed from there; None where the
    branch does not lead so far."""
    values = 0.5 * (nodes.values[:, before] + nodes.values[:, before + 1])
    places = nodes.between(before, values, nodes.states[:, before])
    guess = np.empty_like(places.states)
    for k, node in enumerate(before):
        path = np.stack([nodes.reduced[:, node], places.reduced[:, k]], axis=1)
        followed = session.follow(path, nodes.states[:, node], every_row=True)
        if followed.reached < 2:
            return None
        guess[:, k] = followed.guess[:, 1]
    closed = session.close(places.reduced, guess)
    return places._replace(states=closed.states) if closed.good.all() else None


@dataclass(frozen=True, slots=True, eq=False)
class Turned:
    """How far coordinates went, rad and lengths of the kernel.

    Attributes:
        tree: the states (states,); those of orientations have no meaning.
        closing: the angles of cut joints by (cut joint, freedom).
    """

    tree: Floats
    closing: Mapping[tuple[int, int], float]

    @classmethod
    def along(cls, session: Session, followed: Followed) -> Self:
        """From the first place of a path, followed with its turns, to the last."""
        assert followed.turns is not None
        structure, turns = session.structure, followed.turns[:, -1] - followed.turns[:, 0]
        tree = followed.guess[:, -1] - followed.guess[:, 0]
        for state, slot in structure.tree_slots.items():
            tree[state] += FULL_TURN * turns[slot]
        closing = structure.closing_slots.items()
        return cls(tree, {angle: float(turns[slot]) for angle, slot in closing})

    def and_on(self, other: Turned) -> Turned:
        """Along this path and then another one, of the same tree."""
        both = {angle: one + other.closing[angle] for angle, one in self.closing.items()}
        return Turned(self.tree + other.tree, both)

    def of_angle(self, session: Session, wanted: Wanted) -> float:
        """How far a joint's angle went, rad."""
        layout = session.layout
        reference = layout.joint_reference[wanted.owner]
        freedom = layout.mechanism.joints[wanted.owner].type.freedom_of[wanted.coordinate]
        if reference < 0:
            return self.closing[-1 - reference, freedom]
        return float(self.tree[layout.state(layout.edge_number[wanted.owner], freedom)])


WhyNot = Literal["inputs", "balls", "box", "closure", "branch"]
"""Why a dead centre is not proven: several inputs move there together; no joint coordinate leads
through it; no box could be proven to hold exactly one; its loops are only proven to closure; it is
proven to exist, but not that the branch of the rows leads to it."""


@dataclass(frozen=True, slots=True, eq=False)
class DeadCentreProof:
    """What is proven of a dead centre at which a path along the rows ends.

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


Lead = tuple[int, Turned]
"""The tubes along a path to a dead centre, and how far the coordinates go on it."""


def prove_dead_centre(
    enclosed: Enclosed, row: Nodes, box: Boxes, behind: int, ending: Ending
) -> DeadCentreProof:
    """What is proven of a dead centre.

    Args:
        enclosed: the mechanism as it is driven.
        row: the last row before the dead centre.
        box: of that row.
        behind: the number of that row.
        ending: where following ended.
    """
    session = enclosed.session
    gap = ending.inputs - row.values[:, 0]
    moved = np.flatnonzero(np.abs(gap) > row.off[:, 0])
    number = int(np.abs(gap).argmax())

    def proof(
        why: WhyNot | None, fold: Fold | None = None, lead: Lead | None = None
    ) -> DeadCentreProof:
        tubes, turned = lead or (0, None)
        return DeadCentreProof(behind, number, ending.inputs, fold, tubes, turned, why)

    if moved.size > 1:
        return proof("inputs")
    exchanged = exchange(session, number, ending.block, ending.first)
    if exchanged is None:
        return proof("balls")
    inputs = row.reduced[:, 0].copy()
    inputs[number] += gap[number]
    guess = _guess(session, row, inputs, number, ending)
    fold = prove_fold(exchanged, inputs, row.off[:, 0], guess)
    if fold is None:
        return proof("box")
    if fold.boxes.beyond[0] > 0.0:
        return proof("closure")
    lead = _lead(enclosed, row, box, fold) if box.proven[0] else None
    return proof(None if lead else "branch", fold, lead)


def _guess(session: Session, row: Nodes, inputs: Floats, number: int, ending: Ending) -> Floats:
    """States (states,) at a dead centre: of the block that has it those where following ended, all
    others at a place just before it, since one block's path may leave others behind."""
    before = inputs[:, None].copy()
    gap = float(inputs[number] - row.reduced[number, 0])
    before[number] -= np.copysign(min(abs(gap), tolerances.DEAD_CENTRE_NEAR), gap)
    place = _place_on_path(session, row, before)
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
            on_path = _place_on_path(enclosed.session, row, inputs)
            if on_path is None:
                continue
            place, turned = on_path
            path = row.then(place)
            near = prove_boxes(enclosed, place)
            before = bridge(enclosed, path._replace(values=path.reduced)) if near.proven[0] else 0
            behind = _lead_exchanged(place, near, fold) if before else None
            if behind:
                return before + behind[0], turned.and_on(behind[1])
        else:
            behind = _lead_exchanged(row, box, fold)
            if behind:
                return behind
    return None


def _place_on_path(session: Session, row: Nodes, inputs: Floats) -> tuple[Nodes, Turned] | None:
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
    ends = start.then(fold.node)
    session = exchanged.session
    followed = session.follow(ends.reduced, states[:, 0], every_row=True, turns=True)
    tubes = bridge(fold.enclosed, ends) if followed.reached == 2 else 0
    return (tubes, Turned.along(session, followed)) if tubes else None
