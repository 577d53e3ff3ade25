"""Every quantity of random loops against the oracle at 40 digits."""

from __future__ import annotations

import pytest
from properties.answers import answers, at_row, errors, within
from properties.expected import expected
from properties.loops import SEEDS, loop

import mechkin_cli as mk


@pytest.mark.parametrize("seed", SEEDS)
def test_all_quantities(seed):
    case = loop(seed)
    found = at_row(answers(case.text), case.row)
    wanted = expected(case.mechanism, case.solution, case.reactions)
    assert found.keys() == wanted.keys()
    assert within(errors(found, wanted, case.size, case.condition))


@pytest.mark.parametrize("seed", SEEDS)
def test_verdicts(seed):
    analysis = mk.loads(loop(seed).text).analyze(["J1.effort"])
    assert (analysis["row.residual"] <= 1e-14).all()
    assert (analysis["row.power_error"] <= 1e-12).all()


def test_the_loops_have_all_types_in_all_roles():
    types = [loop(seed).types for seed in SEEDS]
    assert {kinds[0] for kinds in types} == set("RPCH")
    assert {kinds[-1] for kinds in types} == set("RPCHS")
    assert len(set(types)) > 30
