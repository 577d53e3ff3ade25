"""What an entry of the joint table tells of a pair, and what follows from it.

A pair is a chain of elementary displacements from its first link to its second (`steps`); freedoms
count along that chain. What depends on the type is asked here, as a property, never by its letter.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Literal, NamedTuple

from mechkin_cli.mechanism.elementary import ELEMENTARY, Freedom
from mechkin_cli.mechanism.friction import FrictionLaw
from mechkin_cli.units import ANGLE, Dimension

FIRST, SECOND = 0, 1
"""The pair's links."""


class Drawn(NamedTuple):
    """A direction as drawn: an axis of the pair's frame on one link; `own` stands for the z of the
    frame that the drawing gives beside those two."""

    side: int
    axis: Literal["x", "y", "z", "own"] = "z"
    reverse: bool = False


class Condition(NamedTuple):
    """An elementary condition of a closing pair: lengths along some axes of the frame on one link,
    or one of directions: parallel axes, a common orientation, a kept angle of the axes."""

    kind: Literal["lengths", "parallel", "orientation", "angle"]
    axes: str = ""
    side: int = FIRST


class Step(NamedTuple):
    """A part of a pair: its letter, and along what it is drawn.

    Without `along` it is the one that leads from the drawing of the first link to that of the
    second; the parts before and behind it stand on one link. `between`: it rides on neither link,
    but square to the turn before it and the turn behind it.
    """

    letter: str
    along: Drawn | None = None
    between: bool = False


class Coordinate(NamedTuple):
    """A coordinate that users name: its dimension, its freedom along the chain, and its axis.

    `axis` None: one of two turns, about z of the first frame and then about z of the second, whose
    axes may be oblique, or any of a pair that holds nothing. `on_thread`: a length by a freedom
    that is an angle; the pitch is its scale.
    """

    name: str
    dimension: Dimension
    freedom: int
    axis: Drawn | None = Drawn(SECOND)
    on_thread: bool = False

    @property
    def is_angle(self) -> bool:
        """Whether it is an angle, else a length."""
        return self.dimension == ANGLE


class Drawing(NamedTuple):
    """How a pair's frames are drawn (building/joints.py), from which keys of its section."""

    kind: Literal["axis", "ball", "ball on", "plane", "two axes", "square axes", "slotted", "weld"]
    keys: tuple[str, ...] = ()
    cure: str = ""


@dataclass(frozen=True)
class JointType:
    """A pair.

    `named`: its coordinates; `axis`: what users see as its axis (normal, groove), None without
    one; `point_on`: the link that carries its point, None without one; `closing`: its kernel
    entry, None where it closes no loop; `parameter`: what that entry has to know of the drawing
    (`Joint.parameter`); `softer`: pairs on the same frames that cure a redundant constraint;
    `friction`: how it rubs, None where no law is known; `space`: freedoms of a body where the pair
    works, six, or three in a plane; `shape`: the pair as which it is drawn, where that is another.
    """

    letter: str
    steps: tuple[Step, ...]
    named: tuple[Coordinate, ...]
    drawing: Drawing
    axis: Drawn | None = None
    point_on: int | None = SECOND
    closing: str | None = None
    parameter: Literal["", "between axes", "from axis to pin"] = ""
    softer: tuple[str, ...] = ()
    friction: FrictionLaw | None = None
    space: int = 6
    shape: str = ""

    @cached_property
    def parts(self) -> tuple[str, ...]:
        """Letters of the elementary displacements."""
        return tuple(step.letter for step in self.steps)

    @cached_property
    def chain(self) -> tuple[Freedom, ...]:
        """Its freedoms."""
        return tuple(f for letter in self.parts for f in ELEMENTARY[letter].freedoms)

    @cached_property
    def freedoms(self) -> int:
        """Number of its freedoms."""
        return len(self.chain)

    @cached_property
    def equations(self) -> int:
        """Number of closing equations, 0 for a pair that closes no loop."""
        return self.space - self.freedoms if self.closing else 0

    @cached_property
    def code(self) -> int:
        """The kernel's code of its closing equations."""
        return _closing_codes()[self.closing or ""]

    @cached_property
    def coordinate(self) -> dict[str, Coordinate]:
        """Its coordinates by name."""
        return {coordinate.name: coordinate for coordinate in self.named}

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(self.coordinate)

    @cached_property
    def freedom_of(self) -> dict[str, int]:
        """The freedom of each coordinate."""
        return {coordinate.name: coordinate.freedom for coordinate in self.named}

    @cached_property
    def scalars(self) -> dict[str, int]:
        """The freedom of each coordinate, one coordinate to a freedom."""
        return {c.name: c.freedom for c in self.named if not c.on_thread}

    @cached_property
    def slides(self) -> tuple[bool, ...]:
        """For each freedom, whether it is a length."""
        return tuple(freedom.is_slide for freedom in self.chain)

    @cached_property
    def free(self) -> dict[str, tuple[tuple[int, Drawn | None], ...]]:
        """Of its freedoms that turn, and of those that slide: the steps that have them (`turn`,
        `slide`) with their directions."""
        return {
            motion: tuple(
                (number, step.along)
                for number, step in enumerate(self.steps)
                for freedom in ELEMENTARY[step.letter].freedoms
                if freedom.motion == motion
            )
            for motion in ("turn", "slide")
        }

    @property
    def has_point(self) -> bool:
        """Whether it has a point of its own."""
        return self.point_on is not None

    @property
    def has_slip(self) -> bool:
        """Whether its point rides on the first link and moves along the second."""
        return self.point_on == FIRST

    @cached_property
    def is_threaded(self) -> bool:
        """Whether it has a lead."""
        return any(ELEMENTARY[letter].is_thread for letter in self.parts)

    @cached_property
    def is_ball(self) -> bool:
        """Whether it is a ball and socket, nothing else."""
        return len(self.parts) == 1 and ELEMENTARY[self.parts[0]].is_ball

    @cached_property
    def is_slider(self) -> bool:
        """Whether it is a slide along an axis, nothing else."""
        return len(self.parts) == 1 and self.slides == (True,)

    @cached_property
    def is_guide(self) -> bool:
        """Whether it guides along or about one axis."""
        return len(self.parts) == 1 and ELEMENTARY[self.parts[0]].has_axis

    @cached_property
    def is_oriented(self) -> bool:
        """Whether it turns as a ball does: an orientation, for which no coordinate stands."""
        return any(ELEMENTARY[letter].is_ball for letter in self.parts)

    @property
    def is_free(self) -> bool:
        """Whether it holds nothing: it is no part of the machine, but tells or drives a pose."""
        return self.freedoms == 6


@cache
def _closing_codes() -> dict[str, int]:
    from mechkin_cli.kernel import _kernel

    return {row["letter"]: row["code"] for row in _kernel.joint_table()}
