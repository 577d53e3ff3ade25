"""Windows: their edges, their turns, and motions along which the loads balance, against closed
forms."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest
from statics.roots import roots

import mechkin_cli as mk

G = 9.81


def arm(*loads: dict[str, Any]) -> dict[str, Any]:
    return {
        "format": 1,
        "units": {"angle": "rad"},
        "links": {"a": {"mass": 2, "center_of_mass": [0, -0.25, 0]}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0, 0], "axis": [0, 0, 1]}
        },
        "loads": list(loads),
    }


WEIGHT = {"type": "gravity", "g": [0, -G, 0]}


def told(r: Any) -> list[str]:
    return [note.code for note in r.diagnostics]


def test_turns_at_which_loads_are_the_same_are_one_row_and_a_note_says_so() -> None:
    m = mk.load(arm(WEIGHT))
    wide = m.equilibrium(window={"A.theta": (-0.5, 20)})
    assert wide["A.theta"] == pytest.approx([0, pi], abs=1e-9)
    assert "window-turns" in told(wide)
    one = m.equilibrium(window={"A.theta": (-pi, pi)})
    assert one["A.theta"] == pytest.approx([-pi, 0], abs=1e-9)
    assert "window-turns" not in told(one)


def test_turns_at_which_slopes_differ_are_rows_of_their_own() -> None:
    """theta sin(theta) is zero at each half turn, and steeper at each further one."""
    torque = {"type": "torque", "joint": "A", "value": "-1 N*m/rad*A.theta*sin(A.theta)"}
    r = mk.load(arm(torque)).equilibrium(window={"A.theta": (1, 20)})
    halves = pi * np.arange(1, 7)
    assert r["A.theta"] == pytest.approx(halves, abs=1e-9)
    assert r["row.least_stiffness"] == pytest.approx(halves * np.cos(halves), rel=1e-8)


def test_many_turns_of_a_spring() -> None:
    spring = {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": 0.02}
    r = mk.load(arm(WEIGHT, spring)).equilibrium(window={"A.theta": (-300, 300)})
    wanted = roots(lambda t: 2 * G * 0.25 * sin(t) + 0.02 * t, -300, 300)
    assert r["A.theta"] == pytest.approx(wanted, abs=1e-8)


def test_more_turns_than_are_looked_through_are_refused() -> None:
    with pytest.raises(mk.InvalidFile, match="too wide"):
        mk.load(arm(WEIGHT)).equilibrium(window={"A.theta": (0, 1000)})


def test_an_angle_is_turned_into_the_window_beside_one_whose_spring_counts_turns() -> None:
    """The lower link hangs or stands; the upper one carries both weights and winds a spring."""
    k = 1.0
    chain = {
        "format": 1,
        "plane": "xy",
        "units": {"angle": "rad"},
        "links": {
            "a": {"mass": 2, "center_of_mass": [0, -0.25]},
            "b": {"mass": 1, "center_of_mass": [0, -0.7]},
        },
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "R", "links": ["a", "b"], "point": [0, -0.5]},
        },
        "loads": [
            {"type": "gravity", "g": [0, -G]},
            {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": k},
        ],
    }
    window = {"A.theta": (-7.0, 7.0), "B.theta": (-3.0, -3.0 + 2 * pi)}
    r = mk.load(chain).equilibrium(window=window)
    upper = roots(lambda t: (2 * 0.25 + 0.5) * G * sin(t) + k * t, -7.0, 7.0)
    wanted = sorted((t, (turned - t + 3.0) % (2 * pi) - 3.0) for t in upper for turned in (0.0, pi))
    found = sorted(zip(r["A.theta"], r["B.theta"], strict=True))
    assert np.array(found) == pytest.approx(np.array(wanted), abs=1e-8)


ROD = hypot(100, 50)
SLIDER = """
format: 1
plane: xy
units: {length: mm, force: N}
links:
  crank: {mass: 1, center_of_mass: [0, 25]}
  rod: {}
  slider: {}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, 50]}
  C: {type: R, links: [rod, slider], point: [100, 0]}
  S: {type: P, links: [ground, slider], point: [100, 0], axis: [1, 0]}
