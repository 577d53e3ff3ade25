"""Angles among outputs, and what inputs are within a turn."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechkin_cli.plan import Slot
    from mechkin_cli.session.session import Session
    from mechkin_cli.show import Floats


def input_rest(session: Session, name: str) -> Floats | None:
    """An input (rows,) without its whole turns in rad, None if it has none."""
    for number, item in enumerate(session.problem.motion.inputs):
        if name == item.name and session.inputs.whole[number].any():
            rest: Floats = session.inputs.reduced[number]
            return rest
    return None


def angle_slots(session: Session, names: Mapping[str, Slot]) -> list[tuple[int, int, bool]]:
    """Outputs that are angles, as native runs take them: (output slot, row of `Followed.turns`,
    whether of a closing joint); of an input -2 - its number."""
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
            turn = session.turn_slots.of_angle(layout, quantity)
        if turn is not None:
            found.append((slot.first, turn, of_closing))
    return found
