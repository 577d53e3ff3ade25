"""Rows at rest of random mechanisms with springs: each is an equilibrium of the assembly that it
shows, by an energy of the tests' own, and no row depends on how far apart rows are.
MECHKIN_RANDOM=25 takes five hundred."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable

import numpy as np
import pytest
from random_families.four_bars import TURN, cases
from random_families.sprung_loops import SprungLoop, arm, plane_four_bar, rssr
from scipy.optimize import brentq

import mechkin_cli as mk
from mechkin_cli.show import Floats

H = 1e-4


def _slope(energy: Callable[[float], float], x: float) -> float:
    far, near = energy(x + 2 * H) - energy(x - 2 * H), energy(x + H) - energy(x - H)
    return (8 * near - far) / (12 * H)


def _at_rest(loop: SprungLoop) -> None:
    r = mk.loads(loop.text + "motion: {rest: [A.theta]}\n").analyze()
    if not r.result.solved.all():
        return  # nothing is told, then
    name, energies = loop.by_output
    theta, out = float(r["A.theta"][0]), float(r[name][0])
    # the assembly that is shown is the one in which this output goes with this coordinate
    misses = [abs(math.remainder(energy(out)[1] - theta, TURN)) for energy in energies]
    own = energies[int(np.nanargmin(misses))]
    assert min(misses) < 1e-8
    level = own(out)[0]
    # by the coordinate, too: next to a dead centre of one the energy has no rate by it
    slopes = [_slope(lambda phi: own(phi)[0], out)]
    slopes += [_slope(e, theta) for e in loop.energies if abs(e(theta) - level) < 1e-7]
    assert np.nanmin(np.abs(slopes)) < 1e-6 * (1.0 + abs(level))


@pytest.mark.parametrize("rng", [*cases(811, 12)])
def test_plane_four_bars_balance_as_they_are_shown(rng: random.Random) -> None:
    _at_rest(plane_four_bar(rng))


@pytest.mark.parametrize("rng", [*cases(812, 8)])
def test_spatial_four_bars_balance_as_they_are_shown(rng: random.Random) -> None:
    _at_rest(rssr(rng))


def _swept(text: str, near: float, first: float, last: float, count: int) -> Floats:
    sweep = (
        f"motion: {{inputs: {{A.theta: {{from: {first}, to: {last}, count: {count}}}}}, "
        f"rest: [B.theta]}}\nassembly: {{near: {{B.theta: {near}}}}}\n"
    )
    return np.asarray(mk.loads(text + sweep).analyze(["B.theta"])["B.theta"])


@pytest.mark.parametrize("rng", [*cases(813, 20)])
def test_rows_at_rest_do_not_depend_on_their_distance(rng: random.Random) -> None:
    own = arm(rng)
    near, first = rng.uniform(-2, 2), rng.uniform(-3, 0)
    last, count = first + rng.uniform(1, 5), rng.randint(4, 9)
    few = _swept(own.text, near, first, last, count)
    many = _swept(own.text, near, first, last, 9 * (count - 1) + 1)[::9]
    # rows behind a fold are empty in both
    np.testing.assert_allclose(few, many, atol=1e-8)
    back = _swept(own.text, float(few[-1]), last, first, count) if np.isfinite(few).all() else None
    if back is not None:
        turns = np.round((back[::-1] - few) / TURN) * TURN
        np.testing.assert_allclose(back[::-1] - turns, few, atol=1e-8)


@pytest.mark.parametrize("rng", [*cases(814, 40)])
def test_rows_under_a_growing_load_do_not_depend_on_their_distance(rng: random.Random) -> None:
    own = plane_four_bar(rng)
    moment, count = round(rng.choice([-1, 1]) * rng.uniform(2, 60), 2), rng.randint(3, 8)
    load = f'  - {{type: torque, joint: A, value: "{moment} N*m/s*time"}}\n'

    def swept(rows: int) -> tuple[Floats, bool]:
        motion = f"motion: {{time: {{from: 0, to: 1, count: {rows}}}, rest: [A.theta]}}\n"
        r = mk.loads(own.text + load + motion).analyze(["A.theta"])
        lost = any(one.code == "rest-lost" for one in r.diagnostics)
        return np.asarray(r["A.theta"]), lost

    (few, few_lost), (many, many_lost) = swept(count), swept(9 * (count - 1) + 1)
    many = many[::9]
    # a hair beside a dead centre of the coordinate a branch may be lost, which is told
    same = np.isfinite(few) & np.isfinite(many)
    np.testing.assert_allclose(few[same], many[same], atol=1e-8)
    if not (few_lost or many_lost):
        np.testing.assert_array_equal(np.isfinite(few), np.isfinite(many))


def _angles(force: float, rows: int) -> tuple[Floats, Floats]:
    """Two equal rods in a row, pulled sideways by a force that grows to `force`."""
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: rad, force: N}}
links: {{a: {{mass: 1, center_of_mass: [0, -0.5]}}, b: {{mass: 1, center_of_mass: [0, -1.5]}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [a, b], point: [0, -1]}}
points: {{tip: {{link: b, at: [0, -2]}}}}
loads:
  - {{type: gravity, g: [0, -10]}}
  - {{type: force, link: b, point: tip, force: [{force} N/s*time, 0]}}
motion: {{time: {{from: 0, to: 1, count: {rows}}}, rest: [A.theta, B.theta]}}
"""
    r = mk.loads(text).analyze(["A.theta", "B.theta"])
    return np.asarray(r["A.theta"]), np.asarray(r["B.theta"])


