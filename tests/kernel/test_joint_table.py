"""The joint table and the kernel's entries agree with the textbook forms of the pairs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kernel.pairs import COSINE, ELEMENTARY, PAIRS, PITCH, SLOTTED, Matrix, derivative, mp, vector
from kernel.plans import PLANE_TABLE, TABLE, TREE_LETTERS

from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import pair_type as elementary
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.pair_type import FIRST, SECOND
from mechkin_cli.mechanism.pairs import (
    CLOSING_CONDITIONS,
    JOINT_TYPES,
    PLANE_JOINT_TYPES,
    dimension_of,
)
from mechkin_cli.mechanism.vectors import Frame

LETTERS = list(JOINT_TYPES)


def drawn(matrix: Matrix) -> Frame:
    """A textbook frame, rounded."""
    return Frame(*(tuple(float(c) for c in vector(matrix, column)) for column in range(4)))


def joint_of(letter: str) -> Joint:
    """The pair between the textbook's frames, its coordinates zero."""
    kind, pair = JOINT_TYPES[letter], PAIRS[letter]
    meeting = next(i for i, step in enumerate(kind.steps) if step.along is None)
    between = drawn(pair.chain[meeting][1])
    halves = Halves(drawn(mp.eye(4)), drawn(pair.home), (between, between), drawn(SLOTTED))
    ends = halves.on_first, halves.on_second
    return Joint("J", letter, "a", "b", *ends, parts_of(kind, halves), PITCH * 2 * np.pi)


def test_every_type_of_the_table_has_its_textbook_form() -> None:
    assert set(PAIRS) == set(LETTERS)


def test_the_code_of_an_entry_is_its_place_in_the_kernel() -> None:
    rows = _kernel.joint_table()
    assert [row["code"] for row in rows] == list(range(len(rows)))
    used = {row["letter"] for row in (*TABLE.values(), *PLANE_TABLE.values())}
    assert {row["letter"] for row in rows} == {"", *used}  # the first: the ends of a leg


@pytest.mark.parametrize("letter", LETTERS)
def test_parts_are_the_chain_of_elementary_displacements(letter: str) -> None:
    assert list(JOINT_TYPES[letter].parts) == [part for part, _ in PAIRS[letter].chain]


@pytest.mark.parametrize("letter", LETTERS)
def test_freedoms_and_closing_equations_make_six(letter: str) -> None:
    """H closes no loop: the count of its turns would be lost; F holds nothing."""
    kind = JOINT_TYPES[letter]
    assert kind.freedoms == PAIRS[letter].freedoms
    if letter in ("H", "F"):
        assert kind.equations == 0
        return
    assert kind.equations == TABLE[letter]["equations"] == 6 - PAIRS[letter].freedoms


@pytest.mark.parametrize("letter", list(PLANE_TABLE))
def test_freedoms_and_closing_equations_of_a_plane_make_three(letter: str) -> None:
    """Gruebler 1917: of R and P two, of a pin in a slot one, of a weld three."""
    kind, row = PLANE_JOINT_TYPES[letter], PLANE_TABLE[letter]
    assert kind.equations == row["equations"] == 3 - kind.freedoms
    assert kind.equations == {"R": 2, "P": 2, "Ps": 1, "W": 3}[letter]
    # what holds the turn is a moment, all else forces
    assert row["lengths"] == kind.equations - (letter in ("P", "W"))


@pytest.mark.parametrize("letter", list(TABLE))
def test_lengths_are_what_forces_hold(letter: str) -> None:
    """The directions in which the second link, turned at will, cannot slide."""
    kind = joint_of(letter)
    turns = [linear for angular, linear in kind.screws if any(angular)]
    slides = [linear for angular, linear in kind.screws if not any(angular)]
    assert len(turns) + len(slides) == PAIRS[letter].freedoms
    assert TABLE[letter]["lengths"] == 3 - np.linalg.matrix_rank(np.array([*slides, (0, 0, 0)]))


@pytest.mark.parametrize("letter", LETTERS)
def test_coordinates_have_the_textbook_names_and_freedoms(letter: str) -> None:
    """Turns about a sphere's centre and the slides of a sphere on a plane have no names."""
    found = JOINT_TYPES[letter].scalars
    assert found == {name: freedom for name, (freedom, _) in PAIRS[letter].coordinates.items()}


@pytest.mark.parametrize("letter", LETTERS)
def test_a_coordinate_measures_what_its_freedom_does(letter: str) -> None:
    slides = PAIRS[letter].slides
    for known in JOINT_TYPES[letter].named:
        assert known.is_angle == (not slides[known.freedom] and not known.on_thread)
        assert dimension_of(known.name) == known.dimension


