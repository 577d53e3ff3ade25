"""Work over a cycle, harmonics and flywheels against closed forms at 40 digits."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk

BODY = """
format: 1
accept: [unphysical-inertia]
links:
  crank: {mass: 2, center_of_mass: [0.03, 0.01, 0], inertia: {zz: .02}}
  rod: {mass: 1.5, center_of_mass: [0.25, 0, 0], inertia: {zz: .03}}
  slider: {mass: 3, center_of_mass: [0.4, 0, 0]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, slider], point: [0.4, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [0.4, 0, 0], axis: [1, 0, 0]}
"""
TURN = "motion: {inputs: {A.theta: {from: 0, to: 360, step: 5, rate: 30 rad/s}}}\n"
LOADS = """loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: damper, joint: D, coordinate: s, damping: 12}
  - {type: force, joint: D, value: "-30 N - 20 N*sin(A.theta)"}
"""
WORK = "balances: [{name: work, type: work}]\n"
SHAKING = (
    "balances: [{name: h, type: harmonics, of: [ground.shaking_force], orders: [0, 1, 2, 4]}]\n"
)
FLYWHEEL = "balances: [{name: f, type: flywheel, unevenness: 0.02}]\n"


def balances(text: str) -> dict:
    analysis = mk.loads(text).analyze()
    assert not [d for d in analysis.diagnostics if d.severity == "error"]
    return analysis.balances


def slope(theta):
    """d s/d theta of the slide."""
    beta = mp.asin(mp.sin(theta) / 3)
    return -(mp.sin(theta) + mp.cos(theta) * mp.tan(beta)) / 10


def centres(theta):
    """Masses and their places along x and y."""
    beta = mp.asin(mp.sin(theta) / 3)
    c, s = mp.cos(theta), mp.sin(theta)
    crank = (mpf("0.03") * c - mpf("0.01") * s, mpf("0.03") * s + mpf("0.01") * c)
    rod = (c / 10 + mpf("0.15") * mp.cos(beta), s / 10 - mpf("0.15") * mp.sin(beta))
    return ((2, crank), (mpf("1.5"), rod), (3, (c / 10 + mpf("0.3") * mp.cos(beta), mpf(0))))


def inertia(theta):
    beta = mp.asin(mp.sin(theta) / 3)
    turn = mp.cos(theta) / (3 * mp.cos(beta))
    vx = -mp.sin(theta) / 10 - mpf("0.15") * mp.sin(beta) * turn
    vy = mp.cos(theta) / 10 - mpf("0.15") * mp.cos(beta) * turn
    crank = mpf("0.02") + 2 * mpf("0.001")
    rod = mpf("1.5") * (vx**2 + vy**2) + mpf("0.03") * turn**2
    return crank + rod + 3 * slope(theta) ** 2


def over_turn(function):
    """The integral over a turn: the trapezoidal rule with 240 places is exact to 40 digits."""
    return mp.fsum(function(2 * mp.pi * k / 240) for k in range(240)) * 2 * mp.pi / 240


def test_work_of_each_load_over_a_turn():
    found = balances(BODY + TURN + LOADS + WORK)["work"]
    work = dict(zip(found["of"], found["work"], strict=True))
    with mp.workdps(40):
        damper = -12 * 30 * over_turn(lambda x: slope(x) ** 2)
        force = over_turn(lambda x: -(30 + 20 * mp.sin(x)) * slope(x))
    assert abs(work["load 1: damper D"] - damper) < 1e-13
    assert abs(work["load 2: at joint D"] - force) < 1e-13
    assert abs(work["A.theta.effort"] + damper + force) < 1e-12
    assert abs(work["gravity"]) < 1e-14
    assert abs(work["inertia"]) < 1e-13
    assert abs(work["sum"]) < 1e-12
    assert (found["error"] < 1e-12).all()


@pytest.mark.parametrize("rate", ["30", "-7", "0"])
def test_a_law_that_reads_rates_works_as_a_damper_does(rate):
    turn = TURN.replace("rate: 30", f"rate: {rate}")
    damper = "loads: [{type: damper, joint: D, coordinate: s, damping: 12}]\n"
    law = "loads: [{type: force, joint: D, value: -12 N*s/m*D.s_dot}]\n"
    one, other = (balances(BODY + turn + load + WORK)["work"] for load in (damper, law))
    assert np.abs(one["work"] - other["work"]).max() < 1e-14
    assert (np.abs(one["work"]).max() > 1) == (rate != "0")


def test_harmonics_of_the_shaking_force():
    """-sum of m a from the places' second derivatives."""
    found = balances(BODY + TURN + SHAKING)["h"]
    with mp.workdps(30):
        for axis, letter in enumerate("xyz"):
            rows = [k for k, name in enumerate(found["of"]) if name.endswith(letter)]
            for row in rows:
                order = int(found["order"][row])

                def shaking(x, axis=axis):
                    if axis == 2:
                        return mpf(0)
                    total = lambda t: mp.fsum(m * place[axis] for m, place in centres(t))  # noqa: E731
                    return -900 * mp.diff(total, x, 2)

                factor = (2 if order else 1) / (2 * mp.pi)
                cosine = factor * over_turn(lambda x, n=order: shaking(x) * mp.cos(n * x))
                sine = factor * over_turn(lambda x, n=order: shaking(x) * mp.sin(n * x))
                assert abs(found["cosine"][row] - cosine) < 1e-11
                assert abs(found["sine"][row] - sine) < 1e-11
                assert abs(found["amplitude"][row] - mp.hypot(cosine, sine)) < 1e-11
                if abs(cosine) + abs(sine) > 1:
                    phase = mp.degrees(mp.atan2(sine, cosine))
                    turned = abs(found["phase"][row] - phase) % 360
                    assert min(turned, 360 - turned) < 1e-10


