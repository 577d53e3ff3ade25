"""What a sweep leaves undone, and that nothing it leaves out would have changed its answer."""

from __future__ import annotations

import random

import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.assembly.near import far_notes
from mechkin_cli.assembly.start import HOME, NEAR, choose_start
from mechkin_cli.mechanism.quantities import Catalogue
from mechkin_cli.search.clusters import is_in_reach
from mechkin_cli.search.search import all_assemblies

PROVEN = ("rcsr", "rcsr_csr", "rssr", "slider_crank", "swash_plate", "rspr")
OPEN = ("rchch", "sevenr", "stewart", "five_link_suspension", "rprhrrr")


def searches(session) -> list[object]:
    memo = session.structure.memo
    return [key for key in memo if isinstance(key, tuple) and key[0].__name__ == "_everywhere"]


@pytest.mark.parametrize("name", [*PROVEN, *OPEN])
def test_no_search_is_left_out_that_would_have_told_the_letter(name: str) -> None:
    analysis = mk.load(FILE_OF[name]).analyze()
    session, result = analysis.result.session, analysis.result
    mode = result.mode
    left_out = mode in (HOME, NEAR) and not searches(session)
    assert left_out == (name in OPEN)
    first = session.inputs.reduced[:, 0]
    found = all_assemblies(session, first, thorough=False)
    if left_out:
        assert not found.complete
    else:
        assert found.complete
        states = found.states.T
        assert all(is_in_reach(session.layout, state) for state in states)


def test_a_sweep_of_positions_lists_no_quantities() -> None:
    for name in ("rcsr", "sevenr", "stewart"):
        model = mk.load(FILE_OF[name])
        quantities = model.problem.quantities()
        assert isinstance(quantities, Catalogue)
        of_tables = quantities.made
        model.analyze(tables=[])
        assert quantities.made == of_tables
        assert vars(quantities)["_every"] is None


@pytest.mark.parametrize("number", range(24))
def test_a_distance_within_the_limit_leaves_no_coordinate_far(number: int) -> None:
    rng = random.Random(number)
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    (line,) = (row for row in text.splitlines() if row.startswith("assembly:"))
    near = f"O2.theta: {rng.uniform(-180, 180):.6f}, O4.theta: {rng.uniform(-180, 180):.6f}"
    session = mk.loads(text.replace(line, f"assembly: {{near: {{{near}}}}}")).session
    start = choose_start(session)
    assert start.state is not None
    notes = far_notes(session, session.inputs.reduced[:, 0], start.state)
    told = [note for note in start.diagnostics if note.code == "nearest-far"]
    assert told == notes
    if start.off <= tolerances.NEAR_FAR:
        assert not notes
