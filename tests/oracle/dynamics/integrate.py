"""States of a motion at given moments: DOP853, projected onto the joints after every step."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from scipy.integrate import DOP853

from oracle.dynamics.motion import Motion
from oracle.dynamics.rows import Array

Node = tuple[Array, Array]
"""A state, and its relations with their whole turns."""


def integrate(
    motion: Motion, start: Array, times: Sequence[float], tolerance: float = 1e-13
) -> list[Node]:
    """The nodes at the times, the first of which is that of the start."""
    state = motion.projected(times[0], start.copy())
    motion.keep_turns(state)
    nodes, length = [(state, motion.turns)], None
    for begin, end in itertools.pairwise(times):
        solver = DOP853(
            motion.rate,
            begin,
            nodes[-1][0],
            end,
            rtol=tolerance,
            atol=tolerance,
            first_step=min(length, abs(end - begin)) if length else None,
        )
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise ArithmeticError(message)
            solver.y = motion.projected(solver.t, solver.y)
            motion.keep_turns(solver.y)
            solver.f = motion.rate(solver.t, solver.y)
            # the last step may be short because it ends at the row
            length = max(solver.step_size or 0.0, solver.h_abs)
        nodes.append((solver.y, motion.turns))
    return nodes
