"""A replay gives what building the file anew gives, bit for bit, or says that it does not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from variants.recordings import (
    WITH_PARAMETERS,
    built_anew,
    everything,
    near,
    parameters_of,
    tape_of,
)

from mechkin_cli.building.builder import Built, build
from mechkin_cli.building.recording import record
from mechkin_cli.building.source import open_text
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.structure.graph import SolverGraph
from mechkin_cli.tape.recorder import Recorder, Traced, TraceLost, register
from mechkin_cli.tape.tape import Verdict, compiled, replay

COUNT = 25


@pytest.mark.parametrize("stem", WITH_PARAMETERS)
def test_replay_is_a_fresh_build(stem: str) -> None:
    base, tape, native = tape_of(stem)
    values = near(base, COUNT, seed=len(stem))
    outputs, verdicts = replay(native, values)
    assert verdicts[0] == Verdict.SAME
    for k in range(COUNT):
        named = dict(zip(tape.inputs, values[:, k], strict=True))
        if verdicts[k] == Verdict.OTHER_WAY:
            continue
        fresh = built_anew(base, named)
        assert isinstance(fresh.graph, SolverGraph)
        expected = np.array(everything(fresh.problem, fresh.graph))
        assert outputs[k].tobytes() == expected.tobytes()
        warned = fresh.problem.diagnostics != base.problem.diagnostics
        assert verdicts[k] == Verdict.OTHER_ADVICE or not warned


@pytest.mark.parametrize("stem", WITH_PARAMETERS)
def test_most_variants_are_replayed(stem: str) -> None:
    """A guard that fails for no reason would cost a fresh build each time."""
    base, _, native = tape_of(stem)
    _, verdicts = replay(native, near(base, 400, seed=2))
    assert np.count_nonzero(verdicts == Verdict.OTHER_WAY) <= 0.02 * verdicts.size


def test_the_structure_of_the_plan_is_the_same() -> None:
    base, tape, _ = tape_of("rcsr")
    named = dict(zip(tape.inputs, near(base, 2, seed=9)[:, 1], strict=True))
    fresh = built_anew(base, named)
    records = [
        plan_records(Layout(built.problem.mechanism, built.graph)) for built in (base, fresh)
    ]
    assert [call for call, _ in records[0]] == [call for call, _ in records[1]]
    assert flatten(records[0]) != flatten(records[1])


def test_the_length_unit_follows_the_size() -> None:
    """Dimensions three times as large: another power of two, found on the tape."""
    base, tape, native = tape_of("rcsr")
    lengths = [name for name in tape.inputs if not name.startswith("alpha")]
    values = parameters_of(base)
    tripled = values | {name: 3.0 * values[name] for name in lengths}
    outputs, verdicts = replay(native, np.array(list(tripled.values()))[:, None])
    fresh = built_anew(base, tripled)
    assert isinstance(fresh.graph, SolverGraph)
    assert verdicts[0] == Verdict.SAME
    expected = np.array(everything(fresh.problem, fresh.graph))
    assert outputs[0].tobytes() == expected.tobytes()


def replayed(text: str, name: str, value: float) -> tuple[int, Built | None]:
    """The verdict of a replay with another value, and the fresh build (None where it fails)."""
    base = build(*open_text(text, "text"))
    recorder, _ = record(base, [name])
    tape = recorder.tape([0])
    _, verdicts = replay(compiled(tape), np.array([[value]]))
    try:
        return int(verdicts[0]), built_anew(base, {name: value})
    except InvalidFile:
        return int(verdicts[0]), None


CRANK = """
format: 1
units: {{length: m, angle: rad}}
parameters: {{p: {value}}}
links: {{crank: {{mass: {mass}, center_of_mass: [0, 0, 0]}}}}
joints:
  A: {{type: {type}, links: [ground, crank], point: [0, 0, 0], axis: [0, {axis}, 1]{more}}}
motion: {{inputs: {{A.theta: {{{motion}}}}}}}
"""


def crank(**fields: str) -> str:
    given = {"value": "1", "mass": "1", "type": "R", "axis": "0", "motion": "at: 1", "more": ""}
    return CRANK.format(**(given | fields))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        (crank(mass="p * 1 kg"), -1.0),
        (crank(mass="1 kg/p"), 0.0),
        (crank(mass="sqrt(p) * 1 kg"), -1.0),
        (crank(mass="exp(p) * 1 kg"), 800.0),
        (crank(mass="(log(p)+1) * 1 kg"), 0.0),
        (crank(mass="p*1e50*1e40 * 1 kg"), 1e30),
        (crank(type="H", more=", lead: p * 1 m"), 0.0),
        (crank(more=", zero: {ground: [1, 0, 0], crank: [2 - p, 0, p - 1]}"), 2.0),
    ],
)
def test_what_is_refused_is_no_replay(text: str, value: float) -> None:
    """The ordinary path refuses it, so the guards must send it there."""
    verdict, fresh = replayed(text, "p", value)
    assert fresh is None
    assert verdict == Verdict.OTHER_WAY


def test_a_dropped_guard_is_noticed() -> None:
    """Without its guards the tape of a negative mass would pass for a replay."""
    base = build(*open_text(crank(mass="p * 1 kg"), "text"))
    recorder, _ = record(base, ["p"])
    tape = recorder.tape([0])
    none = replace(tape, guards=tape.guards[:0], expected=tape.expected[:0], advice=tape.advice[:0])
    for each, verdict in ((tape, Verdict.OTHER_WAY), (none, Verdict.SAME)):
        assert replay(compiled(each), np.array([[-1.0]]))[1].tolist() == [verdict]


@pytest.mark.parametrize(
    ("fields", "values"),
    [
        ({"motion": "from: 0, to: p * 1 rad, step: 0.1"}, [1.0, 1.04, 1.0999]),
        ({"motion": "from: p * 1 rad, to: 2, count: 3"}, [1.0, -0.3, 3.0]),
        ({"motion": "from: 0, to: -1, step: p * 0.25 rad"}, [1.0, 0.999, 0.8001]),
    ],
)
def test_rows_that_depend_on_a_parameter(fields: dict[str, str], values: list[float]) -> None:
    """They go by decimals, which no operation has: inputs of the tape, computed before it runs."""
    base = build(*open_text(crank(**fields), "text"))
    recorder, problem = record(base, ["p"])
    (given,) = recorder.given_rows
    tape = compiled(recorder.tape(register(recorder, x) for x in problem.motion.inputs[0].written))
    for value in values:
        rows = given.compute(*(_replayed_number(recorder, n, value) for n in given.numbers))
        outputs, verdicts = replay(tape, np.array([[value], *rows[:, None]]))
        fresh = built_anew(base, {"p": value}).problem.motion.inputs[0].written
        assert verdicts[0] == Verdict.SAME
        assert outputs[0].tobytes() == fresh.tobytes()


def _replayed_number(recorder: Recorder, number: float, value: float) -> float:
    if not isinstance(number, Traced):
        return number
    tape = compiled(recorder.tape([number.register], guarded=False))
    inputs = [value, *recorder.values_given[1:]]
    return float(replay(tape, np.array(inputs)[:, None])[0][0, 0])


def test_moments_that_depend_on_a_parameter_are_lost() -> None:
    motion = "law: constant-rate, at: 0, rate: 1"
    timed = crank(motion=motion).replace(
        "{inputs", "{time: {from: 0, to: p * 1 s, count: 3}, inputs"
    )
    base = build(*open_text(timed, "text"))
    with pytest.raises(TraceLost):
        record(base, ["p"])
    record(base, ["p"], motion=False)
