"""Rest at limits while other freedoms move on: slides and pendulums by closed forms and by their
equations of motion, integrated apart."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from limits.machines import TOGETHER
from scipy.optimize import nnls

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.response import ResponseResult
from mechkin_cli.response.impacts import complementary

CROSS = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  carriage: {{mass: 3, center_of_mass: [0, 0]}}
  block: {{mass: 2, center_of_mass: [0, 0]}}
joints:
  X: {{type: P, links: [ground, carriage], point: [0, 0], axis: [1, 0]}}
  Y: {{type: P, links: [carriage, block], point: [0, 0], axis: [0, 1]}}
loads: [{{type: gravity, g: [0, -10]}}]
limits: {{Y.s: {{min: -2, restitution: {e!r}}}{more}}}
responses:
  fall:
    start: {{X.s: 0, X.s_dot: {rate!r}, Y.s: 0}}
    efforts: {{{efforts}}}
    time: {{from: 0, to: 4, step: 0.1}}
"""


def cross(e: float, *, rate: float = 0.0, efforts: str = "X.s: 5", more: str = "") -> mk.Analysis:
    """A block on a slide that a carriage carries along another."""
    text = CROSS.format(e=e, rate=rate, efforts=efforts, more=more)
    return mk.loads(text).respond("fall")


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_a_block_lies_on_its_limit_while_its_carriage_goes_on(e: float) -> None:
    rows = cross(e, rate=0.3)
    time = rows["time"]
    assert time[-1] == 4.0
    np.testing.assert_allclose(rows["X.s"], 0.3 * time + 0.5 * time**2, atol=1e-9)
    rests = time > sqrt(0.4) * (1.0 + 2.0 * e / (1.0 - e)) + 1e-3
    np.testing.assert_allclose(rows["Y.s"][rests], -2.0, atol=1e-11)
    assert (rows["Y.s_dot"][rests] == 0.0).all()
    np.testing.assert_allclose(rows["Y.effort"][rests], 20.0, rtol=1e-12)
    np.testing.assert_allclose(rows["X.force"][rests, 1], 50.0, rtol=1e-12)
    assert set(rows["row.status"]) == {"ok"}
    assert np.nanmax(rows["row.energy_error"]) < 1e-9


def test_two_limits_hold_and_one_lets_go() -> None:
    # the carriage comes to rest at 1 m; a force that rises by 20 N/s lifts the block at 20 N
    rows = cross(
        0.0,
        efforts='X.s: 5, Y.s: "20 N*max(0, time/(1 s) - 2)"',
        more=", X.s: {max: 1, restitution: 0}",
    )
    time = rows["time"]
    both = (time > sqrt(2.0)) & (time < 3.0 - 1e-9)
    np.testing.assert_allclose(rows["X.s"][both], 1.0, atol=1e-11)
    np.testing.assert_allclose(rows["X.effort"][both], 0.0, atol=1e-11)
    np.testing.assert_allclose(rows["Y.effort"][both], 20.0, rtol=1e-12)
    np.testing.assert_allclose(rows["X.force"][both, 1], 50.0, rtol=1e-12)
    off = time > 3.0 + 1e-9
    np.testing.assert_allclose(rows["X.s"][off], 1.0, atol=1e-11)
    expected = -2.0 + 10.0 * (time[off] - 3.0) ** 3 / 6.0
    np.testing.assert_allclose(rows["Y.s"][off], expected, atol=1e-9)
    np.testing.assert_allclose(rows["Y.effort"][off], 20.0 * (time[off] - 2.0), rtol=1e-12)


ELBOW = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  upper: {mass: 2, center_of_mass: [0, -0.5], inertia: 0.2}
  lower: {mass: 1, center_of_mass: [0, -1.4], inertia: 0.05}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0]}
  B: {type: R, links: [upper, lower], point: [0, -1]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: torque, joint: B, value: "TORQUE"}
limits: {B.theta: {max: 0.8, restitution: 0}}
"""


def pendulum(place: np.ndarray, rates: np.ndarray, torque: float) -> tuple[np.ndarray, np.ndarray]:
    """Inertia and forces of the double pendulum by A.theta and B.theta."""
    lower, arm, g = 0.05 + 0.16, 0.4, 9.81
    upper, elbow = 0.2 + 2 * 0.25 + 1.0, float(place[1])
    coupled = lower + arm * cos(elbow)
    inertia = np.array([[upper + 2 * arm * cos(elbow) + lower, coupled], [coupled, lower]])
    a, b = rates
    whole = float(place[0]) + elbow
    curved = arm * sin(elbow)
    forces = np.array(
        [
            curved * (2 * a * b + b * b) - g * (2.0 * sin(place[0]) + arm * sin(whole)),
            -curved * a * a - g * arm * sin(whole) + torque,
        ]
    )
    return inertia, forces


def stepped(place: np.ndarray, rates: np.ndarray, time: float, to: float, torque, held: bool):
    """The double pendulum by Runge and Kutta's method, its elbow held or not."""
    steps = max(1, int(np.ceil((to - time) / 1e-3)))
    h = (to - time) / steps

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        inertia, forces = pendulum(y[:2], y[2:], torque(t))
        second = np.array([forces[0] / inertia[0, 0], 0.0])
        if not held:
            second = np.linalg.solve(inertia, forces)
        return np.concatenate([y[2:], second])

    y = np.concatenate([place, rates])
    for k in range(steps):
        t = time + k * h
        a = slope(t, y)
        b = slope(t + h / 2, y + h / 2 * a)
        c = slope(t + h / 2, y + h / 2 * b)
        d = slope(t + h, y + h * c)
        y = y + h / 6 * (a + 2 * b + 2 * c + d)
    return y[:2], y[2:]


