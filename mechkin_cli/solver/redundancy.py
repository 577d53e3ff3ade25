"""Closing equations that follow from the others of their joint, because its loop moves in a
subgroup (docs/numerics.md, Proofs).

In an assembly of the drawing the frames A and B of the closing joint coincide, and elsewhere B is
moved against A by a displacement D of the subgroup, whatever the coordinates are. So of the joint's
elementary conditions (kernel/src/pairs.hpp), with d = B.o - A.o, n the normal of a plane loop and O
the centre of a spherical one,

- directions: none turns in a translational loop, and n in none of a plane loop; where D turns about
  n, one equation that is the sine of its angle, times what is not zero, leaves no angle but zero
  where the joint's side condition holds beside it;
- lengths: n.d is zero in a plane loop; in a spherical one, D keeps the line from O to the point of
  a joint whose axis it keeps, and everything where it keeps the orientation.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.mechanism.joint_table import CLOSING_CONDITIONS
from mechkin_cli.mechanism.vectors import Vector, cross, dot
from mechkin_cli.solver.subgroups import Subgroup, Tests, off_centre, subgroup_of
from mechkin_cli.tape.scalars import as_recorded

if TYPE_CHECKING:
    from mechkin_cli.mechanism.joint_type import Condition
    from mechkin_cli.mechanism.model import Joint
    from mechkin_cli.solver.graph import Closing
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session


class _Loop(NamedTuple):
    """A loop's closing joint in the drawing, its subgroup, and the test of numbers."""

    joint: Joint
    group: Subgroup
    tests: Tests

    @property
    def _is_on_normal(self) -> tuple[bool, bool]:
        """Whether z of either frame is the normal of a plane loop."""
        normal = self.group.normal
        if normal is None:
            return False, False
        frames = self.joint.on_first, self.joint.on_second
        one, other = (self.tests.parallel(normal, self.tests.axis(frame)) for frame in frames)
        return one, other

    def _nearest_to_normal(self, axes: Sequence[Vector]) -> int:
        """Which of some directions has the largest component along the normal."""
        assert self.group.normal is not None
        sizes = [abs(as_recorded(dot(axis, self.group.normal))) for axis in axes]
        return sizes.index(max(sizes))

    def of(self, condition: Condition, beside: Collection[str]) -> list[bool]:
        """Which equations of a condition follow, with conditions of some kinds beside it."""
        if condition.kind == "lengths":
            return self._lengths(condition, beside)
        directions = {"parallel": self._parallel, "orientation": self._orientation}
        return directions.get(condition.kind, self._angle)()

    def _lengths(self, condition: Condition, beside: Collection[str]) -> list[bool]:
        """Of u.d = 0 for some axes u of a frame."""
        frame = (self.joint.on_first, self.joint.on_second)[condition.side]
        numbers = ["xyz".index(axis) for axis in condition.axes]
        count = len(numbers)
        if self.group.centre is not None:
            return [self._keeps_point(beside)] * count
        follow = [False] * count
        if self.group.normal is not None:
            others = [axis for k, axis in enumerate(frame[:3]) if k not in numbers]
            if all(self.tests.is_square(axis, self.group.normal) for axis in others):
                follow[self._nearest_to_normal([frame[k] for k in numbers])] = True
        return follow

    def _keeps_point(self, beside: Collection[str]) -> bool:
        """Whether the joint's point stays where it is about the centre of a spherical loop."""
        off = off_centre(self.group, self.joint.on_first.o)
        if "orientation" in beside or self.tests.vanishes(off):
            return True
        axis = self.tests.axis(self.joint.on_first)
        return "parallel" in beside and self.tests.vanishes(cross(off, axis))

    def _parallel(self) -> list[bool]:
        """Of x_A.z_B = y_A.z_B = 0."""
        if not self.group.turns or all(self._is_on_normal):
            return [True, True]
        first = self.joint.on_first
        follow = [False, False]
        normal = self.group.normal
        if normal is not None and self.tests.is_square(first.z, normal):
            # after a turn by an angle t they are n.y sin t and -n.x sin t
            follow[self._nearest_to_normal((first.x, first.y))] = True
        return follow

    def _orientation(self) -> list[bool]:
        """Of the components of the axis of the turn from A to B, times the sine of its angle."""
        follow = [not self.group.turns] * 3
        if self.group.turns and self.group.normal is not None:
            kept = self._nearest_to_normal(self.joint.on_first[:3])
            follow = [k != kept for k in range(3)]
        return follow

    def _angle(self) -> list[bool]:
        """Of z_A.z_B, which keeps its value."""
        first, second = self.joint.on_first, self.joint.on_second
        closed = self.tests.is_zero(dot(first.z, second.z) - self.joint.parameter)
        return [closed and (not self.group.turns or any(self._is_on_normal))]


def _follow(closing: Closing, layout: Layout, tests: Tests) -> list[bool]:
    """Which equations of a closing joint follow from the others."""
    joint = closing.joint
    nothing = [False] * closing.equations
    conditions = CLOSING_CONDITIONS.get(joint.type.closing or "")
    edges = [layout.graph.edges[edge] for edge, _ in closing.loop]
    if closing.leg is not None or conditions is None or any(edge.hung for edge in edges):
        return nothing
    kinds = {condition.kind for condition in conditions}
    if not _is_closed(joint, kinds, tests):
        return nothing
    parts = [layout.carriers[k].part for edge, _ in closing.loop for k in layout.parts_of[edge]]
    group = subgroup_of(parts, tests)
    if group is None:
        return nothing
    loop = _Loop(joint, group, tests)
    return [one for condition in conditions for one in loop.of(condition, kinds)]


def _is_closed(joint: Joint, kinds: Iterable[str], tests: Tests) -> bool:
    """Whether the frames of a closing joint coincide in the drawing, as far as it looks at them; an
    angle that it keeps is tested where that counts."""
    first, second = joint.on_first, joint.on_second
    if "orientation" in kinds:
        return tests.same_frame(first, second)
    return (tests.same_line if "parallel" in kinds else tests.same_origin)(first, second)


def equations_that_follow(session: Session) -> list[bool]:
    """Which closing equations of a session's plan hold where the others of their joint do, in the
    kernel's order: by the numbers of the text, whatever the coordinates are, where the side
    conditions of the closing joints hold.

    Raises:
        LookupError: the session is of no file.
        TraceLost: a number depends on the text in a way that no tape holds.
    """
    layout = session.precise.layout(session)
    tests = Tests(session.precise.recorder)
    found = [_follow(closing, layout, tests) for closing in layout.graph.closings]
    return [one for equations in found for one in equations]