@pytest.mark.parametrize("rows", [2, 3, 21])
@pytest.mark.parametrize("force", [10.0, 100.0, 1000.0])
def test_two_rods_follow_a_pull_however_far_rows_lie_apart(force: float, rows: int) -> None:
    # each rod lies along what pulls at its lower end: moments about A and B vanish
    a, b = _angles(force, rows)
    pull = force * np.linspace(0, 1, rows)
    np.testing.assert_allclose(a, np.arctan(pull / 15), atol=1e-9)
    np.testing.assert_allclose(a + b, np.arctan(pull / 5), atol=1e-9)


@pytest.mark.parametrize("rows", [2, 3, 6, 21, 201])
def test_a_fold_lies_on_the_law_of_the_input_that_moves(rows: int) -> None:
    # a toggle snaps where the push that grows less the lift of a slide is its largest force
    knee, law = np.hypot(100, 30), "100 mm*(1 - cos(180 deg*time/(1 s)))"
    text = f"""
format: 1
plane: xy
units: {{length: mm, force: N}}
links: {{left: {{}}, right: {{}}, slider: {{}}, lift: {{}}}}
joints:
  A: {{type: R, links: [ground, left], point: [0, 0]}}
  K: {{type: R, links: [left, right], point: [100, 30]}}
  C: {{type: R, links: [right, slider], point: [200, 0]}}
  S: {{type: P, links: [ground, slider], point: [200, 0], axis: [1, 0]}}
  L: {{type: P, links: [ground, lift], point: [100, 30], axis: [0, 1]}}
points: {{knee: {{link: left, at: [100, 30]}}}}
loads:
  - {{type: spring, joint: S, coordinate: s, stiffness: 10 N/mm}}
  - {{type: force, link: left, point: knee, force: [0, "0.04 N/mm*L.s - 30 N*time/(1 s)"]}}
motion:
  time: {{from: 0, to: 2, count: {rows}}}
  inputs: {{L.s: {{law: expression, value: '{law}'}}}}
  rest: [A.theta]
"""
    r = mk.loads(text).analyze(["A.theta"])
    found = next(one for one in r.diagnostics if one.code == "snaps-through")
    time = float(re.search(r"time = ([\d.]+) s", str(found))[1])  # type: ignore[index]
    angle = np.linspace(0, np.arctan2(30, 100), 200001)
    # V = k s^2 / 2, s = 2 l (cos a - cos a0): the push that balances at an angle is
    push = 4 * 10 * knee * (np.cos(angle) - 100 / knee) * np.sin(angle) / np.cos(angle)
    t = brentq(lambda t: 30 * t - 4 * (1 - np.cos(np.pi * t)) - push.max(), 0.85, 1.0)
    assert time == pytest.approx(t, abs=1e-8)


