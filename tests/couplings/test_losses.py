"""Efficiencies of couplings and friction between the flanks of worms, against closed forms
(Shigley, Mechanical Engineering Design, force analysis of worm gearing)."""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths
from mechkin_cli.tape.double_double import exactly

SPUR = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, w2], point: [90, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 500, count: 3, rate: 10 rad/s}}}
loads: [{type: torque, joint: B, value: LOAD N*m}]
couplings:
  G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 20, efficiency: 0.9}
"""


@pytest.mark.parametrize("efficiency", [0.9, 0.4, 1.0])
def test_the_smaller_power_is_a_share_of_the_larger(efficiency: float) -> None:
    """The second wheel turns at -5 rad/s: a load of 6 N m brakes it with 30 W, one of -6 N m drives
    it."""
    text = SPUR.replace("0.9}", f"{efficiency}}}")
    braked = mk.loads(text.replace("LOAD", "6")).analyze()
    np.testing.assert_allclose(braked["A.effort"], 3000.0 / efficiency, rtol=1e-12)
    lost = 30.0 * (1.0 / efficiency - 1.0)
    np.testing.assert_allclose(braked["G.friction_power"], lost * 1e3, rtol=1e-12, atol=1e-9)
    driven = mk.loads(text.replace("LOAD", "-6")).analyze()
    np.testing.assert_allclose(driven["A.effort"], -3000.0 * efficiency, rtol=1e-12)
    for result in (braked, driven):
        assert np.abs(result["row.power_error"]).max() < 1e-9 * 3e4


WORM = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {worm: {}, wheel: {}}
joints:
  A: {type: R, links: [ground, worm], point: [-50, 0, 0], axis: [1, 0, 0]}
  B: {type: R, links: [ground, wheel], point: [0, 125, 10], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 7200, count: 3, rate: RATE rad/s}}}
loads: [{type: torque, joint: B, value: 100 N*m}]
couplings:
  G:
    {type: gear, joints: [A, B], teeth: [2, 40], radii: [25, 100], pressure_angle: 20, HELIX,
      friction: MU}
""".replace("HELIX", 'helix: "90 deg - atan(0.2)"')
LEAD, COSINE = 0.2, float(np.cos(np.pi / 9))


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.08, 0.3])
def test_a_worm_drives_its_wheel_against_friction(friction: float) -> None:
    """The wheel's load of 100 N m brakes it; at 20 to 1 it is 5 N m without friction."""
    worm = WORM.replace("RATE", "10").replace("MU", str(friction))
    result = mk.loads(worm).analyze()
    share = (COSINE - friction * LEAD) / (COSINE * LEAD + friction) * LEAD
    np.testing.assert_allclose(result["A.effort"], 5000.0 / share, rtol=1e-12)
    if friction:
        np.testing.assert_allclose(result["G.efficiency"], share, rtol=1e-12)
    # along the wheel's axis: what the worm's rim pushes, by its moment
    np.testing.assert_allclose(np.abs(result["B.axial_force"]), 5000.0 / share / 25.0, rtol=1e-12)
    assert np.abs(result["row.power_error"]).max() < 1e-9 * 5e4


@pytest.mark.parametrize("friction", [0.05, 0.1, 0.18, 0.2, 0.3])
def test_a_worm_locks_where_friction_is_more_than_its_lead(friction: float) -> None:
    """Driven by the wheel: from mu = cos(20 deg) tan(lead) on the worm has to be pushed."""
    worm = WORM.replace("RATE", "-10").replace("MU", str(friction))
    result = mk.loads(worm).analyze()
    share = (COSINE * LEAD - friction) / (COSINE + friction * LEAD) / LEAD
    np.testing.assert_allclose(result["A.effort"], 5000.0 * share, rtol=1e-11)
    locks = friction >= COSINE * LEAD
    assert any(d.code == "self-locking" for d in result.diagnostics) == locks
    if locks:
        assert np.isnan(result["G.efficiency"]).all()
    else:
        np.testing.assert_allclose(result["G.efficiency"], share, rtol=1e-11)


