"""Small plans for the kernel, built directly: serial chains, closed and open, with random frames.

The unit of length is 2 m and the kernel's origin lies off the ground's, so that a forgotten scale
or shift shows. Poses are 4 x 4; those that go into a plan are rounded to doubles first.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from kernel.pairs import ELEMENTARY, PITCH, O, Z, exponential, mp, vector

from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism.pairs import JOINT_TYPES, PLANE_JOINT_TYPES
from mechkin_cli.plan.records import Demand, Output, OutputCode, hand_over_outputs

_CLOSING = {entry["letter"]: entry for entry in _kernel.joint_table()}
TABLE = {letter: _CLOSING[kind.closing] for letter, kind in JOINT_TYPES.items() if kind.closing}
"""The kernel's entry of every pair that closes loops."""
PLANE_TABLE = {letter: _CLOSING[kind.closing or ""] for letter, kind in PLANE_JOINT_TYPES.items()}
"""That of every pair of a plane."""
TREE_LETTERS = "RPHCSW"
"""Elementary displacements in the order of the kernel's codes."""
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


def exactly(x: Any) -> Any:
    return x if isinstance(x, mp.mpf) else mp.mpf(float(x))


def floats(values: Any) -> tuple[float, ...]:
    return tuple(float(v) for v in values)


def frame(m: Any) -> list[float]:
    """A pose as the kernel takes frames: axes x, y, z, origin."""
    return [float(c) for column in range(4) for c in vector(m, column)]


@dataclass(frozen=True)
class TreeJoint:
    """An elementary displacement of a chain: its letter, the body that carries it and its frame
    there."""

    letter: str
    parent: int
    at: Any


@dataclass
class Chain:
    """A plan under construction with what the tests must know of it.

    Every tree joint has a place (its own number) with the point at its frame's origin, and every
    column that is no turn of a sphere has an axis there.
    """

    builder: Any
    joints: list[TreeJoint]
    axes: dict[int, int]
    records: list[Output] = field(default_factory=list)
    slots: int = 0
    plan: Any = None

    @staticmethod
    def of(joints: list[TreeJoint]) -> Chain:
        chain = Chain(_kernel.PlanBuilder(LENGTH, ORIGIN, LENGTH), joints, {})
        for joint in joints:
            pitch = PITCH if joint.letter == "H" else 0.0
            code = TREE_LETTERS.index(joint.letter)
            chain.builder.add_tree_joint(code, joint.parent, pitch, frame(joint.at))
        for number, joint in enumerate(joints):
            chain.builder.add_place(number, joint.parent, number, number, floats(O), 1.0)
            for column, (angular, _) in zip(
                chain.columns_of(number), ELEMENTARY[joint.letter].screws, strict=True
            ):
                if joint.letter != "S":
                    along = not any(angular)
                    chain.axes[column] = chain.axis(number, number, Z, along_axis=along)
        return chain

    def axis(self, place: int, link: int, direction: Any, *, along_axis: bool) -> int:
        """Adds an axis of a place, carried by a link: a force along it or a couple about it."""
        return int(
            self.builder.add_axis(place, along_axis, link, floats(direction), link, floats(O))
        )

    def drive(self, column: int) -> None:
        """Makes a column an input."""
        self.builder.add_input(column, self.axes[column], 1.0)

    def columns_of(self, number: int) -> range:
        """Columns of a tree joint."""
        sizes = [len(ELEMENTARY[joint.letter].screws) for joint in self.joints]
        return range(sum(sizes[:number]), sum(sizes[: number + 1]))

    def states_of(self, number: int) -> range:
        """States of a tree joint."""
        sizes = [ELEMENTARY[joint.letter].states for joint in self.joints]
        return range(sum(sizes[:number]), sum(sizes[: number + 1]))

    def poses(self, states: Any, first: Any = None, second: Any = None, time: Any = 0) -> list[Any]:
        """Poses of the links by the product of exponentials of the home screws.

        `states` (states,), `first` and `second` (columns,) of one row; `time` moves along them.
        """
        homes: list[Any] = []
        moves: list[Any] = []
        for number, joint in enumerate(self.joints):
            q = [exactly(states[s]) for s in self.states_of(number)]
            columns = self.columns_of(number)
            v = [mp.mpf(0 if first is None else float(first[c])) for c in columns]
            a = [mp.mpf(0 if second is None else float(second[c])) for c in columns]
            home = joint.at if joint.parent < 0 else homes[joint.parent] * joint.at
            local = ELEMENTARY[joint.letter].moving(q, v, a, time)
            about_home = home * local * mp.inverse(home)
            before = mp.eye(4) if joint.parent < 0 else moves[joint.parent]
            homes.append(home)
            moves.append(before * about_home)
        return [move * home for move, home in zip(moves, homes, strict=True)]

    def output(
        self, code: OutputCode, index: int, order: int = 0, data: Any = O, freedom: int = 0
    ) -> slice:
        """Plans an output without scaling; returns its slots."""
        begin = self.slots
        self.records.append(Output(code, index, freedom, order, floats(data), 1.0))
        self.slots += _kernel.output_width(code)
        return slice(begin, self.slots)

    def finish(self) -> None:
        """Freezes the plan; outputs may still come."""
        self.plan = self.builder.finish()


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
    shift: int = 0,
    lanes: int = 0,
    iterations: int = 6,
    accept: float = 1e-14,
) -> Run:
    """Runs a plan over the rows of `inputs` (inputs, rows) and `guess` (states, rows)."""
    plan, rows = chain.plan, inputs.shape[1]
    outputs = hand_over_outputs(plan, chain.records)
    served = outputs.demand & demand == outputs.demand
    moving, with_condition = demand & Demand.VELOCITY, demand & Demand.CONDITION
    result = Run(
        np.full((plan.states, rows), np.nan),
        np.full((outputs.slots, rows), np.nan),
        np.zeros((plan.columns, rows)),
        np.zeros((plan.columns, rows)),
        np.full(rows, np.nan),
        np.full(rows, np.nan),
        np.zeros(rows, dtype=np.uint8),
    )
    plan.run(
        inputs=inputs,
        rates=rates,
        accelerations=accelerations,
        guess=guess,
        states=result.states,
        outputs=outputs if served else None,
        values=result.outputs if served else None,
        first=result.first if moving else None,
        second=result.second if demand & Demand.ACCELERATION else None,
        residual=result.residual,
        correction=np.empty(rows),
        condition=result.condition if with_condition else None,
        flags=result.flags,
        demand=int(demand),
        shift=shift,
        iterations=iterations,
        tests=(1e-16, 1e-8, accept),
        lanes=lanes,
    )
    return result