loads:
  - {type: gravity, g: [-9810, 0]}
"""


@pytest.mark.parametrize("about", ["least", "largest", "stroke"])
def test_dead_centres_in_the_middle_and_at_the_ends_of_a_window(about: str) -> None:
    """The weight pulls along the guide: it rests where the slider turns back."""
    least, most = ROD - 50 - 100, ROD + 50 - 100
    low, high = {
        "least": (least - 20, least + 20),
        "largest": (most - 20, most + 20),
        "stroke": (least, most),
    }[about]
    wanted = [place for place in (least, most) if low <= place <= high]
    r = mk.loads(SLIDER).equilibrium(window={"S.s": (low, high)})
    assert r["S.s"] == pytest.approx(wanted, abs=1e-9)
    assert "window-branch" not in told(r)


BARS = 0.5, 1.2, 0.6, 1.0  # crank, coupler, rocker, ground


def four_bar() -> dict[str, Any]:
    """A four-bar without loads whose crank does not turn fully, drawn with its crank upward."""
    crank, coupler, rocker, ground = BARS
    apart = hypot(ground, crank)
    along = (apart**2 + coupler**2 - rocker**2) / (2 * apart)
    turn = atan2(-crank, ground) + acos(along / coupler)
    knee = [coupler * np.cos(turn), crank + coupler * sin(turn)]
    return {
        "format": 1,
        "plane": "xy",
        "units": {"angle": "rad"},
        "links": {"one": {}, "two": {}, "three": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "one"], "point": [0, 0]},
            "B": {"type": "R", "links": ["one", "two"], "point": [0, crank]},
            "C": {"type": "R", "links": ["two", "three"], "point": [float(x) for x in knee]},
            "D": {"type": "R", "links": ["three", "ground"], "point": [ground, 0]},
        },
    }


def spans(r: Any) -> list[tuple[float, float]]:
    (note,) = (note for note in r.diagnostics if note.code == "indifferent")
    parts = note.message.split("from A.theta = ")[1:]
    pairs = [part.split(" rad to A.theta = ") for part in parts]
    return [(float(low), float(high.split(" ")[0])) for low, high in pairs]


@pytest.mark.parametrize(
    ("low", "high", "motions"),
    [
        (-9.0, 8.0, 1),  # all that it has, more than once
        (-0.3, 0.2, 2),  # both assemblies, which meet at dead centres outside
        (-4.0, 1.0, 2),  # about both dead centres, and nothing between them
        (-2.0, 7.0, 1),
    ],
)
def test_a_mechanism_without_loads_balances_as_far_as_it_moves(
    low: float, high: float, motions: int
) -> None:
    """The crank goes as far as coupler and rocker lie in line; outward in line they reach farther
    than it comes, so both limits are where they overlap."""
    crank, coupler, rocker, ground = BARS

    def reach(angle: float) -> float:
        return acos((crank**2 + ground**2 - angle**2) / (2 * crank * ground))

    assert coupler + rocker > crank + ground
    nearest = reach(coupler - rocker)  # from the ground's line, on either side
    middle = pi - pi / 2  # of what is reached, from the drawn crank
    half = pi - nearest
    wanted = [
        (max(middle - half + 2 * pi * k, low), min(middle + half + 2 * pi * k, high))
        for k in range(-3, 4)
    ]
    wanted = [(first, last) for first, last in wanted if first < last]
    r = mk.load(four_bar()).equilibrium(window={"A.theta": (low, high)})
    assert np.array(spans(r)) == pytest.approx(np.array(wanted), abs=1e-9)
    assert all(event.startswith("indifferent") for event in r["row.event"])
    assert len(r["A.theta"]) == motions


def test_a_dead_band_is_told_to_its_ends_beside_other_equilibria() -> None:
    """Nothing acts from -0.2 to 0.3 rad; beyond the moment is a sine, zero again half a turn on."""
    value = "-1 N*m*sin(max(A.theta, 0.3 rad) - 0.3 rad + min(A.theta, -0.2 rad) + 0.2 rad)"
    torque = {"type": "torque", "joint": "A", "value": value}
    r = mk.load(arm(torque)).equilibrium(window={"A.theta": (-1, 5)})
    assert spans(r) == [pytest.approx((-0.2, 0.3), abs=1e-9)]
    inside, beyond = r["A.theta"]
    assert -0.2 <= inside <= 0.3
    assert beyond == pytest.approx(0.3 + pi, abs=1e-9)
    assert r["row.event"].tolist()[1] == "unstable"


def test_searches_that_all_run_away_are_told_so() -> None:
    """Two blocks that fall without end."""
    slide = {"type": "P", "point": [0, 0, 0], "axis": [0, 1, 0]}
    block = {"mass": 1, "center_of_mass": [0, 0, 0]}
    falling = {
        "format": 1,
        "links": {"a": block, "b": block},
        "joints": {
            "A": {**slide, "links": ["ground", "a"]},
            "B": {**slide, "links": ["ground", "b"]},
        },
        "loads": [WEIGHT],
    }
    r = mk.load(falling).equilibrium(window={"A.s": (-1, 1), "B.s": (-1, 1)})
    assert r["row.status"].tolist() == ["no-equilibrium"]
    (note,) = (note for note in r.diagnostics if note.code == "window-starts")
    assert note.message.startswith("none of the searches from")


def test_circuits_between_two_values_of_a_window_are_found() -> None:
    """A four-bar that the crank moves by four degrees: its two equal bars are hardly longer than
    half the least gap, and their knee turns over in between. A spring at the knee."""
    bar = 1.0005
    slant = acos(1 / bar)
    joints = {
        "A": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
        "B": {"type": "R", "links": ["crank", "left"], "point": [1, 0]},
        "C": {"type": "R", "links": ["left", "right"], "point": [2, sin(slant) * bar]},
        "D": {"type": "R", "links": ["ground", "right"], "point": [3, 0]},
    }
    spring = {"type": "spring", "joint": "C", "coordinate": "theta", "stiffness": 10, "free": slant}
    short = {
        "format": 1,
        "plane": "xy",
        "units": {"angle": "rad"},
        "links": {"crank": {}, "left": {}, "right": {}},
        "joints": joints,
        "loads": [spring],
    }
    r = mk.load(short).equilibrium(window={"A.theta": (-pi + 0.061, pi + 0.061)})
    # the crank stands straight where the knee is bent most, to either side
    gap = 2 * bar * cos(slant / 2)
    crank = acos((10 - gap * gap) / 6)
    assert r["A.theta"] == pytest.approx([-crank, 0, 0, crank], abs=1e-9)
    assert sorted(r["C.theta"]) == pytest.approx([0, slant, slant, 4 * slant], abs=1e-9)
    assert r["row.event"].tolist() == ["stable", "unstable", "unstable", "stable"]
    (note,) = (note for note in r.diagnostics if note.code == "window-circuits")
    assert "1 of them at unknown circuits" in str(note.measured)


@pytest.mark.parametrize("turns", [1, 2])
@pytest.mark.parametrize("centre", [-1.0, -1.4])
def test_a_motion_of_several_freedoms_that_balances_is_one_row(centre: float, turns: int) -> None:
    # the second link bears nothing, or hangs at its own joint: it stands anywhere
    mass = 0 if centre != -1.0 else 2
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: deg, force: N}}
links:
  a: {{mass: 1, center_of_mass: [0, -0.5]}}
  b: {{mass: {mass}, center_of_mass: [0, {centre}]}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [a, b], point: [0, -1]}}
loads:
  - {{type: gravity, g: [0, -9.81]}}
"""
    m = mk.loads(text)
    window = {"A.theta": (-180 * turns, 180 * turns), "B.theta": (-180, 180)}
    e = m.equilibrium(["A.theta"], window=window)
    found = np.sort(np.asarray(e["A.theta"]))
    least = [-180, 0] if turns == 1 else [-360, -180]
    np.testing.assert_allclose(found, least, atol=1e-7)
    (note,) = (one for one in e.diagnostics if one.code == "indifferent")
    assert str(note).count("a motion through") == 2


