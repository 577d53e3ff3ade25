"""What responses ask for, in SI: read off the built problem, before anything moves."""

import math
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism.model import JointLoad, Varying
from mechkin_cli.mechanism.problem import response_problem
from mechkin_cli.mechanism.response import (
    CrossingEnd,
    DeadCentreEnd,
    ResponseProblem,
    StartValue,
    TurnsEnd,
)
from mechkin_cli.tape.tape import evaluate

LINKS = """\
format: 1
units: {length: mm, force: N, time: s}
parameters: {k: 2 N/mm, swing: 20 deg}
links:
  upper: {mass: 1, center_of_mass: [0, -100, 0]}
  lower: {mass: 2, center_of_mass: [0, -300, 0]}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: C, links: [upper, lower], point: [0, -200, 0], axis: [0, 0, 1]}
points: {tip: {link: lower, at: [0, -400, 0]}}
"""
START = "start: {A.theta: 20, B.theta: 0, B.s: 0}"
TIME = "time: {from: 0, to: 1, step: 0.25}"
SWEEP = "motion: {inputs: {A.theta: {from: 0, to: 9, step: 3}, B.theta: {at: 0}, B.s: {at: 0}}}\n"


def model(keys: str, more: str = "") -> mk.Model:
    """Two links hung from ground, with the response `go` of some keys."""
    return mk.loads(f"{LINKS}{more}responses:\n  go: {{{keys}}}\n", "go.yaml")


def response(keys: str, more: str = "") -> ResponseProblem:
    return model(keys, more).response("go")


def refusals(text: str) -> list[str]:
    def read() -> None:
        loaded = mk.loads(text, "go.yaml")
        for run in loaded.runs:
            loaded.session_of(run)

    with pytest.raises(mk.InvalidFile) as caught:
        read()
    return [str(found) for found in caught.value.diagnostics if found.severity != "note"]


def test_start_in_si_with_rates_that_are_zero_where_left_out() -> None:
    found = response(f"start: {{A.theta: swing, B.theta: -1 rad, B.s: 3, B.s_dot: 4 mm/s}}, {TIME}")
    assert found.start == (
        StartValue("A", "theta", pytest.approx(math.radians(20.0)), 0.0),
        StartValue("B", "theta", -1.0, 0.0),
        StartValue("B", "s", pytest.approx(3e-3), pytest.approx(4e-3)),
    )
    assert found.independent == [("A", "theta"), ("B", "theta"), ("B", "s")]


def test_a_rate_of_another_coordinate_stands_for_one_of_its_own() -> None:
    four_bar = """\
format: 1
links: {crank: {mass: 1, center_of_mass: [0, 0, 0]}, coupler: {}, rocker: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [crank, coupler], point: [0, 1, 0]}
  B: {type: U, links: [coupler, rocker], point: [3, 2, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}
  C: {type: R, links: [ground, rocker], point: [3, 0, 0], axis: [0, 0, 1]}
responses: {go: {start: {O.theta: 20, C.theta_dot: 1 rad/s}, time: {from: 0, to: 1, step: 0.1}}}
"""
    found = mk.loads(four_bar).response("go")
    assert [(one.name, one.rate) for one in found.start] == [("O.theta", None), ("C.theta", 1.0)]
    assert found.independent == [("O", "theta")]


def test_efforts_are_loads_of_their_run_alone_and_the_last_of_them() -> None:
    loads = (
        "loads: [{type: torque, joint: A, value: 3 N*m}, {type: force, joint: B, value: -k*B.s}]\n"
    )
    keys = f"{START}, {TIME}, efforts: {{A.theta: 7 N*m, B.s: 2 N*cos(time*1 rad/s)}}"
    found = model(keys, SWEEP + loads)
    go, sweep = found.response("go"), found.problem
    assert sweep.mechanism.loads == (JointLoad("A", "theta", 3.0), JointLoad("B", "s", Varying(0)))
    assert go.mechanism.loads == (
        *sweep.mechanism.loads,
        JointLoad("A", "theta", 7.0),
        JointLoad("B", "s", Varying(1)),
    )
    assert [law.reads for law in go.load_laws] == [("B.s",), ("time",)]
    assert [(one.name, one.amount) for one in go.efforts] == [
        ("A.theta", 7.0),
        ("B.s", Varying(1)),
    ]