def test_an_efficiency_is_told_where_power_flows() -> None:
    """Without a load none flows."""
    moving = mk.loads(SPUR.replace("LOAD", "6")).analyze()
    np.testing.assert_allclose(moving["G.efficiency"], 0.9, rtol=1e-12)
    idle = mk.loads(SPUR.replace("LOAD", "0")).analyze()
    assert np.isnan(idle["G.efficiency"]).all()
    np.testing.assert_array_equal(idle["A.effort"], 0.0)


SHAFTS = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {mass: 1, center_of_mass: [0, 0], inertia: 2}
  b: {mass: 1, center_of_mass: [1, 0], inertia: 3}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [1, 0]}
couplings:
  G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 20 deg, efficiency: 0.9}
responses:
  r:
    start: {A.theta: 0, A.theta_dot: RATE}
    efforts: {A.theta: AT_A, B.theta: AT_B}
    time: {from: 0, to: 1, step: 0.25}
"""


def test_an_accelerated_wheel_gets_a_share_of_the_moment() -> None:
    """7 N m on the first wheel accelerate the second, half as fast, by 3 kg m^2/4/0.9 more; on the
    second they are 0.9 of 3.5 N m at the first, whose 2 kg m^2 weigh 1/0.9 as much there."""
    for at, acceleration in (
        ((1, 0), 7.0 / (2.0 + 0.75 / 0.9)),
        ((0, 1), -3.5 / (0.75 + 2.0 / 0.9)),
    ):
        text = SHAFTS.replace("AT_A", str(7 * at[0])).replace("AT_B", str(7 * at[1]))
        text = text.replace("RATE", "0")
        names = ["A.theta", "A.theta_dot", "G.friction_power", "G.efficiency"]
        names += ["row.status", "row.energy_error", "row.power_error", "row.dissipated"]
        result = mk.loads(text).respond("r", names)
        assert set(result["row.status"]) == {"ok"}
        times = np.linspace(0.0, 1.0, 5)
        np.testing.assert_allclose(
            result["A.theta"], 0.5 * acceleration * times**2, rtol=1e-9, atol=1e-12
        )
        moved = 7.0 * abs(acceleration) * 0.5 * (1.0 if at[0] else 0.5)
        kinetic = 0.5 * (2.0 + 0.75) * acceleration**2
        np.testing.assert_allclose(result["row.dissipated"][-1], moved - kinetic, rtol=1e-8)
        np.testing.assert_allclose(result["G.efficiency"][1:], 0.9, rtol=1e-9)
        assert np.nanmax(result["row.energy_error"]) < 1e-9
        assert np.nanmax(result["row.power_error"]) < 1e-9


def test_a_wheel_that_runs_down_drives_the_other() -> None:
    """A brake of 7 N m at the first wheel: the second drives it, then both turn back, driven by the
    first; the deceleration is 7/(2 + .75*.9), the acceleration 7/(2 + .75/.9)."""
    text = SHAFTS.replace("AT_A", "-7").replace("AT_B", "0").replace("RATE", "1")
    result = mk.loads(text).respond("r", ["A.theta_dot", "row.status"])
    down, back = 7.0 / (2.0 + 0.75 * 0.9), 7.0 / (2.0 + 0.75 / 0.9)
    stop = 1.0 / down
    times = np.linspace(0.0, 1.0, 5)
    wanted = np.where(times < stop, 1.0 - down * times, -back * (times - stop))
    np.testing.assert_allclose(result["A.theta_dot"], wanted, rtol=1e-9)


@pytest.mark.parametrize("friction", [0.05, 0.15, 0.25])
def test_a_loaded_wheel_sets_its_worm_in_motion_or_is_held(friction: float) -> None:
    """The worm's inertia of 0.002 kg m^2 takes the share of 5 N m that the wheel, without inertia,
    gives; with more friction than cos(20 deg) tan(lead) all stays at rest."""
    text = WORM.replace("MU", str(friction)).replace(
        "{worm: {}", "{worm: {mass: 1, center_of_mass: [-50, 0, 0], inertia: INERTIA}"
    )
    head, rest = text.split("motion:")
    text = head + rest[rest.index("loads:") :]
    text = text.replace("INERTIA", "{xx: 2000, yy: 2000, zz: 2000}")
    text += "responses: {r: {start: {A.theta: 0}, time: {from: 0, to: 0.2, step: 0.05}}}\n"
    result = mk.loads(text).respond("r", ["A.theta", "B.theta", "row.status", "G.friction_power"])
    share = (COSINE * LEAD - friction) / (COSINE + friction * LEAD) / LEAD
    turn = np.degrees(0.5 * max(share, 0.0) * 5.0 / 0.002 * np.linspace(0.0, 0.2, 5) ** 2)
    np.testing.assert_allclose(np.abs(result["A.theta"]), turn, rtol=1e-9, atol=1e-9)
    assert set(result["row.status"]) == {"ok"}


PLANET = """
format: 1
plane: xy
units: {length: mm, angle: rad, mass: kg, force: N}
links: {sun: {}, arm: {}, planet: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, arm], point: [0, 0]}
  P: {type: R, links: [arm, planet], point: [30, 0]}
