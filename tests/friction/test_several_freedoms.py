"""Sticking and sliding of several freedoms, and beside driven coordinates."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, pi, sqrt

import numpy as np
import pytest
from friction.arm_reference import Arm, G
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.verdict import Status

Floats = NDArray[np.float64]

HEAD = "format: 1\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
ARM = Arm(
    length=[0.7, 0.5],
    mass=[2.0, 1.0],
    centre=[0.4, 0.3],
    inertia=[0.1, 0.05],
    radius=[0.15, 0.1],
    static=[0.35, 0.3],
    sliding=[0.3, 0.2],
)


def errors(found: mk.Analysis) -> list[str]:
    return [d.code for d in found.diagnostics if d.severity == "error"]


@pytest.mark.parametrize(("angle", "rate"), [([-0.4, 0.9], [0.0, 0.0]), ([-2.0, 0.3], [3.0, -2.0])])
def test_an_arm_against_an_integration_from_event_to_event(
    angle: list[float], rate: list[float]
) -> None:
    names = ["J0.theta", "J1.theta", "J0.theta_dot", "J1.theta_dot"]
    model = mk.loads(ARM.text(angle, rate, "0.1", 2.0))
    found = model.respond("go", [*names, "row.energy_error", "row.dissipated", "time"])
    expected = ARM.integrated(angle, rate, np.asarray(found["time"]))
    for name, wanted in zip(names, expected, strict=True):
        assert found[name] == pytest.approx(wanted, abs=1e-8)
    assert (found["row.energy_error"] <= 1e-10).all()
    assert (np.diff(found["row.dissipated"]) >= 0.0).all()


def test_an_arm_comes_to_rest_and_stays() -> None:
    found = mk.loads(ARM.text([0.3, 0.4], [0.0, 0.0], "1", 60.0)).respond(
        "go", ["J0.theta", "J1.theta", "J0.theta_dot", "row.energy_error"]
    )
    rests = found["J0.theta_dot"] == 0.0
    assert rests[10:].all()
    for joint in ("J0", "J1"):
        assert np.ptp(found[f"{joint}.theta"][rests][-50:]) == 0.0
    assert (found["row.energy_error"] <= 1e-10).all()


def test_what_sticks_does_not_creep_while_the_rest_moves() -> None:
    """A pin that carries its load while the arm swings without friction for long."""
    arm = Arm(
        length=[0.7, 0.5],
        mass=[2.0, 1.0],
        centre=[0.4, 0.1],
        inertia=[0.1, 0.01],
        radius=[0.1, 0.2],
        static=[0.0, 0.9],
        sliding=[0.0, 0.9],
    )
    text = arm.text([-1.0, 0.4], [0.0, 0.0], "1", 100.0)
    found = mk.loads(text).respond("go", ["J0.theta", "J1.theta", "J1.theta_dot"])
    assert errors(found) == []
    assert np.ptp(found["J0.theta"]) > 0.5
    assert np.max(np.abs(found["J1.theta"] - 0.4)) <= 1e-12
    assert np.max(np.abs(found["J1.theta_dot"])) <= 1e-15


def test_coefficients_of_zero_give_the_bytes_without_friction() -> None:
    arm = Arm(
        *(getattr(ARM, n) for n in ("length", "mass", "centre", "inertia", "radius")),
        [0.0] * 2,
        [0.0] * 2,
    )
    text = arm.text([-0.4, 0.9], [1.0, 0.0], "0.1", 2.0)
    without = "\n".join(line for line in text.splitlines() if "type: friction" not in line)
    names = ["J0.theta", "J1.theta", "J0.theta_dot", "J1.theta_ddot"]
    one, other = (mk.loads(t).respond("go", names) for t in (text, without))
    assert all(one[name].tobytes() == other[name].tobytes() for name in names)


def blocks(first: str = "A", second: str = "B", mirror: float = 1.0, order: int = 1) -> str:
    """A block of 2 kg on a table that is pulled to the side, one of 1 kg on it."""
    loads = [
        f"  - {{type: gravity, g: [{3 * mirror!r}, -{G}, 0]}}",
        f"  - {{type: friction, joint: {first}, coefficient: 0.2}}",
        f"  - {{type: friction, joint: {second}, coefficient: 0.4}}",
    ]
    listed = "\n".join(loads[::order])
    return f"""{HEAD}name: blocks
