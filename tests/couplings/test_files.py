"""What a file may say of couplings, what is told of errors, and the same answer in space."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile, MechkinError
from mechkin_cli.kernel.functions import widths

SPACE = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
parameters: {n: 20}
links: {w1: {}, w2: {mass: 1, center_of_mass: [0.6, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}}
joints:
  A: {type: C, links: [ground, w1], point: [0, 0, 0], axis: [1, 2, 2]}
  B: {type: R, links: [w2, ground], point: [0.6, 0, 0], axis: [1, 2, 2]}
couplings:
  G: {type: gear, joints: [A, B], teeth: [n, 50], ideal: true}
motion:
  inputs:
    A.theta: {from: 0, to: 40, count: 5, rate: 10 rad/s, acceleration: 4 rad/s^2, jerk: 2 rad/s^3}
    A.s: {at: 0.1}
loads: [{type: torque, link: w2, torque: [1, 0, 0]}]
"""


def test_wheels_on_oblique_axes_in_space() -> None:
    """B counts the turn of the ground against its wheel, so that it turns as A does."""
    result = mk.loads(SPACE).analyze()
    assert set(result["row.status"]) == {"ok"}
    for order, value in (("", np.linspace(0.0, 40.0, 5)), ("_dot", 10.0), ("_ddot", 4.0)):
        np.testing.assert_allclose(result[f"B.theta{order}"], 0.4 * value, rtol=1e-14)
    np.testing.assert_allclose(result["B.theta_dddot"], 0.8, rtol=1e-13)
    # about the axis: the wheel's inertia by -0.4 of A's turn, and a third of the load
    at_wheel = -0.4 * 4.0 - 1.0 / 3.0
    np.testing.assert_allclose(result["A.theta.effort"], -0.4 * at_wheel, rtol=1e-12)
    np.testing.assert_allclose(result["G.torque"], 0.4 * at_wheel, rtol=1e-12)
    moment = result["B.moment"]
    along = (moment[:, 0] + 2.0 * moment[:, 1] + 2.0 * moment[:, 2]) / 3.0
    np.testing.assert_allclose(along, 0.0, atol=1e-13)


def test_axes_that_are_drawn_the_other_way_count_the_other_way() -> None:
    other = SPACE.replace(
        "point: [0.6, 0, 0], axis: [1, 2, 2]", "point: [0.6, 0, 0], axis: [-1, -2, -2]"
    )
    result = mk.loads(other).analyze()
    np.testing.assert_allclose(result["B.theta_dot"], -4.0, rtol=1e-14)


def test_teeth_may_be_parameters() -> None:
    """Of a file, of variants in lanes, and bit for bit on all widths and threads."""
    model = mk.loads(SPACE)
    turns = model.vary({"n": [15, 20, 30]}, ["B.theta", "A.theta.effort"])
    np.testing.assert_allclose(turns["B.theta"][:, -1], [12.0, 16.0, 24.0], rtol=1e-14)
    for number, teeth in enumerate((15, 20, 30)):
        alone = model.with_parameters({"n": teeth}).analyze()
        np.testing.assert_allclose(
            turns["A.theta.effort"][number], alone["A.theta.effort"], rtol=1e-13
        )
    rows = [model.analyze(lanes=n, threads=t)["A.theta.effort"] for n in widths() for t in (1, 2)]
    assert len({row.tobytes() for row in rows}) == 1


def test_slopes_by_teeth_and_by_a_helix() -> None:
    """B = n/50 A; the thrust's moment on the wheel goes with the tangent of the helix."""
    slopes = mk.loads(SPACE).sensitivities(["B.theta"], ["n"])
    turn = np.linspace(0.0, 40.0, 5)
    np.testing.assert_allclose(slopes["B.theta", "n"], turn / 50.0, rtol=1e-9, atol=1e-12)
    text = SPACE.replace("parameters: {n: 20}", "parameters: {n: 20, beta: 0.5 rad}")
    text = text.replace("ideal: true", "helix: beta").replace("type: C", "type: R")
    text = text.replace("    A.s: {at: 0.1}\n", "").replace("{mass: 1, center", "{mass: 0, center")
    text = text.replace("xx: 1, yy: 1, zz: 1", "")
    model = mk.loads(text)
    slopes = model.sensitivities(["norm(G.tooth_force)"], ["beta"])
    # a third of 1 N m at 30/70 of the distance of the axes; the force is that over the cosine
    apart = 0.6 * np.sqrt(8.0) / 3.0
    size = 1.0 / 3.0 / (apart * 5.0 / 7.0)
    found = slopes["norm(G.tooth_force)", "beta"]
    np.testing.assert_allclose(found, size * np.sin(0.5) / np.cos(0.5) ** 2, rtol=1e-7)


