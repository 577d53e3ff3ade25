"""A block is looked at for all places of the blocks before it at once, with the answers that it has
at each place alone; how often the kernel is called goes with the blocks and not with the places."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.plan.layout import home_state
from mechkin_cli.search import search
from mechkin_cli.search.chain import chain_of, chains_of
from mechkin_cli.search.loop_equation import count_assemblies, counts_of_assemblies
from tests.assembly.test_folding_assemblies import scissors

FILES = sorted(p for p in Path("mechanisms").rglob("*.yaml") if p.parent.name != "studies")
PLACES = 5


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_chains_at_many_places_are_those_at_each(path: Path) -> None:
    try:
        layout = mk.load(path).session.layout
    except mk.InvalidFile:
        pytest.skip("not driven as it stands")
    random = np.random.default_rng(7)
    home = home_state(layout)
    bases = home[:, None] + random.uniform(-0.3, 0.3, (home.size, PLACES))
    for number in range(len(layout.graph.blocks)):
        alone = [chain_of(layout, number, base) for base in bases.T]
        together = chains_of(layout, number, bases)
        if together is None:
            assert alone == [None] * PLACES
            continue
        assert together == alone  # to the last bit
        counts = [count_assemblies(layout, number, base) for base in bases.T]
        assert counts_of_assemblies(layout, number, bases) == counts


def test_a_chain_is_longer_than_calls_go_deep() -> None:
    """Round the last rhomb of scissors of 600 storeys the way leads through all of them."""
    layout = mk.loads(scissors(600)).session.layout
    chain = chain_of(layout, len(layout.graph.blocks) - 1, home_state(layout))
    assert chain is not None
    assert len(chain.motions) == 2


@pytest.mark.parametrize("count", [3, 5, 7])
def test_the_kernel_is_called_for_blocks_and_not_for_places(
    monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    calls = 0
    kernel_run = search.run

    def counted(*args: Any, **named: Any) -> Any:
        nonlocal calls
        calls += 1
        return kernel_run(*args, **named)

    session = mk.loads(scissors(count)).session
    monkeypatch.setattr(search, "run", counted)
    found = search.assemblies(session.layout, session.plan, session.inputs.values[:, 0])
    assert found.number == 2 ** (count - 1)
    rounds = 5
    assert calls <= rounds * count
