"""`row.error_bound`: true, and not far above the errors, against states at 60 digits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from derived.exact_rows import mechanism, solution
from oracle import mp
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.verdict import Status

INCH = mp.mpf("0.0254")


@cache
def rcsr() -> mk.Analysis:
    return mk.load(FILE_OF["rcsr"]).analyze(tables=[])


def errors(r: mk.Analysis) -> np.ndarray:
    """The largest error of a tree coordinate in every row, slides in the kernel's length unit."""
    result = r.result
    tree = {edge.joint.name for edge in result.graph.edges}
    names = [
        f"{joint}.{coordinate}"
        for joint, its in mechanism("rcsr").joints.items()
        for coordinate in its.coordinates
        if joint in tree
    ]
    found = np.zeros(r.rows)
    for name in names:
        unit = INCH / mp.mpf(result.session.layout.length) if name.endswith(".s") else mp.one
        computed = np.asarray(result.quantity(name).value)
        for row in range(r.rows):
            exact = solution("rcsr", row)[name]
            at = mp.mpf(computed[row]) / (INCH if name.endswith(".s") else 1)
            found[row] = max(found[row], float(abs(at - exact) * unit))
    return found


def test_it_is_true_and_close():
    bound, true = rcsr()["row.error_bound"], errors(rcsr())
    assert (true <= bound).all()
    assert np.median(bound / true) < 30.0


def test_a_row_beside_the_truth_is_bounded_as_well():
    """Every row planted a little off, as if it had been closed no better: the bound is as large as
    the error then is, and no larger."""
    r = mk.load(FILE_OF["rcsr"]).analyze(tables=[])
    states, planted = r.result.row_states.states, 1e-11
    angles = [c.state for c in r.result.session.layout.carriers if not c.part.type.is_ball]
    states[angles[-1]] += planted
    bound = r["row.error_bound"]
    assert (bound > planted - 1e-13).all()
    assert (bound < 1.01 * planted).all()


@pytest.mark.parametrize("name", ["bennett", "stewart", "rchch", "rcsr_csr", "parallelogram"])
def test_every_row_has_one(name):
    """Loops of legs, threads, several blocks, redundant constraints, a branch point passed."""
    bound = mk.load(FILE_OF[name]).analyze(tables=[])["row.error_bound"]
    assert (bound > 1e-16).all()
    assert (bound < 1e-12).all()


def rocker(position: str) -> mk.Model:
    return mk.loads(FOUR_BAR.format(position=position))


FOUR_BAR = """
format: 1
units: {{length: mm}}
links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [20, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, rocker], point: [60, 50, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [ground, rocker], point: [70, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{D.theta: {position}}}}}
"""


def test_rows_beyond_a_dead_centre_have_none():
    r = rocker("{from: 0, to: 60, step: 5}").analyze()
    bound = r["row.error_bound"]
    reached = r.result.solved
    assert reached.any()
    assert not reached.all()
    assert np.isnan(bound[~reached]).all()
    assert np.isfinite(bound[reached]).all()


def test_it_grows_toward_a_dead_centre():
    whole = rocker("{from: 0, to: 60, step: 0.01}").analyze()
    last = np.flatnonzero(whole.result.solved & (whole.result.status == Status.ok))[-1]
    bound = whole["row.error_bound"]
    assert bound[last] > 5.0 * bound[0]


def test_a_row_has_the_same_beside_any_others():
    alone = rocker("{at: 10}").analyze()["row.error_bound"]
    for rows in ("{values: [0, 10, 20]}", "{values: [20, 10, 0]}"):
        r = rocker(rows).analyze(lanes=2, threads=1)
        # its states may differ in their last bits, as it was guessed from elsewhere
        assert r["row.error_bound"][1] == pytest.approx(alone[0], rel=0.1)


def test_it_depends_neither_on_lanes_nor_on_threads():
    m = mk.load(FILE_OF["rcsr_csr"])
    bounds = [
        m.analyze(["row.error_bound"], tables=[], lanes=lanes, threads=threads)["row.error_bound"]
        for lanes, threads in ((2, 1), (0, 2))
    ]
    assert (bounds[0] == bounds[1]).all()


def test_a_response_has_none():
    with pytest.raises(mk.UsageError, match=r"row\.error_bound"):
        mk.load(FILE_OF["rcsr_response"]).respond("response", ["row.error_bound"])
