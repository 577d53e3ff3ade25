"""The kernel's elementary functions against mpmath, in units in the last place."""

import math

import mpmath
import numpy as np
import pytest
from mpmath import mp, mpf

from mechkin_cli.kernel import _kernel, functions

SAMPLES = 1500
INFINITY, NAN = math.inf, math.nan
LARGEST, SMALLEST = 1.7976931348623157e308, 5e-324


def all_magnitudes(random, count=SAMPLES):
    """Doubles of both signs from the smallest subnormal to the largest."""
    return np.ldexp(random.uniform(0.5, 1, count), random.integers(-1073, 1025, count)) * signs(
        random, count
    )


def signs(random, count):
    return random.choice([-1.0, 1.0], count)


def near_quarter_turns(random):
    """The doubles next to multiples of pi/2, up to 1e22, and the closest of all to any multiple."""
    multiples = [*range(1, 100), *(29 << i for i in range(13))]
    multiples += [int(m) for m in 10 ** random.uniform(2, 22, 400)]
    with mp.workprec(200):
        nearest = [float(m * mp.pi / 2) for m in multiples]
    return np.array([*nearest, math.ldexp(6381956970095103, 797)])


def angles(random):
    return np.concatenate(
        [
            random.uniform(-10, 10, SAMPLES),
            random.uniform(-1e6, 1e6, SAMPLES),
            random.uniform(0.7, 0.9, SAMPLES),
            all_magnitudes(random),
            near_quarter_turns(random),
            [1e22, LARGEST, 2e5, np.nextafter(2e5, 1e6), SMALLEST],
        ]
    )


def within_one(random):
    near_one = 1 - np.ldexp(1.0, -random.integers(1, 54, SAMPLES))
    return np.concatenate(
        [
            random.uniform(-1, 1, 2 * SAMPLES),
            near_one * signs(random, SAMPLES),
            random.uniform(0.49, 0.51, SAMPLES),
            np.ldexp(random.uniform(0.5, 1, 100), -random.integers(30, 1074, 100)),
        ]
    )


def exponents(random):
    return np.concatenate(
        [
            random.uniform(-1, 1, SAMPLES),
            random.uniform(-745, 709.7, 2 * SAMPLES),
            [709.782712893384],
        ]
    )


def positive(random):
    near_one = 1 + random.uniform(-1, 1, SAMPLES) * np.ldexp(1.0, -random.integers(2, 52, SAMPLES))
    return np.concatenate([abs(all_magnitudes(random)), random.uniform(0.5, 2, SAMPLES), near_one])


def slopes(random):
    steep = 1 / random.uniform(-1, 1, SAMPLES)
    return np.concatenate([random.uniform(-1, 1, SAMPLES), steep, all_magnitudes(random)])


def error_in_last_places(computed, exact):
    """|computed - exact| over the distance of doubles at the exact value."""
    if not math.isfinite(computed):
        return math.inf
    exponent = max(mpmath.frexp(exact)[1] - 53, -1074)
    return float(abs(mpf(float(computed)) - exact) * mpf(2) ** -int(exponent))


def precision_for(argument):
    """Bits that keep 100 of them after reducing the argument by multiples of pi."""
    return 180 + max(0, math.frexp(argument)[1])


def largest_error(function, exact, *arguments):
    computed = function(*arguments)
    errors = []
    for values in zip(computed, *arguments, strict=True):
        got, *given = (float(v) for v in values)
        with mp.workprec(max(precision_for(v) for v in given)):
            errors.append((error_in_last_places(got, exact(*map(mpf, given))), *given))
    return max(errors)


@pytest.mark.parametrize(
    ("name", "sample", "limit"),
    [
        ("sin", angles, 0.8),
        ("cos", angles, 0.8),
        ("tan", angles, 0.9),
        ("asin", within_one, 0.7),
        ("acos", within_one, 0.8),
        ("atan", slopes, 0.9),
        ("exp", exponents, 0.8),
        ("log", positive, 0.51),
    ],
)
def test_error_of_one_argument(name, sample, limit):
    x = sample(np.random.default_rng(1))
    error, *place = largest_error(getattr(functions, name), getattr(mp, name), x)
    assert error < limit, place


