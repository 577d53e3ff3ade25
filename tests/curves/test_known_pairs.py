"""Curves and surfaces that pairs know already: a circle is a rocker's end, a line a straight
groove, a helix a thread, a sphere two balls; each against that pair, or its closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism.track import Track

HEAD = "format: 1\nunits: {length: mm}\n"
PLANE = (
    HEAD
    + """
plane: xy
links:
  crank: {mass: 0.3, center_of_mass: [3, 12], inertia: 2e-5 kg*m^2}
  coupler: {mass: 0.5, center_of_mass: [33, 40], inertia: 4e-4 kg*m^2}
"""
)
PLANE_JOINTS = """
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, coupler], point: [0, 20]}
"""
PLANE_MOTION = """
points: {P: {link: coupler, at: [30, 50]}}
loads:
  - {type: gravity, g: standard}
motion:
  inputs:
    A.theta: {from: 0, to: 360, step: 15, rate: 10 rad/s, acceleration: 30 rad/s^2, jerk: 9 rad/s^3}
responses:
  fall: {start: {A.theta: 20}, time: {from: 0, to: 0.3, step: 0.05}}
"""
WITH_ROCKER = (
    PLANE
    + "  rocker: {}"
    + PLANE_JOINTS
    + "  C: {type: R, links: [coupler, rocker], point: [60, 45]}\n"
    + "  D: {type: R, links: [rocker, ground], point: [90, 0]}"
    + PLANE_MOTION
)
ROUND_SLOTS = {
    "circle": "{center: [90, 0]}",
    "circle with its radius": "{center: [90, 0], radius: 54.083269131959838 mm}",
    "expressions": "{at: ['90 mm + r*cos(u)', 'r*sin(u)'], from: 0 deg, to: 360 deg, closed: true}",
    "at double speed": "{at: ['90 mm + r*cos(2*u)', 'r*sin(2*u)'], from: 0, to: 3.2 rad}",
    "arc": "{arc: [[90 mm + r, 0], [90, r], [90 mm - r, 1e-9]]}",
}
"""Ways to write one circle about D through C."""


def with_slot(curve: str) -> mk.Model:
    parameters = "parameters: {r: 54.083269131959838 mm}\n"
    slot = f"  D: {{type: Ps, links: [coupler, ground], point: [60, 45], curve: {curve}}}"
    return mk.loads(parameters + PLANE + PLANE_JOINTS + slot + PLANE_MOTION)


def assert_same(result: mk.Result, other: mk.Result, names: dict[str, str], limit: float) -> None:
    """Columns of a result are those of another one, in parts of the largest."""
    assert set(result["row.status"]) == {"ok"} == set(other["row.status"])
    for name, known in names.items():
        one, two = np.asarray(result[name]), np.asarray(other[known])
        assert np.abs(one - two).max() <= limit * np.abs(two).max(), name


@pytest.mark.parametrize("curve", ROUND_SLOTS.values(), ids=ROUND_SLOTS.keys())
def test_a_pin_in_a_round_slot_is_a_rocker(curve: str) -> None:
    slot, rocker = with_slot(curve), mk.loads(WITH_ROCKER)
    same = ("B.theta", "B.theta_dot", "B.theta_ddot", "B.theta_dddot", "P.acceleration", "P.jerk")
    forces = ("A.effort", "A.force", "B.force", "ground.shaking_moment")
    names = {name: name for name in (*same, *forces)} | {"D.force": "C.force"}
    assert_same(slot.analyze(), rocker.analyze(), names, 1e-12)


def test_its_motion_under_forces_is_that_of_the_rocker() -> None:
    slot, rocker = (
        m.respond("fall") for m in (with_slot("{center: [90, 0]}"), mk.loads(WITH_ROCKER))
    )
    np.testing.assert_allclose(slot["A.theta"], rocker["A.theta"], atol=1e-6)
    for name in ("A.force", "B.force"):
        largest = np.abs(rocker[name]).max()
        assert np.abs(np.asarray(slot[name]) - rocker[name]).max() < 1e-7 * largest


@pytest.mark.parametrize("curve", ["{center: [90, 0]}", ROUND_SLOTS["expressions"]])
def test_its_modes_are_those_of_the_rocker(curve: str) -> None:
    found, known = with_slot(curve).modes(), mk.loads(WITH_ROCKER).modes()
    angles = [sorted(mode.coordinates["B.theta"] for mode in each.modes) for each in (found, known)]
    np.testing.assert_allclose(*angles, atol=1e-9)


SPACE = (
    HEAD
    + """
links:
  crank: {mass: 0.2, center_of_mass: [5, 10, 2]}
  rod: {mass: 0.4, center_of_mass: [40, 30, 20], inertia: {xx: 200, yy: 300, zz: 250, xy: 20}}
"""
)
SPACE_JOINTS = """
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0.2, 1]}
  B: {type: U, links: [crank, rod], point: [0, 20, 5], axis: [0, 0.2, 1], axis2: [1, 0, 0.1]}
