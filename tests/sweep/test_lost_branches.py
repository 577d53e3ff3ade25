"""Words for a branch that is lost without a known cause: they go by the place where it is lost."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.assembly import choose_start
from mechkin_cli.plan import TrackEnd
from mechkin_cli.sweep import branch_end
from mechkin_cli.sweep.rows import SweepRows

SLIDER_CRANK = """
format: 1
plane: xy
units: {{length: m, angle: deg}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, rod], point: [0, 3]}}
  B: {{type: R, links: [rod, slider], point: [4, 0]}}
  S: {{type: P, links: [ground, slider], point: [4, 0], axis: [1, 0]}}
motion: {{inputs: {{S.s: {{values: [0, {last!r}, 3.9]}}}}}}
"""
"""Crank 3 and rod 5 stretch at s = 4, where the crank's rate is the slider's over sqrt(4 - s)."""


@pytest.mark.parametrize(
    ("last", "words"),
    [
        (2.0, "that place itself is regular"),
        (4.0 - 1e-15, "a singular position lies next to that place"),
    ],
)
def test_a_lost_branch_says_whether_its_last_place_is_singular(
    last: float, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = mk.loads(SLIDER_CRANK.format(last=last)).design.session
    start = choose_start(session)
    assert start.state is not None
    followed = session.follow_rows(start.state, every_row=True)
    state = np.ascontiguousarray(followed.guess[:, 1])
    inputs = np.ascontiguousarray(session.inputs.values[:, 1])
    lost = followed._replace(reached=2, end=TrackEnd.STALLED, inputs=inputs, state=state)
    rows = SweepRows.followed(lost)
    monkeypatch.setattr(branch_end, "find_limit", lambda *_: None)
    branch_end.explain_end(session, session.inputs.values, lost, rows)
    (note,) = rows.diagnostics
    assert note.code == "branch-lost"
    assert words in (note.hint or "")
    assert "where the condition is" in (note.measured or "")