def points_all_around(random):
    return random.uniform(-1, 1, 2 * SAMPLES), random.uniform(-1, 1, 2 * SAMPLES)


def points_of_all_magnitudes(random):
    return all_magnitudes(random), all_magnitudes(random)


def points_near_the_diagonals(random):
    y = np.clip(all_magnitudes(random), -1e307, 1e307)
    return y, y * random.uniform(0.1, 10, SAMPLES) * signs(random, SAMPLES)


def points_with_slope_near_a_quarter(random):
    x = random.uniform(0.5, 1, 3 * SAMPLES)
    return x * random.uniform(0.249, 0.256, x.size), x


@pytest.mark.parametrize(
    "sample",
    [
        points_all_around,
        points_of_all_magnitudes,
        points_near_the_diagonals,
        points_with_slope_near_a_quarter,
    ],
)
def test_error_of_atan2(sample):
    y, x = sample(np.random.default_rng(2))
    error, *place = largest_error(functions.atan2, mp.atan2, y, x)
    assert error < 1.5, place


@pytest.mark.parametrize("spread", [1.0, 2.0**-20, 2.0**-45, 1000.0])
def test_error_of_power(spread):
    random = np.random.default_rng(3)
    base = np.exp2(random.uniform(-spread, spread, SAMPLES))
    base = base[base != 1]
    exponent = random.uniform(-740, 709, base.size) / np.log(base)
    error, *place = largest_error(functions.power, mp.power, base, exponent)
    assert error < 0.8, place


def same(computed, expected):
    """Equal in value and sign of zero, or both nan."""
    if math.isnan(expected):
        return math.isnan(computed)
    return computed == expected and math.copysign(1, computed) == math.copysign(1, expected)


PI, HALF, QUARTER, THREE_QUARTERS = math.pi, math.pi / 2, math.pi / 4, 3 * math.pi / 4


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        *((name, (zero,), zero) for name in ("sin", "tan", "asin", "atan") for zero in (0.0, -0.0)),
        *((name, (x,), NAN) for name in ("sin", "cos", "tan") for x in (INFINITY, -INFINITY, NAN)),
        *((name, (x,), NAN) for name in ("asin", "acos") for x in (1.0000000000000002, -2.0, NAN)),
        ("cos", (-0.0,), 1.0),
        ("asin", (1.0,), HALF),
        ("asin", (-1.0,), -HALF),
        ("acos", (1.0,), 0.0),
        ("acos", (-1.0,), PI),
        ("acos", (0.0,), HALF),
        ("atan", (INFINITY,), HALF),
        ("atan", (-INFINITY,), -HALF),
        ("atan", (NAN,), NAN),
        ("atan2", (0.0, 0.0), 0.0),
        ("atan2", (-0.0, 0.0), -0.0),
        ("atan2", (0.0, -0.0), PI),
        ("atan2", (-0.0, -0.0), -PI),
        ("atan2", (0.0, 1.0), 0.0),
        ("atan2", (-0.0, 1.0), -0.0),
        ("atan2", (0.0, -1.0), PI),
        ("atan2", (-0.0, -1.0), -PI),
        ("atan2", (1.0, 0.0), HALF),
        ("atan2", (-1.0, -0.0), -HALF),
        ("atan2", (3.0, 3.0), QUARTER),
        ("atan2", (-3.0, -3.0), -THREE_QUARTERS),
        ("atan2", (INFINITY, INFINITY), QUARTER),
        ("atan2", (-INFINITY, -INFINITY), -THREE_QUARTERS),
        ("atan2", (1.0, INFINITY), 0.0),
        ("atan2", (-1.0, -INFINITY), -PI),
        ("atan2", (INFINITY, -2.0), HALF),
        ("atan2", (LARGEST, LARGEST), QUARTER),
        ("atan2", (SMALLEST, SMALLEST), QUARTER),
        ("atan2", (NAN, INFINITY), NAN),
        ("atan2", (0.0, NAN), NAN),
        ("exp", (0.0,), 1.0),
        ("exp", (709.8,), INFINITY),
        ("exp", (INFINITY,), INFINITY),
        ("exp", (-745.2,), 0.0),
        ("exp", (-INFINITY,), 0.0),
        ("exp", (NAN,), NAN),
        ("log", (1.0,), 0.0),
        ("log", (0.0,), -INFINITY),
        ("log", (-0.0,), -INFINITY),
        ("log", (-1.0,), NAN),
        ("log", (INFINITY,), INFINITY),
        ("log", (NAN,), NAN),
        ("power", (NAN, 0.0), 1.0),
        ("power", (1.0, NAN), 1.0),
        ("power", (2.0, NAN), NAN),
        ("power", (-1.0, INFINITY), 1.0),
        ("power", (0.5, INFINITY), 0.0),
        ("power", (0.5, -INFINITY), INFINITY),
        ("power", (0.0, 2.0), 0.0),
        ("power", (-0.0, 3.0), -0.0),
        ("power", (-0.0, -3.0), -INFINITY),
        ("power", (-0.0, -2.5), INFINITY),
        ("power", (INFINITY, -0.5), 0.0),
        ("power", (-INFINITY, 3.0), -INFINITY),
        ("power", (-INFINITY, 0.5), INFINITY),
        ("power", (-INFINITY, -3.0), -0.0),
        ("power", (-2.0, 3.0), -8.0),
        ("power", (-2.0, 4.0), 16.0),
        ("power", (-2.0, -1.0), -0.5),
        ("power", (-2.0, 0.5), NAN),
        ("power", (-1.0, 2.0**53 - 1), -1.0),
        ("power", (-1.0, 2.0**53 + 2), 1.0),
        ("power", (-1.0, 2.0**51 + 0.5), NAN),
        ("power", (3.0, 2.0), 9.0),
        ("power", (10.0, 22.0), 1e22),
        ("power", (2.0, 1e300), INFINITY),
        ("power", (-2.0, 1025.0), -INFINITY),
        ("power", (2.0, -1074.0), SMALLEST),
        ("power", (2.0, -1076.0), 0.0),
    ],
)
def test_special_values(name, arguments, expected):
    assert same(getattr(functions, name)(*arguments), expected)


