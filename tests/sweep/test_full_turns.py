"""A full turn of the input that does not come back to its start is told."""

from __future__ import annotations

from mechanisms.runs import model

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.search.clusters import pose_keys, same_poses
from mechkin_cli.search.search import all_assemblies
from mechkin_cli.sweep.messages import first_row, open_turn_note
from mechkin_cli.sweep.rows import SweepRows


def test_a_turn_that_closes_is_not_mentioned() -> None:
    result = model("rssr").analyze()
    assert result["O1.theta"][-1] - result["O1.theta"][0] == 360
    assert "turn-not-closed" not in {d.code for d in result.diagnostics}


def test_a_turn_that_ends_at_another_assembly_is_told() -> None:
    """The two assemblies of an RSSR put at either end of its turn."""
    session = model("rssr").session
    layout, inputs = session.layout, session.inputs.values
    found = all_assemblies(session, inputs[:, 0])
    assert found.number == 2
    keys = pose_keys(layout, found.states)
    assert not same_poses(keys[:, :1], keys[:, 1:])[0, 0]
    count = inputs.shape[1]
    rows = SweepRows.without_guesses(found.states.shape[0], 0, count)
    rows.states[:] = found.states[:, :1]
    rows.reached[:] = True

    def note() -> Diagnostic | None:
        return open_turn_note(session, rows, first_row(session, rows))

    assert note() is None
    rows.states[:, -1] = found.states[:, 1]
    told = note()
    assert told is not None
    assert (told.code, told.severity) == ("turn-not-closed", "note")
    assert "after 1 full turn of O1.theta, in row 37" in told.message
    rows.reached[-1] = False
    assert note() is None
