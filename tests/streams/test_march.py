"""Some of a response's moments, and parts of the ways between them, as the rows of a motion; and a
motion that is left."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from streams.test_responses import DRIVEN, PENDULUM

import mechkin_cli as mk
from mechkin_cli.response import Prepared, integrate, prepare
from mechkin_cli.response.march import RowTimes, taken
from mechkin_cli.response.report import MotionRows

Rows = Callable[..., MotionRows]


def prepared(count: int) -> Prepared:
    model = mk.loads(PENDULUM.format(to=2, count=count, stop=""))
    return prepare(model.design.at_responses.problem, model.design.response("swing"))


def moved(one: Prepared, begin: float, times: Any, **named: Any) -> MotionRows:
    assert one.begun is not None
    (found,) = integrate(
        [(one.free.plan, one.begun)],
        begin,
        times,
        one.response,
        packing=one.free.packing,
        **named,
    )
    return found


@pytest.mark.parametrize("count", [101, 100_001], ids=["held", "equally spaced"])
@pytest.mark.parametrize(("parts", "last"), [(1, None), (1, 0.0217), (7, None), (16, 0.02169)])
def test_a_motion_has_the_rows_of_its_moments(count: int, parts: int, last: float | None) -> None:
    one = prepared(count)
    every = one.response.moments.values
    first, begin = int(np.searchsorted(every, 0.01)), 0.0043
    rows = int(np.searchsorted(every, 0.0215)) - first
    times = RowTimes(one.response.moments, first, rows, parts, last)
    # the way from one moment to the next, as sixteen equal parts
    expected = []
    for a, b in zip([begin, *every[first:]], every[first : first + rows], strict=False):
        expected += [b if k == parts else a + (b - a) * (k / parts) for k in range(1, parts + 1)]
    expected += [] if last is None else [last]
    assert times.between(0, times.size, begin).tolist() == expected
    some = slice(times.size // 3, times.size // 2)
    assert times.between(some.start, some.stop, begin).tolist() == expected[some]
    whole = moved(one, begin, np.array(expected))
    blocks: list[MotionRows] = []

    def take(number: int, rows: int, arrays: list[Any]) -> bool:
        blocks.append(taken(number, rows, arrays))
        return True

    blocks.append(moved(one, begin, times, block=5, taker=take))
    states = np.concatenate([block.states for block in blocks], axis=1)[:, : times.size]
    assert states.tobytes() == whole.states[:, : times.size].tobytes()
    assert blocks[-1].report._replace(first=0) == whole.report


def test_a_motion_that_is_left_goes_no_further() -> None:
    """Its first row is that of the whole one."""
    one = prepared(100_001)
    times = RowTimes(one.response.moments, 0, 100_001)
    whole = moved(one, 0.0, times, block=100_001, taker=lambda *_: True)
    left = moved(one, 0.0, times, block=1, taker=lambda *_: False)
    assert left.report.steps == 1
    assert whole.report.steps > 10
    assert left.states[:, 0].tobytes() == whole.states[:, 0].tobytes()


def test_laws_over_moments_are_those_at_each() -> None:
    model = mk.loads(DRIVEN)
    one = prepare(model.design.at_responses.problem, model.design.response("pull"))
    assert one.driven is not None
    times = np.linspace(0.0, 2.0, 41)
    found = one.driven.over(times)
    assert found.shape == (3, 1, 41)
    for column, time in enumerate(times.tolist()):
        assert found[:, :, column].T.tolist() == [list(each) for each in one.driven.at(time)]


@pytest.mark.parametrize(
    ("named", "message"),
    [
        ({"first": -1}, "some: of the times"),
        ({"first": 95}, "some: of the times"),
        ({"parts": 0}, "parts: 1 to 1048576"),
        ({"parts": (1 << 20) + 1}, "parts: 1 to 1048576"),
        ({"last": float("nan")}, "a finite number"),
        ({"last": 0.01}, "rise from the start on"),
    ],
)
@pytest.mark.parametrize("count", [101, 100_001])
def test_moments_that_are_none_are_refused(named: dict[str, Any], message: str, count: int) -> None:
    one = prepared(count)
    rows = 10 if count == 101 else 99_990
    times = RowTimes(one.response.moments, 0, rows)._replace(**named)
    if named.get("first") == 95:
        times = times._replace(first=count - 5)
    with pytest.raises(ValueError, match=message):
        moved(one, 0.0, times, block=5, taker=lambda *_: True)
