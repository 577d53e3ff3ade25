"""A nut that a screw raises and lowers, and a sphere in a groove, from rest and to rest."""

from __future__ import annotations

from math import atan, cos, hypot, pi, radians, sin, tan

import numpy as np
import pytest

import mechkin_cli as mk

HEAD = "format: 1\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
RADIUS, INERTIA, G = 0.01, 1e-3, 9.81
NUT = """name: nut
links: {{nut: {{mass: 1, center_of_mass: [0, 0, 0], inertia: {{xx: 0.001, yy: 0.001, zz: 0.001}}}}}}
joints: {{H: {{type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: {lead!r}}}}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
  - {{type: friction, joint: H, coefficient: {coefficient}, radius: 0.01, flank: {flank!r}}}
  - {{type: torque, joint: H, value: "{torque}"}}
responses:
  r: {{start: {{H.theta: 0, H.theta_dot: 0}}, time: {{from: 0, to: 4, count: 41}}}}
"""


class Thread:
    """A nut of 1 kg on a thread of lead per radian p and friction mu' = mu/cos(flank). It slips up
    (sense 1) or down (-1) with the torque T = load + inertia * turn''."""

    def __init__(self, p: float, mu: float) -> None:
        self.p, self.mu, self.lead_angle = p, mu, atan(p / RADIUS)

    def load(self, sense: int) -> float:
        """W r tan(lead angle +- angle of friction): Shigley, on power screws."""
        return G * RADIUS * tan(self.lead_angle + sense * atan(self.mu))

    def inertia(self, sense: int) -> float:
        """The weight of the nut and its inertia load the thread alike."""
        return INERTIA + self.p * self.load(sense) / G


def turned(p: float, mu: float, flank: float, torque: str) -> tuple[np.ndarray, np.ndarray]:
    """Turns and times."""
    text = NUT.format(lead=2 * pi * p, coefficient=mu * cos(flank), flank=flank, torque=torque)
    found = mk.loads(HEAD + text).respond("r", ["H.theta", "time"])
    assert (found["row.status"] == "ok").all()
    assert found.result.report.evaluations < 5000
    return np.array(found["H.theta"]), np.array(found["time"])


SCREWS = [(0.002, 0.3, 0.25), (0.002, 0.12, 0.0), (0.01, 0.2, 0.5)]
"""Lead per radian, mu', flank: the first locks itself."""


@pytest.mark.parametrize(("p", "mu", "flank"), SCREWS)
@pytest.mark.parametrize("sense", [1, -1])
def test_a_torque_that_grows_raises_or_lowers_a_nut(
    p: float, mu: float, flank: float, sense: int
) -> None:
    """From the torque that holds the weight without friction on, up or down by 0.1 N m/s."""
    thread = Thread(p, mu)
    have, time = turned(p, mu, flank, f"{G * p!r} N*m + {0.1 * sense!r} N*m/s*time")
    starts = sense * (thread.load(sense) - G * p) / 0.1
    assert 0 < starts < 2
    want = sense * 0.1 * np.maximum(time - starts, 0.0) ** 3 / (6 * thread.inertia(sense))
    assert np.abs(have - want).max() < 1e-10 * max(1.0, np.abs(want).max())


@pytest.mark.parametrize("sense", [1, -1])
def test_a_nut_that_locks_itself_stays_where_its_torque_ends(sense: int) -> None:
    """0.01 N m beyond what starts it, for one second, then none."""
    p, mu, flank = SCREWS[0]
    thread = Thread(p, mu)
    torque = thread.load(sense) + sense * 0.01
    have, time = turned(p, mu, flank, f"{torque / 2!r} N*m*(1 - sign(time - 1 s))")
    up = sense * 0.01 / thread.inertia(sense)
    down = -thread.load(sense) / thread.inertia(sense)
    assert up * down < 0
    late = np.clip(time - 1, 0.0, -up / down)
    want = up * np.minimum(time, 1.0) ** 2 / 2 + up * late + down * late**2 / 2
    assert np.abs(have - want).max() < 1e-10 * np.abs(want).max()
    assert np.ptp(have[-5:]) == 0.0


def test_a_nut_that_does_not_lock_runs_down_its_screw() -> None:
    p, mu, flank = SCREWS[2]
    thread = Thread(p, mu)
    have, time = turned(p, mu, flank, "0 N*m")
    assert thread.load(-1) > 0
    want = -thread.load(-1) / thread.inertia(-1) * time**2 / 2
    assert np.abs(have - want).max() < 1e-10 * np.abs(want).max()


LIGHT = """name: light nut
links: {{nut: {{mass: 1, center_of_mass: [0, 0, 0], inertia: {{xx: 1, yy: 1, zz: {inertia!r}}}}}}}
joints: {{H: {{type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: {lead!r}}}}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
  - {{type: friction, joint: H, coefficient: {mu!r}, radius: 0.01}}
  - {{type: torque, joint: H, value: {torque!r} N*m}}
responses:
  r: {{start: {{H.theta: 0, H.theta_dot: 0}}, time: {{from: 0, to: 0.01, count: 3}}}}
"""


