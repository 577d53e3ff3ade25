"""Continuous angles: the kernel gives them within a turn, following counts whole turns
(`solver.closing_turns`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.solver.closing_turns import continuous_angle

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Columns, Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.demand import Slot
    from mechkin_cli.solver.session import Session


@dataclass
class _Turning:
    """Angles of one sort: their names, outputs, and the rows of `Followed.turns` that count their
    turns; of inputs, their numbers."""

    names: list[str] = field(default_factory=list)
    outputs: list[int] = field(default_factory=list)
    turns: list[int] = field(default_factory=list)

    def add(self, name: str, output: int, turn: int) -> None:
        self.names.append(name)
        self.outputs.append(output)
        self.turns.append(turn)


@dataclass(frozen=True)
class _Angles:
    """The angles among some outputs: of inputs, of the tree and of closing joints."""

    driven: _Turning = field(default_factory=_Turning)
    tree: _Turning = field(default_factory=_Turning)
    closing: _Turning = field(default_factory=_Turning)


def make_continuous(
    result: Result, wanted: Sequence[Wanted], slots: Mapping[str, Slot], outputs: Floats
) -> Columns:
    """Makes the angles among some outputs (outputs, rows) continuous from the first row, in place.

    Returns:
        What they are within a turn, of those that have turns.
    """
    rows, session = result.row_states, result.session
    key = ("angles", tuple(quantity.name for quantity in wanted))
    angles = session.own(key, lambda: _angles(session, wanted, slots))
    reached = rows.reached
    for output, number in zip(angles.driven.outputs, angles.driven.turns, strict=True):
        values = result.problem.motion.inputs[number].values
        outputs[output] = np.where(reached, values, outputs[output])
    rests: Columns = {}
    for some in (angles.tree, angles.closing):
        if not some.names:
            continue
        rest, turns = outputs[some.outputs], rows.turns[some.turns]
        if some is angles.closing:
            continuous = continuous_angle(rest, turns)
        else:
            continuous = rest + turns * (2.0 * pi)
        outputs[some.outputs] = continuous
        turned = ((continuous != rest) & reached).any(axis=1)
        rests |= {some.names[k]: rest[k] for k in np.flatnonzero(turned)}
    return rests


def _angles(session: Session, wanted: Sequence[Wanted], slots: Mapping[str, Slot]) -> _Angles:
    found, layout = _Angles(), session.layout
    inputs = {item.name: number for number, item in enumerate(session.problem.motion.inputs)}
    for quantity in filter(has_turns, wanted):
        name, output = quantity.name, slots[quantity.name].first
        turn = session.turn_slots.of_angle(layout, quantity)
        if name in inputs:
            found.driven.add(name, output, inputs[name])
        elif turn is not None:
            closing = layout.joint_reference[quantity.owner] < 0
            (found.closing if closing else found.tree).add(name, output, turn)
    return found


def has_turns(quantity: Wanted) -> bool:
    """Whether a quantity is an angle, which may have whole turns."""
    return quantity.kind == "coordinate" and is_angle(quantity.coordinate) and quantity.order == 0
