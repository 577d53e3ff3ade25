"""Equilibria against closed forms and the minima and saddles of an energy that scipy finds."""

from __future__ import annotations

import pickle
import re
from itertools import product
from math import acos, cos, degrees, hypot, pi, radians, sin, sqrt, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

G = 9.81

PENDULUM: dict[str, Any] = {
    "format": 1,
    "links": {"bob": {"mass": 2, "center_of_mass": [0, -0.25, 0], "inertia": {"zz": 0.02}}},
    "joints": {
        "A": {"type": "R", "links": ["ground", "bob"], "point": [0, 0, 0], "axis": [0, 0, 1]}
    },
    "loads": [{"type": "gravity", "g": [0, -G, 0]}],
}

TWO: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "links": {
        "a": {"mass": 2, "center_of_mass": [0, -0.25]},
        "b": {"mass": 1, "center_of_mass": [0, -0.7]},
    },
    "joints": {
        "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
        "B": {"type": "R", "links": ["a", "b"], "point": [0, -0.5]},
    },
    "loads": [{"type": "gravity", "g": [0, -G]}],
}

FOUR_BAR = """
format: 1
plane: xy
units: {length: mm, force: N}
links:
  crank: {mass: 1, center_of_mass: [0, 20]}
  coupler: {mass: 2, center_of_mass: [60, 70]}
  rocker: {mass: 1.5, center_of_mass: [110, 40]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, coupler], point: [0, 40]}
  C: {type: R, links: [coupler, rocker], point: [120, 80]}
  D: {type: R, links: [rocker, ground], point: [100, 0]}
points: {P: {link: rocker, at: [110, 40]}, Q: {link: ground, at: [200, 60]}}
loads:
  - {type: gravity, g: [0, -9810]}
  - {type: spring, between: [P, Q], stiffness: 1 N/mm, free: 60}
"""


def test_a_pendulum_hangs_and_stands_on_its_head() -> None:
    r = mk.load(PENDULUM).equilibrium(window={"A.theta": (-90, 200)})
    assert r["A.theta"] == pytest.approx([0.0, 180.0], abs=1e-9)
    assert r["row.event"].tolist() == ["stable", "unstable"]
    assert r["row.least_stiffness"] == pytest.approx([2 * G * 0.25, -2 * G * 0.25], rel=1e-10)
    frequency = sqrt(2 * G * 0.25 / (2 * 0.25**2 + 0.02)) / (2 * pi)
    assert r["row.frequency"][0] == pytest.approx(frequency, rel=1e-10)
    assert np.isnan(r["row.frequency"][1])
    assert r["A.force"][0] == pytest.approx([0, 2 * G, 0], abs=1e-9)


@pytest.mark.parametrize("start", [-170.0, -100.0, 10.0, 95.0, 179.0])
def test_a_search_ends_at_an_equilibrium_from_anywhere(start: float) -> None:
    r = mk.load(PENDULUM).equilibrium(near={"A.theta": start})
    assert abs(sin(radians(r["A.theta"][0]))) < 1e-9


def test_an_effort_moves_the_equilibrium() -> None:
    own = {"pushed": {"near": {"A.theta": 20}, "efforts": {"A.theta": "2 N*m"}}}
    r = mk.load(PENDULUM | {"equilibria": own}).equilibrium("pushed")
    assert r["A.theta"][0] == pytest.approx(degrees(np.arcsin(2 / (2 * G * 0.25))), rel=1e-12)
    assert r["A.effort"][0] == 2.0


def test_a_double_pendulum_has_four() -> None:
    r = mk.load(TWO).equilibrium(window={"A.theta": (-90, 200), "B.theta": (-90, 200)})
    found = sorted(zip(r["A.theta"].round(6), r["B.theta"].round(6), r["row.event"], strict=True))
    wanted = [
        (0.0, 0.0, "stable"),
        (0.0, 180.0, "unstable"),
        (180.0, 0.0, "unstable"),
        (180.0, 180.0, "unstable"),
    ]
    assert found == wanted


