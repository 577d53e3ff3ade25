"""Machines with couplings, laws, limits, cables and curves against closed forms and equations of
all bodies: `python -P tests/random_families/driven_machines FAMILY --seeds 0:1000` takes more."""

from __future__ import annotations

import pytest
from random_families.driven_machines import misread
from random_families.driven_machines.families import FAMILIES, judge

import mechkin_cli as mk

SEEDS = {
    "wheels_in_space": 40,
    "each_way": 40,
    "rises": 20,
    "rebounds": 30,
    "tracks": 24,
    "cables": 24,
    "cam_profiles": 24,
    "on_carriers": 12,
    "said_otherwise": 20,
    "misread": 80,
}


@pytest.mark.parametrize("family", FAMILIES)
def test_machines_are_as_their_reference_says(family: str) -> None:
    found = {seed: judge(family, seed) for seed in range(SEEDS[family])}
    assert {seed: one.fault for seed, one in found.items() if one.faults} == {}
    assert all(one.rows for one in found.values())
    assert any(one.worst > 0.0 for one in found.values()) or family == "misread"


@pytest.mark.parametrize("kind", misread.KINDS)
def test_what_is_misread_was_sound(kind: str) -> None:
    data, part, key = misread.sound(kind)
    assert key in part
    rows = mk.load(data).analyze()
    assert set(map(str, rows["row.status"])) <= {"ok", "beyond-limit"}


def test_what_is_no_refusal_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def raised(_: object) -> None:
        raise KeyError("law")

    monkeypatch.setattr(mk, "load", raised)
    assert "KeyError" in judge("misread", 0).fault
