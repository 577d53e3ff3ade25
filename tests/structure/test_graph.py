"""The solver graph: blocks of classics, against brute force, of many loops; verdicts and limits.

`MECHKIN_RANDOM` multiplies the number of networks that are shuffled.
"""

from __future__ import annotations

import os
from functools import partial

import numpy as np
import pytest
from structure.brute_force import least_blocks
from structure.networks import (
    Network,
    beside,
    ladder,
    platforms,
    random_network,
    shuffled,
    spatial_train,
    sphere,
    turn,
    walking_legs,
    windows,
)
from work import calls

import mechkin_cli as mk
from mechkin_cli.session.assembled_places import solver_graph

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


def blocks(network: Network) -> list[tuple[int, int]]:
    """Unknowns and equations of all blocks, sorted."""
    graph = mk.loads(network.text).graph
    return sorted((len(block.unknowns), block.equations) for block in graph.blocks)


WATT = {
    "A": turn("ground", "a", (0, 0, 0)),
    "B": turn("a", "b", (1, 1, 0)),
    "C": turn("b", "c", (4, 2, 0)),
    "D": turn("c", "ground", (5, 0, 0)),
    "E": turn("b", "d", (2, 3, 0)),
    "F": turn("d", "e", (4, 5, 0)),
    "G": turn("c", "e", (6, 3, 0)),
}
TRIAD = {
    "A": turn("ground", "crank", (0, 0, 0)),
    "B": turn("crank", "a", (1, 1, 0)),
    "C": turn("a", "plate", (3, 2, 0)),
    "D": turn("ground", "b", (6, 0, 0)),
    "E": turn("b", "plate", (5, 3, 0)),
    "F": turn("ground", "c", (2, 6, 0)),
    "G": turn("c", "plate", (4, 5, 0)),
}
CRANKS = {
    "A": turn("ground", "a", (0, 0, 0)),
    "B": turn("ground", "b", (1, 0, 0)),
    "C": turn("ground", "c", (2, 0, 0)),
    "D": turn("a", "rod", (0, 1, 0)),
    "E": turn("b", "rod", (1, 1, 0)),
    "F": turn("c", "rod", (2, 1, 0)),
}
SARRUS = {
    "A": turn("ground", "a", (2, 0, 0), (0, 1, 0)),
    "B": turn("a", "b", (3, 0, 1), (0, 1, 0)),
    "C": turn("b", "plate", (2, 0, 2), (0, 1, 0)),
    "D": turn("ground", "d", (0, 2, 0), (1, 0, 0)),
    "E": turn("d", "e", (0, 3, 1), (1, 0, 0)),
    "F": turn("e", "plate", (0, 2, 2), (1, 0, 0)),
}
STRUT = {
    "U": sphere("ground", "strut", (0.1, 0, 0)),
    "V": sphere("strut", "plate0", (0.05, 0.02, 1)),
}
RIG = platforms(2)

CLASSICS = {
    "Watt's six-bar by its crank: two dyads": (
        Network(list("abcde"), WATT, ["A.theta"]),
        [(2, 5), (2, 5)],
    ),
    "by its second loop: a group of four links": (
        Network(list("abcde"), WATT, ["F.theta"]),
        [(4, 10)],
    ),
    "a ternary link on three bars: Assur's third class": (
        Network(["crank", "a", "b", "c", "plate"], TRIAD, ["A.theta"]),
        [(4, 10)],
    ),
    "three parallel cranks, one too many": (
        Network(["a", "b", "c", "rod"], CRANKS, ["A.theta"]),
        [(3, 10)],
    ),
    "Sarrus": (Network(["a", "b", "plate", "d", "e"], SARRUS, ["A.theta"]), [(4, 5)]),
    "platform on platform": (RIG, [(6, 6), (6, 6)]),
    "a strut too many at the first of two platforms": (
        Network([*RIG.links, "strut"], RIG.joints | STRUT, RIG.inputs),
        [(6, 6), (6, 7)],
    ),
    "Jansen's leg: two dyads, then foot, rod": (walking_legs(1), [(2, 5), (2, 5), (2, 5)]),
}


@pytest.mark.parametrize(("network", "expected"), CLASSICS.values(), ids=CLASSICS)
def test_blocks_of_classics(network: Network, expected: list[tuple[int, int]]) -> None:
    for seed in range(6):
        assert blocks(shuffled(network, seed)) == expected


def small(count: int) -> list[int]:
    """Seeds of random mechanisms of two to four loops."""
    seeds = (seed for seed in range(1000) if 2 <= random_network(seed, 3).loops <= 4)
    return [next(seeds) for _ in range(count)]


@pytest.mark.parametrize("seed", small(30))
def test_no_spanning_tree_has_smaller_blocks(seed: int) -> None:
    model = mk.loads(random_network(seed, 3).text)
    found = sorted(len(block.unknowns) for block in model.graph.blocks)
    assert found == least_blocks(model.problem.mechanism, model.graph.driven)