def contact(place: np.ndarray, rates: np.ndarray, torque: float) -> float:
    """The moment of the stop on the lower arm while the elbow rests."""
    inertia, forces = pendulum(place, rates, torque)
    return inertia[1, 0] * forces[0] / inertia[0, 0] - forces[1]


def test_an_elbow_rests_at_its_stop_while_the_arm_swings_and_leaves_it() -> None:
    run = (
        "responses: {swing: {start: {A.theta: 0.9, B.theta: 0.3, B.theta_dot: 3}, "
        "time: {from: 0, to: 3, step: 0.01}}}\n"
    )
    law = "20 N*m*(1 - time/(2 s))"
    rows = mk.loads(ELBOW.replace("TORQUE", law) + run).respond("swing")
    result = rows.result
    assert isinstance(result, ResponseResult)
    assert rows["time"][-1] == 3.0
    first = result.impacts[0]
    assert first.rests

    def torque(t: float) -> float:
        return 20.0 * (1.0 - t / 2.0)

    time = rows["time"]
    angles = np.column_stack([rows["A.theta"], rows["B.theta"]])
    rates = np.column_stack([rows["A.theta_dot"], rows["B.theta_dot"]])
    begin = int(np.flatnonzero(time > first.time)[0])
    place, moving = angles[begin], rates[begin]
    assert place[1] == pytest.approx(0.8, abs=1e-11)
    assert moving[1] == 0.0
    k, left = begin, None
    while contact(place, moving, torque(time[k])) < 0.0:
        np.testing.assert_allclose(angles[k], place, atol=1e-9)
        np.testing.assert_allclose(rates[k], moving, atol=1e-9)
        effort = contact(place, moving, torque(time[k]))
        assert rows["B.effort"][k] == pytest.approx(effort, rel=1e-8, abs=1e-8)
        start = place, moving, float(time[k])
        place, moving = stepped(*start, float(time[k + 1]), torque, held=True)
        k += 1
    # where the stop would pull, by bisection
    low, high = start[2], float(time[k])
    for _ in range(60):
        left = 0.5 * (low + high)
        there = stepped(*start, left, torque, held=True)
        low, high = (left, high) if contact(*there, torque(left)) < 0.0 else (low, left)
    there = stepped(*start, high, torque, held=True)
    assert k - begin > 20
    for row in range(k, min(k + 20, len(time))):
        place, moving = stepped(*there, high, float(time[row]), torque, held=False)
        np.testing.assert_allclose(angles[row], place, atol=1e-8)
        np.testing.assert_allclose(rates[row], moving, atol=1e-7)
        assert rows["B.effort"][row] == 0.0
    assert np.nanmax(rows["row.energy_error"]) < 1e-8


def test_a_pendulum_lies_at_its_stop_on_a_driven_carriage() -> None:
    # the carriage oscillates: x = 0.2 m sin(2 pi t/(1 s)); at the stop of 0.3 rad the moment is
    # m l (x'' cos + g sin), taken while it pushes the bob down
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  carriage: {mass: 3, center_of_mass: [0, 0]}
  bob: {mass: 2, center_of_mass: [0, -0.5]}
joints:
  X: {type: P, links: [ground, carriage], point: [0, 0], axis: [1, 0]}
  T: {type: R, links: [carriage, bob], point: [0, 0]}
loads: [{type: gravity, g: [0, -10]}]
limits: {T.theta: {min: 0.3, restitution: 0}}
responses:
  shaken:
    start: {T.theta: 0.3}
    driven: {X.s: {law: sine, amplitude: 0.2, frequency: 1 Hz}}
    time: {from: 0, to: 1, step: 0.02}
