"""The same mechanism written otherwise has the same response."""

import numpy as np
import pytest

import mechkin_cli as mk

CRANK = """\
format: 1
units: {length: mm, force: N}
links:
  crank: {mass: 1, center_of_mass: [20, 5, 0], inertia: {zz: 400, xx: 10, yy: 400}}
  rod: {mass: 0.5, center_of_mass: [95, 15, 0], inertia: {zz: 800, xx: 10, yy: 800}}
  piston: {mass: 2, center_of_mass: [150, 0, 0]}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: R, links: [crank, rod], point: [40, 30, 0], axis: [0, 0, 1]}
  B: {type: S, links: [rod, piston], point: [150, 0, 0]}
  D: {type: P, links: [ground, piston], point: [150, 0, 0], axis: [1, 0, 0]}
loads:
  - {type: gravity, g: [0, -9810, 0]}
  - {type: damper, joint: D, coordinate: s, damping: 2 N*s/m}
responses:
  go:
    start: {O.theta: 10, O.theta_dot: 2 rad/s}
    efforts: {O.theta: 0.5 N*m}
    time: {from: 0, to: 0.4, step: 0.05}
    stop: [{value: O.theta, at: 200, direction: up}]
"""
READ = ("time", "O.theta", "D.s", "D.s_dot")


def read(text: str, names: dict[str, str] | None = None) -> dict[str, np.ndarray]:
    found = mk.loads(text).respond("go")
    return {name: found[(names or {}).get(name, name)] for name in READ}


def same(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    for name in READ:
        assert other[name] == pytest.approx(one[name], rel=1e-8, abs=1e-8), name


def test_it_stops_where_it_should() -> None:
    found = mk.loads(CRANK).respond("go")
    assert found["O.theta"][-1] == pytest.approx(200.0, abs=1e-9)
    assert found["row.event"][-1] == "O.theta = 200 deg upwards"


def test_with_other_names_and_orders() -> None:
    renamed = CRANK.replace("O:", "motor:").replace("O.theta", "motor.theta")
    same(read(CRANK), read(renamed, {"O.theta": "motor.theta"}))
    gravity, damper = CRANK[CRANK.index("  - {type: g") : CRANK.index("responses:")].splitlines()
    same(read(CRANK), read(CRANK.replace(f"{gravity}\n{damper}", f"{damper}\n{gravity}")))


def test_in_other_units() -> None:
    units = "units: {length: mm, force: N, angle: rad, time: ms}"
    text = CRANK.replace("units: {length: mm, force: N}", units)
    text = text.replace("g: [0, -9810, 0]", "g: [0, -9810 mm/s^2, 0]")
    text = text.replace("theta: 10,", "theta: 10 deg,").replace("at: 200", "at: 200 deg")
    found = read(text.replace("to: 0.4, step: 0.05", "to: 400, step: 50"))
    found["time"] = found["time"] / 1e3
    found["O.theta"] = np.degrees(found["O.theta"])
    found["D.s_dot"] = found["D.s_dot"] * 1e3
    same(read(CRANK), found)


def test_with_a_joint_written_from_the_other_side() -> None:
    text = CRANK.replace("links: [ground, crank]", "links: [crank, ground]")
    text = text.replace("theta: 10, O.theta_dot: 2", "theta: -10, O.theta_dot: -2")
    text = text.replace("0.5 N*m", "-0.5 N*m").replace("at: 200, direction: up", "at: -200")
    found = read(text)
    found["O.theta"] = -found["O.theta"]
    same(read(CRANK), found)


def test_with_the_effort_as_a_load_of_its_run() -> None:
    text = CRANK.replace("    efforts: {O.theta: 0.5 N*m}\n", "")
    load = "  - {type: torque, joint: O, value: 0.5 N*m, runs: [go]}\nresponses:"
    same(read(CRANK), read(text.replace("responses:", load)))


def test_beside_another_response_and_a_sweep() -> None:
    sweep = "motion: {inputs: {O.theta: {values: [0, 10]}}}\nloads:"
    other = "  other:\n    start: {O.theta: 0}\n    time: {from: 0, to: 1, step: 1}\n  go:"
    text = CRANK.replace("loads:", sweep).replace("  go:", other)
    one, beside = read(CRANK), read(text)
    for name in READ:
        assert one[name].tobytes() == beside[name].tobytes()
