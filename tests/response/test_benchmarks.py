"""Published test problems: values of their sources, closed forms, dense Newton-Euler equations."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp
from oracle.document import document
from oracle.dynamics.quadrature import EnergyIntegral
from oracle.dynamics.response import prepare
from response import benchmarks
from response.motions import off, respond

import mechkin_cli as mk


def test_andrews_squeezer_ends_where_it_was_published() -> None:
    """15 significant digits are printed; rates of 1400 rad/s follow a torque of 0.033 N m."""
    found = respond(benchmarks.squeezer())
    start, end = benchmarks.SQUEEZER_START, benchmarks.SQUEEZER_END
    for angle, joint in benchmarks.SQUEEZER_JOINTS.items():
        turned = end[angle] - start[angle]
        assert abs(found[f"{joint}.theta"][-1] - turned) < 1e-8, angle


def test_bricards_mechanism_gives_its_energy_back() -> None:
    """It falls from rest and comes to rest again: moments by quadrature, then the way back."""
    found = respond(benchmarks.bricard(["time: {from: 0, to: 10, step: 0.0625}"]))
    total = found["row.kinetic_energy"] + found["row.potential_energy"]
    assert np.max(np.abs(total - total[0])) < 1e-10
    angle = found["J1.theta"]
    rate = np.sign(found["J1.theta_dot"][1:])
    first = int(np.argmax(rate != rate[0]))
    assert first > 4, "it falls in one go"
    rows = slice(2, first, 4)
    integral = EnergyIntegral(prepare(benchmarks.bricard()), "J1.theta", 30)
    assert off(integral.times(angle[rows]), found["time"][rows]) < 1e-9
    assert np.min(found["row.kinetic_energy"][1:]) < 0.05 * np.max(found["row.kinetic_energy"])


def test_the_spatial_slider_crank_turns_as_newton_and_euler_say() -> None:
    text = benchmarks.slider_crank(["time: {from: 0, to: 1, step: 0.25}", "tolerance: 1e-13"])
    found, exact = respond(text), prepare(text).run()
    for name in ("A.theta", "D.s", "C.theta1", "C.theta2", "A.theta_dot", "D.s_dot"):
        assert off(found[name], exact[name]) < 1e-10, name


def test_the_stiff_governor_moves_as_newton_and_euler_say() -> None:
    text = benchmarks.governor(["time: {from: 0, to: 0.004, count: 3}", "tolerance: 1e-12"])
    found, exact = respond(text), prepare(document(text)).run(1e-11)
    for name in ("S.theta", "P.s", "right.theta", "left.theta", "S.theta_dot", "P.s_dot"):
        assert off(found[name], exact[name]) < 1e-9, name


def test_the_stiff_governor_keeps_its_momentum_and_its_symmetry() -> None:
    """Nothing turns it about its shaft: what its balls gain outwards its speed loses."""
    found = respond(
        benchmarks.governor(["time: {from: 0, to: 2, step: 0.125}", "tolerance: 1e-11"])
    )
    assert off(found["right.theta"], found["left.theta"]) < 1e-8
    angle = np.radians(60) + found["right.theta"]
    reach = 0.05 + np.sin(angle)
    half = 0.05 + np.sin(angle) / 2
    rods = 0.3 * (half**2 + ((1 + 1e-4) * np.sin(angle) ** 2 + 2e-4 * np.cos(angle) ** 2) / 12)
    moment = found["S.theta_dot"] * (2 * (5 * reach**2 + rods) + 0.3 * 1e-4 / 6 + 3.0 * 0.01 / 6)
    assert off(moment / moment[0], 1 + 0 * moment) < 1e-8


def test_four_bars_pass_their_singular_position_straight() -> None:
    """Like one pendulum that turns over: I = 3 (m/3) + 2 m, pull (3/2 + 2) m g at its length."""
    # where the loops are nearly singular accelerations hold eleven digits
    found = respond(benchmarks.four_bars(), energy=1e-10)
    assert any(d.code == "branch-point-passed" for d in found.diagnostics)
    with mp.workdps(40):
        inertia, pull = mp.mpf(3), mp.mpf("3.5") * mp.mpf("9.81")
        # from the top at 1 rad/s: angle from the top phi, phi'^2 = 1 + 4 w^2 sin^2(phi/2)
        w = mp.sqrt(pull / inertia)
        bottom = mp.sqrt(1 + 4 * w * w)
        m = (2 * w / bottom) ** 2
        quarter = mp.ellipk(m)
        sn, cn = mp.ellipfun("sn"), mp.ellipfun("cn")
        angles = []
        for t in found["time"]:
            # counted from the bottom, which it passes after a quarter
            u = bottom / 2 * mp.mpf(t) - quarter
            turns = mp.floor(u / (2 * quarter) + mp.mpf(1) / 2)
            rest = u - 2 * quarter * turns
            am = mp.atan2(sn(rest, m=m), cn(rest, m=m)) + mp.pi * turns
            angles.append(-(2 * am + mp.pi))
    assert angles[-1] < -2 * mp.pi
    for name in ("G0", "G1", "G2"):
        assert off(found[f"{name}.theta"], angles) < 1e-9, name


def test_four_bars_that_are_not_told_to_go_straight_end_there() -> None:
    text = benchmarks.four_bars(1).replace("assembly: {at_branch_points: straight}\n", "")
    found = mk.loads(text).respond("run")
    status = [str(word) for word in found["row.status"]]
    assert status[:6] == ["ok"] * 6
    assert set(status[6:]) == {"branch-lost"}


@pytest.mark.parametrize("miss", [1e-3, 1e-5, 1e-7])
def test_four_bars_that_only_come_near_a_branch_point_turn_off(miss: float) -> None:
    """A coupler too long by a little: the other bar turns back, as the equations of motion say."""
    text = benchmarks.four_bars(1, ["time: {from: 0, to: 1, step: 0.25}", "tolerance: 1e-12"])
    joint = "R0: {type: R, links: [top0, bar1], point: "
    text = text.replace(
        joint + "[1.0, 1.0, 0.0]",
        f"{joint}{{top0: [{1 + miss!r}, 1.0, 0.0], bar1: [1.0, 1.0, 0.0]}}",
    )
    found = respond(text, energy=1e-8)
    assert not any(d.code == "branch-point-passed" for d in found.diagnostics)
    assert abs(found["G0.theta"][-1] - found["G1.theta"][-1]) > 1
