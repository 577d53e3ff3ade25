"""Gears, racks and other relations between coordinates against closed forms: ratios of trains
(Willis 1841), torques by power, motions under forces by the reduced inertia, and a geared five-bar
by circles at 40 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

HEAD = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
"""
SHAFTS = (
    HEAD
    + """
links:
  a: {mass: 1, center_of_mass: [0, 0], inertia: 0.2}
  b: {mass: 1, center_of_mass: [0.6, 0], inertia: 0.3}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [0.6, 0]}
"""
)
SWEPT = """
motion: {inputs: {A.theta: {from: 0, to: 20, count: 5, rate: 10 rad/s, acceleration: 3 rad/s^2}}}
loads: [{type: torque, joint: B, value: -4}]
"""
GEAR = "G: {type: gear, joints: [A, B], teeth: [20, 50], ideal: true}"
ALIKE = {
    "teeth": GEAR,
    "radii": "G: {type: gear, joints: [A, B], radii: [0.2, 0.5], ideal: true}",
    "linear": "G: {type: linear, terms: {A.theta: 1, B.theta: 2.5}}",
    "with a parameter": "G: {type: linear, terms: {A.theta: 1, B.theta: 5/2}}",
}
"""Ways to write one pair of wheels."""


def of(shafts: str, couplings: str, motion: str) -> mk.Model:
    """The model of shafts with couplings."""
    return mk.loads(f"{shafts}couplings:\n  {couplings}\n{motion}")


@pytest.mark.parametrize("words", ALIKE.values(), ids=ALIKE.keys())
def test_two_shafts_turn_by_their_ratio_and_share_power(words: str) -> None:
    result = of(SHAFTS, words, SWEPT).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(0.0, 20.0, 5)
    np.testing.assert_allclose(result["B.theta"], -turn / 2.5, rtol=1e-14)
    np.testing.assert_allclose(result["B.theta_dot"], -4.0, rtol=1e-14)
    np.testing.assert_allclose(result["B.theta_ddot"], -1.2, rtol=1e-14)
    # the wheel needs its inertia's moment and the load's, 0.4 of it at the pinion, turned round
    at_wheel = 0.3 * -1.2 + 4.0
    np.testing.assert_allclose(result["G.torque"], 0.4 * at_wheel, rtol=1e-13)
    np.testing.assert_allclose(result["G.power"], 4.0 * at_wheel, rtol=1e-13)
    np.testing.assert_allclose(result["A.effort"], 0.2 * 3.0 - 0.4 * at_wheel, rtol=1e-13)
    # bearings carry no moment about their axes, and no force
    np.testing.assert_allclose(result["B.moment"], 0.0, atol=1e-14)
    np.testing.assert_allclose(
        result["ground.shaking_moment"], 0.0 * turn - 0.2 * 3 + 0.36, rtol=1e-12
    )


TRAIN = (
    HEAD
    + """
links: {sun: {}, planet: {}, carrier: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, carrier], point: [0, 0]}
  P: {type: R, links: [carrier, planet], point: [0.0375, 0]}
"""
)


@pytest.mark.parametrize("turns", [60, 131, 2_000, 30_000])
def test_wheels_turn_as_often_as_they_like(turns: int) -> None:
    # the angles of a train round by their own size, in as many products and sums as it has terms
    words = """inner: {type: gear, joints: [S, P], teeth: [18, 12], ideal: true}
  outer: {type: gear, joints: [C, P], teeth: [42, 12], internal: true, ideal: true}"""
    motion = f"motion: {{inputs: {{S.theta: {{from: 0, to: {turns} * 2*pi*1 rad, count: 997}}}}}}"
    rows = of(TRAIN, words, motion).analyze(["C.theta", "P.theta"], errors=True)
    assert set(rows["row.status"]) == {"ok"}
    # Willis: the carrier turns by 18/(18 + 42) of the sun, the planet against it by 42/12 of that
    np.testing.assert_allclose(rows["C.theta"], 0.3 * rows["S.theta"], rtol=4e-15)
    np.testing.assert_allclose(rows["P.theta"], -1.05 * rows["S.theta"], rtol=4e-15)


def test_a_gear_written_twice_moves_as_one_and_leaves_its_torques_open() -> None:
    twice = f"{GEAR}\n  H: {{type: linear, terms: {{B.theta: -5, A.theta: -2}}}}"
    one, both = (of(SHAFTS, words, SWEPT).analyze() for words in (GEAR, twice))
    for name in ("B.theta", "B.theta_ddot", "A.effort"):
        np.testing.assert_allclose(both[name], one[name], rtol=1e-13)
    found = of(SHAFTS, twice, SWEPT).mobility()
    assert (found.count, found.mobility) == (0, 1)
    assert [each.joints for each in found.redundant] == [("G", "H")]


