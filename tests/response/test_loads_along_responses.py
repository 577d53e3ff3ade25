"""Loads by law along a response of a pendulum without gravity, against closed forms and springs."""

from __future__ import annotations

from math import cos, degrees, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.response.result import ResponseResult
from mechkin_cli.response.runs import respond

INERTIA = 2.0 * 0.15**2 + 0.003
"""kg m^2, about the joint."""

STIFFNESS = 0.9
"""N m/rad."""

OMEGA = sqrt(STIFFNESS / INERTIA)
BEGIN, STEP = 1.0, 0.25

TEXT = f"""\
format: 1
units: {{length: mm, mass: kg, force: N}}
parameters: {{k: {1e3 * STIFFNESS} N*mm, c: 50 N*mm}}
links: {{arm: {{mass: 2, center_of_mass: [150, 0, 0], inertia: {{xx: 1e3, yy: 2e3, zz: 3e3}}}}}}
joints: {{O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}}}
points: {{tip: {{link: arm, at: [300, 0, 0]}}}}
responses:
  swing:
    start: {{O.theta: 20}}
    time: TIME
loads: [LOAD]
"""


def swing(load: str, time: str = "", folder: Path | None = None) -> ResponseResult:
    time = time or f"{{from: {BEGIN}, to: 3, step: {STEP}}}"
    text = TEXT.replace("LOAD", load).replace("TIME", time)
    if folder is None:
        model = mk.loads(text)
    else:
        (folder / "m.yaml").write_text(text, encoding="utf-8")
        model = mk.load(folder / "m.yaml")
    return respond(model.problem, model.problem.responses["swing"], ["O.theta"])


def angles(result: ResponseResult) -> list[float]:
    return [degrees(x) for x in np.asarray(result.quantity("O.theta").value)]


def torque(value: str) -> str:
    return f"{{type: torque, joint: O, value: {value}}}"


def test_a_spring_as_spring_expression_and_table(tmp_path: Path) -> None:
    expected = [20.0 * cos(OMEGA * STEP * row) for row in range(9)]
    per = 1e3 * STIFFNESS
    spring = f"{{type: spring, joint: O, coordinate: theta, stiffness: {per} N*mm/rad}}"
    table = "".join(f"{x},{-per * radians(x)!r}\n" for x in range(-24, 25, 4))
    (tmp_path / "law.csv").write_text(f"theta,torque\n{table}", encoding="utf-8")
    for load in (spring, torque('"-k*O.theta/(1 rad)"'), torque("{table: law.csv}")):
        found = swing(load, folder=tmp_path)
        assert angles(found) == pytest.approx(expected, abs=1e-7), load
        assert found.energy_error.max() < 1e-9


def test_a_force_at_a_point_as_the_torque_that_it_makes() -> None:
    one = swing('{type: torque, joint: O, value: "-0.3 N/mm*tip.position.x*tip.position.y"}')
    other = swing(
        '{type: force, link: arm, point: [300, 0, 0], force: [0, "-0.3 N/mm*tip.position.y", 0]}'
    )
    assert angles(other) == pytest.approx(angles(one), abs=1e-7)


def test_a_torque_of_time() -> None:
    """I theta'' = k sin(3 t) from rest at t = 1 s."""
    found = swing(torque('"k*sin(3 rad/s*time)"'))
    expected = []
    for row in range(9):
        t = BEGIN + STEP * row
        turned = (t - BEGIN) * cos(3.0 * BEGIN) / 3.0 - (sin(3.0 * t) - sin(3.0 * BEGIN)) / 9.0
        expected.append(20.0 + degrees(STIFFNESS / INERTIA * turned))
    assert angles(found) == pytest.approx(expected, rel=1e-8, abs=1e-7)


def test_a_law_that_jumps_with_the_rate() -> None:
    """I theta'' = -k theta - c sign(theta'): each half swing ends 2 c/k nearer to the middle."""
    half = pi / OMEGA
    found = swing(
        torque('"-k*O.theta/(1 rad) - c*sign(O.theta_dot/(1 rad/s))"'),
        f"{{from: 0, to: {3 * half!r}, count: 4}}",
    )
    lost = degrees(2.0 * 0.05 / STIFFNESS)
    expected = [(-1) ** n * (20.0 - n * lost) for n in range(4)]
    assert angles(found) == pytest.approx(expected, abs=1e-6)


def test_a_law_with_a_corner() -> None:
    """A spring with play: free between -8 and 8 degrees, where the pendulum coasts."""
    play = radians(8.0)
    found = swing(
        torque('"-k*(max(O.theta - 8 deg, 0 deg) + min(O.theta + 8 deg, 0 deg))/(1 rad)"'),
        "{from: 0, to: 4, step: 0.5}",
    )
    reach = radians(20.0) - play
    speed, quarter = reach * OMEGA, pi / (2.0 * OMEGA)
    across = 2.0 * play / speed

    def angle(t: float) -> float:
        period = 4.0 * quarter + 2.0 * across
        t = t % period
        back = t > period / 2.0
        t = t - period / 2.0 if back else t
        if t < quarter:
            found = play + reach * cos(OMEGA * t)
        elif t < quarter + across:
            found = play - speed * (t - quarter)
        else:
            found = -play - reach * sin(OMEGA * (t - quarter - across))
        return -found if back else found

    expected = [degrees(angle(0.5 * row)) for row in range(9)]
    assert angles(found) == pytest.approx(expected, abs=1e-6)
    assert found.energy_error.max() < 1e-8


def test_a_law_that_ends() -> None:
    """Where a load has no value the response ends, and says so."""
    found = swing(torque('"-k*O.theta/(1 rad) - c*sqrt(O.theta/(1 deg) - 10)"'))
    assert found.solved.tolist()[0]
    assert not found.solved.all()
    (error,) = (d for d in found.diagnostics if d.severity == "error")
    assert error.code == "load-undefined"


TWO_RUNS = """format: 1
units: {length: mm, force: N}
links:
  k1: {mass: 1, center_of_mass: [10, 0, 0]}
  k2: {mass: 1, center_of_mass: [30, 0, 0]}
joints:
  A: {type: R, links: [ground, k1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [k1, k2], point: [20, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: torque, joint: A, value: "7 N*mm - 0.2 N*mm*s/rad*A.theta_dot", runs: [RUNS]}
responses:
  a:
    start: {A.theta: 0, B.theta: 0}
    time: {values: [0, 0.1]}
    efforts: {B.theta: "1 N*mm - 0.4 N*mm*s/rad*B.theta_dot"}
  b:
    start: {A.theta: 0, B.theta: 0}
    time: {values: [0, 0.1]}
    efforts:
      A.theta: "2 N*mm - 0.1 N*mm*s/rad*A.theta_dot"
      B.theta: "3 N*mm - 0.1 N*mm*s/rad*B.theta_dot"
"""


@pytest.mark.parametrize("runs", ["a", "b", "a, b"])
def test_efforts_are_those_of_their_own_run(runs: str) -> None:
    """Whatever loads and efforts by expression other runs have before."""
    model = mk.loads(TWO_RUNS.replace("RUNS", runs))
    laws = {("a", "B"): (1, 0.4), ("b", "A"): (2, 0.1), ("b", "B"): (3, 0.1)}
    for (run, joint), (begin, falls) in laws.items():
        rows = model.respond(run)
        assert (rows.unit(f"{joint}.theta_dot"), rows.unit(f"{joint}.effort")) == ("rad/s", "N*mm")
        rate = rows[f"{joint}.theta_dot"]
        assert rows[f"{joint}.effort"] == pytest.approx(begin - falls * rate, rel=1e-13)
