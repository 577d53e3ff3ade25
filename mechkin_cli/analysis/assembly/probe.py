"""What assemblies look like: joint coordinates, joint points and size."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.model import GROUND_NAME
from mechkin_cli.mechanism.quantities import coordinate_quantities

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


class Probe:
    """Reads coordinates and joint points of assemblies."""

    def __init__(self, session: Session) -> None:
        self.session = session
        mechanism = session.problem.mechanism
        self.coordinates = list(mechanism.coordinates)
        self.points = [at for _, at in mechanism.joint_points() if at.link != GROUND_NAME]
        self.fixed = [at.vector for _, at in mechanism.joint_points() if at.link == GROUND_NAME]
        self.readout = session.readout(coordinate_quantities(mechanism), self.points)

    @classmethod
    def of(cls, session: Session) -> Probe:
        """The session's probe, made once."""
        return session.once("probe", lambda: cls(session))

    def read(self, inputs: Floats, states: Floats) -> tuple[dict[str, Floats], Floats]:
        """Coordinates by name (SI) and the joint points of the moving links (points, 3,
        assemblies)."""
        values = np.repeat(inputs[:, None], states.shape[1], axis=1)
        batch = self.session.run(values, states, readout=self.readout)
        assert batch.outputs is not None
        out = batch.outputs
        coordinates = {name: out[self.readout.slots[name].first] for name in self.coordinates}
        points = np.array([out[slot : slot + 3] for slot in self.readout.points])
        # welds have no point
        return coordinates, points.reshape(len(self.points), 3, states.shape[1])

    def size(self, inputs: Floats, state: Floats) -> float:
        """Diagonal of the box of all joint points, in m; 1 if they coincide."""
        _, points = self.read(inputs, state[:, None])
        every = np.concatenate([points[:, :, 0], np.array(self.fixed).reshape(-1, 3)])
        extent = every.max(axis=0) - every.min(axis=0)
        x, y, z = (float(e) for e in extent)
        return sqrt(x * x + y * y + z * z) or 1.0