"""
    rows = mk.loads(text).respond("shaken")
    time = rows["time"]
    second = -0.2 * 4.0 * pi**2 * np.sin(2.0 * pi * time)
    moment = 2.0 * 0.5 * (second * cos(0.3) + 10.0 * sin(0.3))
    # x'' = -g tan(0.3)
    leaves = np.arcsin(10.0 * np.tan(0.3) / (0.2 * 4.0 * pi**2)) / (2.0 * pi)
    rests = time < leaves - 1e-9
    assert rests.sum() > 2
    np.testing.assert_allclose(rows["T.effort"][rests], moment[rests], rtol=1e-11)
    np.testing.assert_allclose(rows["T.theta"][rests], 0.3, atol=1e-12)
    pushed = 5.0 * second + 0.0
    np.testing.assert_allclose(rows["X.effort"][rests], pushed[rests], atol=1e-10)
    swings = (time > leaves) & (time < leaves + 0.2)
    assert (rows["T.theta"][swings] > 0.3).all()
    assert (rows["T.effort"][swings] == 0.0).all()
    assert time[-1] == 1.0
    assert np.nanmax(rows["row.energy_error"]) < 1e-8


FIVE_BAR = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 1, center_of_mass: [0.1, 0.3], inertia: 0.02}
  two: {mass: 2, center_of_mass: [0.6, 0.8], inertia: 0.1}
  three: {mass: 1.5, center_of_mass: [1.3, 0.8], inertia: 0.1}
  four: {mass: 1, center_of_mass: [1.7, 0.3], inertia: 0.02}
joints:
  A: {type: R, links: [ground, one], point: [0, 0]}
  B: {type: R, links: [one, two], point: [0.2, 0.6]}
  C: {type: R, links: [two, three], point: [1, 1]}
  D: {type: R, links: [three, four], point: [1.6, 0.6]}
  E: {type: R, links: [ground, four], point: [1.8, 0]}
points:
  p: {link: one, at: [0.1, 0.3]}
  q: {link: two, at: [0.6, 0.8]}
  r: {link: three, at: [1.3, 0.8]}
  s: {link: four, at: [1.7, 0.3]}
loads: [{type: gravity, g: [0, -9.81]}]
"""
PARTS = {"one": (1.0, 0.02), "two": (2.0, 0.1), "three": (1.5, 0.1), "four": (1.0, 0.02)}


@pytest.mark.parametrize("joint", ["A", "B", "C", "D", "E"])
def test_a_five_bar_rests_on_a_limit_of_any_of_its_joints(joint: str) -> None:
    pins = {"A": (None, 0), "B": (0, 1), "C": (1, 2), "D": (2, 3), "E": (None, 3)}
    falls = mk.loads(
        FIVE_BAR + "responses: {f: {start: {A.theta: 0, E.theta: 0}, time: {values: [0, 0.1]}}}\n"
    ).respond("f")[f"{joint}.theta"][1]
    bound = f"{{{'max' if falls > 0 else 'min'}: {float(falls)!r}, restitution: 0}}"
    start = "{start: {A.theta: 0, E.theta: 0}, time: {from: 0, to: 0.2, step: 0.02}}"
    text = f"{FIVE_BAR}limits: {{{joint}.theta: {bound}}}\nresponses: {{f: {start}}}\n"
    centres = [f"{name}.acceleration" for name in "pqrs"]
    spins = [f"{name}.alpha" for name in PARTS]
    rows = mk.loads(text).respond("f")
    k = len(rows["time"]) - 1
    assert rows["time"][k] == pytest.approx(0.2)
    assert rows[f"{joint}.theta"][k] == pytest.approx(falls, abs=1e-11)
    # the balance of all bodies: the forces of pins and the moment of the limit as multipliers
    places = [rows[f"{name}.position"][k] for name in "pqrs"]
    accelerations = np.concatenate(
        [[*rows[a][k], float(rows[w][k])] for a, w in zip(centres, spins, strict=True)]
    )
    columns = []
    for name, bodies in pins.items():
        for axis in range(2):
            column = np.zeros(12)
            for body, sign in zip(bodies, (-1.0, 1.0), strict=True):
                if body is not None:
                    arm = rows[f"{name}.point"][k] - places[body]
                    column[3 * body + axis] = sign
                    column[3 * body + 2] = sign * (-arm[1] if axis == 0 else arm[0])
            columns.append(column)
    moment = np.zeros(12)
    for body, sign in zip(pins[joint], (-1.0, 1.0), strict=True):
        if body is not None:
            moment[3 * body + 2] = sign
    columns.append(moment)
    masses = np.concatenate([[m, m, i] for m, i in PARTS.values()])
    weights = np.concatenate([[0.0, -9.81 * m, 0.0] for m, _ in PARTS.values()])
    system = np.array(columns).T
    solved, *_ = np.linalg.lstsq(system, masses * accelerations - weights, rcond=None)
    missing = system @ solved - (masses * accelerations - weights)
    np.testing.assert_allclose(missing, 0.0, atol=1e-8)
    found = [float(rows[f"{name}.force"][k, axis]) for name in pins for axis in range(2)]
    np.testing.assert_allclose([*found, rows[f"{joint}.effort"][k]], solved, rtol=1e-8, atol=1e-8)
    assert solved[-1] * falls < 0.0
    assert np.nanmax(rows["row.energy_error"]) < 1e-8


