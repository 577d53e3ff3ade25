"""A few seconds of seeded fuzzing; `python tests/fuzz` goes on for minutes, guided by coverage."""

import os
import random

import pytest
from fuzz.mutation import mutated
from fuzz.seeds import seeds, words
from fuzz.verdict import check, verdict

import mechkin_cli as mk
from mechkin_cli.diagnostics import Diagnostic, Place

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

RUNS = 150 * TIMES
"""Damaged files per part: some seconds."""


@pytest.mark.parametrize("part", range(5))
def test_any_bytes_are_a_model_or_refused_with_a_place(part: int) -> None:
    dice = random.Random(part)
    first, vocabulary = seeds(), words()
    sound = [content for content in first if verdict(content) == "model"]
    seen: set[str] = set()
    for _ in range(RUNS):
        content = mutated(dice.choice(dice.choice([sound, first])), first, vocabulary, dice)
        try:
            seen.add(verdict(content))
        except Exception as error:
            raise AssertionError(f"found by {content!r}") from error
    # damage that is either always harmless or always fatal would test nothing
    assert "model" in seen
    assert len(seen) > 10


def test_every_seed_has_a_verdict() -> None:
    verdicts = [verdict(content) for content in seeds()]
    assert verdicts.count("model") >= 10


@pytest.mark.parametrize(("line", "column"), [(3, 1), (2, 5), (0, 1), (1, 0)])
def test_a_place_outside_the_text_is_a_finding(line: int, column: int) -> None:
    place = Place("fuzz.yaml", line, column)
    with pytest.raises(AssertionError):
        check(Diagnostic("x", "error", "x", place), b"ab\nabc")


def test_a_slow_answer_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fuzz.verdict.MOST_CALLS", 0)
    with pytest.raises(AssertionError, match=r"calls, limit 0"):
        verdict(b"")


def test_what_is_no_refusal_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mk, "loads", lambda *_: [][0])
    with pytest.raises(IndexError):
        verdict(b"")
