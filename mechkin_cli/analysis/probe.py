"""What assemblies look like: joint coordinates, joint points and size."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.solver.layout import Layout

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


class Probe:
    """Reads coordinates and joint points of assemblies."""

    def __init__(self, problem: Problem, layout: Layout) -> None:
        self.layout = layout
        self.plan = layout.build()
        self.outputs = OutputPlan(layout, self.plan, problem.motion.driven)
        quantities = problem.quantities()
        self.coordinates = list(problem.mechanism.coordinates)
        for name in self.coordinates:
            self.outputs.add(quantities[name])
        self.points = [at for _, at in layout.mechanism.joint_points() if at.link != "ground"]
        self.point_slots = [self.outputs.add_point(at, 0) for at in self.points]

    def read(self, inputs: Floats, states: Floats) -> tuple[dict[str, Floats], Floats]:
        """Coordinates by name (SI) and the joint points of the moving links (points, 3,
        assemblies)."""
        values = np.repeat(inputs[:, None], states.shape[1], axis=1)
        batch = run(self.plan, values, states, outputs=self.outputs.outputs)
        assert batch.outputs is not None
        out = batch.outputs
        coordinates = {name: out[self.outputs.slots[name].first] for name in self.coordinates}
        points = np.stack([out[slot : slot + 3] for slot in self.point_slots])
        return coordinates, points

    def size(self, inputs: Floats, state: Floats) -> float:
        """Diagonal of the box of all joint points, in m; 1 if they coincide."""
        _, points = self.read(inputs, state[:, None])
        fixed = [at.vector for _, at in self.layout.mechanism.joint_points() if at.link == "ground"]
        every = np.concatenate([points[:, :, 0], np.array(fixed).reshape(-1, 3)])
        extent = every.max(axis=0) - every.min(axis=0)
        x, y, z = (float(e) for e in extent)
        return sqrt(x * x + y * y + z * z) or 1.0
