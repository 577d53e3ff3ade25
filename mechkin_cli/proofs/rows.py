"""Proves the rows of a sweep: a box about each, and tubes from each to the next; and encloses the
quantities of proven rows and dead centres: which can be, and their bounds in the file's units
(docs/numerics.md, Intervals).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.exact import PI
from mechkin_cli.mechanism import (
    DERIVED_KINDS,
    LEDGER_KINDS,
    Problem,
    Wanted,
    is_angle,
    rubbing_words,
)
from mechkin_cli.proofs.boxes import (
    FULL_TURN,
    MEASURED,
    Boxes,
    Enclosed,
    Nodes,
    distance,
    enclosed_of,
    input_rounding,
    prove_boxes,
    prove_tubes,
)
from mechkin_cli.proofs.dead_centre import DeadCentreProof, bridge, prove_dead_centre
from mechkin_cli.proofs.enclose import (
    EnclosedInputs,
    Enclosure,
    Positions,
    enclose,
    enclose_positions,
)
from mechkin_cli.record import dataclass, replace
from mechkin_cli.session import Session, input_unit
from mechkin_cli.tape import DoubleDoubles
from mechkin_cli.verdict import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.plan import Layout
    from mechkin_cli.session import Ending
    from mechkin_cli.show import Bools, Floats


Why = Literal["no position", "box", "branch"]
"""Why nothing is proven of a row: it has no position; no box about its position could be proven;
its box is proven, but not that it lies on the branch of the rows before."""


Gap = tuple[int, int, Why]
"""The first and the last row (counted from 0) of a stretch of which nothing is proven, and why."""


@dataclass(frozen=True, slots=True, eq=False)
class SweepProofs:
    """Proofs of the rows of a sweep.

    Attributes:
        boxes: of all rows; those without a position have none.
        solved: rows that have a position (rows,).
        joined: whether each row is joined to the next by tubes (rows - 1,).
        tubes: how many tubes there are.
        anchor: the first row whose box is proven; the branch of all others is compared with its.
        of_text: whether it is proven of the numbers of the file's text; else of the kernel's
            doubles.
        dead_centres: those at which paths along the rows end.
    """

    boxes: Boxes
    solved: Bools
    joined: Bools
    tubes: int
    anchor: int
    of_text: bool
    dead_centres: tuple[DeadCentreProof, ...] = ()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.solved.size

    @property
    def status(self) -> NDArray[np.int8]:
        """Codes of `Proof` (rows,)."""
        exact = np.where(self.boxes.beyond > 0.0, Proof.proven_to_closure, Proof.proven)
        return np.asarray(np.where(self.on_branch, exact, Proof.not_proven), dtype=np.int8)

    @property
    def on_branch(self) -> Bools:
        """Rows whose boxes are proven and joined without a gap to the first that is."""
        together = np.concatenate([[True], self.joined])
        together[: self.anchor + 1] = True
        return np.asarray(np.logical_and.accumulate(together) & self.boxes.proven)

    @property
    def is_complete(self) -> bool:
        """Whether every row is proven, or proven to closure: the sweep lies on one branch."""
        return bool(self.on_branch.all())

    @property
    def gaps(self) -> tuple[Gap, ...]:
        """Where nothing is proven."""
        reason = np.where(self.on_branch, 0, np.where(~self.solved, 1, 2 + self.boxes.proven))
        words: tuple[Why, ...] = ("no position", "box", "branch")
        edges = np.flatnonzero(np.diff(reason, prepend=-1))
        ends = [*edges[1:], reason.size]
        return tuple(
            (int(first), int(end) - 1, words[reason[first] - 1])
            for first, end in zip(edges, ends, strict=True)
            if reason[first]
        )


def certify(
    session: Session, states: Floats, solved: Bools, ends: Sequence[tuple[int, Ending]] = ()
) -> SweepProofs:
    """Proofs of all rows of a sweep.

    Args:
        session: the mechanism, driven along the rows.
        states: of the rows in doubles (states, rows).
        solved: which rows have a position (rows,).
        ends: the dead centres at which paths along the rows end, behind the last row before each.
    """
    inputs = session.inputs
    nodes = Nodes.of(session, inputs.values, inputs.reduced, states)
    enclosed = enclosed_of(session)
    boxes = prove_boxes(enclosed, nodes)
    proven = boxes.proven & solved
    boxes = boxes._replace(proven=proven)
    joined, count = np.zeros(max(solved.size - 1, 0), dtype=bool), 0
    for rows in _stretches(proven):
        joined[rows.start : rows.stop - 1], tubes = prove_tubes(
            enclosed, nodes.part(rows), boxes.part(rows)
        )
        count += tubes
    for row in np.flatnonzero(proven[:-1] & proven[1:] & ~joined):
        tubes = bridge(enclosed, nodes.part(slice(row, row + 2)))
        joined[row] = tubes > 0
        count += tubes
    anchor = int(proven.argmax()) if proven.any() else 0
    certificate = SweepProofs(boxes, solved, joined, count, anchor, enclosed.of_text)
    dead_centres = tuple(_ended(enclosed, nodes, certificate, *end) for end in ends)
    return replace(certificate, dead_centres=dead_centres)


def _ended(
    enclosed: Enclosed, nodes: Nodes, certificate: SweepProofs, number: int, ending: Ending
) -> DeadCentreProof:
    """What is proven of a dead centre behind a row, which the branch leads to if it leads to the
    row."""
    row = slice(number, number + 1)
    proof = prove_dead_centre(
        enclosed, nodes.part(row), certificate.boxes.part(row), number, ending
    )
    lost = proof.why is None and not certificate.on_branch[number]
    return replace(proof, why="branch") if lost else proof


def _stretches(proven: Bools) -> list[slice]:
    """Rows next to each other, two at least, that are all proven."""
    edges = np.flatnonzero(np.diff(proven.astype(np.int8), prepend=0, append=0))
    pairs = zip(edges[0::2], edges[1::2], strict=True)
    return [slice(int(a), int(b)) for a, b in pairs if b - a > 1]


_OF_ROWS = {"kinetic_energy", "potential_energy"}


def reason_against(quantity: Wanted) -> str:
    """Why a quantity has no enclosure in any mechanism; "" where it can have one."""
    if quantity.kind in LEDGER_KINDS:
        return "a sum over the rows"
    if quantity.kind in DERIVED_KINDS:
        return "computed from other quantities in doubles alone"
    if quantity.owner == "row" and quantity.kind not in _OF_ROWS:
        return "a verdict"
    return ""


def is_angle_of_place(quantity: Wanted) -> bool:
    """Whether it is an angle of a joint, no rate of one."""
    return quantity.kind == "coordinate" and not quantity.order and is_angle(quantity.coordinate)


def reason_unknown(problem: Problem) -> str:
    """Why forces of a mechanism have no enclosure in any row that is proven; "" where they have."""
    if problem.mechanism.frictions:
        named = rubbing_words(problem.mechanism.frictions)
        return f"{named}, which is solved for in doubles"
    drives = problem.mechanism.drives
    if drives is not None and drives.actuators:
        return "efforts at actuators other than the inputs, which are solved for in doubles"
    return ""


def bounds(
    problem: Problem, wanted: Wanted, enclosure: Enclosure, known: Floats
) -> tuple[Floats, Floats]:
    """Bounds of a quantity in the file's units, two arrays (width, places); nan where nothing is
    known. Angles are those next to what is `known` in SI, of the same shape; those of threads, of
    which a turn more is another place, are as they are enclosed."""
    seen = list(wanted.places)
    middle, radius = enclosure.high[seen], enclosure.about_high[seen]
    scale = np.abs(middle)
    if is_angle_of_place(wanted):
        kind = problem.mechanism.joints[wanted.owner].type
        if kind.chain[kind.freedom_of[wanted.coordinate]].is_cyclic:
            turns = FULL_TURN * np.rint((known - middle) / FULL_TURN)
            middle, scale = middle + turns, scale + np.abs(turns)
    middle, radius, scale = (
        np.asarray(problem.units.from_si(part, wanted.dimension))
        for part in (middle, radius, scale)
    )
    off = radius + tolerances.ENCLOSURE_ROUNDING * (radius + scale)
    off = np.where(np.isfinite(off) & np.isfinite(np.atleast_2d(known)), off, np.nan)
    return middle - off, middle + off


def inside_boxes(session: Session) -> Bools:
    """Rows whose inputs, as the text says them, are among those that the boxes were proven for."""
    return _are_inside(session, _enclosed(session)[1])


def _enclosed(session: Session) -> tuple[Enclosed, EnclosedInputs]:
    """The mechanism and its inputs, of the text where it can be followed to them."""
    enclosed = enclosed_of(session)
    of = EnclosedInputs.of if enclosed.of_text else EnclosedInputs.of_doubles
    return enclosed, of(session)


def _are_inside(session: Session, inputs: EnclosedInputs) -> Bools:
    reduced = session.inputs.reduced
    high, low, radius = inputs.inputs.transpose(1, 0, 2)
    inside = distance(high, low, reduced) + radius <= input_rounding(session, reduced)
    return np.asarray(inside.all(axis=0), dtype=np.bool_)


def enclosures(
    session: Session,
    certificate: SweepProofs,
    wanted: Sequence[Wanted],
    states: Floats,
    turned: Floats,
) -> Mapping[str, Enclosure]:
    """Enclosures of quantities in SI (width, rows), of the rows that are proven; elsewhere nothing
    is known. Angles up to whole turns; of reactions that are not unique one of many.

    Args:
        states: of the rows in doubles (states, rows).
        turned: the cut joints' angles as following has them (turn slots, rows).
    """
    enclosed, inputs = _enclosed(session)
    positions = Positions(enclosed.plan, enclosed.constants, states, certificate.boxes.radius)
    over_boxes = enclose(session, positions, inputs, wanted, turned=turned)
    known = certificate.on_branch & _are_inside(session, inputs)
    return {
        name: Enclosure(high, low, np.where(known, radius, np.inf))
        for name, (high, low, radius) in over_boxes.items()
    }


def position_bounds(
    session: Session,
    states: Floats,
    solved: Bools,
    coordinates: Mapping[Wanted, Floats],
    turned: Floats,
) -> tuple[Floats, Floats]:
    """How far rows in doubles can be from the one position that is proven to be near each (rows,):
    the largest of all states and coordinates, in rad and the kernel's lengths, of orientations the
    angle, nan where nothing is proven; and `Boxes.beyond` (rows,): where that is above 0 the first
    is the distance to the zero of the equations solved for.

    Args:
        session: the mechanism, driven along the rows.
        states: of the rows in doubles (states, rows).
        solved: the rows in question (rows,).
        coordinates: values of joint coordinates in SI (rows,), with their whole turns.
        turned: as in `enclosures`.
    """
    error, rows = np.full(solved.size, np.nan), session.inputs
    enclosed, inputs = _enclosed(session)
    if not enclosed.of_text:
        return error, np.zeros(solved.size)
    boxes = prove_boxes(enclosed, Nodes.of(session, rows.values, rows.reduced, states))
    proven = boxes.proven & solved & _are_inside(session, inputs)
    for closed in (True, False):
        part = proven & ((boxes.beyond == 0.0) == closed)
        if not part.any():
            continue
        positions = Positions(enclosed.plan, enclosed.constants, states, boxes.radius)
        places = enclose_positions(positions, inputs.inputs, closed=closed)
        off = [_off_places(session.layout, states, places)]
        found = enclose(session, positions, inputs, coordinates, turned=turned, closed=closed)
        off += [_off(session, q, values, found[q.name]) for q, values in coordinates.items()]
        error[part] = np.max(off, axis=0)[part]
    error *= MEASURED
    return np.where(np.isfinite(error), error, np.nan), boxes.beyond


def _off_places(layout: Layout, states: Floats, places: Enclosure) -> Floats:
    """The largest that a state can be off the enclosed places (rows,)."""
    largest = np.zeros(states.shape[1])
    for carrier in layout.carriers:
        kind, row, column = carrier.part.type, carrier.state, carrier.column
        if kind.is_ball:
            turn = [
                np.abs(places.high[c]) + places.about_high[c] for c in range(column, column + 3)
            ]
            # tan(angle / 2) is half the increments' length, and a quaternion is a unit to rounding
            angle = np.sqrt(turn[0] ** 2 + turn[1] ** 2 + turn[2] ** 2)
            w, x, y, z = states[row : row + 4]
            length = np.abs((w * w + x * x) + (y * y + z * z) - 1.0)
            largest = np.maximum(largest, angle + length + tolerances.ENCLOSURE_ROUNDING)
            continue
        for number in range(len(kind.freedoms)):
            c = column + number
            off = distance(places.high[c], places.low[c], states[row + number])
            largest = np.maximum(largest, off + places.radius[c])
    return largest


def _off(session: Session, wanted: Wanted, values: Floats, found: Enclosure) -> Floats:
    """How far a coordinate in SI, or converted to the file's unit, can be off (rows,): in rad, in
    the kernel's lengths."""
    true: Any = DoubleDoubles(found.high[0], found.low[0])
    unit = 1.0 if is_angle_of_place(wanted) else session.layout.length
    if is_angle_of_place(wanted):
        turns = np.rint((values - found.high[0]) / FULL_TURN)
        true = true + turns * DoubleDoubles.of_fraction(2 * PI)
    off = distance(true.high, true.low, values) + found.radius[0]
    return np.asarray((off + tolerances.ENCLOSURE_ROUNDING * np.abs(values)) / unit)


