"""Every quantity of random mechanisms against the oracle at 40 digits."""

from __future__ import annotations

import pytest
from oracle.mechanism import COORDINATES
from properties.answers import at_row, errors, within
from properties.cases import CASES, LOOPS, STRUCTURES, case, original
from properties.expected import expected

import mechkin_cli as mk


@pytest.mark.parametrize("name", CASES)
def test_all_quantities(name):
    its = case(name)
    found = at_row(original(name), its.row)
    wanted = expected(its.mechanism, its.solution, its.reactions)
    assert found.keys() == wanted.keys()
    assert within(errors(found, wanted, its.size, its.condition))


@pytest.mark.parametrize("name", CASES)
def test_verdicts(name):
    analysis = mk.loads(case(name).text).analyze(["ground.shaking_force"])
    assert (analysis["row.residual"] <= 1e-14).all()
    assert (analysis["row.power_error"] <= 1e-12).all()


def test_the_loops_have_all_types_in_all_roles():
    types = [case(name).types.split("-") for name in LOOPS]
    assert {kinds[0] for kinds in types} == set("RPCH")
    assert {kinds[-1] for kinds in types} == set("RPCHS")
    assert len(set(map(tuple, types))) > 0.75 * len(LOOPS)


def test_the_structures_have_all_types_and_shapes():
    mechanisms = [case(name).mechanism for name in STRUCTURES]
    types = {joint.type for m in mechanisms for joint in m.joints.values()}
    assert types == set(COORDINATES)
    assert {len(m.joints) - len(m.links) for m in mechanisms} == {2, 3}
    assert {len(m.inputs) for m in mechanisms} == {1, 2, 3}
