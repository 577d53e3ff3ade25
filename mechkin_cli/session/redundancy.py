"""Closing equations that follow from the others of their joint, because its loop moves in a
subgroup (docs/numerics.md, Proofs).

In an assembly of the drawing the frames A and B of the cut joint coincide, and elsewhere B is
moved against A by a displacement D of the subgroup, whatever the coordinates are. So of the joint's
elementary conditions (kernel/core/joints/pairs.hpp), with d = B.o - A.o, n the normal of a plane
loop and O the centre of a spherical one,

- directions: none turns in a translational loop, and n in none of a plane loop; where D turns about
  n, one equation that is the sine of its angle, times what is not zero, leaves no angle but zero
  where the joint's side condition holds beside it;
- lengths: n.d is zero in a plane loop; in a spherical one, D keeps the line from O to the point of
  a joint whose axis it keeps, and everything where it keeps the orientation.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.mechanism import (
    Frame,
    Vector,
    add,
    cross,
    dot,
    scale,
    subtract,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import Identities, as_recorded, register

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Condition, Constraint, Joint, Part
    from mechkin_cli.plan import Layout
    from mechkin_cli.session.session import Session
    from mechkin_cli.structure import Loop
    from mechkin_cli.tape import ExactRecorder


# Loops whose joints all move in one subgroup of the displacements, by the numbers of the text.
#
# A loop is *planar* where every joint turns about one direction or slides square to it, *spherical*
# where every joint turns about one point, *translational* where every joint slides. Products of
# such displacements are such again (J. M. Herve, Mechanism and Machine Theory 13, 1978), so that
# whatever the coordinates are, the two sides of the joint that closes the loop are placed against
# each other by a displacement of the subgroup. All of it is decided by identities
# (`tape.identities`).

TURN, SLIDE = ("turn",), ("slide",)
"""Motions of displacements that move in one of the subgroups; a thread does both."""


class Subgroup(NamedTuple):
    """What a loop's displacements have in common, in the drawing.

    Attributes:
        turns: whether there are any; a translational loop has none.
        normal: the one direction about which they turn, and square to which they slide, of any
            length; None of a loop that is not planar.
        centre: the point that all of them keep, times `weight`; None of a loop that is not
            spherical.
        weight: a positive number.
    """

    turns: bool
    normal: Vector | None = None
    centre: Vector | None = None
    weight: float = 1.0


class Tests:
    """Exact tests of recorded vectors."""

    def __init__(self, recorder: ExactRecorder) -> None:
        self.recorder = recorder
        self.is_zero: Callable[[Any], bool] = Identities(recorder).is_zero

    def axis(self, frame: Frame) -> Vector:
        """The z axis of a frame, of any length and either way."""
        return self.undivided(frame.z)

    def undivided(self, vector: Vector) -> Vector:
        """A direction as it is written, before it was made a unit vector, whose root would hide
        what cancels; of any length and either way."""
        x, y, z = map(self.recorder.number, self.recorder.undivided(self._registers(vector)))
        return (x, y, z)  # type: ignore[return-value]

    def _registers(self, vector: Vector) -> list[int]:
        found = [register(self.recorder, component) for component in vector]
        return list(map(self.recorder.origin, found))

    def vanishes(self, vector: Iterable[Any]) -> bool:
        """Whether a vector is zero."""
        return all(map(self.is_zero, vector))

    def same(self, a: Vector, b: Vector) -> bool:
        """Whether two vectors are equal."""
        return self._registers(a) == self._registers(b) or self.vanishes(subtract(a, b))

    def parallel(self, a: Vector, b: Vector) -> bool:
        """Whether two vectors are parallel."""
        return self._registers(a) == self._registers(b) or self.vanishes(cross(a, b))

    def is_square(self, a: Vector, b: Vector) -> bool:
        """Whether two directions are square to each other."""
        return self.is_zero(dot(self.undivided(a), self.undivided(b)))

    def same_origin(self, a: Frame, b: Frame) -> bool:
        """Whether two frames have one origin."""
        return self.same(a.o, b.o)

    def same_line(self, a: Frame, b: Frame) -> bool:
        """Whether two frames have one z axis and one origin."""
        return self.same(a.z, b.z) and self.same(a.o, b.o)

    def same_frame(self, a: Frame, b: Frame) -> bool:
        """Whether two frames are equal: x is square to z, and the doubles tell its way."""
        if not self.same_line(a, b) or not as_recorded(dot(a.x, b.x)) > 0.0:
            return False
        return self.parallel(self.undivided(a.x), self.undivided(b.x))


def subgroup_of(parts: Sequence[Part], tests: Tests) -> Subgroup | None:
    """The subgroup in which the joints of a loop move, cut joint left out; None where none of
    the three is found."""
    if not parts or not all(_is_drawn_once(part, tests) for part in parts):
        return None
    moving = [part for part in parts if part.type.freedoms]
    turning = [part for part in moving if part.type.motions != SLIDE]
    normal = _normal(moving, turning, tests)
    if not turning:
        return Subgroup(False, normal)
    if normal is not None:
        return Subgroup(True, normal)
    if len(turning) == len(moving):
        return _spherical(turning, tests)
    return None


def _is_drawn_once(part: Part, tests: Tests) -> bool:
    """Whether the displacement is that of its pair, from the drawing to the drawing: its two frames
    agree in all that the pair leaves alone."""
    before, after = part.before, part.after
    if part.type.is_ball:
        return tests.same_origin(before, after)
    if part.type.motions == TURN:
        return tests.same_line(before, after)
    return part.type.motions in (SLIDE, ()) and tests.same_frame(before, after)


def _normal(moving: Sequence[Part], turning: Sequence[Part], tests: Tests) -> Vector | None:
    """The direction about which all turn and square to which all slide."""
    slides = [tests.axis(part.before) for part in moving if part.type.motions == SLIDE]
    axes = [tests.axis(part.before) for part in turning]
    if any(part.type.is_ball for part in turning):
        return None
    normal = axes[0] if axes else _across(slides)
    if normal is None or not all(tests.parallel(normal, axis) for axis in axes[1:]):
        return None
    square = all(tests.is_square(normal, slide) for slide in slides)
    return normal if square else None


def _across(slides: Sequence[Vector]) -> Vector | None:
    """The direction square to slides, of which two are far from parallel."""
    pairs = [cross(slides[0], slide) for slide in slides[1:]]
    best = max(pairs, key=_size, default=None)
    return None if best is None or _size(best) == 0.0 else best


def _spherical(turning: Sequence[Part], tests: Tests) -> Subgroup | None:
    found = _meeting_point(turning, tests)
    if found is None:
        return None
    centre, weight = found
    group = Subgroup(True, None, centre, weight)
    for part in turning:
        off = off_centre(group, part.before.o)
        on_line = off if part.type.is_ball else cross(off, tests.axis(part.before))
        if not tests.vanishes(on_line):
            return None
    return group


def off_centre(group: Subgroup, point: Vector) -> Vector:
    """From a point to the centre of a spherical loop, times its weight."""
    assert group.centre is not None
    return subtract(group.centre, scale(group.weight, point))


def _meeting_point(turning: Sequence[Part], tests: Tests) -> tuple[Vector, float] | None:
    """The point of a ball, or that of the first axis next to the one that is least parallel to it,
    times a positive number: (c, weight)."""
    ball = next((part for part in turning if part.type.is_ball), None)
    if ball is not None:
        return ball.before.o, 1.0
    one, a = turning[0].before.o, tests.axis(turning[0].before)
    other = max(turning[1:], key=lambda part: _size(cross(a, part.before.z)), default=None)
    if other is None:
        return None
    b = tests.axis(other.before)
    normal = cross(a, b)
    weight = dot(normal, normal)
    if _size(normal) == 0.0:
        return None
    along = dot(cross(subtract(other.before.o, one), b), normal)
    return add(scale(weight, one), scale(along, a)), weight


def _size(vector: Vector) -> float:
    return max(abs(as_recorded(component)) for component in vector)


class _Loop(NamedTuple):
    """A loop's cut joint in the drawing, its subgroup, and the test of numbers."""

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


