"""The ways from an assembled drawing to the rows: which row it is followed to.

The drawing stands where all inputs are zero, and whole turns away from there. Rows in its own turn
come first, or in the turn next to it that has any; and of each kind the nearest row before the
nearest on the other side of the drawing: its branch may end in one direction and reach the rows in
the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.analysis.assembly.home import follow_from_home, from_home
from mechkin_cli.analysis.assembly.named_modes import is_cyclic
from mechkin_cli.solver.follow import TrackEnd

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.session import Session


class WayFromHome(NamedTuple):
    """What came of following the drawing to a row; `turned`: to whole turns of the inputs away."""

    row: int
    followed: Followed
    turned: bool = False


def ways_from_home(session: Session) -> list[WayFromHome]:
    """The ways that were tried, at least one; only the last may come to its row."""
    ways: list[WayFromHome] = []
    for row, inputs, turned in _places(session):
        ways.append(WayFromHome(row, follow_from_home(session, inputs), turned))
        if ways[-1].followed.end == TrackEnd.FINISHED:
            break
    return ways


def _places(session: Session) -> Iterator[tuple[int, Floats, bool]]:
    """Rows to try, their inputs (inputs,), and whether these leave whole turns out."""
    leading, tried = _leading(session), set()
    for path, rows, turned in _paths(session, leading):
        for row in _two_sides(from_home(session, path)[leading], rows):
            inputs = np.ascontiguousarray(path[:, row])
            if (row, inputs.tobytes()) not in tried:
                tried.add((row, inputs.tobytes()))
                yield row, inputs, turned


def _paths(session: Session, leading: Bools) -> Iterator[tuple[Floats, NDArray[np.intp], bool]]:
    """The inputs of all rows (inputs, rows) and which rows of them are meant: those in the first
    turn that has any, all rows, and all without whole turns; one after the other is asked for."""
    inputs = session.inputs
    turns = np.max(np.abs(inputs.whole[leading]), axis=0, initial=0.0)
    every = np.arange(turns.size)
    # an assembly is the same whole turns of an input away; in the drawing's own turn what follows
    # others goes all its way
    if turns.size:
        least = float(turns.min())
        yield (inputs.reduced if least else inputs.values), np.flatnonzero(turns == least), False
    yield inputs.reduced, every, False
    yield without_turns(session, inputs.reduced), every, True


def _leading(session: Session) -> Bools:
    """Which inputs (inputs,) place a row in a turn: those that follow no other."""
    inputs = session.problem.motion.inputs
    leading = np.zeros(session.inputs.values.shape[0], dtype=bool)
    leading[: len(inputs)] = [not item.follows for item in inputs]
    return leading


def _two_sides(path: Floats, rows: NDArray[np.intp]) -> list[int]:
    """Of some rows (of inputs from the drawing's, rows) the nearest to the drawing, and of all rows
    the nearest on its other side."""
    if not path.size:
        return [0]
    distance = np.max(np.abs(path), axis=0)
    first = int(rows[np.argmin(distance[rows])])
    along = sum(one * one[first] for one in path)
    other = np.flatnonzero(along < 0.0)
    return [first, int(other[np.argmin(distance[other])])] if other.size else [first]


def without_turns(session: Session, path: Floats) -> Floats:
    """Inputs (inputs, rows) without the whole turns after which the mechanism stands as drawn; as
    they are where a thread counts turns."""
    joints = session.problem.mechanism.joints
    if any(joint.type.is_threaded for joint in joints.values()):
        return path
    cyclic = np.array([is_cyclic(session.problem.mechanism, f"{j}.{c}") for j, c in session.driven])
    turns = np.rint(path / (2.0 * np.pi))
    turned: Floats = np.where(cyclic[:, None], path - turns * (2.0 * np.pi), path)
    return turned if (turned != path).any() else path
