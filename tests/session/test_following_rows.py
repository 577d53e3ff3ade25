"""Following rows on any path: the same branch however the rows are cut, ordered, doubled or filled
up, linear work, and turns of closing joints that are never lost."""

from __future__ import annotations

import numpy as np
import pytest
from prepared import Setup, prepared
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.plan.layout import Layout, home_state
from mechkin_cli.plan.outputs import Readout
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.plan.records import Output, OutputCode, TrackEnd, hand_over_outputs
from mechkin_cli.session.following import Followed, follow, step_limits
from mechkin_cli.session.inputs import (
    ORIENTATION,
    closing_slots,
    continuous_angle,
    continuous_signs,
    drawn_quaternion,
)
from mechkin_cli.session.kernel_run import Ask, RowInputs, run


class Platform:
    """The Stewart platform, driven along Lissajous paths of its six legs."""

    def __init__(self) -> None:
        model = mk.load(FILE_OF["stewart"])
        self.layout = Layout(model.problem.mechanism, model.graph)
        self.plan = build_plan(self.layout)
        self.start = home_state(self.layout)

    def path(self, rows: int, turns: float = 3.0) -> np.ndarray:
        """(6, rows), zero at the first row."""
        t = 2.0 * np.pi * turns * np.linspace(0.0, 1.0, rows)
        legs = [
            (0.1 if k % 2 else -0.07) * (1.0 - np.cos(t * (1.0 + 0.1 * k)))
            + 0.03 * np.sin(0.7 * k * t)
            for k in range(6)
        ]
        return np.ascontiguousarray(np.stack(legs)) / self.layout.length

    def closed(self, path: np.ndarray, followed: Followed) -> np.ndarray:
        """States at all rows; every row closes near its guess."""
        assert followed.end == TrackEnd.FINISHED
        assert followed.reached == path.shape[1]
        batch = run(self.plan, RowInputs(path, followed.guess))
        assert batch.good.all()
        assert np.all(batch.correction <= followed.limit)
        return batch.states

    def states(self, path: np.ndarray, **options: bool) -> np.ndarray:
        return self.closed(path, follow(self.plan, path, self.start, **options))


@pytest.fixture(scope="module")
def platform() -> Platform:
    return Platform()


def near(a: np.ndarray, b: np.ndarray) -> bool:
    return bool(np.max(np.abs(a - b)) <= 1e-12)


@pytest.mark.parametrize("rows", [2, 3, 4, 25, 60, 400, 5000])
def test_a_curved_path_is_followed_as_row_by_row(platform: Platform, rows: int) -> None:
    path = platform.path(rows)
    assert near(platform.states(path), platform.states(path, every_row=True))


def test_the_nodes_do_not_grow_with_the_rows(platform: Platform) -> None:
    steps = []
    for rows in (4000, 40000):
        path = platform.path(rows)
        steps.append(follow(platform.plan, path, platform.start).steps)
    assert steps[1] <= 1.2 * steps[0] < 300


def test_in_two_parts(platform: Platform) -> None:
    path = platform.path(700)
    whole = platform.states(path)
    cut = 311
    first = follow(platform.plan, path[:, : cut + 1], platform.start)
    second = follow(platform.plan, path[:, cut:], first.state)
    parts = [
        platform.closed(path[:, : cut + 1].copy(), first),
        platform.closed(path[:, cut:].copy(), second),
    ]
    assert near(np.concatenate([parts[0][:, :-1], parts[1]], axis=1), whole)


def test_there_and_back(platform: Platform) -> None:
    path = platform.path(500)
    both = np.concatenate([path, path[:, -2::-1]], axis=1)
    states = platform.states(np.ascontiguousarray(both))
    assert near(states[:, 500:], states[:, 498::-1])
    assert near(states[:, :500], platform.states(path))


def test_every_row_twice(platform: Platform) -> None:
    path = platform.path(300)
    doubled = platform.states(np.repeat(path, 2, axis=1))
    assert near(doubled[:, ::2], platform.states(path))
    assert near(doubled[:, 1::2], doubled[:, ::2])


