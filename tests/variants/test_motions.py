"""Parameters in motions and loads: what is on the tape, and what is built anew."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.building import motion_as_built
from mechkin_cli.variants.design import base_of

ARM = """
format: 1
parameters: {{k: 2, L: 0.5 m, n: 3 N}}
links:
  one: {{mass: 2, center_of_mass: [L, 0, 0], inertia: {{xx: 0.01, yy: 0.2, zz: 0.2}}}}
joints:
  A: {{type: {type}, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]{more}}}
motion: {motion}
loads: [{{type: gravity, g: [0, -10, 1]}}, {{type: {load}, joint: A, value: "{value}"}}]
"""
SWEPT = "{inputs: {A.theta: {from: 0, to: 90, step: 30, rate: 1 rad/s}}}"
HELD = "{inputs: {A.theta: {at: 20, rate: k * 1 rad/s}}}"
TIMED = "{time: {from: 0, to: 1, step: 0.25}, inputs: {A.theta: {law: LAW}}}"
HARMONIC = TIMED.replace("LAW", "harmonic, from: 0, to: 90")
TURNING = TIMED.replace("LAW", "constant-rate, at: 0, rate: k * 1 rad/s")
SLIDING = "{inputs: {A.s: {from: 0, to: 2, step: 0.5, rate: k * 1 m/s}}}"
ALONG = "{inputs: {A.s: {from: 0, to: 2, step: 0.5}}}"


def arm(motion: str, value: str = "n*L", type: str = "R", more: str = "") -> str:
    load = "force" if type == "P" else "torque"
    return ARM.format(motion=motion, value=value, type=type, more=more, load=load)


@pytest.mark.parametrize(
    ("text", "taped"),
    [
        (arm(SWEPT), True),
        (arm(SWEPT, "k*1 N*m*A.theta/(1 rad)"), True),
        (arm(HARMONIC), True),
        (arm(HARMONIC, "n*L*sin(time*k*1 rad/s)"), True),
        (arm(TURNING), False),
        (arm(HELD), True),
        (arm(SLIDING, "n*k", "P"), True),
        (arm(ALONG, "n*L", "H", ", lead: L"), False),
        (arm(HARMONIC.replace("to: 90", "to: k * 30 deg")), False),
        (arm(HARMONIC.replace("to: 90", "to: 90, start: 0.1, duration: k * 0.2 s")), False),
        (arm(TIMED.replace("LAW", "polynomial, coefficients: [0, k * 1 rad/s]")), False),
        (arm(SWEPT.replace("from: 0, to: 90, step: 30", "values: [0, 30, k * 20 deg]")), True),
        (arm(SWEPT.replace("to: 90, step: 30", "to: k * 20 deg, count: 4")), True),
    ],
)
def test_as_fresh_files(text: str, taped: bool) -> None:
    model = mk.loads(text, "arm")
    given = {"k": [2.0, 2.5, 3.0], "L": [0.5, 0.6, 0.7]}
    joint = next(iter(model.problem.mechanism.joints.values()))
    first = joint.coordinates[0]
    texts = ["A.effort", first, f"{first}_dot", "norm(A.force)"]
    result = model.vary(given, texts)
    assert (base_of(model.design).variation(("k", "L")) is not None) is taped
    for number in range(3):
        one = {name: values[number] for name, values in given.items()}
        varied = model.with_parameters(one).analyze(["A.effort", "A.force"], tables=[])
        fresh = mk.loads(text, "arm", {"k": str(one["k"]), "L": f"{one['L']} m"})
        analysis = fresh.analyze(["A.effort", "A.force"], tables=[])
        for name in texts:
            assert varied[name].tobytes() == result[name][number].tobytes(), name
            assert np.allclose(analysis[name], varied[name], rtol=1e-13, atol=1e-13), name


def test_variants_with_other_rows() -> None:
    model = mk.loads(arm(SWEPT.replace("to: 90, step: 30", "to: 40, step: k * 5 deg")), "arm")
    result = model.vary({"k": [2, 4]}, ["A.theta"])
    assert result["A.theta"][0].tolist() == [0.0, 10.0, 20.0, 30.0, 40.0]
    assert "has 3 rows, the file has 5" in str(result.errors[1])
    assert set(result.status[1]) == {"not-assembled"}


WELDED = """
format: 1
parameters: {L: 0.5 m}
links: {one: {mass: 2, center_of_mass: [L, 0, 0]}}
joints: {A: {type: W, links: [ground, one]}}
loads: [{type: gravity, g: [0, -10, 1]}]
"""


def test_a_mechanism_that_does_not_move() -> None:
    result = mk.loads(WELDED).vary({"L": [0.5, 1.0]}, ["A.moment_about_origin", "A.force"])
    assert np.allclose(result["A.moment_about_origin"][:, 0, 2], [10.0, 20.0])
    assert np.allclose(result["A.force"][:, 0], [0.0, 20.0, -2.0])


@pytest.mark.parametrize(
    ("motion", "k", "message"),
    [
        (SWEPT.replace("to: 90, step: 30", "to: 40, step: k * 5 deg"), 0, "the step is zero"),
        (SWEPT.replace("from: 0, to: 90, step: 30", "values: [0, 30 deg / k]"), 0, "division"),
        (SWEPT.replace("rate: 1 rad/s", "rate: 1 rad/s / k"), 0, "division by zero"),
        (
            HARMONIC.replace("to: 90", "to: 90, start: 0.1, duration: k * 0.2 s"),
            -1,
            "positive time",
        ),
    ],
)
def test_a_motion_that_says_something_is_refused_as_in_a_fresh_file(
    motion: str, k: float, message: str
) -> None:
    """The variant's motion alone is read again, and must not stand in spite of what it says."""
    model = mk.loads(arm(motion), "arm")
    with pytest.raises(mk.MechkinError, match=message) as fresh:
        mk.loads(arm(motion), "arm", {"k": str(k)})
    for _ in range(2):  # recorded by then
        errors = model.vary({"k": [2.0, k]}, ["A.theta"]).errors
        assert list(errors) == [1]
        assert str(errors[1]) == str(fresh.value)
    with pytest.raises(mk.MechkinError, match=message):
        model.with_parameters({"k": k}).analyze(["A.theta"])


