"""Pendulums against elliptic functions, and a top whose mass centre rests."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from response.motions import off, respond

EXACT = 1e-11

PENDULUM = """format: 1
name: pendulum
units: {{angle: rad}}
links:
  bob: {{mass: 2, center_of_mass: [0, 0, -0.5], inertia: {{xx: 0.1, yy: 0.2, zz: 0.15}}}}
joints:
  A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 1, 0]}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
responses:
  run:
    start: {{A.theta: {angle}, A.theta_dot: {rate} rad/s}}
    time: {{from: 0, to: 4, step: 0.25}}
    tolerance: 1e-13
"""
INERTIA, PULL = mp.mpf("0.7"), mp.mpf("9.81")
"""About the pivot; m g l."""


@pytest.mark.parametrize("start", [0.1, 1.0, 2.9])
def test_a_pendulum_swings(start: float) -> None:
    """From rest: sin(theta/2) = k cd(w t), k = sin(start/2)."""
    found = respond(PENDULUM.format(angle=start, rate=0))
    with mp.workdps(40):
        w, k = mp.sqrt(PULL / INERTIA), mp.sin(mp.mpf(start) / 2)
        cd = mp.ellipfun("cd")
        angles = [2 * mp.asin(k * cd(w * mp.mpf(t), m=k * k)) for t in found["time"]]
        # theta'^2 = 4 w^2 (k^2 - sin^2(theta/2))
        squares = [4 * w * w * (k * k - mp.sin(a / 2) ** 2) for a in angles]
    # near the upright a difference grows by 40 in a swing
    assert off(found["A.theta"], angles) < (EXACT if start < 2 else 30 * EXACT)
    assert off(found["A.theta_dot"] ** 2, squares) < 100 * EXACT


def test_a_pendulum_turns_over() -> None:
    """theta = 2 am(u), u = rate t / 2, and angles count on."""
    found = respond(PENDULUM.format(angle=0, rate=9))
    with mp.workdps(40):
        m = 4 * PULL / INERTIA / 81
        dn = mp.ellipfun("dn")
        sn, cn = mp.ellipfun("sn"), mp.ellipfun("cn")
        period = mp.ellipk(m)
        angles, rates = [], []
        for t in found["time"]:
            u = mp.mpf(9) / 2 * mp.mpf(t)
            turns = mp.floor(u / (2 * period) + mp.mpf(1) / 2)
            rest = u - 2 * period * turns
            am = mp.atan2(sn(rest, m=m), cn(rest, m=m))
            angles.append(2 * (am + mp.pi * turns))
            rates.append(9 * dn(u, m=m))
    assert angles[-1] > 8 * mp.pi
    assert off(found["A.theta"], angles) < EXACT
    assert off(found["A.theta_dot"], rates) < EXACT


SPHERICAL = """format: 1
name: spherical pendulum
units: {angle: rad}
links:
  bob: {mass: 3, center_of_mass: [0, 0, -1]}
joints:
  A: {type: U, links: [ground, bob], point: [0, 0, 0], axis: [1, 0, 0], axis2: [0, 1, 0]}
points:
  bob_at: {link: bob, at: [0, 0, -1]}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
responses:
  run:
    start: {A.theta1: 0, A.theta2: 0.6, A.theta1_dot: 2.5 rad/s, A.theta2_dot: 0 rad/s}
    time: {from: 0, to: 3, step: 0.125}
    tolerance: 1e-13