def test_more_rows_between(platform: Platform) -> None:
    assert near(platform.states(platform.path(1201))[:, ::4], platform.states(platform.path(301)))


def test_corners_rests_and_straight_runs(platform: Platform) -> None:
    curve = platform.path(200)
    corner = curve[:, -1:] * np.linspace(1.0, 0.0, 50)
    rest = np.repeat(corner[:, -1:], 5, axis=1)
    zigzag = 0.02 * np.array([[(-1.0) ** k * (i + 1) / 6 for k in range(20)] for i in range(6)])
    path = np.ascontiguousarray(np.concatenate([curve, corner, rest, zigzag], axis=1))
    assert near(platform.states(path), platform.states(path, every_row=True))


@pytest.mark.parametrize("size", [1e-13, 1e-9, 1e-5, 1e-3])
def test_noise_on_the_rows(platform: Platform, size: float) -> None:
    noise = np.random.default_rng(1).uniform(-size, size, (6, 900))
    noise[:, 0] = 0.0
    path = platform.path(900) + noise
    assert near(platform.states(path), platform.states(path, every_row=True))


def test_the_inputs_in_another_order(platform: Platform) -> None:
    """The path's length, not one of its inputs, measures the steps."""
    model = mk.load(FILE_OF["stewart"])
    text = FILE_OF["stewart"].read_text(encoding="utf-8")
    lines = text.splitlines()
    first = next(k for k, line in enumerate(lines) if line.strip().startswith("L1.s: {from"))
    lines[first : first + 6] = lines[first : first + 6][::-1]
    other = mk.loads("\n".join(lines))
    layout = Layout(other.problem.mechanism, other.graph)
    assert model.problem.motion.driven[0] == other.problem.motion.driven[5]
    path = platform.path(400)
    here, there = (
        follow(platform.plan, path, platform.start),
        follow(build_plan(layout), path[::-1].copy(), home_state(layout)),
    )
    assert here.steps == there.steps


# --- turns of closing joints ------------------------------------------------------------------


def closing_case(name: str) -> Setup:
    problem = mk.load(FILE_OF[name]).problem
    return prepared(problem)


def dense(path: np.ndarray, parts: int) -> np.ndarray:
    """The path with `parts` steps for each."""
    rows = np.arange(parts * (path.shape[1] - 1) + 1) / parts
    return np.stack([np.interp(rows, np.arange(path.shape[1]), values) for values in path])


def longer_way(setup: Setup) -> np.ndarray:
    """The inputs from the row of the first assembly to the farther end."""
    values, row = setup.inputs.values, setup.start.row
    onward = row < values.shape[1] / 2
    return values[:, row:] if onward else values[:, row::-1]


@pytest.mark.parametrize("name", ["slider_crank", "rchch", "hooke", "double_hooke", "rccc"])
@pytest.mark.parametrize("coarse", [1, 2, 5])
def test_angles_against_small_steps(name: str, coarse: int) -> None:
    """Brute force: an arctangent unwrapped over steps too small for half a turn."""
    setup = closing_case(name)
    path = np.ascontiguousarray(longer_way(setup)[:, ::coarse])
    plan = build_plan(setup.layout)
    slots = {place: slot for place, slot in closing_slots(plan).items() if place[1] != ORIENTATION}
    assert slots
    code = int(OutputCode.CLOSING)
    records = [Output(code, *place, 0, (0.0, 0.0, 0.0), 1.0) for place in slots]
    angles = hand_over_outputs(plan, records)
    outputs = {place: number for number, place in enumerate(slots)}
    read = Ask(readout=Readout(angles, {}, ()))
    fine = dense(path, 400)
    way = follow(plan, fine, setup.start.state)
    brute = run(plan, RowInputs(fine, way.guess), read).outputs
    followed = follow(plan, path, setup.start.state, turns=True)
    assert followed.end == way.end == TrackEnd.FINISHED
    rows = run(plan, RowInputs(path, followed.guess), read).outputs
    for place, slot in slots.items():
        wanted = np.unwrap(brute[outputs[place]])[::400]
        found = continuous_angle(rows[outputs[place]], followed.turns[slot])
        assert np.max(np.abs(found - wanted)) <= 1e-9


