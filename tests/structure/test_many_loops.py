"""Machines of many loops: their answers by closed forms, and work that goes with the loops.

Scissors of bars of length l, of which the lowest stands at the angle a: their shoe stands at
l cos a, the k-th storey k l sin a high, whichever joints close the loops. A chain of parallelograms
turns as one. Work is counted in calls, which no other load on the machine changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
import yaml
from structure.networks import Network, parallelograms, scissors, spatial_train, windows
from work import calls

import mechkin_cli as mk
from mechkin_cli.mobility import drawn_faults
from mechkin_cli.reading.text import MOST_BYTES, MOST_EVENTS
from mechkin_cli.tolerances import MOST_LOOP_JOINTS

CHAINS = {
    "four-bars": windows,
    "parallelograms": parallelograms,
    "scissors": scissors,
    "RSUR": spatial_train,
}


def text_of(network: Network, *, plane: bool) -> str:
    return network.plane_text if plane else network.text


def more_of(counts: list[int]) -> float:
    """How much more the second doubling of the loops adds than the first; 2 of linear work."""
    few, twice, four = counts
    return (four - twice) / (twice - few)


@pytest.mark.parametrize("plane", [True, False], ids=["plane", "space"])
@pytest.mark.parametrize("count", [3, 40, 200])
def test_scissors_of_many_storeys_stand_where_the_lowest_bar_says(count: int, plane: bool) -> None:
    top = (
        f"points: {{top: {{link: a{count - 1}, at: [1, {0.4 * count}{'' if plane else ', 0'}]}}}}\n"
    )
    run = mk.loads(text_of(scissors(count), plane=plane) + top).analyze(["S.s", "top.position"])
    turned = np.radians(run["A0.theta"])
    length, angle = math.hypot(1.0, 0.4), math.atan2(0.4, 1.0) + turned
    assert run.complete
    # in mm, the file's unit of length
    assert run["S.s"] == pytest.approx(length * np.cos(angle) - 1.0, abs=1e-11 * count)
    # a{count - 1} leans from the left to the right, so its top is on the right
    assert run["top.position"][:, 0] == pytest.approx(length * np.cos(angle), abs=1e-11 * count)
    height = count * length * np.sin(angle)
    assert run["top.position"][:, 1] == pytest.approx(height, abs=1e-11 * count)


def test_a_chain_of_a_thousand_parallelograms_turns_as_one() -> None:
    count = 1000
    run = mk.loads(parallelograms(count).plane_text).analyze(
        [f"O{count}.theta", f"A{count - 1}.theta"]
    )
    assert run.complete
    assert run[f"O{count}.theta"] == pytest.approx(run["O0.theta"], abs=1e-9)
    assert run[f"A{count - 1}.theta"] == pytest.approx(-run["O0.theta"], abs=1e-9)


def test_where_long_loops_are_closed_changes_no_answer() -> None:
    """All at the middle of the rhombs, where both halves lead to ground, as short loops are."""
    count = 60
    model = mk.loads(scissors(count).plane_text)
    names = [f"M{k}" for k in range(1, count)]
    even = [closing.name for closing in model.graph.closings if closing.name not in names]
    found = model.analyze([f"{name}.theta" for name in names])
    forced = model.analyze(
        [f"{name}.theta" for name in names],
        closed_at=[*even[:1], *names],
    )
    for name in names:
        assert found[f"{name}.theta"] == pytest.approx(forced[f"{name}.theta"], abs=1e-9)


def test_loops_of_scissors_stay_short() -> None:
    """With all cut at the middles of the rhombs the last would pass every storey."""
    longest, passed = [], []
    for count in (100, 200):
        graph = mk.loads(scissors(count).plane_text).graph
        longest.append(max(map(len, graph.loops)))
        passed.append(sum(map(len, graph.loops)))
    assert longest[0] == longest[1] <= 2 * MOST_LOOP_JOINTS
    assert passed[1] < 2.1 * passed[0]


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("plane", [True, False], ids=["plane", "space"])
def test_loading_and_running_goes_with_the_loops(name: str, plane: bool) -> None:
    if plane and name == "RSUR":
        pytest.skip("is no mechanism of a plane")
    counts = []
    for count in (50, 100, 200):
        text = text_of(CHAINS[name](count), plane=plane)
        # the drawing of RSUR loops is a special position, from where no row is run here
        runs = name != "RSUR"
        counts.append(calls(lambda: mk.loads(text).analyze() if runs else mk.loads(text)))  # noqa: B023
    assert more_of(counts) < 2.2


@pytest.mark.parametrize("network", [windows, scissors])
def test_whether_inputs_move_is_asked_in_work_that_goes_with_the_loops(
    network: Callable[[int], Network],
) -> None:
    counts = []
    for count in (30, 60, 120):
        session = mk.loads(network(count).text).session
        counts.append(calls(lambda: drawn_faults(session)))  # noqa: B023
    assert more_of(counts) < 2.2


def test_ten_thousand_four_bars_are_no_longer_than_a_file_may_be() -> None:
    text = windows(10_000).text
    loader = getattr(yaml, "CSafeLoader", None)
    assert len(text.encode()) < MOST_BYTES
    if loader is not None:
        assert sum(1 for _ in yaml.parse(text, Loader=loader)) < MOST_EVENTS


def test_exact_numbers_of_a_plan_are_read_once() -> None:
    """Rows of many storeys are near singular, and each run looks at them in double-double."""
    session = mk.loads(scissors(20).plane_text).design.session
    once = session.precise.constants(session)
    assert session.precise.constants(session) is once
