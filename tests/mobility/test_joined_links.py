"""Links that may move together as one body are found from joint to joint: the choices that a search
through all sets of links finds, in its order; and the work goes with the links."""

from __future__ import annotations

from itertools import combinations

import pytest
from structure.networks import Network, random_network, scissors, walking_legs, windows

import mechkin_cli as mk
from mechkin_cli.mechanism import Mechanism
from mechkin_cli.mobility.idle import joined_links


def hang_together(mechanism: Mechanism, chosen: tuple[str, ...]) -> bool:
    """Whether joints lead from the first of some links to all others, through these alone."""
    reached = {chosen[0]}
    for _ in chosen:
        for joint in mechanism.joints.values():
            ends = {joint.first, joint.second}
            if ends <= set(chosen) and ends & reached:
                reached |= ends
    return len(reached) == len(chosen)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("count", [1, 2, 3])
def test_all_that_hang_together_are_found_in_order(seed: int, count: int) -> None:
    mechanism = mk.loads(random_network(seed, 3).text).problem.mechanism
    links = [name for name in mechanism.links if name != "ground"]
    every = combinations(links, count)
    expected = [chosen for chosen in every if hang_together(mechanism, chosen)]
    assert joined_links(mechanism, links, count) == expected


def test_their_number_goes_with_the_links() -> None:
    numbers = []
    for count in (50, 100):
        mechanism = mk.loads(windows(count).plane_text).problem.mechanism
        links = [name for name in mechanism.links if name != "ground"]
        numbers.append(len(joined_links(mechanism, links, 3)))
    assert numbers[1] < 2.1 * numbers[0]


@pytest.mark.parametrize(
    ("network", "redundant"),
    [(windows(30), 90), (scissors(20), 60), (walking_legs(2), 18)],
    ids=["four-bars", "scissors", "legs"],
)
def test_every_plane_loop_in_space_has_three_redundant_constraints(
    network: Network, redundant: int
) -> None:
    found = mk.loads(network.text).mobility()
    assert found.mobility == 1
    assert sum(item.number for item in found.redundant) == redundant
    flat = mk.loads(network.plane_text).mobility()
    assert flat.count == 1