"""
SPACE_MOTION = """
loads: [{type: gravity, g: [0, 0, -9.81]}]
motion: {inputs: {A.theta: {from: 0, to: 30, step: 3, rate: 6 rad/s, acceleration: 9 rad/s^2}}}
"""


def test_a_sphere_in_a_round_groove_is_on_a_rocker() -> None:
    groove = (
        "  D: {type: Sg, links: [rod, ground], point: [70, 40, 10], "
        "curve: {center: [100, 0, 0], axis: [10, 0, 30]}}"
    )
    rocker = (
        "  C: {type: S, links: [rod, rocker], point: [70, 40, 10]}\n"
        "  D: {type: R, links: [rocker, ground], point: [100, 0, 0], axis: [10, 0, 30]}"
    )
    one = mk.loads(SPACE + SPACE_JOINTS + groove + SPACE_MOTION).analyze()
    other = mk.loads(SPACE + "  rocker: {}" + SPACE_JOINTS + rocker + SPACE_MOTION).analyze()
    names = ("B.theta1", "B.theta1_ddot", "B.theta2_dddot", "A.effort", "B.force", "B.moment")
    assert_same(one, other, {name: name for name in names} | {"D.force": "C.force"}, 1e-12)


def test_a_sphere_on_a_sphere_is_on_a_rod_of_balls() -> None:
    joints = """
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0.2, 1]}
  B: {type: R, links: [crank, rod], point: [0, 20, 5], axis: [1, 0, 0.1]}
"""
    ball = (
        "  D: {type: Sp, links: [rod, ground], point: [70, 40, 10], surface: {sphere: [100, 0, 0]}}"
    )
    rod = (
        "  C: {type: S, links: [rod, other], point: [70, 40, 10]}\n"
        "  D: {type: S, links: [other, ground], point: [100, 0, 0]}"
    )
    motion = SPACE_MOTION.replace("to: 30, step: 3", "to: 10, step: 2")
    one = mk.loads(SPACE + joints + ball + motion).analyze()
    other = mk.loads(SPACE + "  other: {}" + joints + rod + motion).analyze()
    names = ("B.theta", "B.theta_dot", "B.theta_ddot", "B.theta_dddot", "A.effort", "B.force")
    assert_same(one, other, {name: name for name in names} | {"D.force": "C.force"}, 1e-12)


def test_a_line_has_the_bytes_of_a_straight_groove() -> None:
    straight = "  D: {type: Sg, links: [rod, ground], point: [70, 40, 10], %s}"
    ways = ("groove: [3, 0, 4]", "curve: {line: [[40, 40, -30], [100, 40, 50]]}")
    one, other = (
        mk.loads(SPACE + SPACE_JOINTS + straight % way + SPACE_MOTION).analyze() for way in ways
    )
    for name in ("B.theta1", "D.s", "D.s_dddot", "A.effort", "B.force", "D.force"):
        assert np.asarray(one[name]).tobytes() == np.asarray(other[name]).tobytes()


def test_a_sphere_in_a_helical_groove_is_a_thread() -> None:
    """A nut on a helix of 8 mm a turn: s = p theta, torque (I + m p^2) alpha + F p."""
    text = (
        HEAD
        + """
parameters: {p: 8 mm/(360 deg)}
links:
  nut: {mass: 2, center_of_mass: [0, 0, 0], inertia: {xx: 600, yy: 600, zz: 1000}}
  pin: {}
joints:
  N: {type: C, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1]}
  R: {type: P, links: [nut, pin], point: [30, 0, 0], axis: [1, 0, 0]}
  G:
    type: Sg
    links: [pin, ground]
    point: [30, 0, 0]
    curve: {at: ['30 mm*cos(u)', '30 mm*sin(u)', 'p*u'], from: -720 deg, to: 720 deg}
loads: [{type: force, joint: N, value: -50 N}]
motion:
  inputs:
    N.theta:
      {from: 0, to: 600, step: 40, rate: 3 rad/s, acceleration: 5 rad/s^2, jerk: 7 rad/s^3}
"""
    )
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    pitch = 8.0 / (2.0 * np.pi)
    np.testing.assert_allclose(
        result["N.s"], 8.0 * np.asarray(result["N.theta"]) / 360.0, atol=1e-11
    )
    for order, rate in zip(("_dot", "_ddot", "_dddot"), (3.0, 5.0, 7.0), strict=True):
        np.testing.assert_allclose(result[f"N.s{order}"], pitch * rate, rtol=1e-11)
    lead = pitch / 1000.0
    torque = (1e-3 + 2.0 * lead * lead) * 5.0 + 50.0 * lead
    np.testing.assert_allclose(result["N.theta.effort"], 1000.0 * torque, rtol=1e-10)
    np.testing.assert_allclose(np.radians(result["N.theta"]), result["G.u"], atol=1e-12)


def test_a_piston_on_a_curved_swash_plate_follows_it() -> None:
    """On z = h cos 2u + k v^2 turned by theta, at the radius R: z = h cos 2 theta + k R^2."""
    text = (
        HEAD
        + """
