"""Friction where the efforts act at actuators: against dense free-body equations at 40 digits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from friction.rubbed import with_friction
from friction.slider_crank import TEXT
from oracle import document, mp, read, solve, to_text
from oracle.friction import NoFixedPoint, rub, rubbings, without_friction
from properties.cases import case
from properties.test_actuators import chosen

import mechkin_cli as mk
from mechkin_cli.verdict import Status

JOINTS = ("A", "B", "C", "D")
WORDS = ("force", "moment", "friction_force", "friction_moment", "normal_load", "friction_power")
ROUNDING = 2.0**-52


def with_actuators(text: str, *names: str) -> str:
    return f"{text}\nactuators: [{', '.join(names)}]\n"


@cache
def pushed() -> mk.Analysis:
    """Prescribed at the crank, driven at the piston."""
    names = [f"{joint}.{word}" for joint in JOINTS for word in WORDS]
    more = ["D.effort", "B.theta", "D.s", "row.power_error"]
    return mk.loads(with_actuators(TEXT, "D.s")).analyze([*names, *more], tables=[])


@pytest.mark.parametrize("row", [0, 4, 9, 13, 18])
def test_a_slider_crank_driven_by_its_piston(row):
    mechanism = read(without_friction(TEXT))
    guess = {"B.theta": pushed()["B.theta"][row] * float(mp.pi / 180), "D.s": pushed()["D.s"][row]}
    solution = solve(mechanism, mechanism.row(row), guess)
    found = rub(mechanism, solution, rubbings(TEXT), ["D.s"])
    pairs = [(pushed()["D.effort"][row], found.reactions.effort["D.s"], 1.0)]
    by_word = (found.reactions.force, found.reactions.moment, found.force, found.moment)
    for word, values in zip(WORDS, (*by_word, found.normal, found.power), strict=True):
        unit = {"moment": 40.0, "friction_moment": 40.0, "friction_power": 1000.0}.get(word, 1.0)
        pairs += [(pushed()[f"{j}.{word}"][row], values[j], unit) for j in JOINTS]
    largest = max(float(mp.norm(force)) for force in found.reactions.force.values())
    for value, wanted, unit in pairs:
        expected = np.ravel(np.array(wanted, dtype=object)).astype(float)
        assert np.abs(np.ravel(value) - expected).max() <= 4e-14 * unit * largest
    at_crank = rub(mechanism, solution, rubbings(TEXT)).normal
    moved = [abs(float(at_crank[j] - found.normal[j])) / largest for j in JOINTS]
    assert max(moved) > 1e-2  # where the efforts act matters


def test_the_powers_balance():
    assert (pushed()["row.power_error"] <= 1e-14).all()


@pytest.mark.parametrize("name", ["loop 0", "loop 3", "loop 9", "structure 0", "structure 5"])
def test_random_mechanisms(name):
    its, data = case(name), with_friction(case(name).text, 7)
    actuators, _ = chosen(name)
    mechanism = read(to_text(without_friction(data)))
    columns = [f"{j}.force" for j in its.mechanism.joints] + [f"{a}.effort" for a in actuators]
    analysis = mk.loads(with_actuators(to_text(data), *actuators)).analyze(columns, tables=[])
    try:
        wanted = rub(mechanism, its.solution, rubbings(data), actuators).reactions
    except NoFixedPoint:
        assert analysis.result.status[its.row] == Status.friction_undecided
        return
    if analysis.result.status[its.row] == Status.friction_undecided:
        return
    scale = float(max(mp.norm(v) for v in wanted.force.values()))
    expected = [*wanted.force.values(), *([wanted.effort[a]] for a in actuators)]
    for column, value in zip(columns, expected, strict=True):
        error = np.ravel(analysis[column][its.row]) - np.array(value, dtype=object).astype(float)
        assert np.abs(error).max() <= 500 * ROUNDING * its.condition * scale, column


def test_actuators_at_the_inputs_change_nothing():
    names = [f"{joint}.{word}" for joint in JOINTS for word in WORDS] + ["A.effort"]
    found, plain = (
        mk.loads(text).analyze(names, tables=[]) for text in (with_actuators(TEXT, "A.theta"), TEXT)
    )
    for name in names:
        assert np.abs(found[name] - plain[name]).max() <= 1e-13 * np.abs(plain[name]).max(), name


def test_no_coefficient_gives_the_bytes_without_friction():
    data = document(with_actuators(TEXT, "D.s"))
    for load in data["loads"]:
        if load["type"] == "friction":
            load["coefficient"] = "0"
    smooth = [load for load in data["loads"] if load["type"] != "friction"]
    model, without = mk.loads(to_text(data)), mk.loads(to_text(data | {"loads": smooth}))
    names = sorted(without.quantities)
    found, expected = (m.analyze(names, tables=[]) for m in (model, without))
    for name in names:
        assert found[name].tobytes() == expected[name].tobytes(), name
    assert found.diagnostics == expected.diagnostics


def test_more_actuators_share_with_least_squares():
    """Of all efforts in balance with these friction forces, by the set's null space."""
    names = ["A.effort", "D.effort", "A.theta_dot", "D.s_dot"]
    analysis = mk.loads(with_actuators(TEXT, "A.theta", "D.s")).analyze(names, tables=[])
    assert [d.code for d in analysis.diagnostics] == ["shared-effort"]
    # J^T t = Q leaves t along (size D.s_dot, -A.theta_dot) open, moments in parts of the size
    size = np.hypot(180.0, 40.0 * np.sin(np.pi / 18))
    across = (
        analysis["D.s_dot"] / size * analysis["A.effort"] / size
        - analysis["A.theta_dot"] * analysis["D.effort"]
    )
    assert np.abs(across).max() <= 1e-12 * np.abs(analysis["A.theta_dot"] * 1e3).max()


def test_a_singular_set_is_no_matter_of_friction():
    """At its dead centres a piston turns no crank."""
    text = TEXT.replace("from: 10, to: 370, step: 15", "from: -30, to: 30, step: 15")
    analysis = mk.loads(with_actuators(text, "D.s")).analyze(["D.effort", "A.force"], tables=[])
    assert [d.code for d in analysis.diagnostics if d.severity != "note"] == ["singular-actuators"]
    assert np.isnan(analysis["D.effort"]).tolist() == [False, False, True, False, False]
    assert analysis.result.status[2] == Status.ok