def test_loads_act_in_the_runs_that_they_name() -> None:
    loads = """\
loads:
  - {type: torque, joint: A, value: 1 N*m*sin(time*1 rad/s), runs: [go]}
  - {type: gravity, g: [0, -9810, 0], runs: [sweep]}
  - {type: force, joint: B, value: -k*B.s}
"""
    found = model(f"{START}, {TIME}", SWEEP + loads)
    go, sweep = found.response("go"), found.problem
    assert sweep.mechanism.gravity == (0.0, -9.81, 0.0)
    assert go.mechanism.gravity == (0.0, 0.0, 0.0)
    assert sweep.mechanism.loads == (JointLoad("B", "s", Varying(0)),)
    assert [law.reads for law in sweep.load_laws] == [("B.s",)]
    assert [law.reads for law in go.load_laws] == [("time",), ("B.s",)]
    assert [load.amount for load in go.mechanism.loads] == [Varying(0), Varying(1)]


def test_a_load_of_time_needs_a_run_with_time() -> None:
    loads = "loads: [{type: torque, joint: A, value: 1 N*m*sin(time*1 rad/s)}]\n"
    text = f"{LINKS}{SWEEP}{loads}responses: {{go: {{{START}, {TIME}}}}}\n"
    (refused,) = refusals(text)
    assert "go.yaml:12:51: error: time is not known: the motion has no time" in refused
    assert "or let the load act in responses alone: runs: [go]" in refused
    alone = mk.loads(text.replace(SWEEP, ""))
    assert alone.runs == ("go",)
    assert [law.reads for law in alone.response("go").load_laws] == [("time",)]


def test_a_table_runs_over_the_coordinate_or_what_it_names(tmp_path: Path) -> None:
    (tmp_path / "motor.csv").write_text("speed,torque\n-10,8\n0,5\n10,0\n")
    keys = f"{START}, {TIME}, efforts: {{A.theta: {{table: motor.csv, over: A.theta_dot}}, "
    keys += "B.s: {table: motor.csv}}"
    (tmp_path / "go.yaml").write_text(f"{LINKS}responses:\n  go: {{{keys}}}\n")
    found = mk.load(tmp_path / "go.yaml").response("go")
    assert [law.reads for law in found.load_laws] == [("A.theta_dot",), ("B.s",)]
    assert [one.amount for one in found.efforts] == [Varying(0, moving=True), Varying(1)]
    speed, force = (law.curve for law in found.load_laws)
    assert speed is not None
    assert force is not None
    # N*mm over rad/s, and N over mm
    assert speed.evaluate(np.array([-10.0, 0.0]))[0] == pytest.approx([8e-3, 5e-3])
    assert force.evaluate(np.array([-0.01, 0.01]))[0] == pytest.approx([8.0, 0.0], abs=1e-12)


def test_driven_coordinates_follow_their_laws_between_the_moments() -> None:
    drives = "{B.theta: {law: harmonic, from: 0, to: 90}, B.s: {with: 2 mm/rad*B.theta}}"
    found = response(f"start: {{A.theta: 20}}, driven: {drives}, {TIME}")
    turn, slide = found.driven
    assert turn.values == pytest.approx(
        [math.pi / 4 * (1 - math.cos(math.pi * t)) for t in found.moments.values]
    )
    assert slide.values == pytest.approx(2e-3 * turn.values)
    assert slide.accelerations == pytest.approx(2e-3 * turn.accelerations)
    assert found.course is not None
    at = evaluate(found.course.tape, [0.3, *found.course.constants[0]])[0]
    expected = math.pi / 4 * (1 - math.cos(math.pi * 0.3))
    assert at == pytest.approx([expected, 2e-3 * expected])


def test_what_stays_is_driven_at_its_place() -> None:
    found = response(f"start: {{A.theta: 20, B.theta: 0}}, driven: {{B.s: {{at: 5}}}}, {TIME}")
    (held,) = found.driven
    assert held.values.tolist() == [0.005] * 5
    assert not held.rates.any()


def test_moments_are_those_written() -> None:
    spaced = response(f"{START}, time: {{from: 0, to: 0.3, step: 0.1}}").moments
    assert spaced.written.tolist() == [0.0, 0.1, 0.2, 0.3]
    listed = response(f"{START}, time: {{values: [1, 1.5 s, 4]}}").moments
    assert listed.values.tolist() == listed.written.tolist() == [1.0, 1.5, 4.0]