@pytest.mark.parametrize("letter", LETTERS)
def test_the_point_rides_where_the_textbook_has_it(letter: str) -> None:
    assert (JOINT_TYPES[letter].point_on == FIRST) == PAIRS[letter].point_on_first


@pytest.mark.parametrize("letter", LETTERS)
def test_screws_as_drawn_are_the_rates_of_the_displacement(letter: str) -> None:
    pair, joint = PAIRS[letter], joint_of(letter)
    home = [
        c for part in pair.parts for c in ([1, 0, 0, 0] if part.quaternion else [0] * part.states)
    ]
    for freedom, (angular, linear) in enumerate(joint.screws):
        rates = [int(freedom == k) for k in range(pair.freedoms)]

        def at(time: Any, rates: list[int] = rates) -> Matrix:
            return pair.moving(home, rates, [0] * len(rates), time)

        twist = derivative(at, 1) * mp.inverse(at(mp.mpf(0)))
        expected = [twist[2, 1], twist[0, 2], twist[1, 0], *(twist[i, 3] for i in range(3))]
        assert [*angular, *linear] == pytest.approx([float(c) for c in expected], abs=1e-15)


def test_parameters_are_the_cosines_of_the_textbook_pairs() -> None:
    for letter in LETTERS:
        expected = COSINE if PAIRS[letter].parameter else 0.0
        assert joint_of(letter).parameter == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("letter", TREE_LETTERS)
def test_tree_displacements(letter: str) -> None:
    """Freedoms, states and which freedoms are lengths."""
    entry, part = _kernel.tree_table()[TREE_LETTERS.index(letter)], elementary.ELEMENTARY[letter]
    screws = ELEMENTARY[letter].screws
    slides = tuple(not any(angular) for angular, _ in screws)
    assert entry["code"] == part.code == TREE_LETTERS.index(letter)
    assert entry["freedoms"] == len(part.freedoms) == len(screws)
    assert entry["states"] == part.states == ELEMENTARY[letter].states
    assert entry["slides"] == sum(slide << f for f, slide in enumerate(slides))
    assert part.slides == slides


def test_there_are_no_other_tree_displacements_but_of_legs_and_carriages() -> None:
    """Those along curves and over surfaces are tested by the pairs that have them: tests/curves."""
    assert len(_kernel.tree_table()) == len(TREE_LETTERS) + 3 == len(ELEMENTARY) + 3
    # a turn that is counted is a thread to the kernel
    own = [
        one for one in elementary.ELEMENTARY.values() if not any(f.counted for f in one.freedoms)
    ]
    assert len(own) == len(_kernel.tree_table())
    leg, curve, surface = _kernel.tree_table()[-3:]
    assert leg["freedoms"] == leg["states"] == 0
    assert [(one["freedoms"], one["states"]) for one in (curve, surface)] == [(1, 1), (2, 2)]


PAIR = re.compile(
    r"Pair<Conditions<((?:[^<>]|<[^<>]*>)*)>,\s*Coordinates.*?letter\[\] = \"(\w*)\"", re.DOTALL
)
"""An entry of the kernel's list: its conditions and its letter."""
EQUATIONS = {"parallel": 2, "orientation": 3}
SPELLED = {
    "CommonPoint": [("lengths", axis, FIRST) for axis in "xyz"],
    "ParallelAxes": [("parallel", "", FIRST)] * 2,
    "SameOrientation": [("orientation", "", FIRST)] * 3,
    **{f"InPlane<A{axis.upper()}>": [("lengths", axis, FIRST)] for axis in "xyz"},
    **{f"InPlane<B{axis.upper()}>": [("lengths", axis, SECOND)] for axis in "xyz"},
}


def test_conditions_are_those_of_the_kernel_in_their_order() -> None:
    """What `session.redundancy` knows of an equation is said of the right one."""
    source = Path(__file__).parents[2] / "mechkin_cli/kernel/core/joints/pairs.hpp"
    text = source.read_text("utf-8")
    kernel = {}
    for conditions, letter in PAIR.findall(text):
        names = re.findall(r"\w+(?:<\w+>)?", conditions)
        spelled = [SPELLED.get(name, [(name, "", FIRST)]) for name in names]
        kernel[letter] = [one for equations in spelled for one in equations]
    assert set(CLOSING_CONDITIONS) < set(kernel)
    for letter, conditions in CLOSING_CONDITIONS.items():
        told = [
            ("KeptAngle<Parameter>", "", FIRST)
            if condition.kind == "angle"
            else (condition.kind, axis, condition.side)
            for condition in conditions
            for axis in condition.axes or [""] * EQUATIONS.get(condition.kind, 1)
        ]
        assert told == kernel[letter], letter
