"""Loads by expression and by table on a pendulum and a slider-crank, against closed forms.

Files in mm, kg, N: a bare moment is N mm.
"""

from __future__ import annotations

from math import asin, cos, degrees, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

ARM, RATE = 300.0, 3.0
ANGLES = [-80.0, -30.0, 0.0, 20.0, 65.0]

PENDULUM = f"""\
format: 1
units: {{length: mm, mass: kg, force: N}}
parameters: {{k: 60 N*mm}}
links: {{arm: {{}}}}
joints: {{O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}}}
points: {{tip: {{link: arm, at: [{ARM}, 0, 0]}}}}
directions: {{along: {{link: arm, vector: [1, 0, 0]}}}}
motion: {{inputs: {{O.theta: {{values: {ANGLES}, rate: {RATE}}}}}}}
"""

WITHOUT_K = PENDULUM.replace("parameters: {k: 60 N*mm}\n", "")
"""For loads that do not use it."""

EXPRESSIONS = {
    '{type: torque, joint: O, value: "-0.2 N*m*s*O.theta_dot + 3 N*m*sin(O.theta)"}': lambda a: (
        200 * RATE - 3000 * sin(a)
    ),
    '{type: torque, joint: O, value: "k*O.theta/(1 rad)"}': lambda a: -60 * a,
    '{type: torque, link: arm, torque: [1, 2, "k*cos(O.theta)"]}': lambda a: -60 * cos(a),
    '{type: torque, link: arm, axes: link, torque: [1, 2, "k*arm.omega.z/(1 rad/s)"]}': lambda a: (
        -60 * RATE
    ),
    '{type: force, link: arm, point: [300, 0, 0], force: [0, "2 N/mm*tip.position.x", 5]}': (
        lambda a: -2 * (ARM * cos(a)) ** 2
    ),
    '{type: force, link: arm, point: [300, 0, 0], force: ["-0.1 N*s/mm*tip.velocity.x", 0, 0]}': (
        lambda a: 0.1 * RATE * (ARM * sin(a)) ** 2
    ),
    '{type: force, link: arm, point: [300, 0, 0], axes: link, force: [9, "4 N*along.y", 0]}': (
        lambda a: -4 * ARM * sin(a)
    ),
}


def efforts(load: str) -> list[float]:
    return list(mk.loads(f"{PENDULUM}loads: [{load}]\n").analyze()["O.effort"])


