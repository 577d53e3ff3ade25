"""Recorded numbers never pass for plain ones."""

from __future__ import annotations

import copy
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest

from mechkin_cli.tape import scalars
from mechkin_cli.tape.recorder import Recorder, Traced, TraceLost
from mechkin_cli.tape.tape import Operation

X = 0.75


def traced() -> Traced:
    return Traced(Recorder(["x"], [X]), 0)


LEAKS: dict[str, Callable[[Traced], object]] = {
    "float": float,
    "int": int,
    "truth": lambda x: 1 if x else 0,
    "not": lambda x: not x,
    "index": lambda x: [1, 2][x],  # type: ignore[index]
    "format": lambda x: f"{x:.3g}",
    "text": lambda x: f"{x}",
    "round": round,
    "power": lambda x: x**2,  # type: ignore[operator]
    "modulo": lambda x: x % 1.0,  # type: ignore[operator]
    "math": math.sin,
    "hash": hash,
    "key": lambda x: {x: 1},
    "array of floats": lambda x: np.array([x], dtype=float),
    "into an array": lambda x: np.zeros(2).__setitem__(0, x),
    "fill": lambda x: np.full(3, x, dtype=float),
    "with rows": lambda x: np.ones(3) * x,
    "rows after": lambda x: x + np.ones(3),
    "numpy function": np.sqrt,
    "copy": copy.deepcopy,
    "pickle": pickle.dumps,
    "isfinite": math.isfinite,
}


@pytest.mark.parametrize("leak", LEAKS)
def test_leaks_raise(leak: str) -> None:
    with pytest.raises(TypeError):
        LEAKS[leak](traced())


def test_it_is_no_float() -> None:
    assert not isinstance(traced(), float)


def test_recordings_do_not_mix() -> None:
    with pytest.raises(TraceLost):
        traced() + traced()


def test_division_by_zero_is_the_same_error() -> None:
    x = traced()
    with pytest.raises(ZeroDivisionError):
        x / 0.0
    with pytest.raises(ZeroDivisionError):
        1.0 / (x - X)


def test_what_nothing_needs_is_left_out() -> None:
    x = traced()
    useful = x + 1.0
    _ = scalars.sin(x) * 7.0
    again = x + 1.0
    tape = x.recorder.tape([useful.register, again.register])
    assert tape.operations.tolist() == [Operation.ADD]
    assert tape.constants.tolist() == [1.0]
    assert tape.outputs.tolist() == [2, 2]


def test_zeros_of_either_sign_are_two_constants() -> None:
    x = traced()
    tape = x.recorder.tape([(x * 0.0).register, (x * -0.0).register])
    assert [math.copysign(1.0, value) for value in tape.constants] == [1.0, -1.0]


def test_a_condition_compared_with_a_truth_value_decides() -> None:
    """As `same == section.internal` does."""
    x = traced()
    assert ((x > X - 1.0) == True, (x > X - 1.0) == False) == (True, False)  # noqa: E712
    assert (x > X - 1.0) != (x > X + 1.0)
    assert x.recorder.tape([0]).expected.tolist() == [True, False]


def test_a_condition_that_nobody_asks_is_no_guard() -> None:
    x = traced()
    (x < 1.0).choose(x, 2.0)
    assert x.recorder.tape([0]).expected.size == 0
    assert x < 1.0
    assert x.recorder.tape([0]).expected.tolist() == [True]
