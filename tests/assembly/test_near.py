"""`assembly: near` on coordinates that count turns, at exact ties, and what a run leaves out."""

from __future__ import annotations

import numpy as np
import pytest
from references import FILE_OF
from scipy.optimize import brentq

import mechkin_cli as mk

SLIDER = """
format: 1
units: {{length: m, angle: deg}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: C, links: [crank, rod], point: [1, 0, 0], axis: [0, 0, 1]}}
  C: {{type: S, links: [rod, slider], point: [3, 1, 0]}}
  D: {{type: P, links: [ground, slider], point: [3, 1, 0], axis: [1, 0, 0]}}
motion: {{inputs: {{A.theta: {{at: 0}}}}}}
assembly: {{near: {{{near}}}}}
"""


def test_two_assemblies_at_the_same_distance_are_told_and_the_drawn_one_is_taken() -> None:
    """The rod from (1, 0) to the line y = 1: mirrored about the vertical through the crank's end,
    so the place between them is as far from both, and far."""
    middle = np.degrees(np.arctan2(1, 0) - np.arctan2(1, 2))
    result = mk.loads(SLIDER.format(near=f"B.theta: {float(middle)!r}")).analyze(["B.theta"])
    assert [d.code for d in result.diagnostics] == ["nearest-unclear", "nearest-far"]
    assert abs(result["B.theta"][0]) < 1e-9
    other = mk.loads(SLIDER.format(near="B.theta: 120")).analyze(["B.theta"])
    assert other["B.theta"][0] == pytest.approx(2 * middle, abs=1e-9)


RADIUS, REACH, LEAD = 0.1, 0.1, 0.02
PHASE = 0.7
OWN_AXIS = f"axis: [0, {REACH * np.sin(PHASE)}, {RADIUS - REACH * np.cos(PHASE)}]"
"""Of the universal joint in the rod: square to the rod, so that this points everywhere."""
SCREW = f"""
format: 1
units: {{length: m, angle: rad}}
links: {{spindle: {{}}, nut: {{}}, rod: {{}}}}
joints:
  A: {{type: R, links: [ground, spindle], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: H, links: [spindle, nut], point: [0, 0, 0], axis: [1, 0, 0], lead: {LEAD}}}
  C: {{type: S, links: [nut, rod], point: [0, {RADIUS}, 0]}}
  D:
    type: U
    links: [rod, ground]
    point: [0, {REACH * np.cos(PHASE)}, {REACH * np.sin(PHASE)}]
    {OWN_AXIS}
    axis2: [1, 0, 0]
motion: {{inputs: {{A.theta: {{at: 0}}}}}}
"""


def screw_angles() -> list[float]:
    """Turns of the nut that keep the rod's length: (lead turn / 2 pi)^2 = 2 r q (cos(turn - phase)
    - cos(phase)), bracketed on a fine grid."""

    def off(turn: float) -> float:
        slide = LEAD * turn / (2 * np.pi)
        return float(slide**2 - 2 * RADIUS * REACH * (np.cos(turn - PHASE) - np.cos(PHASE)))

    grid = np.linspace(-80.0, 80.0, 16_000)
    signs = np.sign([off(turn) for turn in grid])
    return [float(brentq(off, grid[i], grid[i + 1])) for i in np.flatnonzero(np.diff(signs))]


@pytest.mark.parametrize("turn", screw_angles())
def test_near_names_the_turns_of_a_thread(turn: float) -> None:
    """The nut meets the rod on many turns; the one that is named is taken. The universal joint has
    two places for each, as near."""
    text = SCREW + f"assembly: {{near: {{B.theta: {turn + 0.01!r}}}}}\n"
    result = mk.loads(text).analyze(["B.theta"])
    assert result["B.theta"][0] == pytest.approx(turn, abs=1e-9)
    assert [d.code for d in result.diagnostics] == ["nearest-unclear"]


@pytest.mark.parametrize("named", [-40.0, -15.0, 10.0, 30.0])
def test_a_turn_that_no_assembly_has_is_told(named: float) -> None:
    """The nearest of the closed form is taken where the search reaches it, and never silently."""
    result = mk.loads(SCREW + f"assembly: {{near: {{B.theta: {named!r}}}}}\n").analyze(["B.theta"])
    codes = [d.code for d in result.diagnostics]
    assert "nearest-far" in codes
    best = min(screw_angles(), key=lambda turn: abs(turn - named))
    if abs(best - named) < 3 * np.pi:
        assert result["B.theta"][0] == pytest.approx(best, abs=1e-9)


def test_a_turn_that_the_universal_joint_does_not_let_through_is_no_assembly() -> None:
    """With the joint's own axis along z, v of the rod keeps its z in the joint's frame and reaches
    no more than |v_xy| along x: the nut goes so far and no farther."""
    text = SCREW.replace(OWN_AXIS, "axis: [0, 0, 1]")
    reach = abs(RADIUS - REACH * np.cos(PHASE))
    kept = [turn for turn in screw_angles() if abs(LEAD * turn / (2 * np.pi)) <= reach]
    assert 0 < len(kept) < len(screw_angles())
    found = mk.loads(text + "assembly: {turns: 4}\n").modes()
    turns = sorted({round(mode.coordinates["B.theta"], 9) for mode in found.modes})
    assert turns == pytest.approx(sorted({round(turn, 9) for turn in kept}), abs=1e-8)


def test_what_a_run_left_out_is_not_read_from_another_assembly() -> None:
    """The second loop does not close on the branch of the first that the file names."""
    model = mk.load(FILE_OF["rcsr_csr_loop_one"])
    alone = model.analyze()
    with pytest.raises(mk.UsageError, match=r'ask for it in analyze\(\["O5.theta"\]\)'):
        alone["O5.theta"]
    both = model.analyze(["O5.theta"])
    assert np.isfinite(both["O5.theta"]).all()
    assert abs(both["O2.theta"][0] - alone["O2.theta"][0]) > 30
    inputs = {"O1.theta": float(both["O1.theta"][3])}
    assert model.solve(inputs, ["O5.theta"])["O5.theta"] == pytest.approx(both["O5.theta"][3])
    assert model.solve(inputs, ["O4.theta"])["O4.theta"] == pytest.approx(alone["O4.theta"][3])
