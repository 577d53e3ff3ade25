"""The home drawing as an assembly: whether it closes, and its branch up to given inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.home import home_inputs, home_state

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.session import Session


def is_home_assembled(session: Session) -> bool:
    """Whether the home drawing closes all loops as drawn."""
    return session.once("home", lambda: _is_home_assembled(session))


def _is_home_assembled(session: Session) -> bool:
    inputs = home_inputs(session.layout)[:, None]
    tests = (0.0, 0.0, tolerances.HOME_ASSEMBLED)
    home = home_state(session.layout)[:, None]
    batch = session.run(inputs, home, iterations=0, tests=tests)
    return bool(batch.good[0])


def from_home(session: Session, path: Floats) -> Floats:
    """How far inputs (inputs, rows) are from those of the drawing."""
    away: Floats = path - home_inputs(session.layout)[:, None]
    return away


def nearest_to_home(session: Session, path: Floats) -> int:
    """The row whose inputs (inputs, rows) are nearest to the drawing's."""
    return int(np.argmin(np.max(np.abs(from_home(session, path)), axis=0))) if path.size else 0


def follow_from_home(session: Session, inputs: Floats) -> Followed:
    """The branch of an assembled drawing, straight to `inputs` (inputs,)."""
    path = np.stack([home_inputs(session.layout), inputs], axis=1)
    return session.follow(path, home_state(session.layout))
