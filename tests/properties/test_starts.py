"""Two ways to one assembly: following an assembled home, and near given coordinates."""

from __future__ import annotations

import pytest
from oracle.document import document, to_text
from properties.answers import answers, at_row, errors, within
from properties.loops import SEEDS, loop

import mechkin_cli as mk

TWICE = 2.0


def near(seed: int) -> str:
    """The first row's coordinates with three digits, in file units, instead of following home."""
    case = loop(seed)
    analysis = mk.loads(case.text).analyze()
    data = document(case.text)
    names = [f"{n}.{c}" for n, j in case.mechanism.joints.items() for c in j.coordinates]
    first = {name: analysis[name][0] for name in names if name.split(".")[0] != "J1"}
    data["assembly"] = {"near": {name: f"{value:.3g}" for name, value in first.items()}}
    return to_text(data)


@pytest.mark.parametrize("seed", SEEDS[::4])
def test_near_finds_what_home_leads_to(seed):
    case = loop(seed)
    found = at_row(answers(near(seed)), case.row)
    wanted = at_row(answers(case.text), case.row)
    assert within(errors(found, wanted, case.size, case.condition), TWICE)


@pytest.mark.parametrize("seed", SEEDS[::16])
def test_the_start_is_the_one_asked_for(seed):
    assert mk.loads(loop(seed).text).analyze().result.how.startswith("followed")
    assert mk.loads(near(seed)).analyze().result.how.startswith("near")