def test_stops() -> None:
    stops = "[{value: B.s - 2*k/k*1 mm, at: 4, direction: up}, {value: tip.velocity.x}, "
    stops += "{dead_centre: A.theta, count: 2}, {dead_centre: B.s}, {turns: B.theta, count: 3}]"
    crossing, fast, dead, slide, turns = response(f"{START}, {TIME}, stop: {stops}").stops
    assert isinstance(crossing, CrossingEnd)
    assert (crossing.at, crossing.direction) == (pytest.approx(4e-3), "up")
    assert crossing.law.reads == ("B.s",)
    assert crossing.words == "B.s - 2*k/k*1 mm = 4 mm upwards"
    assert isinstance(fast, CrossingEnd)
    assert (fast.at, fast.direction, fast.words) == (0.0, "any", "tip.velocity.x = 0 mm/s")
    assert isinstance(dead, DeadCentreEnd)
    assert (dead.joint, dead.coordinate, dead.count) == ("A", "theta", 2)
    assert dead.words == "dead centre 2 of A.theta"
    assert slide.words == "dead centre of B.s"
    assert isinstance(turns, TurnsEnd)
    assert (turns.words, turns.count) == ("3 turns of B.theta", 3)


def test_steps() -> None:
    assert response(f"{START}, {TIME}").tolerance == 1e-10
    assert response(f"{START}, {TIME}, tolerance: 1e-7").tolerance == 1e-7
    assert response(f"{START}, {TIME}, fixed_step: 2e-3").fixed_step == pytest.approx(2e-3)


def test_its_own_assembly_else_that_of_the_file() -> None:
    file = "assembly: {near: {B.theta: 30}, turns: 3}\n"
    assert response(f"{START}, {TIME}", file).assembly.near == {
        "B.theta": pytest.approx(math.pi / 6)
    }
    own = response(f"{START}, {TIME}, mode: B", file).assembly
    assert (own.near, own.mode, own.turns) == ({}, "B", 3)
    assert response(f"{START}, {TIME}, near: {{A.theta: 1 rad}}", file).assembly.near == {
        "A.theta": 1.0
    }


def test_the_first_moment_is_a_problem_of_its_own() -> None:
    drives = "driven: {B.s: {law: constant-rate, at: 2, rate: 3 mm/s}}"
    found = model(f"start: {{A.theta: 20, B.theta: 0, B.theta_dot: 2 rad/s}}, {drives}, {TIME}")
    first = response_problem(found.problem, found.response("go"))
    assert first.motion.driven == [("A", "theta"), ("B", "theta"), ("B", "s")]
    assert [item.values.tolist() for item in first.motion.inputs] == [
        [pytest.approx(math.radians(20.0))],
        [0.0],
        [pytest.approx(2e-3)],
    ]
    assert [float(item.rates[0]) for item in first.motion.inputs] == [0.0, 2.0, pytest.approx(3e-3)]
    known = first.quantities()
    assert {"time", "row.work", "row.energy_error", "row.dissipated", "B.s.effort"} <= known.keys()
    assert "A.effort" not in known


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ("{}", "names no coordinate, but 3 are free; candidates: A.theta, B.theta, B.s"),
        ("{A.theta: 1}", "names 1 coordinate, but 3 are free; candidates: B.theta, B.s"),
        ("{A.theta: 1, B.s: 1}", "names 2 coordinates, but 3 are free; candidates: B.theta"),
    ],
)
def test_a_start_of_too_few_coordinates_says_which_are_free(start: str, words: str) -> None:
    (refused,) = refusals(f"{LINKS}responses:\n  go: {{start: {start}, {TIME}}}\n")
    assert refused.startswith("go.yaml:12:15: error: the start of go ")
    assert words in refused
    assert "start as many independent coordinates as are free" in refused


def test_a_start_of_too_many_coordinates_names_one_that_follows() -> None:
    rcsr = Path("mechanisms/dissertation/rcsr.yaml").read_text()
    more = (
        "responses: {go: {start: {O1.theta: 150, O4.theta: 37}, time: {from: 0, to: 1, step: 1}}}\n"
    )
    (refused,) = refusals(rcsr + more)
    assert "names 2 coordinates, which is more than are free: O4.theta follows" in refused
    assert "remove O4.theta from start; to choose among assemblies write near:" in refused


TABLES = "tables: [{name: t, columns: [time, A.theta]}]\n"


def test_a_table_reads_the_sweep_else_the_only_response() -> None:
    assert [(t.name, t.run) for t in model(f"{START}, {TIME}", TABLES).tables] == [("t", "go")]
    swept = model(f"{START}, {TIME}", SWEEP + TABLES.replace("time, ", ""))
    assert [(t.name, t.run) for t in swept.tables] == [("t", "sweep"), ("go", "go")]


