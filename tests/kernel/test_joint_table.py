"""The constants of the kernel's tables agree with the textbook forms of the pairs."""

from __future__ import annotations

import pytest
from kernel.pairs import ELEMENTARY, PAIRS
from kernel.plans import TABLE, TREE_LETTERS

from mechkin_cli.kernel import _kernel

LETTERS = list(TABLE)


def test_every_type_of_the_table_has_its_textbook_form() -> None:
    assert set(PAIRS) == set(TABLE)


def test_the_code_of_a_type_is_its_place_in_the_table() -> None:
    assert [entry["code"] for entry in TABLE.values()] == list(range(len(TABLE)))


@pytest.mark.parametrize("letter", LETTERS)
def test_parts_are_the_chain_of_elementary_displacements(letter: str) -> None:
    assert TABLE[letter]["parts"] == "".join(part for part, _ in PAIRS[letter].chain)


@pytest.mark.parametrize("letter", LETTERS)
def test_freedoms_and_closing_equations_make_six(letter: str) -> None:
    """H closes no loop: the count of its turns would be lost."""
    expected = 0 if letter == "H" else 6 - PAIRS[letter].freedoms
    assert TABLE[letter]["equations"] == expected


@pytest.mark.parametrize("letter", LETTERS)
def test_coordinates_are_named_in_the_order_of_the_freedoms(letter: str) -> None:
    """Turns about a sphere's centre and the slides of a sphere on a plane have no names."""
    names = TABLE[letter]["coordinates"].split()
    expected = ["-"] * PAIRS[letter].freedoms
    for name, (freedom, _) in PAIRS[letter].coordinates.items():
        expected[freedom] = name
    assert names == expected


@pytest.mark.parametrize("letter", TREE_LETTERS)
def test_tree_displacements(letter: str) -> None:
    """Freedoms, states and which freedoms are lengths."""
    entry = _kernel.tree_table()[TREE_LETTERS.index(letter)]
    screws = ELEMENTARY[letter].screws
    slides = sum((not any(angular)) << f for f, (angular, _) in enumerate(screws))
    assert entry["code"] == TREE_LETTERS.index(letter)
    assert entry["freedoms"] == len(screws)
    assert entry["states"] == ELEMENTARY[letter].states
    assert entry["slides"] == slides


def test_there_are_no_other_tree_displacements_but_the_hanging_of_legs() -> None:
    assert len(_kernel.tree_table()) == len(TREE_LETTERS) + 1 == len(ELEMENTARY) + 1
    assert _kernel.tree_table()[-1]["freedoms"] == _kernel.tree_table()[-1]["states"] == 0
