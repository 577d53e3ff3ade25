"""Closing equations and their derivatives over random boxes, against 40 digits.

    python tests/kernel/position_boxes.py [BOXES] [SEED]

closes every pair, and a weld beside it, between two bodies that hang on random tree joints, off the
closed position; residuals are written down from the frames' relative displacement, and derived
numerically, at random points of the box. None may lie outside its enclosure.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
from kernel.pairs import PAIRS, Matrix, mp, vector
from kernel.plans import TABLE, TREE_LETTERS, Chain, TreeJoint, exactly, exponential, frame

from mechkin_cli.kernel import _kernel

STEP = mp.mpf(10) ** -13
"""Of central differences of second order in 40 digits; off by about 1e-26."""


def exact_pose(generator: np.random.Generator) -> Matrix:
    """A frame with random axes, orthonormal to all digits, its origin in a box of side 1."""
    pose = exponential(generator.standard_normal(3).tolist(), (0.0, 0.0, 0.0))
    for i, c in enumerate(generator.uniform(-0.5, 0.5, 3).tolist()):
        pose[i, 3] = c
    return pose


def parts_of_constants(plan: Any, frames: list[Matrix]) -> tuple[np.ndarray, np.ndarray]:
    """What the plan's constants lack of the frames' numbers, of which they are the doubles, and how
    far the sums are off at most."""
    exact = {float(x): x for pose in frames for x in pose[:3, :]}
    rest = [exact.get(high, high) - mp.mpf(high) for high in plan.constants.tolist()]
    low = np.array([float(x) for x in rest])
    return low, np.abs(low) * 2.0**-53


def skew(m: Matrix) -> list[Any]:
    return [(m[2, 1] - m[1, 2]) / 2, (m[0, 2] - m[2, 0]) / 2, (m[1, 0] - m[0, 1]) / 2]


def residual(letter: str, m: Matrix) -> list[Any]:
    """The pair's closing equations, of the second frame's displacement against the first."""
    t, c = vector(m, 3), exactly(PAIRS[letter].parameter)
    s = mp.sqrt(1 - c * c)
    of_second = [sum(vector(m, k)[i] * t[i] for i in range(3)) for k in range(3)]
    parallel = [m[0, 2], m[1, 2]]
    equations: dict[str, list[Any]] = {
        "R": [*t, *parallel],
        "P": [t[0], t[1], *skew(m)],
        "C": [t[0], t[1], *parallel],
        "S": t,
        "Sp": [of_second[2]],
        "Sg": of_second[:2],
        "U": [*t, m[2, 2] - c],
        "Ss": [*t, m[2, 2]],
        "E": [t[2], *parallel],
        "W": [*t, *skew(m)],
        "Sc": [c * t[0] + s * t[1], t[2], m[2, 2]],
        "Cp": [of_second[2], m[2, 2]],
    }
    return equations[letter]


@dataclass
class Box:
    """A plan with a box about a random place: states (states, 1), radius (columns, 1), which of
    driven columns is that of their inputs."""

    letter: str
    chain: Chain
    frames: list[Matrix]
    driven: list[int]
    states: np.ndarray
    radius: np.ndarray

    def enclosed(self) -> tuple[np.ndarray, np.ndarray]:
        """Equations (equations, 3) and derivatives (equations, columns, 3)."""
        count = len(residual(self.letter, mp.eye(4))) + 6
        columns = self.chain.plan.columns
        equations, derivatives = np.empty((3 * count, 1)), np.empty((3 * count * columns, 1))
        radius, inputs = self.radius.copy(), np.zeros((3 * len(self.driven), 1))
        for number, column in enumerate(self.driven):
            inputs[3 * number] = self.states[self.state_of(column)]
            inputs[3 * number + 2] = radius[column]
            radius[column] = 0.0
        frames = [*self.frames, *(joint.at for joint in self.chain.joints)]
        low, radii = parts_of_constants(self.chain.plan, frames)
        given: dict[str, Any] = {"states": self.states, "inputs": inputs, "radius": radius}
        given |= {"low": low, "radii": radii}
        _kernel.enclose(self.chain.plan, **given, equations=equations, derivatives=derivatives)
        return equations.reshape(count, 3), derivatives.reshape(count, columns, 3)

    def place(self, parts: np.ndarray) -> list[Any]:
        """Increments of the columns at a point of the box, `parts` of its radii."""
        return [exactly(r) * exactly(t) for r, t in zip(self.radius[:, 0], parts, strict=True)]

    def state_of(self, column: int) -> int:
        for number in range(len(self.chain.joints)):
            columns, states = self.chain.columns_of(number), self.chain.states_of(number)
            if column in columns and len(columns) == len(states):
                return states[columns.index(column)]
        raise LookupError(column)

    def equations(self, increments: list[Any]) -> list[Any]:
        """Closing equations with the states moved from the middle by increments of the columns."""
        states = [exactly(x) for x in self.states[:, 0]]
        for number, joint in enumerate(self.chain.joints):
            own, at = self.chain.columns_of(number), self.chain.states_of(number)
            x = [increments[c] for c in own]
            if joint.letter == "S":
                q = [states[s] for s in at]
                for s, value in zip(at, product([mp.mpf(1), *(c / 2 for c in x)], q), strict=True):
                    states[s] = value
            else:
                for s, value in zip(at, x, strict=True):
                    states[s] += value
        poses = self.chain.poses(states)
        first, second = poses[2], poses[1]
        pair, weld = (
            mp.inverse(first * self.frames[k]) * second * self.frames[k + 1] for k in (0, 2)
        )
        return [*residual(self.letter, pair), *residual("W", weld)]


def product(a: list[Any], b: list[Any]) -> list[Any]:
    w, x, y, z = a
    return [
        w * b[0] - x * b[1] - y * b[2] - z * b[3],
        w * b[1] + x * b[0] + y * b[3] - z * b[2],
        w * b[2] - x * b[3] + y * b[0] + z * b[1],
        w * b[3] + x * b[2] - y * b[1] + z * b[0],
    ]


def random_box(letter: str, trees: tuple[str, str], generator: np.random.Generator) -> Box:
    """Links 0 and 1 hang on the two tree joints one after the other, link 2 on an R of its own."""
    joints = [TreeJoint(trees[0], -1, exact_pose(generator))]
    joints += [TreeJoint(trees[1], 0, exact_pose(generator))]
    chain = Chain.of([*joints, TreeJoint("R", -1, exact_pose(generator))])
    frames = [exact_pose(generator) for _ in range(4)]
    loop = [(0, 1.0), (1, 1.0), (2, -1.0)]
    for code, parameter, k in (
        (TABLE[letter]["code"], PAIRS[letter].parameter, 0),
        (TABLE["W"]["code"], 0.0, 2),
    ):
        ends = frame(frames[k]), frame(frames[k + 1])
        chain.builder.add_closing_joint(code, 2, 1, *ends, parameter, loop)
    balls = [c for n in range(3) if chain.joints[n].letter == "S" for c in chain.columns_of(n)]
    columns = [c for n in range(3) for c in chain.columns_of(n)]
    driven = [c for c in columns if c not in balls and generator.uniform() < 0.4][
        : len(columns) - 1
    ]
    unknown = [c for c in columns if c not in driven]
    chain.builder.add_block(2, [0, 1, 2], unknown)
    for column in driven:
        chain.drive(column)
    chain.finish()
    states = generator.uniform(-1.5, 1.5, (chain.plan.states, 1))
    width = 10.0 ** generator.uniform(-12, -0.5)
    radius = width * generator.uniform(0, 1, (chain.plan.columns, 1))
    return Box(letter, chain, frames, driven, states, radius)


def outside(box: Box, generator: np.random.Generator) -> int:
    """How many equations and derivatives at a random point are not in their enclosures."""
    equations, derivatives = box.enclosed()
    assert np.isfinite(derivatives).all()
    parts = generator.uniform(-1, 1, box.chain.plan.columns)
    if generator.uniform() < 0.3:
        parts = np.sign(parts)
    at = box.place(parts)
    wrong = sum(map(_is_outside, box.equations(at), equations))
    for column in range(len(at)):
        ends = []
        for sign in (1, -1):
            moved = list(at)
            moved[column] += sign * STEP
            ends.append(box.equations(moved))
        slopes = [(a - b) / (2 * STEP) for a, b in zip(*ends, strict=True)]
        wrong += sum(map(_is_outside, slopes, derivatives[:, column]))
    return wrong


def _is_outside(value: Any, enclosure: np.ndarray) -> bool:
    high, low, radius = map(exactly, enclosure)
    return bool(abs(value - high - low) > radius + mp.mpf(10) ** -24)


def combinations() -> Iterator[tuple[str, tuple[str, str]]]:
    """Every pair with every two tree joints, in an order in which few show many."""
    trees = list(itertools.product(TREE_LETTERS, repeat=2))
    for round_ in range(len(trees)):
        for number, letter in enumerate(TABLE):
            first, second = trees[(round_ + 7 * number) % len(trees)]
            if (first, second) != ("W", "W"):
                yield letter, (first, second)


def main() -> int:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    generator = np.random.default_rng(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    wrong = 0
    for letter, trees in itertools.islice(itertools.cycle(combinations()), count):
        found = outside(random_box(letter, trees, generator), generator)
        if found:
            print(f"{letter} closed by {trees}: {found} outside")
        wrong += found
    print(f"{count} boxes, {wrong} values outside")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