SEQUENCE = TIMED.replace(
    "LAW",
    "sequence, from: 0, segments: [{law: constant-rate, for: 0.5, to: 0.5 rad}, "
    "{law: constant-rate, for: 0.5, to: k * 0.5 rad}]",
)


@pytest.mark.parametrize(
    ("motion", "silent", "says"),
    [
        (SWEPT.replace("to: 90, step: 30", "to: 40, step: k * 5 deg"), 2.0, 0.0),
        (SWEPT.replace("rate: 1 rad/s", "rate: 1 rad/s / k"), 2.0, 0.0),
        # a rate that jumps is warned of
        (SEQUENCE, 2.0, 3.0),
    ],
)
def test_a_motion_that_says_something_is_not_taken_by_itself(
    motion: str, silent: float, says: float
) -> None:
    base = base_of(mk.loads(arm(motion), "arm").design)
    built = base.design.built
    found = motion_as_built(built, built.problem, base.given({"k": silent}))
    assert found is not None
    assert found.rows == built.problem.motion.rows
    assert motion_as_built(built, built.problem, base.given({"k": says})) is None


def test_a_variant_warns_as_its_fresh_file() -> None:
    text = arm(SEQUENCE)
    model = mk.loads(text, "arm")
    for k in (2.0, 3.0, 2.0):
        own = model.with_parameters({"k": k}).analyze(["A.theta"], tables=[]).diagnostics
        fresh = mk.loads(text, "arm", {"k": str(k)}).analyze(["A.theta"], tables=[]).diagnostics
        assert list(map(str, own)) == list(map(str, fresh))
        assert [d.code for d in own] == ["rate-jump"] * (k == 3.0)
