"""Laws of loads as programs of a plan: the bits of evaluating them over rows of numbers, and the
same loads whichever way a law is written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st
from mpmath import mp, mpf

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import width
from mechkin_cli.mechanism.problem import law_value
from mechkin_cli.plan.programs import kernel_columns
from mechkin_cli.plan.records import Demand
from mechkin_cli.session.kernel_run import Ask, Batch, run as run_kernel

CRANK, ROD, OFFSET = 40.0, 130.0, 15.0
TEXT = f"""\
format: 1
units: {{length: mm, mass: kg, force: N}}
parameters: {{k: 60 N*mm, c: 0.3, h: {ROD} mm}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  A: {{type: R, links: [crank, rod], point: [{CRANK}, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [rod, slider],
      point: {{rod: ["{CRANK} mm + h", 0, 0], slider: [0, {OFFSET}, 0]}}}}
  D: {{type: P, links: [ground, slider], point: [0, {OFFSET}, 0], axis: [1, 0, 0]}}
points: {{tip: {{link: rod, at: ["{CRANK} mm + h", 7, 3]}}}}
directions: {{along: {{link: rod, vector: [1, 0, 0]}}}}
motion:
  time: {{from: 0, to: 3, step: 0.05}}
  inputs: {{O.theta: {{law: constant-rate, at: -300, rate: 5}}}}
assembly: {{near: {{D.s: {CRANK + ROD}}}}}
loads:
LOADS
"""

UNITS = {
    "O.theta": "1 rad",
    "A.theta": "1 rad",
    "O.theta_dot": "1 rad/s",
    "A.theta_dot": "1 rad/s",
    "D.s": "10 mm",
    "D.s_dot": "10 mm/s",
    "tip.position.y": "1 mm",
    "tip.velocity.x": "10 mm/s",
    "along.x": "1",
    "rod.omega.z": "1 rad/s",
    "time": "1 s",
    "c": "1",
}
LEAVES = [f"({name}/({unit}))" for name, unit in UNITS.items()] + ["0", "1", "-2.5", "1e-3", "7"]


OF_ONE = (
    "-({}); abs({}); sign({}); sqrt({}); sin(({})*1 rad); cos(({})*1 rad); tan(({})*1 rad); "
    "exp({}); log({}); (wrap(({})*1 rad)/(1 rad)); (atan({})/(1 rad)); ({})^2"
)
OF_TWO = (
    "({} + {}); ({} - {}); ({}*{}); ({}/({})); min({}, {}); max({}, {}); "
    "(atan2({}, {})/(1 rad)); pow({}, {}); dot([{}, 1, 2], [{}, 3, along.y])"
)


def branches(inner: Any) -> Any:
    one, two = (st.sampled_from(forms.split("; ")) for forms in (OF_ONE, OF_TWO))
    return st.builds(str.format, one, inner) | st.builds(str.format, two, inner, inner)


TERMS = st.recursive(st.sampled_from(LEAVES), branches, max_leaves=6)


def model_of(*loads: str) -> mk.Model:
    return mk.loads(TEXT.replace("LOADS", "\n".join(f"  - {load}" for load in loads)))


def torque(term: str, joint: str = "A") -> str:
    return f'{{type: torque, joint: {joint}, value: "1 N*mm*({term})"}}'


def batch_of(result: Any, lanes: int = 0, threads: int = 1) -> Batch:
    """The rows' loads by the kernel."""
    session, rows = result.session, result.row_states
    inputs = session.inputs
    return run_kernel(
        session.plan,
        inputs.at(rows.states, rows.turns, session.problem.motion.time.values),
        Ask(Demand.FORCES | Demand.VELOCITY, iterations=0),
        lanes=lanes,
        threads=threads,
    )


def by_rows(result: Any) -> np.ndarray:
    """The same from the laws over rows of numbers."""
    problem, rows = result.problem, result.rows
    values = {
        number: law_value(law, result.quantity, rows)
        for number, law in enumerate(problem.load_laws)
    }
    columns = kernel_columns(result.session.layout, values)
    return np.array([np.broadcast_to(column, (rows,)) for column in columns])


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(st.lists(TERMS, min_size=1, max_size=3))
def test_random_expressions_have_the_bits_of_their_evaluation(terms: list[str]) -> None:
    try:
        model = model_of(*(torque(f"0*c + {term} + 0*along.x") for term in terms))
    except mk.InvalidFile:
        return  # a constant part has no value
    result = model.analyze(["D.s"], tables=[]).result
    found, expected = batch_of(result), by_rows(result)
    assert found.loads is not None
    assert found.undefined is not None
    np.testing.assert_array_equal(found.loads, expected)
    lost = np.isnan(expected).any(axis=0)
    np.testing.assert_array_equal(found.undefined.astype(bool), lost)


EVERY_KIND = (
    torque("sin(A.theta) + O.theta/(1 rad)", "O"),
    '{type: force, joint: D, value: "-k/(7 mm)*max(c, time/(1 s))"}',
    '{type: force, link: rod, point: [1, 2, 3], force: ["1 N*along.x", 4, "-c*1 N*abs(along.y)"]}',
    '{type: force, link: rod, axes: link, point: [1, 2, 3], force: [0, "1 N*along.y", 2]}',
    '{type: torque, link: slider, torque: [3, "k*D.s_dot/(1 mm/s)", 0]}',
    '{type: torque, link: crank, axes: link, torque: [3, "k*wrap(O.theta)/(1 rad)", 0]}',
)


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("lanes", [n for n in (2, 4, 8) if n <= _kernel.widest])
def test_the_same_bytes_in_all_lanes_and_threads(lanes: int, threads: int) -> None:
    result = model_of(*EVERY_KIND).analyze(["D.s"], tables=[]).result
    found = batch_of(result, width(lanes), threads)
    assert found.loads is not None
    assert found.loads.tobytes() == by_rows(result).tobytes()


@pytest.mark.parametrize("closed_at", ["A", "B", "D"])
def test_the_same_law_wherever_the_loop_is_closed(closed_at: str) -> None:
    """The same quantities by other coordinates of the kernel, continuous over turns."""
    load = torque("sin(A.theta/3) + O.theta/(7 rad) + A.theta_dot/(9 rad/s)", "O")
    one, other = (
        model_of(load).analyze(["O.effort"], tables=[], **named)["O.effort"]
        for named in ({}, {"closed_at": [closed_at]})
    )
    assert other == pytest.approx(one, rel=1e-9, abs=1e-9)


def test_an_expression_against_forty_digits() -> None:
    result = model_of(torque("exp(-time/(2 s))*sin(3 rad/s*time) - c*time^2/(1 s)^2", "O")).analyze(
        ["O.effort"], tables=[]
    )
    with mp.workdps(40):
        times = [mpf(float(t)) for t in result["time"]]
        expected = [-(mp.exp(-t / 2) * mp.sin(3 * t) - mpf(0.3) * t**2) for t in times]
    assert result["O.effort"] == pytest.approx([float(x) for x in expected], rel=1e-14, abs=1e-13)


def test_expression_table_and_constant_give_the_same_load(tmp_path: Path) -> None:
    """A line over s, met by a table's curve; and where it is level, a number."""
    points = "".join(f"{s},{2 * s - 5}\n" for s in range(70, 190, 6))
    (tmp_path / "line.csv").write_text(f"s,F\n{points}", encoding="utf-8")
    level = "".join(f"{s},7\n" for s in range(70, 190, 6))
    (tmp_path / "level.csv").write_text(f"s,F\n{level}", encoding="utf-8")

    def effort(value: str) -> Any:
        load = f"{{type: force, joint: D, value: {value}}}"
        (tmp_path / "m.yaml").write_text(TEXT.replace("LOADS", f"  - {load}"), encoding="utf-8")
        return mk.load(tmp_path / "m.yaml").analyze(["O.effort"], tables=[])["O.effort"]

    line = effort('"2 N/mm*D.s - 5 N"')
    assert effort("{table: line.csv}") == pytest.approx(line, rel=1e-12, abs=1e-9)
    constant = effort("7")
    assert effort("{table: level.csv}").tobytes() == constant.tobytes()
    assert effort('"7 N + 0 N*along.x"').tobytes() == constant.tobytes()


def test_variants_take_laws_with_them() -> None:
    """Parameters of laws and of what they read, in one run and one at a time."""
    model = model_of(*EVERY_KIND)
    values = {"k": [30.0, 60.0, 90.0], "h": [120.0, 130.0, 141.0], "c": [0.1, 0.3, 0.7]}
    found = model.vary(values, ["O.effort", "D.moment"])
    for number in range(3):
        own = model.with_parameters({name: values[name][number] for name in values})
        alone = own.analyze(["O.effort", "D.moment"], tables=[])
        fresh = mk.loads(
            TEXT.replace("LOADS", "\n".join(f"  - {load}" for load in EVERY_KIND)),
            parameters={"k": f"{values['k'][number]} N*mm", "c": str(values["c"][number])}
            | {"h": f"{values['h'][number]} mm"},
        ).analyze(["O.effort", "D.moment"], tables=[])
        assert found["O.effort"][number].tobytes() == alone["O.effort"].tobytes()
        assert alone["O.effort"] == pytest.approx(fresh["O.effort"], rel=1e-9, abs=1e-9)
        assert alone["D.moment"] == pytest.approx(fresh["D.moment"], rel=1e-9, abs=1e-6)


def test_a_single_position_has_the_loads_of_its_row() -> None:
    """`solve` evaluates laws, too, as far as they read no time."""
    swept = TEXT.replace(
        "{law: constant-rate, at: -300, rate: 5}", "{from: -300, to: 500, step: 50}"
    )
    swept = swept.replace("  time: {from: 0, to: 3, step: 0.05}\n", "")
    law = torque("sin(A.theta/3) + max(O.theta/(7 rad), along.x)", "O")
    model = mk.loads(swept.replace("LOADS", f"  - {law}"))
    rows = model.analyze(["O.effort"], tables=[])["O.effort"]
    for row in (0, 3, 16):
        found = model.solve({"O.theta": -300.0 + 50.0 * row}, ["O.effort"])
        assert found["O.effort"] == pytest.approx(rows[row], rel=1e-12, abs=1e-12)
    with pytest.raises(mk.UsageError, match="varies with time"):
        model_of(torque("time/(1 s)")).solve({"O.theta": 1.0}, ["O.effort"])


def test_kinks_are_where_a_law_chooses() -> None:
    """Magnitudes, larger and smaller of two and wraps are told; smooth laws have none."""
    from mechkin_cli.plan.programs import load_program
    from mechkin_cli.tape.tape import Operation

    def kinks(term: str) -> list[str]:
        layout = model_of(torque(term)).session.layout
        (program,) = load_program(layout)
        return [Operation(program.operations[k]).name for k in program.kinks]

    assert kinks("sin(A.theta)*exp(time/(1 s))") == []
    assert kinks("abs(along.x)") == ["MAGNITUDE"]
    assert kinks("sign(along.x)") == ["SIGN"]
    assert kinks("max(along.x, 0, min(along.y, along.x))") == ["SMALLER", "LARGER", "LARGER"]
    assert kinks("wrap(A.theta)/(1 rad)") == ["WHOLE"]