def test_the_order_of_joints_links_and_axes_does_not_matter() -> None:
    one = of(SHAFTS, GEAR, SWEPT).analyze()
    turned = SHAFTS.replace("links: [ground, b]", "links: [b, ground]")
    other = "G: {type: gear, joints: [B, A], teeth: [50, 20], ideal: true}"
    result = of(turned, other, SWEPT.replace("value: -4", "value: 4")).analyze()
    np.testing.assert_allclose(result["B.theta"], -one["B.theta"], rtol=1e-14)
    np.testing.assert_allclose(result["A.effort"], one["A.effort"], rtol=1e-14)
    # what is told of a coupling is told of its first joint, where it takes out what it put in
    np.testing.assert_allclose(result["G.power"], -one["G.power"], rtol=1e-13)


def test_an_idler_turns_the_wheel_the_other_way_as_a_ring_does() -> None:
    """Its teeth do not matter."""
    ring = of(SHAFTS, GEAR.replace("ideal", "internal: true, ideal"), SWEPT).analyze()
    with_idler = SHAFTS.replace("joints:", "  i: {}\njoints:") + (
        "  I: {type: R, links: [ground, i], point: [0.3, 0.1]}\n"
    )
    words = "G: {type: gear, joints: [A, I], teeth: [20, 13], ideal: true}\n"
    words += "  H: {type: gear, joints: [I, B], teeth: [13, 50], ideal: true}"
    train = of(with_idler, words, SWEPT).analyze()
    for name in ("B.theta", "B.theta_dot", "A.effort"):
        np.testing.assert_allclose(train[name], ring[name], rtol=1e-13)
    np.testing.assert_allclose(ring["B.theta_dot"], 4.0, rtol=1e-14)


EPICYCLIC = (
    HEAD
    + """
links: {sun: {}, arm: {}, planet: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, arm], point: [0, 0]}
  P: {type: R, links: [arm, planet], point: [0.15, 0]}
"""
)


def test_planet_and_arm_in_a_fixed_ring() -> None:
    """Sun 18, planet 12, ring 42: the arm turns 3/10 of the sun's turn, the planet -3/4."""
    words = "K: {type: gear, joints: [S, P], teeth: [18, 12], ideal: true}\n"
    words += "  R: {type: gear, joints: [C, P], teeth: [42, 12], internal: true, ideal: true}"
    motion = "motion: {inputs: {S.theta: {from: 0, to: 50, count: 5, rate: 1 rad/s}}}\n"
    motion += "loads: [{type: torque, link: arm, torque: -7}]"
    model = of(EPICYCLIC, words, motion)
    result, sun = model.analyze(), np.linspace(0.0, 50.0, 5)
    np.testing.assert_allclose(result["C.theta"], 0.3 * sun, rtol=1e-14)
    np.testing.assert_allclose(result["P.theta"], -1.05 * sun, rtol=1e-14)
    np.testing.assert_allclose(result["planet.omega"], -0.75, rtol=1e-14)
    np.testing.assert_allclose(result["S.effort"], 0.3 * 7.0, rtol=1e-13)
    found = model.mobility()
    assert (found.count, found.mobility, found.first_order) == (1, 1, 1)


def test_a_carrier_that_no_coupling_names_may_turn_more_than_half() -> None:
    """Its turns are counted as those of the wheels: between sun and ring it turns by the mean of
    both, by their teeth."""
    ring = EPICYCLIC.replace("planet: {}}", "planet: {}, ring: {}}")
    ring += "  N: {type: R, links: [ground, ring], point: [0, 0]}\n"
    words = "K: {type: gear, joints: [S, P], teeth: [18, 12], ideal: true}\n"
    words += "  R: {type: gear, joints: [N, P], teeth: [42, 12], internal: true, ideal: true}"
    motion = "motion: {inputs: {S.theta: {from: 0, to: 90, count: 40}, N.theta: {with: S.theta/7}}}"
    result = of(ring, words, motion).analyze()
    assert set(result["row.status"]) == {"ok"}
    sun = result["S.theta"]
    np.testing.assert_allclose(result["C.theta"], (18.0 + 6.0) / 60.0 * sun, rtol=1e-13)
    np.testing.assert_allclose(result["P.theta"], 42.0 / 12.0 * (1.0 / 7.0 - 0.4) * sun, rtol=1e-13)


