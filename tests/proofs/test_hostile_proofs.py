"""The kernel's proofs with numbers and arrays that make no sense: refused, or not proven."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel
from mechkin_cli.proofs.rows import certify


@pytest.fixture
def result() -> Any:
    return mk.load(RCSR).analyze(tables=[]).result


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 1e300, -1e308, 5e-324])
def test_states_that_make_no_sense_prove_nothing(result: Any, wrong: float) -> None:
    """Of the row alone: its neighbours keep their proofs, and nothing leads over it."""
    states = result.row_states.states
    states[1:, 10] = wrong
    found = certify(result.session, states, result.solved)
    assert found.boxes.proven.tolist() == [row != 10 for row in range(27)]
    assert found.on_branch.tolist() == [row < 10 for row in range(27)]


def boxes(plan: Any, states: np.ndarray, **changes: Any) -> None:
    places = states.shape[1]
    arguments = {
        "states": states,
        "off": np.zeros((plan.inputs, places)),
        "radius": np.empty((plan.columns, places)),
        "contraction": np.empty(places),
        "beyond": np.empty(places),
        "proven": np.empty(places, np.uint8),
    }
    _kernel.prove_boxes(plan, **(arguments | changes))


def test_arrays_that_do_not_fit_are_refused(result: Any) -> None:
    plan, states = result.session.plan, np.ascontiguousarray(result.row_states.states)
    boxes(plan, states)
    for name, array in {
        "states": states[:-1],
        "off": np.zeros((2, 27)),
        "radius": np.empty((plan.columns, 26)),
        "proven": np.empty(28, np.uint8),
        "contraction": None,
    }.items():
        with pytest.raises((ValueError, TypeError)):
            boxes(plan, states, **{name: array})
    other = mk.load(FILE_OF["rssr"]).session.plan
    with pytest.raises(ValueError, match="another structure"):
        boxes(plan, states, radii=other)


def test_no_rows(result: Any) -> None:
    plan = result.session.plan
    boxes(plan, np.empty((plan.states, 0)))


def test_a_way_does_not_go_back(result: Any) -> None:
    plan, states = result.session.plan, np.ascontiguousarray(result.row_states.states[:, :3])
    columns = np.zeros((plan.columns, 3))
    with pytest.raises(ValueError, match="do not fall"):
        _kernel.prove_tubes(
            plan,
            place=np.array([0.0, 1.0, 0.5]),
            inputs=np.zeros((plan.inputs, 3)),
            off=np.zeros((plan.inputs, 3)),
            states=states,
            after=columns,
            before=columns.copy(),
            radius=columns.copy(),
            proven=np.ones(3, np.uint8),
            bends=np.zeros(3, np.uint8),
            joined=np.empty(3, np.uint8),
            width=np.empty(3),
        )
