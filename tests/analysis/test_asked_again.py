"""A model that is asked the same again: nothing is prepared anew, and nothing piles up."""

from __future__ import annotations

from pathlib import Path

import mechkin_cli as mk

RCSR = Path(__file__).parents[2] / "mechanisms" / "dissertation" / "rcsr.yaml"


def test_a_sweep_that_was_asked_for_is_not_prepared_again() -> None:
    model = mk.load(RCSR)
    first = model.analyze(["O4.theta"], tables=[])
    known = len(model.design.memo)
    assert known > 0
    again = model.analyze(iter(["O4.theta"]), tables=())
    assert len(model.design.memo) == known
    other = model.analyze(["O4.theta_dot", "O4.theta"])
    for one in (again, other, mk.load(RCSR).analyze(["O4.theta"])):
        assert one["O4.theta"].tobytes() == first["O4.theta"].tobytes()


def test_sweeps_closed_elsewhere_do_not_pile_up() -> None:
    """Each has a session of its own, which goes with its answer."""
    model = mk.load(RCSR)
    _ = model.analyze(["O4.theta"])
    known = len(model.design.memo)
    for _ in range(3):
        _ = model.analyze(["O4.theta"], closed_at=["O3"])
    assert len(model.design.memo) == known
