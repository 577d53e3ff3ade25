"""A few damaged files that are run; more: `python -P tests/fuzz/answers.py --seeds 0:10000`."""

from __future__ import annotations

import os

import pytest
from fuzz.answers import FORCES, answer, run_one

COUNT = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("text", FORCES, ids=range(len(FORCES)))
def test_what_is_damaged_is_sound(text: str) -> None:
    assert answer(text) == "answered"


def test_a_damaged_file_is_run_or_refused_with_a_place() -> None:
    found = [run_one(seed) for seed in range(COUNT)]
    assert not [fault for _, _, fault in found if fault]
    # damage that is either always harmless or always fatal would test nothing
    codes = {code for _, code, _ in found}
    assert "answered" in codes
    assert len(codes) > 10


def test_what_is_no_refusal_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mechkin_cli.loads", lambda *_: [][0])
    assert "IndexError" in run_one(0)[2]
