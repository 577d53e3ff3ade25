"""What docs/scale.md is made by: its parts measure what they say."""

from __future__ import annotations

import pytest
from benchmark import scale
from benchmark.scale_parts import PARTS, fall_by_scipy, pendulums

import mechkin_cli as mk


@pytest.mark.parametrize("count", [1, 3, 6])
def test_chains_of_pendulums_fall_as_the_peer_says(count: int) -> None:
    """Two integrations that share no equation; angles of joints add up to those of bars."""
    names = [f"A{k}.theta" for k in range(count)]
    found = mk.loads(pendulums(count)).respond("fall", names, threads=1)
    bars = 0.0
    for name, angle in zip(names, fall_by_scipy(count), strict=True):
        bars += found[name][-1]
        assert bars == pytest.approx(angle, abs=1e-6)


@pytest.mark.parametrize("name", PARTS)
def test_every_part_measures_from_few_on(name: str) -> None:
    part, _ = PARTS[name]
    first = next(iter(part(100)))
    by, *columns = first
    assert first[by] >= 1
    assert all(first[column] > 0.0 or first[column] != first[column] for column in columns)


def test_all_parts_can_be_named() -> None:
    assert ("rows", *PARTS) == scale.PARTS


def test_slopes_are_those_on_log_paper() -> None:
    lines = [{"n": n, "straight": 3.0 * n, "cubic": n**3.0} for n in (1, 2, 8)]
    told = scale.slopes(lines, "n", ["straight", "cubic"])
    assert told == "Slopes of the last step (of all): straight 1.00 (1.00), cubic 3.00 (3.00)."
    assert "| n | straight, s | cubic, s |" in scale.part_page(lines)
