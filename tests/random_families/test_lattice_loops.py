"""The mobility of loops on a lattice."""

from __future__ import annotations

from random_families.lattice_loops import judge


def test_twenty_loops_by_moves_that_close_again() -> None:
    assert not {seed: fault for seed in range(20) if (fault := judge(seed))}