def test_the_lowest_frequency_of_a_double_pendulum() -> None:
    r = mk.load(TWO).equilibrium(near={"A.theta": 20, "B.theta": -30})
    # M u'' + K u = 0 in the angles of A and B
    stiff = np.array([[2 * G * 0.25 + G * 0.7, G * 0.2], [G * 0.2, G * 0.2]])
    heavy = np.array([[2 * 0.25**2 + 0.7**2, 0.2 * 0.7], [0.2 * 0.7, 0.2**2]])
    lowest = np.linalg.eigvals(np.linalg.solve(heavy, stiff)).real.min()
    assert r["row.frequency"][0] == pytest.approx(sqrt(lowest) / (2 * pi), rel=1e-9)
    assert r["row.least_stiffness"][0] == pytest.approx(np.linalg.eigvalsh(stiff)[0], rel=1e-9)


@pytest.mark.parametrize("angles", [(20, -30, 0), (-40, 10, 70), (75, 60, -120)])
def test_a_balanced_lamp_rests_anywhere(angles: tuple[float, float, float]) -> None:
    m = mk.load("mechanisms/statics/balanced_lamp.yaml")
    names = ("A.theta", "E.theta", "F.theta")
    r = m.equilibrium(near=dict(zip(names, angles, strict=True)))
    assert [r[name][0] for name in names] == pytest.approx(angles, abs=1e-6)
    assert r["row.event"][0].startswith("indifferent")
    assert r["row.imbalance"][0] < 1e-12


def test_a_lamp_that_balances_at_all_angles_is_told_as_one() -> None:
    k = 2 * G * 0.3 / (0.2 * 0.1)
    lamp = {
        "format": 1,
        "plane": "xy",
        "links": {"arm": {"mass": 2, "center_of_mass": [0.3, 0]}},
        "joints": {"A": {"type": "R", "links": ["ground", "arm"], "point": [0, 0]}},
        "points": {"P": {"link": "arm", "at": [0.1, 0]}, "Q": {"link": "ground", "at": [0, 0.2]}},
        "loads": [
            {"type": "gravity", "g": [0, -G]},
            {"type": "spring", "between": ["P", "Q"], "stiffness": k, "free": 0},
        ],
    }
    r = mk.load(lamp).equilibrium(window={"A.theta": (-80, 80)})
    assert r["row.event"].tolist() == ["indifferent along A.theta"]
    assert "indifferent" in [note.code for note in r.diagnostics]


LENGTH = hypot(100, 30)
DRAWN = 100 / LENGTH


def test_a_toggle_snaps_through_at_its_critical_load() -> None:
    """V = k s^2/2 + P y, y = L sin(phi), s = 2 L (cos(phi) - cos(phi0)): the load at the fold has
    cos(phi)^3 = cos(phi0)."""
    text = Path("mechanisms/statics/toggle.yaml").read_text(encoding="utf-8")
    r = mk.loads(text.replace("to: 18", "to: 24")).analyze()
    phi = acos(DRAWN ** (1 / 3))
    critical = 4 * 10 * LENGTH * (sin(phi) - DRAWN * tan(phi))
    (fold,) = (note for note in r.diagnostics if note.code == "snaps-through")
    assert fold.measured is not None
    told = float(fold.measured.split("time = ")[1].split(" s")[0])
    assert told == pytest.approx(critical, rel=1e-9)
    solved = r["row.status"] == "ok"
    assert solved.tolist() == [time < critical for time in r["time"]]
    assert set(r["row.status"][~solved]) == {"snapped-through"}
    assert np.isnan(r["A.theta"][~solved]).all()
    # rows: the push of the height, in closed form
    height = r["knee.position.y"][solved]
    angle = np.arcsin(height / LENGTH)
    push = 4 * 10 * LENGTH * (np.sin(angle) - DRAWN * np.tan(angle))
    assert push == pytest.approx(r["time"][solved], abs=1e-8)


