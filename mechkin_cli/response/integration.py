"""A session of a free motion, and its integration by the kernel (kernel/core/response).

The plan of a free motion has a chart in place of the free inputs (`free_session`); coordinates that
are driven along it go by their laws of time (`driven_laws`).
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import threads_for, width
from mechkin_cli.plan import Layout
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.session import (
    RESIDUAL_TESTS,
    Chart,
    Coordinate,
    Packing,
    Session,
    Structure,
    held_values,
    input_unit,
)
from mechkin_cli.structure import charted
from mechkin_cli.tape import compiled
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import DrivenLaws, Plan
    from mechkin_cli.mechanism import Problem, ResponseProblem
    from mechkin_cli.show import Floats


class Beginning(NamedTuple):
    """States (states,), rates of the columns (columns,) and a basis of the free rates (freedoms,
    columns) at the first moment, in kernel units."""

    state: Floats
    first: Floats
    tangents: Floats


class MotionEnd(IntEnum):
    """How a motion ended, as the kernel's `LaneEnd`."""

    DONE = 0
    STOPPED = 1
    STUCK = 2
    STEP_LIMIT = 3
    HELD = 4


class Fault(IntEnum):
    """Why no step could be taken: bits of the kernel's `StageFlag`."""

    NOT_CLOSED = 1
    OFF_BRANCH = 2
    SINGULAR_INERTIA = 4
    UNDEFINED_LOAD = 8
    FRICTION = 16
    UNDEFINED_STOP = 32
    NOT_FINITE = 255


class MotionReport(NamedTuple):
    """How a motion ended.

    Attributes:
        stop: that ended it, or that had no value where it ended; -1: none.
        joints: numbers of the frictions that it ended by.
        energy: largest kinetic energy at the ends of its steps (kg, length units, s).
        lightest: least inertia at the last of them, in parts of that at the start.
        growth: accelerations there, in parts of the rates (1/s).
        met: how often the switch `which` was met.
        step: the last one, s.
        value: largest of that switch.
        end: the kernel's verdict.
        fault: of the last refused step.
        which: the switch that held it, or that was met most often when steps ran out.
        stiff, stiff_from: whether and from when (s) the implicit method took over.
        time: the last one, s.
        rows, evaluations, steps, rejections: their counts.
        last: the last states.
        crossings: the branch points that were passed (time in s, states).
        touches: stops (numbers) whose value came to `at` and went back, and when (s).
        branch_point: the states at the one that it has ended next to; empty: none.
        singular: whether short steps were refused there as off the branch.
    """

    stop: int
    joints: list[int]
    energy: float
    lightest: float
    growth: float
    met: int
    step: float
    value: float
    end: MotionEnd
    fault: int
    which: int
    stiff: bool
    stiff_from: float
    time: float
    rows: int
    evaluations: int
    steps: int
    rejections: int
    last: list[float]
    crossings: list[tuple[float, list[float]]]
    touches: list[tuple[int, float]]
    branch_point: list[float]
    singular: bool


@dataclass(frozen=True)
class MotionRows:
    """Rows of one motion in kernel units: states (states, rows), the chart about each, turns of
    closing joints (slots, rows), work put in and lost (2, rows) in kg, length units and s, and the
    kernel's flags (rows,). Rows that were not reached hold nan."""

    report: MotionReport
    states: Floats
    chart: Chart
    turns: Floats
    work: Floats
    flags: NDArray[np.uint8]

    @property
    def count(self) -> int:
        """Rows that there are: those that were reached, and one where a stop lies between rows."""
        return self.report.rows + bool(np.isfinite(self.states[:1, self.report.rows]).all())


class WatchedStop(NamedTuple):
    """What ends a motion, by a value that is watched. `kind` 0: it crosses `at` for the `times`th
    time, upwards (1), downwards (-1) or in either direction (0); 1: it changes its sign for the
    `times`th time; 2: it lies `times` turns from where it began; 3: a condition holds for the
    `times`th time. `lengths` and `rates` are the powers of length and
    1/time in the value's dimension, by which its rounding is estimated; `rates` -1: not known."""

    kind: int
    direction: int
    times: int
    at: float
    lengths: int = 0
    rates: int = -1


