"""What is said of friction: errors of the file, reactions that are arbitrary, variants."""

from __future__ import annotations

import numpy as np
import pytest
from friction.slider_crank import TEXT
from oracle import document, to_text

import mechkin_cli as mk
from mechkin_cli.verdict import Status

FOUR_BAR = """
format: 1
name: four-bar of pins
links: {crank: {mass: 1, center_of_mass: [0.5, 0, 0]}, coupler: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [0, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [coupler, rocker], point: [3, 2.5, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [3.5, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 60, step: 20, rate: 1 rad/s}}}
loads:
  - {type: torque, joint: D, value: -5}
  - {type: friction, joint: B, coefficient: 0.1, radius: 0.02LENGTH}
"""


def test_friction_by_a_reaction_that_is_arbitrary():
    names = ["A.effort", "B.force", "B.theta"]
    found = mk.loads(FOUR_BAR.replace("LENGTH", ", length: 0.1")).analyze(names, tables=[])
    (diagnostic,) = [d for d in found.diagnostics if d.severity == "error"]
    assert diagnostic.code == "friction-not-unique"
    assert "friction of B" in diagnostic.message
    assert "leave out length" in diagnostic.hint
    assert diagnostic.place is not None
    assert diagnostic.place.line == 13
    assert np.isnan(found["A.effort"]).all()
    assert not np.isnan(found["B.theta"]).any()
    assert (found.result.status == Status.friction_undecided).all()


def test_the_part_that_is_unique_is_enough():
    found = mk.loads(FOUR_BAR.replace("LENGTH", "")).analyze(
        ["A.effort", "B.friction_moment"], tables=[]
    )
    assert [d.code for d in found.diagnostics if d.severity == "error"] == []
    assert not np.isnan(found["A.effort"]).any()
    assert (np.abs(found["B.friction_moment"][:, 2]) > 0.0).all()


def friction(**keys: str) -> str:
    """The slider-crank with another friction at A."""
    data = document(TEXT)
    data["loads"][2] = {"type": "friction", "joint": "A"} | keys
    return to_text(data)


NO_LAW = (
    TEXT.replace(
        "  - {type: friction, joint: A",
        "  - {type: friction, joint: E, coefficient: 0.1}\n  - {type: friction, joint: A",
    )
    .replace(
        "joints:\n",
        "joints:\n  E: {type: U, links: [ground, tail], point: [9, 9, 9], axis: [1, 0, 0], "
        "axis2: [0, 1, 0]}\n",
    )
    .replace("links:\n", "links:\n  tail: {}\n")
    .replace("A.theta: {", "E.theta1: {at: 0}, E.theta2: {at: 0}, A.theta: {")
)