@pytest.mark.parametrize(("teeth", "share"), [(99, -1 / 99), (100, 0.0), (101, 1 / 101)])
def test_fergusons_paradox(teeth: int, share: float) -> None:
    """A wide planet on a fixed wheel of 100 teeth and on another of nearly as many."""
    words = "K: {type: gear, joints: [C, P], teeth: [100, 17], ideal: true}\n"
    words += f"  L: {{type: gear, joints: [S, P], teeth: [{teeth}, 17], ideal: true}}"
    motion = "motion: {inputs: {C.theta: {from: 0, to: 700, count: 3}}}"
    result = of(EPICYCLIC, words, motion).analyze()
    np.testing.assert_allclose(result["S.theta"], share * result["C.theta"], rtol=1e-11, atol=1e-12)


FREE = {
    "geared shafts": (
        ("inertia: 2", "inertia: 3", "G: {type: linear, terms: {A.theta: 2, B.theta: 1}}", 7.0),
        # 2 + 4 * 3 as one inertia
        lambda t: 7.0 / 14.0 * t * t / 2.0,
    ),
    "spun up": (
        (
            "inertia: 0.01",
            "inertia: 0.5",
            "G: {type: gear, joints: [A, B], teeth: [15, 60], ideal: true}",
            1.0,
        ),
        lambda t: t * t / 2.0 / (0.01 + 0.5 / 16.0),
    ),
}


@pytest.mark.parametrize(("given", "turn"), FREE.values(), ids=FREE.keys())
def test_shafts_free_to_move_have_the_reduced_inertia(
    given: tuple[str, str, str, float], turn: Callable[[Any], Any]
) -> None:
    one, other, words, torque = given
    shafts = SHAFTS.replace("inertia: 0.2", one).replace("inertia: 0.3", other)
    motion = "responses: {r: {start: {A.theta: 0}, time: {from: 0, to: 2, step: 0.5}, "
    motion += f"efforts: {{A.theta: {torque}}}}}}}"
    result = of(shafts, words, motion).respond("r")
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["A.theta"], turn(result["time"]), rtol=1e-9, atol=1e-12)


RACK = (
    HEAD
    + """
links:
  a: {mass: 2, center_of_mass: [0.2, 0]}
  b: {}
  s: {mass: 3, center_of_mass: [0.8, 0]}
  p: {mass: 1, center_of_mass: [0.8, 0.2], inertia: 0.5}
joints:
  O: {type: R, links: [ground, a], point: [0, 0]}
  A: {type: R, links: [a, b], point: [0.2, 0]}
  B: {type: R, links: [b, s], point: [0.8, 0]}
  S: {type: P, links: [ground, s], point: [0.8, 0], axis: [1, 0]}
  P: {type: R, links: [ground, p], point: [0.8, 0.2]}
"""
)


