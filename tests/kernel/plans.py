"""Small plans for the kernel, built directly: serial chains, closed and open, with random frames.

The unit of length is 2 m and the kernel's origin lies off the ground's, so that a forgotten scale
or shift shows. Poses are 4 x 4; those that go into a plan are rounded to doubles first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from kernel.pairs import PAIRS, PITCH, O, Z, exponential, mp, vector

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.codes import Demand, OutputCode

TABLE = {entry["letter"]: entry for entry in _kernel.joint_table()}
LENGTH = 2.0
ORIGIN = (0.5, -1.25, 0.75)
EVERYTHING = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES


def doubles(m: Any) -> Any:
    """A matrix rounded to doubles."""
    return mp.matrix([[float(m[i, j]) for j in range(m.cols)] for i in range(m.rows)])


def random_pose(generator: np.random.Generator) -> Any:
    """A frame with random axes, its origin in a box of side 1."""
    axis = generator.standard_normal(3).tolist()
    turned = exponential(axis, O)
    for i, c in enumerate(generator.uniform(-0.5, 0.5, 3).tolist()):
        turned[i, 3] = c
    return doubles(turned)


def frame(m: Any) -> list[float]:
    """A pose as the kernel takes frames: axes x, y, z, origin."""
    return [float(c) for column in range(4) for c in vector(m, column)]


@dataclass(frozen=True)
class TreeJoint:
    """A joint of a chain: its letter, the link that carries it and its frame in that link."""

    letter: str
    parent: int
    at: Any


@dataclass
class Chain:
    """A plan under construction with what the tests must know of it."""

    plan: Any
    joints: list[TreeJoint]

    @staticmethod
    def of(joints: list[TreeJoint]) -> Chain:
        plan = _kernel.Plan(LENGTH, ORIGIN, LENGTH)
        for number, joint in enumerate(joints):
            place = _kernel.Place(joint.parent, number, O, Z, 1.0)
            code = TABLE[joint.letter]["code"]
            pitch = PITCH if joint.letter == "H" else 0.0
            plan.add_tree_joint(code, joint.parent, pitch, frame(joint.at), place)
        return Chain(plan, joints)

    def drive(self, column: int, *, along_axis: bool | None = None) -> None:
        """Makes a column an input; the drive acts along the axis of a slide, else about it."""
        if along_axis is None:
            number = next(k for k in range(len(self.joints)) if column in self.columns_of(k))
            freedom = column - self.columns_of(number)[0]
            along_axis = bool(TABLE[self.joints[number].letter]["slides"] >> freedom & 1)
        self.plan.add_input(column, along_axis)

    def columns_of(self, number: int) -> range:
        """Columns of a tree joint."""
        sizes = [TABLE[joint.letter]["freedoms"] for joint in self.joints]
        return range(sum(sizes[:number]), sum(sizes[: number + 1]))

    def states_of(self, number: int) -> range:
        """States of a tree joint."""
        sizes = [TABLE[joint.letter]["states"] for joint in self.joints]
        return range(sum(sizes[:number]), sum(sizes[: number + 1]))

    def poses(self, states: Any, first: Any = None, second: Any = None, time: Any = 0) -> list[Any]:
        """Poses of the links by the product of exponentials of the home screws.

        `states` (states,), `first` and `second` (columns,) of one row; `time` moves along them.
        """
        homes: list[Any] = []
        moves: list[Any] = []
        for number, joint in enumerate(self.joints):
            q = [mp.mpf(float(states[s])) for s in self.states_of(number)]
            columns = self.columns_of(number)
            v = [mp.mpf(0 if first is None else float(first[c])) for c in columns]
            a = [mp.mpf(0 if second is None else float(second[c])) for c in columns]
            home = joint.at if joint.parent < 0 else homes[joint.parent] * joint.at
            local = PAIRS[joint.letter].moving(q, v, a, time)
            about_home = home * local * mp.inverse(home)
            before = mp.eye(4) if joint.parent < 0 else moves[joint.parent]
            homes.append(home)
            moves.append(before * about_home)
        return [move * home for move, home in zip(moves, homes, strict=True)]

    def output(self, code: OutputCode, index: int, order: int = 0, data: Any = O) -> slice:
        """Plans an output without scaling; returns its slots."""
        begin = self.plan.add_output(int(code), index, order, tuple(map(float, data)), 1.0)
        return slice(begin, self.plan.slots)


@dataclass(frozen=True)
class Run:
    """What the kernel returned, one column per row."""

    states: Any
    outputs: Any
    first: Any
    second: Any
    residual: Any
    condition: Any
    flags: Any


def run(
    chain: Chain,
    inputs: Any,
    guess: Any,
    *,
    rates: Any = None,
    accelerations: Any = None,
    demand: Demand = Demand.POSITION,
    iterations: int = 6,
    accept: float = 1e-14,
) -> Run:
    """Runs a plan over the rows of `inputs` (inputs, rows) and `guess` (states, rows)."""
    plan, rows = chain.plan, inputs.shape[1]
    result = Run(
        np.full((plan.states, rows), np.nan),
        np.full((plan.slots, rows), np.nan),
        np.zeros((plan.columns, rows)),
        np.zeros((plan.columns, rows)),
        np.full(rows, np.nan),
        np.full(rows, np.nan),
        np.zeros(rows, dtype=np.uint8),
    )
    plan.run(
        inputs,
        rates,
        accelerations,
        guess,
        result.states,
        result.outputs,
        result.first,
        result.second,
        result.residual,
        np.empty(rows),
        None,
        result.condition,
        np.empty(rows),
        result.flags,
        int(demand),
        iterations,
        (1e-16, 1e-8, accept),
        0,
    )
    return result
