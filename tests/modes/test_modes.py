"""All assembly modes: against closed forms, random loops in many drawings, and their names."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from mobility.overconstrained import Z, bricard, general, ring, sarrus
from modes.quartic import circle, cylinder_angles, mp, plane_angles, vector
from modes.random_loops import (
    WORST_CONDITION,
    home_marks,
    random_loop,
    rotation,
    same,
    search,
)
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.templates import template_text


def text(*joints: str) -> str:
    """A loop ground, L1, L2, L3 with the first joint driven at 0."""
    head = "format: 1\nlinks: {L1: {}, L2: {}, L3: {}}\njoints:\n"
    if len(joints) == 3:
        head = head.replace(", L3: {}", "")
    return head + "\n".join(f"  {j}" for j in joints) + "\nmotion: {inputs: {A.theta: {at: 0}}}\n"


def digits(values) -> str:
    return "[" + ", ".join(mp.nstr(x, 17) for x in values) + "]"


def rcsr(seed: int) -> tuple[str, list]:
    """A random RCSR loop and its angles at D, degrees, by the quartic."""
    rng = random.Random(seed)
    a, b, ball, other, d = (vector(rng) for _ in range(5))
    axes = [vector(rng) for _ in range(3)]
    file = text(
        f"A: {{type: R, links: [ground, L1], point: {digits(a)}, axis: {digits(axes[0])}}}",
        f"B: {{type: C, links: [L1, L2], point: {digits(b)}, axis: {digits(axes[1])}}}",
        f"C: {{type: S, links: [L2, L3], point: {{L2: {digits(ball)}, L3: {digits(other)}}}}}",
        f"D: {{type: R, links: [ground, L3], point: {digits(d)}, axis: {digits(axes[2])}}}",
    )
    return file, cylinder_angles(b, axes[1], ball, circle(d, axes[2], other))


def test_rcsr_has_the_real_roots_of_its_quartic() -> None:
    counts = set()
    for seed in range(30):
        file, expected = rcsr(seed)
        found = mk.loads(file).modes()
        theta = sorted(mode.coordinates["D.theta"] for mode in found.modes)
        assert len(theta) == len(expected), seed
        assert found.complete
        assert found.bound == 4
        for value, exact in zip(theta, expected, strict=True):
            assert value == pytest.approx(float(mp.degrees(exact)), abs=1e-9)
        counts.add(len(expected))
    assert counts == {0, 2, 4}


def test_a_sphere_on_a_plane_has_the_two_roots_of_a_quadratic() -> None:
    counts = set()
    for seed in range(20):
        rng = random.Random(seed)
        a, ball, contact, d = (vector(rng) for _ in range(4))
        axes = [vector(rng) for _ in range(3)]
        file = text(
            f"A: {{type: R, links: [ground, L1], point: {digits(a)}, axis: {digits(axes[0])}}}",
            "B: {type: Sp, links: [L2, L1], "
            f"point: {{L1: {digits(contact)}, L2: {digits(ball)}}}, normal: {digits(axes[1])}}}",
            f"D: {{type: R, links: [ground, L2], point: {digits(d)}, axis: {digits(axes[2])}}}",
        )
        expected = plane_angles(contact, axes[1], circle(d, axes[2], ball))
        found = mk.loads(file).modes()
        theta = sorted(mode.coordinates["D.theta"] for mode in found.modes)
        assert theta == pytest.approx([float(mp.degrees(x)) for x in expected], abs=1e-9)
        assert found.complete
        counts.add(len(theta))
    assert counts == {0, 2}


def test_the_known_pose_of_random_loops_is_found_in_every_drawing() -> None:
    """The pose a loop was built in is among its modes, and the modes are the same bodies' poses
    when links are drawn elsewhere (other zeros), joints listed or loops closed elsewhere."""
    rng, done = random.Random(4), 0
    while done < 200:
        loop = random_loop(rng)
        found, marks = search(loop.text())
        away = same(home_marks(loop)[None], marks)[0]
        if away.min(initial=np.inf) < 1e-6 and found.condition[away.argmin()] > WORST_CONDITION:
            continue
        done += 1
        assert away.min() < 1e-10, loop.letters
        assert found.residual.max() <= 1e-13
        assert (same(marks, marks) + 9 * np.eye(found.number)).min() > 1e-6
        count = len(loop.letters)
        if done % 3 == 0:
            turns = [np.eye(3), np.eye(3), *(rotation(rng) for _ in range(count - 2))]
            shifts = np.array([[0.0] * 3] * 2 + [[rng.uniform(-2, 2)] * 3 for _ in turns[2:]])
            others, elsewhere = search(loop.text(turns, shifts))
        elif done % 3 == 1:
            others, elsewhere = search(loop.text(order=count // 2))
        else:
            others, elsewhere = search(loop.text(), [f"J{rng.randrange(1, count)}"])
        assert others.number == found.number, loop.letters
        apart = same(marks, elsewhere)
        assert apart.min(axis=0).max() < 1e-8
        assert apart.min(axis=1).max() < 1e-8


def test_letters_follow_branches_and_not_the_order_elsewhere() -> None:
    model = mk.load(RCSR)
    by_name = {letter: model.analyze([], mode=letter) for letter in "AB"}
    for row, theta in ((0, 150), (10, 170), (26, 202)):
        found = model.modes(at=theta)
        assert found.inputs == {"O1.theta": theta}
        assert found.picked == "B"
        assert [mode.name for mode in found.modes] == ["A", "B"]
        for mode in found.modes:
            sweep = by_name[mode.name]["O4.theta"][row]
            assert (mode.coordinates["O4.theta"] - sweep) % 360 == pytest.approx(0, abs=1e-9) or (
                mode.coordinates["O4.theta"] - sweep
            ) % 360 == pytest.approx(360, abs=1e-9)


def test_places_tell_modes_apart_where_coordinates_do_not() -> None:
    """The Delta robot's rods hang in balls, which have no coordinate: sixteen lines were alike."""
    model = mk.loads(template_text("delta"))
    found = model.modes()
    told = [tuple(round(value, 3) for value in mode.places.values()) for mode in found.modes]
    assert len(set(told)) == len(found.modes) == 16
    for mode in found.modes[::5]:
        first = model.analyze(tables=[], mode=mode.name)
        for name, value in mode.places.items():
            assert first[name][0] == pytest.approx(value, abs=1e-9)
    assert all(next(iter(mode.places)) in str(found) for mode in found.modes)
    assert all(mode.places == {} for mode in mk.load(RCSR).modes().modes)


