"""Bad use of the Python interface: whatever is given, a documented error that says what to do."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest
from interface.bad_values import SINGLE, bad_value, shown
from references import RCSR

import mechkin_cli as mk

CALLS_PER_ARGUMENT = 400
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
