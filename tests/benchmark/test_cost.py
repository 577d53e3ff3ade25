"""The cost command counts what the kernel did, and knows the gaps that a mechanism meets."""

from __future__ import annotations

import sys

from benchmark import cost


def test_two_versions_take_turns() -> None:
    versions = {name: cost.Version(sys.executable) for name in ("before", "after")}
    text = cost.near_change_point("1e-4", "SS", 1)
    found = cost.in_turns(versions, text, 1)
    assert found["before"]["steps"] == found["after"]["steps"] > 10
    assert all(f["attempts"] >= f["steps"] and 0 < f["follow"] < f["sweep"] for f in found.values())


def test_a_narrower_gap_takes_more_steps() -> None:
    here = {"after": cost.Version(sys.executable)}
    table = cost.four_bars(here)
    attempts = [line["after"] for line in table.rows if "twice" not in str(line["case"])]
    assert attempts[0] < attempts[2] < attempts[4]


def test_gaps_of_random_mechanisms() -> None:
    met = [found[1] for number in range(6) if (found := cost.gaps_met(number))]
    assert met
    assert min(met) >= 1
