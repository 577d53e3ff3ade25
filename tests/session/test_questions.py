"""An answer depends on the model and the question, never on what was asked before."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from session.questions import MECHANISMS, answer, differing, kept, rows

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

FOLLOWED = next(MECHANISMS.rglob("rcsr_csr_loop_one.yaml"))


@pytest.mark.parametrize("path", kept(), ids=lambda path: path.stem)
def test_questions_in_random_order(path: Path) -> None:
    _, differing_answers = differing(path, 0, 2)
    assert not differing_answers


@pytest.mark.parametrize("name", ["rcsr_csr_loop_one", "rcsr", "rcsr_response", "rprrhc"])
def test_many_questions_in_random_order(name: str) -> None:
    _, differing_answers = differing(next(MECHANISMS.rglob(f"{name}.yaml")), 1, 8 * TIMES)
    assert not differing_answers


def test_a_mode_after_the_own_assembly() -> None:
    model = mk.load(FOLLOWED)
    own = rows(model.analyze())
    other = rows(model.analyze(mode="A"))
    assert other == rows(mk.load(FOLLOWED).analyze(mode="A"))
    assert other != own


def test_an_unknown_mode_after_the_own_assembly() -> None:
    model = mk.load(FOLLOWED)
    model.analyze()
    assert answer(model, lambda m: m.analyze(mode="Z")) == (
        "UsageError",
        "there is no mode Z at the first row: modes A, B",
    )


def test_a_mode_of_a_model_with_other_parameters() -> None:
    """What is continued from the file's own parameters is not what a mode names."""
    name, quantity = next(iter(mk.load(FOLLOWED).problem.parameters.items()))
    value = float(mk.load(FOLLOWED).problem.units.from_si(quantity.value, quantity.dimension))
    varied = mk.load(FOLLOWED).with_parameters({name: value})
    own = mk.load(FOLLOWED)
    for mode in "AB":
        assert rows(varied.analyze(mode=mode)) == rows(own.analyze(mode=mode))
