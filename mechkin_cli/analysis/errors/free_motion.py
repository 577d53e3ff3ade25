"""A free motion at given moments and places, in double-double: rates, accelerations, powers.

The kernel closes a guess along a chart through it and tells what would have to act along the chart
for the accelerations that are supposed; the true ones leave nothing (docs/numerics.md, Free
motion).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.analysis.errors.parts import as_number, as_parts
from mechkin_cli.elimination import eliminate
from mechkin_cli.mechanism.model import Damper, Spring
from mechkin_cli.solver.batch import Chart
from mechkin_cli.solver.codes import Demand
from mechkin_cli.tape.double_doubles import DoubleDoubles

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.model import Load
    from mechkin_cli.solver.precise import Precise
    from mechkin_cli.solver.session import Session

MOVING = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES


CORRECTIONS = 3
"""Of accelerations by a reduced inertia in doubles: each leaves 1e-15 of the one before."""


class Places(NamedTuple):
    """What a motion is supposed to be at some moments: states (states, places), rates and
    accelerations (columns, places) in kernel units, time (places,) in s; what whole turns go by
    (turn slots, places) is of doubles."""

    time: DoubleDoubles
    states: DoubleDoubles
    rates: DoubleDoubles
    accelerations: DoubleDoubles
    turned: Floats

    def at(self, chosen: Any) -> Places:
        """Some of the places."""
        return Places(
            self.time[chosen],
            self.states[:, chosen],
            self.rates[:, chosen],
            self.accelerations[:, chosen],
            np.ascontiguousarray(self.turned[:, chosen]),
        )


class Found(NamedTuple):
    """The same closed: states, rates and accelerations, and what would have to act along the chart
    (freedoms, places); `good` places are closed and all loads have values there."""

    states: DoubleDoubles
    rates: DoubleDoubles
    accelerations: DoubleDoubles
    forces: DoubleDoubles
    good: Bools


class Response(NamedTuple):
    """What places answer to unit accelerations along the chart, in doubles: forces (places,
    freedoms, freedoms), which are the reduced inertia, and accelerations of the columns (freedoms,
    columns, places)."""

    inertia: Floats
    tangents: Floats


class FreeMotion:
    """A mechanism that moves under forces.

    Args:
        session: of the free motion.
        precise: the numbers of its text.
        held: (held inputs, 2) what holds idle freedoms, in kernel units.
    """

    def __init__(self, session: Session, precise: Precise, held: Floats) -> None:
        self.session, self.precise = session, precise
        self.constants = precise.constants(session)
        self.held = held
        self.freedoms = session.plan.charts

    def found(self, places: Places, directions: Floats, *, forces: bool = True) -> Found:
        """Places closed along the chart of `directions` (freedoms, columns, places; or 1 for all
        of them), with what they are supposed to move by."""
        seconds = self.along(directions, places.accelerations)
        return self._run(places, directions, seconds, forces=forces)

    def response(self, places: Places, directions: Floats) -> Response:
        """What places answer to unit accelerations along the chart."""
        n, count = self.freedoms, places.time.size
        copies = np.tile(np.arange(count), n + 1)
        seconds = np.zeros((n, (n + 1) * count))
        for k in range(n):
            seconds[k, (k + 1) * count : (k + 2) * count] = 1.0
        along = directions if directions.shape[2] == 1 else directions[:, :, copies]
        found = self._run(places.at(copies), along, DoubleDoubles(seconds))
        forces = found.forces.high.reshape(n, n + 1, count)
        second = found.accelerations.high.reshape(-1, n + 1, count)
        inertia = (forces[:, 1:] - forces[:, :1]).transpose(2, 0, 1)
        return Response(inertia, (second[:, 1:] - second[:, :1]).transpose(1, 0, 2))

    def tangents(self, place: Places, directions: Floats) -> Floats:
        """Rates of the columns (freedoms, columns, 1) by unit rates along the chart at one
        place."""
        n = self.freedoms
        copies = place.at(np.zeros(n, dtype=np.intp))
        still = np.zeros_like(copies.rates.high)
        moving = copies._replace(accelerations=DoubleDoubles(still))
        found = self._run(moving, directions, DoubleDoubles(np.zeros((n, n))), np.eye(n))
        return np.ascontiguousarray(found.rates.high.T)[:, :, None]

    def corrected(self, found: Found, response: Response) -> tuple[DoubleDoubles, Floats]:
        """The accelerations of the columns that leave nothing to act, as far as `response` tells;
        and by how much they differ, in parts of unit accelerations (freedoms, places)."""
        with np.errstate(all="ignore"):
            missing = -eliminate(response.inertia, found.forces.high.T).T
        step = response.tangents[0] * missing[0]
        for k in range(1, len(missing)):
            step = step + response.tangents[k] * missing[k]
        return found.accelerations + step, missing

    @staticmethod
    def along(directions: Floats, columns: DoubleDoubles) -> DoubleDoubles:
        """What columns do (columns, places) along a chart (freedoms, places)."""
        total = columns[0][None] * directions[:, 0]
        for k in range(1, len(columns)):
            total = total + columns[k][None] * directions[:, k]
        return total

    def settled(self, places: Places, directions: Floats) -> tuple[Places, Bools]:
        """Places closed, with the accelerations that follow from the forces there; and which of
        them are."""
        found = self.found(places, directions)
        response = self.response(places, directions)
        for _ in range(CORRECTIONS):
            accelerations, missing = self.corrected(found, response)
            found.good[:] &= np.isfinite(missing).all(axis=0)
            numbers = (found.states, found.rates, accelerations)
            places = Places(places.time, *numbers, places.turned)
            good = found.good
            found = self.found(places, directions)
            found.good[:] &= good
        return places, found.good

    def without(self, dropped: Callable[[Load], bool]) -> FreeMotion | None:
        """The same mechanism without some of its loads; None where it has none of them."""
        from mechkin_cli.solver.free_motion import with_loads

        mechanism = self.session.problem.mechanism
        loads = tuple(load for load in mechanism.loads if not dropped(load))
        if len(loads) == len(mechanism.loads):
            return None
        fewer = replace(self.session.problem, mechanism=replace(mechanism, loads=loads))
        return FreeMotion(with_loads(self.session, fewer), self.precise, self.held)

    def _run(
        self,
        places: Places,
        directions: Floats,
        seconds: DoubleDoubles,
        rates: Floats | None = None,
        *,
        forces: bool = True,
    ) -> Found:
        count, plan = places.time.size, self.session.plan
        moved = self.along(directions, places.rates) if rates is None else DoubleDoubles(rates)
        spread = np.broadcast_to(directions, (*directions.shape[:2], count))
        chart = Chart(
            np.array(spread).reshape(-1, count),
            as_parts(moved),
            as_parts(seconds),
            np.zeros((0, count)),
        )
        inputs = np.repeat(self.held[:, :, None], count, axis=2)
        still = np.zeros((plan.inputs, 2, count))
        batch = self.session.run_precise(
            inputs,
            as_parts(places.states),
            constants=self.constants,
            rates=still,
            accelerations=still,
            full=inputs,
            turned=places.turned,
            time=np.stack([places.time.high, places.time.low]),
            chart=chart,
            demand=MOVING if forces else Demand.VELOCITY | Demand.ACCELERATION,
            derivatives=True,
        )
        assert batch.first is not None
        assert batch.second is not None
        good = batch.good | self.session.is_redundant
        if batch.undefined is not None:
            good &= batch.undefined == 0
        acting = batch.chart_forces if forces else np.zeros((self.freedoms, 2, count))
        assert acting is not None
        for part in (batch.states, batch.first, batch.second, acting):
            good &= np.isfinite(part).all(axis=(0, 1))
        states, first, second = map(as_number, (batch.states, batch.first, batch.second))
        return Found(states, first, second, as_number(acting), good)


def is_damper(load: Load) -> bool:
    """Whether what a load takes counts as dissipated."""
    return isinstance(load, Damper)


def is_working(load: Load) -> bool:
    """Whether what a load gives counts as work: it has no potential and is no damper."""
    return not isinstance(load, Damper | Spring)
