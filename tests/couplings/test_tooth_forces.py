"""Forces between teeth at the pitch point, and what bearings take of them, against statics by
hand (Shigley, Mechanical Engineering Design, force analysis of spur and helical gears)."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

HEAD = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
"""
SPUR = (
    HEAD
    + """
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [60, 0]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
"""
)
ANGLES = {"none": ("", 0.0), "20 deg": (", pressure_angle: 20", np.tan(np.radians(20.0)))}


@pytest.mark.parametrize(("words", "slope"), ANGLES.values(), ids=ANGLES.keys())
@pytest.mark.parametrize("load", [-4.0, 4.0])
def test_a_spur_pair_pushes_its_bearings(words: str, slope: float, load: float) -> None:
    """4 N m on a wheel of 40 mm radius are 100 N at its teeth; both flanks push apart."""
    text = f"{SPUR}loads: [{{type: torque, joint: B, value: {load} N*m}}]\n"
    text += f"couplings: {{G: {{type: gear, joints: [A, B], teeth: [20, 40]{words}}}}}"
    result = mk.loads(text).analyze()
    # at the arm (-40 mm, 0) from the wheel's axis: -0.04 m F + load = 0
    tangential = load / 0.04
    for row in range(3):
        force = result["G.tooth_force"][row]
        np.testing.assert_allclose(
            force, [slope * abs(tangential), tangential], rtol=1e-12, atol=1e-10
        )
        # what ground exerts on the wheel holds that, and on the pinion its opposite
        np.testing.assert_allclose(result["B.force"][row], -force, rtol=1e-12, atol=1e-10)
        np.testing.assert_allclose(result["A.force"][row], force, rtol=1e-12, atol=1e-10)
    np.testing.assert_allclose(result["A.effort"], load * 500.0, rtol=1e-12)


def test_a_pinion_in_a_ring() -> None:
    """Ring 60, pinion 20 teeth, axes 20 mm apart: radii 30 and 10 mm; both are pushed apart."""
    text = (
        HEAD
        + """
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [0, 20]}
motion: {inputs: {A.theta: {at: 0}}}
loads: [{type: torque, joint: B, value: -6 N*m}]
couplings: {G: {type: gear, joints: [A, B], teeth: [60, 20], internal: true, pressure_angle: 25}}
"""
    )
    result = mk.loads(text).analyze()
    # the pitch point lies at (0, 30): the pinion, above the ring's axis, is driven along -x there
    tangential = -6.0 / 0.01
    radial = -abs(tangential) * np.tan(np.radians(25.0))
    np.testing.assert_allclose(result["G.tooth_force"][0], [tangential, radial], rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], 18000.0, rtol=1e-12)


HELICAL = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: TYPE, links: [ground, w1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, w2], point: [60, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}MORE}}
loads: [{type: torque, joint: B, value: -4 N*m}]
couplings:
  G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 20, helix: 30}
"""


def test_helical_wheels_have_thrust() -> None:
    """Right hand on the first wheel: 100 N tangential, by tan 20/cos 30 apart, by tan 30 along."""
    result = mk.loads(HELICAL.replace("TYPE", "R").replace("MORE", "")).analyze()
    thrust, apart = 100.0 * np.tan(np.pi / 6), 100.0 * np.tan(np.pi / 9) / np.cos(np.pi / 6)
    # the pinion drives clockwise: its right-hand teeth push it towards +z, and the wheel to -z
    force = result["G.tooth_force"][1]
    np.testing.assert_allclose(np.abs(force), [apart, 100.0, thrust], rtol=1e-12)
    np.testing.assert_allclose(result["B.force"][1], -force, rtol=1e-12)
    # the thrust at the rim tilts the wheel, and the pinion half as much, about y
    for joint, radius in (("A", 20.0), ("B", 40.0)):
        moment = result[f"{joint}.moment"][1]
        np.testing.assert_allclose(
            np.abs(moment), [0.0, radius * thrust, 0.0], rtol=1e-12, atol=1e-9
        )


def test_a_helical_wheel_that_slides_turns_its_mate_and_takes_thrust_as_effort() -> None:
    """Its rim moves by tan 30 of the slide."""
    slid = HELICAL.replace("TYPE", "C").replace("MORE", ", A.s: {with: A.theta*0.1 mm/deg}")
    result = mk.loads(slid).analyze()
    turn, slide = np.array([0.0, 45.0, 90.0]), np.array([0.0, 4.5, 9.0])
    by_slide = np.degrees(np.tan(np.pi / 6) / 20.0) * slide
    np.testing.assert_allclose(result["B.theta"], -(turn - by_slide) / 2.0, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.abs(result["A.s.effort"]), 100.0 * np.tan(np.pi / 6), rtol=1e-12)
    power = result["A.theta.effort"] * result["A.theta_dot"]
    power = power + result["A.s.effort"] * result["A.s_dot"]
    # the load takes 4 N m by the wheel's rate
    np.testing.assert_allclose(power, 4000.0 * result["B.theta_dot"], rtol=1e-12)


def test_a_rack_pushes_its_guide() -> None:
    text = (
        HEAD
        + """