@pytest.mark.parametrize(
    "motion",
    [
        "from: 40, to: 400, step: 5",
        "from: 360, to: 0, step: 5",
        "from: -360, to: 360, step: 5",
        "from: 7.5, to: 367.5, count: 121",
    ],
)
def test_harmonics_are_those_of_the_angle_wherever_the_rows_begin(motion):
    plain = balances(BODY + TURN + SHAKING)["h"]
    other = TURN.replace("from: 0, to: 360, step: 5", motion)
    found = balances(BODY + other + SHAKING)["h"]
    for label in ("cosine", "sine", "amplitude"):
        assert np.abs(found[label] - plain[label]).max() < 1e-10


def test_two_turns_have_half_orders_too():
    two = TURN.replace("to: 360", "to: 720")
    text = BODY + two + SHAKING.replace("[0, 1, 2, 4]", "[0.5, 1]")
    text += "loads: [{type: force, joint: D, value: 8 N*sin(A.theta/2)}]\n"
    found = balances(text.replace("ground.shaking_force", "C.force.x"))["h"]
    assert abs(found["sine"][0] + 8) < 1e-12
    assert abs(found["cosine"][0]) < 1e-12


def test_a_flywheel_keeps_the_unevenness():
    """The rate of the machine with what was found, from energies at 40 digits."""
    found = balances(BODY + TURN + LOADS + FLYWHEEL)["f"]
    wheel, drive = found["flywheel"][0], found["drive"][0]
    with mp.workdps(20):
        pieces = 240
        loads = lambda x: (  # noqa: E731
            -12 * 30 * slope(x) ** 2
            - (30 + 20 * mp.sin(x)) * slope(x)
            - mpf("9.81")
            * mp.fsum(
                m * mp.diff(lambda t, i=i: centres(t)[i][1][1], x)
                for i, (m, _) in enumerate(centres(x))
            )
        )
        angles = [2 * mp.pi * k / pieces for k in range(pieces + 1)]
        moments = [loads(x) for x in angles]
        # Fourier integration of the periodic part
        mean = mp.fsum(moments[:-1]) / pieces
        assert abs(drive + mean) < 1e-12
        work = fourier_integral([m - mean for m in moments[:-1]])
        inertias = [inertia(x) + mpf(float(wheel)) for x in angles[:-1]]
        low, high = 30 * mpf("0.99"), 30 * mpf("1.01")
        level = max(low**2 / 2 * j - w for j, w in zip(inertias, work, strict=True))
        rates = [mp.sqrt(2 * (level + w) / j) for j, w in zip(inertias, work, strict=True)]
    assert abs(max(rates) - high) < 2e-3 * (high - low)
    assert abs(min(rates) - low) < 2e-3 * (high - low)
    assert found["estimate"][0] == pytest.approx(wheel, rel=0.1)
    assert abs(found["estimate"][0] - wheel) > 1e-3 * wheel