def _follow(closing: Constraint, loop: Loop, layout: Layout, tests: Tests) -> list[bool]:
    """Which equations of a cut joint follow from the others."""
    joint = closing.joint
    nothing = [False] * closing.equations
    conditions = closing.conditions
    edges = [layout.graph.edges[edge] for edge, _ in loop]
    if conditions is None or any(edge.hung for edge in edges):
        return nothing
    kinds = {condition.kind for condition in conditions}
    if not _is_closed(joint, kinds, tests):
        return nothing
    parts = [layout.carriers[k].part for edge, _ in loop for k in layout.parts_of[edge]]
    group = subgroup_of(parts, tests)
    if group is None:
        return nothing
    own = _Loop(joint, group, tests)
    return [one for condition in conditions for one in own.of(condition, kinds)]


def _is_closed(joint: Joint, kinds: Iterable[str], tests: Tests) -> bool:
    """Whether the frames of a cut joint coincide in the drawing, as far as it looks at them; an
    angle that it keeps is tested where that counts."""
    first, second = joint.on_first, joint.on_second
    if "orientation" in kinds:
        return tests.same_frame(first, second)
    return (tests.same_line if "parallel" in kinds else tests.same_origin)(first, second)


def equations_that_follow(session: Session) -> list[bool]:
    """Which closing equations of a session's plan hold where the others of their joint do, in the
    kernel's order: by the numbers of the text, whatever the coordinates are, where the side
    conditions of the cut joints hold.

    Raises:
        LookupError: the session is of no file.
        TraceLost: a number depends on the text in a way that no tape holds.
    """
    layout = session.precise.layout(session)
    tests = Tests(session.precise.recorder)
    closings = zip(layout.graph.closings, layout.graph.loops, strict=True)
    found = [_follow(closing, loop, layout, tests) for closing, loop in closings]
    return [one for equations in found for one in equations]