couplings:
  I: {type: gear, joints: [S, P], teeth: [18, 12], pressure_angle: 20 deg, efficiency: 0.9}
  O: {type: gear, joints: [C, P], teeth: [42, 12], internal: true}
motion: {inputs: {S.theta: {from: 0, to: 1, count: 3, rate: 10 rad/s}}}
loads: [{type: torque, joint: C, value: LOAD}]
"""


@pytest.mark.parametrize(("load", "share"), [(-6.0, 0.9), (6.0, 1.0 / 0.9)])
def test_a_loss_of_a_planetary_gear_is_of_the_power_against_its_carrier(
    load: float, share: float
) -> None:
    """With the ring held the moments of arm and sun are as 1 + eta 42/18, eta of the power that the
    sun gives while the carrier stands (Mueller, Die Umlaufgetriebe)."""
    result = mk.loads(PLANET.replace("LOAD", f"{load} N*m")).analyze()
    np.testing.assert_allclose(
        result["S.effort"], -load * 1e3 / (1.0 + share * 42 / 18), rtol=1e-12
    )
    np.testing.assert_allclose(result["I.efficiency"], 0.9, rtol=1e-11)
    assert np.abs(result["row.power_error"]).max() < 1e-9 * 6e4


DRIVES = """
format: 1
units: {length: mm, angle: rad, mass: kg, force: N}
links: {turning: {}, sliding: {}, other: {}}
joints:
  A: {type: R, links: LINKS, point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, sliding], point: [0, 20, 0], axis: AXIS}
  B: {type: R, links: [ground, other], point: [200, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 1, count: 3, rate: 10 rad/s}, FREE.FREE_C: {at: 0}}}
loads: [{type: LOAD, joint: OUT, value: VALUE}]
couplings: {K: {COUPLING, efficiency: 0.8}}
"""


@pytest.mark.parametrize("links", ["[ground, turning]", "[turning, ground]"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("coupling", "out", "rate"),
    [
        ("type: rack, joints: [A, S], radius: 20, pressure_angle: 20 deg", "S.s", 20.0),
        ("type: screw, joints: [A, S], lead: 5", "S.s", 5.0 / (2.0 * np.pi)),
        ("type: belt, joints: [A, B], radii: [20, 50], pretension: 100 N", "B.theta", 0.4),
        ("type: chain, joints: [A, B], teeth: [17, 34], pitch: 9", "B.theta", 0.5),
        ("type: gear, joints: [A, B], teeth: [20, 60], ideal: true", "B.theta", 1.0 / 3.0),
    ],
)
def test_every_drive_has_its_efficiency(
    coupling: str, out: str, rate: float, sign: float, links: str
) -> None:
    """The load of 3 N or 3 N m takes or gives power at `rate` times the first wheel's."""
    joint, coordinate = out.split(".")
    slides = coordinate == "s"
    free = "B.theta" if slides else "S.s"
    text = DRIVES.replace("LINKS", links).replace("FREE.FREE_C", free).replace("OUT", joint)
    text = text.replace("AXIS", "[0, 0, 1]" if "screw" in coupling else "[1, 0, 0]")
    text = text.replace("COUPLING", coupling)
    text = text.replace("LOAD", "force" if slides else "torque")
    text = text.replace("VALUE", f"{3.0 * sign} {'N' if slides else 'N*m'}")
    result = mk.loads(text).analyze()
    moves = float(np.sign(result[f"{out}_dot"][0]))
    np.testing.assert_allclose(np.abs(result[f"{out}_dot"]), 10.0 * rate, rtol=1e-12)
    share = 1.0 / 0.8 if moves * sign < 0.0 else 0.8
    wanted = -moves * sign * 3.0 * rate * share * (1.0 if slides else 1e3)
    np.testing.assert_allclose(result["A.effort"], wanted, rtol=1e-11)
    np.testing.assert_allclose(result["K.efficiency"], 0.8, rtol=1e-11)
    assert np.abs(result["row.power_error"]).max() < 1e-8


