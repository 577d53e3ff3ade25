"""Mobility of linkages of known mobility after changes that must not matter.

MECHKIN_RANDOM multiplies the number of cases.
"""

from __future__ import annotations

import os
from random import Random
from typing import Any

import pytest
import yaml
from classics import osculating, planes, platforms, rings, robots, sheets
from classics.changes import CHANGES, braced
from classics.drawing import Classic

import mechkin_cli as mk

MODULES = (rings, planes, platforms, robots, osculating, sheets)
CASES = [case for module in MODULES for case in module.CASES]
NUMBER = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))


def changed(seed: int) -> tuple[Classic, Any, str]:
    random = Random(seed)
    case = CASES[seed % len(CASES)]
    change = CHANGES[random.randrange(len(CHANGES))]
    document = yaml.safe_load(case.text)
    if change is braced and not document["links"]:
        change = CHANGES[0]
    return case, change, yaml.safe_dump(change(document, random), sort_keys=False)


@pytest.mark.parametrize("seed", range(NUMBER))
def test_the_answer_stays(seed: int) -> None:
    case, change, text = changed(seed)
    more = int(change is braced)
    found = mk.loads(text).mobility()
    assert found.dimensions == tuple(d + more for d in case.dimensions), (case.name, change)
    assert found.first_order == case.first_order + more, (case.name, change)
