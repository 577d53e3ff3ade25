"""Random studies of four-bars and a pendulum against closed forms: crossing, rows, dead centres and
what is kept of each variant."""

import itertools
import math
import os
import random
from typing import Any

import numpy as np
import pytest
from means import mean_over_the_way, rms_over_the_way

import mechkin_cli as mk

TIMES = 12 * int(os.environ.get("MECHKIN_RANDOM", "1"))
WORDS = ["max", "min", "peak", "range", "mean", "rms"]
PLACES = ["place_of_max", "place_of_min", "place_of_peak"]
CLEAR = 60.0
"""mm^2 by which squared distances stay off those of a dead centre."""


def four_bar(dims: dict[str, float], inputs: dict[str, Any]) -> mk.Model:
    """A four-bar a, b, c, d from the left pivot of the ground, its rocker drawn upright."""
    links = ("crank", "coupler", "rocker")
    hinges = {
        "O": (["ground", "crank"], [0, 0]),
        "A": (["crank", "coupler"], ["a", 0]),
        "B": (["coupler", "rocker"], {"coupler": ["a + b", 0], "rocker": ["d", "c"]}),
        "C": (["ground", "rocker"], ["d", 0]),
    }
    return mk.load(
        {
            "format": 1,
            "plane": "xy",
            "units": {"length": "mm"},
            "parameters": {name: f"{value} mm" for name, value in dims.items()},
            "links": {name: {} for name in links},
            "joints": {
                name: {"type": "R", "links": pair, "point": point}
                for name, (pair, point) in hinges.items()
            },
            "motion": {"inputs": {"O.theta": inputs}},
            "assembly": {"near": {"C.theta": 0}},
        }
    )


def gaps(dims: dict[str, float], degrees: np.ndarray) -> np.ndarray:
    """How far the squared distance of A and C is inside of what coupler and rocker reach."""
    a, b, c, d = (dims[name] for name in "abcd")
    square = a * a + d * d - 2.0 * a * d * np.cos(np.radians(degrees))
    found: np.ndarray = np.minimum(square - (b - c) ** 2, (b + c) ** 2 - square)
    return found


def rocker(dims: dict[str, float], side: int, degrees: np.ndarray) -> np.ndarray:
    """The rocker's angle from its drawing, in degrees, within a turn of itself."""
    a, b, c, d = (dims[name] for name in "abcd")
    x, y = a * np.cos(np.radians(degrees)) - d, a * np.sin(np.radians(degrees))
    inner = np.arccos((x * x + y * y + c * c - b * b) / (2.0 * c * np.hypot(x, y)))
    found: np.ndarray = np.degrees(np.arctan2(y, x) + side * inner) - 90.0
    return found


def rows_of(dims: dict[str, float], side: int, at: np.ndarray) -> tuple[np.ndarray, float]:
    """The rocker's angle over the rows, nan from a dead centre on; the input there, or nan."""
    angle = np.full(at.size, np.nan)
    angle[0] = (rocker(dims, side, at[:1])[0] + 180.0) % 360.0 - 180.0
    for k in range(1, at.size):
        fine = np.linspace(at[k - 1], at[k], 200)
        if gaps(dims, fine).min() < 0.0:
            # by halving between the last place that closes and the next that does not
            first = int(np.argmax(gaps(dims, fine) < 0.0))
            good, bad = fine[first - 1], fine[first]
            for _ in range(60):
                middle = (good + bad) / 2.0
                good, bad = (good, middle) if gaps(dims, middle) < 0.0 else (middle, bad)
            return angle, float(good)
        steps = np.unwrap(np.radians(rocker(dims, side, fine)))
        angle[k] = angle[k - 1] + np.degrees(steps[-1] - steps[0])
    return angle, math.nan


def expected(word: str, values: np.ndarray, at: np.ndarray) -> float:
    """What is kept of rows, by numpy."""
    if word == "mean":
        return mean_over_the_way(values, at)
    if word == "rms":
        return rms_over_the_way(values, at)
    known = values[~np.isnan(values)]
    by = {"max": np.max, "min": np.min, "peak": lambda x: np.abs(x).max(), "range": np.ptp}
    return float(by[word](known))


