"""Loops in long rows are eliminated one after the other: steps, motions and ranks as those of a
dense factorisation by NumPy, and mobility as the count says."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from structure.networks import Network, parallelograms, shuffled, spatial_train, turn, windows

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.mobility.configurations import Body, LoopPart, home
from mechkin_cli.mobility.elimination import DampedTriangle, Fronts, regular_motions

NETWORKS: dict[str, Callable[[], Network]] = {
    "windows": lambda: windows(70),
    "shuffled windows": lambda: shuffled(windows(70), 3),
    "parallelograms": lambda: parallelograms(20),
    "spatial train": lambda: spatial_train(24),
}


def undriven(network: Network, *, plane: bool) -> str:
    text = network.plane_text if plane else network.text
    return text[: text.index("motion:")]


def part_of(text: str) -> tuple[Body, LoopPart]:
    body = Body(mk.loads(text).problem.mechanism)
    return body, max(body.parts, key=lambda part: part.count)


def fronts_of(part: LoopPart) -> Fronts:
    assert part.fronts is not None
    return part.fronts


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.parametrize("off", [0.0, 0.01])
def test_steps_are_least_squares(name: str, off: float) -> None:
    body, part = part_of(undriven(NETWORKS[name](), plane="spatial" not in name))
    random = np.random.default_rng(5)
    moves = off * random.normal(size=(2, part.count))
    states = part.moved(np.repeat(home(body).state[None], 2, axis=0), moves)
    _, jacobians = part.closing(states)
    misses = random.normal(size=jacobians.shape[:2]) * np.any(jacobians != 0.0, axis=2)
    damping = np.array([1e-3, 0.3])
    triangle = DampedTriangle(fronts_of(part), jacobians, misses, damping)
    right = random.normal(size=(2, part.count, 3))
    steps, normal = triangle.solution(), triangle.normal_solution(right)
    for k, jacobian in enumerate(jacobians):
        whole = np.concatenate([jacobian, damping[k] * np.eye(part.count)])
        sides = np.concatenate([-misses[k], np.zeros(part.count)])
        expected = np.linalg.lstsq(whole, sides, rcond=None)[0]
        np.testing.assert_allclose(steps[k], expected, atol=1e-10 * np.abs(expected).max())
        expected = np.linalg.solve(whole.T @ whole, right[k])
        np.testing.assert_allclose(normal[k], expected, atol=1e-8 * np.abs(expected).max())


def test_motions_of_a_long_row_are_its_null_space() -> None:
    body, part = part_of(undriven(windows(70), plane=True))
    _, (jacobian,) = part.closing(home(body).state[None])
    motions = regular_motions(fronts_of(part), jacobian, tolerances.RANK_ZERO)
    assert motions is not None
    _, values, right = np.linalg.svd(jacobian)
    rank = int(np.count_nonzero(values > 1e-8 * values[0]))
    space = right[rank:].T
    assert motions.shape == space.shape == (part.count, 1)
    np.testing.assert_allclose(motions @ motions.T, space @ space.T, atol=1e-12)


@pytest.mark.parametrize("size", [1e-13, 1e-9, 2e-6])
def test_equations_that_nearly_depend_on_others_are_left_to_all_at_once(size: float) -> None:
    """One equation repeats another but for a part of this size."""
    body, part = part_of(undriven(windows(70), plane=True))
    _, (jacobian,) = part.closing(home(body).state[None])
    told = np.flatnonzero(np.any(jacobian != 0.0, axis=1))
    one, other = told[60:62]
    jacobian[one] = jacobian[other] + size * jacobian[one]
    zero = tolerances.MOBILITY_RANK_REACHED
    assert regular_motions(fronts_of(part), jacobian, zero) is None
    left = int(np.linalg.matrix_rank(jacobian, 1e-5 * np.linalg.norm(jacobian, 2)))
    assert part.rank(jacobian, zero).motions.shape[1] == part.count - left


@pytest.mark.parametrize("count", [20, 100])
def test_mobility_of_a_long_row(count: int) -> None:
    """As Kutzbach counts: one freedom, and none where a bar across one of the first four-bars locks
    it. Those at the end hardly move, since each turns less than that before."""
    text = undriven(windows(count), plane=True)
    bar = (
        "  L0: {type: R, links: [ground, lock], point: [13, -1]}\n"
        "  L1: {type: R, links: [lock, b3], point: [14, 1.2]}\n"
    )
    for own, freedom in (text, 1), (text.replace("links: {", "links: {lock: {}, ", 1) + bar, 0):
        found = mk.loads(own).mobility()
        assert found.mobility == found.count == freedom
        assert found.redundant == ()
        assert found.idle == ()


def with_triangles(network: Network, every: int) -> tuple[Network, set[str]]:
    """Bars that stand as a triangle on rockers at equal distances, and their joints."""
    links, joints, still = [*network.links], dict(network.joints), set()
    for k in range(0, network.loops, every):
        links += [f"p{k}", f"q{k}"]
        joints[f"P{k}"] = turn(f"c{k}", f"p{k}", (4 * k + 0.1, 0.6, 0))
        joints[f"Q{k}"] = turn(f"p{k}", f"q{k}", (4 * k + 0.7, 0.8, 0))
        joints[f"R{k}"] = turn(f"q{k}", f"c{k}", (4 * k + 0.2, 0.2, 0))
        still |= {f"P{k}.theta", f"Q{k}.theta", f"R{k}.theta"}
    return network._replace(links=links, joints=joints), still


@pytest.mark.parametrize(("count", "plane"), [(20, False), (20, True), (60, True), (150, True)])
def test_what_never_moves_is_told_from_what_hardly_moves(count: int, plane: bool) -> None:
    """Rockers a hundred windows on move by 1e-14 of the first; triangles on them not at all."""
    network, still = with_triangles(windows(count), 9)
    for one in (network, shuffled(network, 1, renamed=False)):
        assert set(mk.loads(undriven(one, plane=plane)).mobility().fixed) == still
    assert mk.loads(undriven(windows(count), plane=plane)).mobility().fixed == ()


def test_inputs_that_hardly_move_are_neither_locked_nor_independent() -> None:
    first, last = "O0.theta", "O90.theta"
    driven = windows(90)._replace(inputs=[last])
    assert mk.loads(driven.plane_text).mobility().diagnostics == ()
    (note,) = mk.loads(driven._replace(inputs=[first, last]).plane_text).mobility().diagnostics
    assert str(note).startswith("error: the inputs O0.theta, O90.theta are not independent: 2 in")
    network, _ = with_triangles(driven, 9)
    locked = network._replace(inputs=["P81.theta"])
    notes = mk.loads(locked.plane_text).mobility().diagnostics
    assert [each.code for each in notes] == ["input-locked", "undriven-freedom"]
    assert f"candidates: {first}, " in notes[1].message
