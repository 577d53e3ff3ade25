"""True errors of analyses: what does not change them, and what is said where there are none."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.tape.double_double import exactly

RUBBING = """
format: 1
units: {length: mm, force: N}
links: {crank: {mass: 1, center_of_mass: [10, 0, 0], inertia: {xx: 10, yy: 10, zz: 20}}}
joints: {A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 30, rate: 3 rad/s}}}
loads:
  - {type: gravity, g: standard}
  - {type: friction, joint: A, coefficient: 0.1, radius: 8 mm}
tables:
  - {name: one, columns: [A.theta, A.effort, row.power_error, crank.omega.z]}
"""

ROCKER = """
format: 1
units: {length: UNIT, angle: deg}
links: {crank: {}, rod: {}, rocker: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0 mm, 0 mm, 0 mm], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [20.3 mm, 0 mm, 0 mm], axis: [0, 0, 1]}
  C: {type: R, links: [rod, rocker], point: [60.1 mm, 50.7 mm, 0 mm], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [70 mm, 0 mm, 0 mm], axis: [0, 0, 1]}
points: {tip: {link: rod, at: [40 mm, 60 mm, 0 mm]}}
motion: {inputs: {D.theta: VALUES}}
tables:
  - {name: one, columns: [D.theta, A.theta, {label: x, value: tip.position.x}]}
"""


def rocker(values: str, unit: str = "mm", **options: int) -> mk.Analysis:
    return mk.loads(ROCKER.replace("VALUES", values).replace("UNIT", unit)).analyze(**options)


def true(r: mk.Analysis, label: str) -> np.ndarray:
    """True values in the file's units, as cells less their signed errors would be."""
    quantity = r.errors.repeated.quantity(label)
    return exactly(quantity.value)


def test_rcsr():
    errors = mk.load(RCSR).analyze(errors=True).errors
    assert errors.digits is not None
    assert errors.digits >= 13
    assert (errors["theta1"] == 0.0).all()
    # a unit in the last place of 152 degrees is 2.8e-14; over a thousand rows of this sweep the
    # largest error is 1.8e-13 and their root mean square 4.6e-14, however rows are guessed
    off = errors["table_03", "theta4"]
    assert off.max() < 2e-13
    assert np.sqrt(np.mean(off * off)) < 6e-14
    assert errors["O4.theta"].tolist() == errors["table_03", "theta4"].tolist()
    assert errors["norm(O3.force)"].max() < 1e-11


def test_rows_do_not_depend_on_each_other():
    alone = true(rocker("{at: 10}"), "A.theta")
    for values in ("{values: [0, 10, 20]}", "{values: [20, 10, 0]}", "{values: [5, 10]}"):
        beside = true(rocker(values), "A.theta")[1]
        assert abs((beside - alone[0]).high) < 1e-30


@pytest.mark.parametrize("options", [{"lanes": 2}, {"threads": 2}, {"lanes": 2, "threads": 1}])
def test_lanes_and_threads_change_nothing(options):
    rows = "{from: 0, to: 25, step: 0.5}"
    for one, other in zip(
        rocker(rows).errors.columns, rocker(rows, **options).errors.columns, strict=True
    ):
        assert np.array_equal(one.error, other.error, equal_nan=True)


def test_other_units_change_nothing():
    rows = "{from: 0, to: 25, step: 5}"
    one, other = (true(rocker(rows, unit), "A.theta") for unit in ("mm", "in"))
    assert np.abs((one - other).high).max() < 1e-30


def test_rows_without_a_position_have_no_errors():
    r = rocker("{from: 0, to: 60, step: 5}")
    there = r.result.solved
    assert not there.all()
    assert np.isnan(r.errors["x"][~there]).all()
    assert np.isfinite(r.errors["x"][there]).all()
    assert sum(column.lost for column in r.errors.columns) == 0


def test_friction_of_a_sweep_is_repeated():
    """The bearing carries m r omega^2 = 0.09 N: the effort is 0.1 (8 mm) of that."""
    r = mk.loads(RUBBING).analyze()
    assert r.errors.why == {"one.row.power_error": "a verdict"}
    assert r.errors["crank.omega.z"].max() == 0.0
    assert 0.0 < r.errors["A.effort"].max() < 1e-16
    for cell in true(r, "A.effort"):
        assert abs(Fraction(cell.high) + Fraction(cell.low) - Fraction("7.2e-5")) < Fraction(
            "1e-33"
        )


