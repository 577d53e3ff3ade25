"""Legs between spheres against the oracle, which has them as bodies with six unknowns each.

Rates have zero spin in both. Poses of a leg beyond its line are a convention and not compared: the
files have no points there.
"""

from __future__ import annotations

import numpy as np
import pytest
from oracle import assemble, condition_of, document, newton_euler, read
from oracle_checks.legs import rssr, stewart, suspension
from properties.answers import errors, within
from properties.expected import expected

import mechkin_cli as mk

FILES = {"RSSR": rssr, "suspension": suspension, "Stewart": stewart}


@pytest.mark.parametrize("name", FILES)
def test_legs(name: str) -> None:
    text = FILES[name]()
    mechanism = read(document(text))
    solution = assemble(mechanism, mechanism.row(0))
    wanted = expected(mechanism, solution, newton_euler(mechanism, solution))
    model = mk.loads(text)
    analysis = model.analyze([*wanted])
    assert {d.code for d in analysis.diagnostics} <= {"conventional"}
    found = {quantity: analysis[quantity][0].reshape(-1) for quantity in wanted}
    turns = [q for q in wanted if q.endswith((".theta", ".theta1", ".theta2"))]
    found |= {quantity: np.radians(found[quantity]) for quantity in turns}
    worst = errors(found, wanted, float(mechanism.size), condition_of(mechanism, solution))
    assert within(worst), worst