def test_rows_are_proven_and_their_errors_known() -> None:
    model = mk.loads(SPACE)
    assert set(model.certify().status) == {"proven"}


def test_a_coupling_too_many_of_a_parallelogram_is_redundant() -> None:
    """Its cranks turn alike: gears between them (over an idler) keep it so at its change points."""
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {a: {}, b: {}, d: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0, 1]}
  C: {type: R, links: [d, b], point: [3, 1]}
  D: {type: R, links: [ground, d], point: [3, 0]}
motion: {inputs: {A.theta: {from: 0, to: 7, count: 8}}}
couplings: {G: {type: linear, terms: {A.theta: 1, D.theta: -1}}}
"""
    model = mk.loads(text)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["D.theta"], np.linspace(0.0, 7.0, 8), atol=1e-12)
    assert model.mobility().mobility == 1


WRONG = {
    "no teeth": ("teeth: [n, 50], ", "", "told by teeth or by radii"),
    "negative teeth": ("[n, 50]", "[n, -50]", "the teeth of a wheel are -50"),
    "unknown joint": ("[A, B]", "[A, Q]", "there is no joint Q"),
    "no type": ("type: gear", "type: grip", "known words: linear, gear, rack"),
    "name taken": ("  G: {type: gear", "  A: {type: gear", "already used"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_what_is_wrong_is_told_at_its_place(before: str, after: str, words: str) -> None:
    assert before in SPACE
    with pytest.raises(InvalidFile) as told:
        mk.loads(SPACE.replace(before, after))
    errors = [d for d in told.value.diagnostics if d.severity == "error"]
    assert len(errors) == 1
    assert words in str(errors[0])
    assert errors[0].place is not None


def test_wheels_that_are_both_driven_leave_nothing_to_a_coupling() -> None:
    both = SPACE.replace("A.s: {at: 0.1}", "A.s: {at: 0.1}\n    B.theta: {with: 0.4*A.theta}")
    with pytest.raises(MechkinError, match="nothing is left that G could move"):
        mk.loads(both).analyze()


FACTORS = {
    "zero": ("A.theta: 1, B.theta: 0", "the factor of B.theta is zero"),
    "alone": ("A.theta: 1", "two coordinates or more"),
    "unit": ("A.theta: 1, A.s: 2 m", "dimension"),
    "unknown": ("A.theta: 1, B.s: 2 rad/m", "no coordinate s"),
}


@pytest.mark.parametrize(("terms", "words"), FACTORS.values(), ids=FACTORS.keys())
def test_factors_carry_their_coordinates_to_what_the_first_measures(terms: str, words: str) -> None:
    gear = "{type: gear, joints: [A, B], teeth: [n, 50], ideal: true}"
    assert gear in SPACE
    with pytest.raises(InvalidFile) as told:
        mk.loads(SPACE.replace(gear, f"{{type: linear, terms: {{{terms}}}}}"))
    assert any(words in str(d) for d in told.value.diagnostics)


PLANE = """
format: 1
plane: xy
links: {a: {}, b: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [0.06, 0]}
couplings:
  K: COUPLING
motion: {inputs: {A.theta: {from: 0, to: 10, step: 5}}}
"""
TINY = {
    "teeth": "{type: gear, joints: [A, B], teeth: [TINY, 38]}",
    "wheels": "{type: gear, joints: [A, B], radii: [TINY, 38]}",
    "chain": "{type: chain, joints: [A, B], teeth: [TINY, 38], pitch: 5 mm}",
    "pitch": "{type: chain, joints: [A, B], teeth: [20, 38], pitch: TINY}",
    "belt": "{type: belt, joints: [A, B], radii: [TINY, 1]}",
    "segment": (
        "{type: function, of: A.theta, gives: B.theta, law: {law: sequence, segments: "
        "[{for: TINY, to: 3 deg, law: cycloidal}, {for: 300 deg, law: dwell}]}}"
    ),
    "rise": (
        "{type: function, of: A.theta, gives: B.theta, law: "
        "{law: cycloidal, from: 0, to: 1, duration: TINY}}"
    ),
}


@pytest.mark.parametrize("tiny", ["5e-324", "1e-308", "1e-200", "1e-80"])
@pytest.mark.parametrize("coupling", TINY.values(), ids=TINY.keys())
def test_what_numbers_are_divided_by_is_no_slip_of_the_pen(coupling: str, tiny: str) -> None:
    text = PLANE.replace("COUPLING", coupling.replace("TINY", tiny))
    with pytest.raises(InvalidFile) as told:
        mk.loads(text)
    found = {(d.code, d.place is not None) for d in told.value.diagnostics}
    words = ("no-wheel", "no-duration", "too-small", "expression")
    assert found <= {(word, True) for word in words}
