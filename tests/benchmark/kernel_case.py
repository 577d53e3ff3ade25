"""The kernel at work on a mechanism: plans, inputs and guesses as a sweep makes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmark.specimen import Specimen, values

from mechkin_cli import tolerances
from mechkin_cli.model.model import loads
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.outputs import OutputPlan, Readout, demand_of
from mechkin_cli.plan.plan import build_plan
from mechkin_cli.plan.records import Demand
from mechkin_cli.session.following import Followed, follow
from mechkin_cli.session.kernel_run import Ask, Batch, RowInputs, run

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.show import Floats

BATCH = 2048
"""Rows of a timed call."""

SWEEP_ROWS = 361
"""Rows of the timed sweep: as many as a full turn has degrees."""


class PlannedRun:
    """A kernel call with what it computes: demand, plan and the names of its outputs."""

    def __init__(
        self, case: KernelCase, names: Iterable[str], more: Demand = Demand.POSITION
    ) -> None:
        problem, self.names = case.model.problem, tuple(names)
        self.specimen = case.specimen
        known = problem.quantities()
        wanted = [known[name] for name in self.names]
        self.demand = demand_of(problem.mechanism, wanted) | more
        self.plan: Plan = build_plan(case.layout)
        self.outputs = OutputPlan(case.layout, self.plan, problem.motion.driven)
        for quantity in wanted:
            self.outputs.add(quantity)
        self.readout = Readout(self.outputs.outputs, self.outputs.slots, ())

    def __call__(
        self,
        inputs: Floats,
        guess: Floats,
        iterations: int = tolerances.NEWTON_ITERATIONS,
        lanes: int = 0,
    ) -> Batch:
        """Runs all rows; inputs (1, rows), guess (states, rows)."""
        rates, accelerations = driven(self.specimen, inputs.shape[1])
        return run(
            self.plan,
            RowInputs(inputs, guess, rates, accelerations),
            Ask(self.demand, self.readout, iterations=iterations),
            lanes=lanes,
            # times are those of this thread
            threads=1,
        )

    def quantities(self, batch: Batch) -> dict[str, Any]:
        """The outputs by name, (rows,) or (rows, 3), in SI."""
        assert batch.outputs is not None
        found = {}
        for name in self.names:
            slot = self.outputs.slots[name]
            columns = batch.outputs[slot]
            found[name] = columns[0] if len(columns) == 1 else columns.T
        return found


class KernelCase:
    """A mechanism at the input's positions (rows, rad): coordinates by name, and the kernel's
    arrays."""

    def __init__(self, specimen: Specimen, positions: Floats) -> None:
        self.specimen = specimen
        names = [name for level in specimen.motion for name in level]
        self.model = loads(specimen.text(values(positions.tolist())), specimen.name)
        self.layout = Layout(self.model.problem.mechanism, self.model.graph)
        analysis = self.model.analyze(names)
        self.found = {name: analysis[name] for name in names}
        self.positions = self.model.problem.motion.inputs[0].values
        self.inputs = np.ascontiguousarray(self.positions[None, :])
        self.states = self._states([self.found[name] for name in specimen.coordinates])

    def _states(self, coordinates: list[Floats]) -> Floats:
        """The kernel's states (states, rows) for given coordinates."""
        states = np.zeros((build_plan(self.layout).states, self.positions.size))
        known = dict(zip(self.specimen.coordinates, coordinates, strict=True))
        known[self.specimen.driven] = self.positions
        for k, edge in enumerate(self.layout.graph.edges):
            for kind in edge.joint.type.coordinates:
                unit = self.layout.length if kind == "s" else 1.0
                place = self.layout.state(k, edge.joint.type.freedom_of[kind])
                states[place] = known[f"{edge.joint.name}.{kind}"] / unit
        return states

    def second_order_guesses(self) -> Floats:
        """Each row's states predicted from the row before by its two derivatives."""
        step = np.diff(self.positions)
        predicted = []
        omega, alpha = self.specimen.rate, self.specimen.acceleration
        for names in zip(*self.specimen.motion, strict=True):
            value, rate, second = (self.found[name] for name in names)
            first = rate / omega
            curvature = (second - alpha * first) / omega**2
            ahead = value[:-1] + step * first[:-1] + 0.5 * step * step * curvature[:-1]
            predicted.append(np.concatenate([value[:1], ahead]))
        return self._states(predicted)

    def following(self, planned: PlannedRun) -> Callable[[], Followed]:
        """A call that follows the branch from the first row along all rows."""
        start = np.ascontiguousarray(self.states[:, 0])
        return lambda: follow(planned.plan, self.inputs, start)

    def sweep(self, planned: PlannedRun, lanes: int = 0) -> Callable[[], Batch]:
        """The same, and runs them."""
        followed = self.following(planned)
        return lambda: planned(self.inputs, followed().guess, lanes=lanes)


@cache
def driven(specimen: Specimen, rows: int) -> tuple[Floats, Floats]:
    """Rates and accelerations of the input (1, rows), made once as the motion of a file is."""
    return np.full((1, rows), specimen.rate), np.full((1, rows), specimen.acceleration)


def degree_rows(specimen: Specimen) -> Floats:
    """Positions 1 degree apart over the mechanism's sweep, rad."""
    first, last = specimen.span
    rows: Floats = np.radians(np.arange(first, last + 1.0))
    return rows


def sweep_rows(specimen: Specimen, rows: int = SWEEP_ROWS) -> Floats:
    """Equidistant positions over the mechanism's sweep, rad."""
    first, last = (float(end) for end in np.radians(specimen.span))
    return np.linspace(first, last, rows)


def repeated(array: Floats, rows: int = BATCH) -> Floats:
    """(columns, rows) by repeating the columns' rows from the start."""
    times = -(-rows // array.shape[1])
    return np.ascontiguousarray(np.tile(array, times)[:, :rows])