class Stops:
    """The double pendulum between stops without restitution, by the equations of motion with the
    forces of stops as multipliers: every set of them is tried, and the one kept whose forces push
    and beyond which nothing goes."""

    def __init__(self, ends: np.ndarray, torque: np.ndarray) -> None:
        self.ends, self.torque = ends, torque

    def forces(self, place: np.ndarray, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        inertia, forces = pendulum(place, rates, float(self.torque[1]))
        return inertia, forces + np.array([self.torque[0], 0.0])

    def touched(self, place: np.ndarray) -> list[tuple[int, float]]:
        found = []
        for k in range(2):
            found += [(k, -1.0)] if place[k] < self.ends[k, 0] + 1e-9 else []
            found += [(k, 1.0)] if place[k] > self.ends[k, 1] - 1e-9 else []
        return found

    def solve(self, inertia: np.ndarray, change: np.ndarray, touched: list) -> tuple:
        """The change behind the pushes of stops, which allows no outward one, and who pushes."""
        for chosen in range(1 << len(touched)):
            own = [one for k, one in enumerate(touched) if chosen >> k & 1]
            if len({k for k, _ in own}) < len(own):
                continue
            normals = np.zeros((len(own), 2))
            for row, (k, side) in enumerate(own):
                normals[row, k] = side
            inverse = np.linalg.inv(inertia)
            pushes = np.linalg.solve(normals @ inverse @ normals.T, normals @ change)
            after = change - inverse @ normals.T @ pushes
            if (pushes >= 0).all() and all(s * after[k] <= 1e-11 for k, s in touched):
                return after, own
        raise AssertionError("no set of stops")

    def run(self, place: np.ndarray, rates: np.ndarray, times: np.ndarray) -> np.ndarray:
        now, rows, y = 0.0, [], np.concatenate([place, rates])
        held = self.begin(y)
        for to in times:
            while now < to:
                step = min(2e-3, to - now)
                after = self.step(y, held, step)
                if self.broken(after, held):
                    low, high = 0.0, step
                    for _ in range(50):
                        middle = 0.5 * (low + high)
                        bad = self.broken(self.step(y, held, middle), held)
                        low, high = (low, middle) if bad else (middle, high)
                    y, now = self.step(y, held, high), now + high
                    held = self.begin(y)
                else:
                    y, now = after, now + step
            rows.append(y.copy())
        return np.array(rows)

    def begin(self, y: np.ndarray) -> list:
        """Impacts at what is touched, whose rates `y` then has; and who is held from there on."""
        touched = self.touched(y[:2])
        inertia, _ = self.forces(y[:2], y[2:])
        y[2:], _ = self.solve(inertia, y[2:], touched)
        still = [(k, s) for k, s in touched if abs(y[2 + k]) < 1e-10]
        inertia, forces = self.forces(y[:2], y[2:])
        return self.solve(inertia, np.linalg.solve(inertia, forces), still)[1]

    def step(self, y: np.ndarray, held: list, h: float) -> np.ndarray:
        def slope(y: np.ndarray) -> np.ndarray:
            return np.concatenate([y[2:], self.second(y, held)[0]])

        a = slope(y)
        b = slope(y + h / 2 * a)
        c = slope(y + h / 2 * b)
        return y + h / 6 * (a + 2 * b + 2 * c + slope(y + h * c))

    def second(self, y: np.ndarray, held: list) -> tuple[np.ndarray, np.ndarray]:
        inertia, forces = self.forces(y[:2], y[2:])
        system = np.zeros((2 + len(held), 2 + len(held)))
        system[:2, :2] = inertia
        for row, (k, side) in enumerate(held, 2):
            system[row, k] = system[k, row] = side
        solved = np.linalg.solve(system, np.concatenate([forces, np.zeros(len(held))]))
        return solved[:2], solved[2:]

    def broken(self, y: np.ndarray, held: list) -> bool:
        pulls = (self.second(y, held)[1] < 0.0).any()
        free = [k for k in range(2) if k not in [one for one, _ in held]]
        return pulls or any(y[k] < self.ends[k, 0] or y[k] > self.ends[k, 1] for k in free)


@pytest.mark.parametrize("seed", range(8))
def test_arms_between_stops_rest_and_leave_as_all_choices_of_stops_say(seed: int) -> None:
    random = np.random.default_rng(seed)
    low, high = random.uniform(-0.7, -0.2, 2), random.uniform(0.2, 0.7, 2)
    rates, torque = random.uniform(-3, 3, 2), random.uniform(-1, 1, 2) * [30, 8]
    times = np.arange(1, 31) * 0.05
    apart = Stops(np.column_stack([low, high]), torque)
    expected = apart.run(np.zeros(2), rates, times)
    limits = ", ".join(
        f"{name}.theta: {{min: {a!r}, max: {b!r}, restitution: 0}}"
        for name, a, b in zip("AB", low.tolist(), high.tolist(), strict=True)
    )
    loads = "".join(
        f"  - {{type: torque, joint: {name}, value: {value!r}}}\n"
        for name, value in zip("AB", torque.tolist(), strict=True)
    )
    first = ", ".join(
        f"{name}.theta: 0, {name}.theta_dot: {value!r}"
        for name, value in zip("AB", rates.tolist(), strict=True)
    )
    run = f"responses: {{s: {{start: {{{first}}}, time: {{from: 0, to: 1.5, step: 0.05}}}}}}\n"
    head = ELBOW.partition("  - {type: torque")[0]
    rows = mk.loads(f"{head}{loads}limits: {{{limits}}}\n{run}").respond("s")
    names = ("A.theta", "B.theta", "A.theta_dot", "B.theta_dot")
    found = np.column_stack([rows[name][1:] for name in names])
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, atol=2e-7)
    result = rows.result
    assert isinstance(result, ResponseResult)
    assert result.impacts
    assert np.nanmax(rows["row.energy_error"]) < 1e-7


