"""Equations and derivatives over boxes hold the true ones, for every pair and every tree joint off
the closed position; thousands by a command, see tests/kernel/position_boxes.py."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from kernel.plans import TABLE, TREE_LETTERS
from kernel.position_boxes import combinations, outside, random_box

CASES = list(itertools.islice(combinations(), 48))


@pytest.mark.parametrize("number", range(len(CASES)))
def test_the_true_derivatives_are_inside(number: int) -> None:
    generator = np.random.default_rng([3, number])
    letter, trees = CASES[number]
    assert outside(random_box(letter, trees, generator), generator) == 0


def test_all_pairs_and_tree_joints_are_among_them() -> None:
    assert {letter for letter, _ in CASES} == set(TABLE)
    assert {tree for _, trees in CASES for tree in trees} == set(TREE_LETTERS)


def test_a_smaller_box_leaves_values_out() -> None:
    generator = np.random.default_rng(5)
    box = random_box("U", ("S", "C"), generator)
    enclosed = replace(box, radius=0.01 * box.radius).enclosed()
    box.enclosed = lambda: enclosed  # type: ignore[method-assign]
    assert outside(box, generator) > 0