def _five_bar(rng: random.Random) -> str:
    points = [(0, 0), (-0.3, 0.5), (0.25, 1), (0.9, 0.6), (0.6, 0)]
    moved = [tuple(round(x + rng.uniform(-0.12, 0.12), 2) for x in point) for point in points]
    links = ["ground", "l1", "l2", "l3", "l4", "ground"]
    text = "format: 1\nplane: xy\nunits: {length: m, angle: rad, force: N}\nlinks: {"
    text += ", ".join(f"l{k}: {{}}" for k in range(1, 5)) + "}\njoints:\n"
    for k, joint in enumerate("ABCDE"):
        pair = f"[{links[k]}, {links[k + 1]}]" if joint != "E" else "[ground, l4]"
        text += f"  {joint}: {{type: R, links: {pair}, point: {list(moved[k])}}}\n"
    loads, marks = "", ""
    for k in range(2):
        far = [round(rng.uniform(-0.5, 1.5), 2), round(rng.uniform(0.2, 1.6), 2)]
        link, at = rng.choice([("l3", (0.5, 0.8)), ("l4", (0.7, 0.4)), ("l2", (0, 0.8))])
        marks += f"  p{k}: {{link: {link}, at: {list(at)}}}\n  q{k}: {{link: ground, at: {far}}}\n"
        loads += (
            f"  - {{type: spring, between: [p{k}, q{k}], stiffness: {rng.randint(100, 400)}, "
            f"free: {round(rng.uniform(0.2, 0.9), 2)}}}\n"
        )
    for joint in "AE":
        loads += f"  - {{type: spring, joint: {joint}, coordinate: theta, stiffness: 5}}\n"
    push = [f"{rng.randint(-90, 90)} N/s*time" for _ in range(2)]
    loads += f"  - {{type: force, link: l4, point: p9, force: [{push[0]}, {push[1]}]}}\n"
    marks += "  p9: {link: l4, at: [0.7, 0.3]}\n"
    return f"{text}points:\n{marks}loads:\n{loads}"


@pytest.mark.parametrize("rng", [*cases(815, 15)])
def test_rows_do_not_depend_on_which_coordinates_rest(rng: random.Random) -> None:
    own = _five_bar(rng)
    names = [f"{joint}.theta" for joint in "ABDE"]
    found, lost = [], []
    for pair in ("A.theta, E.theta", "A.theta, B.theta", "D.theta, E.theta"):
        motion = f"motion: {{time: {{from: 0, to: 1.5, count: 16}}, rest: [{pair}]}}\n"
        r = mk.loads(own + motion).analyze(names)
        found.append(np.array([r[name] for name in names]))
        lost.append(any(one.code == "rest-lost" for one in r.diagnostics))
    for other, other_lost in zip(found[1:], lost[1:], strict=True):
        turns = np.round((other - found[0]) / (2 * np.pi)) * 2 * np.pi
        off = np.abs(other - turns - found[0])
        if not off[:, 0].max() < 1e-7:
            continue  # the search for the first equilibrium ended at another
        if not (lost[0] or other_lost):
            np.testing.assert_array_equal(np.isfinite(other), np.isfinite(found[0]))
        assert np.nanmax(off) < 1e-7


@pytest.mark.parametrize(
    ("seed", "pair"), [(0, "D.theta, E.theta"), (9, "A.theta, B.theta"), (56, "A.theta, B.theta")]
)
def test_rows_told_by_another_coordinate_are_rows_like_others(seed: int, pair: str) -> None:
    own = _five_bar(random.Random(seed)).replace("units:", "parameters: {k: 5}\nunits:")
    own = own.replace("stiffness: 5}", "stiffness: k*1 N*m/rad}")
    m = mk.loads(own + f"motion: {{time: {{from: 0, to: 1.5, count: 16}}, rest: [{pair}]}}\n")
    names = [f"{joint}.theta" for joint in "ABDE"]
    r = m.analyze(names)
    assert "rest-exchanged" in [one.code for one in r.diagnostics]
    assert np.isfinite([r[name] for name in names]).all()
    assert max(r.errors[name].max() for name in names) < 1e-10
    s = m.sensitivities(names, ["k"], run="sweep")
    ends = [m.with_parameters({"k": 5 + h}).analyze(names) for h in (1e-4, -1e-4)]
    varied = m.vary({"k": [5 + 1e-4, 5 - 1e-4]}, names)
    narrow = m.analyze(names, lanes=2, threads=1)
    blocks = list(m.stream(names, rows=5))
    for name in names:
        slope = (ends[0][name] - ends[1][name]) / 2e-4
        np.testing.assert_allclose(s[name, "k"], slope, rtol=1e-6, atol=1e-8)
        for number, end in enumerate(ends):
            np.testing.assert_array_equal(varied[name][number], end[name])
        np.testing.assert_array_equal(narrow[name], r[name])
        np.testing.assert_array_equal(np.concatenate([one[name] for one in blocks]), r[name])
