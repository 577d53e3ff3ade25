"""Derivatives of a fit's measures against differences of a four-bar's closed form at 40 digits."""

from typing import Any

import mpmath
import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.fit.measure import FitModels, FitSlopes, FitValues
from mechkin_cli.fit.request import request
from mechkin_cli.fit.search import Measured

FOUR_BAR = mk.load(FILE_OF["planar_four_bar"])
BOUNDS = {"a": (30, 50), "b": (100, 140), "c": (80, 110), "d": (110, 150)}
AT = {"a": 37.0, "b": 117.0, "c": 94.0, "d": 129.0}
LOWER = np.array([low for low, _ in BOUNDS.values()], dtype=float)
WIDTH = np.array([high - low for low, high in BOUNDS.values()], dtype=float)
UNKNOWNS = (np.array(list(AT.values())) - LOWER) / WIDTH
RIGHT = 1e-10
"""Of the largest derivative of a kind."""

Numbers = list[Any]


def rocker(theta: Any, a: Any, b: Any, c: Any, d: Any) -> Any:
    """Rocker angle (rad) from the two circles that meet in B."""
    x, y = a * mpmath.cos(theta) - d, a * mpmath.sin(theta)
    far = mpmath.hypot(x, y)
    out = mpmath.atan2(y, x) - mpmath.acos((far**2 + c**2 - b**2) / (2 * far * c))
    return out + 2 * mpmath.pi if out < 0 else out


def pen(theta: Any, a: Any, b: Any, c: Any, d: Any) -> Numbers:
    """The point of the coupler, 100 - a along it and 80 beside it."""
    out = rocker(theta, a, b, c, d)
    start = [a * mpmath.cos(theta), a * mpmath.sin(theta)]
    end = [d + c * mpmath.cos(out), c * mpmath.sin(out)]
    along = [(one - other) / b for one, other in zip(end, start, strict=True)]
    beside = [-along[1], along[0]]
    return [start[k] + (100 - a) * along[k] + 80 * beside[k] for k in (0, 1)]


def foot(point: Numbers, near: Any, *sizes: Any) -> Numbers:
    """The place of the curve that is nearest to a point."""

    def down(theta: Any) -> Any:
        def distance(at: Any) -> Any:
            x, y = pen(at, *sizes)
            return (x - point[0]) ** 2 + (y - point[1]) ** 2

        return mpmath.diff(distance, theta)

    return pen(mpmath.findroot(down, near), *sizes)


def derivatives(of: Any) -> np.ndarray:
    """Of (unknowns in [0, 1]) the derivatives of all components (values, unknowns)."""
    sizes = [mpmath.mpf(value) for value in AT.values()]
    columns = []
    with mpmath.workdps(40):
        step = mpmath.mpf(10) ** -12
        for k in range(4):
            up, down = ([*sizes], [*sizes])
            up[k] += step
            down[k] -= step
            pairs = zip(of(*up), of(*down), strict=True)
            columns.append([float((one - other) / (2 * step)) for one, other in pairs])
    return np.array(columns).T * WIDTH


def measured(targets: Any, constraints: Any = ()) -> tuple[FitSlopes, Measured]:
    values = FitValues(
        FitModels(FOUR_BAR), *request(FOUR_BAR.problem, targets, BOUNDS, constraints)
    )
    slopes = FitSlopes(values)
    return slopes, Measured(values.measure, slopes.stacked)


def assert_right(found: np.ndarray, expected: np.ndarray) -> None:
    assert found.shape == expected.shape
    assert np.abs(found - expected).max() <= RIGHT * np.abs(expected).max()


def test_slopes_at_inputs_are_those_of_the_closed_form() -> None:
    degrees = [200.0, 15.0, 120.0]
    target = {"of": "pen.position", "at": degrees, "is": [[0, 0]] * 3, "within": "2 cm"}
    _, both = measured(target)

    def of(*sizes: Any) -> Numbers:
        return [x / 20 for at in degrees for x in pen(mpmath.radians(at), *sizes)]

    assert_right(both.exact_slopes(UNKNOWNS), derivatives(of))
    assert both.filled == 0


def test_slopes_of_nearest_places_follow_the_foot_of_the_perpendicular() -> None:
    # well beside the curve, where the foot moves along it
    near = [15.0, 80.0, 165.0, 255.0, 333.0]
    aside = [(3.0, 2.0), (-2.0, 4.0), (4.0, -1.0), (-3.0, -3.0), (0.0, 3.0)]
    points = []
    for at, (x, y) in zip(near, aside, strict=True):
        own = pen(mpmath.radians(at), *AT.values())
        points.append([float(own[0]) + x, float(own[1]) + y])
    _, both = measured({"of": "pen.position", "is": points})

    def of(*sizes: Any) -> Numbers:
        feet = [
            foot(point, mpmath.radians(at), *sizes) for point, at in zip(points, near, strict=True)
        ]
        return [x for place in feet for x in place]

    assert_right(both.exact_slopes(UNKNOWNS), derivatives(of))


def test_slopes_of_peaks_means_and_margins() -> None:
    degrees = np.arange(0.0, 361.0, 15.0)
    _, both = measured(
        [
            {"of": "sin(C.theta)", "least": "peak", "within": 0.5},
            {"of": "C.theta", "least": "rms", "within": "4 deg"},
        ],
        {"of": "C.theta", "min": "20 deg", "max": "160 deg"},
    )
    share = np.full(25, 1 / 24)
    share[[0, -1]] /= 2
    # the drawing's own zero of C.theta
    zero = mpmath.radians(FOUR_BAR.solve({"O.theta": 90.0}, ["C.theta"])["C.theta"])
    zero -= rocker(mpmath.pi / 2, 40, 120, 90, 130)

    def of(*sizes: Any) -> Numbers:
        out = [rocker(mpmath.radians(at), *sizes) for at in degrees]
        angles = [mpmath.degrees(one) for one in out]
        weighted = [one / 4 * mpmath.sqrt(w) for one, w in zip(angles, share, strict=True)]
        peaks = [mpmath.sin(one + zero) / 0.5 for one in out]
        return [*weighted, *peaks, *(one / 20 for one in angles), *(-one / 160 for one in angles)]

    found, expected = both.exact_slopes(UNKNOWNS), derivatives(of)
    for begin in range(0, 100, 25):
        assert_right(found[begin : begin + 25], expected[begin : begin + 25])


@pytest.mark.parametrize("beside", [0.0, 1e-3])
def test_what_has_no_sensitivity_is_told_and_taken_from_differences(beside: float) -> None:
    file = mk.load(FILE_OF["planar_four_bar"])
    wanted = file.analyze()["C.theta"][[4, 8]]
    # at the own values abs() has its kink in the row
    target = {"of": f"abs(C.theta - {float(wanted[0]) + beside!r} deg)", "at": [60, 120]}
    values = FitValues(
        FitModels(file), *request(file.problem, {**target, "is": [0, 0]}, {"a": (30, 50)}, ())
    )
    slopes = FitSlopes(values)
    both = Measured(values.measure, slopes.stacked)
    found = both.exact_slopes(np.array([0.5]))
    assert np.isfinite(found).all()
    assert both.filled == (0 if beside else 1)
    assert bool(slopes.why) == (not beside)
    if not beside:
        assert "a: 1 rows bent" in next(iter(slopes.why.values()))