def test_a_carriage_rubs_by_what_lies_on_its_limit() -> None:
    rubs = "loads: [{type: friction, joint: X, coefficient: 0.1}, "
    text = CROSS.format(e=0.0, rate=6.0, efforts="", more="").replace("loads: [", rubs)
    rows = mk.loads(text.replace("    efforts: {}\n", "")).respond("fall")
    time, at = rows["time"], sqrt(0.4)
    # both masses are 5 kg; the carriage bears 30 N, and 50 N from the impact on
    expected = np.where(time < at, 6.0 - 0.6 * time, 6.0 - 0.6 * at - (time - at))
    np.testing.assert_allclose(rows["X.s_dot"], expected, atol=1e-9)
    np.testing.assert_allclose(np.abs(rows["X.normal_load"][time > at]), 50.0, rtol=1e-11)
    assert set(rows["row.status"]) == {"ok"}


def together(one: float | None, other: float | None, more: str = "") -> mk.Analysis:
    """Two blocks that a coupling lets fall as one, each to a limit of its own at the same place."""
    words = ["" if e is None else f", restitution: {e}" for e in (one, other)]
    text = TOGETHER.format(one=words[0], other=words[1]).replace("MORE", more)
    return mk.loads(text).respond("fall")


@pytest.mark.parametrize(("one", "other"), [(0.0, 0.0), (0.5, 0.5), (0.5, 0.2), (0.2, 0.5)])
def test_limits_that_end_one_freedom_share_their_force(one: float, other: float) -> None:
    """Both stop 5 kg; the one that throws off faster gives the impulse, equal ones share it in
    parts that nothing determines. At rest either may bear them, until a force of 50 N lifts."""
    rows = together(one, other)
    time, e = rows["time"], max(one, other)
    falls = sqrt(0.4)
    rests = falls * (1.0 + 2.0 * e / (1.0 - e))
    up = falls * (1.0 + 2.0 * e)
    expected = -5.0 * time**2
    first = (time > falls) & (time < up)
    since = time - falls
    expected[first] = -2.0 + (e * sqrt(40.0) * since - 5.0 * since**2)[first]
    held = (time > rests + 1e-3) & (time < 6.5)
    expected[held] = -2.0
    lifted = time > 6.5 + 1e-9
    expected[lifted] = -2.0 + (4.0 * (time - 6.5) ** 3 / 6.0)[lifted]
    sure = (time < up) | held | lifted
    for name in ("S.s", "T.s"):
        np.testing.assert_allclose(rows[name][sure], expected[sure], atol=1e-9)
    np.testing.assert_allclose(rows["X.s"], 0.5 * time, atol=1e-11)
    for name in ("S.effort", "T.effort", "K.force"):
        assert np.isnan(rows[name][held]).all()
        assert np.isfinite(rows[name][time < falls]).all()
    # what the bed bears does not depend on who bears the blocks
    np.testing.assert_allclose(rows["X.force"][held, 1], 60.0, rtol=1e-11)
    np.testing.assert_allclose(rows["S.effort"][lifted], 20.0 * (time[lifted] - 4.0), rtol=1e-12)
    assert set(rows["row.status"]) == {"ok"}
    assert np.nanmax(rows["row.energy_error"]) < 1e-9
    table = rows.impacts
    assert table is not None
    columns = {column.label: column.values for column in table.columns}
    own, its = (np.asarray(columns[f"{name}.s.impulse"])[0] for name in "ST")
    if one == other:
        assert np.isnan([own, its]).all()
    else:
        impulse = 5.0 * sqrt(40.0) * (1.0 + e)
        assert [own, its] == pytest.approx([impulse, 0.0] if one > other else [0.0, impulse])
    assert any("how they share it is not unique" in d.message for d in rows.diagnostics)


