"""Constraints where they bind, the range over which a linkage assembles, and its mode: optima of
closed forms."""

from __future__ import annotations

import os

import numpy as np
import pytest
from fit.test_fit import FOUR_BAR, rocker
from references import FILE_OF
from scipy.optimize import least_squares, minimize

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

TRANSMISSION = (
    "acos(abs(dot(A.point - B.point, C.point - B.point))"
    "/(norm(A.point - B.point)*norm(C.point - B.point)))"
)
AT_LEAST_40 = {"of": TRANSMISSION, "min": "40 deg"}
COUPLER = {"of": "norm(B.point - A.point)", "least": "rms"}


@pytest.mark.parametrize("starts", [1, 2] if TIMES > 1 else [1])
def test_the_shortest_coupler_that_transmits_at_40_degrees(starts: int) -> None:
    """The angle at B is least where the crank lies along the ground, and largest half a turn on: by
    the law of cosines b^2 + c^2 - 2 b c cos 40 = (d - a)^2 and b^2 + c^2 + 2 b c cos 40 =
    (d + a)^2, so that b^2 + c^2 = a^2 + d^2 and b c = a d / cos 40."""
    f = FOUR_BAR.fit(
        COUPLER,
        {"b": (40, 140), "c": (60, 160)},
        constraints=AT_LEAST_40,
        generations=3,
        starts=starts,
    )
    total, product = 40**2 + 130**2, 40 * 130 / np.cos(np.radians(40))
    both = np.sqrt((total + np.array([-1, 1]) * np.sqrt(total**2 - 4 * product**2)) / 2)
    assert f.status == "fitted"
    assert np.abs(np.array([f.parameters["b"], f.parameters["c"]]) - both).max() < 1e-5
    assert f.constraints[0].value == pytest.approx(40.0, abs=1e-5)
    assert f.model.analyze(tables=[])[TRANSMISSION].min() >= 40 - 1e-5


def test_a_function_within_a_transmission_angle() -> None:
    """Against scipy on the two circles that meet in B; without the bound the angle falls to 32."""
    at = [40.0, 80.0, 120.0, 160.0, 200.0]
    theta = np.radians(at)
    zero = FOUR_BAR.analyze(["C.theta"])["C.theta"][6] - np.degrees(
        rocker(np.array([np.pi / 2]), 40, 120, 90, 130)[0]
    )
    wanted = np.degrees(rocker(theta, 40, 120, 90, 130)) + zero + [4, -3, -6, 0, 9]
    bounds = {"a": (30, 60), "b": (80, 160), "c": (60, 140)}
    target = {"of": "C.theta", "at": at, "is": wanted.tolist()}
    rows = np.radians(np.arange(0, 361, 15))

    def away(x: np.ndarray) -> np.ndarray:
        return np.degrees(rocker(theta, *x, 130)) + zero - wanted

    def room(x: np.ndarray) -> np.ndarray:
        a, b, c = x
        far = np.hypot(a * np.cos(rows) - 130, a * np.sin(rows))
        return np.cos(np.radians(40)) - np.abs((b**2 + c**2 - far**2) / (2 * b * c))

    own = [40.0, 120.0, 90.0]
    low_high = tuple(zip(*bounds.values(), strict=True))
    free = least_squares(away, own, bounds=low_high, x_scale=own, xtol=1e-14)
    assert room(free.x).min() < -0.02, "the bound does not bind"
    best = minimize(
        lambda x: float(np.square(away(x * own)).sum()) / 100,
        [1.0, 1.0, 1.0],
        method="SLSQP",
        bounds=[(low / x, high / x) for (low, high), x in zip(bounds.values(), own, strict=True)],
        constraints={"type": "ineq", "fun": lambda x: room(x * own)},
        tol=1e-15,
    ).x * np.array(own)
    f = FOUR_BAR.fit(target, bounds, constraints=AT_LEAST_40, generations=8, starts=2)
    assert f.status == "fitted", f.reason
    assert f.constraints[0].value == pytest.approx(40.0, abs=1e-4)
    assert np.abs(np.array(list(f.parameters.values())) - best).max() < 1e-3
    found = away(np.array(list(f.parameters.values())))
    assert found @ found == pytest.approx(away(best) @ away(best), rel=1e-5)
    unbound = FOUR_BAR.fit(target, bounds, generations=8, starts=2)
    assert np.abs(np.array(list(unbound.parameters.values())) - free.x).max() < 1e-4


def test_the_shortest_coupler_with_which_the_crank_turns() -> None:
    """Grashof's limit: the longest and the shortest are as long as the others, b = a + d - c."""
    f = FOUR_BAR.fit(COUPLER, {"b": (40, 140)}, generations=5, starts=2)
    assert f.status == "fitted"
    assert f.parameters["b"] == pytest.approx(80.0, abs=1e-6)
    assert f.parameters["b"] >= 80.0
    assert f.rows_not_ok == 0


def test_the_mode_of_the_file_is_kept() -> None:
    """A function that the crossed linkage of other dimensions would give is not met by crossing."""
    at = [60.0, 120.0, 240.0]
    theta = np.radians(at)
    x, y = 40 * np.cos(theta) - 130, 40 * np.sin(theta)
    far = np.hypot(x, y)
    bend = np.arccos((far**2 + 90**2 - 120**2) / (2 * far * 90))
    zero = FOUR_BAR.solve({"O.theta": 90.0}, ["C.theta"])["C.theta"] - np.degrees(
        rocker(np.array([np.pi / 2]), 40, 120, 90, 130)[0]
    )
    wanted = np.degrees(np.arctan2(y, x) + bend) + zero
    bounds = {"b": (90, 150), "c": (70, 120)}
    f = FOUR_BAR.fit({"of": "C.theta", "at": at, "is": wanted.tolist()}, bounds, generations=5)
    b, c = f.parameters["b"], f.parameters["c"]
    open_one = np.degrees(rocker(theta, 40, b, c, 130)) + zero
    assert np.abs(f.targets[0].values.ravel() - open_one).max() < 1e-9
    assert f.targets[0].largest > 20.0
    assert f.rows_not_ok == 0


def test_a_transmission_angle_in_space() -> None:
    m = mk.load(FILE_OF["rssr"])
    angle = "O4.theta.transmission_angle"
    target = {"of": "O4.theta", "at": [70, 90, 110, 130, 150], "is": [0, 10, 20, 30, 40]}
    bounds = {"r": (20, 80), "x": (100, 250), "d": (100, 220)}
    free = m.fit(target, bounds, starts=1)
    least = free.model.analyze([angle], tables=[])[angle].min()
    bound = {"of": angle, "min": f"{least + 5} deg"}
    held = m.fit(target, bounds, constraints=bound, starts=1)
    assert held.status == "fitted", held.reason
    assert held.model.analyze([angle], tables=[])[angle].min() == pytest.approx(least + 5, abs=1e-4)
    assert held.cost > free.cost
