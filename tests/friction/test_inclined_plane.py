"""A block on an inclined plane, free to slide in all directions of it: it curves, stops, starts."""

from __future__ import annotations

from math import cos, radians, sin, tan

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

G = 9.81
PLANE = """
format: 1
name: block on an inclined plane
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{x: {{}}, y: {{}}, block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints:
  X: {{type: P, links: [ground, x], point: [0, 0, 0], axis: [1, 0, 0]}}
  Y: {{type: P, links: [x, y], point: [0, 0, 0], axis: [0, 1, 0]}}
  Z: {{type: P, links: [y, block], point: [0, 0, 0], axis: [0, 0, 1]}}
  T: {{type: Sp, links: [block, ground], point: [0, 0, 0], normal: [{sine}, 0, {cosine}]}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
  - {{type: friction, joint: T, coefficient: {coefficient}}}
  - {{type: force, link: block, point: [0, 0, 0], force: [{force}]}}
responses:
  r: {{start: {{X.s: 0, X.s_dot: {along}, Y.s: 0, Y.s_dot: {across}}}, time: {{values: [{times}]}}}}
"""


def slid(
    slope: float,
    coefficient: str,
    times: list[float],
    speed: tuple[float, float] = (0.0, 0.0),
    force: tuple[str, str] = ("0 N", "0 N"),
) -> np.ndarray:
    """Places (2, rows), down the plane and across, under a force (down, across)."""
    text = PLANE.format(
        sine=repr(sin(slope)),
        cosine=repr(cos(slope)),
        coefficient=coefficient,
        along=repr(speed[0] * cos(slope)),
        across=repr(speed[1]),
        times=", ".join(map(repr, times)),
        force=", ".join(
            f'"{part}*({of})"'
            for part, of in ((cos(slope), force[0]), (1, force[1]), (-sin(slope), force[0]))
        ),
    )
    found = mk.loads(text).respond("r", ["X.s", "Y.s"])
    assert (found["row.status"] == "ok").all()
    assert found.result.report.evaluations < 20_000
    return np.array([found["X.s"] / cos(slope), found["Y.s"]])


def stopped(slope: float, mu: float, speed: float, angle: float) -> tuple[float, float, float]:
    """Time and place of the stop of a block that begins at an angle to the line down the plane:
    v sin(angle) / tan(angle/2)^k is constant, k = mu / tan(slope), and angle' = -g sin(slope)
    sin(angle) / v."""
    with mp.workdps(30):
        k, down = mp.mpf(mu) / mp.tan(slope), mp.mpf(G) * mp.sin(slope)
        scale = speed * mp.sin(angle) / mp.tan(mp.mpf(angle) / 2) ** k

        def v(a: mp.mpf) -> mp.mpf:
            return scale * mp.tan(a / 2) ** k / mp.sin(a)

        # by u = log(tan(angle/2)): d(angle) = sin(angle) du
        first = mp.log(mp.tan(mp.mpf(angle) / 2))

        def integral(of: str) -> float:
            def part(u: mp.mpf) -> mp.mpf:
                a = 2 * mp.atan(mp.exp(u))
                return v(a) / down * {"t": 1, "x": v(a) * mp.cos(a), "y": v(a) * mp.sin(a)}[of]

            ends = [first - mp.mpf(n) * 5 for n in range(13)] + [-mp.inf]
            return float(-mp.quad(part, ends))

        return integral("t"), integral("x"), integral("y")


@pytest.mark.parametrize("angle", [0.3, 1.2, 2.0, 2.9])
@pytest.mark.parametrize(("slope", "mu"), [(10.0, 0.6), (20.0, 0.45), (20.0, 0.8), (2.0, 0.3)])
def test_a_block_that_is_thrown_across_the_plane_stops(
    slope: float, mu: float, angle: float
) -> None:
    ends, x, y = stopped(radians(slope), mu, 3.0, angle)
    speed = (3 * cos(angle), 3 * sin(angle))
    have = slid(radians(slope), str(mu), [0.0, ends / 2, 2 * ends, 3 * ends], speed)
    assert np.abs(have[:, 2] - [x, y]).max() < 1e-10
    assert np.abs(have[:, 3] - have[:, 2]).max() == 0.0


@pytest.mark.parametrize("turned", [0.0, 0.7, 2.2, -1.3])
@pytest.mark.parametrize("coefficient", ["0.5", "{static: 0.5, sliding: 0.5}"])
def test_a_force_across_the_plane_that_grows_moves_a_block(coefficient: str, turned: float) -> None:
    """On a level plane a force 4 N/s t moves 2 kg from 4 t = mu N on, along it."""
    times = [0.1 * n for n in range(41)]
    force = (f"{4 * cos(turned)!r} N/s*time", f"{4 * sin(turned)!r} N/s*time")
    have = slid(0.0, coefficient, times, force=force)
    want = np.maximum(np.array(times) - 0.5 * 2 * G / 4, 0.0) ** 3 / 3
    assert np.abs(have - np.outer([cos(turned), sin(turned)], want)).max() < 1e-10


def test_a_block_on_a_slope_beyond_the_angle_of_friction_slides() -> None:
    slope = radians(30.0)
    have = slid(slope, "{static: 0.55, sliding: 0.4}", [0.0, 1.0, 2.0])
    along = G * cos(slope) * (tan(slope) - 0.4)
    assert np.abs(have - np.array([[0.0, along / 2, 2 * along], [0.0] * 3])).max() < 1e-10
