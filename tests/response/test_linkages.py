"""Linkages under their own weight against quadratures of the energy integral, and a double rocker
that passes 24 dead centres against dense Newton-Euler equations."""

from __future__ import annotations

import os

import numpy as np
from oracle.document import document, to_text
from oracle.dynamics.quadrature import EnergyIntegral
from oracle.dynamics.response import prepare
from references import FILE_OF
from response.linkages import four_bar
from response.motions import last_time, off, respond

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

EXACT = 1e-10


def test_a_four_bar_falls_as_its_energy_says() -> None:
    """A crank-rocker from rest; the time of every row by quadrature."""
    response = """    start: {A.theta: 0}
    time: {from: 0, to: 0.7, step: 0.1}
    tolerance: 1e-13"""
    text = four_bar(2.0, 0.6, 1.7, 1.5, 100, response)
    found = respond(text)
    integral = EnergyIntegral(prepare(text), "A.theta", 30)
    assert off(integral.times(found["A.theta"][1:]), found["time"][1:]) < EXACT


BENNETT = {
    "start": {"A.theta": "60", "A.theta_dot": "9 rad/s"},
    "near": {"B.theta": "120"},
    "time": {"from": "0", "to": "1", "step": "0.125"},
    "tolerance": "1e-13",
}


def test_bennetts_linkage_turns_as_its_energy_says() -> None:
    """Three equations too many, and one freedom all the same."""
    data = document(FILE_OF["bennett"])
    del data["motion"], data["tables"]
    data["responses"] = {"run": BENNETT}
    text = to_text(data)
    found = respond(text)
    integral = EnergyIntegral(prepare(text), "A.theta", 30)
    times = integral.times(np.radians(found["A.theta"][1:]))
    assert off(times, found["time"][1:]) < EXACT


ROCKERS = (2.0, 1.6, 0.9, 1.5)
"""Ground, rocker, coupler, rocker: the shortest is the coupler, which turns round (Grashof)."""


def rockers(response: str, loads: str = "  - {type: gravity, g: [0, -1, 0]}") -> str:
    return four_bar(*ROCKERS, 60, response, loads)


def test_a_double_rocker_passes_24_dead_centres() -> None:
    """Its coupler turns round and round; either rocker turns back twice in a turn. The dense
    equations go on for one second of the five, or for two with `MECHKIN_RANDOM=2`."""
    response = """    start: {A.theta: 0, B.theta_dot: 9 rad/s}
    time: {from: 0, to: 5, step: 0.01}
    tolerance: 1e-13"""
    text = rockers(response)
    found = respond(text)
    turned = sum(
        int(np.sum(np.diff(np.sign(found[f"{name}.theta_dot"])) != 0)) for name in ("A", "D")
    )
    assert turned >= 24
    assert abs(found["B.theta"][-1]) > 6 * 2 * np.pi
    data = document(text)
    rows = [0, 100] if TIMES == 1 else [0, 100, 200]
    data["responses"]["run"]["time"] = {"values": [str(row // 100) for row in rows]}
    exact = prepare(data).run()
    for name in ("A.theta", "B.theta", "D.theta", "A.theta_dot", "B.theta_dot"):
        assert off(found[name][rows], exact[name]) < 10 * EXACT, name


def test_the_response_ends_at_the_24th_dead_centre() -> None:
    """12 turns of the coupler for one rocker; its rate is zero there, and changes its sign."""
    response = """    start: {A.theta: 0, B.theta_dot: 9 rad/s}
    time: {from: 0, to: 20, step: 0.5}
    stop: [{dead_centre: A.theta, count: 24}]
    tolerance: 1e-14"""
    found = respond(rockers(response))
    end = last_time(found)
    assert abs(found["A.theta_dot"][-1]) < 1e-9
    assert str(found["row.event"][-1])
    assert all(not str(word) for word in found["row.event"][:-1])
    dense = f"""    start: {{A.theta: 0, B.theta_dot: 9 rad/s}}
    time: {{from: 0, to: {end!r}, count: 2001}}
    tolerance: 1e-14"""
    rates = mk.loads(rockers(dense)).respond("run")["A.theta_dot"]
    assert int(np.sum(np.diff(np.sign(rates[:-1])) != 0)) == 23
