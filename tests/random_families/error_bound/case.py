"""One random mechanism: the errors of its rows and their bounds."""

from __future__ import annotations

import random
from typing import NamedTuple

import numpy as np
from modes.random_loops import random_loop
from random_families.no_wrong_row.case import drawn

import mechkin_cli as mk

FAMILIES = ("plane and sphere", "singular", "chain", "space")


class Rows(NamedTuple):
    """Of every row that is there: the largest error of a state, its bound, and the condition."""

    error: np.ndarray
    bound: np.ndarray
    condition: np.ndarray


def text_of(number: int) -> str:
    """A file of one of the families, in turn."""
    family = number % len(FAMILIES)
    if family < 3:
        return drawn(number // len(FAMILIES), family + 1).text
    loop = random_loop(random.Random(number)).text()
    last = "0.4 m" if "J0.s" in loop else "40 deg"
    return loop.replace("{at: 0}", f"{{from: 0, to: {last}, count: 20}}")


def rows_of(number: int) -> Rows:
    """The rows of one mechanism that have a position."""
    r = mk.loads(text_of(number)).analyze(["row.error_bound"], tables=[])
    error = r.errors.states
    bound = r["row.error_bound"]
    condition = np.asarray(r.result.quantity("row.condition").value)
    there = np.isfinite(error)
    return Rows(error[there], bound[there], condition[there])
