"""The law of bushings: what holds a body at any pose is the gradient of their energy."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from bushings.energy import POSE, Bushing, mp, slope

import mechkin_cli as mk
from mechkin_cli.errors.errors import true_values
from mechkin_cli.errors.rows import Repeated, wide_run
from mechkin_cli.expressions.expression import parse
from mechkin_cli.mechanism.pairs import is_angle
from mechkin_cli.proofs.boxes import Enclosed
from mechkin_cli.proofs.enclose import EnclosedInputs, Positions, enclose

GIVEN = [
    [100.0, 10, 0, 0, 20, 5],
    [10, 200, 0, -30, 0, 0],
    [0, 0, 300, 0, 0, 0],
    [0, -30, 0, 40, 0, 0],
    [20, 0, 0, 0, 60, 7],
    [5, 0, 0, 0, 7, 50],
]
POINTS = ([0.3, -0.1, 0.2], [-0.4, 0.2, 0.1])
X, Y = [3.0, 4.0, 0.0], [-4.0, 3.0, 0.0]
FREE = {"z": -0.02, "rx": 0.3}

MECHANISM = """format: 1
units: {angle: rad}
links: {body: {}}
joints: {pose: {type: F, links: [ground, body], point: [0, 0, 0]}}
motion: {inputs: {INPUTS}}
loads:
  - {type: bushing, name: one, links: [ground, body], point: P0, axes: {x: AX, y: AY},
     stiffness: MATRIX}
  - {type: bushing, name: two, links: [ground, body], point: P1,
     stiffness: {x: 20, y: 30, z: 50, rx: 2, ry: 3, rz: 1.5}, free: {z: -0.02, rx: 0.3}}
"""


@cache
def poses() -> dict[str, list[float]]:
    """Slides up to .5 m, and turns whose rotation is up to 170 degrees; the last is the drawing."""
    rng = np.random.default_rng(7)
    rows = [[0.5, -0.2, 0.1, 0.0, 0.0, 2.9], [0.0, 0.0, 0.0, 1e-9, -2e-9, 3e-9]]
    while len(rows) < 12:
        row = rng.uniform([-0.5] * 3 + [-2.5, -1.5, -2.5], [0.5] * 3 + [2.5, 1.5, 2.5])
        # no row near half a turn, where there is no rotation vector
        if abs(rotation_of(dict(zip(POSE, row, strict=True)))) < 2.95:
            rows.append([float(x) for x in row])
    rows.append([0.0] * 6)
    return {name: [row[k] for row in rows] for k, name in enumerate(POSE)}


def rotation_of(pose: dict[str, float]) -> float:
    plain = Bushing([0, 0, 0], mp.eye(3), mp.eye(6))
    return float(mp.norm(plain.deflection({n: mp.mpf(float(x)) for n, x in pose.items()})[3:6]))


def bushings() -> list[Bushing]:
    axes = mp.matrix([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])
    axes[0, 0] = axes[1, 1] = mp.mpf(3) / 5
    axes[1, 0], axes[0, 1] = mp.mpf(4) / 5, -mp.mpf(4) / 5
    free = [0, 0, mp.mpf("-0.02"), mp.mpf("0.3"), 0, 0]
    diagonal = mp.diag([20, 30, 50, 2, 3, mp.mpf(3) / 2])
    points = [[mp.mpf(str(x)) for x in point] for point in POINTS]
    return [Bushing(points[0], axes, GIVEN), Bushing(points[1], mp.eye(3), diagonal, free)]


@cache
def analysis() -> mk.Analysis:
    inputs = ", ".join(f"pose.{name}: {{values: {rows}}}" for name, rows in poses().items())
    text = MECHANISM.replace("INPUTS", inputs).replace("MATRIX", str(GIVEN))
    for word, value in {"P0": POINTS[0], "P1": POINTS[1], "AX": X, "AY": Y}.items():
        text = text.replace(word, str(value))
    return mk.loads(text).analyze()


@pytest.mark.parametrize("row", range(13))
def test_efforts_are_the_gradient_of_the_energy(row: int) -> None:
    r = analysis()
    pose = {name: mp.mpf(repr(rows[row])) for name, rows in poses().items()}

    def energy(at):
        return sum(each.energy(at) for each in bushings())

    exact = float(energy(pose))
    assert r["row.potential_energy"][row] == pytest.approx(exact, rel=1e-13, abs=1e-15)
    for name in POSE:
        effort = float(slope(energy, pose, name))
        assert r[f"pose.{name}.effort"][row] == pytest.approx(effort, rel=1e-11, abs=1e-12), name


@pytest.mark.parametrize("row", range(13))
def test_quantities(row: int) -> None:
    """Deflections are those of the definition, and the force its stiffness times them."""
    r, pose = analysis(), {name: mp.mpf(repr(rows[row])) for name, rows in poses().items()}
    for name, own in zip(("one", "two"), bushings(), strict=True):
        deflection = own.deflection(pose)
        told = [*r[f"{name}.shift"][row], *r[f"{name}.turn"][row]]
        assert told == pytest.approx([float(x) for x in deflection], rel=1e-12, abs=1e-15)
        pull = own.matrix * (deflection - own.free)
        force = [float(x) for x in -(own.axes * mp.matrix(pull[0:3]))]
        assert r[f"{name}.force"][row] == pytest.approx(force, rel=1e-12, abs=1e-13)


def test_about_one_axis_the_moment_grows_with_the_angle() -> None:
    """As a torsion spring on the hinge, to 179 degrees."""
    text = """format: 1