def test_all_places_of_a_toggle() -> None:
    r = mk.load("mechanisms/statics/toggle.yaml").equilibrium("pushed")

    def push(phi: float) -> float:
        return 4 * 10 * LENGTH * (sin(phi) - DRAWN * tan(phi)) - 12

    grid = np.linspace(radians(-72), radians(76), 4001)
    signs = np.sign([push(x) for x in grid])
    at = np.flatnonzero(signs[1:] != signs[:-1])
    angles = [optimize.brentq(push, grid[k], grid[k + 1], xtol=1e-14) for k in at]
    left = sorted(LENGTH * sin(x) for x in angles)
    # the slider may also stand to the left of A: cos(phi) < 0 is another assembly
    found = [y for y, s in zip(r["knee.position.y"], r["S.s"], strict=True) if s > -200]
    assert sorted(found) == pytest.approx(left, abs=1e-8)


STANDING: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "links": {"arm": {}},
    "joints": {"A": {"type": "R", "links": ["ground", "arm"], "point": [0, 0]}},
    "points": {"P": {"link": "arm", "at": [0, 0.1]}},
}


@pytest.mark.parametrize("push", [0.5, 0.99, 1.0, 1.01, 1.5, 2.0])
def test_an_inverted_pendulum_on_a_spring_forks(push: float) -> None:
    """theta = push sin(theta), in parts of the critical load."""
    loads = [
        {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": 0.1},
        {"type": "force", "link": "arm", "point": "P", "force": [0, -push]},
    ]
    r = mk.load(STANDING | {"loads": loads}).equilibrium(window={"A.theta": (-170, 170)})
    if push <= 1.0:
        assert r["A.theta"] == pytest.approx([0.0], abs=1e-3 if push == 1.0 else 1e-9)
        words = "marginal along A.theta" if push == 1.0 else "stable"
        assert r["row.event"].tolist() == [words]
        return
    beside = optimize.brentq(lambda x: x - push * sin(x), 1e-2, pi)
    assert np.radians(r["A.theta"]) == pytest.approx([-beside, 0.0, beside], abs=1e-9)
    assert r["row.event"].tolist() == ["stable", "unstable", "stable"]


FOLDS: dict[str, tuple[dict[str, Any], float, float]] = {
    # m g l sin(theta) comes to its largest value; (theta - 0.3)^2 only touches zero
    "largest": ({"effort": 2 * G * 0.25}, 90.0, 3e-5),
    "touching": ({"value": "-1 N*m/rad^2*(A.theta-0.3 rad)^2"}, degrees(0.3), 1e-5),
}


@pytest.mark.parametrize("name", FOLDS)
def test_a_fold_is_marginal(name: str) -> None:
    own, wanted, off = FOLDS[name]
    if "effort" in own:
        efforts = {"A.theta": own["effort"]}
        m = mk.load(PENDULUM | {"equilibria": {"it": {"efforts": efforts}}})
        r = m.equilibrium("it")
    else:
        loads = [{"type": "torque", "joint": "A", "value": own["value"]}]
        r = mk.load(PENDULUM | {"loads": loads}).equilibrium(window={"A.theta": (-90, 90)})
    assert r["A.theta"] == pytest.approx([wanted], abs=off)
    assert r["row.event"].tolist() == ["marginal along A.theta"]


@pytest.mark.parametrize("part", [1e-8, 1e-10])
def test_places_beside_a_fold_are_no_fold(part: float) -> None:
    """m g l sin(theta) = (1 - part) m g l on both sides of its largest value: the stiffness is
    m g l cos(theta)."""
    largest = 2 * G * 0.25
    sides = {
        name: {"near": {"A.theta": near}, "efforts": {"A.theta": largest * (1 - part)}}
        for name, near in (("below", 80), ("above", 100))
    }
    m = mk.load(PENDULUM | {"equilibria": sides})
    found = {name: m.equilibrium(name) for name in sides}
    beside = sqrt(2 * part)
    for name, sign in (("below", 1), ("above", -1)):
        r = found[name]
        assert radians(r["A.theta"][0] - 90) == pytest.approx(-sign * beside, rel=1e-2)
        assert r["row.event"][0] == ("stable" if sign > 0 else "unstable")
        assert r["row.least_stiffness"][0] == pytest.approx(sign * largest * beside, rel=1e-2)


def _energy(angle: float, branch: float) -> float:
    """V (N*mm) of the four-bar, written anew from its circles; angle of the crank from its drawing
    in rad."""
    turn = angle + pi / 2
    b = np.array([40 * cos(turn), 40 * sin(turn)])
    d = np.array([100.0, 0.0])
    coupler, rocker = hypot(120, 40), hypot(20, 80)
    between = d - b
    apart = hypot(*between)
    along = (apart**2 + coupler**2 - rocker**2) / (2 * apart)
    aside = sqrt(coupler**2 - along**2)
    e = between / apart
    c = b + along * e + branch * aside * np.array([-e[1], e[0]])

    def carried(point: tuple[float, float], p: Any, q: Any, p0: Any, q0: Any) -> Any:
        turned = complex(*(q - p)) / complex(*(np.subtract(q0, p0)))
        moved = turned * complex(*np.subtract(point, p0))
        return p + np.array([moved.real, moved.imag])

    o = np.zeros(2)
    g1 = carried((0, 20), o, b, (0, 0), (0, 40))
    g2 = carried((60, 70), b, c, (0, 40), (120, 80))
    g3 = carried((110, 40), d, c, (100, 0), (120, 80))
    stretch = hypot(*(g3 - np.array([200, 60]))) - 60
    return float(G * (g1[1] + 2 * g2[1] + 1.5 * g3[1]) + 0.5 * stretch**2)


def _stationary() -> list[float]:
    """Crank angles (deg) of all stationary places of the energy, by its differences."""
    found = []
    for branch in (1.0, -1.0):

        def slope(x: float, branch: float = branch) -> float:
            h = 1e-4
            far = _energy(x + 2 * h, branch) - _energy(x - 2 * h, branch)
            near = _energy(x + h, branch) - _energy(x - h, branch)
            return (8 * near - far) / (12 * h)

        grid = np.linspace(-pi, pi, 1441) + 1e-3
        values = [slope(x) for x in grid]
        for k in range(grid.size - 1):
            if values[k] * values[k + 1] < 0:
                x = optimize.brentq(slope, grid[k], grid[k + 1], xtol=1e-12)
                found.append((degrees(x) + 180) % 360 - 180)
    return sorted(found)


def test_a_four_bar_against_its_energy() -> None:
    wanted = _stationary()
    r = mk.loads(FOUR_BAR).equilibrium(window={"A.theta": (-180, 180)})
    assert r["A.theta"] == pytest.approx(wanted, abs=1e-6)
    assert len(wanted) >= 4


@pytest.mark.parametrize("coordinate", ["B.theta", "C.theta", "D.theta"])
def test_other_free_coordinates_find_the_same(coordinate: str) -> None:
    m = mk.loads(FOUR_BAR)
    by_crank = m.equilibrium(window={"A.theta": (-180, 180)})
    other = m.equilibrium(window={coordinate: (-180, 180)})
    order = np.argsort(other["A.theta"])
    assert other["A.theta"][order] == pytest.approx(by_crank["A.theta"], abs=1e-8)
    assert other["row.event"][order].tolist() == by_crank["row.event"].tolist()
    frequencies = by_crank["row.frequency"]
    assert other["row.frequency"][order] == pytest.approx(frequencies, rel=1e-8, nan_ok=True)


def _scaled(text: str) -> str:
    """Ten times as large, with springs a tenth as stiff: weights and springs grow alike."""

    def larger(found: re.Match[str]) -> str:
        return ", ".join(str(10 * float(x)) for x in found.group(0).split(","))

    head, tail = text.split("links:", 1)
    tail = re.sub(r"(?<=: \[)-?[\d.]+, -?[\d.]+", larger, tail)
    return f"{head}links:{tail}".replace("1 N/mm, free: 60", "0.1 N/mm, free: 600").replace(
        "g: [0.0, -98100.0]", "g: [0, -9810]"
    )


def _mirrored(text: str) -> str:
    return re.sub(
        r"(?<=: \[)(-?[\d.]+)(?=, -?[\d.]+\])", lambda found: str(-float(found.group(0))), text
    )


def _reordered(text: str) -> str:
    """Joints and links in the opposite order: another tree, other cut joints."""
    lines = text.splitlines()
    for key in ("links:", "joints:"):
        first = lines.index(key) + 1
        last = next(k for k in range(first, len(lines)) if not lines[k].startswith("  "))
        lines[first:last] = lines[first:last][::-1]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(("change", "sign"), [(_scaled, 1.0), (_mirrored, -1.0), (_reordered, 1.0)])
def test_the_same_mechanism_written_otherwise(change: Any, sign: float) -> None:
    window = {"A.theta": (-180, 180)}
    own = mk.loads(FOUR_BAR).equilibrium(window=window)
    other = mk.loads(change(FOUR_BAR)).equilibrium(window=window)
    order = np.argsort(sign * other["A.theta"])
    assert sign * other["A.theta"][order] == pytest.approx(own["A.theta"], abs=1e-8)
    assert other["row.event"][order].tolist() == own["row.event"].tolist()
    if change is not _scaled:
        stiffness = own["row.least_stiffness"]
        assert other["row.least_stiffness"][order] == pytest.approx(stiffness, rel=1e-8)
        frequency = own["row.frequency"]
        assert other["row.frequency"][order] == pytest.approx(frequency, rel=1e-8, nan_ok=True)


def test_lanes_and_threads_do_not_matter() -> None:
    m = mk.loads(FOUR_BAR + "equilibria: {all: {window: {A.theta: {from: -180, to: 180}}}}\n")
    one = m.equilibrium("all", lanes=2, threads=1)
    for lanes, threads in product(widths(), (1, 2)):
        other = m.equilibrium("all", lanes=lanes, threads=threads)
        for name in ("A.theta", "C.theta", "B.force", "row.least_stiffness", "row.frequency"):
            assert one[name].tobytes() == other[name].tobytes()


def test_the_ride_height_of_a_wishbone_against_scipy() -> None:
    """The least energy over the driven sweep of the same mechanism."""
    m = mk.load("mechanisms/statics/ride_height.yaml")
    r = m.equilibrium("ride")
    assert r["row.event"].tolist() == ["stable"]
    text = Path("mechanisms/statics/ride_height.yaml").read_text(encoding="utf-8")
    text = text[: text.index("motion:")].replace("runs: [ride]", "runs: [sweep]", 1)
    text = "\n".join(
        line for line in text.splitlines() if "time}" not in line and "time]" not in line
    )

    def energy(angle: float) -> float:
        motion = f"motion: {{inputs: {{lower_pivot.theta: {{values: [{float(angle)!r}]}}}}}}\n"
        driven = mk.loads(text + "\n" + motion).analyze(["row.potential_energy"], tables=[])
        height = driven["contact.position.z"][0]
        return float(driven["row.potential_energy"][0] - 3500 * height)

    least = optimize.minimize_scalar(energy, bracket=(-5, 0, 5), tol=1e-9)
    assert r["lower_pivot.theta"][0] == pytest.approx(float(least.x), abs=2e-5)


def test_no_equilibrium_is_told_in_words() -> None:
    falls = {
        "format": 1,
        "links": {"block": {"mass": 1, "center_of_mass": [0, 0, 0]}},
        "joints": {
            "S": {"type": "P", "links": ["ground", "block"], "point": [0, 0, 0], "axis": [0, 1, 0]}
        },
        "loads": [{"type": "gravity", "g": [0, -G, 0]}],
    }
    r = mk.load(falls).equilibrium(near={"S.s": 0})
    assert r["row.status"].tolist() == ["no-equilibrium"]
    assert not r.complete
    (note,) = (note for note in r.diagnostics if note.severity == "error")
    assert note.code == "no-equilibrium"
    assert "runs away" in note.message
    assert np.isnan(r["S.s"]).all()
    r = mk.load(PENDULUM).equilibrium(window={"A.theta": (20, 160)})
    assert r["row.status"].tolist() == ["no-equilibrium"]


def test_too_few_coordinates_are_named() -> None:
    with pytest.raises(mk.InvalidFile, match="2 are free"):
        mk.load(TWO).equilibrium(near={"A.theta": 0})
    with pytest.raises(mk.InvalidFile, match="follows from"):
        mk.loads(FOUR_BAR).equilibrium(near={"A.theta": 0, "B.theta": 0})


def test_variants_of_an_equilibrium() -> None:
    own = {
        "parameters": {"torque": "1 N*m"},
        "equilibria": {"pushed": {"near": {"A.theta": 10}, "efforts": {"A.theta": "torque"}}},
    }
    m = mk.load(PENDULUM | own)
    r = m.vary({"torque": [1, 2, 3]}, ["A.theta"], run="pushed")
    wanted = np.degrees(np.arcsin(np.array([1, 2, 3]) / (2 * G * 0.25)))
    assert r["A.theta"][:, 0] == pytest.approx(wanted, rel=1e-10)


def test_an_answer_is_pickled_and_asked_again() -> None:
    m = mk.load("mechanisms/statics/toggle.yaml")
    for r in (m.equilibrium("pushed"), m.equilibrium(near={"A.theta": -5}), m.analyze()):
        again = pickle.loads(pickle.dumps(r))
        assert again["A.theta"].tobytes() == r["A.theta"].tobytes()
        assert again.errors["A.theta"].tobytes() == r.errors["A.theta"].tobytes()


def test_loads_of_time_are_taken_at_the_moment_that_is_given() -> None:
    torque = {"type": "torque", "link": "bob", "torque": [0, 0, "1 N*m/s*time"]}
    loads = [*PENDULUM["loads"], torque]
    own = {"late": {"near": {"A.theta": 0}, "time": 2}, "first": {"near": {"A.theta": 1}}}
    m = mk.load(PENDULUM | {"loads": loads, "equilibria": own})
    late = m.equilibrium("late")
    assert late["A.theta"][0] == pytest.approx(degrees(np.arcsin(2 / (2 * G * 0.25))), rel=1e-12)
    assert late["time"].tolist() == [2.0]
    assert m.equilibrium("first")["A.theta"][0] == pytest.approx(0.0, abs=1e-9)


def test_a_held_coordinate_has_its_effort() -> None:
    own = {"held": {"near": {"B.theta": 10}, "driven": {"A.theta": {"at": 30}}}}
    r = mk.load(TWO | {"equilibria": own}).equilibrium("held")
    # the lower link hangs down
    assert r["A.theta"][0] + r["B.theta"][0] == pytest.approx(0.0, abs=1e-9)
    moment = G * sin(radians(30)) * (2 * 0.25 + 1 * 0.5)
    assert r["A.effort"][0] == pytest.approx(moment, rel=1e-10)


def test_a_force_that_follows_its_link_leaves_the_stiffness_unsymmetric() -> None:
    """Beck's column of two links: its least stiffness creeps nowhere below the flutter load."""
    beck = {
        "format": 1,
        "plane": "xy",
        "links": {
            "a": {"mass": 1, "center_of_mass": [0, 0.5]},
            "b": {"mass": 1, "center_of_mass": [0, 1.5]},
        },
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "R", "links": ["a", "b"], "point": [0, 1]},
        },
        "points": {"tip": {"link": "b", "at": [0, 2]}},
        "loads": [
            {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": 1},
            {"type": "spring", "joint": "B", "coordinate": "theta", "stiffness": 1},
            {"type": "force", "link": "b", "point": "tip", "force": [0, -0.5], "axes": "link"},
        ],
    }
    r = mk.load(beck).equilibrium(near={"A.theta": 3, "B.theta": 2})
    assert [r["A.theta"][0], r["B.theta"][0]] == pytest.approx([0, 0], abs=1e-9)
    assert r["row.event"].tolist() == ["stable"]
    assert np.isnan(r["row.frequency"]).all()


