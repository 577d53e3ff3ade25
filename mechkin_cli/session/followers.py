"""Inputs that follow others: what moves with one input where all others stand; inputs within a
turn, and which outputs are angles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import Parameter
from mechkin_cli.memo import remembered
from mechkin_cli.session.cells import Formula, cells_of
from mechkin_cli.session.inputs import input_unit
from mechkin_cli.session.path import FollowedPath, Route, places_of
from mechkin_cli.show import Floats
from mechkin_cli.tape import replay

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechkin_cli.session.session import Session
    from mechkin_cli.tape import Tape


class InputPath:
    """All inputs of a session along input `number`, which others follow, the rest as in a row.

    Args:
        session: the mechanism as it is driven.
        tape: its motion's for that input.
        number: the input.
        row: where the others stand.
    """

    def __init__(self, session: Session, tape: Tape, number: int, row: int) -> None:
        motion = session.problem.motion
        self.number, self.name = number, motion.inputs[number].name
        self.units = np.array([input_unit(session.layout, item) for item in motion.inputs])
        followers = followers_of(session)
        self.followers = {name for name, leader in followers.items() if leader == self.name}
        own = [i for i in motion.inputs if i.name not in followers]
        given = [float(item.values[row]) for item in own]
        given += [] if motion.time is None else [float(motion.time.values[row])]
        self.formula = Formula(tape, [], lambda _: given)
        self.given = given
        self.held = session.inputs.values[len(motion.inputs) :, row : row + 1]

    def at(self, values: Floats) -> Floats:
        """All inputs (inputs, places) at values of the one that moves; in kernel units."""
        own = self._in_si(values * self.units[self.number]) / self.units[:, None]
        inputs: Floats = np.concatenate([own, np.repeat(self.held, own.shape[1], axis=1)])
        return inputs

    def derivatives(self, values: Floats) -> Floats:
        """All inputs with first and second derivatives by the one that moves (3, inputs, places),
        in kernel units."""
        unit = self.units[self.number]
        found = np.empty((3, self.units.size, values.size))
        for k, value in enumerate((values * unit).tolist()):
            at = np.array([value])
            ways = self.formula.ways(at, self.given)[0]
            found[:, :, k] = self.formula.jets(at, self.given, ways)[0].T
        powers = np.array([1.0, unit, unit * unit])
        own = found * powers[:, None, None] / self.units[None, :, None]
        held = np.zeros((3, self.held.size, values.size))
        held[0] = self.held
        jets: Floats = np.concatenate([own, held], axis=1)
        return jets

    def way(self, values: Floats) -> FollowedPath:
        """The way of all inputs along values of the one that moves, in kernel units."""
        places = values * self.units[self.number]
        cells = cells_of(self.formula, places)
        course = places_of(self.formula, cells, Parameter(self.name), places, self._in_si(places))
        own = course.values[:, course.rows >= 0] / self.units[:, None]
        inputs = np.concatenate([own, np.repeat(self.held, own.shape[1], axis=1)])
        return Route(course, inputs, self.units).way(0)

    def _in_si(self, places: Floats) -> Floats:
        given = np.empty((1 + len(self.given), places.size))
        given[0], given[1:] = places, np.array(self.given)[:, None]
        inputs: Floats = replay(self.formula.native, given)[0].T
        return inputs


def followers_of(session: Session) -> dict[str, str]:
    """Inputs that follow another, and the first of those that they follow."""
    motion = session.problem.motion
    found: dict[str, str] = {}
    for leader, tape in motion.paths:
        number = [item.name for item in motion.inputs].index(leader)
        for k, item in enumerate(motion.inputs):
            if k != number and tape.depends(k):
                found.setdefault(item.name, leader)
    return found


@remembered
def input_path(session: Session, number: int, row: int = 0) -> InputPath | None:
    """What follows input `number` where all others stand as in a row; None where nothing does."""
    name = session.problem.motion.inputs[number].name
    tapes = dict(session.problem.motion.paths)
    return InputPath(session, tapes[name], number, row) if name in tapes else None


def input_rest(session: Session, name: str) -> Floats | None:
    """An input (rows,) without its whole turns in rad, None if it has none."""
    for number, item in enumerate(session.problem.motion.inputs):
        if name == item.name and session.inputs.whole[number].any():
            rest: Floats = session.inputs.reduced[number]
            return rest
    return None


def angle_slots(session: Session, names: Mapping[str, slice]) -> list[tuple[int, int, bool]]:
    """Outputs that are angles, as native runs take them: (output slot, row of `Followed.turns`,
    whether of a cut joint); of an input -2 - its number."""
    known, layout = session.problem.quantities(), session.layout
    inputs = {item.name: number for number, item in enumerate(session.problem.motion.inputs)}
    found = []
    for name, slot in names.items():
        quantity = known.get(name)
        if quantity is None or quantity.kind != "coordinate" or quantity.order:
            continue
        of_closing = layout.joint_reference[quantity.owner] < 0
        if name in inputs and not of_closing:
            turn: int | None = -2 - inputs[name]
        else:
            turn = session.structure.turn_slot(quantity)
        if turn is not None:
            found.append((slot.start, turn, of_closing))
    return found
