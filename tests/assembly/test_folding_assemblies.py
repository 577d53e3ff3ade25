"""Mechanisms whose loops fold: at some places of the blocks before, a block has infinitely many
assemblies, which are neither listed nor gone on with.

Sarrus: two legs of three parallel axes each, about different directions, leave the platform one
shift; with a leg's lower angle given it is at the height drawn, or flat, where the other legs spin
about their folded axes. At the height each leg but the driven one has two elbows.

Scissors: with the lowest bar given the shoe stands at two places; at one of them the bars coincide,
and all above spin. At the other every further rhomb stands up or is folded down, two places each.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.plan.layout import home_state
from mechkin_cli.plan.records import Demand
from mechkin_cli.search.clusters import unknown_states
from mechkin_cli.session.kernel_run import Ask, RowInputs, run

HEAD = "format: 1\nunits: {length: m, angle: deg, force: N}\n"
Z = (0, 0, 1)
DIRECTIONS = (0.3, 2.394, 4.488)
MOST_STARTS = 16_384
"""Of a short search at one place."""


def revolute(name: str, links: str, point: tuple[float, ...], axis: tuple[float, ...]) -> str:
    return f"  {name}: {{type: R, links: [{links}], point: {list(point)}, axis: {list(axis)}}}\n"


def stages(count: int, legs: int, near: str = "") -> str:
    """Sarrus stages on each other, each driven at its first leg's lower joint."""
    links, joints, inputs = [], "", []
    for k in range(count):
        base = f"p{k}" if k else "ground"
        links.append(f"p{k + 1}")
        for n, turned in enumerate(DIRECTIONS[:legs]):
            out = math.cos(turned), math.sin(turned)
            axis = -out[1], out[0]
            upper, lower = f"v{k}{n}", f"u{k}{n}"
            links += [lower, upper]
            for letter, two, reach, height in (
                ("A", f"{base}, {lower}", 2.0, k),
                ("B", f"{lower}, {upper}", 2.7, k + 0.5),
                ("C", f"{upper}, p{k + 1}", 2.0, k + 1),
            ):
                at = (reach * out[0], reach * out[1], height)
                joints += revolute(f"{letter}{k}{n}", two, at, (*axis, 0))
        inputs.append(f"A{k}0.theta: {{from: 0, to: {4 - k}, step: {(4 - k) / 4}}}")
    named = ", ".join(f"{link}: {{}}" for link in links)
    motion = f"motion: {{inputs: {{{', '.join(inputs)}}}}}\n"
    return f"{HEAD}links: {{{named}}}\njoints:\n{joints}{motion}{near}"


def scissors(count: int, off: float = 0.0) -> str:
    """The first rhomb is `off` its right shape by as much."""
    named = ", ".join(f"a{k}: {{}}, b{k}: {{}}" for k in range(count))
    joints = revolute("A0", "ground, a0", (0, 0, 0), Z)
    joints += "  S: {type: P, links: [ground, shoe], point: [1, 0, 0], axis: [1, 0, 0]}\n"
    joints += revolute("SR", "shoe, b0", (1, 0, 0), Z)
    for k in range(count):
        joints += revolute(f"M{k}", f"a{k}, b{k}", (0.5, k + 0.5, 0), Z)
    for k in range(1, count):
        joints += revolute(f"L{k}", f"b{k - 1}, a{k}", (off if k == 1 else 0, k, 0), Z)
        joints += revolute(f"R{k}", f"a{k - 1}, b{k}", (1, k, 0), Z)
    motion = "motion: {inputs: {A0.theta: {from: 0, to: 30, step: 3}}}\n"
    return f"{HEAD}links: {{{named}, shoe: {{}}}}\njoints:\n{joints}{motion}"


def is_told(diagnostics: tuple[mk.Diagnostic, ...]) -> bool:
    return any(d.code == "free-assembly" and "still move" in d.message for d in diagnostics)