def ziegler(force: float, damping: float = 0.0) -> dict[str, Any]:
    """Two massless links of length 1 on springs of torsion, with a mass of 2 kg where they meet and
    one of 1 kg at the tip, which a force pushes that follows the second link."""
    coordinates = [("A", "theta"), ("B", "theta")]
    return {
        "format": 1,
        "plane": "xy",
        "links": {
            "a": {"mass": 2, "center_of_mass": [0, 1]},
            "b": {"mass": 1, "center_of_mass": [0, 2]},
        },
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "R", "links": ["a", "b"], "point": [0, 1]},
        },
        "points": {"tip": {"link": "b", "at": [0, 2]}},
        "loads": [
            *(
                {"type": "spring", "joint": j, "coordinate": c, "stiffness": 1}
                for j, c in coordinates
            ),
            *(
                {"type": "damper", "joint": j, "coordinate": c, "damping": damping}
                for j, c in coordinates
                if damping
            ),
            {"type": "force", "link": "b", "point": "tip", "force": [0, -force], "axes": "link"},
        ],
    }


@pytest.mark.parametrize(
    ("damping", "critical"),
    [(0.0, 3.5 - 2**0.5), (0.1, 41 / 28 + 0.1**2 / 2)],
    ids=["without", "with"],
)
def test_a_column_flutters_under_a_force_that_follows_it(damping: float, critical: float) -> None:
    """H. Ziegler, Ingenieur-Archiv 20, 1952, and with damping G. Herrmann and I.-C. Jong, Journal
    of Applied Mechanics 32, 1965: a little of it takes a third of the load."""
    for part, event in ((0.999, "stable"), (1.001, "unstable by flutter")):
        m = mk.load(ziegler(part * critical, damping))
        r = m.equilibrium(near={"A.theta": 1, "B.theta": 1})
        assert [r["A.theta"][0], r["B.theta"][0]] == pytest.approx([0, 0], abs=1e-9)
        assert r["row.event"].tolist() == [event]


