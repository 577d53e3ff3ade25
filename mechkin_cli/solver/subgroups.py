"""Loops whose joints all move in one subgroup of the displacements, by the numbers of the text.

A loop is *planar* where every joint turns about one direction or slides square to it, *spherical*
where every joint turns about one point, *translational* where every joint slides. Products of such
displacements are such again (J. M. Herve, Mechanism and Machine Theory 13, 1978), so that whatever
the coordinates are, the two sides of the joint that closes the loop are placed against each other
by a displacement of the subgroup. All of it is decided by identities (`tape.identities`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.vectors import Vector, add, cross, dot, scale, subtract
from mechkin_cli.tape.identities import Identities
from mechkin_cli.tape.scalars import as_recorded
from mechkin_cli.tape.traced import register

if TYPE_CHECKING:
    from mechkin_cli.mechanism.elementary import Part
    from mechkin_cli.tape.exact_recorder import ExactRecorder


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
    """The subgroup in which the joints of a loop move, closing joint left out; None where none of
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
