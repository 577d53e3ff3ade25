"""Turns: continuous angles and orientations of closing joints, whole turns of the tree's angles.

The kernel has the angle of a closing joint from an arctangent and its orientation from a rotation
matrix: whole turns and the quaternion's sign are lost. Following carries both along from node to
node by the integral of their rates (`follow(..., turns=True)`), so each row only has to take the
value that is nearest to what following says. The states of the tree's angles are kept within half a
turn, where their rounding stays that of a turn, and their whole turns are counted.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import _kernel

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism.frames import Frame
    from mechkin_cli.mechanism.model import Joint
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.demand import Slot
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session

ORIENTATION = -1
"""Stands for the freedom of an orientation, which has four slots."""

Four = tuple["Floats", "Floats", "Floats", "Floats"]


class TurnSlots(NamedTuple):
    """Rows of `Followed.turns`.

    Attributes:
        closing: the first row of each (closing joint, freedom); freedom `ORIENTATION` of a joint
            that has no angles.
        tree: the row with the whole turns of each state that is an angle of the tree.
    """

    closing: Mapping[tuple[int, int], int]
    tree: Mapping[int, int]

    @classmethod
    def of(cls, plan: Plan) -> TurnSlots:
        """Those of a plan."""
        turns = _kernel.closing_turns(plan)
        closing = {(joint, freedom): slot for joint, freedom, slot, _ in turns}
        return cls(closing, dict(_kernel.tree_turns(plan)))

    def of_angle(self, layout: Layout, quantity: Wanted) -> int | None:
        """The row of a joint's angle, None where it has no turns."""
        reference = layout.joint_reference[quantity.owner]
        freedom = layout.mechanism.joints[quantity.owner].type.freedom_of[quantity.coordinate]
        if reference < 0:
            return self.closing.get((-1 - reference, freedom))
        return self.tree.get(layout.state(layout.edge_number[quantity.owner], freedom))


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


def turn_count(plan: Plan) -> int:
    """Number of rows of `Followed.turns`."""
    return sum(width for *_, width in _kernel.closing_turns(plan)) + len(_kernel.tree_turns(plan))


def continuous_angle(values: Floats, followed: Floats) -> Floats:
    """An angle with the whole turns that following says.

    Args:
        values: (rows,) from an arctangent, rad.
        followed: (rows,) the same angle out of `Followed.turns`.
    """
    continuous: Floats = values - np.rint((values - followed) / (2.0 * pi)) * (2.0 * pi)
    return continuous


def continuous_signs(q: Four, followed: Four, first: int) -> Floats:
    """Signs (rows,) that make unit quaternions continuous, 1 at row `first`.

    Args:
        q: four arrays (rows,), scalar first, of either sign.
        followed: as `drawn_quaternion` gives them.
        first: a row that keeps its sign.
    """
    signs = np.where(_inner(q, followed) < 0.0, -1.0, 1.0)
    alike: Floats = signs * signs[first]
    return alike


def drawn_quaternion(joint: Joint, turns: Floats) -> Four:
    """The orientation that following carries along, (4, rows), about the axes as drawn.

    The kernel turns the joint's frame on the second link against the one on the first, R = A^T B;
    against the drawing that is A0 R B0^T.
    """
    a, b = _frame_quaternion(joint.on_first), _frame_quaternion(joint.on_second)
    r = (turns[0], turns[1], turns[2], turns[3])
    return _product(_product(a, r), (b[0], -b[1], -b[2], -b[3]))


def _inner(p: Four, q: Four) -> Floats:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


def _product(p: Four, q: Four) -> Four:
    (a, b, c, d), (e, f, g, h) = p, q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def _frame_quaternion(frame: Frame) -> Four:
    """The rotation whose columns are the frame's axes, as arrays of no dimension."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = frame.x, frame.y, frame.z
    a, b, c = m21 - m12, m02 - m20, m10 - m01
    d, e, f = m10 + m01, m20 + m02, m21 + m12
    rows = (
        (1.0 + m00 + m11 + m22, a, b, c),
        (a, 1.0 + m00 - m11 - m22, d, e),
        (b, d, 1.0 - m00 + m11 - m22, f),
        (c, e, f, 1.0 - m00 - m11 + m22),
    )
    best = max(range(4), key=lambda k: rows[k][k])
    size = sqrt(sum(part * part for part in rows[best]))
    w, x, y, z = (np.asarray(part / size) for part in rows[best])
    return (w, x, y, z)
