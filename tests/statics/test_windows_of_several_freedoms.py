"""Windows of several freedoms: turns that springs count, inches, and searches side by side, against
closed forms."""

from __future__ import annotations

from math import cos, degrees, pi, sin
from typing import Any

import numpy as np
import pytest
from statics.roots import roots

import mechkin_cli as mk
from mechkin_cli.kernel import functions
from mechkin_cli.response import prepare
from mechkin_cli.statics.forces import FreePlace
from mechkin_cli.statics.newton import Balancing, search, searches
from mechkin_cli.statics.places import Place, Statics

G = 9.81
INCH, POUND, STANDARD_GRAVITY = 0.0254, 0.45359237, 9.80665


def two_pendulums(stiffness: tuple[float, float]) -> dict[str, Any]:
    """Two that know nothing of each other, each with a spring that counts turns."""
    turning = {"type": "R", "axis": [0, 0, 1]}
    springs = [
        {"type": "spring", "joint": joint, "coordinate": "theta", "stiffness": k}
        for joint, k in zip("AB", stiffness, strict=True)
    ]
    return {
        "format": 1,
        "units": {"angle": "rad"},
        "links": {
            "a": {"mass": 1, "center_of_mass": [0, 1, 0]},
            "b": {"mass": 1, "center_of_mass": [1, 0, 0]},
        },
        "joints": {
            "A": {**turning, "links": ["ground", "a"], "point": [0, 0, 0]},
            "B": {**turning, "links": ["ground", "b"], "point": [0, 0, 0]},
        },
        "loads": [{"type": "gravity", "g": [0, -G, 0]}, *springs],
    }


def test_equilibria_in_several_turns_are_all_pairs_of_those_of_each_freedom() -> None:
    low, high = -9.0, 10.0
    first = roots(lambda t: 1.2 * t - G * sin(t), low, high)
    second = roots(lambda t: 2.1 * t + G * cos(t), low, high)
    assert len(first) > 3
    assert len(second) > 2
    window = {"A.theta": (low, high), "B.theta": (low, high)}
    r = mk.load(two_pendulums((1.2, 2.1))).equilibrium(window=window)
    wanted = [(x, y) for x in sorted(first) for y in sorted(second)]
    found = sorted(zip(r["A.theta"].tolist(), r["B.theta"].tolist(), strict=True))
    # pairs of the same first coordinate lie in the order of the second, to rounding of the first
    found = sorted(found, key=lambda pair: (round(pair[0], 6), pair[1]))
    assert np.array(found) == pytest.approx(np.array(wanted), abs=1e-8)
    # where turns count those of even index need not be as many as those of odd index
    assert "window-missing" not in [note.code for note in r.diagnostics]


def test_files_in_inches_pounds_and_degrees_have_the_same_equilibria() -> None:
    stiffness = 1.2, 2.1
    first = roots(lambda t: stiffness[0] * t - G * sin(t), -6, 7)
    second = roots(lambda t: stiffness[1] * t + G * cos(t), -6, 7)
    force = POUND * STANDARD_GRAVITY
    inches = two_pendulums((stiffness[0] / (force * INCH), stiffness[1] / (force * INCH)))
    inches["units"] = {"length": "in", "mass": "lbm", "force": "lbf"}
    for link in inches["links"].values():
        link["mass"] /= POUND
        link["center_of_mass"] = [x / INCH for x in link["center_of_mass"]]
    inches["loads"][0]["g"] = [0, -G / INCH, 0]
    ends = degrees(-6), degrees(7)
    r = mk.load(inches).equilibrium(window={"A.theta": ends, "B.theta": ends})
    found = np.radians(np.stack([r["A.theta"], r["B.theta"]], axis=1))
    assert len(found) == len(first) * len(second)
    for x in first:
        for y in second:
            assert np.abs(found - [x, y]).max(axis=1).min() < 1e-9


def test_searches_side_by_side_find_what_each_finds_alone() -> None:
    """Bit for bit, whatever goes on beside it."""
    model = mk.load({**two_pendulums((1.2, 2.1)), "equilibria": {"one": {}}})
    design = model.design
    response = design.response("one")
    one = prepare(design.problem, response, session=design.session_of("one"))
    balancing = Balancing.of(one.chosen, response.independent)
    statics = Statics(one.chosen, range(2))
    inputs = np.stack([functions.RandomStarts().between(pi, 2 * 11).reshape(2, 11)])[0]
    states, turns = inputs.copy(), np.zeros((2, 11))
    starts, good = balancing.charted_each(statics, Place(inputs, states, turns))
    assert good.all()
    together = searches(balancing, starts)
    for k, found in enumerate(together):
        alone = search(balancing, starts.at(k))
        assert alone.end == found.end
        assert alone.steps == found.steps
        for own, other in zip(alone.place, found.place, strict=True):
            assert own.tobytes() == np.ascontiguousarray(other).tobytes()
    assert len({found.steps for found in together}) > 1
    assert FreePlace.many([one.place for one in together]).state.shape == states.shape
