"""Quantities of proven rows, enclosed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.proofs.enclose import (
    Enclosure,
    Given,
    Positions,
    _are_inside,
    _enclosed,
    bounds,
    enclose,
)
from mechkin_cli.session import input_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.proofs.dead_centre import DeadCentreProof
    from mechkin_cli.proofs.rows import SweepProofs
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


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
    enclosed, given = _enclosed(session)
    positions = Positions(enclosed.plan, enclosed.constants, states, certificate.boxes.radius)
    found = enclose(session, positions, given, wanted, turned=turned)
    known = certificate.on_branch & _are_inside(session, given)
    return {
        name: Enclosure(high, low, np.where(known, radius, np.inf))
        for name, (high, low, radius) in found.items()
    }


def dead_centre_enclosure(session: Session, found: DeadCentreProof, wanted: Wanted) -> Enclosure:
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


def input_bounds(session: Session, found: DeadCentreProof) -> tuple[float, float]:
    """Bounds of the input at its dead centre in the file's units; nan where none is proven."""
    problem, item = session.problem, session.problem.motion.inputs[found.number]
    known = found.place[found.number] * input_unit(session.layout, item)
    wanted = problem.quantities()[item.name]
    enclosure = dead_centre_enclosure(session, found, wanted)
    low, high = bounds(problem, wanted, enclosure, np.array([[known]]))
    return float(low[0, 0]), float(high[0, 0])
