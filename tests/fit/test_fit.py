"""Fits reach optima that are known from closed forms, and say where there is none."""

import os
from typing import Any

import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk

STARTS = 20 if int(os.environ.get("MECHKIN_RANDOM", "1")) > 1 else 1
"""Seeds of the nine points; MECHKIN_RANDOM=2 takes twenty."""

FOUR_BAR = mk.load(FILE_OF["planar_four_bar"])
BOUNDS = {"a": (30, 50), "b": (100, 140), "c": (80, 110), "d": (110, 150)}
KNOWN = {"a": 35.0, "b": 118.0, "c": 95.0, "d": 128.0}


def rocker(theta: np.ndarray, a: float, b: float, c: float, d: float) -> np.ndarray:
    """Rocker angle (rad) of an open four-bar from the two circles that meet in B."""
    x, y = a * np.cos(theta) - d, a * np.sin(theta)
    far = np.hypot(x, y)
    out = np.arctan2(y, x) - np.arccos((far**2 + c**2 - b**2) / (2 * far * c))
    return np.where(out < 0.0, out + 2 * np.pi, out)


def pen(degrees: list[float]) -> np.ndarray:
    """The pen of the known linkage (points, 2): on the coupler, 100 - a along and 80 beside it."""
    theta, (a, b, c, d) = np.radians(degrees), KNOWN.values()
    out = rocker(theta, a, b, c, d)
    start = np.stack([a * np.cos(theta), a * np.sin(theta)], axis=1)
    end = np.stack([d + c * np.cos(out), c * np.sin(out)], axis=1)
    along = (end - start) / b
    return start + (100 - a) * along + 80 * np.stack([-along[:, 1], along[:, 0]], axis=1)


NINE = pen([15, 45, 80, 120, 165, 210, 255, 300, 333])


WIDE = {"a": (15, 80), "b": (60, 220), "c": (50, 200), "d": (60, 240)}


@pytest.mark.parametrize("seed", range(STARTS))
@pytest.mark.parametrize("bounds", [BOUNDS, WIDE], ids=["near", "wide"])
def test_nine_points_are_reached_from_elsewhere(bounds: dict[str, Any], seed: int) -> None:
    """From own values drawn within the bounds, and by the searches that do not begin there."""
    random = np.random.default_rng(seed)
    points = NINE[random.permutation(9)]
    a, b, c, d = 1.0, 0.0, 0.0, 0.0
    while a + max(b, c, d) >= 0.95 * (b + c + d - max(b, c, d)):  # so that the crank turns
        a, b, c, d = (float(random.uniform(*pair)) for pair in bounds.values())
    own = FOUR_BAR.with_parameters({"a": a, "b": b, "c": c, "d": d})
    f = own.fit({"of": "pen.position", "is": points.tolist()}, bounds, seed=seed)
    assert f.status == "fitted"
    assert min(f.costs[1:]) < 1e-16
    assert f.targets[0].largest < 1e-8
    assert np.allclose(list(f.parameters.values()), list(KNOWN.values()), rtol=0, atol=1e-7)


def test_three_precision_points_are_freudensteins() -> None:
    """K1 cos(out) - K2 cos(in) + K3 = cos(in - out), linear in K (Freudenstein 1955)."""
    degrees = [40.0, 110.0, 200.0]
    theta = np.radians(degrees)
    out = rocker(theta, 42, 118, 96, 130)
    table = np.stack([np.cos(out), -np.cos(theta), np.ones(3)], axis=1)
    k1, k2, k3 = np.linalg.solve(table, np.cos(theta - out))
    a, c = 130 / k1, 130 / k2
    b = np.sqrt(a**2 + c**2 + 130**2 - 2 * a * c * k3)
    told = FOUR_BAR.solve({"O.theta": 40.0}, ["C.theta"])["C.theta"]
    # the drawing's zero: the file's angle against that of the closed form at the own dimensions
    offset = told - np.degrees(rocker(np.radians([40.0]), 40, 120, 90, 130))[0]
    wanted = np.degrees(out) + offset
    f = FOUR_BAR.fit(
        {"of": "C.theta", "at": degrees, "is": wanted.tolist()},
        {"a": (30, 50), "b": (100, 140), "c": (80, 110)},
    )
    assert f.status == "fitted"
    assert np.allclose(list(f.parameters.values()), [a, b, c], rtol=0, atol=1e-8)