WRONG = {
    "nothing comes out": ("efficiency: 0.9", "efficiency: 0", "more than 0, at most 1"),
    "it says so": ("efficiency: 0.9", "efficiency: 0", "nothing would come out, whatever is put"),
    "more comes out": ("efficiency: 0.9", "efficiency: 1.1", "more than 0, at most 1"),
    "in percent": ("efficiency: 0.9", "efficiency: 98", "0.98 for 98 %"),
    "both": ("efficiency: 0.9", "efficiency: 0.9, friction: 0.1", "both tell the losses"),
    "no sliding": ("efficiency: 0.9", "friction: 0.1", "slide at their pitch point"),
    "no teeth": (
        "pressure_angle: 20, efficiency: 0.9",
        "ideal: true, friction: 0.1",
        "no teeth that slide",
    ),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_losses_that_cannot_be_are_refused(before: str, after: str, words: str) -> None:
    assert before in SPUR
    with pytest.raises(InvalidFile) as told:
        mk.loads(SPUR.replace("LOAD", "6").replace(before, after))
    assert any(words in f"{d} {d.limit} {d.hint}" for d in told.value.diagnostics)


def test_friction_below_zero_is_refused() -> None:
    with pytest.raises(InvalidFile) as told:
        mk.loads(WORM.replace("RATE", "1").replace("MU", "-0.1"))
    assert any(d.limit == "at least 0" for d in told.value.diagnostics)


@pytest.mark.parametrize("lanes", widths())
def test_rows_are_the_same_in_lanes_of_any_width(lanes: int) -> None:
    names = ["A.effort", "G.efficiency", "G.friction_power", "B.force"]
    for text in (SPUR.replace("LOAD", "6"), WORM.replace("RATE", "10").replace("MU", "0.08")):
        model = mk.loads(text)
        one, other = model.analyze(names), model.analyze(names, lanes=lanes)
        for name in names:
            np.testing.assert_array_equal(one[name], other[name])


RUBBED = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  motor: {mass: 1, center_of_mass: [-1, 0], inertia: 0.1}
  a: {mass: 1, center_of_mass: [0.2, 0], inertia: 0.1}
  b: {mass: 2, center_of_mass: [1.5, 0.4], inertia: 0.2}
  c: {mass: 1, center_of_mass: [2.5, 0.5], inertia: 0.1}
joints:
  M: {type: R, links: [ground, motor], point: [-1, 0]}
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0.5, 0]}
  C: {type: R, links: [b, c], point: [2.5, 1.5]}
  D: {type: R, links: [c, ground], point: [2, 0]}
couplings: {G: {type: gear, joints: [M, A], teeth: [20, 60], efficiency: 0.85}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: friction, joint: B, coefficient: 0.2, radius: 0.05}
  - {type: friction, joint: M, coefficient: 0.1, radius: 0.03}
