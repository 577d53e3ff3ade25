"""The verdicts on rows."""

import re
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli.verdict
from mechkin_cli.verdict import (
    Status,
    by_condition,
    has_rates,
    has_solution,
    labels,
    rates_are_clear,
)

LABELS = {
    "ok": 0,
    "near-singular": 1,
    "beyond-dead-centre": 2,
    "branch-lost": 3,
    "not-converged": 4,
    "not-assembled": 5,
    "rank-unclear": 6,
    "friction-undecided": 7,
    "singular-inertia": 8,
    "step-limit": 9,
    "dead-centre": 10,
    "unsupported": 11,
    "beyond-limit": 12,
    "slack": 13,
    "fleet-angle": 14,
    "no-equilibrium": 15,
    "snapped-through": 16,
}


def test_the_enumeration_is_fixed():
    assert {status.label: int(status) for status in Status} == LABELS


@pytest.mark.parametrize("status", Status)
def test_every_status_has_a_sentence(status):
    assert status.sentence.endswith(".")
    assert status.sentence == status.sentence.strip()
    assert status.sentence.count(".") == 1


def test_rows_with_a_position_have_a_solution():
    solved = {status.label for status in Status if status.has_solution}
    judged = {"ok", "near-singular", "rank-unclear", "friction-undecided", "dead-centre"}
    assert solved == {*judged, "unsupported", "beyond-limit", "slack", "fleet-angle"}


@pytest.mark.parametrize("status", Status)
def test_the_page_explains_every_status(status: Status) -> None:
    page = (Path(__file__).parents[1] / "docs" / "verdicts.md").read_text(encoding="utf-8")
    names = ("position", "rates", "forces")
    marks = (status.has_solution, status.has_rates, status.has_forces)
    has = ", ".join(name for name, mark in zip(names, marks, strict=True) if mark) or "nothing"
    if status.ends_run:
        has += ", nor do those beyond it"
    assert f"\n| `{status.label}` | {has} | " in page


@pytest.mark.parametrize("status", Status)
def test_a_row_with_forces_has_rates_and_one_with_rates_a_position(status: Status) -> None:
    assert status.has_solution >= status.has_rates >= status.has_forces
    assert not (status.ends_run and status.has_solution)


def test_codes_of_many_rows_mean_what_their_members_mean() -> None:
    codes = np.arange(len(Status), dtype=np.int8)
    assert has_solution(codes).tolist() == [status.has_solution for status in Status]
    assert has_rates(codes).tolist() == [status.has_rates for status in Status]
    assert labels(codes).tolist() == [status.label for status in Status]


@pytest.mark.parametrize(
    ("condition", "status"),
    [
        (1.0, Status.ok),
        (1e7, Status.ok),
        (np.nextafter(1e7, 1e8), Status.near_singular),
        (1e12, Status.near_singular),
        (np.nextafter(1e12, 1e13), Status.rank_unclear),
        (np.inf, Status.rank_unclear),
        (np.nan, Status.rank_unclear),
    ],
)
def test_the_condition_alone_gives_a_status(condition: float, status: Status) -> None:
    assert by_condition(np.array([condition])).tolist() == [status]
    if rates_are_clear(condition):
        assert status is Status.ok


def test_only_the_verdict_gives_a_status_by_condition() -> None:
    """Sweeps, variants and single positions go by one rule."""
    package = Path(mechkin_cli.verdict.__file__).parent
    for path in package.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        if path.name != "verdict.py" and path.parent.name != "tolerances":
            assert "CONDITION_RATES_UNCLEAR" not in text
            assert not re.search(
                r"(= |int\()Status\.(near_singular|rank_unclear)\b.*CONDITION", text
            )
