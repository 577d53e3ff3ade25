"""Two ways to one assembly: following an assembled home, and near given coordinates."""

from __future__ import annotations

import pytest
from oracle.document import document, to_text
from properties.answers import answers, at_row, errors, within
from properties.cases import LOOPS, STRUCTURES, case, original

import mechkin_cli as mk

TWICE = 2.0


SOME = [*LOOPS[::4], *STRUCTURES[::4]]


def near(name: str) -> str:
    """The first row's coordinates with three digits, in file units, instead of following home."""
    its = case(name)
    analysis = mk.loads(its.text).analyze()
    data = document(its.text)
    names = [f"{n}.{c}" for n, j in its.mechanism.joints.items() for c in j.coordinates]
    driven = {coordinate.split(".")[0] for coordinate in its.mechanism.inputs}
    first = {name: analysis[name][0] for name in names if name.split(".")[0] not in driven}
    data["assembly"] = {"near": {name: f"{value:.3g}" for name, value in first.items()}}
    return to_text(data)


@pytest.mark.parametrize("name", SOME)
def test_near_finds_what_home_leads_to(name):
    its = case(name)
    found = at_row(answers(near(name)), its.row)
    wanted = at_row(original(name), its.row)
    assert within(errors(found, wanted, its.size, its.condition), TWICE)


@pytest.mark.parametrize("name", SOME[::4])
def test_the_start_is_the_one_asked_for(name):
    assert mk.loads(case(name).text).analyze().result.how.startswith("followed")
    assert "off what near names" in mk.loads(near(name)).analyze().result.how