def test_modes_that_no_branch_reaches_have_no_letter() -> None:
    """Of more modes than at the first row the surplus has no letter; a branch that ended lends its
    own to none."""
    seen = 0
    for seed in range(12):
        model = mk.loads(rcsr(seed)[0])
        letters = [mode.name for mode in model.modes().modes]
        for angle in (60, 120, 180) if letters else ():
            found = model.modes(at=angle)
            names = [mode.name for mode in found.modes if mode.name != "-"]
            ended = [n for n in found.diagnostics if n.code == "branch-ends"]
            assert sorted(names) == sorted(set(names) & set(letters))
            assert found.modes == () or len(names) + len(ended) == len(letters)
            seen += len(found.modes) > len(letters)
            seen += bool(ended and found.modes)
    assert seen > 2


def test_modes_beside_an_assembled_drawing_carry_its_letter() -> None:
    found = mk.load(RCSR.with_name("sevenr.yaml")).modes()
    assert found.picked in [mode.name for mode in found.modes]
    (home,) = [mode for mode in found.modes if mode.name == found.picked]
    assert max(abs(value) for value in home.coordinates.values()) < 1e-9


def test_an_unnamed_input_or_a_wrong_value_is_refused() -> None:
    model = mk.load(RCSR)
    with pytest.raises(mk.UsageError, match=r"O2.theta is no input; inputs are O1.theta"):
        model.modes(at={"O2.theta": 10})
    with pytest.raises(mk.UsageError, match="expected an angle"):
        model.modes(at="10 in")
    radians = model.modes(at="3 rad").modes[0].coordinates
    degrees = model.modes(at=float(np.degrees(3.0))).modes[0].coordinates
    assert radians == pytest.approx(degrees, abs=1e-9)


@pytest.mark.parametrize("drawn", [bricard(), sarrus()], ids=["Bricard", "Sarrus"])
def test_overconstrained_loops_list_their_drawing_once(drawn: str) -> None:
    found = mk.loads(f"{drawn}motion: {{inputs: {{J1.theta: {{at: 20}}}}}}\n").modes()
    coordinates = np.array([list(mode.coordinates.values()) for mode in found.modes])
    assert found.picked is not None
    assert (coordinates[:, 0] == 20).all()
    assert max(mode.residual for mode in found.modes) < 1e-13
    apart = np.abs(coordinates[:, None] - coordinates[None]).max(axis=2)
    assert (apart + 360 * np.eye(len(coordinates))).min() > 1e-6


def test_more_turns_of_a_thread_are_more_modes() -> None:
    drawn = general("RPRRHC", lead=0.3) + "motion: {inputs: {J1.theta: {at: 0}}}\n"
    few = mk.loads(drawn + "assembly: {turns: 0}\n").modes()
    more = mk.loads(drawn + "assembly: {turns: 1}\n").modes()
    assert max(abs(mode.coordinates["J5.theta"]) for mode in few.modes) <= 180
    assert max(abs(mode.coordinates["J5.theta"]) for mode in more.modes) <= 540
    assert 1 <= len(few.modes) < len(more.modes)
    assert "counts its turns within 1.5 of them" in more.sentence


