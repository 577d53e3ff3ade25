"""Loops with more closing equations than unknowns are solved where their dimensions let them."""

import numpy as np
import pytest
from building.sound import SOUND

import mechkin_cli as mk
from mechkin_cli.verdict import Status

FOUR_BAR = """\
format: 1
units: {length: mm, force: N}
links: {crank: {}, coupler: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [0, 30, 0], axis: [0, 0, 1]}
  C: {type: R, links: [coupler, rocker], point: [80, 60, HEIGHT], axis: [0, 0, 1]}
  D: {type: R, links: [rocker, ground], point: POINT, axis: AXIS}
motion: {inputs: INPUTS}
"""
SWEPT = "{A.theta: {from: 0, to: 90, step: 15}}"


def four_bar(
    inputs: str = SWEPT, axis: str = "[0, 0, 1]", height: str = "0", point: str = "[80, 0, 0]"
) -> mk.Model:
    text = FOUR_BAR.replace("INPUTS", inputs).replace("AXIS", axis)
    return mk.loads(text.replace("HEIGHT", height).replace("POINT", point), "bar.yaml")


@pytest.mark.parametrize("height", ["0", "5"])
def test_a_planar_loop_closes_wherever_its_pins_are_drawn(height: str) -> None:
    """Along its axis a pin may stand at any height."""
    analysis = four_bar(height=height).analyze(["B.theta", "D.theta"], tables=[])
    assert np.all(analysis.result.status == Status.ok)
    crank, rocker = np.radians(90 + analysis["A.theta"]), np.radians(90 - analysis["D.theta"])
    b = 30 * np.cos(crank), 30 * np.sin(crank)
    c = 80 + 60 * np.cos(rocker), 60 * np.sin(rocker)
    coupler = np.hypot(c[0] - b[0], c[1] - b[1])
    np.testing.assert_allclose(coupler, np.hypot(80, 30), rtol=1e-13)


def test_a_loop_with_a_tilted_axis_does_not_move() -> None:
    """It is assembled as drawn, at the first row, and at no other."""
    analysis = four_bar(axis="[0, 0.001, 1]").analyze(["B.theta"], tables=[])
    status = analysis.result.status
    assert status[0] == Status.ok
    assert not np.any(status[1:] == Status.ok)


def test_a_loop_that_closes_nowhere_says_how_near_it_comes() -> None:
    """Turns about parallel axes never bring back a millimetre along them."""
    apart = "{rocker: [80, 0, 0], ground: [80, 0, 1]}"
    analysis = four_bar(point=apart).analyze(["B.theta"], tables=[])
    assert np.all(analysis.result.status == Status.not_assembled)
    (error,) = [d for d in analysis.diagnostics if d.severity == "error"]
    assert error.code == "not-assembled"
    assert "write expressions" in str(error)


def test_driving_more_than_the_freedom_leaves_no_row_but_the_drawn_one() -> None:
    driven = "{O.theta: {values: [0, 30]}, D.theta: {at: 0}}"
    text = SOUND.replace("{O.theta: {from: -70, to: 70, step: 5}}", driven)
    status = mk.loads(text).analyze(["D.s"], tables=[]).result.status
    assert status[0] == Status.ok
    assert status[1] != Status.ok


def test_a_loop_that_is_driven_in_every_other_joint_has_nothing_to_close_it() -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        _ = four_bar("{A.theta: {at: 0}, B.theta: {at: 0}, C.theta: {at: 0}}").graph
    (error,) = caught.value.diagnostics
    assert error.code == "driven-solid"
    assert str(error).startswith("bar.yaml:9:18: error: ")
    assert "A, B, C, D" in error.message
    assert "drive fewer coordinates" in str(error)
