"""Loads that vary with coordinates, rates and points on the RCSR mechanism, against dense
Newton-Euler at 40 digits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from oracle import document, mp, newton_euler, read, solve, to_text
from references import FILE_OF

import mechkin_cli as mk

LIMIT = 1e-12
ROWS = (0, 9, 24)
LOADS = [
    {
        "type": "torque",
        "joint": "O4",
        "value": "-300 lbm*in^2/s*O4.theta_dot + 30 lbm*in^2/s^2*sin(O4.theta)",
    },
    {"type": "force", "joint": "O2", "value": "-4 lbm/s^2*O2.s - 90 lbm/s*O2.s_dot"},
    {
        "type": "force",
        "link": "coupler",
        "point": ["-5", "-1", "2"],
        "force": ["8 lbm/s^2*pm2.position.y", "7", "-50 lbm/s*pm2.velocity.z"],
        "axes": "link",
    },
    {
        "type": "torque",
        "link": "rocker",
        "torque": ["0", "-200 lbm*in^2/s*coupler.omega.y", "5*(1 lbm/s^2)*O2.s^2"],
    },
]
TORQUE_ONLY = [{"type": "torque", "link": "rocker", "torque": LOADS[3]["torque"], "axes": "link"}]
CASES = [(loads, massless) for loads in ("all", "torque") for massless in (False, True)]


def text(loads: str, massless: bool) -> str:
    data = document(FILE_OF["rcsr"]) | {"loads": LOADS if loads == "all" else TORQUE_ONLY}
    data["tables"] = []
    if massless:
        data["links"] = {name: {} for name in data["links"]}
    return to_text(data)


@cache
def model(loads: str, massless: bool) -> mk.Model:
    return mk.loads(text(loads, massless))


@cache
def run(loads: str, massless: bool) -> mk.Analysis:
    joints = model(loads, massless).problem.mechanism.joints
    names = [f"{j}.{word}" for j in joints for word in ("force", "moment")]
    return model(loads, massless).analyze(["O1.effort", *names])


@cache
def expected(loads: str, massless: bool, row: int):
    mechanism = read(text(loads, massless))
    turn = mp.pi / 180
    guess = {
        name: float(run(loads, massless)[name][row]) * (turn if name.endswith("theta") else 1)
        for name in ("O1.theta", "O2.theta", "O2.s", "O4.theta")
    }
    return newton_euler(mechanism, solve(mechanism, mechanism.row(row), guess))


@pytest.mark.parametrize(("loads", "massless"), CASES)
@pytest.mark.parametrize("row", ROWS)
def test_effort_and_wrenches(loads, massless, row):
    reactions, found = expected(loads, massless, row), run(loads, massless)
    effort = float(reactions.effort["O1.theta"])
    assert found["O1.effort"][row] == pytest.approx(effort, rel=LIMIT)
    for word, exact in (("force", reactions.force), ("moment", reactions.moment)):
        values = np.array([found[f"{joint}.{word}"][row] for joint in exact])
        right = np.array([[float(x) for x in exact[joint]] for joint in exact])
        assert np.abs(values - right).max() <= LIMIT * np.abs(right).max()


@pytest.mark.parametrize(("loads", "massless"), CASES)
def test_powers_balance(loads, massless):
    assert run(loads, massless)["row.power_error"].max() <= 1e-13


@pytest.mark.parametrize("lanes", [2, 4, 8])
def test_bits_do_not_depend_on_the_width(lanes):
    from mechkin_cli.kernel import _kernel

    if lanes > _kernel.widest:
        pytest.skip("this machine's packs are narrower")
    names = ["O1.effort", "O3.force", "O4.moment"]
    one, other = run("all", False), model("all", False).analyze(names, lanes=lanes)
    for name in names:
        assert one[name].tobytes() == other[name].tobytes()


@pytest.mark.parametrize("closed_at", ["O2", "O3", "O4"])
def test_the_closing_joint_does_not_matter(closed_at):
    """Coordinates of closing joints are read from poses, those of others are unknowns."""
    other = model("all", False).analyze(["O1.effort"], closed_at=[closed_at])["O1.effort"]
    effort = run("all", False)["O1.effort"]
    assert np.abs(other - effort).max() <= LIMIT * np.abs(effort).max()