"""


def spherical(
    g: mp.mpf, tilt: mp.mpf, speed: mp.mpf, times: Iterable[float]
) -> tuple[list[mp.mpf], mp.mpf]:
    """Heights of a spherical pendulum of length 1 that starts at a `speed` square to the plane of
    its tilt, and its moment of momentum h by mass: z'^2 = 2 (E - g z)(1 - z^2) - h^2
    = 2 g (z - z1)(z2 - z)(z3 - z); z = z1 + (z2 - z1) sn^2."""
    with mp.workdps(40):
        z0 = -mp.cos(tilt)
        h, energy = speed * mp.sin(tilt), speed**2 / 2 + g * z0
        roots = mp.polyroots([2 * g, -2 * energy, -2 * g, 2 * energy - h * h], maxsteps=200)
        z1, z2, z3 = sorted(mp.re(z) for z in roots)
        m, w = (z2 - z1) / (z3 - z1), mp.sqrt(g * (z3 - z1) / 2)
        sn = mp.ellipfun("sn")
        # it starts at one of its turning points
        begin = 0 if abs(z0 - z1) < abs(z0 - z2) else mp.ellipk(m)
        return [z1 + (z2 - z1) * sn(w * mp.mpf(t) + begin, m=m) ** 2 for t in times], h


def test_a_spherical_pendulum() -> None:
    found = respond(SPHERICAL)
    with mp.workdps(40):
        tilt = mp.mpf("0.6")
        # the bob moves about x at distance cos(tilt), square to the plane of its swing
        speed = mp.mpf("2.5") * mp.cos(tilt)
        heights, h = spherical(mp.mpf("9.81"), tilt, speed, found["time"])
    assert off(found["bob_at.position.z"], heights) < EXACT
    x, y = found["bob_at.position.x"], found["bob_at.position.y"]
    u, v = found["bob_at.velocity.x"], found["bob_at.velocity.y"]
    assert off(np.abs(x * v - y * u), 0 * x + abs(float(h))) < EXACT


TABLE = """format: 1
name: table on four equal parallel legs, drawn hanging
units: {{angle: rad}}
links:
  top: {{mass: 3, center_of_mass: [0, 0, -1]}}
  x: {{}}
  y: {{}}
  z: {{}}
{legs}joints:
{feet}  X: {{type: P, links: [ground, x], point: [0, 0, 0], axis: [1, 0, 0]}}
  Y: {{type: P, links: [x, y], point: [0, 0, 0], axis: [0, 1, 0]}}
  Z: {{type: P, links: [y, z], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [z, top], point: [0, 0, -1]}}