@pytest.mark.parametrize("name", ["rcsr", "rspp", "rspr", "swash_plate"])
def test_signs_against_small_steps(name: str) -> None:
    """Quaternions of coarse rows against those of small steps, component by component."""
    setup = closing_case(name)
    (closing,) = setup.layout.graph.closings
    joint, plan = closing.joint, build_plan(setup.layout)
    slot = closing_slots(plan)[0, ORIENTATION]
    path = np.ascontiguousarray(longer_way(setup))
    fine = dense(path, 100)
    coarse = follow(plan, path, setup.start.state, turns=True)
    small = follow(plan, fine, setup.start.state, turns=True)
    q = drawn_quaternion(joint, coarse.turns[slot : slot + 4])
    wanted = drawn_quaternion(joint, small.turns[slot : slot + 4, ::100])
    side = np.sign(sum(a[0] * b[0] for a, b in zip(q, wanted, strict=True)))
    for a, b in zip(q, wanted, strict=True):
        assert np.max(np.abs(side * a - b)) <= 1e-2
    steps = np.stack(drawn_quaternion(joint, small.turns[slot : slot + 4]))
    assert np.max(np.abs(np.diff(steps, axis=1))) <= 0.1
    signs = continuous_signs(tuple(-part for part in wanted), q, 0)
    assert np.all(signs == 1.0)
    flipped = tuple(part * (-1.0) ** np.arange(part.size) for part in wanted)
    assert np.array_equal(continuous_signs(flipped, q, 0), (-1.0) ** np.arange(path.shape[1]))


@pytest.mark.parametrize("row", [1, 57, 99])
@pytest.mark.parametrize("value", [np.nan, np.inf, 1e200])
def test_a_row_that_is_no_place_ends_the_way(platform: Platform, row: int, value: float) -> None:
    path = platform.path(100)
    path[3, row] = value
    followed = follow(platform.plan, path, platform.start)
    assert followed.end != TrackEnd.FINISHED
    assert followed.reached == row


STEPS = (0.2, 0.1)
"""Longest steps (rad) of a loop that wants longer ones: all nodes are as far apart."""


def missed_by_guesses(longest: float) -> tuple[np.ndarray, np.ndarray]:
    """Places of rows of an RCHCH in parts of the longest step, and the largest miss of a guess."""
    setup = prepared(mk.load(FILE_OF["rchch"]).problem)
    plan = build_plan(setup.layout)
    way = np.linspace(0.0, 2.0, 401)
    rows = setup.inputs.values[:, setup.start.row][:, None] + way
    followed = follow(plan, rows, setup.start.state, limits=step_limits(longest))
    assert followed.end == TrackEnd.FINISHED
    assert followed.steps == round(2.0 / longest)
    closed = run(plan, RowInputs(rows, followed.guess))
    assert closed.good.all()
    return way / longest, np.abs(followed.guess - closed.states).max(axis=0)


def test_rows_between_nodes_are_told_to_ninth_order() -> None:
    """Two nodes give a polynomial of degree five; with the node before them it is one of eight."""
    misses = []
    for longest in STEPS:
        place, miss = missed_by_guesses(longest)
        misses.append((miss[place < 1.0].max(), miss[place > 1.0].max()))
    first, later = np.log2(np.divide(*misses))
    assert 5.5 < first < 7.5
    assert 8.3 < later < 9.7


def test_rows_on_nodes_are_closed() -> None:
    """However many of them were closed at once."""
    place, miss = missed_by_guesses(STEPS[0])
    on_nodes = np.abs(place - np.rint(place)) < 1e-9
    assert on_nodes.sum() == 11
    assert miss[on_nodes].max() < 1e-14
    assert miss[~on_nodes & (place > 1.0)].max() > 1e-11