ONE_ARGUMENT = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "log")


@pytest.mark.parametrize("name", [*ONE_ARGUMENT, "atan2", "power"])
def test_bits_do_not_depend_on_neighbours(name):
    random = np.random.default_rng(4)
    hard = [0.0, -0.0, INFINITY, NAN, 1e300, 3e5, SMALLEST, 1e-300]
    x = np.concatenate([random.uniform(-1, 1, 15), hard, random.uniform(-20, 20, 14)])
    arguments = (x,) if name in ONE_ARGUMENT else (x, x[::-1].copy())
    function = getattr(functions, name)
    together = function(*arguments)
    alone = np.array([function(*map(float, values)) for values in zip(*arguments, strict=True)])
    assert together.tobytes() == alone.tobytes()


@pytest.mark.parametrize("lanes", [lanes for lanes in (2, 4) if lanes < _kernel.widest])
def test_bits_do_not_depend_on_the_width(lanes):
    random = np.random.default_rng(5)
    x, y = all_magnitudes(random), all_magnitudes(random)
    x[::2], y[::2] = random.uniform(-1, 1, x[::2].size), random.uniform(-9, 9, y[::2].size)
    for operation in range(10):
        narrow = _kernel.elementwise(operation, x, y, lanes)
        wide = _kernel.elementwise(operation, x, y, _kernel.widest)
        assert narrow.tobytes() == wide.tobytes(), operation


@pytest.mark.parametrize("count", range(18))
def test_length_and_kind_are_kept(count):
    result = functions.exp(np.zeros(count))
    assert result.dtype == np.float64
    assert result.tolist() == [1.0] * count


def test_arrays_of_any_layout():
    x = np.arange(6)[::-2]
    x.flags.writeable = False
    assert functions.power(x, np.full(3, 2)).tolist() == [25.0, 9.0, 1.0]


def test_different_lengths_are_refused():
    with pytest.raises(ValueError, match="different length"):
        functions.atan2(np.zeros(3), np.zeros(2))


def test_a_total_is_summed_from_the_first_to_the_last() -> None:
    """By IEEE 754: 1e16 + 1 rounds to 1e16; what Python's `sum` gives depends on its version."""
    assert functions.total([1e16, 1.0, 1.0, -1e16]) == 0.0
    assert functions.total([1.0, 1.0, 1e16, -1e16]) == 2.0
    assert functions.total([]) == 0