points:
  middle: {{link: top, at: [0, 0, -1]}}
  corner: {{link: top, at: [1, 0, -1]}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
responses:
  run:
    start: {{X.s: {x!r}, Y.s: 0, X.s_dot: 0, Y.s_dot: {speed!r}}}
    time: {{from: 0, to: 3, step: 0.125}}
    tolerance: 1e-13
"""


@pytest.mark.parametrize("rod", [0, 2])
@pytest.mark.parametrize(("tilt", "speed"), [("0.6", "1.3"), ("0", "2.5")])
def test_a_table_that_hangs_on_parallel_legs(tilt: str, speed: str, rod: int) -> None:
    """Drawn where families of motions meet: without a turn, its middle is a spherical pendulum.
    Slender rods have half their mass in its weight and a third in its inertia."""
    corners = {"1": (1, 1), "2": (-1, 1), "3": (-1, -1), "4": (1, -1)}
    feet = "".join(
        f"  F{k}: {{type: S, links: [ground, l{k}], point: [{x}, {y}, 0]}}\n"
        f"  H{k}: {{type: S, links: [l{k}, top], point: [{x}, {y}, -1]}}\n"
        for k, (x, y) in corners.items()
    )
    legs = "".join(
        f"  l{k}: {{mass: {rod}, center_of_mass: [{x}, {y}, -0.5], "
        f"inertia: {{xx: {rod / 12!r}, yy: {rod / 12!r}, zz: 0}}}}\n"
        if rod
        else f"  l{k}: {{}}\n"
        for k, (x, y) in corners.items()
    )
    angle, rate = mp.mpf(tilt), mp.mpf(speed)
    text = TABLE.format(legs=legs, feet=feet, x=float(mp.sin(angle)), speed=float(rate))
    found = respond(text)
    weight = mp.mpf("9.81") * (3 + 4 * mp.mpf(rod) / 2) / (3 + 4 * mp.mpf(rod) / 3)
    heights, h = spherical(weight, angle, rate, found["time"])
    assert off(found["middle.position.z"], heights) < EXACT
    x, y = found["X.s"], found["Y.s"]
    assert off(x * found["Y.s_dot"] - y * found["X.s_dot"], 0 * x + float(h)) < EXACT
    assert off(found["corner.position.x"] - x, 0 * x + 1) < EXACT


TOP = """format: 1
name: top in gimbals without mass
units: {angle: rad}
links:
  outer: {}
  inner: {}
  top: {mass: 1, center_of_mass: [0, 0, 0], inertia: {xx: 2, yy: 3, zz: 4.5}}
joints:
  A: {type: R, links: [ground, outer], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [outer, inner], point: [0, 0, 0], axis: [0, 1, 0]}
  C: {type: R, links: [inner, top], point: [0, 0, 0], axis: [1, 0, 0]}
directions:
  e1: {link: top, vector: [1, 0, 0]}
  e2: {link: top, vector: [0, 1, 0]}
  e3: {link: top, vector: [0, 0, 1]}
responses:
  run:
    start: {A.theta: 0, B.theta: 0, C.theta: 0, A.theta_dot: 2 rad/s, C.theta_dot: 1 rad/s}
    time: {from: 0, to: 6, step: 0.25}
    tolerance: 1e-13
"""


def test_a_top_without_moment() -> None:
    """Euler's equations: A cn, B sn, C dn along its own axes (Landau and Lifshitz, section 37)."""
    found = respond(TOP)
    with mp.workdps(40):
        i1, i2, i3 = map(mp.mpf, ("2", "3", "4.5"))
        a, c = mp.mpf(1), mp.mpf(2)
        energy, square = i1 * a**2 + i3 * c**2, (i1 * a) ** 2 + (i3 * c) ** 2
        rest, more = energy * i3 - square, square - energy * i1
        w = mp.sqrt((i3 - i2) * more / (i1 * i2 * i3))
        m = (i2 - i1) * rest / ((i3 - i2) * more)
        b = mp.sqrt(rest / (i2 * (i3 - i2)))
        sn, cn, dn = (mp.ellipfun(name) for name in ("sn", "cn", "dn"))
        times = [w * mp.mpf(t) for t in found["time"]]
        rates = {
            "e1": [a * cn(t, m=m) for t in times],
            "e2": [b * sn(t, m=m) for t in times],
            "e3": [c * dn(t, m=m) for t in times],
        }
    momentum: Any = 0
    for axis, inertia in (("e1", 2), ("e2", 3), ("e3", 4.5)):
        rate = found[f"dot(top.omega, {axis})"]
        assert off(rate, rates[axis]) < EXACT, axis
        momentum = momentum + inertia * rate[:, None] * found[axis]
    assert off(momentum, np.tile([2.0, 0.0, 9.0], (len(momentum), 1))) < EXACT


CART = """format: 1
name: pendulum on a cart
units: {angle: rad}
links:
  cart: {mass: 5, center_of_mass: [0, 0, 0]}
  bob: {mass: 2, center_of_mass: [0, 0, -0.5], inertia: {yy: 0.2}}
joints:
  S: {type: P, links: [ground, cart], point: [0, 0, 0], axis: [1, 0, 0]}
  A: {type: R, links: [cart, bob], point: [0, 0, 0], axis: [0, -1, 0]}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
responses:
  run:
    start: {A.theta: 0}
    driven: {S.s: {law: constant-acceleration, at: 0, rate: 1.5, acceleration: -4}}
    time: {from: 0, to: 4, step: 0.25}
    tolerance: 1e-13
"""


def test_a_pendulum_on_a_cart_that_accelerates() -> None:
    """As with gravity tilted by atan(a/g) and enlarged to sqrt(a^2 + g^2)."""
    found = respond(CART)
    t = found["time"]
    assert off(found["S.s"], 1.5 * t - 2 * t**2) < EXACT
    with mp.workdps(40):
        a, g = mp.mpf(-4), mp.mpf("9.81")
        # theta counts towards +x: it swings about the place where it hangs along the pull
        middle = mp.atan2(-a, g)
        w = mp.sqrt(mp.sqrt(a * a + g * g) * 1 / INERTIA)
        k = mp.sin(-middle / 2)
        cd = mp.ellipfun("cd")
        angles = [middle + 2 * mp.asin(k * cd(w * mp.mpf(s), m=k * k)) for s in t]
    assert off(found["A.theta"], angles) < EXACT
