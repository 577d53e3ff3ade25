"""Rows of which none is to be judged by itself: the kernel's word on all of them is what it says of
each."""

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.plan import Demand
from mechkin_cli.session import Ask, RowInputs
from mechkin_cli.sweep import follow_rows

RCSR = Path(__file__).parents[2] / "mechanisms" / "dissertation" / "rcsr.yaml"
ROWS = 9001
ASK = Ask(Demand.VELOCITY | Demand.CONDITION)


@pytest.fixture(scope="module")
def followed():
    text = RCSR.read_text(encoding="utf-8")
    text = text.replace("from: 150, to: 202, step: 2", f"from: 150, to: 202, count: {ROWS}")
    session = mk.loads(text, "rcsr").analyze().result.session
    start = mk.loads(text, "rcsr").analyze().result.start
    rows = follow_rows(session, start)
    given = session.row_inputs(rows.states, rows.turns)._replace(limit=rows.limit)
    return session, given


def told(session, given: RowInputs, threads: int) -> bool:
    return session.packed(session.packing._replace(threads=threads)).run(given, ASK).all_closed


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_all_closed(followed, threads: int) -> None:
    session, given = followed
    batch = session.run(given, ASK)
    assert batch.condition is not None
    assert batch.condition.max() < tolerances.CONDITION_FEW_DIGITS
    assert told(session, given, threads)


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("row", [0, 1, 4095, 4096, 5000, ROWS - 1])
def test_one_row_has_another_limit(followed, row: int, threads: int) -> None:
    """One correction beyond its limit is seen, wherever its row is, and where its limit is nan."""
    session, given = followed
    for number in (-1.0, np.nan):
        limit = given.limit.copy()
        limit[row] = number
        assert not told(session, given._replace(limit=limit), threads)


@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize("row", [0, 1, 4095, 4096, 5000, ROWS - 1])
def test_one_row_on_another_side(followed, row: int, threads: int) -> None:
    """One row that closes in another mode, without any limit."""
    session, given = followed
    guess = given.guess.copy()
    other = other_side(session, given, row)
    guess[:, row] = other
    found = given._replace(guess=guess, limit=np.full(ROWS, np.inf))
    assert told(session, given._replace(limit=np.full(ROWS, np.inf)), threads)
    assert not told(session, found, threads)


def other_side(session, given: RowInputs, row: int):
    """A state of the row with the other sign of its determinant, from guesses by chance."""
    generator = np.random.default_rng(1)
    inputs = np.repeat(given.inputs[:, [row]], 400, axis=1)
    guess = given.guess[:, [row]] + generator.normal(0.0, 1.0, (given.guess.shape[0], 400))
    rates = np.ones_like(inputs)
    batch = session.run(RowInputs(inputs, guess, rates), ASK._replace(iterations=60))
    own = session.run(given, ASK)
    sides = (batch.side != own.side[:, [row]]).any(axis=0) & batch.good & (batch.condition < 1e3)
    assert sides.any()
    return batch.states[:, np.argmax(sides)]


@pytest.mark.parametrize("row", [0, 4096, ROWS - 1])
def test_one_row_is_open(followed, row: int) -> None:
    session, given = followed
    guess = given.guess.copy()
    guess[:, row] = np.nan
    assert not told(session, given._replace(guess=guess, limit=np.full(ROWS, np.inf)), 2)
