"""Quantities of proven rows, enclosed (docs/numerics.md, Intervals)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.proof.distance import FULL_TURN
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS, LEDGER_KINDS
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.solver.enclosures import Enclosure, Given, Positions, enclose
from mechkin_cli.solver.inputs import input_unit
from mechkin_cli.solver.proofs import Enclosed, distance, input_rounding

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mechkin_cli.analysis.proof.certificate import Certificate
    from mechkin_cli.analysis.proof.dead_centre import DeadCentre
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session

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


def enclosures(
    session: Session,
    certificate: Certificate,
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
    enclosed, given = _enclosed(session)
    positions = Positions(enclosed.plan, enclosed.constants, states, certificate.boxes.radius)
    found = enclose(session, positions, given, wanted, turned=turned)
    known = certificate.on_branch & _are_inside(session, given)
    return {
        name: Enclosure(high, low, np.where(known, radius, np.inf))
        for name, (high, low, radius) in found.items()
    }


def dead_centre_enclosure(session: Session, found: DeadCentre, wanted: Wanted) -> Enclosure:
    """Enclosure of a quantity of the position at a dead centre in SI (width, 1); nothing is known
    where no dead centre is proven. Angles up to whole turns."""
    fold = found.fold
    if fold is None:
        unknown = np.full((3 if wanted.vector else 1, 1), np.nan)
        return Enclosure(unknown, unknown, np.full_like(unknown, np.inf))
    node, enclosed, exchanged = fold.node, fold.enclosed, fold.exchanged
    inputs = np.stack([node.values, np.zeros_like(node.values), node.off], axis=1)
    inputs[exchanged.number, 2] = fold.reach
    still = np.zeros_like(inputs)
    given = Given(inputs, still, still, still, np.zeros_like(node.values), None, None)
    positions = Positions(enclosed.plan, enclosed.constants, node.states, fold.boxes.radius)
    return enclose(exchanged.session, positions, given, [wanted])[wanted.name]


def input_bounds(session: Session, found: DeadCentre) -> tuple[float, float]:
    """Bounds of the input at its dead centre in the file's units; nan where none is proven."""
    problem, item = session.problem, session.problem.motion.inputs[found.number]
    known = found.place[found.number] * input_unit(session.layout, item)
    wanted = problem.quantities()[item.name]
    enclosure = dead_centre_enclosure(session, found, wanted)
    low, high = bounds(problem, wanted, enclosure, np.array([[known]]))
    return float(low[0, 0]), float(high[0, 0])


def bounds(
    problem: Problem, wanted: Wanted, enclosure: Enclosure, known: Floats
) -> tuple[Floats, Floats]:
    """Bounds of a quantity in the file's units, two arrays (width, places); nan where nothing is
    known. Angles are those next to what is `known` in SI, of the same shape; those of threads, of
    which a turn more is another place, are as they are enclosed."""
    seen = list(wanted.places)
    middle, radius = enclosure.high[seen], enclosure.about_high[seen]
    scale = np.abs(middle)
    if is_angle_of_place(wanted) and _is_cyclic(problem, wanted):
        turns = FULL_TURN * np.rint((known - middle) / FULL_TURN)
        middle, scale = middle + turns, scale + np.abs(turns)
    middle, radius, scale = (
        np.asarray(problem.units.from_si(part, wanted.dimension))
        for part in (middle, radius, scale)
    )
    off = radius + tolerances.ENCLOSURE_ROUNDING * (radius + scale)
    off = np.where(np.isfinite(off) & np.isfinite(np.atleast_2d(known)), off, np.nan)
    return middle - off, middle + off


def _is_cyclic(problem: Problem, angle: Wanted) -> bool:
    """Whether a turn more of a joint's angle is the same place."""
    kind = problem.mechanism.joints[angle.owner].type
    return kind.chain[kind.freedom_of[angle.coordinate]].is_cyclic


def inside_boxes(session: Session) -> Bools:
    """Rows whose inputs, as the text says them, are among those that the boxes were proven for."""
    return _are_inside(session, _enclosed(session)[1])


def _enclosed(session: Session) -> tuple[Enclosed, Given]:
    """The mechanism and its inputs, of the text where it can be followed to them."""
    enclosed = session.once("enclosed", lambda: Enclosed.of(session))
    return enclosed, Given.of(session) if enclosed.of_text else Given.of_doubles(session)


def _are_inside(session: Session, given: Given) -> Bools:
    reduced = session.inputs.reduced
    high, low, radius = given.inputs.transpose(1, 0, 2)
    inside = distance(high, low, reduced) + radius <= input_rounding(session, reduced)
    found: Bools = np.asarray(inside.all(axis=0), dtype=np.bool_)
    return found
