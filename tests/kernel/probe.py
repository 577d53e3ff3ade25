"""A closing joint on a link that can be given any pose.

Link 0 rides on a driven R, links 1 to 6 on three slides and three turns; the closing joint lies
between 0 and 6. As many slides and turns are driven as the pair has.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from kernel.pairs import ALONG_X, PAIRS, mp, vector
from kernel.plans import (
    EVERYTHING,
    TABLE,
    Chain,
    Run,
    TreeJoint,
    doubles,
    floats,
    frame,
    random_pose,
    run,
)

from mechkin_cli.mechanism.pairs import JOINT_TYPES
from mechkin_cli.plan.records import RowFlag

SEEDS = list(JOINT_TYPES)
MOVED = 6
"""Number of the link that the six probing joints carry."""


def held(letter: str) -> list[int]:
    """Probing joints that are driven: one slide per slide of the pair, one turn per turn."""
    slides = sum(PAIRS[letter].slides)
    turns = PAIRS[letter].freedoms - slides
    return [*range(1, 1 + slides), *range(4, 4 + turns)]


class Probe:
    """The plan, and states that give the pair's second frame a displacement against its first."""

    def __init__(self, letter: str, seed: int) -> None:
        generator = np.random.default_rng([seed, SEEDS.index(letter)])
        self.pair = PAIRS[letter]
        self.base = random_pose(generator)
        joints = [TreeJoint("R", -1, random_pose(generator))]
        for k, each in enumerate("PPPRRR"):
            at = ALONG_X if k else doubles(self.base * ALONG_X)
            joints.append(TreeJoint(each, k if k else -1, at))
        self.chain = chain = Chain.of(joints)
        self.on_first, self.on_second = random_pose(generator), random_pose(generator)
        loop = [(k, 1.0) for k in range(1, 7)] + [(0, -1.0)]
        ends = frame(self.on_first), frame(self.on_second)
        code, parameter = TABLE[letter]["code"], self.pair.parameter
        chain.builder.add_closing_joint(code, 0, MOVED, *ends, parameter, loop)
        first = self.pair.point_on_first
        point = floats(vector(self.on_first if first else self.on_second, 3))
        self.place = chain.builder.add_place(-1, 0, MOVED, 0 if first else MOVED, point, 1.0)
        self.driven = [0, *held(letter)]
        unknown = [c for c in range(7) if c not in self.driven]
        chain.builder.add_block(1, list(range(7)), unknown)
        for column in self.driven:
            chain.drive(column)
        self.carrier_angle = generator.uniform(-1.5, 1.5)
        self.own = self.pair.random_state(generator)
        self.generator = generator

    def finish(self) -> Probe:
        self.chain.finish()
        return self

    def states(self, displacement: Any) -> np.ndarray:
        """States that displace the pair's second frame against its first as given."""
        carrier = self.chain.poses([self.carrier_angle, *[0] * 6])[0]
        target = carrier * self.on_first * displacement * mp.inverse(self.on_second)
        m = mp.inverse(self.base) * target
        angles = mp.atan2(-m[1, 2], m[2, 2]), mp.asin(m[0, 2]), mp.atan2(-m[0, 1], m[0, 0])
        return np.array([self.carrier_angle, *map(float, vector(m, 3)), *map(float, angles)])

    def run(self, states: np.ndarray, **options: Any) -> Run:
        """One row from a guess; its driven coordinates are the guess's."""
        guess = np.ascontiguousarray(states[:, None])
        return run(self.chain, np.ascontiguousarray(guess[self.driven]), guess, **options)

    def displacement(
        self, states: Any, first: Any = None, second: Any = None, time: Any = 0
    ) -> Any:
        """Displacement of the pair's second frame against its first."""
        poses = self.chain.poses(states, first, second, time)
        return mp.inverse(poses[0] * self.on_first) * poses[MOVED] * self.on_second

    def off_motion(self, displacement: Any) -> Any:
        """How far a displacement is off the pair's own motion, as a matrix."""
        return displacement * mp.inverse(self.pair.nearest(displacement)) - mp.eye(4)

    def moving(self) -> Run:
        """A closed row with random rates, accelerations and everything else demanded."""
        count = len(self.driven)
        result = self.run(
            self.states(self.pair.displacement(self.own)),
            rates=self.generator.uniform(-1, 1, (count, 1)),
            accelerations=self.generator.uniform(-1, 1, (count, 1)),
            demand=EVERYTHING,
        )
        assert result.flags[0] == RowFlag.GOOD
        assert np.all(np.isfinite([*result.first, *result.second]))
        return result


def largest(m: Any) -> float:
    return float(max(abs(c) for c in m))