def dead_centre_enclosure(proof: DeadCentreProof, wanted: Wanted) -> Enclosure:
    """Enclosure of a quantity of the position at a dead centre in SI (width, 1); nothing is known
    where no dead centre is proven. Angles up to whole turns."""
    fold = proof.fold
    if fold is None:
        unknown = np.full((3 if wanted.vector else 1, 1), np.nan)
        return Enclosure(unknown, unknown, np.full_like(unknown, np.inf))
    node, enclosed, exchanged = fold.node, fold.enclosed, fold.exchanged
    whole = np.zeros_like(node.values)
    parts = np.stack([node.values, whole, node.off], axis=1)
    parts[exchanged.number, 2] = fold.reach
    still = np.zeros_like(parts)
    inputs = EnclosedInputs(parts, still, still, still, whole, None, None)
    positions = Positions(enclosed.plan, enclosed.constants, node.states, fold.boxes.radius)
    return enclose(exchanged.session, positions, inputs, [wanted])[wanted.name]


def input_bounds(session: Session, proof: DeadCentreProof) -> tuple[float, float]:
    """Bounds of the input at its dead centre in the file's units; nan where none is proven."""
    problem, item = session.problem, session.problem.motion.inputs[proof.number]
    known = proof.place[proof.number] * input_unit(session.layout, item)
    wanted = problem.quantities()[item.name]
    enclosure = dead_centre_enclosure(proof, wanted)
    low, high = bounds(problem, wanted, enclosure, np.array([[known]]))
    return float(low[0, 0]), float(high[0, 0])