BAD = {
    "no radius": (friction(coefficient="0.1"), "needs a radius"),
    "a key of another joint": (friction(coefficient="0.1", radius="8", flank="15"), "has no flank"),
    "negative coefficient": (friction(coefficient="-0.1", radius="8"), "not negative"),
    "a coefficient with a unit": (friction(coefficient="2 mm", radius="8"), "dimensionless"),
    "zero radius": (friction(coefficient="0.1", radius="0"), "must be positive"),
    "a radius in kg": (friction(coefficient="0.1", radius="8 kg"), "length"),
    "no joint": (TEXT.replace("joint: C, coefficient", "joint: Z, coefficient"), "no joint Z"),
    "twice": (TEXT.replace("joint: C, coefficient", "joint: A, coefficient"), "given twice"),
    "width along the axis": (
        TEXT.replace("across: [0, 0, 1]", "across: [2, 0, 0]"),
        "along its axis",
    ),
    "across without width": (TEXT.replace("width: 40, ", ""), "there is none"),
    "static below sliding": (TEXT.replace("static: 0.15", "static: 0.05"), "smaller than"),
    "speed zero": (TEXT.replace("speed: 80", "speed: 0"), "must be positive"),
    "no law": (NO_LAW, "no law of friction"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_friction(name):
    text, words = BAD[name]
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    (diagnostic,) = caught.value.diagnostics
    assert words in diagnostic.message
    assert diagnostic.place is not None
    assert diagnostic.hint


PARAMETERS = TEXT.replace("units:", "parameters: {mu: 0.12, r: 8 mm}\nunits:").replace(
    "coefficient: 0.12, radius: 8", "coefficient: mu, radius: r"
)


def test_variants_of_coefficients():
    base = mk.loads(PARAMETERS)
    values = {"mu": np.array([0.0, 0.1, 0.3]), "r": np.array([0.008, 0.005, 0.012])}
    values["r"] = values["r"] * 1000.0
    found = base.vary(values, ["A.effort", "A.friction_power"])
    for number in range(3):
        mu, radius = float(values["mu"][number]), float(values["r"][number])
        text = PARAMETERS.replace("mu: 0.12, r: 8 mm", f"mu: {mu!r}, r: {radius!r} mm")
        fresh = mk.loads(text).analyze(["A.effort", "A.friction_power"], tables=[])
        for name in ("A.effort", "A.friction_power"):
            assert found[name][number] == pytest.approx(fresh[name], rel=1e-13, abs=1e-9)
    again = base.with_parameters({"mu": 0.3, "r": 12.0}).analyze(["A.effort"], tables=[])
    assert again["A.effort"].tobytes() == found["A.effort"][2].tobytes()


def test_variants_that_jam_say_so():
    text = """
format: 1
name: guide
parameters: {arm: 0.1}
links: {pusher: {}, slider: {}}
joints:
  D: {type: P, links: [ground, pusher], point: [0, 0.1, 0], axis: [1, 0, 0]}
  G: {type: P, links: [ground, slider], point: [0, 0, 0], axis: [1, 0, 0]}
  K: {type: Sp, links: [pusher, slider], point: [0, 0.1, 0], normal: [1, 0, 0]}
motion: {inputs: {D.s: {from: 0, to: 0.2, step: 0.1, rate: 1}}}
loads:
  - {type: force, link: slider, point: [0, 0, 0], force: [-50, 0, 0]}
  - {type: friction, joint: G, coefficient: arm, length: 0.1}
"""
    found = mk.loads(text).vary({"arm": np.array([0.2, 0.6])}, ["D.effort"])
    assert (found.status[0] == "ok").all()
    assert (found.status[1] == "friction-undecided").all()
    assert np.isnan(found["D.effort"][1]).all()
    assert found["D.effort"][0] == pytest.approx(np.full(3, 50 / 0.6))


PUSHED = """
format: 1
name: block
links: {block: {mass: 2, center_of_mass: [0, 0, 0]}}
joints: {D: {type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
motion:
  time: {from: 0, to: LAST}
  inputs: {D.s: {law: polynomial, coefficients: [COEFFICIENTS]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: friction, joint: D, coefficient: {static: 0.3, sliding: 0.1}, length: 1}
"""


@pytest.mark.parametrize(
    ("coefficients", "at_rest"),
    [("0 m, 3 m/s, -3 m/s^2, 1 m/s^3", None), ("0 m, -2 m/s, 1 m/s^2", 4 + 0.3 * 19.62)],
)
def test_a_row_in_which_a_slip_stands_still(coefficients, at_rest):
    """At one second, between rows that know nothing of it: of (t - 1)^3 nothing tells where it goes
    on, of (t - 1)^2 the acceleration does, and the coefficient is that of rest."""
    text = PUSHED.replace("COEFFICIENTS", coefficients)
    names = ["D.effort", "D.friction_force", "row.power_error"]
    every = mk.loads(text.replace("LAST", "2, step: 0.5")).analyze(names, tables=[])
    alone = mk.loads(text.replace("LAST", "1.5, step: 1.5")).analyze(names, tables=[])
    statuses = [str(status) for status in every["row.status"]]
    if at_rest is None:
        assert statuses == ["ok", "ok", "friction-undecided", "ok", "ok"]
        (said,) = (d for d in every.diagnostics if d.code == "friction-undecided")
        assert "no direction" in said.message
        assert "row 3" in said.message
        assert np.isnan(every["D.effort"][2])
        assert np.isnan(every["D.friction_force"][2]).all()
    else:
        assert statuses == ["ok"] * 5
        assert every["D.effort"][2] == pytest.approx(at_rest, abs=1e-13)
    for name in names[:2]:
        assert every[name][3].tobytes() == alone[name][1].tobytes()
    sliding = 0.1 * 19.62
    wanted = [-6 + sliding, 6 + sliding] if at_rest is None else [4 - sliding, 4 + sliding]
    assert every["D.effort"][[1, 3]] == pytest.approx(wanted, abs=1e-13)
