"""Rows one after the other, as a script solves them: each from the row before.

Closures are 4x4 matrices of doubles; the first row starts from its own closed coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.benchmark.closure import Matrices, Placing
from mechkin_cli.benchmark.truth import BALL, State, coordinates_of, named_values

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene, Values
    from mechkin_cli.show import Floats


MANY_UNKNOWNS = 12
"""Beyond, differences of the whole closure in Python take tens of milliseconds a row."""

Gap = Callable[["Floats"], "Floats"]
Solve = Callable[[Gap, "Floats"], "Floats"]
"""From the gap as a function of the unknowns, and a start, to the unknowns. They are counted so
that the start is 1: solvers take their differences in parts of the unknowns."""


class RowByRow:
    """A scene for solvers of one row at a time."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.chain = scene, scene.chain
        self.placing = Placing(self.chain, Matrices())
        self.unknowns = list(self.chain.unknowns)
        self.driven = list(self.chain.inputs)
        lengths = [self.chain.coordinates[k].is_length for k in self.driven]
        units = np.where(lengths, self.chain.length, 1.0)[:, None]
        inputs = scene.session.inputs
        self.inputs: Floats = inputs.values[:, scene.places] * units
        self.rates: Floats = inputs.rates[:, scene.places] * units
        self.accelerations: Floats = inputs.accelerations[:, scene.places] * units
        values, turned = coordinates_of(scene, slice(0, 1))
        self.start: Floats = values[:, 0]
        self.turned = {ball: _first(matrix) for ball, matrix in turned.items()}

    @property
    def is_long(self) -> bool:
        """Whether a sweep takes so long that few settings have to do."""
        return len(self.unknowns) > MANY_UNKNOWNS

    @property
    def is_square(self) -> bool:
        """Whether there are as many equations as unknowns."""
        return self.chain.equations == len(self.unknowns)

    def gap(self, q: Floats, turned: dict[int, Any]) -> Floats:
        """All closing equations (equations,) at coordinates (coordinates,)."""
        places = self.placing.places(q, turned)
        return np.array(self.placing.gaps(places, q, turned))

    def values(self, solve: Solve, inputs: Floats) -> Values:
        """Coordinates and points by name, of rows whose inputs (inputs, rows) are given."""
        return self.named(*self.rows(solve, inputs))

    def rows(self, solve: Solve, inputs: Floats) -> tuple[Floats, list[dict[int, Any]]]:
        """Coordinates (coordinates, rows) and the orientations that balls count from."""
        q, turned = self.start.copy(), dict(self.turned)
        found, orientations = np.empty((q.size, inputs.shape[1])), []
        for row in range(inputs.shape[1]):
            q[self.driven] = inputs[:, row]

            start = q[self.unknowns] - 1.0

            def gap(
                x: Floats, q: Floats = q, turned: dict[int, Any] = turned, start: Floats = start
            ) -> Floats:
                at = q.copy()
                at[self.unknowns] = start + x
                return self.gap(at, turned)

            q[self.unknowns] = start + solve(gap, np.ones(start.size))
            found[:, row] = q
            orientations.append(turned)
            q, turned = self.rebased(q, turned)
        return found, orientations

    def rebased(self, q: Floats, turned: dict[int, Any]) -> tuple[Floats, dict[int, Any]]:
        """The same place with the turns of balls counted from where they are."""
        if not turned:
            return q, turned
        algebra, q, found = self.placing.algebra, q.copy(), {}
        for ball, matrix in turned.items():
            frame = np.eye(4)
            frame[:3, :3] = matrix
            for about in BALL:
                frame = algebra.turned(frame, about, q[ball + about])
                q[ball + about] = 0.0
            found[ball] = frame[:3, :3]
        return q, found

    def named(
        self,
        q: Floats,
        orientations: list[dict[int, Any]],
        rates: Floats | None = None,
        accelerations: Floats | None = None,
    ) -> Values:
        """Positions by name, with velocities and accelerations where rates (coordinates, rows) are
        given."""
        still = np.zeros_like(q)
        turned = {
            ball: np.array([each[ball] for each in orientations]).transpose(1, 2, 0)
            for ball in self.turned
        }
        moving = rates is not None and accelerations is not None
        motion = (rates, accelerations) if moving else (still, still)
        found = named_values(self.chain, State(q, *motion, turned))
        names = self.scene.asked.level("motion" if moving else "position")
        return {name: found[name] for name in names}


def _first(matrix: Any) -> Any:
    return np.array([[float(x[0]) for x in row] for row in matrix])