def assembled(rng: random.Random, at: np.ndarray) -> tuple[dict[str, float], int]:
    """Dimensions that close at the first place, and on which side of the line from C to A the
    rocker is that is clearly nearer to its drawing."""
    ranges = {"a": (20, 60), "b": (60, 150), "c": (60, 150), "d": (80, 160)}
    while True:
        dims = {name: round(rng.uniform(*ends), 1) for name, ends in ranges.items()}
        if gaps(dims, at)[0] > CLEAR:
            away = {s: abs((rocker(dims, s, at)[0] + 180) % 360 - 180) for s in (1, -1)}
            if abs(away[1] - away[-1]) > 1.0:
                return dims, min(away, key=lambda s: away[s])


@pytest.mark.parametrize("seed", range(TIMES))
def test_a_study_of_four_bars(seed: int) -> None:
    rng = random.Random(seed)
    first, way, count = rng.choice([0, 10, -30]), rng.choice([360, 90, -120, 200]), 25
    at = np.linspace(first, first + way, count)
    dims, side = assembled(rng, at[:1])
    names = rng.sample("abcd", 2)
    lists = [
        [round(dims[name] * rng.uniform(0.7, 1.4), 1) for _ in range(rng.randint(2, 4))]
        for name in names
    ]
    inputs = {"from": first, "to": first + way, "count": count}
    place = float(at[rng.randrange(count)])
    found = four_bar(dims, inputs).study(
        {
            "vary": dict(zip(names, lists, strict=True)),
            "keep": [
                {"of": "C.theta", "as": [*WORDS, *PLACES]},
                {"of": "C.theta", "as": "value", "at": place, "label": "there"},
            ],
            "rows": ["C.theta"],
            "dead_centres": "place",
        },
        threads=rng.choice([1, 2]),
    )
    crossed = list(itertools.product(*lists))
    assert list(zip(*(found[name].tolist() for name in names), strict=True)) == crossed
    for number, values in enumerate(crossed):
        own = dims | dict(zip(names, values, strict=True))
        line = [{n: dims[n] + s * (own[n] - dims[n]) for n in own} for s in np.linspace(0, 1, 99)]
        on_the_way = min(gaps(one, at[:1])[0] for one in line)
        fine = gaps(own, np.linspace(at[0], at[-1], 4000))
        if abs(on_the_way) < CLEAR or abs(fine.min()) < CLEAR:
            continue
        if on_the_way < 0.0:
            assert found["verdict"][number] == "branch-lost"
            assert found["rows_not_ok"][number] == count
            continue
        angle, end = rows_of(own, side, at)
        rows = found.rows["C.theta"][number * count : (number + 1) * count]
        assert np.allclose(rows, angle, rtol=0.0, atol=1e-8, equal_nan=True)
        assert found["rows_not_ok"][number] == np.count_nonzero(np.isnan(angle))
        assert found["dead_centre"][number] == pytest.approx(end, abs=1e-7, nan_ok=True)
        assert found["there"][number] == pytest.approx(
            angle[np.argmin(np.abs(at - place))], abs=1e-8, nan_ok=True
        )
        for word in WORDS:
            kept = found[f"{word}(C.theta)"][number]
            assert kept == pytest.approx(expected(word, angle, at), abs=1e-7), (word, number)
        for word, sizes in zip(PLACES, (rows, -rows, np.abs(rows)), strict=True):
            assert found[f"{word}(C.theta)"][number] == pytest.approx(
                at[np.nanargmax(sizes)], abs=1e-9
            )