def test_rows_of_an_assembled_drawing_carry_the_letter_of_their_mode() -> None:
    """Where a short search proves that it knows all modes `rows.csv` has it at once; else
    `row.mode` has it when it is asked for."""
    for name, short in (("rssr", True), ("rccc", True), ("stewart", False)):
        model = mk.load(FILE_OF[name])
        picked = model.modes().picked
        assert picked is not None
        result = mk.load(FILE_OF[name]).analyze(["row.mode"])
        assert set(result["row.mode"]) == {picked}
        fresh = mk.load(FILE_OF[name]).analyze([])
        assert "home" in fresh.result.how
        assert fresh.result.mode == (picked if short else "home")
        assert model.analyze([], mode=picked).result.how == "by name"


def test_a_triangle_that_cannot_close() -> None:
    drawn = ring("RRR", [(0, 0, 0), (1, 0, 0), (3, 0, 0)], [Z] * 3)
    drawn += "motion: {inputs: {J1.theta: {at: 40}}}\n"
    found = mk.loads(drawn).modes()
    assert found.modes == ()
    assert "no mode found" in found.sentence


def test_a_weld_alone_is_one_mode() -> None:
    """Welds have neither points nor coordinates."""
    text = "format: 1\nlinks: {one: {}}\njoints: {A: {type: W, links: [ground, one]}}\n"
    (mode,) = mk.loads(text).modes().modes
    assert (mode.name, mode.coordinates) == ("A", {})


@pytest.mark.parametrize("at", ["A", "B", "C", "D"])
@pytest.mark.parametrize("seed", range(4))
def test_a_plane_four_bar_with_one_cylinder_has_two_modes_and_no_more(at: str, seed: int) -> None:
    """R-R-C-R and its like, pins at any heights: the slide stands still, and the rocker has the two
    directions of a triangle's side."""
    rng = np.random.default_rng(seed)
    crank, rocker, ground = 1.0, rng.uniform(2.0, 3.0), rng.uniform(2.5, 3.5)
    drawn, lifted = rng.uniform(1.0, 2.0, 2)
    pins = {
        "A": (0.0, 0.0),
        "B": (crank * math.cos(drawn), crank * math.sin(drawn)),
        "C": (ground + rocker * math.cos(lifted), rocker * math.sin(lifted)),
        "D": (ground, 0.0),
    }
    links = {"A": "ground, crank", "B": "crank, rod", "C": "rod, rocker", "D": "ground, rocker"}
    joints = "".join(
        f"  {name}: {{type: {'C' if name == at else 'R'}, links: [{links[name]}], "
        f"point: [{float(x)!r}, {float(y)!r}, {rng.uniform(-1, 1)!r}], axis: [0, 0, 1]}}\n"
        for name, (x, y) in pins.items()
    )
    held = ", A.s: {at: 0}" if at == "A" else ""
    found = mk.loads(
        "format: 1\nname: four-bar\nunits: {angle: rad}\n"
        f"links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}\njoints:\n{joints}"
        f"motion: {{inputs: {{A.theta: {{at: 0.3}}{held}}}}}\n"
    ).modes()
    (bx, by), (cx, cy) = pins["B"], pins["C"]
    rod = math.hypot(cx - bx, cy - by)
    x, y = crank * math.cos(drawn + 0.3) - ground, crank * math.sin(drawn + 0.3)
    side = math.hypot(x, y)
    half = math.acos((side**2 + rocker**2 - rod**2) / (2 * side * rocker))
    want = sorted(math.remainder(math.atan2(y, x) + s * half - lifted, math.tau) for s in (-1, 1))
    assert found.complete
    assert found.bound == 2
    have = sorted(mode.coordinates["D.theta"] for mode in found.modes)
    assert np.abs(np.array(have) - want).max() < 1e-9


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1.0, 1e6])
def test_a_slide_tells_modes_apart_at_any_size(size: float) -> None:
    """Crank r = 1, rod l = 3 sizes with a ball at either end: the slide is at
    cos(t) r +- sqrt(l^2 - r^2 sin(t)^2)."""
    angle = math.radians(40)
    far = f"point: [{4 * size!r}, 0, 0]"
    file = f"""\
format: 1
units: {{length: m, angle: rad}}
links: {{k: {{}}, l: {{}}, m: {{}}}}
joints:
  A: {{type: R, links: [ground, k], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [k, l], point: [{size!r}, 0, 0]}}
  C: {{type: S, links: [l, m], {far}}}
  S: {{type: P, links: [ground, m], {far}, axis: [1, 0, 0]}}
motion: {{inputs: {{A.theta: {{values: [{angle!r}]}}}}}}
"""
    modes = mk.loads(file).modes().modes
    assert [mode.places for mode in modes] == [{}, {}]
    found = sorted(mode.coordinates["S.s"] / size + 4 for mode in modes)
    root = math.sqrt(9 - math.sin(angle) ** 2)
    assert found == pytest.approx([math.cos(angle) - root, math.cos(angle) + root], rel=1e-9)


def test_inputs_that_are_tied_by_a_negative_factor_begin_at_zero() -> None:
    """-3/14 of nothing, not -0."""
    inputs = mk.load(FILE_OF["planetary_gear"]).modes().inputs
    assert [str(value) for value in inputs.values()] == ["0.0", "0.0"]
