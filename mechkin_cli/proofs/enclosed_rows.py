"""Quantities of proven rows and dead centres, enclosed: which can be, and their bounds in the
file's units (docs/numerics.md, Intervals).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import DERIVED_KINDS, LEDGER_KINDS, Problem, Wanted, is_angle
from mechkin_cli.proofs.boxes import FULL_TURN, Enclosed, distance, enclosed_of, input_rounding
from mechkin_cli.proofs.enclose import EnclosedInputs, Enclosure, Positions, enclose
from mechkin_cli.session import Session, input_unit

if TYPE_CHECKING:
    from mechkin_cli.proofs.dead_centre import DeadCentreProof
    from mechkin_cli.proofs.rows import SweepProofs
    from mechkin_cli.show import Bools, Floats


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
        return "friction, whose sticking and slipping is decided in doubles"
    if any(law.curve is not None for law in problem.load_laws):
        return "a load that is read from a table, whose curve is known in doubles"
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
        turned: the closing joints' angles as following has them (turn slots, rows).
    """
    enclosed, inputs = _enclosed(session)
    positions = Positions(enclosed.plan, enclosed.constants, states, certificate.boxes.radius)
    over_boxes = enclose(session, positions, inputs, wanted, turned=turned)
    known = certificate.on_branch & _are_inside(session, inputs)
    return {
        name: Enclosure(high, low, np.where(known, radius, np.inf))
        for name, (high, low, radius) in over_boxes.items()
    }


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