def test_a_binding_constraint_holds_and_is_told() -> None:
    asked: dict[str, Any] = {"of": "O.effort", "least": "peak"}
    bounds = {"b": (100, 140), "c": (80, 110)}
    free = FOUR_BAR.fit(asked, bounds, generations=10, starts=2)
    highest = free.model.analyze(["C.theta"], tables=[])["C.theta"].max()
    limit = {"of": "C.theta", "max": float(highest) - 1.0}
    held = FOUR_BAR.fit(asked, bounds, constraints=limit, generations=10, starts=2)
    assert held.status == "fitted", held.reason
    assert held.constraints[0].holds
    assert held.targets[0].largest >= free.targets[0].largest
    assert held.model.analyze(["C.theta"], tables=[])["C.theta"].max() <= limit["max"] + 1e-3
    never = FOUR_BAR.fit(
        asked, bounds, constraints={"of": "C.theta", "max": -170}, generations=2, starts=1
    )
    assert never.status == "violated"
    assert "C.theta reaches" in never.reason


def test_what_does_not_assemble_is_told() -> None:
    f = FOUR_BAR.fit({"of": "O.effort", "least": "rms"}, {"c": (10, 12)}, generations=2, starts=2)
    assert f.status == "not-assembled"
    assert "rows of the sweep" in f.reason
    assert "not-assembled" in repr(f)


def test_a_fit_repeats_and_shows_what_was_found() -> None:
    f = FOUR_BAR.fit({"of": "pen.position", "is": NINE.tolist()}, BOUNDS, starts=1)
    again = FOUR_BAR.fit({"of": "pen.position", "is": NINE.tolist()}, BOUNDS, starts=1)
    assert again.parameters == f.parameters
    assert f.yaml.startswith("parameters:\n  a: 3")
    assert "pen.position" in repr(f)
    assert "<table>" in f._repr_html_()


TARGET = {"of": "C.theta", "at": [60], "is": [50]}


@pytest.mark.parametrize(
    ("targets", "parameters", "told"),
    [
        (TARGET, {"aa": (1, 2)}, "there is no parameter aa"),
        (TARGET, {"a": (50, 30)}, "write the smaller one first"),
        (TARGET, {"a": ("1 s", "2 s")}, "a = 1 s"),
        (TARGET, {"a": 3}, "write the least and the largest value"),
        (TARGET, {}, "expected bounds by name"),
        ([], {"a": (30, 50)}, "there is none"),
        ({"of": "nothing", "least": "peak"}, {"a": (30, 50)}, "nothing"),
        ({"of": "C.theta"}, {"a": (30, 50)}, "either what C.theta should be"),
        ({"of": "C.theta", "is": [50]}, {"a": (30, 50)}, "at which inputs"),
        ({"of": "C.theta", "at": [1, 2], "is": [50]}, {"a": (30, 50)}, "1 values and 2 inputs"),
        ({"of": "O.effort", "least": "mode"}, {"a": (30, 50)}, "one of peak, rms"),
        ({**TARGET, "wihtin": 1}, {"a": (30, 50)}, "there is no key wihtin"),
        ({**TARGET, "is": ["50 mm"]}, {"a": (30, 50)}, "is = 50 mm"),
        ([TARGET, {"of": "O.effort", "least": "peak"}], {"a": (30, 50)}, "needs within"),
    ],
)
def test_bad_questions_are_told_with_a_cure(targets: Any, parameters: Any, told: str) -> None:
    with pytest.raises(mk.UsageError, match=told):
        FOUR_BAR.fit(targets, parameters)


@pytest.mark.parametrize("name", ["starts", "generations", "seed"])
def test_numbers_of_searches_are_told_with_their_least(name: str) -> None:
    given: Any = {name: -1}
    with pytest.raises(mk.UsageError, match=rf"{name}: .*{int(name == 'starts')} or more, not -1"):
        FOUR_BAR.fit(TARGET, {"a": (30, 50)}, **given)