@pytest.mark.parametrize(
    ("one", "other", "more"),
    [
        (0.5, None, ""),
        (None, 0.5, ""),
        (0.0, 0.0, ", {type: friction, joint: S, coefficient: 0.1}"),
    ],
)
def test_shared_limits_that_end_the_response(
    one: float | None, other: float | None, more: str
) -> None:
    """One of them has no restitution; or friction goes by forces that are not unique."""
    rows = together(one, other, more)
    assert rows["time"][-1] == pytest.approx(sqrt(0.4), rel=1e-9)
    assert "at its limit" in rows["row.event"][-1]


@pytest.mark.parametrize("seed", range(60))
def test_which_limits_push_where_some_end_one_freedom(seed: int) -> None:
    """The change of the rates is that of least energy without an outward one, by a solver for least
    squares with signs."""
    random = np.random.default_rng(seed)
    freedoms, limits = int(random.integers(1, 4)), int(random.integers(1, 6))
    normals = random.normal(size=(limits, freedoms))
    for k in range(1, limits):
        if random.random() < 0.5:
            normals[k] = random.uniform(0.5, 2.0) * normals[k - 1] * random.choice([1.0, 1.0, -1.0])
    rates = random.normal(size=freedoms)
    matrix, outward = normals @ normals.T, normals @ rates
    found = complementary(matrix.tolist(), outward.tolist(), outward.tolist())
    wanted, _ = nnls(normals.T, rates)
    assert found is not None
    own = dict(zip(found.numbers, found.sizes, strict=True))
    for pushes in (own, *found.others):
        every = np.array([pushes.get(k, 0.0) for k in range(limits)])
        assert every.min() >= 0.0
        np.testing.assert_allclose(normals.T @ every, normals.T @ wanted, atol=1e-9)
    # those that a push of another one moves, too, are not unique
    pushing = [k for k in range(limits) if abs(outward - matrix @ wanted)[k] < 1e-9]
    rank = np.linalg.matrix_rank(normals[pushing], tol=1e-9) if pushing else 0
    if own and rank < len(pushing):
        assert found.others
    if rank == len(pushing):
        assert not found.others


def test_rests_are_the_same_bits_in_any_lanes() -> None:
    text = CROSS.format(e=0.5, rate=0.3, efforts="X.s: 5", more="")
    one = mk.loads(text).respond("fall", ["X.s", "Y.effort"], lanes=2)
    for lanes in widths():
        other = mk.loads(text).respond("fall", ["X.s", "Y.effort"], lanes=lanes)
        for name in ("X.s", "Y.effort"):
            assert one[name].tobytes() == other[name].tobytes()


def chatter(seed: int) -> mk.Analysis:
    """Arms that torques press to stops with restitution."""
    random = np.random.default_rng(seed)
    low, high = random.uniform(-0.7, -0.2, 2), random.uniform(0.2, 0.7, 2)
    rates, torque = random.uniform(-3, 3, 2), random.uniform(-1, 1, 2) * [30, 8]
    bounce = random.uniform(0, 0.8, 2)
    columns = (low.tolist(), high.tolist(), bounce.tolist(), torque.tolist(), rates.tolist())
    limits, loads, first = [], "", []
    for name, a, b, e, push, rate in zip("AB", *columns, strict=True):
        limits.append(f"{name}.theta: {{min: {a!r}, max: {b!r}, restitution: {e!r}}}")
        loads += f"  - {{type: torque, joint: {name}, value: {push!r}}}\n"
        first.append(f"{name}.theta: 0, {name}.theta_dot: {rate!r}")
    run = f"{{start: {{{', '.join(first)}}}, time: {{from: 0, to: 2, step: 0.02}}}}"
    head = ELBOW.partition("  - {type: torque")[0]
    tail = f"limits: {{{', '.join(limits)}}}\nresponses: {{s: {run}}}\n"
    return mk.loads(head + loads + tail).respond("s")


@pytest.mark.parametrize("seed", [7, 37, 43, 74])
def test_arms_that_throw_each_other_off_their_stops_settle_at_both(seed: int) -> None:
    rows = chatter(seed)
    torque = (np.random.default_rng(seed).uniform(size=8)[6:] * 2.0 - 1.0) * [30, 8]
    assert rows["time"][-1] == 2.0
    assert set(rows["row.status"]) == {"ok"}
    names = ("A.theta", "B.theta", "A.theta_dot", "B.theta_dot", "A.theta_ddot", "B.theta_ddot")
    columns = np.column_stack([rows[name] for name in names])
    efforts = np.column_stack([rows["A.effort"], rows["B.effort"]])
    assert (efforts != 0.0).any()
    for row, effort in zip(columns, efforts, strict=True):
        inertia, forces = pendulum(row[:2], row[2:4], float(torque[1]))
        forces = forces + np.array([torque[0], 0.0])
        np.testing.assert_allclose(inertia @ row[4:], forces + effort, atol=1e-9)