links: {{a: {{mass: 2, center_of_mass: [0, 0, 0]}}, b: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints:
  {first}: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}
  {second}: {{type: P, links: [a, b], point: [0, 0, 0], axis: [1, 0, 0]}}
loads:
{listed}
responses:
  go:
    start: {{{first}.s: 0, {second}.s: 0, {first}.s_dot: 0, {second}.s_dot: {2 * mirror!r}}}
    time: {{from: 0, to: 2, step: 0.1}}
"""


def test_a_block_on_a_block_slides_and_is_carried_along() -> None:
    found = mk.loads(blocks()).respond("go", ["A.s", "B.s", "row.dissipated", "row.energy_error"])
    t = np.arange(21) * 0.1
    # the upper one slides and drives the lower one; then both go together
    low, high = (2 * 3 + 0.4 * G - 0.2 * 3 * G) / 2, 3 - 0.4 * G
    together = 3 - 0.2 * G
    stop = 2 / (low - high)
    after = np.maximum(t - stop, 0.0)
    a = np.where(
        t < stop,
        low * t * t / 2,
        low * stop**2 / 2 + low * stop * after + together * after**2 / 2,
    )
    b = np.where(t < stop, 2 * t + (high - low) * t * t / 2, 2 * stop + (high - low) * stop**2 / 2)
    assert found["A.s"] == pytest.approx(a, abs=1e-10)
    assert found["B.s"] == pytest.approx(b, abs=1e-10)
    lost = 0.2 * 3 * G * a + 0.4 * G * b
    assert found["row.dissipated"] == pytest.approx(lost, abs=1e-9)
    assert (found["row.energy_error"] <= 1e-12).all()


def test_blocks_by_other_names_in_another_order_and_mirrored() -> None:
    here = mk.loads(blocks()).respond("go", ["A.s", "B.s"])
    renamed = mk.loads(blocks("Z", "K", order=-1)).respond("go", ["Z.s", "K.s"])
    assert renamed["Z.s"] == pytest.approx(here["A.s"], abs=1e-13)
    assert renamed["K.s"] == pytest.approx(here["B.s"], abs=1e-13)
    mirrored = mk.loads(blocks(mirror=-1.0)).respond("go", ["A.s", "B.s"])
    assert (mirrored["A.s"] == -here["A.s"]).all()
    assert (mirrored["B.s"] == -here["B.s"]).all()


BELT = f"""{HEAD}name: belt
points: {{p: {{link: ground, at: [-5, 0, 0]}}, q: {{link: b, at: [0, 0, 0]}}}}
links: {{belt: {{}}, b: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints:
  A: {{type: P, links: [ground, belt], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: P, links: [belt, b], point: [0, 0, 0], axis: [1, 0, 0]}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: B, coefficient: {{static: 0.4, sliding: 0.2}}}}
  - {{type: spring, between: [p, q], stiffness: 40 N/m, free: 5}}
responses:
  go:
    start: {{B.s: 0}}
    driven: {{A.s: {{law: constant-acceleration, at: 0, rate: 0.3, acceleration: 0}}}}
    time: {{from: 0, to: 5, step: 0.05}}
"""


def belt(t: float) -> float:
    """Where the block is: it goes with the belt up to what friction holds, then swings about what
    sliding friction holds until it has the belt's speed again; at rest on the belt from there."""
    k, v, omega = 40.0, 0.3, sqrt(40.0)
    far, middle = 0.4 * G / k, 0.2 * G / k
    first = far / v
    if t <= first:
        return v * t
    # x = middle + c cos(omega t - phase); the speed is v again at pi + phase
    reach = sqrt((far - middle) ** 2 + (v / omega) ** 2)
    phase = atan2(v / omega, far - middle)
    slide = (pi + 2 * phase) / omega
    back = middle - (far - middle)
    stick = (far - back) / v
    rest = (t - first) % (slide + stick)
    if rest < slide:
        return middle + reach * cos(omega * rest - phase)
    return back + v * (rest - slide)


def test_a_block_on_a_belt_sticks_and_slips() -> None:
    names = ["A.s", "B.s", "row.energy_error", "row.work", "time"]
    found = mk.loads(BELT).respond("go", names)
    place = found["A.s"] + found["B.s"]
    assert place == pytest.approx([belt(float(t)) for t in found["time"]], abs=1e-9)
    assert (found["row.energy_error"] <= 1e-11).all()
    assert errors(found) == []


CYLINDER = f"""{HEAD}name: cylinder
links: {{a: {{mass: 1, center_of_mass: [0, 0, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}}}
joints: {{A: {{type: C, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads:
  - {{type: gravity, g: [0, -{G}, 1]}}
  - {{type: friction, joint: A, coefficient: 0.3, radius: 0.1}}
responses:
  go:
    start: {{A.theta: 0, A.s: 0, A.theta_dot: 20, A.s_dot: 0.5}}
    time: {{from: 0, to: 9, step: 0.5}}
"""


def test_a_shaft_that_turns_slides_until_both_stop() -> None:
    names = ["A.theta", "A.s", "A.theta_dot", "A.s_dot", "row.energy_error", "time"]
    found = mk.loads(CYLINDER).respond("go", names)

    def slope(_: float, y: Floats) -> list[float]:
        size = sqrt(y[3] ** 2 + (0.1 * y[2]) ** 2)
        return [y[2], y[3], -0.3 * G * 0.01 / 0.1 * y[2] / size, 1 - 0.3 * G * y[3] / size]

    times = found["time"][:15]
    fine = solve_ivp(slope, (0, 7), [0, 0, 20, 0.5], "DOP853", times, rtol=1e-12, atol=1e-13)
    for name, wanted in zip(names, fine.y, strict=False):
        assert found[name][:15] == pytest.approx(wanted, abs=1e-9)
    assert (found["row.energy_error"] <= 1e-12).all()
    assert (found["A.s_dot"][-3:] == 0.0).all()
    assert (found["A.theta_dot"][-3:] == 0.0).all()
    assert np.ptp(found["A.s"][-3:]) == 0.0


@pytest.mark.parametrize("slow", [1.0, 100.0])
@pytest.mark.parametrize("coefficients", ["0.3", "{static: 0.3, sliding: 0.3}"])
def test_a_shaft_gives_way_in_two_directions_to_a_load_that_grows(
    slow: float, coefficients: str
) -> None:
    """Its coefficient does not jump, so that the slip begins with neither rate nor acceleration:
    along the load w = (f, m/r) t at the limit, w0 = mu N d, and by the first two terms in t of
    M v' = w - mu N v/|v| on."""
    mass, inertia, r, force, couple, last = 1.3, 0.05, 0.08, 3 / slow, 1.1 / slow, 3 * slow
    text = f"""{HEAD}name: cylinder
links:
  a: {{mass: {mass}, center_of_mass: [0, 0, 0], inertia: {{xx: 0.1, yy: 0.1, zz: {inertia}}}}}
joints: {{A: {{type: C, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: force, link: a, point: [0, 0, 0], force: [0, 0, "{force} N/s*time"]}}
  - {{type: torque, link: a, torque: [0, 0, "{couple * r} N*m/s*time"]}}
  - {{type: friction, joint: A, coefficient: {coefficients}, radius: {r}}}
responses:
  go: {{start: {{A.theta: 0, A.s: 0}}, time: {{from: 0, to: {last}, count: 13}}}}
"""
    found = mk.loads(text).respond("go", ["A.s", "A.theta", "time"])
    assert {str(word) for word in found["row.status"]} == {"ok"}
    held, growth = 0.3 * mass * G, np.array([force, couple])
    per = np.array([1 / mass, r * r / inertia])
    begin = held / np.linalg.norm(growth)
    along = growth / np.linalg.norm(growth)
    across = np.array([-along[1], along[0]])
    second, turn = np.linalg.solve(np.array([along, held * per * across]).T, growth * per)
    early = 1e-4 * (last - begin)
    way = along + turn * early * across
    way /= np.linalg.norm(way)

    def slope(t: float, y: Floats) -> Floats:
        v = y[2:]
        return np.concatenate([v, per * (growth * t - held * v / np.linalg.norm(v))])

    start = np.concatenate([way * second * early**3 / 6, way * second * early**2 / 2])
    times = np.asarray(found["time"])
    rows = times > begin + early
    fine = solve_ivp(
        slope, (begin + early, last), start, "Radau", times[rows], rtol=1e-11, atol=1e-16
    )
    size = max(1.0, float(np.max(np.abs(fine.y[:2]))))
    assert np.max(np.abs(found["A.s"][rows] - fine.y[0])) < 1e-10 * size
    assert np.max(np.abs(r * np.asarray(found["A.theta"])[rows] - fine.y[1])) < 1e-10 * size
    assert (np.asarray(found["A.s"])[~rows] == 0.0).all()


FIVE_BAR = f"""{HEAD}name: five-bar
links:
  a: {{mass: 1, center_of_mass: [-0.25, 0.5, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
  b: {{mass: 1.5, center_of_mass: [0.1, 1.2, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
  c: {{mass: 1, center_of_mass: [0.9, 1.2, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
  d: {{mass: 1, center_of_mass: [1.25, 0.5, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [-0.5, 1, 0], axis: [0, 0, 1]}}
  C: {{type: S, links: [b, c], point: [0.5, 1.5, 0]}}
  D: {{type: C, links: [c, d], point: [1.5, 1, 0], axis: [0, 0, 1]}}
  E: {{type: R, links: [d, ground], point: [1, 0, 0], axis: [0, 0, 1]}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: A, coefficient: 0.2, radius: 0.15}}
  - {{type: friction, joint: B, coefficient: 0.2, radius: 0.15}}
  - {{type: friction, joint: C, coefficient: 0.2, radius: 0.15}}
  - {{type: friction, joint: D, coefficient: 0.2, radius: 0.15}}
  - {{type: friction, joint: E, coefficient: 0.2, radius: 0.15}}
responses:
  go: {{start: {{A.theta: 0.1, E.theta: 0.04}}, time: {{from: 0, to: 6, step: 0.5}}}}
"""


def test_a_five_bar_whose_joints_all_rub() -> None:
    found = mk.loads(FIVE_BAR).respond(
        "go", ["A.theta", "E.theta", "row.energy_error", "row.dissipated"]
    )
    assert errors(found) == []
    assert (found["row.energy_error"] <= 1e-9).all()
    assert (np.diff(found["row.dissipated"]) >= 0.0).all()


def test_friction_that_may_jam_names_its_joint() -> None:
    """The mass hangs so far beside its guide that friction feeds itself (Painleve)."""
    text = f"""{HEAD}name: guide
links:
  cart: {{mass: 1, center_of_mass: [0, 0, 0]}}
  slider: {{mass: 1, center_of_mass: [0, 0.5, 0]}}
joints:
  H: {{type: P, links: [ground, cart], point: [0, 0, 0], axis: [0, 0, 1]}}
  G: {{type: P, links: [cart, slider], point: [0, 0, 0], axis: [1, 0, 0]}}
responses:
  go: {{start: {{H.s: 0, G.s: 0, G.s_dot: 1}}, time: {{from: 0, to: 1, step: 0.5}}}}
loads:
  - {{type: force, link: slider, point: [0, 0.5, 0], force: [1, 0, 0]}}
  - {{type: friction, joint: G, coefficient: 0.3, length: 0.2}}
"""
    found = mk.loads(text).respond("go", ["G.s"])
    assert found.result.status[-1] == Status.friction_undecided
    (told,) = [d for d in found.diagnostics if d.severity == "error"]
    assert told.code == "friction-undecided"
    assert "friction of G has" in told.message


def test_a_motion_taken_up_at_a_row_goes_on_as_it_did() -> None:
    names = ["J0.theta", "J1.theta", "J0.theta_dot", "J1.theta_dot"]
    whole = mk.loads(ARM.text([-0.4, 0.9], [0.0, 0.0], "0.1", 2.0)).respond("go", names)
    at = [float(whole[name][10]) for name in names]
    rest = mk.loads(ARM.text(at[:2], at[2:], "0.1", 1.0)).respond("go", names)
    for name in names:
        assert rest[name] == pytest.approx(whole[name][10:], abs=1e-9)


def test_doubled_coefficients_with_radii_halved_rub_as_much() -> None:
    doubled = replace(
        ARM,
        radius=[r / 2 for r in ARM.radius],
        static=[2 * c for c in ARM.static],
        sliding=[2 * c for c in ARM.sliding],
    )
    names = ["J0.theta", "J1.theta", "row.dissipated"]
    here, other = (
        mk.loads(arm.text([-0.4, 0.9], [0.0, 0.0], "0.1", 2.0)).respond("go", names)
        for arm in (ARM, doubled)
    )
    for name in names:
        assert other[name] == pytest.approx(here[name], abs=1e-9)


def test_lanes_do_not_change_bits() -> None:
    model = mk.loads(ARM.text([-0.4, 0.9], [0.0, 0.0], "0.1", 2.0))
    names = ["J0.theta", "J1.theta_dot", "row.dissipated"]
    here = model.respond("go", names)
    for lanes in widths():
        other = model.respond("go", names, lanes=lanes)
        assert all(other[name].tobytes() == here[name].tobytes() for name in names)


UNLOADED = f"""{HEAD}name: arm on a table
links:
  a: {{mass: 2, center_of_mass: [0.5, 0, 0], inertia: {{xx: 1, yy: 1, zz: 1}}}}
  b: {{mass: 1, center_of_mass: [1.4, 0, 0], inertia: {{xx: 0.5, yy: 0.5, zz: 0.5}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [1, 0, 0], axis: [0, 0, 1]}}
loads:
  - {{type: friction, joint: A, coefficient: 0.3, radius: 0.1}}
responses:
  go:
    start: {{A.theta: 0, B.theta: 0}}
    time: {{from: 0, to: 2, step: 0.1}}
    efforts: {{A.theta: "EFFORT N*m/s*time"}}
"""


@pytest.mark.parametrize("sign", [1, -1])
def test_a_pin_that_carries_nothing_at_first_gives_way_to_any_push(sign: int) -> None:
    names = ["A.theta", "B.theta", "row.energy_error"]
    found = mk.loads(UNLOADED.replace("EFFORT", str(sign))).respond("go", names)
    assert errors(found) == []
    assert (sign * np.diff(found["A.theta"]) > 0.0).all()
    assert (found["row.energy_error"][1:] <= 1e-10).all()


def test_several_pins_that_carry_nothing_at_first_are_not_held_without_a_word() -> None:
    other = "  - {type: friction, joint: B, coefficient: 0.3, radius: 0.1}\nresponses:"
    text = UNLOADED.replace("EFFORT", "1").replace("responses:", other)
    found = mk.loads(text).respond("go", ["A.theta"])
    assert errors(found) or (np.diff(found["A.theta"]) > 0.0).all()
