"""Modes of mechanisms of many blocks: each is searched once for what it hangs from."""

from __future__ import annotations

import random

import pytest

import mechkin_cli as mk


def rods(count: int, *, chained: bool = False, slip: int | None = None) -> str:
    """Rockers moved by rods (S-S) from one crank, or each from the one before; the rod `slip` is
    drawn forty too long."""
    rng = random.Random(3)
    links, before = ["crank: {}"], "crank"
    joints = ["A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}"]
    for k in range(count):
        links += [f"c{k}: {{}}", f"r{k}: {{}}"]
        base = [3 * (k + 1) + rng.uniform(-0.2, 0.2), *(rng.uniform(-0.3, 0.3) for _ in "yz")]
        x = 3 * k if chained else 0
        start = [x + rng.uniform(-0.5, 0.5), 0.7 + rng.uniform(-0.1, 0.1), rng.uniform(-0.2, 0.2)]
        end = [base[0] + rng.uniform(-0.2, 0.2), base[1] + 1.2, base[2] + rng.uniform(-0.2, 0.2)]
        drawn = [end[0] - 40.0 * (k == slip), *end[1:]]
        axis = [rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), 1]
        joints += [
            f"S{k}: {{type: S, links: [{before}, c{k}], point: {start}}}",
            f"T{k}: {{type: S, links: [c{k}, r{k}], point: {{c{k}: {drawn}, r{k}: {end}}}}}",
            f"P{k}: {{type: R, links: [ground, r{k}], point: {base}, axis: {axis}}}",
        ]
        before = f"r{k}" if chained else before
    head = f"format: 1\nlinks: {{{', '.join(links)}}}\njoints:\n  "
    return head + "\n  ".join(joints) + "\nmotion: {inputs: {A.theta: {at: 0}}}\n"


def test_independent_blocks_multiply_and_are_searched_once() -> None:
    alone = mk.loads(rods(1)).modes()
    assert len(alone.modes) == 2
    found = mk.loads(rods(12)).modes()
    assert len(found.modes) == 2**12
    assert found.complete
    assert found.starts <= 12 * 512
    places = {tuple(round(v, 6) for v in mode.coordinates.values()) for mode in found.modes}
    assert len(places) == 2**12


def test_blocks_in_a_chain_are_searched_at_every_place_before() -> None:
    """Of a chain of two every mode is one of the second loop alone, its crank at the first's."""
    found = mk.loads(rods(8, chained=True)).modes()
    assert found.complete
    before = mk.loads(rods(7, chained=True)).modes()
    kept = {round(mode.coordinates["P6.theta"], 5) for mode in found.modes}
    assert kept <= {round(mode.coordinates["P6.theta"], 5) for mode in before.modes}
    assert found.starts < 20_000


@pytest.mark.parametrize("chained", [False, True])
def test_the_loop_that_cannot_close_is_named_at_once(chained: bool) -> None:
    result = mk.loads(rods(9, chained=chained, slip=6)).modes()
    assert result.modes == ()
    assert result.starts < 10_000
    (error,) = (d for d in result.diagnostics if d.severity == "error")
    crank = "P5" if chained else "A"
    assert f"the loop through {crank}, S6, T6, P6 does not close" in error.message
    assert error.measured == "its equations have no real root"


def test_more_modes_than_can_be_listed_are_told() -> None:
    found = mk.loads(rods(16)).modes()
    assert 0 < len(found.modes) < 2**16
    assert not found.complete
    assert found.is_cut
    assert "listed of many more" in found.sentence
    assert [d.code for d in found.diagnostics if d.severity == "warning"][-1] == "search-stopped"


def test_a_body_on_legs_of_which_one_is_too_short() -> None:
    from modes.forty import drawing

    text = drawing().replace("rod5: [1.361", "rod5: [13.61")
    found = mk.loads(text).modes()
    assert found.modes == ()
    (error,) = found.diagnostics
    assert "the 6 loops through A0, B0, A1" in error.message
    assert "with 99 % confidence one more does with a chance of at most" in found.sentence
    assert 0.0 < found.chance < 0.01
