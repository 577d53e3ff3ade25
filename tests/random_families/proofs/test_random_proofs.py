"""Some of the random linkages; more: `python -P tests/random_families/proofs --seeds 0:1000`."""

from __future__ import annotations

import os
import random
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from oracle.numerics import mp
from random_families.proofs import judge
from random_families.proofs.judge import DRAWS, Outcome, judged, run_one
from random_families.proofs.linkage import Linkage

COUNT = 14 * int(os.environ.get("MECHKIN_RANDOM", "1"))
ROWS = [("0",), ("3",), ("7.5",)]


@pytest.mark.parametrize("seed", [seed for seed in range(COUNT) if seed % 20 != 8])
def test_nothing_is_proven_that_is_not_so(seed: int) -> None:
    outcome = run_one(seed)
    assert not outcome.fault, f"{outcome.fault}\n{outcome.text}"


def four_bar() -> Linkage:
    return DRAWS[0](random.Random("a four-bar"))


def verdict(linkage: Linkage) -> Outcome:
    return judged(linkage, "even", ROWS, ["1"], ["0.5"])


def test_a_linkage_drawn_is_proven_as_a_whole() -> None:
    assert verdict(four_bar()).remark == "with all of its rows proven"


@pytest.mark.parametrize("name", ["B.theta", "D.theta"])
def test_a_row_beside_the_truth_is_seen(name: str) -> None:
    linkage = four_bar()

    def beside(inputs: Any) -> Any:
        found = linkage.assemblies(inputs)
        return {s: {**known, name: known[name] + mp.mpf("1e-11")} for s, known in found.items()}

    assert "no assembly lies in its box" in verdict(replace(linkage, assemblies=beside)).fault


def test_rates_beside_the_truth_are_seen() -> None:
    linkage = four_bar()

    def bent(inputs: Any) -> Any:
        """Right at the row itself, with a rate of its own."""
        (angle,) = inputs
        off = (angle - angle_of_row(angle)) / 10**9
        found = linkage.assemblies(inputs)
        return {s: {**known, "D.theta": known["D.theta"] + off} for s, known in found.items()}

    assert "rates lie outside" in verdict(replace(linkage, assemblies=bent)).fault


def angle_of_row(angle: Any) -> Any:
    return min((mp.radians(mp.mpf(x)) for (x,) in ROWS), key=lambda row: abs(row - angle))


def test_a_way_that_is_not_open_is_seen() -> None:
    shut = replace(four_bar(), margin=lambda inputs: 0.0 * inputs[0] - 1.0)
    assert "nothing closes" in verdict(shut).fault


@pytest.mark.parametrize(("told", "fault"), [(True, "a jump"), (False, "")])
def test_a_jump_that_is_proven_is_seen(
    monkeypatch: pytest.MonkeyPatch, told: bool, fault: str
) -> None:
    def proven(session: Any, states: Any, solved: Any) -> Any:
        return SimpleNamespace(on_branch=np.full(solved.shape, told))

    monkeypatch.setattr(judge, "certify", proven)
    assert fault in verdict(four_bar()).fault
    assert bool(verdict(four_bar()).fault) is told


def test_a_mode_too_many_is_seen() -> None:
    linkage = four_bar()

    def one_side(inputs: Any) -> Any:
        return {linkage.home: linkage.assemblies(inputs)[linkage.home]}

    alone = replace(linkage, assemblies=one_side)
    assert "modes are proven to differ" in verdict(alone).fault
