"""Responses with friction on a changed page: sliding, sticking and breaking away have the bits of
the command's."""

from __future__ import annotations

import pytest
from live.rubbing import RESPONSES
from live.test_cells import NODE, RANDOM, checked_run, computed, verdict_texts

from mechkin_cli import loads
from mechkin_cli.view.scene import page_data

pytestmark = pytest.mark.skipif(NODE is None, reason="needs node")
VARIANTS = max(RANDOM, 10)


@pytest.mark.parametrize("name", RESPONSES)
def test_rubbing_responses_are_those_of_the_command(name: str) -> None:
    text, run = RESPONSES[name]
    # half of the variants of the loop may be lost, as where it does not close
    spread = 0.02 if name == "rcsr" else 0.1
    columns = sum(len(table.columns) for table in loads(text).respond(run).tables)
    checked = checked_run(name, loads(text), run, spread, VARIANTS)
    assert checked >= columns * (VARIANTS + 1) // 2


def test_more_friction_ends_a_motion_on_a_page() -> None:
    text, run = RESPONSES["incline"]
    model = loads(text.replace("push: 2 N/s", "push: 0 N/s").replace("35 deg", "20 deg"))
    data, _ = page_data([model.respond(run)], modes=False)
    cases = [{"mu": mu} for mu in (0.1, 0.4)]
    ends = [float(one["tables"][0]["rows"][-1][2]) for one in computed(data, cases)]
    assert ends[0] < 0.0, "tan(20 deg) is more than both coefficients: it comes down again"
    assert ends[1] == 0.0


def test_a_page_has_the_power_errors_of_the_command() -> None:
    """No table of the nut asks for forces, but its arrows read some."""
    text, run = RESPONSES["nut"]
    model = loads(text)
    theirs = verdict_texts(model.respond(run))["power_error"]
    data, _ = page_data([model.respond(run)], modes=False)
    assert data["runs"][0]["branches"][0]["arrows"]
    table = next(table for table in data["tables"] if table["name"] == f"{run}.rows")
    at = [one["label"] for one in table["columns"]].index("power_error")
    assert [row[at] for row in table["rows"]] == theirs == [""] * 41