def test_responses_with_friction_are_not_repeated_and_say_what_rubs():
    text = RUBBING.replace(
        "motion: {inputs: {A.theta: {from: 0, to: 90, step: 30, rate: 3 rad/s}}}", ""
    )
    text = text[: text.index("tables:")]
    motion = "start: {A.theta: 0}, efforts: {A.theta: 9}, time: {from: 0, to: 1, step: 0.5}"
    text += f"responses: {{r: {{{motion}}}}}"
    why = mk.loads(text).respond("r").errors.why["r.A.theta"]
    assert why == "friction of A: when what rubs sticks and slips is found in doubles"


def test_a_varied_model_is_repeated_with_its_own_numbers():
    """A length of 0.48 in, which is no double in metres, against the file that says so."""
    m = mk.load(RCSR)
    varied = m.with_parameters({"P1": "0.48 in"}).analyze().errors
    written = mk.loads(RCSR.read_text(encoding="utf-8").replace("P1: 0.5 in", "P1: 0.48 in"))
    for one, other in zip(varied.columns, written.analyze().errors.columns, strict=True):
        if one.table == "table_03":
            assert one.digits[one.digits >= 0].min() >= 13
            assert np.nanmax(np.abs(one.error - other.error)) <= 1e-13 * one.largest


def test_inertia_of_no_real_body_is_repeated():
    text = RUBBING.replace("{xx: 10, yy: 10, zz: 20}", "{xx: 10.1, yy: 10, zz: 90}")
    text = text.replace("  - {type: friction, joint: A, coefficient: 0.1, radius: 8 mm}\n", "")
    errors = mk.loads(text).analyze().errors
    assert errors.digits is not None
    assert errors.digits >= 15


def test_dense_systems_are_not_repeated_and_say_so():
    found = mk.load(FILE_OF["rchch"]).analyze().errors
    assert found.why["table_32.all columns"] == "a dense system"


def test_words_have_no_error():
    with pytest.raises(mk.UsageError, match=r"row\.status is words"):
        rocker("{at: 10}").errors["row.status"]


POLES = """format: 1
name: poles
units: {length: mm, angle: deg}
parameters: {half: 180 deg, nothing: sin(180 deg), none: 1/sin(half)}
links: {crank: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
points: {P: {link: crank, at: [2, 0, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 180, step: 90}}}
"""


@pytest.mark.parametrize(
    "text",
    ["1/sin(180 deg)", "none", "P.position.x/nothing", "tan(90 deg)*2", "1/cos(half/2)",
     "P.position.x/(sin(half)^2)"],
)  # fmt: skip
def test_what_divides_by_zero_has_no_error(text):
    """Doubles have a number there, as sin(180 deg) is 1e-16; the text has none."""
    r = mk.loads(POLES).analyze(["P.position"])
    assert np.isfinite(r[text]).any()
    assert np.isnan(np.atleast_1d(r.errors[text])[np.isfinite(r[text])][[0, -1]]).all()


def test_what_only_comes_near_zero_has_one():
    r = mk.loads(POLES).analyze(["P.position"])
    assert r.errors["1/sin(179.999999 deg)"].max() < 1e-7 * r["1/sin(179.999999 deg)"].max()


@pytest.mark.parametrize(
    "name", ["J3.quaternion", "screws", "advantages", "coefficients", "transmission"]
)
def test_derived_quantities_are_repeated(name):
    words = {
        "J3.quaternion": "O3.q1",
        "screws": "coupler.screw_pitch",
        "advantages": "O4.theta.mechanical_advantage",
        "coefficients": "O1.effort.per_acceleration",
        "transmission": "O4.theta.transmission_angle",
    }
    r = mk.load(RCSR).analyze([], tables=[])
    error, value = r.errors[words[name]], r[words[name]]
    assert np.nanmax(error) < 1e-12 * np.nanmax(np.abs(value))
    assert np.nanmax(error) > 0.0


def test_time_is_what_the_text_says() -> None:
    model = mk.loads(
        "format: 1\nlinks: {one: {}}\n"
        "joints: {A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}}\n"
        "motion:\n  time: {from: 0, to: 1, step: 0.1}\n"
        "  inputs: {A.theta: {law: constant-rate, at: 0, rate: 1 rad/s}}\n"
    )
    found = model.analyze(errors=True)
    for name in ("time", "time*time"):
        times = np.asarray(found[name], dtype=float)
        power = name.count("time")
        exact = [Fraction(x) - Fraction(k, 10) ** power for k, x in enumerate(times)]
        assert np.abs(found.errors[name]) == pytest.approx(
            [abs(float(e)) for e in exact], abs=1e-30
        )
