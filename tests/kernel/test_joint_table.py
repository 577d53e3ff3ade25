"""The constants of the joint table agree with the textbook forms of the pairs."""

from __future__ import annotations

import pytest
from kernel.pairs import PAIRS
from kernel.plans import TABLE

LETTERS = list(TABLE)


def test_every_type_of_the_table_has_its_textbook_form() -> None:
    assert set(PAIRS) == set(TABLE)


@pytest.mark.parametrize("letter", LETTERS)
def test_freedoms_and_closing_equations_make_six(letter: str) -> None:
    entry = TABLE[letter]
    assert entry["freedoms"] == len(PAIRS[letter].screws)
    assert entry["equations"] in (0, 6 - entry["freedoms"])


@pytest.mark.parametrize("letter", LETTERS)
def test_slides_are_the_freedoms_without_rotation(letter: str) -> None:
    slides = [not any(angular) for angular, _ in PAIRS[letter].screws]
    assert TABLE[letter]["slides"] == sum(slide << f for f, slide in enumerate(slides))


@pytest.mark.parametrize("letter", LETTERS)
def test_coordinates_are_what_the_freedoms_turn_and_slide(letter: str) -> None:
    """A pair with one axis has theta where it turns and s where it slides; S has no such axis."""
    screws = PAIRS[letter].screws
    one_axis = all(not any(part[:2]) for screw in screws for part in screw)
    assert TABLE[letter]["theta"] == (one_axis and any(any(angular) for angular, _ in screws))
    assert TABLE[letter]["s"] == (one_axis and any(any(linear) for _, linear in screws))


@pytest.mark.parametrize("letter", LETTERS)
def test_states_are_the_freedoms_or_a_quaternion_in_place_of_three(letter: str) -> None:
    entry = TABLE[letter]
    assert entry["states"] == entry["freedoms"] + PAIRS[letter].quaternion