links: {arm: {}}
joints: {A: {type: R, links: [ground, arm], point: [1, 2, 3], axis: [1, 2, -2]}}
motion: {inputs: {A.theta: {values: [-179, -90, -1e-3, 0, 1e-5, 30, 120, 179]}}}
loads:
  - {type: bushing, name: b, links: [ground, arm], point: [1, 2, 3],
     axes: {x: [2, 1, 2], y: [2, -2, -1]}, stiffness: {x: 10, rz: 7}}
"""
    r = mk.loads(text).analyze()
    angles = np.radians(r["A.theta"])
    assert r["A.effort"] == pytest.approx(-7.0 * -angles, rel=1e-13)
    assert r["row.potential_energy"] == pytest.approx(3.5 * angles**2, rel=1e-13)


def test_a_damper_takes_what_its_matrix_says() -> None:
    """The efforts put in, at any pose, v . C v of the velocities in its axes."""
    text = """format: 1
links: {body: {}}
joints: {pose: {type: F, links: [ground, body], point: [0, 0, 0]}}
motion:
  time: {from: 0, to: 1, step: 0.25}
  inputs:
    pose.x: {law: expression, value: "0.1 m*sin(90 deg*time/(1 s))"}
    pose.y: {law: polynomial, coefficients: [0, "0.3 m/s"]}
    pose.z: {at: 0}
    pose.rz: {law: polynomial, coefficients: [10, "1 rad/s"]}
    pose.ry: {at: 20}
    pose.rx: {law: polynomial, coefficients: [0, "-2 rad/s", "1 rad/s^2"]}
points: {P: {link: body, at: [0.3, 0.1, 0]}}
loads:
  - {type: bushing, name: b, links: [ground, body], point: [0.3, 0.1, 0],
     stiffness: {}, damping: {x: 5, y: 2, z: 1, rx: 3, ry: 4, rz: 7}}
"""
    r = mk.loads(text).analyze()
    v, omega = r["P.velocity"], r["body.omega"]
    damping = np.array([5.0, 2, 1]), np.array([3.0, 4, 7])
    assert r["b.force"] == pytest.approx(-damping[0] * v, rel=1e-12, abs=1e-14)
    assert r["b.moment"] == pytest.approx(-damping[1] * omega, rel=1e-12, abs=1e-14)
    power = (damping[0] * v**2).sum(axis=1) + (damping[1] * omega**2).sum(axis=1)
    told = sum(r[f"pose.{n}.effort"] * r[f"pose.{n}_dot"] for n in POSE)
    assert told == pytest.approx(power, rel=1e-12)
    assert np.nanmax(r["row.power_error"]) < 1e-14


def test_in_double_double() -> None:
    """Energies, deflections and efforts to 28 digits, in the file's units."""
    r = analysis()
    rows = Repeated(r.result, wide_run(r.result))

    def wide(name: str, row: int) -> list:
        parts = [part[row] for part in true_values(parse(name), rows)]
        return [mp.mpf(float(part.high)) + mp.mpf(float(part.low)) for part in parts]

    own = bushings()
    for row in range(13):
        pose = {name: mp.mpf(repr(given[row])) for name, given in poses().items()}

        def energy(at):
            return sum(each.energy(at) for each in own)

        (told,) = wide("row.potential_energy", row)
        assert abs(told - energy(pose)) <= 1e-28 * max(1, energy(pose))
        turns = own[0].deflection(pose)[3:6]
        assert all(abs(a - b) < 1e-29 for a, b in zip(wide("one.turn", row), turns, strict=True))
        for name in POSE:
            (effort,) = wide(f"pose.{name}.effort", row)
            assert abs(effort - slope(energy, pose, name)) < 1e-26, (row, name)


def test_enclosed() -> None:
    """Intervals about the poses, 1e-9 wide and exact, hold what the definition gives there."""
    r = analysis()
    session = r.result.session
    states = r.result.row_states.states
    known = session.problem.quantities()
    wanted = [known[f"{name}.{word}"] for name in ("one", "two") for word in ("turn", "moment")]
    wanted.append(known["row.potential_energy"])
    enclosed, given = Enclosed.of(session), EnclosedInputs.of(session)
    for radius in (0.0, 1e-9):
        # of slides in lengths of the kernel
        scale = np.where([is_angle(c) for _, c in session.driven], 1.0, 1.0 / session.layout.length)
        inputs = given.inputs.copy()
        inputs[:, 2] += radius * scale[:, None]
        still = np.zeros((session.plan.columns, states.shape[1]))
        positions = Positions(enclosed.plan, enclosed.constants, states, still)
        found = enclose(session, positions, given._replace(inputs=inputs), wanted)
        for row in range(13):
            for shift in (0.0, 0.9, -0.9):
                pose = {n: mp.mpf(repr(rows[row])) + shift * radius for n, rows in poses().items()}
                energy = sum(each.energy(pose) for each in bushings())
                turn = bushings()[0].deflection(pose)[3:6]
                names = ("row.potential_energy", *["one.turn"] * 3)
                exact = zip(names, (0, 0, 1, 2), [energy, *turn], strict=True)
                for name, part, value in exact:
                    parts = (x[part, row] for x in found[name])
                    high, low, width = (mp.mpf(float(x)) for x in parts)
                    assert abs(high + low - value) <= width, (name, row, radius)
                    assert width < max(1e-25, 1e5 * radius), (name, row, radius)