def test_equilibria_at_dead_centres_of_the_windows_coordinate() -> None:
    """A slider-crank whose weight pulls along its guide: it rests in line, where the slider turns
    back and no force along it tells anything."""
    text = """
format: 1
plane: xy
units: {length: mm, force: N}
links:
  crank: {mass: 1, center_of_mass: [0, 30]}
  rod: {}
  slider: {}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, 40]}
  C: {type: R, links: [rod, slider], point: [80, 0]}
  S: {type: P, links: [ground, slider], point: [80, 0], axis: [1, 0]}
loads:
  - {type: gravity, g: [-9810, 0]}
"""
    m = mk.loads(text)
    r = m.equilibrium(window={"S.s": (-100, 100)})
    rod = hypot(80, 40)
    wanted = [rod - 40 - 80, rod + 40 - 80]
    assert r["S.s"] == pytest.approx(wanted, abs=1e-9)
    assert r["row.event"].tolist() == ["stable", "unstable"]
    assert np.isnan(r["row.least_stiffness"]).all()
    by_crank = m.equilibrium(window={"A.theta": (-180, 180)})
    # the slider to the right of the crank; to its left is another assembly
    right = sorted(s for s in by_crank["S.s"] if s > -100)
    assert right == pytest.approx(wanted, abs=1e-9)
