"""Some of the random linkages; more: `python -P tests/random_families/planar --seeds 0:2000`."""

from __future__ import annotations

import os
from typing import Any

import pytest
from random_families.planar import judge
from random_families.planar.judge import run_one

COUNT = 24 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_a_linkage_in_a_plane_is_that_in_space_and_that_of_dense_equations(seed: int) -> None:
    outcome = run_one(seed)
    assert not outcome.fault, f"{outcome.fault} {outcome.figures}\n{outcome.text}"


def test_another_mechanism_in_space_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    in_space = judge.in_space

    def heavier(data: dict[str, Any]) -> dict[str, Any]:
        found = in_space(data)
        for link in found["links"].values():
            if "mass" in link:
                link["mass"] *= 1 + 1e-9
        return found

    monkeypatch.setattr(judge, "in_space", heavier)
    assert run_one(3).fault == "off in force"


def test_an_oracle_beside_the_truth_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    moving = judge.Maximal.moving

    def late(model: Any, start: Any, value: Any) -> Any:
        return moving(model, start, value + 1e-9)

    monkeypatch.setattr(judge.Maximal, "moving", late)
    assert "position" in run_one(0).fault