# masses of the second and the third rod of a chain; how many motions balance, of how many freedoms
@pytest.mark.parametrize(
    ("second", "third", "motions", "freedoms"), [(0, 0, 2, 2), (1, 0, 4, 1), (0, 1, 8, 0)]
)
def test_what_hangs_without_weight_stands_anywhere(
    second: float, third: float, motions: int, freedoms: int
) -> None:
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: deg, force: N}}
links:
  a: {{mass: 1, center_of_mass: [0, -0.5]}}
  b: {{mass: {second}, center_of_mass: [0, -1.4]}}
  c: {{mass: {third}, center_of_mass: [0, -2.3]}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [a, b], point: [0, -1]}}
  C: {{type: R, links: [b, c], point: [0, -2]}}
loads:
  - {{type: gravity, g: [0, -9.81]}}
"""
    window = {f"{joint}.theta": (-180, 180) for joint in "ABC"}
    e = mk.loads(text).equilibrium(["A.theta"], window=window)
    assert len(e["A.theta"]) == motions
    words = {0: "through", 1: "a motion through", 2: "motions of 2 freedoms through"}[freedoms]
    notes = [str(one) for one in e.diagnostics if one.code == "indifferent"]
    # a link that bears nothing between two that do is no motion: the third holds it
    assert [note.count(words) for note in notes] == ([motions] if freedoms else [])


def test_motions_that_balance_and_points_are_told_apart() -> None:
    # a balanced wheel stands anywhere, a bob beside it at two places
    text = """
