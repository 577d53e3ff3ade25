"""The documented fits reach the optima of their closed forms, which are found without mechkin."""

from __future__ import annotations

import numpy as np
import pytest
from fit.closed_forms import (
    force_balanced,
    hatch,
    hoeken,
    minimax,
    rssr,
    rssr_function,
    shaking,
    spring_length,
    straight_line,
)
from references import FILE_OF
from scipy.optimize import minimize
from studies.studies import MECHANISMS

import mechkin_cli as mk

FITS = MECHANISMS / "plane" / "fits"
NINE = np.array([[x, 0.0] for x in range(-80, 81, 20)])


def values(f: mk.Fit) -> np.ndarray:
    return np.array(list(f.parameters.values()))


def test_a_straight_line_through_nine_points() -> None:
    m = mk.load(FITS / "straight_line.yaml")
    path = m.analyze(["pen.position"])["pen.position"]
    assert np.abs(path - hoeken(np.radians(np.arange(90, 271, 5)), 40, 105, 80)).max() < 1e-10
    target = {"of": "pen.position - middle.position", "is": NINE.tolist()}
    f = m.fit(target, {"b": (80, 200), "d": (40, 200), "h": (100, 300)}, starts=2, generations=15)
    expected, largest = straight_line(NINE, [105.0, 80.0, 190.0])
    assert f.status == "fitted"
    # scipy's feet are known to the root of rounding; the optimum is flat
    assert np.abs(values(f) - expected).max() < 1e-5
    assert f.targets[0].largest == pytest.approx(largest, rel=1e-6)


def test_the_straightest_half_turn_is_the_published_one() -> None:
    """Norton, Design of Machinery, table 3-1: for half a turn ground and coupler are 2.200 and
    2.800 cranks, in steps of 0.025 and 0.0375, and always coupler = (3 ground - 1)/2."""
    m = mk.load(FITS / "straight_line.yaml")
    bounds = {"a": (30, 50), "b": (80, 150), "d": (60, 110), "h": (150, 220)}
    f = m.fit(
        {"of": "pen.position.y - h", "least": "peak"},
        bounds,
        constraints={"of": "if(O.theta < 91 deg, pen.position.x, 80 mm)", "min": 80},
        starts=2,
        generations=10,
    )
    assert f.status == "fitted"
    theta = np.radians(np.arange(90, 271, 5))
    found, peak = minimax(
        lambda x: hoeken(theta, *x[:3])[:, 1] - x[3],
        lambda x: hoeken(theta[:1], *x[:3])[:, 0] - 80,
        0.01,
        [40.0, 110.0, 85.0, 180.0],
        list(bounds.values()),
    )
    assert f.targets[0].largest == pytest.approx(peak, rel=1e-7)
    assert np.abs(values(f) - found).max() < 1e-4
    a, b, d, _ = values(f)
    assert abs(d / a - 2.200) < 0.025
    assert abs(b / a - 2.800) < 0.0375
    assert abs(b / a - (3 * d / a - 1) / 2) < 1e-3


def test_a_function_of_an_rssr() -> None:
    m = mk.load(FILE_OF["rssr"])
    own = m.analyze(["O4.theta"])["O4.theta"]
    assert np.abs(own - rssr(np.radians(np.arange(0, 361, 10)), 40, 140, 160)).max() < 1e-10
    at, wanted = [70, 90, 110, 130, 150], [0, 10, 20, 30, 40]
    f = m.fit(
        {"of": "O4.theta", "at": at, "is": wanted},
        {"r": (20, 80), "x": (100, 250), "d": (100, 220)},
        starts=2,
        generations=10,
    )
    expected, deviations = rssr_function(at, wanted, [40.0, 140.0, 160.0])
    assert f.status == "fitted"
    # the optimum is flat: scipy ends 1e-4 mm beside it, at no lower cost
    found = rssr(np.radians(at), *values(f)) - wanted
    assert found @ found <= deviations @ deviations * (1 + 1e-13)
    assert np.abs(values(f) - expected).max() < 1e-3
    assert np.abs(f.targets[0].deviations.ravel() - found).max() < 1e-10


PLACES = dict.fromkeys(("x1", "y1", "x3", "y3"), (-150, 150))


def test_counterweights_that_leave_no_force() -> None:
    m = mk.load(FITS / "counterweights.yaml")
    r = m.analyze(tables=[])
    force, moment = shaking(np.zeros(4))
    assert np.abs(r["ground.shaking_force"] - force).max() < 1e-9 * np.abs(force).max()
    assert np.abs(r["ground.shaking_moment"] - moment).max() < 1e-9 * np.abs(moment).max()
    f = m.fit({"of": "ground.shaking_force", "least": "rms"}, PLACES, starts=1)
    assert np.abs(values(f) - force_balanced()).max() < 1e-8


def test_counterweights_that_leave_the_least_moment() -> None:
    m = mk.load(FITS / "counterweights.yaml")
    f = m.fit(
        {"of": "ground.shaking_moment", "least": "rms"},
        PLACES,
        constraints={"of": "norm(ground.shaking_force)", "max": "2 N"},
        generations=10,
    )
    share = np.full(25, 1 / 24)
    share[[0, -1]] /= 2

    def cost(x: np.ndarray) -> float:
        return float(share @ shaking(x * 100)[1] ** 2) / 1e4

    def room(x: np.ndarray) -> np.ndarray:
        return 4.0 - np.square(shaking(x * 100)[0]).sum(axis=1)

    ends = [
        minimize(cost, start, method="SLSQP", constraints={"type": "ineq", "fun": room}, tol=1e-13)
        for start in (force_balanced() / 100, [-0.6, 0.3, 0.3, -0.6], [0.0, 0.0, 0.0, 0.0])
    ]
    best = min((end for end in ends if room(end.x).min() > -1e-6), key=lambda end: end.fun)
    assert f.status == "fitted"
    assert f.constraints[0].value == pytest.approx(2.0, abs=1e-6)  # it binds
    assert f.targets[0].largest == pytest.approx(100 * best.fun**0.5, rel=1e-6)
    assert np.abs(values(f) - 100 * best.x).max() < 0.01


def test_the_seat_of_a_gas_spring() -> None:
    m = mk.load(FITS / "hatch.yaml")
    own = np.array([-60.0, -250.0, 220.0])
    r = m.analyze(["hinge.effort", "gas.s"])
    assert np.abs(r["hinge.effort"] - hatch(own)).max() < 1e-9 * np.abs(hatch(own)).max()
    bounds = {"u": (-150, 150), "v": (-400, -50), "p": (100, 350)}
    f = m.fit(
        {"of": "hinge.effort", "least": "peak"},
        bounds,
        constraints={"of": "long + gas.s", "min": "250 mm", "max": "450 mm"},
        starts=2,
        generations=15,
    )
    expected, peak = minimax(
        hatch,
        lambda x: np.concatenate([spring_length(x) - 250, 450 - spring_length(x)]),
        200.0,
        [30.0, -200.0, 200.0],
        list(bounds.values()),
    )
    assert f.status == "fitted"
    assert f.targets[0].largest == pytest.approx(peak, rel=1e-6)
    assert np.abs(values(f) - expected).max() < 1e-3
    assert f.constraints[1].value == pytest.approx(450.0, abs=1e-4)
