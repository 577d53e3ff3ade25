"""Every mechanism file: all rows solved, loops closed, power balanced, no matter where loops are
closed."""

from __future__ import annotations

import os

import numpy as np
import pytest
from mechanisms.runs import LECTURES, NAMES, closings, model, motions, run
from references import FILE_OF

from mechkin_cli.verdict import Status

NOTHING = 1e-14  # in the file's units: links that only slide turn by roundings, 1.3e-14 degrees
TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
SELDOM = 1 if TIMES > 1 else 8
"""Of every so many ways to close the loops of a mechanism of the how-to pages, one is tried."""


def cuts_of(name: str) -> list[tuple[str, ...]]:
    step = SELDOM if FILE_OF[name].parent.name == "howto" else 1
    return closings(name)[::step]


CUTS = [(name, cut) for name in NAMES for cut in cuts_of(name)]


@pytest.mark.parametrize("name", NAMES + LECTURES)
def test_every_row_is_solved(name):
    analysis = run(name)
    assert set(analysis.result.status.tolist()) == {Status.ok}
    assert np.all(analysis["row.residual"] <= 1e-14)


@pytest.mark.parametrize("name", NAMES)
def test_power_balances(name):
    assert not np.any(run(name)["row.power_error"] > 1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_inputs_are_loaded(name):
    """Without loads or masses the balance of power would hold trivially."""
    efforts = [q for q in model(name).quantities if q.endswith(".effort")]
    if model(name).problem.motion.rest is not None:
        assert not efforts, "what rests has no drive"
        return
    assert any(np.any(np.abs(run(name)[effort]) > 1e-3) for effort in efforts)


@pytest.mark.parametrize(("name", "cut"), CUTS, ids=[f"{n}-{'-'.join(c)}" for n, c in CUTS])
def test_where_loops_are_closed(name, cut):
    """Motions and efforts are the same to 1e-12 of the largest value of their family."""
    usual, other = run(name), run(name, cut)
    assert np.all(other.result.status == Status.ok)
    for family in motions(name).values():
        largest = max(np.max(np.abs(usual[quantity])) for quantity in family)
        for quantity in family:
            error = np.max(np.abs(usual[quantity] - other[quantity]))
            assert error <= 1e-12 * largest + NOTHING, quantity


@pytest.mark.parametrize("name", NAMES + LECTURES)
def test_a_file_says_what_it_is(name):
    first, second = FILE_OF[name].read_text(encoding="utf-8").splitlines()[:2]
    assert first == "# yaml-language-server: $schema=../../schemas/mechanism.schema.json"
    assert second == "format: 1"
    assert model(name).name
    assert model(name).source
    assert all(table.title for table in model(name).tables)