@pytest.mark.parametrize(("count", "legs"), [(1, 2), (1, 3), (2, 2), (2, 3)])
def test_a_stage_has_two_elbows_for_each_leg_that_is_not_driven(count: int, legs: int) -> None:
    found = mk.loads(stages(count, legs)).modes()
    # from 180 - 2 rise between a leg's halves, the other elbow turns the knee to the opposite
    rise = math.degrees(math.atan2(0.5, 0.7))
    knees = [
        tuple(
            abs(round(mode.coordinates[f"B{k}{n}.theta"], 6))
            for k in range(count)
            for n in range(1, legs)
        )
        for mode in found.modes
    ]
    expected = product((0.0, round(4.0 * rise, 6)), repeat=count * (legs - 1))
    assert sorted(knees) == sorted(expected)
    assert found.picked is not None
    assert is_told(found.diagnostics)
    assert found.starts < 4 * MOST_STARTS * count


@pytest.mark.parametrize("count", [2, 3, 5])
def test_every_rhomb_stands_up_or_is_folded_down(count: int) -> None:
    found = mk.loads(scissors(count)).modes()
    assert len(found.modes) == 2 ** (count - 1)
    assert found.picked is not None
    assert is_told(found.diagnostics)
    assert found.starts < MOST_STARTS


@pytest.mark.parametrize("off", [1e-12, 1e-11, 1e-10, 1e-9, 1e-8])
@pytest.mark.parametrize("count", [2, 5])
def test_so_does_one_that_rounding_only_just_keeps_from_spinning(count: int, off: float) -> None:
    found = mk.loads(scissors(count, off)).modes()
    assert len(found.modes) == 2 ** (count - 1)
    assert is_told(found.diagnostics)
    assert found.starts < 4 * MOST_STARTS


def test_four_that_are_apart_are_all_listed() -> None:
    """The shoe's two places, with two of the rhomb each where it does not fold exactly."""
    found = mk.loads(scissors(2, 1e-5)).modes()
    assert len(found.modes) == 4
    assert found.complete
    assert not found.diagnostics


@pytest.mark.parametrize("count", [1, 2])
def test_near_a_stage_among_infinitely_many_assemblies(count: int) -> None:
    near = "assembly: {near: {B00.theta: 3}}\n"
    drawn = mk.loads(stages(count, 3)).analyze()
    found = mk.loads(stages(count, 3, near)).analyze()
    for name in ("B01.theta", "C02.theta"):
        expected, measured = drawn[name], found[name]
        assert measured == pytest.approx(expected, abs=1e-9)


def test_a_block_is_closed_alone() -> None:
    """Beside blocks that are not closed, which stay as they are; the worst condition of any block
    is that of the mechanism."""
    session = mk.loads(scissors(3)).session
    inputs, home = session.inputs.values[:, :1], home_state(session.layout)[:, None]
    whole = run(session.plan, RowInputs(inputs, home), Ask(Demand.CONDITION))
    assert whole.good.all()
    assert whole.condition is not None
    conditions = []
    for number in range(len(session.graph.blocks)):
        own = unknown_states(session.layout, number)
        given = whole.states.copy()
        for other in range(number, len(session.graph.blocks)):
            given[unknown_states(session.layout, other)] += 1e-3 if other == number else 0.5
        alone = run(session.plan, RowInputs(inputs, given), Ask(Demand.CONDITION, only=number))
        others = np.setdiff1d(np.arange(given.shape[0]), own)
        assert alone.good.all()
        assert alone.condition is not None
        assert alone.states[own] == pytest.approx(whole.states[own], abs=1e-12)
        assert (alone.states[others] == given[others]).all()
        conditions.append(float(alone.condition[0]))
    assert max(conditions) == pytest.approx(float(whole.condition[0]), rel=1e-9)
    assert min(conditions) < max(conditions)
    rates = np.ones_like(inputs)
    with pytest.raises(ValueError, match="one block alone"):
        run(session.plan, RowInputs(inputs, home, rates), Ask(Demand.VELOCITY, only=0))
