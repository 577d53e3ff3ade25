"""Drawings in which motions meet: flat parallel bars, Sarrus linkages folded or stretched.

Rows go on in the motion in which the inputs move, if it is the only one; if not, the motions are
told apart. Expectations are the motions' closed forms.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import mechkin_cli as mk

STRAIGHT = "assembly: {at_branch_points: straight}"


def bars(count: int, angles: list[float], *, spacing: float = 1.0, more: str = "") -> str:
    """A coupler on equal bars of length 1 with pins in a line, all drawn flat; the first is
    driven."""
    lines = ["format: 1", "plane: xy", "units: {length: m, angle: deg}", "joints:"]
    for k in range(count):
        x = spacing * k
        lines.append(f"  A{k}: {{type: R, links: [ground, l{k}], point: [{x}, 0]}}")
        lines.append(f"  B{k}: {{type: R, links: [l{k}, top], point: [{x + 1.0}, 0]}}")
    lines.append(f"links: {{top: {{}}, {', '.join(f'l{k}: {{}}' for k in range(count))}}}")
    lines.append(f"motion: {{inputs: {{A0.theta: {{values: {angles}}}}}}}")
    return "\n".join([*lines, more])


def sarrus(legs: int, height: float, motion: str, more: str = "") -> str:
    """A plate on legs of two links of length 1, a third or a quarter of a turn apart, drawn at a
    height."""
    out = math.sqrt(1.0 - height * height / 4.0)
    lines = ["format: 1", "units: {length: m, angle: deg}", "joints:"]
    for k in range(legs):
        angle = 2.0 * math.pi * k / (3 if legs == 3 else 4)
        c, s = math.cos(angle), math.sin(angle)
        for name, links, r, z in (
            ("A", f"[ground, u{k}]", 2.0, 0.0),
            ("B", f"[u{k}, v{k}]", 2.0 + out, height / 2.0),
            ("C", f"[v{k}, top]", 2.0, height),
        ):
            place = f"point: [{r * c}, {r * s}, {z}], axis: [{-s}, {c}, 0]"
            lines.append(f"  {name}{k}: {{type: R, links: {links}, {place}}}")
    lines.append(
        f"links: {{top: {{}}, {', '.join(f'u{k}: {{}}, v{k}: {{}}' for k in range(legs))}}}"
    )
    lines.append(f"points: {{c: {{link: top, at: [0, 0, {height}]}}}}")
    lines.append(f"motion: {{inputs: {{{motion}}}}}")
    return "\n".join([*lines, more])


def near(values: np.ndarray, expected: np.ndarray) -> bool:
    return bool(np.abs(np.asarray(values) - expected).max() < 1e-8)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_flat_bars_swing_parallel(count: int) -> None:
    angles = [20.0, 40.0, 60.0]
    names = [f"{pin}{k}.theta" for k in range(count) for pin in "AB"]
    analysis = mk.loads(bars(count, angles)).analyze(names)
    assert analysis["row.status"].tolist() == ["ok"] * 3
    for k in range(count):
        assert near(analysis[f"A{k}.theta"], np.array(angles))
        assert near(analysis[f"B{k}.theta"], -np.array(angles))
    assert "motions-meet" in {d.code for d in analysis.diagnostics}


@pytest.mark.parametrize("count", [2, 3])
def test_they_go_through_the_drawing_where_that_is_asked(count: int) -> None:
    angles = [-40.0, -20.0, 10.0, 20.0]
    analysis = mk.loads(bars(count, angles, more=STRAIGHT)).analyze(["A1.theta"])
    assert analysis["row.status"].tolist() == ["ok"] * 4
    assert near(analysis["A1.theta"], np.array(angles))


@pytest.mark.parametrize("angles", [[-20.0, 0.0, 20.0], [0.0, 20.0, 40.0]], ids=str)
def test_a_row_in_the_drawing_is_as_singular_as_it(angles: list[float]) -> None:
    """It has a position, and the others go on where the way is to go straight on."""
    straight = mk.loads(bars(3, angles, more=STRAIGHT)).analyze(["A1.theta"])
    drawn = angles.index(0.0)
    assert np.delete(straight["row.status"], drawn).tolist() == ["ok"] * 2
    assert straight["row.status"][drawn] == "rank-unclear"
    assert near(straight["A1.theta"], np.array(angles))
    plain = mk.loads(bars(3, angles)).analyze(["A1.theta"])
    assert plain["row.status"][drawn] == "rank-unclear"
    (said,) = (d for d in plain.diagnostics if d.code == "motions-meet")
    assert said.hint is not None
    assert "at_branch_points: straight" in said.hint


def test_a_flat_parallelogram_moves_in_two_ways() -> None:
    """As a parallelogram and crossed; of three bars only the first is left."""
    analysis = mk.loads(bars(2, [20.0, 40.0], spacing=2.0)).analyze()
    assert analysis["row.status"].tolist() == ["branch-lost"] * 2
    (said,) = (d for d in analysis.diagnostics if d.code == "several-motions")
    assert "2 motions" in said.message
    # crossed, bars of length 1 at the spacing d turn by tan(b/2) = -(d + 1)/(d - 1) tan(a/2)
    crossed = -2.0 * math.degrees(math.atan(3.0 * math.tan(math.radians(10.0))))
    assert said.measured is not None
    found = said.measured.split("A1.theta = ")[1].split(" deg")[0].split(" or ")
    assert sorted(map(float, found)) == pytest.approx([crossed, 20.0], rel=1e-5)
    three = mk.loads(bars(3, [20.0, 40.0], spacing=2.0)).analyze(["A1.theta"])
    assert near(three["A1.theta"], np.array([20.0, 40.0]))


@pytest.mark.parametrize("legs", [2, 3])
def test_a_folded_sarrus_linkage_rises(legs: int) -> None:
    """Folded, its legs may also turn about their pins; then the plate rests."""
    z = np.array([0.2, 0.4, 1.0])
    text = sarrus(legs, 0.0, f"c.position.z: {{values: {z.tolist()}}}")
    analysis = mk.loads(text).analyze([f"A{k}.theta" for k in range(legs)])
    assert analysis["row.status"].tolist() == ["ok"] * 3
    for k in range(legs):
        assert near(analysis[f"A{k}.theta"], -np.degrees(np.arcsin(z / 2.0)))


def test_mobility_judges_inputs_by_the_motion_that_they_drive() -> None:
    found = mk.loads(sarrus(2, 0.0, "c.position.z: {values: [0.0]}")).mobility()
    assert found.dimensions == (2, 1)
    assert [(f.dimension, f.inputs) for f in found.families] == [(2, ()), (1, ("c.position.z",))]
    assert not found.diagnostics


@pytest.mark.parametrize("legs", [2, 3])
def test_the_legs_of_a_stretched_sarrus_linkage_bend_either_way(legs: int) -> None:
    angles = [20.0, 40.0]
    motion = f"A0.theta: {{values: {angles}}}"
    (said,) = (
        d
        for d in mk.loads(sarrus(legs, 2.0, motion)).analyze().diagnostics
        if d.code == "several-motions"
    )
    assert f"{2 ** (legs - 1)} motions" in said.message
    assert said.measured is not None
    assert "A1.theta = -20 or 20 deg" in said.measured
    other = ", ".join(f"A{k}.theta: -20 deg" for k in range(1, legs))
    chosen = sarrus(legs, 2.0, motion, f"assembly: {{near: {{{other}}}}}")
    analysis = mk.loads(chosen).analyze(["A1.theta", "c.position.z"])
    assert near(analysis["A1.theta"], -np.array(angles))
    assert near(analysis["c.position.z"], 2.0 * np.cos(np.radians(angles)))
