"""Loops that are solved together, more of them than a full matrix is kept of.

Scissors driven at the middle of their highest storey are one block, whatever their number: all
bars lean alike. If the middle turns by t, a bar of length l that stood at the angle a stands at
a - t / 2, whichever joints close the loops.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from structure.networks import ladder, scissors, shuffled

import mechkin_cli as mk
from mechkin_cli.kernel._kernel import StepLimits, Stepper
from mechkin_cli.plan import TrackEnd, home_state
from mechkin_cli.session import follow, step_limits, step_numbers
from mechkin_cli.structure import Block, SolverGraph
from mechkin_cli.structure.loop_order import entries_of
from mechkin_cli.tolerances import MOST_EQUATIONS

FLAT = 2.0 * math.degrees(math.atan2(0.4, 1.0))
"""How far the middle turns until all bars lie flat."""


def driven_on_top(count: int, to: float = 5.0, rows: int = 3) -> mk.Model:
    network = scissors(count)._replace(inputs=[f"M{count - 1}.theta"])
    text = network.plane_text.replace("to: 5, count: 3", f"to: {to}, count: {rows}")
    return mk.loads(text)


def the_block(model: mk.Model) -> Block:
    (block,) = model.graph.blocks
    return block


@pytest.mark.parametrize("count", [8, 14, 61, 130])
def test_scissors_driven_on_top_lean_alike(count: int) -> None:
    model = driven_on_top(count)
    block = the_block(model)
    assert block.equations == len(block.unknowns) == 2 * count
    run = model.analyze(["A0.theta", "S.s", "S.s_dot", f"M{count - 1}.theta"])
    assert run.complete
    turned = run[f"M{count - 1}.theta"] / 2.0
    # as many roundings as unknowns, each as large as the condition makes it
    off = 2e-16 * count * np.max(run["row.condition"])
    assert run["A0.theta"] == pytest.approx(-turned, abs=math.degrees(off))
    length, angle = math.hypot(1.0, 0.4), math.atan2(0.4, 1.0) - np.radians(turned)
    assert run["S.s"] == pytest.approx(length * np.cos(angle) - 1.0, abs=off)


def test_forces_are_those_of_few_loops() -> None:
    """A load on the shoe works against the drive by virtual work, whatever stands above."""
    load = "loads: [{type: force, link: shoe, point: [1, 0], force: [-3, 0]}]\n"
    efforts = []
    for count in (6, 70):
        network = scissors(count)._replace(inputs=[f"M{count - 1}.theta"])
        run = mk.loads(network.plane_text + load).analyze([f"M{count - 1}.effort"])
        assert run.complete
        efforts.append(run[f"M{count - 1}.effort"])
        # the shoe moves by l sin(a) / 2 per turn of the middle (N mm)
        angle = math.atan2(0.4, 1.0) - np.radians(np.array([0.0, 2.5, 5.0])) / 2.0
        work = 3.0 * math.hypot(1.0, 0.4) * np.sin(angle) / 2.0
        assert np.abs(efforts[-1]) == pytest.approx(work, rel=1e-8)
    assert efforts[1] == pytest.approx(efforts[0], rel=1e-8)


def test_rows_get_the_verdicts_of_few_loops() -> None:
    """All storeys fold flat at once: the last row before that is the same for any number."""
    found = []
    for count in (8, 20, 32):
        run = driven_on_top(count, to=FLAT + 3.0, rows=48).analyze(["A0.theta"])
        found.append((list(run["row.status"]), [d.code for d in run.diagnostics]))
    assert found[0] == found[1] == found[2]
    assert "branch-point" in found[0][1]


@pytest.mark.parametrize("count", [8, 20])
def test_assemblies_beside_the_drawing_are_found_by_search(count: int) -> None:
    """From starts some hundredths off: of 8 storeys by a full matrix, of 20 by a band."""
    session = driven_on_top(count).session
    home, rows = home_state(session.layout), 16
    rng = np.random.default_rng(count)
    states = home[:, None] + rng.uniform(-0.02, 0.02, (len(home), rows))
    residual, flags = np.empty(rows), np.empty(rows, np.uint8)
    session.plan.search(
        block=0,
        inputs=np.zeros((1, rows)),
        states=states,
        residual=residual,
        flags=flags,
        iterations=60,
        tests=(1e-12,),
    )
    assert not flags.any()
    assert np.all(residual <= 1e-12)
    assert np.max(np.abs(states - home[:, None])) < 1e-9


@pytest.mark.parametrize("count", [8, 20])
def test_no_step_leads_over_the_flat_place(count: int) -> None:
    """Beyond it all bars lean on as a step from before it predicts, to what its test of corrections
    and tangents allows: the Jacobians alone tell that branches cross there, full ones of 8 storeys
    and bands of 20."""
    session, flat, short = driven_on_top(count).session, math.radians(FLAT), 0.05
    stepper = Stepper.straight(session.plan, [0.0], [1.0], step_limits())
    node = stepper.close(0.0, home_state(session.layout).tolist())
    assert node is not None
    while node.sigma < flat - short:
        h = min(0.5 * stepper.wanted_step(node), flat - short - node.sigma)
        node = stepper.step(node, h) if h > 1e-9 else None
        assert node is not None
    beyond = stepper.close(flat + short, stepper.predict(node, flat + short - node.sigma).tolist())
    assert beyond is not None
    shoe = session.layout.state(list(session.layout.edge_number).index("S"), 0)
    assert beyond.state[shoe] == pytest.approx(node.state[shoe], abs=1e-9)
    assert not stepper.judge(node, beyond)


def test_a_walk_by_arclength_ends_where_it_would_take_too_much_work() -> None:
    """With the work of all that it takes the branch point is found, with that of two attempts it is
    not."""
    session = driven_on_top(8).session
    inputs = np.radians(np.linspace(0.0, FLAT + 3.0, 48))[None, :]
    start, attempt = home_state(session.layout), 17.0**3
    found = {}
    for attempts in (2, 1000):
        limits = StepLimits(**step_numbers() | {"arc_work": attempts * attempt})
        found[attempts] = follow(session.plan, inputs, start, limits=limits)
    assert found[1000].ending is not None
    assert not found[1000].ending.is_dead_centre
    assert found[2].ending is None
    assert found[2].end == TrackEnd.STALLED


def test_loops_are_closed_where_they_are_short() -> None:
    for count in (30, 61):
        graph = driven_on_top(count).graph
        assert max(len(loop) for loop in graph.loops) <= 4
        assert entries_per_equation(graph) < 12


def entries_per_equation(graph: SolverGraph) -> float:
    (block,) = graph.blocks
    number = {at: k for k, at in enumerate(block.unknowns)}
    passed = [
        sorted(number[at] for at in number if at[0] in {edge for edge, _ in graph.loops[c]})
        for c in block.closings
    ]
    counts = [graph.closings[c].equations for c in block.closings]
    return entries_of(passed, counts, len(number)) / block.equations


@pytest.mark.parametrize("seed", range(3))
def test_they_are_as_narrow_in_any_order_of_writing(seed: int) -> None:
    network = shuffled(scissors(40)._replace(inputs=["M39.theta"]), seed)
    assert entries_per_equation(mk.loads(network.plane_text).graph) < 14


def test_a_ladder_that_its_far_end_drives_is_narrow() -> None:
    network = ladder(40)._replace(inputs=["Q38.theta"])
    assert entries_per_equation(mk.loads(network.plane_text).graph) < 30


def test_entries_are_those_that_exchanged_rows_may_fill() -> None:
    """By elimination of matrices of ones and zeros, with rows exchanged in all ways."""
    rng = np.random.default_rng(3)
    for _ in range(30):
        n = int(rng.integers(2, 6))
        held = rng.random((n, n)) < 0.5
        held |= np.eye(n, dtype=bool)
        passed = [np.flatnonzero(row).tolist() for row in held]
        # rows are unknowns, columns equations: row i is swapped up to any pivot that it may be of
        filled = set()
        for order in itertools.product(*(range(k, n) for k in range(n))):
            rows = [held[:, i].copy() for i in range(n)]
            for k, pick in enumerate(order):
                if not rows[pick][k]:
                    break
                rows[k], rows[pick] = rows[pick], rows[k]
                filled |= {
                    (i, int(j)) for i in range(k, n) for j in np.flatnonzero(rows[i]) if j >= k
                }
                for i in range(k + 1, n):
                    if rows[i][k]:
                        rows[i] = rows[i] | rows[k]
        assert entries_of(passed, [1] * n, n) >= len(filled)


def test_loops_with_more_equations_than_unknowns_have_the_old_limit() -> None:
    """Written in space, five equations of a loop are for two unknowns."""
    network = scissors(30)._replace(inputs=["M29.theta"])
    with pytest.raises(mk.MechkinError, match=f"limit {MOST_EQUATIONS} closing equations"):
        mk.loads(network.text)
