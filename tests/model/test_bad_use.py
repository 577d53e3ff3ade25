"""Bad use of the Python interface: whatever is given, a documented error that says what to do."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from typing import Any

import pytest
from model.bad_values import SINGLE, bad_value, shown
from references import RCSR

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

CALLS_PER_ARGUMENT = 80 * TIMES
DOCUMENTED = (mk.UsageError, mk.InvalidFile, mk.ExpressionError)
CURES = (
    "expected",
    "are ",
    "such as",
    ";",
    "write",
    "give",
    "expects",
    "takes",
    "needs",
    ": modes A",
)
LONGEST_MESSAGE = 1500


@pytest.fixture(scope="module")
def model():
    return mk.load(RCSR)


@pytest.fixture(scope="module")
def analysis(model):
    return model.analyze(tables=[])


def calls(model, analysis) -> dict[str, Callable[[Any], object]]:
    """Every argument of every public call; the others are as they should be."""
    text = RCSR.read_text(encoding="utf-8")
    return {
        "load path": lambda x: mk.load(x),
        "load parameters": lambda x: mk.load(RCSR, x),
        "load P1": lambda x: mk.load(RCSR, {"P1": x}),
        "loads text": lambda x: mk.loads(x),
        "loads name": lambda x: mk.loads(text, x),
        "loads parameters": lambda x: mk.loads(text, "rcsr.yaml", x),
        "analyze quantities": lambda x: model.analyze(x, tables=[]),
        "analyze one quantity": lambda x: model.analyze([x], tables=[]),
        "analyze tables": lambda x: model.analyze(tables=x),
        "analyze one table": lambda x: model.analyze(tables=[x]),
        "analyze mode": lambda x: model.analyze(tables=[], mode=x),
        "analyze closed_at": lambda x: model.analyze(tables=[], closed_at=x),
        "analyze one closing": lambda x: model.analyze(tables=[], closed_at=[x]),
        "analyze lanes": lambda x: model.analyze(tables=[], lanes=x),
        "modes at": lambda x: model.modes(x),
        "modes one input": lambda x: model.modes({"O1.theta": x}),
        "modes other input": lambda x: model.modes({x: 160.0} if hashable(x) else x),
        "ranges input": lambda x: model.ranges(x, ["O4.theta"]),
        "ranges outputs": lambda x: model.ranges(outputs=x),
        "ranges one output": lambda x: model.ranges(outputs=[x]),
        "read": lambda x: analysis[x],
        "unit": lambda x: analysis.unit(x),
        "peak": lambda x: analysis.peak(x),
        "to_pandas": lambda x: analysis.to_pandas([x]),
        "plot y": lambda x: analysis.plot(x),
        "plot x": lambda x: analysis.plot("O4.theta", x=[x]),
        "plot table": lambda x: analysis.plot(table=[x]),
        "plot to": lambda x: analysis.plot("O4.theta", to=[x]),
        "view path": lambda x: analysis.view([x]),
        "view run": lambda x: model.view("page.html", run=[x]),
        "one error": lambda x: analysis.errors[x],
        "error of a column": lambda x: analysis.errors["table_03", x],
        "error of a pair": lambda x: analysis.errors[x, "theta4"],
        "varied": lambda x: model.vary({"P1": 0.5}, ["O4.theta"])[x],
        "vary run": lambda x: model.vary({"P1": 0.5}, ["O4.theta"], run=x),
        "study": lambda x: model.study(x),
        "with_parameters": lambda x: model.with_parameters(x),
        "with_parameters P1": lambda x: model.with_parameters({"P1": x}),
        "vary parameters": lambda x: model.vary(x, ["O4.theta"]),
        "vary P1": lambda x: model.vary({"P1": x}, ["O4.theta"]),
        "vary one P1": lambda x: model.vary({"P1": [0.5, x]}, ["O4.theta"]),
        "vary quantities": lambda x: model.vary({"P1": 0.5}, x),
        "vary one quantity": lambda x: model.vary({"P1": 0.5}, [x]),
        "vary reduce": lambda x: model.vary({"P1": 0.5}, ["O4.theta"], x),
        "vary lanes": lambda x: model.vary({"P1": 0.5}, ["O4.theta"], lanes=x),
        "vary threads": lambda x: model.vary({"P1": 0.5}, ["O4.theta"], threads=x),
        "solve inputs": lambda x: model.solve(x),
        "solve one input": lambda x: model.solve({"O1.theta": x}),
        "solve quantities": lambda x: model.solve(160.0, x),
        "solve one quantity": lambda x: model.solve(160.0, [x]),
    }


def hashable(x: Any) -> bool:
    try:
        hash(x)
    except TypeError:
        return False
    return True


NAMES = list(calls(None, None))


def check(call: Callable[[Any], object], value: Any) -> bool:
    """Whether a value was refused: by a documented error that says what to do."""
    try:
        call(value)
    except DOCUMENTED as error:
        text = str(error)
        assert any(word in text for word in CURES), f"{shown(value)}: no cure in {text!r}"
        assert len(text) < LONGEST_MESSAGE
        return True
    except Exception as error:
        pytest.fail(f"{shown(value)}: {type(error).__name__}: {str(error)[:300]}")
    return False


@pytest.mark.parametrize("name", NAMES)
def test_every_single_value(name, model, analysis):
    call = calls(model, analysis)[name]
    refused = sum(check(call, value) for value in SINGLE)
    assert refused > len(SINGLE) // 2


@pytest.mark.parametrize("name", NAMES)
def test_random_values(name, model, analysis):
    chance = random.Random(name)
    call = calls(model, analysis)[name]
    refused = sum(check(call, bad_value(chance)) for _ in range(CALLS_PER_ARGUMENT))
    assert refused > CALLS_PER_ARGUMENT // 3


def test_tables_take_numbers_slices_and_names(model):
    for value in SINGLE:
        try:
            model.tables[value]
        except (mk.UsageError, IndexError):
            continue
        except Exception as error:
            pytest.fail(f"{shown(value)}: {type(error).__name__}")


def test_columns_of_studies_take_texts(model):
    found = model.study({"vary": {"P1": [0.5]}, "keep": [{"of": "O1.effort", "as": "peak"}]})
    for value in SINGLE:
        check(found.__getitem__, value)
        check(found.unit, value)
        check(found.to_pandas, value)


def test_what_has_no_default_is_asked_for(analysis):
    for call in (analysis.peak, analysis.unit):
        with pytest.raises(mk.UsageError, match="expected a text such as"):
            call(None)


def test_solve_leaves_no_input_behind_that_follows_another() -> None:
    """Its law is not evaluated, and its value of the first row would be wrong elsewhere."""
    text = (
        "format: 1\nlinks: {arm: {}, dial: {}}\njoints:\n"
        "  A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}\n"
        "  E: {type: R, links: [ground, dial], point: [1, 0, 0], axis: [0, 0, 1]}\n"
        "motion: {inputs: {A.theta: {from: 0, to: 40, step: 10}, E.theta: {with: 0.5*A.theta}}}\n"
    )
    model = mk.loads(text, "arm.yaml")
    with pytest.raises(mk.UsageError, match=r"E\.theta follows other inputs by its law"):
        model.solve({"A.theta": 30.0}, ["E.theta"])
    for row in range(5):
        values = {name: float(model.analyze()[name][row]) for name in ("A.theta", "E.theta")}
        assert values["E.theta"] == pytest.approx(5.0 * row, abs=1e-12)
        assert dict(model.solve(values, ["A.theta", "E.theta"])) == pytest.approx(values, abs=1e-12)


LED = """\
format: 1
plane: xy
parameters: {m: 1 kg}
links: {a: {mass: m, center_of_mass: [0.5, 0]}, b: {mass: 2, center_of_mass: [1.5, 0]}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [1, 0]}
loads: [{type: gravity, g: standard}]
motion:
  inputs:
    A.theta: {from: 0, to: 90, count: 4, rate: 1 rad/s}
    B.theta: {with: 2*A.theta, drive: tie}
"""


def test_efforts_of_inputs_that_others_drive_are_left_to_analyze() -> None:
    model = mk.loads(LED)
    places = {"A.theta": 30.0, "B.theta": 60.0}
    assert model.solve(places, ["b.omega"]).status == "ok"
    with pytest.raises(
        mk.UsageError, match=r"A\.effort depends on the rates of inputs that others"
    ):
        model.solve(places, ["A.effort"])


def test_variants_of_inputs_that_others_drive_are_analyses() -> None:
    masses = [1.0, 3.0]
    found = mk.loads(LED).vary({"m": masses}, ["A.effort"])
    for number, mass in enumerate(masses):
        one = mk.loads(LED, parameters={"m": f"{mass} kg"}).analyze()["A.effort"]
        assert found["A.effort"][number] == pytest.approx(one, rel=1e-13)