links: {p: {}, r: {}}
joints:
  P: {type: R, links: [ground, p], point: [0, 0]}
  S: {type: P, links: [ground, r], point: [0, -20], axis: [1, 0]}
motion: {inputs: {P.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
loads: [{type: force, joint: S, value: -50}]
couplings: {K: {type: rack, joints: [P, S], radius: 20 mm, pressure_angle: 20}}
"""
    )
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(result["S.s"], 20.0 * np.radians([0.0, 45.0, 90.0]), rtol=1e-12)
    np.testing.assert_allclose(result["P.effort"], 1000.0, rtol=1e-12)
    apart = -50.0 * np.tan(np.pi / 9)
    for row in range(3):
        np.testing.assert_allclose(result["K.tooth_force"][row], [50.0, apart], rtol=1e-12)
        np.testing.assert_allclose(result["S.force"][row], [0.0, -apart], rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(result["P.force"][row], [50.0, apart], rtol=1e-12)


def test_the_teeth_of_a_planet_load_its_pin_twice() -> None:
    """Sun 18, planet 12, ring 42, radii 9, 6, 21: at rest the arm holds twice the teeth's force."""
    text = (
        HEAD
        + """
links: {sun: {}, arm: {}, planet: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, arm], point: [0, 0]}
  P: {type: R, links: [arm, planet], point: [15, 0]}
motion: {inputs: {S.theta: {from: 0, to: 720, count: 7, rate: 1 rad/s}}}
loads: [{type: torque, joint: C, value: -3 N*m}]
couplings:
  K: {type: gear, joints: [S, P], teeth: [18, 12], pressure_angle: 20}
  R: {type: gear, joints: [C, P], teeth: [42, 12], internal: true, pressure_angle: 20}
"""
    )
    result = mk.loads(text).analyze()
    pin = 3.0 / 0.015
    np.testing.assert_allclose(result["S.effort"], 3000.0 * 0.3, rtol=1e-12)
    size = [np.hypot(*force) for force in result["P.force"]]
    np.testing.assert_allclose(size, pin, rtol=1e-12)
    for name in ("K.tooth_force", "R.tooth_force"):
        sizes = [np.hypot(*force) for force in result[name]]
        np.testing.assert_allclose(sizes, 0.5 * pin / np.cos(np.pi / 9), rtol=1e-12)


WRONG = {
    "radii": ("teeth: [20, 40]", "radii: [20, 45]", "do not mesh where they are drawn"),
    "module": ("teeth: [20, 40]", "teeth: [20, 40], module: 1", "do not mesh where they are drawn"),
    "pressure": (
        "teeth: [20, 40]",
        "teeth: [20, 40], pressure_angle: 95",
        "no teeth with a pressure",
    ),
    "ideal": ("teeth: [20, 40]", "teeth: [20, 40], pressure_angle: 20, ideal: true", "no teeth"),
    "coaxial": ("point: [60, 0]", "point: [0, 0]", "no pitch point"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_teeth_that_cannot_mesh_are_refused(before: str, after: str, words: str) -> None:
    text = SPUR + "couplings: {G: {type: gear, joints: [A, B], teeth: [20, 40]}}"
    right = text.replace("teeth: [20, 40]", "teeth: [20, 40], module: 2")
    assert mk.loads(right).analyze()["B.theta"][-1] == pytest.approx(-45.0)
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)


RUBBING = (
    HEAD
    + """
links:
  w1: {mass: 1, center_of_mass: [0, 0], inertia: 100}
  w2: {mass: 2, center_of_mass: [60, 0], inertia: 300}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [60, 0]}
loads:
  - {type: torque, joint: B, value: 4 N*m}
  - {type: friction, joint: A, coefficient: 0.1, radius: 5}
  - {type: friction, joint: B, coefficient: 0.2, radius: 8}
couplings: {G: {type: gear, joints: [A, B], teeth: [20, 40]}}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
responses:
  r:
    start: {A.theta: 0, A.theta_dot: 10 rad/s}
    efforts: {A.theta: 3 N*m}
    time: {from: 0, to: 0.02, step: 0.01}
"""
)


def test_bearings_rub_by_the_force_of_teeth() -> None:
    """Moments about both axes, linear in the force F of the teeth and the acceleration."""
    model = mk.loads(RUBBING)
    result = model.analyze()
    force = 4000.0 / (40.0 - 0.2 * 8.0)
    np.testing.assert_allclose(result["norm(B.force)"], force, rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], force * (20.0 + 0.1 * 5.0), rtol=1e-12)
    matrix = [[100e-6, 0.02 + 0.1 * 0.005], [-0.5 * 300e-6, 0.04 - 0.2 * 0.008]]
    acceleration, force = np.linalg.solve(matrix, [3.0, 4.0])
    moved = model.respond("r")
    assert set(moved["row.status"]) == {"ok"}
    np.testing.assert_allclose(moved["norm(A.force)"], force, rtol=1e-10)
    time = moved["time"]
    turn = np.degrees(10.0 * time + acceleration * time * time / 2.0)
    np.testing.assert_allclose(moved["A.theta"], turn, rtol=1e-10, atol=1e-12)


def bearings(
    force: float, acceleration: float, slope: float, weight: float, ways: tuple[float, float]
) -> np.ndarray:
    """Moments left about both axes (N m) with a tangential force at the teeth, the weights of the
    wheels per kg along x and y, their bearings' friction against the wheels' ways, and 4 N m on the
    second one; then the bearings' forces."""
    teeth = np.array([slope * abs(force), force])
    pull = weight * np.array([0.6, -0.8])
    on_first, on_second = teeth - 1.0 * pull, -teeth - 2.0 * pull
    first, second = np.hypot(*on_first), np.hypot(*on_second)
    about_first = -0.02 * force - ways[0] * 0.1 * 0.005 * first - 100e-6 * acceleration
    about_second = 4.0 - 0.04 * force - ways[1] * 0.2 * 0.008 * second + 0.5 * 300e-6 * acceleration
    return np.array([about_first, about_second, first, second])


@pytest.mark.parametrize("weight", [0.0, 200.0])
@pytest.mark.parametrize("degrees", [0.0, 20.0, 35.0])
@pytest.mark.parametrize("rate", [1000.0, -1000.0])
def test_bearings_rub_by_what_pushes_wheels_apart(
    rate: float, degrees: float, weight: float
) -> None:
    gravity = f"  - {{type: gravity, g: [{0.6 * weight} m/s^2, {-0.8 * weight} m/s^2]}}\n"
    text = RUBBING.replace("loads:\n", f"loads:\n{gravity}").replace("10 rad/s", f"{rate} rad/s")
    model = mk.loads(text.replace("teeth: [20, 40]", f"teeth: [20, 40], pressure_angle: {degrees}"))
    slope, ways = np.tan(np.radians(degrees)), (np.sign(rate), -np.sign(rate))
    result = model.analyze()
    force = brentq(lambda f: bearings(f, 0.0, slope, weight, ways)[1], 1.0, 1000.0, xtol=1e-13)
    effort, _, first, second = bearings(force, 0.0, slope, weight, ways)
    np.testing.assert_allclose(result["A.effort"], -1e3 * effort, rtol=1e-11)
    np.testing.assert_allclose(result["A.normal_load"], first, rtol=1e-11)
    np.testing.assert_allclose(result["B.normal_load"], second, rtol=1e-11)
    teeth = [slope * force, force]
    np.testing.assert_allclose(result["G.tooth_force"], [teeth] * 3, rtol=1e-11, atol=1e-9)
    assert result["row.power_error"].max() < 1e-13
    moved = model.respond("r")

    def accelerated(force: float) -> float:
        """By 3 N m and the teeth at the first wheel."""
        return (3.0 + bearings(force, 0.0, slope, weight, ways)[0]) / 100e-6

    def left(force: float) -> float:
        return bearings(force, accelerated(force), slope, weight, ways)[1]

    force = brentq(left, -1000.0, 1000.0, xtol=1e-12)
    acceleration = accelerated(force)
    _, _, first, second = bearings(force, acceleration, slope, weight, ways)
    assert set(moved["row.status"]) == {"ok"}
    np.testing.assert_allclose(moved["norm(A.force)"], first, rtol=1e-9)
    np.testing.assert_allclose(moved["norm(B.force)"], second, rtol=1e-9)
    time = moved["time"]
    turn = np.degrees(rate * time + acceleration * time * time / 2.0)
    np.testing.assert_allclose(moved["A.theta"], turn, rtol=1e-9, atol=1e-10)
    assert np.nanmax(moved["row.energy_error"]) < 1e-9


def test_a_bearing_lets_go_by_what_pushes_apart() -> None:
    """A moment that grows by 1 N m/s: the bearing of the second wheel, which carries 400 N and the
    teeth, holds it until the moment of the teeth is more than 1.6 mm of that."""
    gravity = "  - {type: gravity, g: [120 m/s^2, -160 m/s^2]}\n"
    text = RUBBING.replace("  - {type: torque, joint: B, value: 4 N*m}\n", gravity)
    text = text.replace("  - {type: friction, joint: A, coefficient: 0.1, radius: 5}\n", "")
    text = text.replace("teeth: [20, 40]", "teeth: [20, 40], pressure_angle: 30")
    motion = '{start: {A.theta: 0}, efforts: {A.theta: "1 N*m*time/(1 s)"}, time: {TIME}}'
    motion = motion.replace("TIME", "from: 0, to: 1, step: 0.01")
    result = mk.loads(f"{text[: text.index('responses:')]}responses: {{r: {motion}}}\n").respond(
        "r"
    )
    slope = np.tan(np.pi / 6.0)

    def held(force: float) -> float:
        return 0.04 * force - 0.0016 * np.hypot(slope * abs(force) + 240.0, 320.0 - force)

    def second(time: float) -> float:
        def left(force: float) -> float:
            return held(force) - 150e-6 * (time - 0.02 * force) / 100e-6

        return (time - 0.02 * brentq(left, -100.0, 1e3, xtol=1e-13)) / 100e-6

    start = 0.02 * brentq(held, 0.0, 100.0, xtol=1e-13)
    time, turn = result["time"], np.radians(result["A.theta"])
    rests = time < start
    np.testing.assert_array_equal(turn[rests], 0.0)
    np.testing.assert_allclose(result["G.tooth_force"][rests, 1], time[rests] / 0.02, atol=1e-12)
    moved = solve_ivp(
        lambda t, y: [y[1], second(t)], (start, 1.0), [0.0, 0.0], rtol=1e-11, atol=1e-11
    )
    assert turn[-1] == pytest.approx(moved.y[0, -1], rel=1e-9)
    assert set(result["row.status"]) == {"ok"}
    assert np.nanmax(result["row.energy_error"]) < 1e-9


def test_what_pushes_apart_has_true_errors_and_sensitivities() -> None:
    """With the secant k of the pressure angle F = 4 N m/(40 mm - 1.6 mm k) is at the teeth."""
    text = RUBBING.replace("teeth: [20, 40]", "teeth: [20, 40], pressure_angle: a")
    model = mk.loads(f"{text}parameters: {{a: 20 deg}}\n")

    def effort(degrees: mp.mpf) -> mp.mpf:
        secant = 1 / mp.cos(mp.radians(degrees))
        return 4000 / (40 - mp.mpf("1.6") * secant) * (20 + mp.mpf("0.5") * secant)

    result = model.analyze()
    assert result.errors["A.effort"].max() < 1e-11
    found = model.sensitivities(["A.effort"], ["a"])
    with mp.workdps(30):
        np.testing.assert_allclose(result["A.effort"], float(effort(mp.mpf(20))), rtol=1e-13)
        slope = float(mp.diff(effort, mp.mpf(20)))
    np.testing.assert_allclose(found["A.effort", "a"], slope, rtol=1e-12)
    varied = model.vary({"a": ["0 deg", "20 deg", "35 deg"]}, ["A.effort"])["A.effort"]
    for degrees, row in zip((0, 20, 35), varied, strict=True):
        np.testing.assert_allclose(row, float(effort(mp.mpf(degrees))), rtol=1e-12)


PLANET = (
    HEAD
    + """
links: {sun: {}, arm: {}, planet: {mass: 1, center_of_mass: [30, 0], inertia: 50}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, arm], point: [0, 0]}
  P: {type: R, links: [arm, planet], point: [30, 0]}
couplings:
  I: {type: gear, joints: [S, P], teeth: [18, 12], pressure_angle: 20}
  O: {type: gear, joints: [C, P], teeth: [42, 12], internal: true, pressure_angle: 25}
motion: {inputs: {S.theta: {from: 0, to: 300, count: 7, rate: 40 rad/s, acceleration: 900 rad/s^2}}}
loads:
  - {type: torque, joint: C, value: LOAD N*m}
  - {type: friction, joint: P, coefficient: 0.15, radius: 4}
"""
)


@pytest.mark.parametrize("load", [-6, 6])
def test_the_bearing_of_a_planet_rubs_by_both_meshes(load: int) -> None:
    """Its force and its friction hold the planet, whose mass centre turns with the arm."""
    result = mk.loads(PLANET.replace("LOAD", str(load))).analyze()
    assert set(result["row.status"]) == {"ok"}
    # on the planet; the sun's mesh has it as its second wheel, the ring's as well
    teeth = result["I.tooth_force"] + result["O.tooth_force"]
    force = result["P.force"] + teeth
    rate, second = result["C.theta_dot"], result["C.theta_ddot"]
    angle = np.radians(result["C.theta"])
    x, y = np.cos(angle), np.sin(angle)
    along, across = np.column_stack([x, y]), np.column_stack([-y, x])
    wanted = 0.03 * (second[:, None] * across - (rate**2)[:, None] * along)
    np.testing.assert_allclose(force, wanted, rtol=1e-10, atol=1e-9)
    size = np.hypot(*result["P.force"].T)
    np.testing.assert_allclose(result["P.normal_load"], size, rtol=1e-12)
    for name, degrees, side in (("I", 20.0, -1.0), ("O", 25.0, 1.0)):
        own = result[f"{name}.tooth_force"]
        radial, tangential = (own * along).sum(axis=1), (own * across).sum(axis=1)
        pushed = -side * np.tan(np.radians(degrees)) * np.abs(tangential)
        np.testing.assert_allclose(radial, pushed, rtol=1e-11)
    moments = [
        side * 0.012 * (result[f"{name}.tooth_force"] * across).sum(axis=1)
        for name, side in (("I", -1.0), ("O", 1.0))
    ]
    rubs = -np.sign(result["P.theta_dot"]) * 0.15 * 0.004 * size
    turning = 50e-6 * (second + result["P.theta_ddot"])
    np.testing.assert_allclose(sum(moments) + rubs, turning, rtol=1e-9, atol=1e-10)
    assert result["row.power_error"].max() < 1e-12


def test_rows_with_what_pushes_apart_are_the_same_in_lanes_of_any_width() -> None:
    text = RUBBING.replace("teeth: [20, 40]", "teeth: [20, 40], pressure_angle: 20")
    names = ["A.effort", "B.force", "G.tooth_force", "A.normal_load"]
    one, other = (mk.loads(text).analyze(names, lanes=lanes) for lanes in (2, max(widths())))
    moved = [mk.loads(text).respond("r", names, lanes=lanes) for lanes in (2, max(widths()))]
    for name in names:
        np.testing.assert_array_equal(one[name], other[name])
        np.testing.assert_array_equal(moved[0][name], moved[1][name])


@pytest.mark.parametrize("rate", [3.0, -3.0])
def test_teeth_that_push_apart_and_lose(rate: float) -> None:
    """On wheel B (80 mm) act 2 N*m and the teeth, so these push by F = 2 N*m/80 mm along and F
    tan(alpha) apart, which both bearings hold; wheel A (40 mm) drives it or is driven, and the
    driven side has the part 0.9 of the power."""
    result = mk.loads(f"""
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{}}, b: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0]}}
  B: {{type: R, links: [ground, b], point: [0.12, 0]}}
couplings:
  K: {{type: gear, joints: [A, B], radii: [0.04, 0.08], efficiency: 0.9, pressure_angle: 0.35 rad}}
motion: {{inputs: {{A.theta: {{from: 0, to: 1, count: 3, rate: {rate}}}}}}}
loads: [{{type: torque, joint: B, value: 2}}]
""").analyze()
    assert set(result["row.status"]) == {"ok"}
    # B turns at -rate/2, and 2 N*m put in or take 2 (-rate/2); lossless, A holds 1 N*m
    own = 1.0 / 0.9 if rate > 0.0 else 0.9
    np.testing.assert_allclose(result["A.effort"], own, rtol=1e-12)
    size = 2.0 / 0.08 / np.cos(0.35)
    for bearing in "AB":
        held = np.hypot(*result[f"{bearing}.force"].T)
        np.testing.assert_allclose(held, size, rtol=1e-12)