"""


def test_joints_and_teeth_rub_together_in_a_loop() -> None:
    """Powers and energies balance; bearings rub by the forces of the teeth."""
    law = "{from: 0, to: 18.8, count: 31, rate: 10, acceleration: 3}"
    result = mk.loads(f"{RUBBED}motion: {{inputs: {{M.theta: {law}}}}}").analyze()
    assert set(result["row.status"]) == {"ok"}
    assert result["row.power_error"].max() < 1e-13
    np.testing.assert_allclose(result["G.efficiency"], 0.85, rtol=1e-9)
    motion = "{start: {A.theta: 0.2}, efforts: {M.theta: 3}, time: {from: 0, to: 1, step: 0.25}}"
    names = ["G.efficiency", "row.status", "row.energy_error", "row.power_error"]
    moved = mk.loads(f"{RUBBED}responses: {{r: {motion}}}").respond("r", names)
    assert set(moved["row.status"]) == {"ok"}
    assert moved["row.energy_error"].max() < 1e-9
    assert moved["row.power_error"][1:].max() < 1e-13
    np.testing.assert_allclose(moved["G.efficiency"][1:], 0.85, rtol=1e-9)


def share_of_worm(friction: mp.mpf) -> mp.mpf:
    cosine, lead = mp.cos(mp.pi / 9), mp.mpf("0.2")
    return (cosine - friction * lead) / (cosine * lead + friction) * lead


@pytest.mark.parametrize(
    ("text", "parameter", "at", "effort"),
    [
        (SPUR, "efficiency: 0.9", "0.9", lambda share: 3000 / share),
        (WORM, "friction: MU", "0.08", lambda friction: 5000 / share_of_worm(friction)),
    ],
    ids=["efficiency", "friction"],
)
def test_losses_of_a_sweep_have_true_errors_and_sensitivities(
    text: str, parameter: str, at: str, effort: Callable[[mp.mpf], mp.mpf]
) -> None:
    key = parameter.partition(":")[0]
    text = text.replace(parameter, f"{key}: x").replace("LOAD", "6").replace("RATE", "10")
    model = mk.loads(f"{text}parameters: {{x: {at}}}\n")
    errors = model.analyze(["A.effort", "G.efficiency"]).errors
    found = model.sensitivities(["A.effort"], ["x"])
    with mp.workdps(50):
        x = mp.mpf(at)
        value, slope, bend = effort(x), mp.diff(effort, x), mp.diff(effort, x, 2)
        for cell in exactly(errors.repeated.quantity("A.effort").value):
            in_file_units = 1000 * (mp.mpf(float(cell.high)) + mp.mpf(float(cell.low)))
            assert abs(in_file_units - value) < 1e-27 * value
    assert errors["A.effort"].max() < 1e-14 * value
    assert errors["G.efficiency"].max() < 1e-15
    np.testing.assert_allclose(found["A.effort", "x"], float(slope), rtol=1e-12)
    scale = float(value / x**2)
    np.testing.assert_allclose(found.curvature("A.effort", "x"), float(bend), atol=1e-7 * scale)


def test_losses_without_a_direction_have_no_errors() -> None:
    still = mk.loads(SPUR.replace("LOAD", "6").replace(", rate: 10 rad/s", "")).analyze()
    assert set(still["row.status"]) == {"friction-undecided"}
    assert np.isnan(still.errors["A.effort"]).all()
    assert still.errors["B.theta"].max() < 1e-13


def test_where_a_load_turns_round_a_loss_has_no_slope() -> None:
    """A drive needs 1/eta of a load that brakes and eta of one that drives it."""
    model = mk.loads(SPUR.replace("LOAD N*m", "load") + "parameters: {load: 0 N*m}\n")
    found = model.sensitivities(["A.effort", "B.theta_dot"], ["load"])
    assert set(found.verdict("A.effort", "load")) == {"bent"}
    assert set(found.verdict("B.theta_dot", "load")) == {"ok"}


def test_a_response_with_losses_says_what_is_not_repeated() -> None:
    text = SHAFTS.replace("AT_A", "7").replace("AT_B", "0").replace("RATE", "1")
    errors = mk.loads(text).respond("r", ["A.theta_dot"]).errors
    assert errors.why["r.A.theta"].startswith("efficiency of G: when what rubs sticks and slips")
