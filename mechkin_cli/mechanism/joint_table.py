"""The joint table: everything that is known of a pair stands in its one entry.

A pair is a chain of elementary displacements from its first link to its second (`steps`); freedoms
count along that chain. Its closing equations, with their derivatives, the wrenches they transmit
and the side condition that tells an assembly from a false root of them, are composed in the
kernel's entry of the letter `closing` (kernel/src/pairs.hpp).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Literal, NamedTuple

from mechkin_cli.mechanism.elementary import ELEMENTARY, Freedom
from mechkin_cli.units import ANGLE, LENGTH, Dimension

FIRST, SECOND = 0, 1
"""The pair's links."""


class Drawn(NamedTuple):
    """A direction as drawn: an axis of the pair's frame on one link; `own` stands for the z of the
    frame that the drawing gives beside those two."""

    side: int
    axis: Literal["x", "y", "z", "own"] = "z"
    reverse: bool = False


class Step(NamedTuple):
    """A part of a pair: its letter, and along what it is drawn.

    Without `along` it is the one that leads from the drawing of the first link to that of the
    second; the parts before and behind it stand on one link.
    """

    letter: str
    along: Drawn | None = None


class Coordinate(NamedTuple):
    """A coordinate that users name: its dimension, its freedom along the chain, and its axis.

    `axis` None: one of two turns, about z of the first frame and then about z of the second, whose
    axes may be oblique. `on_thread`: a length by a freedom that is an angle; the pitch is its
    scale.
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
    (`Joint.parameter`); `softer`: pairs on the same frames that cure a redundant constraint.
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
        return 6 - self.freedoms if self.closing else 0

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
        """Whether it holds nothing."""
        return self.freedoms == 6


_X1, _Y1, _Z1 = Drawn(FIRST, "x"), Drawn(FIRST, "y"), Drawn(FIRST)
_X2, _Y2, _Z2 = Drawn(SECOND, "x"), Drawn(SECOND, "y"), Drawn(SECOND)
_BACK = Drawn(SECOND, reverse=True)
_OWN = Drawn(FIRST, "own")


def _angle(name: str, freedom: int, axis: Drawn | None = _Z2) -> Coordinate:
    return Coordinate(name, ANGLE, freedom, axis)


def _length(name: str, freedom: int, axis: Drawn = _Z2, *, on_thread: bool = False) -> Coordinate:
    return Coordinate(name, LENGTH, freedom, axis, on_thread)


def _turns(freedom: int) -> tuple[Coordinate, Coordinate]:
    return _angle("theta1", freedom, None), _angle("theta2", freedom + 1, None)


_TWO_TURNS = (Step("R"), Step("R", _Z2))
_AXIS = Drawing("axis", ("axis",))

_TABLE = (
    JointType(
        "R",
        (Step("R"),),
        (_angle("theta", 0),),
        _AXIS,
        axis=_Z2,
        closing="R",
        softer=("S", "C"),
    ),
    JointType("P", (Step("P"),), (_length("s", 0),), _AXIS, axis=_Z2, closing="P", softer=("C",)),
    # a closing joint would lose the count of its turns
    JointType(
        "H",
        (Step("H"),),
        (_angle("theta", 0), _length("s", 0, on_thread=True)),
        _AXIS,
        axis=_Z2,
    ),
    JointType(
        "C", (Step("C"),), (_angle("theta", 0), _length("s", 1)), _AXIS, axis=_Z2, closing="C"
    ),
    JointType("S", (Step("S"),), (), Drawing("ball"), closing="S"),
    JointType(
        "Sp",
        (Step("S"), Step("P", _X2), Step("P", _Y2)),
        (),
        Drawing("ball on", ("normal",)),
        axis=_Z2,
        point_on=FIRST,
        closing="Sp",
    ),
    # where s grows, the second link runs back along its groove
    JointType(
        "Sg",
        (Step("S"), Step("P", _BACK)),
        (_length("s", 3, _BACK),),
        Drawing("ball on", ("groove",)),
        axis=_Z2,
        point_on=FIRST,
        closing="Sg",
    ),
    JointType(
        "U",
        _TWO_TURNS,
        _turns(0),
        Drawing("two axes", ("axis", "axis2")),
        closing="U",
        parameter="between axes",
    ),
    JointType(
        "E",
        (Step("P", _X1), Step("P", _Y1), Step("R")),
        (_length("x", 0, _X1), _length("y", 1, _Y1), _angle("theta", 2)),
        Drawing("plane", ("normal", "x")),
        axis=_Z2,
        closing="E",
    ),
    JointType("W", (Step("W"),), (), Drawing("weld"), point_on=None, closing="W"),
    # a universal joint with square axes
    JointType(
        "Ss",
        _TWO_TURNS,
        _turns(0),
        Drawing(
            "square axes",
            ("slot", "pin"),
            "the slot's plane holds the pin: give the normal of that plane",
        ),
        closing="U",
    ),
    JointType(
        "Sc",
        (Step("P", _OWN), *_TWO_TURNS),
        (_length("s", 0, _OWN), *_turns(1)),
        Drawing("slotted", ("axis", "pin")),
        axis=_OWN,
        closing="Sc",
        parameter="from axis to pin",
    ),
    JointType(
        "Cp",
        (*_TWO_TURNS, Step("P", _X2), Step("P", _Y2)),
        (*_turns(0), _length("x", 2, _X2), _length("y", 3, _Y2)),
        Drawing(
            "square axes",
            ("axis", "normal"),
            "a cylinder touches a plane along a line only with its axis square to the normal",
        ),
        axis=_Z1,
        point_on=FIRST,
        closing="Cp",
    ),
)

JOINT_TYPES = {entry.letter: entry for entry in _TABLE}
"""The pairs that a file may have, by letter."""

FREE = JointType(
    "F",
    (Step("P", _X1), Step("P", _Y1), Step("P", _Z1), Step("S")),
    (_length("x", 0, _X1), _length("y", 1, _Y1), _length("z", 2, _Z1)),
    Drawing("ball"),
)
"""The pair without constraints by which the solver hangs a body that only legs hold."""


@cache
def joint_type(letter: str) -> JointType:
    """The entry of a letter."""
    return FREE if letter == FREE.letter else JOINT_TYPES[letter]


def dimension_of(coordinate: str) -> Dimension:
    """What coordinates of this name measure, in every pair that has it; a length where none has.

    >>> dimension_of("theta1") == ANGLE
    True
    """
    return ANGLE if coordinate in _angles() else LENGTH


def is_angle(coordinate: str) -> bool:
    """Whether coordinates of this name are angles."""
    return coordinate in _angles()


@cache
def _angles() -> frozenset[str]:
    return frozenset(c.name for entry in _TABLE for c in entry.named if c.is_angle)


@cache
def _closing_codes() -> dict[str, int]:
    from mechkin_cli.kernel import _kernel

    return {row["letter"]: row["code"] for row in _kernel.joint_table()}