def free_session(session: Session, free: Sequence[Coordinate]) -> Session:
    """The session of a problem whose inputs `free` are left to move: the same tree, so the same
    states; residual and condition in parts of the same size."""
    graph, closed_at, packing = (
        charted(session.graph, set(free)),
        session.closed_at,
        session.packing,
    )
    other = Session.of(
        session.problem, graph, driven=graph.driven, closed_at=closed_at, packing=packing
    )
    return other if session.size is None else other.sized(session.size)


def with_loads(session: Session, problem: Problem) -> Session:
    """The session of a free motion for a problem that differs in loads alone."""
    laid = Layout(problem.laid_mechanism, session.graph, session.layout.length, laws=problem.laws)
    structure = Structure(laid, tuple(session.graph.driven), session.closed_at)
    return Session(problem, structure, size=session.size, packing=session.packing)


def integrate(
    starts: Sequence[tuple[Plan, Beginning]],
    begin: float,
    times: Floats,
    *,
    stops: Sequence[WatchedStop] = (),
    driven: DrivenLaws | None = None,
    tolerance: float,
    fixed_step: float | None,
    straight: bool = False,
    packing: Packing,
    method: int = 0,
) -> list[MotionRows]:
    """Integrates motions of plans of one structure, each from its beginning, packed into lanes,
    from time `begin` (s) over the rows' `times` (rows,).

    `stops` go with the values that the plans watch, in order; `driven` with their inputs;
    `straight`: branch points are passed along the smooth continuation.

    Raises:
        ValueError: times that do not rise from `begin` on.
    """
    reports, *arrays = _kernel.respond(
        plans=[plan for plan, _ in starts],
        state=np.ascontiguousarray([start.state for _, start in starts]),
        first=np.ascontiguousarray([start.first for _, start in starts]),
        tangent=np.ascontiguousarray([start.tangents.ravel() for _, start in starts]),
        begin=begin,
        times=np.ascontiguousarray(times),
        stops=[(s.kind, s.direction, s.times, s.at, s.lengths, s.rates) for s in stops],
        driven=driven,
        tolerance=tolerance,
        fixed_step=fixed_step or 0.0,
        most_steps=tolerances.MOST_RESPONSE_STEPS,
        dense_rows=tolerances.DENSE_ROWS,
        method=method,
        tests=list(RESIDUAL_TESTS),
        iterations=tolerances.NEWTON_ITERATIONS,
        jump=tolerances.JUMP_LIMIT,
        radius=tolerances.SPECTRAL_RADIUS,
        straight=straight,
        # one motion needs no more than the narrowest packs
        lanes=width(packing.lanes) if packing.lanes or len(starts) > 2 else 2,
        threads=threads_for(len(starts), packing.threads),
    )
    motions = []
    for number, fields in enumerate(reports):
        states, direction, rates, seconds, turns, fourth, work, flags = (a[number] for a in arrays)
        report = MotionReport(**{**fields, "end": MotionEnd(fields["end"])})
        chart = Chart(direction, rates, seconds, fourth)
        motions.append(MotionRows(report, states, chart, turns, work, flags))
    return motions


def driven_laws(session: Session, response: ResponseProblem) -> _kernel.DrivenLaws | None:
    """The laws of a session's inputs: the response's driven coordinates, then those at which idle
    freedoms are held; None without any.

    The course of the driven ones is a tape over the time in the file's unit, in cells.
    """
    problem, layout = session.problem, session.layout
    held = held_values(problem, layout)
    units = [input_unit(layout, item) for item in response.driven]
    if not units and not held:
        return None
    course, time_unit = response.course, float(problem.units.to_si(1.0, TIME))
    if course is None:
        assert not units
        return _kernel.DrivenLaws(None, [], [], [], [], time_unit, held)
    edges = course.edges[1:-1] * time_unit
    return _kernel.DrivenLaws(
        compiled(course.tape),
        edges.tolist(),
        np.ravel(course.constants).tolist(),
        np.ravel(course.ways).tolist(),
        units,
        time_unit,
        held,
    )
