"""The verdicts on rows."""

from pathlib import Path

import pytest

from mechkin_cli.verdict import Status

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
    assert solved == {"ok", "near-singular", "rank-unclear", "friction-undecided", "dead-centre"}


@pytest.mark.parametrize("status", Status)
def test_the_page_explains_every_status(status: Status) -> None:
    page = (Path(__file__).parents[1] / "docs" / "verdicts.md").read_text(encoding="utf-8")
    assert f"`{status.label}`" in page
