"""What every row of the RCSR tables says about itself."""

from __future__ import annotations

import numpy as np

from mechkin_cli.verdict import Status


def test_every_row_is_solved(analysis):
    assert analysis.result.status.tolist() == [Status.ok] * 27


def test_loops_are_closed(analysis):
    assert np.all(analysis["row.residual"] <= 1e-14)


def test_power_balances(analysis):
    assert np.all(analysis["row.power_error"] <= 1e-12)


def test_condition_grows_towards_the_dead_centre(analysis):
    condition = analysis["row.condition"]
    assert np.all(condition >= 1.0)
    assert condition.argmax() == 26
