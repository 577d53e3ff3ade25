"""Assemblies of a body on six rods of fixed length: from every drawing the same number, checked by
Newton's method on another formulation from many starts."""

from __future__ import annotations

import random

import numpy as np
import pytest
from numpy.typing import NDArray

import mechkin_cli as mk

Floats = NDArray[np.float64]


def rotation(q: Floats) -> Floats:
    w, x, y, z = q / np.sqrt(q @ q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def ends(seed: int) -> tuple[Floats, Floats]:
    """Feet on ground and heads on the body, (6, 3) each."""
    rng = random.Random(seed)
    feet = [[rng.uniform(-1, 1) for _ in range(3)] for _ in range(6)]
    heads = [
        [rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1) + rng.choice([0.5, 1.5])]
        for _ in range(6)
    ]
    return np.array(feet), np.array(heads)


def platform(seed: int, turn: Floats | None = None) -> mk.Model:
    """Drawn assembled, or with the body turned and shifted away from its rods."""
    feet, heads = ends(seed)
    body = heads if turn is None else heads @ rotation(turn).T + [0.3, -0.2, 0.5]
    links = "".join(f", rod{k}: {{}}" for k in range(6))
    joints = ""
    for k in range(6):
        foot, head, far = (list(map(float, v[k])) for v in (feet, heads, body))
        joints += f"  A{k}: {{type: S, links: [ground, rod{k}], point: {foot}}}\n"
        joints += (
            f"  B{k}: {{type: S, links: [rod{k}, body], point: {{rod{k}: {head}, body: {far}}}}}\n"
        )
    return mk.loads(f"format: 1\nlinks: {{body: {{}}{links}}}\njoints:\n{joints}")


def newton_step(feet: Floats, heads: Floats, r: Floats, t: Floats) -> tuple[Floats, Floats]:
    """One step for matrices r (starts, 3, 3) and shifts t (starts, 3): 6 lengths, r^T r = 1."""
    squares = ((heads - feet) ** 2).sum(axis=1)
    i, j = np.triu_indices(3)
    rows = np.arange(6)
    d = heads @ r.transpose(0, 2, 1) + t[:, None] - feet
    gap = r.transpose(0, 2, 1) @ r - np.eye(3)
    value = np.concatenate([(d * d).sum(axis=2) - squares, gap[:, i, j]], axis=1)
    matrix = np.zeros((len(r), 12, 12))
    matrix[:, :6, :9] = 2 * np.einsum("ska,kb->skab", d, heads).reshape(-1, 6, 9)
    matrix[:, :6, 9:] = 2 * d
    for a in range(3):
        matrix[:, 6 + rows, 3 * a + i] += r[:, a, j]
        matrix[:, 6 + rows, 3 * a + j] += r[:, a, i]
    step = np.linalg.solve(matrix, -value[:, :, None])[:, :, 0]
    step *= np.minimum(1.0, 1.0 / np.abs(step).max(axis=1, keepdims=True))
    return step[:, :9].reshape(-1, 3, 3), step[:, 9:]


def other_count(seed: int, starts: int) -> int:
    """Newton's method for rotation matrix and shift from many starts at once, 12 unknowns."""
    feet, heads = ends(seed)
    rng = np.random.default_rng(seed)
    r = np.array([rotation(rng.normal(size=4)) for _ in range(starts)])
    t = rng.uniform(-3, 3, (starts, 3))
    found: list[Floats] = []
    for _ in range(60):
        turn, shift = newton_step(feet, heads, r, t)
        r, t = r + turn, t + shift
        last = np.maximum(np.abs(turn).max(axis=(1, 2)), np.abs(shift).max(axis=1))
        done = last < 1e-12
        for pose in np.concatenate([r.reshape(-1, 9), t], axis=1)[done]:
            proper = np.linalg.det(pose[:9].reshape(3, 3)) > 0
            if proper and all(np.abs(pose - p).max() > 1e-6 for p in found):
                found.append(pose)
        r, t = r[~done], t[~done]
        if not len(r):
            break
    return len(found)


@pytest.mark.parametrize("seed", [1, 7])
def test_assemblies_of_a_platform(seed: int) -> None:
    assembled = platform(seed).modes()
    apart = platform(seed, np.array([0.3, -0.5, 0.2, 0.7])).modes()
    assert len(assembled.modes) == len(apart.modes) == other_count(seed, 1500)
    assert assembled.bound == 40
    assert max(mode.residual for mode in (*assembled.modes, *apart.modes)) <= 1e-13