format: 1
plane: xy
units: {length: m, angle: deg, force: N}
links: {wheel: {mass: 3, center_of_mass: [0, 0]}, bob: {mass: 1, center_of_mass: [2, -0.5]}}
joints:
  W: {type: R, links: [ground, wheel], point: [0, 0]}
  B: {type: R, links: [ground, bob], point: [2, 0]}
loads:
  - {type: gravity, g: [0, -9.81]}
"""
    e = mk.loads(text).equilibrium(
        ["B.theta", "row.event"], window={"W.theta": (-180, 180), "B.theta": (-180, 180)}
    )
    at = dict(zip(np.round(e["B.theta"], 6).tolist(), e["row.event"], strict=True))
    assert sorted(at) == [-180, 0]
    assert at[0].startswith("indifferent")


def test_a_branch_to_infinity_hides_no_forces() -> None:
    # a yoke runs away where its slot lies along its guide: the spring's force grows beyond bounds
    text = """
format: 1
plane: xy
units: {angle: rad}
links:
  crank: {mass: 2, center_of_mass: [0.1, 0.1]}
  yoke: {mass: 3, center_of_mass: [0.3, 0.2]}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  P: {type: Ps, links: [yoke, crank], point: [0.3, 0.2], slot: [0, 1]}
  S: {type: P, links: [ground, yoke], point: [0.3, 0.3], axis: [1, 0.1]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: spring, joint: S, coordinate: s, stiffness: 150}
"""
    e = mk.loads(text).equilibrium(["O.theta"], window={"O.theta": (-3.1, 3.1)})
    assert "indifferent" not in told(e)

    # the slot is a line of the crank 0.3 from O, on which the yoke's pin stays
    axis = np.array([1, 0.1]) / hypot(1, 0.1)

    def slide(turn: float) -> float:
        off = 0.3 - 0.3 * cos(turn) - 0.2 * sin(turn)
        return float(off / (axis[0] * cos(turn) + axis[1] * sin(turn)))

    def energy(turn: float) -> float:
        s = slide(turn)
        height = hypot(0.1, 0.1) * sin(pi / 4 + turn)
        return 2 * G * height + 3 * G * s * axis[1] + 75 * s * s

    def moment(turn: float) -> float:
        return (energy(turn + 1e-6) - energy(turn - 1e-6)) / 2e-6

    # at the poles of the slide the moment changes its sign, too
    found = [at for at in roots(moment, -3.1, 3.1) if abs(slide(at)) < 1e3]
    np.testing.assert_allclose(np.sort(e["O.theta"]), found, atol=1e-6)
