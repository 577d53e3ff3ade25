"""Small motions by the inputs of a sweep: what its drives would have to exert beside a row.

Loops that move each by an input of their own are closed one by one then. A chart of the free
mechanism closes all of them together, which takes the cube of how many there are.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.record import replace
from mechkin_cli.statics import ForcesAt, Statics, differentiated

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.show import Floats
    from mechkin_cli.statics import Derivative
    from mechkin_cli.sweep import Result


class InputForces:
    """What the drives of some inputs of a sweep exert about a row, N*m or N, where the others are
    held or moved as there; friction is left out.

    Args:
        result: the rows.
        row: number of the one.
        free: numbers of the inputs.
    """

    def __init__(self, result: Result, row: int, free: Sequence[int]) -> None:
        session = result.session
        problem = session.problem
        mechanism = replace(problem.mechanism, frictions=(), drives=None)
        # as if nothing rested: all inputs have efforts
        motion = problem.motion._replace(rest=None)
        own = replace(problem, mechanism=mechanism, motion=motion)
        self.session = session.loaded(own)
        self.free = list(free)
        self._statics = Statics(self.session, free)
        inputs, states = session.inputs, result.row_states
        self._values = inputs.values[:, row]
        self._state, self._turns = states.states[:, row], states.turns[:, row]
        moving = np.ones(len(self._values))
        moving[self.free] = 0.0
        self._rates = inputs.rates[:, row] * moving
        self._accelerations = inputs.accelerations[:, row] * moving
        moments = problem.motion.time
        self._time = 0.0 if moments is None else float(moments.values[row])

    @property
    def units(self) -> Floats:
        """SI units (free,) of the kernel's numbers: 1 for angles, a length for slides."""
        return self._statics.units

    @property
    def moves(self) -> bool:
        """Whether drives of other inputs move."""
        return bool(self._rates.any() or self._accelerations.any())

    def at(self, moved: Floats, rates: Floats, accelerations: Floats) -> ForcesAt:
        """Efforts at the inputs where these are (free, places) away, with their rates and
        accelerations, all in kernel units."""
        count = moved.shape[1]

        def of_all(constant: Floats, more: Floats) -> Floats:
            every = np.repeat(constant[:, None], count, axis=1)
            every[self.free] += more
            return every

        states, turns = (np.repeat(x[:, None], count, axis=1) for x in (self._state, self._turns))
        values = of_all(self._values, moved)
        rows = self._statics.rows(values, states, turns, np.full(count, self._time))._replace(
            rates=of_all(self._rates, rates),
            accelerations=of_all(self._accelerations, accelerations),
        )
        found = self._statics.efforts(rows)
        return ForcesAt(found.forces, found.states, turns, found.good)

    @cached_property
    def efforts(self) -> Floats:
        """Those (free,) that hold the row."""
        none = np.zeros((len(self.free), 1))
        return np.asarray(self.at(none, none, none).forces[:, 0])

    @cached_property
    def _derivatives(self) -> tuple[Derivative, ...]:
        """Of the efforts by the inputs, and by their rates where loads read some or others move."""
        n = len(self.free)
        loads = self.session.problem.mechanism.loads

        def moved(u: Floats) -> ForcesAt:
            return self.at(u, np.zeros_like(u), np.zeros_like(u))

        def rated(rates: Floats) -> ForcesAt:
            return self.at(np.zeros_like(rates), rates, np.zeros_like(rates))

        stiffness = differentiated(moved, n)
        if self.moves or any(load.reads_rates for load in loads):
            return stiffness, differentiated(rated, n)
        return (stiffness,)

    @cached_property
    def _inertia(self) -> Floats:
        """Efforts (free, free) by accelerations of the inputs."""
        n = len(self.free)
        none = np.zeros((n, n + 1))
        unit = np.concatenate([np.zeros((n, 1)), np.eye(n)], axis=1)
        found = self.at(none, none, unit).forces
        return np.asarray(found[:, 1:] - found[:, :1])

    @property
    def bends(self) -> bool:
        """Whether loads bend or jump in the row, as `SmallMotions.bends`."""
        return any(bends(found, self._inertia) for found in self._derivatives)

    @cached_property
    def matrices(self) -> tuple[Floats, Floats, Floats]:
        """Stiffness, damping and inertia (free, free), SI."""
        stiffness, *others = (found.matrix / self.units for found in self._derivatives)
        damping = others[0] if others else np.zeros_like(stiffness)
        inertia = self._inertia / self.units
        return stiffness, damping, 0.5 * (inertia + inertia.T)


def bends(found: Derivative, inertia: Floats) -> bool:
    """Whether what was differentiated bends or jumps at the place: its differences do not settle,
    however short they are, and are more than rounding beside an inertia in the same units."""
    size, least = (float(np.abs(each).max(initial=0.0)) for each in (found.matrix, inertia))
    settled = found.error <= max(tolerances.UNSETTLED * size, tolerances.NO_RATE * least)
    # without inertia nothing vibrates
    return least > 0.0 and not settled