@pytest.mark.parametrize(
    ("network", "expected"),
    [
        (windows(8), [(2, 5)] * 8),
        (windows(40), [(2, 5)] * 40),
        (ladder(40), [(2, 5)] * 40),
        (walking_legs(3), [(2, 5)] * 9),
        (spatial_train(100), [(3, 3)] * 100),
        (spatial_train(100, legs=True), [(1, 1)] * 100),
        (spatial_train(40, plane=True), [(2, 5)] * 40 + [(3, 3)] * 40),
        (platforms(8), [(6, 6)] * 8),
    ],
    ids=["windows 8", "windows 40", "ladder", "legs", "RSUR", "RSSR", "RSUR, plane", "platforms"],
)
def test_many_loops_stay_small_blocks_in_any_order(
    network: Network, expected: list[tuple[int, int]]
) -> None:
    assert blocks(network) == expected
    for seed in range(3):
        assert blocks(shuffled(network, seed)) == expected


def test_twice_the_loops_take_about_twice_the_work() -> None:
    """Four times the loops: less than six times the calls (quadratic: sixteen)."""
    counts = []
    for count in (40, 160):
        problem = mk.loads(windows(count).text).problem
        counts.append(calls(partial(solver_graph, problem.mechanism, problem.motion.driven)))
    assert counts[1] < 6 * counts[0]


@pytest.mark.parametrize("network", [windows(8), walking_legs(3)], ids=["windows", "legs"])
def test_numbers_do_not_depend_on_the_order_written(network: Network) -> None:
    """Angles of exchanged links change their sign."""
    names = [f"{name}.theta" for name in network.joints]
    wanted = mk.loads(network.text).analyze(names)
    assert set(wanted["row.status"]) == {"ok"}
    for seed in range(4):
        other = shuffled(network, seed, renamed=False)
        # the crank turns the same way
        crank = network.inputs[0].split(".")[0]
        joints = other.joints | {crank: network.joints[crank]}
        found = mk.loads(other._replace(joints=joints).text).analyze(names)
        for name in names:
            assert np.abs(np.abs(found[name]) - np.abs(wanted[name])).max() < 1e-9, name


def test_two_mechanisms_beside_each_other_have_both_their_blocks() -> None:
    for seed in range(10):
        one, other = random_network(seed, 6), random_network(seed + 50, 6)
        assert blocks(beside(one, other)) == sorted(blocks(one) + blocks(other))
        assert blocks(beside(one, one)) == sorted(2 * blocks(one))


def test_what_nothing_needs_adds_its_own_blocks_only() -> None:
    for seed in range(10):
        network = random_network(seed, 6)
        link = network.links[seed % len(network.links)]
        arm = network.joints | {"hinge": turn(link, "arm", (0, 2, 1), (0, 1, 1))}
        links, inputs = [*network.links, "arm"], [*network.inputs, "hinge.theta"]
        assert blocks(Network(links, arm, inputs)) == blocks(network)
        loop = arm | {
            "B": turn("arm", "b", (1, 2, 1), (0, 1, 1)),
            "C": turn("b", "c", (2, 3, 1), (0, 1, 1)),
            "D": turn("c", link, (3, 2, 1), (0, 1, 1)),
        }
        with_loop = Network([*links, "b", "c"], loop, inputs)
        assert blocks(with_loop) == sorted([*blocks(network), (2, 5)])


def verdict(network: Network) -> object:
    """The blocks; or the error's code and measure."""
    try:
        return blocks(network)
    except mk.InvalidFile as error:
        return [(d.code, d.measured) for d in error.diagnostics]


LOOPS = [*range(8, 8 + 6 * TIMES), 33, 47]


@pytest.mark.parametrize("loops", LOOPS)
def test_the_order_written_changes_neither_verdict_nor_blocks(loops: int) -> None:
    seed = loops - 8
    network = random_network(seed, loops)
    wanted = verdict(network)
    assert isinstance(wanted, list)
    assert wanted == verdict(shuffled(network, seed)) == verdict(shuffled(network, -1 - seed))


@pytest.mark.parametrize("seed", range(5 * TIMES))
def test_nor_with_an_input_more_or_less(seed: int) -> None:
    network = random_network(seed, 12)
    less = network._replace(inputs=network.inputs[1:])
    free = [n for n, p in network.joints.items() if p.letter == "R"]
    driven = {name.split(".")[0] for name in network.inputs}
    extra = next(n for n in free[seed % len(free) :] + free if n not in driven)
    for other in (less, network._replace(inputs=[*network.inputs, f"{extra}.theta"])):
        wanted = verdict(other)
        assert all(verdict(shuffled(other, seed)) == wanted for seed in range(3))


def errors(network: Network) -> tuple[str, str]:
    with pytest.raises(mk.InvalidFile) as caught:
        _ = mk.loads(network.text).graph
    (error,) = caught.value.diagnostics
    return error.code, error.message


def test_an_undriven_part_is_named_alone() -> None:
    both = beside(spatial_train(12), spatial_train(1))
    code, message = errors(both._replace(inputs=["O0.theta"]))
    assert code == "undriven-freedom"
    assert message.startswith("one free coordinate is not driven; candidates: O0x.theta, ")
    assert "A0." not in message


def test_a_driven_solid_is_named_alone() -> None:
    both = beside(windows(12), windows(1))
    inputs = [*both.inputs, "A0x.theta", "B0x.theta"]
    code, message = errors(both._replace(inputs=inputs))
    assert code == "driven-solid"
    assert "A0x, B0x, O0x, O1x" in message