def test_a_table_of_one_of_several_responses_says_which() -> None:
    both = f"responses: {{go: {{{START}, {TIME}}}, on: {{{START}, {TIME}}}}}\n"
    (refused,) = refusals(LINKS + TABLES + both)
    assert refused.startswith("go.yaml:11:10: error: t does not say which run it reads")
    assert "add run: one of go, on" in refused


def test_a_response_without_table_has_one_of_its_name() -> None:
    (table,) = model(f"{START}, {TIME}, efforts: {{A.theta: 1}}").tables
    assert (table.name, table.run) == ("go", "go")
    assert [column.label for column in table.columns] == [
        *("time", "A.theta", "B.theta", "B.s"),
        *("A.theta_dot", "B.theta_dot", "B.s_dot", "A.effort", "row.event"),
    ]
    (refused,) = refusals(
        f"{LINKS}{SWEEP}{TABLES.replace('time, ', '').replace('name: t', 'name: go')}"
        f"responses: {{go: {{{START}, {TIME}}}}}\n"
    )
    assert "the run go has no table and writes one called go itself" in refused


def test_units_do_not_matter() -> None:
    keys = f"start: {{A.theta: 20, B.theta: 0, B.s: 3 mm}}, {TIME.replace('0.25', '0.25 s')}, "
    keys += "efforts: {A.theta: 3 N*m*sin(A.theta)}, stop: [{value: B.s, at: 4 mm}]"
    one = response(keys)
    other = mk.loads(
        f"{LINKS}responses:\n  go: {{{keys}}}\n".replace("length: mm", "length: m")
        .replace("-100, 0]", "-0.1, 0]")
        .replace("-200, 0]", "-0.2, 0]")
        .replace("-300, 0]", "-0.3, 0]")
        .replace("-400, 0]", "-0.4, 0]")
    ).response("go")
    assert one.start == other.start
    assert one.stops[0].at == other.stops[0].at  # type: ignore[union-attr]
    assert one.mechanism.loads == other.mechanism.loads


CART = """format: 1
units: {angle: rad, time: ms}
links:
  cart: {mass: 1, center_of_mass: [0, 0, 0]}
  bob: {mass: 0.7, center_of_mass: [0, -0.3, 0], inertia: {xx: 0.02, yy: 0.02, zz: 0.03}}
joints:
  D: {type: P, links: [ground, cart], point: [0, 0, 0], axis: [1, 0, 0]}
  E: {type: R, links: [cart, bob], point: [0, 0, 0], axis: [0, 0, 1]}
responses:
  run:
    start: {E.theta: 0.1}
    driven: {D.s: LAW}
    time: {from: 0, to: 1000, step: 250}
"""

JUMPS = [
    ('{with: "1 m/s*abs(time - 0.37 s)"}', "the rate of D.s jumps at 370 ms", "0.002 m/ms"),
    (
        '{law: expression, value: "max(0 m, 2 m/s*(time - 0.6 s))"}',
        "the rate of D.s jumps at 600 ms",
        "0.002 m/ms",
    ),
    (
        "{law: sequence, segments: [{for: 500, to: 1, law: constant-rate}, "
        "{for: 300, to: 2, law: cycloidal}]}",
        "the rate of D.s jumps at 500 ms",
        "-0.002 m/ms",
    ),
    ('{with: "if(time < 0.37 s, 0 m, 0.1 m)"}', "D.s jumps at 370 ms", "0.1 m"),
]


@pytest.mark.parametrize(("law", "words", "size"), JUMPS)
def test_driven_coordinates_that_jump_are_refused(law: str, words: str, size: str) -> None:
    """The bob would be struck; told 0 it would hang as before, with status ok."""
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(CART.replace("LAW", law))
    (error,) = caught.value.diagnostics
    assert error.code == "driven-jump"
    assert error.place is not None
    assert error.place.line == 12
    assert f"{words}, where forces would be infinite: {size}; join" in str(error)


SMOOTH = [
    "{law: harmonic, from: 0, to: 1, start: 300, duration: 200}",
    "{law: sequence, segments: [{for: 370, to: 1, law: harmonic}, {for: 100, to: 0, law: 3-4-5}]}",
    '{with: "1 m*abs(time - 0.37 s)*(time - 0.37 s)/(1 s^2)"}',
    "{law: constant-rate, at: 0, rate: 0.001}",
]


@pytest.mark.parametrize("law", SMOOTH)
def test_driven_coordinates_whose_acceleration_jumps_are_followed(law: str) -> None:
    model = mk.loads(CART.replace("LAW", law))
    assert set(model.respond("run")["row.status"]) == {"ok"}