def fourier_integral(samples):
    """Of samples of a periodic function without mean, at the same places."""
    count = len(samples)
    orders = range(1, 40)
    angle = 2 * mp.pi / count
    table = [(mp.cos(angle * k), mp.sin(angle * k)) for k in range(count)]
    found = [mpf(0)] * count
    for n in orders:
        a = 2 * mp.fsum(s * table[n * k % count][0] for k, s in enumerate(samples)) / count
        b = 2 * mp.fsum(s * table[n * k % count][1] for k, s in enumerate(samples)) / count
        for k in range(count):
            c, s = table[n * k % count]
            found[k] += (a * s - b * c) / n
    return found


DISC = """
format: 1
links: {disc: {mass: 1, center_of_mass: [0, 0, 0], inertia: {xx: .01, yy: .01, zz: .02}}}
joints: {A: {type: R, links: [ground, disc], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 3, rate: 20 rad/s}}}
loads: [{type: torque, joint: A, value: "-10 N*m - 4 N*m*sin(A.theta)"}]
balances: [{name: f, type: flywheel, unevenness: 0.02}]
"""


def test_the_flywheel_of_a_disc():
    """J constant: fluctuation / (unevenness rate^2) - J; the fluctuation is 8 N m."""
    found = balances(DISC)["f"]
    assert abs(found["flywheel"][0] - (8 / (0.02 * 400) - 0.02)) < 1e-12
    assert abs(found["estimate"][0] - 8 / (0.02 * 400)) < 1e-12
    assert abs(found["drive"][0] - 10) < 1e-14
    assert abs(found["work_fluctuation"][0] - 8) < 1e-11
    # with J alone: 8 = J unevenness rate^2
    assert abs(found["unevenness_without"][0] - 1.0) < 1e-11
    slow = balances(DISC.replace("0.02}]", "0.02, rate: 10 rad/s}]"))["f"]
    assert abs(slow["flywheel"][0] - (8 / (0.02 * 100) - 0.02)) < 1e-11
    assert np.isnan(slow["unevenness_without"][0])


def test_no_flywheel_where_none_is_needed():
    found = balances(DISC.replace("unevenness: 0.02", "unevenness: 1.5"))["f"]
    assert found["flywheel"][0] == 0.0
    assert found["unevenness_without"][0] < 1.5


def test_a_cycle_in_time():
    """A damper under a harmonic law takes c amplitude^2 frequency pi a period."""
    text = DISC[: DISC.index("motion")] + (
        "motion:\n  time: {from: 0, to: 2, count: 81}\n"
        "  inputs: {A.theta: {with: '30 deg*sin(180 deg/s*time)'}}\n"
        "loads: [{type: damper, joint: A, coordinate: theta, damping: 3}]\n"
        "balances: [{name: work, type: work}, {name: h, type: harmonics, of: [A.effort], "
        "orders: [1]}]\n"
    )
    found = balances(text)
    with mp.workdps(30):
        amplitude, omega = mp.radians(30), mp.pi
        taken = 3 * amplitude**2 * omega * mp.pi
        # the effort is J x'' + c x'
        wanted = amplitude * mp.hypot(mpf("0.02") * omega**2, 3 * omega)
    work = dict(zip(found["work"]["of"], found["work"]["work"], strict=True))
    assert abs(work["load 1: damper A"] + taken) < 1e-13
    assert abs(work["A.theta.effort"] - taken) < 1e-13
    assert abs(found["h"]["amplitude"][0] - wanted) < 1e-13


def test_inputs_that_follow_work_along():
    text = """
format: 1
links:
  upper: {mass: 2, center_of_mass: [0.3, 0, 0]}
  lower: {mass: 1, center_of_mass: [0.9, 0, 0]}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [upper, lower], point: [0.5, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10}, B.theta: {with: -2*A.theta}}}
loads: [{type: gravity, g: [0, -9.81, 0]}, {type: torque, joint: B, value: 5}]
balances: [{name: work, type: work}]
"""
    found = balances(text)["work"]
    work = dict(zip(found["of"], found["work"], strict=True))
    assert abs(work["load 1: at joint B"] + 20 * np.pi) < 1e-12
    assert abs(work["B.theta.effort"] + work["A.theta.effort"] - 20 * np.pi) < 1e-11
    assert abs(work["sum"]) < 1e-11


# --- what is wrong ------------------------------------------------------------------------------


