"""Random loops that rub; `MECHKIN_RANDOM` multiplies their number."""

from __future__ import annotations

import os

import pytest
from oracle.dynamics.rubbing import Rubbed, Undecided
from random_families.rubbing_loops import judge, rubbing_loop

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
COUNT = 8 * TIMES
LONG = ([6], [1096, 1207]) if TIMES > 1 else ([], [])
"""Seeds whose motion takes a quarter of a minute to a minute."""


@pytest.mark.parametrize("seed", [4, 403, *LONG[0]])
def test_a_random_loop_against_dense_equations_from_event_to_event(seed: int) -> None:
    """In 403 a guide with one coefficient breaks away within a moving loop."""
    text = rubbing_loop(seed)
    assert text is not None
    found = judge(text)
    assert not found.fault
    assert found.error < 1e-10


@pytest.mark.parametrize("seed", [15, 107, 136, 141, 244, 375, 1156, *range(1000, 1000 + COUNT)])
def test_no_motion_with_friction_creeps_or_is_lost(seed: int) -> None:
    text = rubbing_loop(seed)
    if text is not None:
        assert not judge(text, motion_alone=True).fault


@pytest.mark.parametrize("seed", [5051, *LONG[1]])
def test_joints_at_rest_beside_friction_that_feeds_itself(seed: int) -> None:
    """Against dense equations: ways out of rest that are ruled out, or that a better one leaves
    behind, leave the motion decided, and so does a force that is just held no longer."""
    text = rubbing_loop(seed)
    assert text is not None
    found = judge(text)
    assert found.word == "ok"
    assert found.error < 1e-9


@pytest.mark.parametrize("seed", [1384, 5452])
def test_what_comes_to_rest_and_goes_on_at_one_place(seed: int) -> None:
    """Joints that rest with forces that are not unique go at once, and three come to a dead centre
    of their own together: their slips there are the rounding of the rates."""
    text = rubbing_loop(seed)
    assert text is not None
    assert judge(text, motion_alone=True).word == "ok"


@pytest.mark.parametrize("seed", [1150, 1290, 1328, 1393, 1486, 1573, 1637, 1682, 5057, 5168, 5229])
def test_joints_that_rest_together_are_decided(seed: int) -> None:
    """Rounding of where each begins to go is no room between them."""
    text = rubbing_loop(seed)
    assert text is not None
    assert judge(text, motion_alone=True).word == "ok"


def test_joints_with_two_ways_to_start_are_named() -> None:
    text = rubbing_loop(5533)
    assert text is not None
    (error,) = [d for d in mk.loads(text).respond("run").diagnostics if d.severity == "error"]
    assert error.code == "friction-undecided"
    assert "friction of J5, J3, J2 has" in error.message


def test_a_ball_whose_friction_feeds_itself_jams() -> None:
    """Its normal load grows without bound, by the dense equations, too."""
    text = rubbing_loop(401)
    assert text is not None
    with pytest.raises((Undecided, ArithmeticError)):
        Rubbed(text, "run").run()
    found = mk.loads(text).respond("run")
    (error,) = [d for d in found.diagnostics if d.severity == "error"]
    assert error.code == "friction-undecided"
    assert "friction of J3 feeds itself" in error.message