@pytest.mark.parametrize("plane", [True, False])
def test_a_boom_comes_to_rest_on_its_cylinder(plane: bool) -> None:
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {boom: {mass: 10, center_of_mass: [0.5, 0], inertia: 1}}
joints: {O: {type: R, links: [ground, boom], point: [0, 0]}}
points:
  P: {link: ground, at: [0.3, -0.8]}
  Q: {link: boom, at: [0.6, 0]}
cylinders: {C: {from: P, to: Q, bore: 50 mm, rod: 28 mm}}
loads: [{type: gravity, g: [0, -9.81]}]
limits: {C.s: {min: 0.7, restitution: 0.3}}
responses: {r: {start: {O.theta: 0}, time: {from: 0, to: 1, step: 0.02}}}
"""
    if not plane:
        text = text.replace("plane: xy\n", "").replace("inertia: 1", "inertia: {zz: 1}")
        for place in ("0.5, 0", "point: [0, 0", "0.3, -0.8", "0.6, 0", "0, -9.81"):
            text = text.replace(f"{place}]", f"{place}, 0]")
        text = text.replace("0, 0, 0]}}", "0, 0, 0], axis: [0, 0, 1]}}")
    rows = mk.loads(text).respond("r")
    turn, length = rows["O.theta"][-1], rows["C.s"][-1]
    # the law of cosines, and the lever of the cylinder's force about the pin
    way = np.array([0.6 * cos(turn) - 0.3, 0.6 * sin(turn) + 0.8])
    assert length == pytest.approx(0.7, abs=1e-11)
    assert np.hypot(*way) == pytest.approx(0.7, abs=1e-11)
    lever = (0.6 * cos(turn) * way[1] - 0.6 * sin(turn) * way[0]) / 0.7
    force = 10 * 9.81 * 0.5 * cos(turn) / lever
    assert rows["C.effort"][-1] == pytest.approx(force, rel=1e-10)
    assert set(rows["row.status"]) == {"ok"}
    assert np.nanmax(rows["row.energy_error"]) < 1e-9


RUBBING = """
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{m: {{mass: 1, center_of_mass: [0, 0]}}{link}}}
joints:
  S: {{type: P, links: [ground, m], point: [0, 0], axis: [1, 0]}}
{joint}loads:
  - {{type: gravity, g: [0, -10]}}
  - {{type: force, joint: S, value: "5 N - 10 N/s*time"}}
  - {{type: friction, joint: S, coefficient: 0.1}}
limits: {{S.s: {{max: 0.1, restitution: 0}}}}
responses: {{r: {{start: {{S.s: 0{start}}}, time: {{from: 0, to: 1.2, count: 25}}}}}}
"""
BESIDE = {
    "alone": {"link": "", "joint": "", "start": ""},
    "beside a slide": {
        "link": ", n: {mass: 2, center_of_mass: [0, 1]}",
        "joint": "  Q: {type: P, links: [ground, n], point: [0, 1], axis: [1, 0]}\n",
        "start": ", Q.s: 0, Q.s_dot: 1",
    },
}


@pytest.mark.parametrize("words", BESIDE.values(), ids=BESIDE.keys())
def test_a_limit_bears_what_presses_on_it_and_friction_holds_what_it_lets_go(
    words: dict[str, str],
) -> None:
    """1 N of friction: off at once by 4 N - 10 t, at the limit where 2 t^2 - 5 t^3/3 = 0.1; let go
    at 5 N = 10 t, and off it where that is less than -1 N, by 6 N - 10 t."""
    rows = mk.loads(RUBBING.format(**words)).respond("r")
    time, place = np.asarray(rows["time"]), np.asarray(rows["S.s"])
    assert set(rows["row.status"]) == {"ok"}
    comes = min(x.real for x in np.roots([-5 / 3, 2, 0, -0.1]) if x.real > 0)
    before, after = time < comes, time > 0.6
    np.testing.assert_allclose(
        place[before], 2 * time[before] ** 2 - 5 * time[before] ** 3 / 3, atol=1e-9
    )
    rests = ~(before | after)
    np.testing.assert_allclose(place[rests], 0.1, atol=1e-12)
    np.testing.assert_allclose(place[after], 0.1 - 5 * (time[after] - 0.6) ** 3 / 3, atol=1e-8)
    borne = rests & (time < 0.5)
    np.testing.assert_allclose(rows["S.effort"][borne], 10 * time[borne] - 5, atol=1e-9)
    held = rests & (time > 0.5)
    np.testing.assert_allclose(rows["S.effort"][held], 0.0, atol=1e-12)


def test_a_lossy_rack_rests_at_a_limit_of_its_slide() -> None:
    """The load drives the pinion: 5 N - r F = I s../r, of which the teeth take a share 0.9 on."""
    text = RUBBING.format(
        link=", n: {mass: 1, center_of_mass: [0, 0.02], inertia: 0.0001}",
        joint="  A: {type: R, links: [ground, n], point: [0, 0.02]}\n",
        start="",
    ).replace("limits:", "couplings: {K: {type: rack, joints: [A, S], radius: 0.02, EFF}}\nlimits:")
    text = text.replace("EFF", "efficiency: 0.9").replace(' - 10 N/s*time"', '"')
    text = text.replace("  - {type: friction, joint: S, coefficient: 0.1}\n", "")
    rows = mk.loads(text).respond("r")
    time = np.asarray(rows["time"])
    assert set(rows["row.status"]) == {"ok"}
    rate = 5.0 / (1.0 + 0.0001 / 0.02**2 / 0.9)
    comes = sqrt(0.2 / rate)
    before = time < comes
    np.testing.assert_allclose(rows["S.s"][before], 0.5 * rate * time[before] ** 2, atol=1e-9)
    np.testing.assert_allclose(rows["S.s"][~before], 0.1, atol=1e-12)
    np.testing.assert_allclose(rows["S.effort"][~before], -5.0, rtol=1e-12)


def test_a_response_that_shared_limits_end_says_why() -> None:
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {mass: 1, center_of_mass: [0, 0], inertia: 0.02}
  b: {mass: 1, center_of_mass: [0.06, 0], inertia: 0.05}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [0.06, 0]}
couplings: {K: {type: gear, joints: [A, B], teeth: [20, 40]}}
limits: {A.theta: {max: 1, restitution: 0}, B.theta: {min: -0.5, restitution: 0}}
loads: [{type: friction, joint: A, coefficient: 0.1, radius: 5 mm}]
responses: {r: {start: {A.theta: 0}, efforts: {A.theta: 1 N*m}, time: {from: 0, to: 1, count: 11}}}
"""
    model = mk.loads(text)
    (told,) = (d for d in model.respond("r").diagnostics if d.code == "impact-unresolved")
    assert "A.theta and B.theta are at limits" in told.message
    free = mk.loads(text.replace("{type: friction, joint: A, coefficient: 0.1, radius: 5 mm}", ""))
    assert not [d for d in free.respond("r").diagnostics if d.code == "impact-unresolved"]