def answers(p: float, mu: float, inertia: float, torque: float) -> tuple[bool, list[float]]:
    """Whether the nut of 1 kg may rest, and the turn'' with which it may start: with friction z
    along the thread (inertia + p^2) turn'' = torque - G p -+ z r/cos(lead angle), the normal load
    is N = N0 +- g z, and z = mu |N|."""
    angle = atan(p / RADIUS)
    arm, whole = RADIUS / cos(angle), inertia + p * p
    push = torque - G * p
    sense = np.sign(push)
    normal = (p * push / whole + G) / cos(angle)
    gain = sense * (sin(angle) - p * arm / whole) / cos(angle)
    held = abs(push) / arm
    roots = [mu * normal / (1 - mu * gain), -mu * normal / (1 + mu * gain)]
    slips = [z for z in roots if 0 <= z < held and z <= mu * abs(normal + gain * z) * (1 + 1e-9)]
    starts = [sense * (abs(push) - z * arm) / whole for z in slips]
    return held <= mu * abs(normal + gain * held), starts


@pytest.mark.parametrize("seed", range(60))
def test_a_nut_of_any_inertia_at_rest(seed: int) -> None:
    """It rests where nothing else is possible, however much friction makes of itself; it slides
    where one friction force alone loads the thread so; else several answers are true."""
    rng = np.random.default_rng(seed)
    p, mu = RADIUS * tan(rng.uniform(0.02, 0.8)), float(rng.uniform(0.05, 0.9))
    inertia = float(10 ** rng.uniform(-7, -3))
    torque = float(G * p + rng.uniform(-2, 2) * G * RADIUS * mu)
    may_rest, starts = answers(p, mu, inertia, torque)
    text = LIGHT.format(inertia=inertia, lead=2 * pi * p, mu=mu, torque=torque)
    found = mk.loads(HEAD + text).respond("r", ["H.theta", "time"])
    status, turn = str(found["row.status"][-1]), float(found["H.theta"][-1])
    if may_rest and not starts:
        assert (status, turn) == ("ok", 0.0)
    elif may_rest or len(starts) > 1:
        assert status == "friction-undecided"
    elif status == "ok":
        assert turn == pytest.approx(starts[0] * 0.01**2 / 2, rel=1e-9)
    else:
        # it goes with one friction force, but once it moves another is as good
        angle = atan(p / RADIUS)
        gain = (sin(angle) - p * RADIUS / cos(angle) / (inertia + p * p)) / cos(angle)
        assert status == "friction-undecided"
        assert mu * abs(gain) > 1


GROOVE = """name: groove
links: {{x: {{}}, y: {{}}, ball: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints:
  X: {{type: P, links: [ground, x], point: [0, 0, 0], axis: [1, 0, 0]}}
  Y: {{type: P, links: [x, y], point: [0, 0, 0], axis: [0, 1, 0]}}
  Z: {{type: P, links: [y, ball], point: [0, 0, 0], axis: [0, 0, 1]}}
  S: {{type: Sg, links: [ball, ground], point: [0, 0, 0], groove: [{x!r}, 0, {z!r}]}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
  - {{type: friction, joint: S, coefficient: 0.5}}
  - {{type: force, link: ball, point: [0, 0, 0], force: [0, 15, 0]}}
  - {{type: force, link: ball, point: [0, 0, 0], force: ["{x!r}*({force})", 0, "{z!r}*({force})"]}}
responses:
  r: {{start: {{X.s: 0, X.s_dot: {speed!r}}}, time: {{from: 0, to: 3, count: 31}}}}
"""


def grooved(slope: float, force: str, speed: float = 0.0) -> tuple[np.ndarray, np.ndarray, float]:
    """Places up the groove, times, and friction, of a ball of 2 kg that 15 N press to its side."""
    x, z = cos(slope), sin(slope)
    text = HEAD + GROOVE.format(x=x, z=z, force=force, speed=x * speed)
    found = mk.loads(text).respond("r", ["X.s", "time"])
    assert (found["row.status"] == "ok").all()
    assert found.result.report.evaluations < 5000
    return np.array(found["X.s"]) / x, np.array(found["time"]), 0.5 * hypot(2 * G * x, 15)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_force_that_grows_moves_a_ball_in_its_groove(sense: int) -> None:
    slope = radians(20)
    have, time, rubs = grooved(slope, f"{10 * sense!r} N/s*time")
    starts = (rubs + sense * 2 * G * sin(slope)) / 10
    want = sense * 10 * np.maximum(time - starts, 0.0) ** 3 / 12
    assert np.abs(have - want).max() < 1e-10


@pytest.mark.parametrize(("slope", "stays"), [(25.0, True), (50.0, False)])
def test_a_ball_thrown_up_its_groove_stops_and_stays_or_comes_back(
    slope: float, stays: bool
) -> None:
    have, time, rubs = grooved(radians(slope), "0 N", 4.0)
    weighs = 2 * G * sin(radians(slope))
    assert (rubs > weighs) == stays
    up, down = (rubs + weighs) / 2, max(weighs - rubs, 0.0) / 2
    early = np.minimum(time, 4 / up)
    want = 4 * early - up * early**2 / 2 - down * (time - early) ** 2 / 2
    assert np.abs(have - want).max() < 1e-10
