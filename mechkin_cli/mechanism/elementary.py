"""The elementary displacements of which every pair is a chain, with their freedom screws.

A displacement moves its frame on the body after it against the frame on the body before it. Its
screws go through that frame's origin along its axes; they stand still in the body before it.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, cross, scale

Screw = tuple[Vector, Vector]
"""Angular velocity, and velocity of the point at the origin, for a unit rate of a freedom."""


class Freedom(NamedTuple):
    """A freedom of an elementary displacement: its motion, and along which axis of the frame.

    A thread turns and slides in one; the three turns of a ball have no coordinate of their own.
    """

    motion: Literal["turn", "slide", "thread", "ball"]
    axis: Literal["x", "y", "z"] = "z"

    @property
    def is_slide(self) -> bool:
        """Whether its unit is a length."""
        return self.motion == "slide"

    @property
    def is_cyclic(self) -> bool:
        """Whether a full turn of it is the same place again."""
        return self.motion == "turn"


class Elementary(NamedTuple):
    """An elementary displacement; `code` is the kernel's, `states` the length of its state."""

    letter: str
    code: int
    freedoms: tuple[Freedom, ...]
    states: int

    @property
    def is_ball(self) -> bool:
        """Whether its state is a unit quaternion, scalar first."""
        return self.states > len(self.freedoms)

    @property
    def motions(self) -> tuple[str, ...]:
        """What its freedoms are: `("turn",)`, `("slide",)`."""
        return tuple(freedom.motion for freedom in self.freedoms)

    @property
    def is_thread(self) -> bool:
        """Whether it has a lead, and counts its turns."""
        return any(freedom.motion == "thread" for freedom in self.freedoms)

    @property
    def has_axis(self) -> bool:
        """Whether it has one axis, the z of its frame."""
        return bool(self.freedoms) and not self.is_ball

    @property
    def slides(self) -> tuple[bool, ...]:
        """For each freedom, whether it is a length."""
        return tuple(freedom.is_slide for freedom in self.freedoms)


_TURN, _SLIDE, _THREAD = Freedom("turn"), Freedom("slide"), Freedom("thread")
_BALL = (Freedom("ball", "x"), Freedom("ball", "y"), Freedom("ball", "z"))

ELEMENTARY = {
    "R": Elementary("R", 0, (_TURN,), 1),
    "P": Elementary("P", 1, (_SLIDE,), 1),
    "H": Elementary("H", 2, (_THREAD,), 1),
    "C": Elementary("C", 3, (_TURN, _SLIDE), 2),
    "S": Elementary("S", 4, _BALL, 4),
    "W": Elementary("W", 5, (), 0),
    "L": Elementary("L", 6, (), 0),
}
"""By letter; W keeps two frames together, L hangs the body of a leg between two points."""


class Part(NamedTuple):
    """An elementary displacement of a joint's chain; its frame as drawn on the body before and
    after it, and its coordinate where these are as drawn (m)."""

    letter: str
    before: Frame
    after: Frame
    drawn: float = 0.0

    @property
    def type(self) -> Elementary:
        """Its row among the elementary displacements."""
        return ELEMENTARY[self.letter]

    def reversed(self) -> Part:
        """The same part passed the other way: the same coordinate about the reversed axis."""
        if not self.type.has_axis:
            return Part(self.letter, self.after, self.before, self.drawn)
        return Part(self.letter, self.after.flipped(), self.before.flipped(), self.drawn)

    def screws(self, pitch: float) -> tuple[Screw, ...]:
        """The unit screws of its freedoms as drawn on the body before it; `pitch` in m per rad."""
        return screws_at(self.letter, self.before, pitch)


def screws_at(letter: str, frame: Frame, pitch: float) -> tuple[Screw, ...]:
    """The unit screws of an elementary displacement about a frame, one per freedom.

    >>> from mechkin_cli.mechanism.frames import upright
    >>> screws_at("H", upright((1.0, 0.0, 0.0)), 0.5)
    (((0.0, 0.0, 1.0), (0.0, -1.0, 0.5)),)
    """
    found: list[Screw] = []
    for freedom in ELEMENTARY[letter].freedoms:
        axis: Vector = getattr(frame, freedom.axis)
        if freedom.is_slide:
            found.append((ZERO, axis))
        else:
            along = pitch if freedom.motion == "thread" else 0.0
            found.append((axis, add(cross(frame.o, axis), scale(along, axis))))
    return tuple(found)