BOTH_HELD = """format: 1
plane: xy
units: {angle: rad}
links:
  b0: {mass: 1, center_of_mass: [-0.554, 0.65], inertia: 0.1}
  b1: {mass: 1, center_of_mass: [-0.665, 0.791], inertia: 0.1}
  b2: {mass: 1, center_of_mass: [-0.843, 0.987], inertia: 0.1}
  b3: {mass: 1, center_of_mass: [0.315, 0.666], inertia: 0.1}
  b4: {mass: 1, center_of_mass: [0.235, 0.429], inertia: 0.1}
  b5: {mass: 1, center_of_mass: [0.007, 1.064], inertia: 0.1}
  b6: {mass: 1, center_of_mass: [-0.118, 0.869], inertia: 0.1}
joints:
  A: {type: R, links: [ground, b0], point: [-0.585, 0.657]}
  B: {type: R, links: [b1, b0], point: [-0.389, 0.917]}
  C: {type: R, links: [b2, b1], point: [-0.877, 0.862]}
  D: {type: R, links: [b0, b3], point: [-0.389, 0.917]}
  E: {type: R, links: [b3, b4], point: [0.173, 0.451]}
  F: {type: R, links: [ground, b4], point: [-0.701, 0.026]}
  G: {type: R, links: [b5, b3], point: [0.173, 0.451]}
  H: {type: R, links: [b6, b5], point: [-0.05, 1.016]}
  K: {type: R, links: [b1, b6], point: [-0.877, 0.862]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: damper, joint: F, coordinate: theta, damping: 0.8}
responses:
  r:
    start: {A.theta: 0, C.theta: 0}
    time: {from: 0, to: 1.5, step: 0.1}
    driven: {B.theta: {law: sine, amplitude: 0.164, frequency: 1.342 Hz}}
limits: {A.theta: {min: -1.1699, restitution: 0}, C.theta: {max: 0.702, restitution: 0}}
"""


def test_a_damper_that_stands_still_does_not_end_a_motion() -> None:
    """All that is free rests at limits, a drive moves on, and what the damper takes is rounding."""
    names = ["time", "A.theta", "B.theta", "C.theta", "F.theta_dot", "row.dissipated"]
    rows = mk.loads(BOTH_HELD).respond("r", names)
    assert rows.complete
    driven = 0.164 * np.sin(2.0 * np.pi * 1.342 * rows["time"])
    np.testing.assert_allclose(rows["B.theta"], driven, atol=1e-12)
    held = (rows["A.theta"] < -1.1699 + 1e-9) & (rows["C.theta"] > 0.702 - 1e-9)
    assert np.count_nonzero(held) > 3
    assert np.abs(rows["F.theta_dot"][held]).max() < 1e-9
    assert np.ptp(rows["row.dissipated"][held]) < 1e-9 * rows["row.dissipated"].max()