def test_a_value_is_that_at_the_place_wherever_the_row_stands() -> None:
    """Sweeps that begin elsewhere in every variant: the row is another, or there is none."""
    dims = {"a": 40.0, "b": 120.0, "c": 90.0, "d": 130.0}
    model = four_bar(dims, {"from": 0, "to": 90, "step": 15})
    text = {
        "vary": {"begin": ["10 deg", "25 deg", "26 deg", "-50 deg"]},
        "keep": [{"of": "C.theta", "as": "value", "at": "40 deg", "label": "there"}],
        "rows": ["C.theta"],
    }
    source = dict(model.built.document.data)
    source["parameters"] = source["parameters"] | {"begin": "10 deg"}
    inputs = {"from": "begin", "to": "begin + 90 deg", "step": 15}
    source["motion"] = {"inputs": {"O.theta": inputs}}
    found = mk.load(source).study(text)
    wanted = rocker(dims, 1, np.array([40.0]))[0]
    wanted = min((wanted, rocker(dims, -1, np.array([40.0]))[0]), key=abs)
    assert found["there"][[0, 1, 3]] == pytest.approx([wanted] * 3, abs=1e-9)
    assert np.isnan(found["there"][2])


PENDULUM = {
    "format": 1,
    "units": {"angle": "rad"},
    "parameters": {"l": "1 m", "q": "0.5 rad"},
    "links": {"bob": {"mass": 2, "center_of_mass": [0, "-l", 0]}},
    "joints": {
        "A": {"type": "R", "links": ["ground", "bob"], "point": [0, 0, 0], "axis": [0, 0, 1]}
    },
    "loads": [{"type": "gravity", "g": [0, -9.81, 0]}],
    "responses": {
        "swing": {"start": {"A.theta": "q"}, "time": {"from": 0, "to": 2, "count": 21}},
        "half": {
            "start": {"A.theta": "q"},
            "time": {"values": [0, 0.05, 0.2, 0.4, 0.7, 1.1]},
            "stop": [{"value": "A.theta", "at": 0}],
        },
    },
}


@pytest.mark.parametrize("run", ["swing", "half"])
def test_a_response_is_kept_up_to_its_stop(run: str) -> None:
    special = pytest.importorskip("scipy.special")
    found = mk.load(PENDULUM).study(
        {
            "run": run,
            "vary": {"l": [0.5, 1, 1.5], "q": [0.3, 1.5]},
            "keep": [
                {"of": "A.theta", "as": ["mean", "rms", "min", "place_of_min"]},
                {"of": "A.theta", "as": "value", "at": "400 ms", "label": "early"},
                {"of": "A.theta", "as": "value", "at": 1.1, "label": "late"},
            ],
            "rows": ["A.theta"],
        }
    )
    moments = np.linspace(0, 2, 21) if run == "swing" else np.array([0, 0.05, 0.2, 0.4, 0.7, 1.1])
    for number, (length, start) in enumerate(itertools.product([0.5, 1, 1.5], [0.3, 1.5])):
        rate, m = math.sqrt(9.81 / length), math.sin(start / 2) ** 2
        quarter = float(special.ellipk(m)) / rate
        at = moments
        if run == "half" and quarter < at[-1]:
            at = np.append(at[at < quarter], quarter)

        def angle(times: Any, rate: float = rate, m: float = m) -> np.ndarray:
            sn, *_ = special.ellipj(float(special.ellipk(m)) - rate * times, m)
            return 2.0 * np.arcsin(math.sqrt(m) * sn)

        values = angle(at)
        mine = found.rows["variant"] == number
        assert np.allclose(found.rows["time"][mine], at, rtol=0.0, atol=1e-8)
        assert np.allclose(found.rows["A.theta"][mine], values, rtol=0.0, atol=1e-7)
        assert set(found.rows["verdict"][mine]) == {"ok"}
        assert found["mean(A.theta)"][number] == pytest.approx(
            mean_over_the_way(values, at), abs=1e-7
        )
        assert found["rms(A.theta)"][number] == pytest.approx(
            rms_over_the_way(values, at), abs=1e-7
        )
        assert found["place_of_min(A.theta)"][number] == pytest.approx(
            at[np.argmin(values)], abs=1e-8
        )
        for label, moment in (("early", 0.4), ("late", 1.1)):
            value = angle(moment) if moment <= at[-1] + 1e-9 else math.nan
            assert found[label][number] == pytest.approx(value, abs=1e-7, nan_ok=True)
