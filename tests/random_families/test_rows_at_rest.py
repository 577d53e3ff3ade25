"""Rows at rest of random mechanisms with springs: each is an equilibrium of the assembly that it
shows, by an energy of the tests' own, and no row depends on how far apart rows are.
MECHKIN_RANDOM=25 takes five hundred."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import numpy as np
import pytest
from random_families.four_bars import TURN, cases
from random_families.sprung_loops import SprungLoop, arm, plane_four_bar, rssr

import mechkin_cli as mk
from mechkin_cli.show import Floats

H = 1e-4


def _slope(energy: Callable[[float], float], x: float) -> float:
    far, near = energy(x + 2 * H) - energy(x - 2 * H), energy(x + H) - energy(x - H)
    return (8 * near - far) / (12 * H)


def _at_rest(loop: SprungLoop) -> None:
    r = mk.loads(loop.text + "motion: {rest: [A.theta]}\n").analyze()
    if not r.result.solved.all():
        return  # nothing is told, then
    name, energies = loop.by_output
    theta, out = float(r["A.theta"][0]), float(r[name][0])
    # the assembly that is shown is the one in which this output goes with this coordinate
    misses = [abs(math.remainder(energy(out)[1] - theta, TURN)) for energy in energies]
    own = energies[int(np.nanargmin(misses))]
    assert min(misses) < 1e-8
    level = own(out)[0]
    # by the coordinate, too: next to a dead centre of one the energy has no rate by it
    slopes = [_slope(lambda phi: own(phi)[0], out)]
    slopes += [_slope(e, theta) for e in loop.energies if abs(e(theta) - level) < 1e-7]
    assert np.nanmin(np.abs(slopes)) < 1e-6 * (1.0 + abs(level))


@pytest.mark.parametrize("rng", [*cases(811, 12)])
def test_plane_four_bars_balance_as_they_are_shown(rng: random.Random) -> None:
    _at_rest(plane_four_bar(rng))


@pytest.mark.parametrize("rng", [*cases(812, 8)])
def test_spatial_four_bars_balance_as_they_are_shown(rng: random.Random) -> None:
    _at_rest(rssr(rng))


def _swept(text: str, near: float, first: float, last: float, count: int) -> Floats:
    sweep = (
        f"motion: {{inputs: {{A.theta: {{from: {first}, to: {last}, count: {count}}}}}, "
        f"rest: [B.theta]}}\nassembly: {{near: {{B.theta: {near}}}}}\n"
    )
    return np.asarray(mk.loads(text + sweep).analyze(["B.theta"])["B.theta"])


@pytest.mark.parametrize("rng", [*cases(813, 20)])
def test_rows_at_rest_do_not_depend_on_their_distance(rng: random.Random) -> None:
    own = arm(rng)
    near, first = rng.uniform(-2, 2), rng.uniform(-3, 0)
    last, count = first + rng.uniform(1, 5), rng.randint(4, 9)
    few = _swept(own.text, near, first, last, count)
    many = _swept(own.text, near, first, last, 9 * (count - 1) + 1)[::9]
    # rows behind a fold are empty in both
    np.testing.assert_allclose(few, many, atol=1e-8)
    back = _swept(own.text, float(few[-1]), last, first, count) if np.isfinite(few).all() else None
    if back is not None:
        turns = np.round((back[::-1] - few) / TURN) * TURN
        np.testing.assert_allclose(back[::-1] - turns, few, atol=1e-8)


@pytest.mark.parametrize("rng", [*cases(814, 40)])
def test_rows_under_a_growing_load_do_not_depend_on_their_distance(rng: random.Random) -> None:
    own = plane_four_bar(rng)
    moment, count = round(rng.choice([-1, 1]) * rng.uniform(2, 60), 2), rng.randint(3, 8)
    load = f'  - {{type: torque, joint: A, value: "{moment} N*m/s*time"}}\n'

    def swept(rows: int) -> tuple[Floats, bool]:
        motion = f"motion: {{time: {{from: 0, to: 1, count: {rows}}}, rest: [A.theta]}}\n"
        r = mk.loads(own.text + load + motion).analyze(["A.theta"])
        lost = any(one.code == "rest-lost" for one in r.diagnostics)
        return np.asarray(r["A.theta"]), lost

    (few, few_lost), (many, many_lost) = swept(count), swept(9 * (count - 1) + 1)
    many = many[::9]
    # a hair beside a dead centre of the coordinate a branch may be lost, which is told
    same = np.isfinite(few) & np.isfinite(many)
    np.testing.assert_allclose(few[same], many[same], atol=1e-8)
    if not (few_lost or many_lost):
        np.testing.assert_array_equal(np.isfinite(few), np.isfinite(many))
