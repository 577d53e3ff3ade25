"""Quantities of proven rows, enclosed (docs/numerics.md, Intervals)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.enclosures import Enclosure, Given, Positions, enclose
from mechkin_cli.solver.proofs import Enclosed, about_high, input_rounding

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mechkin_cli.analysis.proof.certificate import Certificate
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.model import Mechanism
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.session import Session

_OF_ROWS = {"kinetic_energy", "potential_energy"}


def is_enclosed(mechanism: Mechanism, quantity: Wanted) -> bool:
    """Whether a quantity is among those that can be enclosed."""
    if quantity.kind in DERIVED_KINDS or (
        quantity.owner == "row" and quantity.kind not in _OF_ROWS
    ):
        return False
    return not demand_of(mechanism, [quantity]) & Demand.JERK


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
    enclosed = session.once("enclosed", lambda: Enclosed.of(session))
    given = Given.of(session) if enclosed.of_text else Given.of_doubles(session)
    positions = Positions(enclosed.plan, enclosed.constants, states, certificate.boxes.radius)
    found = enclose(session, positions, given, wanted, turned=turned)
    known = certificate.on_branch & _are_inside(session, given)
    return {
        name: Enclosure(high, low, np.where(known, radius, np.inf))
        for name, (high, low, radius) in found.items()
    }


def _are_inside(session: Session, given: Given) -> Bools:
    """Rows whose inputs are among those that the boxes were proven for."""
    reduced = session.inputs.reduced
    off = np.abs(given.inputs[:, 0] - reduced) + about_high(given.inputs.transpose(1, 0, 2))
    inside = off <= input_rounding(session, reduced)
    found: Bools = np.asarray(inside.all(axis=0), dtype=np.bool_)
    return found