def refused(text: str) -> str:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("to: 360", "to: 355", ["5 deg are missing to a full turn", "write to: 360"]),
        ("from: 0, to: 360, step: 5", "values: [0, 5, 30, 180, 270, 360]", ["equal distances"]),
        ("from: 0, to: 360, step: 5", "values: [0, 180, 360]", ["too few"]),
        ("from: 0, to: 360, step: 5, rate: 30 rad/s", "at: 3", ["nothing moves"]),
        ("type: work}", "type: work, cycle: D.s}", ["D.s is not an input", "inputs are A.theta"]),
        ("type: work}", "type: work, cycle: time}", ["the sweep has no time"]),
        ("type: work}", "type: labour}", ["work, harmonics, flywheel"]),
        ("name: work", "name: sweep", ["another table or balance is called sweep"]),
        ("name: work", "name: rows", ["every run writes a table rows"]),
        ("type: work}", "type: flywheel, unevenness: 0}", ["between 0 and 2"]),
        ("rate: 30 rad/s", "rate: 0 rad/s", ["no constant rate", "give rate:"]),
        ("type: work}", "type: harmonics, of: [B.forc]}", ["B.forc"]),
        ("type: work}", "type: harmonics, of: [B.force, A.effort]}", ["one dimension"]),
        ("type: work}", "type: harmonics, of: [B.force.x], orders: [36]}", ["up to 35"]),
        ("type: work}", "type: harmonics, of: [B.force.x], orders: [0.5]}", ["multiples of 1"]),
    ],
)
def test_what_the_file_decides_is_refused_at_its_place(old, new, words):
    text = BODY + TURN + WORK
    if "rate: 0" in new:
        text = text.replace("type: work}", "type: flywheel, unevenness: 0.1}")
    assert old in text
    message = refused(text.replace(old, new))
    assert "text:14:" in message
    for word in words:
        assert word in message


def faults(text: str) -> tuple[list, dict]:
    analysis = mk.loads(text).analyze()
    assert not analysis.complete
    return [d for d in analysis.diagnostics if d.severity == "error"], analysis.balances


def test_a_spring_that_winds_up_is_no_cycle():
    spring = "loads: [{type: spring, joint: A, coordinate: theta, stiffness: 2}]\n"
    found, tables = faults(BODY + TURN + spring + WORK)
    assert {d.code for d in found} == {"cycle-not-closed"}
    assert any("load 1: spring A" in d.message for d in found)
    assert found[0].place is not None
    assert np.isnan(tables["work"]["work"]).any()


def test_rows_without_a_solution_are_named():
    text = (BODY + TURN + WORK).replace(
        "point: [0.4, 0, 0], axis: [0, 0, 1]", "point: [0.15, 0, 0], axis: [0, 0, 1]"
    )
    text = text.replace("[0.4, 0, 0], axis: [1", "[0.15, 0, 0], axis: [1")
    found, tables = faults(text)
    assert "balance-undefined" in {d.code for d in found}
    assert np.isnan(tables["work"]["work"]).all()


def test_files_json_and_exit_code(tmp_path):
    path = tmp_path / "m.yaml"
    path.write_text(BODY + TURN + LOADS + WORK, encoding="utf-8")
    command = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", str(path), "--json"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "out")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    table = next(t for t in record["tables"] if t["name"] == "work")
    assert table["columns"][0]["values"][0] == "A.theta.effort"
    assert table["columns"][1]["unit"] == "N*m"
    lines = (tmp_path / "out" / "work.csv").read_text().splitlines()
    assert lines[0] == "of,work,error"
    assert len(lines) == 7
    assert "| A.theta.effort" in (tmp_path / "out" / "work.md").read_text()
    path.write_text(
        BODY + TURN + WORK + "loads: [{type: spring, joint: A, coordinate: theta, stiffness: 2}]\n"
    )
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 4
    assert ":14:" in done.stderr


def test_friction_works_in_the_balance():
    """A pivot that rubs is all that takes what the effort puts in."""
    force = "loads:\n  - {type: force, link: slider, point: [0.4, 0, 0], force: [0, 50, 0]}\n"
    rubs = "  - {type: friction, joint: A, coefficient: 0.1, radius: 8 mm}\n"
    free = BODY.replace("C: {type: R", "C: {type: S").replace(
        "point: [0.4, 0, 0], axis: [0, 0, 1]}\n  D", "point: [0.4, 0, 0]}\n  D"
    )
    free = free.replace("B: {type: R", "B: {type: U").replace(
        "point: [0.1, 0, 0], axis: [0, 0, 1]}",
        "point: [0.1, 0, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}",
    )
    found = balances(free + TURN + force + rubs + WORK)["work"]
    work = dict(zip(found["of"], found["work"], strict=True))
    assert work["friction"] < 0.0
    assert abs(work["A.theta.effort"] + work["friction"]) < 1e-12
    assert abs(work["sum"]) < 1e-12