def test_a_pinion_on_the_slide_of_a_slider_crank() -> None:
    words = "K: {type: rack, joints: [P, S], radius: 0.2, ideal: true}"
    motion = "motion: {inputs: {O.theta: {from: 0, to: 6, count: 7, rate: 10 rad/s}}}"
    result = of(RACK, words, motion).analyze()
    theta = np.linspace(0.0, 6.0, 7)
    sine, cosine = np.sin(theta), np.cos(theta)
    rod = np.sqrt(0.36 - 0.04 * sine**2)
    slide = 0.2 * cosine + rod - 0.8
    np.testing.assert_allclose(result["S.s"], slide, atol=1e-15)
    np.testing.assert_allclose(result["P.theta"], slide / 0.2, atol=1e-14)
    # by hand: d2s/dt2 at a constant rate
    slope = -0.2 * sine - 0.04 * sine * cosine / rod
    bend = -0.2 * cosine - 0.04 * (cosine**2 - sine**2) / rod - (0.04 * sine * cosine) ** 2 / rod**3
    pinion = 0.5 * 100.0 * bend / 0.2
    np.testing.assert_allclose(result["K.torque"], pinion, rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(result["K.force"], -pinion / 0.2, rtol=1e-11, atol=1e-12)
    effort = slope * (3.0 * 100.0 * bend + pinion / 0.2)
    np.testing.assert_allclose(result["O.effort"], effort, rtol=1e-10, atol=1e-10)


def test_a_rack_on_the_other_side_turns_its_pinion_the_other_way() -> None:
    words = "K: {type: rack, joints: [P, S], radius: 0.2, at: top, ideal: true}"
    motion = "points: {top: {link: ground, at: [0.8, 0.4]}}\n"
    motion += "motion: {inputs: {O.theta: {from: 0, to: 6, count: 7}}}"
    result = of(RACK, words, motion).analyze()
    np.testing.assert_allclose(result["P.theta"], -result["S.s"] / 0.2, atol=1e-14)


FIVE_BAR = (
    HEAD
    + """
links:
  a: {mass: 2, center_of_mass: [0.5, 0], inertia: 0.1}
  b: {mass: 3, center_of_mass: [1.5, 1.5], inertia: 0.4}
  c: {mass: 1, center_of_mass: [3, 2], inertia: 0.2}
  d: {mass: 2, center_of_mass: [4, 0.5], inertia: 0.3}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [1, 0]}
  C: {type: R, links: [b, c], point: [2, 3]}
  D: {type: R, links: [d, c], point: [4, 1]}
  E: {type: R, links: [ground, d], point: [4, 0]}
motion: {inputs: {A.theta: {from: 0, to: 12, count: 7, rate: 2 rad/s, acceleration: 1 rad/s^2}}}
loads: [{type: gravity, g: [0, -9.81]}]
couplings: {G: {type: gear, joints: [A, E], teeth: [20, 30], ideal: true}}
"""
)


class FiveBar:
    """Two cranks and what hangs on them, by circles."""

    def places(self, one: mp.mpf, other: mp.mpf) -> dict[str, tuple[mp.mpc, mp.mpf]]:
        """Mass centre and turn of each link."""
        p = mp.expj(one)
        q = 4 + 1j * mp.expj(other)
        # the circles about p and q meet left of the way from p to q
        first, second, apart = mp.sqrt(10), mp.sqrt(8), abs(q - p)
        along = (first**2 - second**2 + apart**2) / (2 * apart)
        way = (q - p) / apart
        c = p + way * (along + 1j * mp.sqrt(first**2 - along**2))
        by_b, by_c = (c - p) / mp.mpc(1, 3), (c - q) / mp.mpc(-2, 2)
        return {
            "a": (0.5 * p, one),
            "b": (p + by_b * mp.mpc(0.5, 1.5), mp.arg(by_b)),
            "c": (q + by_c * mp.mpc(-1, 1), mp.arg(by_c)),
            "d": (4 + 0.5j * mp.expj(other), other),
        }

    def needed(self, theta: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        """The moments at both cranks that the motion needs, by virtual work."""
        bodies = {"a": (2, "0.1"), "b": (3, "0.4"), "c": (1, "0.2"), "d": (2, "0.3")}
        step = mp.mpf("1e-10")

        def at(t: mp.mpf) -> dict[str, tuple[mp.mpc, mp.mpf]]:
            turn = theta + 2 * t + t * t / 2
            return self.places(turn, -turn * 2 / 3)

        here, ahead, behind = at(mp.mpf(0)), at(step), at(-step)
        moments = []
        for way in ((1, 0), (0, 1)):
            moved = [
                self.places(theta + s * step * way[0], -theta * 2 / 3 + s * step * way[1])
                for s in (1, -1)
            ]
            total = mp.mpf(0)
            for name, (mass, inertia) in bodies.items():
                bend = (ahead[name][0] - 2 * here[name][0] + behind[name][0]) / step**2
                spin = (ahead[name][1] - 2 * here[name][1] + behind[name][1]) / step**2
                by = (moved[0][name][0] - moved[1][name][0]) / (2 * step)
                turned = (moved[0][name][1] - moved[1][name][1]) / (2 * step)
                pull = mass * (bend + 1j * mp.mpf("9.81"))
                total += mp.re(mp.conj(pull) * by) + mp.mpf(inertia) * spin * turned
            moments.append(total)
        return moments[0], moments[1]


def test_a_geared_five_bar() -> None:
    model = mk.loads(FIVE_BAR)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    with mp.workdps(40):
        bar = FiveBar()
        for row, theta in enumerate(np.linspace(0.0, 12.0, 7).tolist()):
            turn = mp.mpf(theta)
            places = bar.places(turn, -turn * 2 / 3)
            for link, joint in (("b", "B"),):
                relative = mp.mpf(result[f"{joint}.theta"][row]) + turn - places[link][1]
                assert abs(mp.sin(relative)) < mp.mpf("1e-14")
            at_a, at_e = bar.needed(turn)
            # the wheels share: 1 on the first crank goes with 3/2 on the other
            torque = at_e * 2 / 3
            assert result["G.torque"][row] == pytest.approx(float(torque), rel=1e-10, abs=1e-10)
            effort = at_a - torque
            assert result["A.effort"][row] == pytest.approx(float(effort), rel=1e-10, abs=1e-10)
    assert model.mobility().mobility == 1
    assert len(model.modes().modes) == 2
