"""Rest at a limit: a mechanism of one freedom that loads push to a limit stands there, held by the
limit's force, until that would have to pull.

Nothing moves while it rests, so that the force follows from the balance of each moment. It is told
as the effort at the limited coordinate, and acts on rows as a load over time.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    JointLoad,
    LoadLaw,
    Moments,
    Varying,
    effort_quantity,
    joined_curve,
)
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.integration import MotionEnd, MotionRows
from mechkin_cli.session import Chart
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.mechanism import Limit, Problem, ResponseProblem
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.show import Floats


class Contact(NamedTuple):
    """A rest at a limit: its force along the coordinate (N*m, N) at the moments of rows (s)."""

    limit: Limit
    times: Floats
    forces: Floats


def at_rest(moved: MotionRows, count: int, places: int, width: int) -> MotionRows:
    """The last place of a motion, at rest over `count` rows and, where `places` are more, at a
    moment between them; of `width` columns the others hold nan."""
    last = moved.count - 1

    def still(array: Floats) -> Floats:
        found = np.full((*array.shape[:-1], width), np.nan)
        found[..., :places] = array[..., [last]]
        return found

    chart, none = moved.chart, np.zeros((1, last + 1))
    resting = still(np.repeat(none, len(chart.rates), axis=0))
    report = moved.report._replace(
        rows=count,
        end=MotionEnd.DONE,
        energy=0.0,
        steps=0,
        rejections=0,
        evaluations=0,
        crossings=[],
        touches=[],
    )
    return MotionRows(
        report,
        still(moved.states),
        Chart(still(chart.direction), resting, resting, np.zeros((len(chart.friction), width))),
        still(moved.turns),
        still(np.repeat(none, 2, axis=0)),
        np.zeros(width, dtype=np.uint8),
    )


def at_moments(response: ResponseProblem, problem: Problem, times: Floats) -> ResponseProblem:
    """The response with rows at other moments (s)."""
    return replace(response, moments=Moments(times, problem.units.from_si(times.copy(), TIME)))


def holding(result: ResponseResult) -> Floats:
    """The effort at the start's coordinate that holds a mechanism of one freedom (rows,)."""
    ((joint, coordinate),) = result.response.independent
    effort = effort_quantity(joint, coordinate)
    return np.asarray(result.as_driven.evaluated([effort])[effort.name][0])


def leaves(force: Callable[[Floats], Floats], begin: float, times: Floats) -> float | None:
    """The first moment within `times` (rows,), rising from `begin`, at which what pushes against
    the limit would pull; None where it never does. `force` gives the push at moments."""
    ends = np.array([begin, *times])
    parts = np.linspace(0.0, 1.0, SAMPLES + 1)[1:]
    sampled = np.concatenate([[begin], *(a + (b - a) * parts for a, b in pairwise(ends))])
    found = force(sampled)
    none = -tolerances.KINK_ROUNDING * float(np.abs(found).max(initial=0.0))
    pulling = np.flatnonzero(found < none)
    if not pulling.size:
        return None
    k = int(pulling[0])
    if k == 0:
        return begin
    low, high = float(sampled[k - 1]), float(sampled[k])
    while True:
        inner = low + (high - low) * np.linspace(0.0, 1.0, SAMPLES + 1)
        inner = np.unique(inner)
        if inner.size < 3:
            return high
        pulls = np.flatnonzero(force(inner) < 0.0)
        k = int(pulls[0]) if pulls.size else inner.size - 1
        if k == 0:
            return low
        if (float(inner[k - 1]), float(inner[k])) == (low, high):
            return high
        low, high = float(inner[k - 1]), float(inner[k])


SAMPLES = 16
"""Parts of a step from row to row, and of each bracket, at which the force is looked at."""


def with_contacts(
    response: ResponseProblem, contacts: list[Contact], times: Floats
) -> ResponseProblem:
    """The response with the forces of limits among its efforts: laws that have their values at the
    rows' moments, 0 where nothing rests."""
    for limit in dict.fromkeys(one.limit for one in contacts):
        values = np.zeros(times.size)
        for one in contacts:
            if one.limit == limit:
                here = np.isin(times, one.times)
                values[here] = one.forces[np.isin(one.times, times)]
        curve = joined_curve(times.tolist(), values.tolist(), "linear", "natural")
        law = LoadLaw(("time",), limit.place, curve=curve)
        load = JointLoad(limit.joint, limit.coordinate, Varying(len(response.load_laws)))
        response = replace(
            response,
            efforts=(*response.efforts, load),
            load_laws=(*response.load_laws, law),
            mechanism=replace(response.mechanism, loads=(*response.mechanism.loads, load)),
        )
    return response