@pytest.mark.parametrize("load", EXPRESSIONS)
def test_effort_against_an_expression(load: str) -> None:
    expected = [EXPRESSIONS[load](radians(angle)) for angle in ANGLES]
    assert efforts(load) == pytest.approx(expected, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("axes", ["ground", "link"])
@pytest.mark.parametrize(
    "kind", ["point: [300, 0, 0], force: [4, 5, VALUE]", "torque: [4, VALUE, 6]"]
)
def test_a_constant_law_has_the_bits_of_a_constant(axes: str, kind: str) -> None:
    load = f"{{type: {'force' if 'force' in kind else 'torque'}, link: arm, axes: {axes}, {kind}}}"
    unit = "N" if "force" in kind else "N*mm"
    one, other = (
        mk.loads(f"{PENDULUM}loads: [{load.replace('VALUE', value)}]\n").analyze(
            ["O.effort", "O.moment"]
        )
        for value in ("7", f'"7 {unit} + 0 {unit}*cos(O.theta)"')
    )
    for name in ("O.effort", "O.force", "O.moment"):
        assert one[name].tobytes() == other[name].tobytes()


CRANK, ROD, OFFSET = 40.0, 130.0, 15.0
SLIDER_CRANK = f"""\
format: 1
units: {{length: mm, mass: kg, force: N}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  A: {{type: R, links: [crank, rod], point: [{CRANK}, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [rod, slider],
      point: {{rod: [{CRANK + ROD}, 0, 0], slider: [0, {OFFSET}, 0]}}}}
  D: {{type: P, links: [ground, slider], point: [0, {OFFSET}, 0], axis: [1, 0, 0]}}
motion: {{inputs: {{O.theta: {{from: 0, to: 720, step: 30, rate: 2}}}}}}
assembly: {{near: {{D.s: {CRANK + ROD}}}}}
loads: [LOAD]
"""


@pytest.mark.parametrize("closed_at", ["B", "D"])
def test_slider_crank_against_a_force_law(closed_at: str) -> None:
    """The gas of a cylinder: F(s) on the slider is held by the crank by -F ds/dtheta."""
    load = '{type: force, joint: D, value: "-5 N - 0.02 N/mm*D.s - 0.03 N*s/mm*D.s_dot"}'
    found = mk.loads(SLIDER_CRANK.replace("LOAD", load)).analyze(closed_at=[closed_at])
    expected = []
    for row in range(25):
        a = radians(30 * row)
        height = OFFSET - CRANK * sin(a)
        s = CRANK * cos(a) + sqrt(ROD**2 - height**2)
        slope = -CRANK * sin(a) + height * CRANK * cos(a) / sqrt(ROD**2 - height**2)
        expected.append((5 + 0.02 * s + 0.03 * slope * 2) * slope)
    assert list(found["O.effort"]) == pytest.approx(expected, rel=1e-12, abs=1e-10)
    assert found["row.power_error"].max() < 1e-13


@pytest.mark.parametrize("closed_at", ["B", "A"])
def test_a_law_of_an_angle_counts_turns(closed_at: str) -> None:
    """A closing joint's angle is continuous over two turns of the crank too."""
    load = '{type: torque, joint: A, value: "7 N*mm*A.theta/(1 rad)"}'
    found = mk.loads(SLIDER_CRANK.replace("LOAD", load)).analyze(closed_at=[closed_at])
    expected = []
    for row in range(25):
        a = radians(30 * row)
        height = OFFSET - CRANK * sin(a)
        slope = -CRANK * cos(a) / sqrt(ROD**2 - height**2) - 1
        expected.append(-7 * (asin(height / ROD) - a) * slope)
    assert list(found["O.effort"]) == pytest.approx(expected, rel=1e-11, abs=1e-10)


def from_file(folder: Path, text: str, table: str) -> mk.Model:
    (folder / "law.csv").write_text(table, encoding="utf-8")
    (folder / "m.yaml").write_text(text, encoding="utf-8")
    return mk.load(folder / "m.yaml")


def test_a_table_over_the_joints_coordinate(tmp_path: Path) -> None:
    """A parabola is met exactly between the points of a table; degrees and N mm."""
    points = range(-80, 71, 10)
    table = "theta,torque\n" + "".join(f"{x},{3 * x * x - x + 5}\n" for x in points)
    load = "{type: torque, joint: O, value: {table: law.csv}}"
    found = from_file(tmp_path, f"{WITHOUT_K}loads: [{load}]\n", table).analyze()
    assert found.diagnostics == ()
    expected = [-(3 * a * a - a + 5) for a in ANGLES]
    assert list(found["O.effort"]) == pytest.approx(expected, rel=1e-12)


TIMED = PENDULUM.replace(
    f"motion: {{inputs: {{O.theta: {{values: {ANGLES}, rate: {RATE}}}}}}}",
    """motion:
  time: {from: 0, to: 4, step: 1}
  inputs: {O.theta: {law: constant-rate, at: 10, rate: 0.1}}""",
)


def test_a_table_over_time(tmp_path: Path) -> None:
    load = (
        "{type: force, link: arm, point: [300, 0, 0], axes: link, force: [0, {table: law.csv}, 0]}"
    )
    found = from_file(tmp_path, f"{TIMED}loads: [{load}]\n", "t,F\n0,0\n2,4\n4,16\n").analyze()
    assert list(found["O.effort"]) == pytest.approx([-(t**2) * ARM for t in range(5)], abs=1e-9)


def test_an_expression_of_time() -> None:
    found = mk.loads(f"{TIMED}loads: [{{type: torque, joint: O, value: k*time/(2 s)}}]\n").analyze()
    assert list(found["O.effort"]) == pytest.approx([-30 * t for t in range(5)])


def test_rows_outside_a_table_have_no_forces(tmp_path: Path) -> None:
    load = "{type: torque, joint: O, value: {table: law.csv}}"
    text = f"{WITHOUT_K}loads: [{load}]\n"
    found = from_file(tmp_path, text, "theta,torque\n-30,1\n20,1\n").analyze(["row.power_error"])
    nothing = [True, False, False, False, True]
    assert list(np.isnan(found["O.effort"])) == nothing
    assert list(np.isnan(found["row.power_error"])) == nothing
    assert list(found["O.theta_dot"]) == pytest.approx([RATE] * 5)
    assert not found.result.complete
    (note,) = found.diagnostics
    assert (note.code, note.severity) == ("load-undefined", "error")
    assert "2 rows, first in row 1" in note.message
    assert note.measured == "O.theta = -80 deg"
    assert note.limit == "-30 deg to 20 deg"
    assert note.place is not None
    assert note.place.line == len(text.splitlines())


def test_rows_without_a_finite_value_have_no_forces() -> None:
    load = '{type: torque, joint: O, value: "k*sqrt(O.theta/(1 rad))"}'
    found = mk.loads(f"{PENDULUM}loads: [{load}]\n").analyze()
    assert list(np.isnan(found["O.effort"])) == [True, True, False, False, False]
    (note,) = found.diagnostics
    assert note.measured == "O.theta = -80 deg"
    assert "no finite value in 2 rows, first in row 1" in note.message


def test_positions_alone_evaluate_no_load() -> None:
    """What reads no force needs no load's value."""
    load = '{type: torque, joint: O, value: "k*sqrt(O.theta/(1 rad))"}'
    tables = "tables: [{name: t, columns: [O.theta]}]\n"
    found = mk.loads(f"{PENDULUM}loads: [{load}]\n{tables}").analyze()
    assert found.diagnostics == ()
    assert found.result.complete


def test_a_limit_of_a_table_is_met_within_rounding(tmp_path: Path) -> None:
    """The slider ends at its largest s, a computed number, where the table ends as well."""
    top = sqrt((CRANK + ROD) ** 2 - OFFSET**2)
    at = degrees(asin(OFFSET / (CRANK + ROD)))
    text = SLIDER_CRANK.replace("LOAD", "{type: force, joint: D, value: {table: law.csv}}")
    text = text.replace("from: 0, to: 720, step: 30, rate: 2", f"values: [0, {at!r}]")
    found = from_file(tmp_path, text, f"s,F\n100,1\n{top!r},1\n").analyze()
    assert found.result.complete
    assert found.diagnostics == ()
