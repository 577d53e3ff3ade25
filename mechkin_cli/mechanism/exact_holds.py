"""Pairs that hold idle freedoms, on exact numbers: where they stand is that of the joints that they
belong to, along which axes they hold is a choice of the doubles.

An axis that was chosen in doubles is made a unit vector, and a frame of such axes orthonormal, so
that the pair is one; which one it is nothing but what is conventional depends on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import Frame, frame_about
from mechkin_cli.mechanism.held import Held
from mechkin_cli.mechanism.model import Joint, Mechanism
from mechkin_cli.mechanism.vectors import Vector, unit

Lift = Callable[[float], float]
"""A double as a recorded number."""


def exact_holds(held: Held, own: Mechanism, recorded: Mechanism, lift: Lift) -> Held:
    """What holds an idle freedom, with its pairs on recorded numbers.

    Args:
        held: in doubles.
        own: the mechanism in doubles.
        recorded: the same on a recording.
        lift: puts a double on that recording.
    """
    if held.told is None and held.stop is None:
        return held
    placed = _Placed(own, recorded, lift)
    told = None if held.told is None else placed.told(held.told)
    stop = None if held.stop is None else placed.stop(held.stop)
    return held._replace(told=told, stop=stop)


class _Placed:
    """Frames of made pairs by the points of the joints beside them."""

    def __init__(self, own: Mechanism, recorded: Mechanism, lift: Lift) -> None:
        self.own, self.recorded, self.lift = own, recorded, lift
        pairs = zip(_frames(own), _frames(recorded), strict=True)
        self.points: dict[Vector, Vector] = {one.o: other.o for one, other in pairs}

    def told(self, joint: Joint) -> Joint:
        """A joint told as other parts; those that it has as written stay what they are."""
        written = self.recorded.joints[joint.name]
        known = zip(self.own.joints[joint.name].parts, written.parts, strict=True)
        same = {id(one): other for one, other in known}
        parts = tuple(same.get(id(part)) or self._part(part) for part in joint.parts)
        return written._replace(parts=parts)

    def stop(self, joint: Joint) -> Joint:
        """A pair of its own beside a joint."""
        parts = tuple(map(self._part, joint.parts))
        first, second = self._frame(joint.on_first), self._frame(joint.on_second)
        return joint._replace(on_first=first, on_second=second, parts=parts)

    def _part(self, part: Part) -> Part:
        before = self._frame(part.before)
        after = before if part.after == part.before else self._frame(part.after)
        return part._replace(before=before, after=after)

    def _frame(self, frame: Frame) -> Frame:
        z, x = unit(self._lifted(frame.z)), self._lifted(frame.x)
        return frame_about(z, x, self.points[frame.o])

    def _lifted(self, vector: Vector) -> Vector:
        return (self.lift(vector[0]), self.lift(vector[1]), self.lift(vector[2]))


def _frames(mechanism: Mechanism) -> Iterator[Frame]:
    for joint in mechanism.joints.values():
        yield from (joint.on_first, joint.on_second)
        for part in joint.parts:
            yield from (part.before, part.after)
