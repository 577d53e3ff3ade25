"""Coordinates that are driven along a motion, by their laws of time, as the kernel takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.inputs import held_values, input_unit
from mechkin_cli.tape.native import compiled
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.session import Session


def driven_laws(session: Session, response: Response) -> _kernel.DrivenLaws | None:
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
