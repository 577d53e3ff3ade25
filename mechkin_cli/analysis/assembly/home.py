"""The home drawing as an assembly: whether it closes, and its branch up to given inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.home import home_state

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.session import Session


def is_home_assembled(session: Session) -> bool:
    """Whether the home drawing closes all loops as drawn."""
    return session.once("home", lambda: _is_home_assembled(session))


def _is_home_assembled(session: Session) -> bool:
    zeros = np.zeros((len(session.graph.inputs), 1))
    tests = (0.0, 0.0, tolerances.HOME_ASSEMBLED)
    home = home_state(session.layout)[:, None]
    batch = session.run(zeros, home, iterations=0, tests=tests)
    return bool(batch.good[0])


def nearest_to_home(path: Floats) -> int:
    """The row whose inputs (inputs, rows) are nearest to the drawing's, which are zero."""
    return int(np.argmin(np.max(np.abs(path), axis=0))) if path.size else 0


def follow_from_home(session: Session, inputs: Floats) -> Followed:
    """The branch of an assembled drawing, straight to `inputs` (inputs,)."""
    path = np.stack([np.zeros_like(inputs), inputs], axis=1)
    return session.follow(path, home_state(session.layout))