links:
  plate: {}
  piston: {mass: 0.5, center_of_mass: [40, 0, 30]}
joints:
  A: {type: R, links: [ground, plate], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, piston], point: [40, 0, 0], axis: [0, 0, 1]}
  G:
    type: Sp
    links: [piston, plate]
    point: [40, 0, 9]
    surface:
      at: ['v*cos(u)', 'v*sin(u)', '5 mm*cos(2*u) + v^2/(400 mm)']
      u: [-180 deg, 180 deg]
      v: [10 mm, 80 mm]
loads: [{type: force, joint: S, value: -20 N}]
motion:
  inputs:
    A.theta:
      {from: 0, to: 170, step: 10, rate: 4 rad/s, acceleration: 6 rad/s^2, jerk: 2 rad/s^3}
"""
    )
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    theta, w, a, j = np.radians(result["A.theta"]), 4.0, 6.0, 2.0
    c, s = np.cos(2.0 * theta), np.sin(2.0 * theta)
    np.testing.assert_allclose(result["S.s"], 5.0 * (c - 1.0), atol=1e-11)
    np.testing.assert_allclose(result["S.s_dot"], -10.0 * s * w, atol=1e-10)
    second = -20.0 * c * w * w - 10.0 * s * a
    np.testing.assert_allclose(result["S.s_ddot"], second, atol=1e-9)
    third = 40.0 * s * w**3 - 60.0 * c * w * a - 10.0 * s * j
    np.testing.assert_allclose(result["S.s_dddot"], third, atol=1e-8)
    # the plate lifts the piston against its load and inertia
    force = 20.0 + 0.5 * second / 1000.0
    np.testing.assert_allclose(result["A.effort"], force * (-10.0 * s), atol=1e-9)
    # the reaction is square to the surface: along (z_u/v^2 ..., -1) at the sphere
    push = np.asarray(result["G.force"])
    np.testing.assert_allclose(np.abs(push[:, 2]), np.abs(force), rtol=1e-11)
    np.testing.assert_allclose(push[:, 0] / push[:, 2], -2.0 * 40.0 / 400.0, rtol=1e-10)
    np.testing.assert_allclose(push[:, 1] / push[:, 2], -(10.0 * s) / 40.0, atol=1e-11)


@pytest.mark.parametrize(
    ("surface", "known"),
    [
        ("{cylinder: [0, 0, 0], axis: [0, 0, 1], radius: 50}", "cylinder"),
        ("{torus: [0, 0, 0], axis: [0, 0, 1], radius: 40, tube: 10}", "torus"),
    ],
)
def test_a_rod_on_a_round_surface_keeps_its_distance(surface: str, known: str) -> None:
    text = (
        HEAD
        + f"""
links: {{arm: {{}}, rod: {{}}}}
joints:
  A: {{type: R, links: [ground, arm], point: [90, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [arm, rod], point: [80, 10, 30], axis: [0, 1, 0]}}
  G: {{type: Sp, links: [rod, ground], point: [50, 0, 0], surface: {surface}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 10, step: 2}}}}}}
"""
    )
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    x, y, z = np.asarray(result["G.point"]).T
    far = np.hypot(x, y)
    expected = 50.0 if known == "cylinder" else 40.0 + np.sqrt(100.0 - z * z)
    np.testing.assert_allclose(far, expected, atol=1e-10)


@pytest.mark.parametrize(
    ("surface", "foot"),
    [
        ("sphere: [0, 0, 0], radius: 50", (30.0, 0.0, 40.0)),
        ("cylinder: [0, 0, 0], axis: [0, 1, 0], radius: 50", (30.0, 7.0, 40.0)),
        ("torus: [0, 0, 0], radius: 60, tube: 50", (90.0, 0.0, 40.0)),
    ],
)
def test_the_place_on_a_surface_nearest_to_the_drawing_is_found_at_once(
    surface: str, foot: tuple[float, float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A sphere drawn off the surface, which a vertical slide then carries onto it: the search
    looks at places by rows, and develops few of them into series."""
    developed = 0
    orders = Track.orders

    def counted(track: Track, *arguments: Any, **more: Any) -> Any:
        nonlocal developed
        developed += 1
        return orders(track, *arguments, **more)

    monkeypatch.setattr(Track, "orders", counted)
    x, y, z = (1.2 * a if surface.startswith("sphere") else a for a in foot)
    text = f"""
links: {{rod: {{}}}}
joints:
  A: {{type: P, links: [ground, rod], point: [0, 0, 0], axis: {list(foot)}}}
  G: {{type: Sp, links: [rod, ground], point: [{x}, {y}, {z}], surface: {{{surface}}}}}
assembly: {{near: {{A.s: 0}}}}
"""
    result = mk.loads(HEAD + text).analyze()
    assert developed < 100
    np.testing.assert_allclose(result["G.point"][0], foot, atol=1e-9)
