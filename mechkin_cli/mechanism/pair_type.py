"""The elementary displacements of which every pair is a chain, with their freedom screws.

A displacement moves its frame on the body after it against the frame on the body before it. Its
screws go through that frame's origin along its axes; they stand still in the body before it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache, cached_property
from typing import TYPE_CHECKING, Literal

from mechkin_cli.mechanism.track import Track
from mechkin_cli.mechanism.vectors import ZERO, Frame, Vector, add, cross, scale, subtract
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tape import cos, square_root
from mechkin_cli.units import LENGTH, Dimension

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Place


Screw = tuple[Vector, Vector]
"""Angular velocity, and velocity of the point at the origin, for a unit rate of a freedom."""


class Freedom(NamedTuple):
    """A freedom of an elementary displacement: its motion, and along which axis of the frame.

    A thread turns and slides in one; the three turns of a ball have no coordinate of their own; a
    carriage goes along a curve or over a surface by a parameter, a plain number. Turns are
    `counted` where something else goes by their number.
    """

    motion: Literal["turn", "slide", "thread", "ball", "carriage"]
    axis: Literal["x", "y", "z"] = "z"
    counted: bool = False

    @property
    def is_slide(self) -> bool:
        """Whether its unit is a length."""
        return self.motion == "slide"

    @property
    def is_cyclic(self) -> bool:
        """Whether a full turn of it is the same place again."""
        return self.motion == "turn" and not self.counted


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
        """Whether it has a lead."""
        return any(freedom.motion == "thread" for freedom in self.freedoms)

    @property
    def counts_turns(self) -> bool:
        """Whether a full turn of it is another place, as of a thread."""
        return self.is_thread or any(freedom.counted for freedom in self.freedoms)

    @property
    def has_axis(self) -> bool:
        """Whether it has one axis, the z of its frame."""
        return bool(self.freedoms) and not (self.is_ball or self.is_carriage)

    @property
    def is_carriage(self) -> bool:
        """Whether it goes along a curve or over a surface."""
        return "carriage" in self.motions

    @property
    def slides(self) -> tuple[bool, ...]:
        """For each freedom, whether it is a length."""
        return tuple(freedom.is_slide for freedom in self.freedoms)


_TURN, _SLIDE, _THREAD = Freedom("turn"), Freedom("slide"), Freedom("thread")
_COUNTED = Freedom("turn", counted=True)
_CARRIAGE = Freedom("carriage")
_BALL = (Freedom("ball", "x"), Freedom("ball", "y"), Freedom("ball", "z"))

ELEMENTARY = {
    "R": Elementary("R", 0, (_TURN,), 1),
    "P": Elementary("P", 1, (_SLIDE,), 1),
    "H": Elementary("H", 2, (_THREAD,), 1),
    "C": Elementary("C", 3, (_TURN, _SLIDE), 2),
    "S": Elementary("S", 4, _BALL, 4),
    "W": Elementary("W", 5, (), 0),
    "L": Elementary("L", 6, (), 0),
    "T": Elementary("T", 2, (_COUNTED,), 1),
    "G": Elementary("G", 7, (_CARRIAGE,), 1),
    "A": Elementary("A", 8, (_CARRIAGE, _CARRIAGE), 2),
}
"""By letter; W keeps two frames together, L hangs a body between two points, T is a turn that is
counted: to the kernel a thread without lead; G goes along a curve, A over a surface."""


COUNTED_AS = {"R": ("T",), "C": ("T", "P")}
"""Displacements in whose place others count the turns."""


class Part(NamedTuple):
    """An elementary displacement of a joint's chain; its frame as drawn on the body before and
    after it, and its coordinate where these are as drawn (m).

    A carriage has its `track`, which rides on the body before it (`sense` 1) or after it (-1) and
    leads from the frames' origin; `at`: its parameters as drawn.
    """

    letter: str
    before: Frame
    after: Frame
    drawn: float = 0.0
    track: Track | None = None
    sense: float = 1.0
    at: tuple[float, ...] = ()

    @property
    def type(self) -> Elementary:
        """Its row among the elementary displacements."""
        return ELEMENTARY[self.letter]

    def reversed(self) -> Part:
        """The same part passed the other way: the same coordinate about the reversed axis."""
        if not self.type.has_axis:
            back = self._replace(before=self.after, after=self.before)
            return back._replace(sense=-self.sense) if self.track else back
        return Part(self.letter, self.after.flipped(), self.before.flipped(), self.drawn)

    @property
    def way(self) -> Vector:
        """How far it is displaced as drawn."""
        if self.track is None:
            return scale(self.drawn, self.before.z)
        return scale(self.sense, subtract(self.track.place(self.at), self.before.o))

    def counted(self) -> tuple[Part, ...]:
        """The parts that count its turns; itself where it has none."""
        first, *rest = COUNTED_AS.get(self.letter, (self.letter,))
        others = (Part(letter, self.after, self.after) for letter in rest)
        return self._replace(letter=first), *others

    def screws(self, pitch: float) -> tuple[Screw, ...]:
        """The unit screws of its freedoms as drawn on the body before it; `pitch` in m per rad."""
        if self.track is not None:
            return tuple((ZERO, scale(self.sense, slope)) for slope in self.track.slopes(self.at))
        return screws_at(self.letter, self.before, pitch)


def screws_at(letter: str, frame: Frame, pitch: float) -> tuple[Screw, ...]:
    """The unit screws of an elementary displacement about a frame, one per freedom.

    >>> from mechkin_cli.mechanism.vectors import upright
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


# Coulomb friction of joints: of each pair what rubs, and what its contacts carry.
#
# One friction force, the coefficient times the normal load of the joint, acts against the velocity
# of the surfaces, which is made of slides and of turns by a radius. The normal load is a weighted
# sum of magnitudes that are linear in the joint's force F and moment M about its point
# (docs/friction.md).

Motion = Literal["along", "square", "all"]
"""Along (about) the joint's axis, square to it, or in every direction."""


class Loss(NamedTuple):
    """Where a coupling rubs: link `second` on `first`, turning about (`turns`) or sliding along an
    axis through a point (m), both on the carrier's drawing. `load`: the normal load by a unit of
    the coupling's multiplier, 1 or a ratio about an axis, in 1/m along one. About an axis it is the
    mean of the moments on both sides of the loss. `leading`: coordinates of the coupling's first
    wheel, and whether they count as the first of them (1) or backwards (-1); `at_first`: the share
    of the lost power that is taken from that wheel, in its turn."""

    carrier: str
    first: str
    second: str
    point: Vector
    axis: Vector
    turns: bool
    load: float
    leading: tuple[tuple[str, int], ...]
    at_first: float


class Rubbing(NamedTuple):
    """The friction of a joint, or of the coupling that has a `loss`, in SI.

    `at_rest`, `sliding`: coefficients; `speed`: from one to the other, None where the coefficient
    falls at once. The lengths are None where they are not given; `across`: the direction of the
    width; `flank`: half the angle of the thread; `place`: where the file says it.
    """

    joint: str
    at_rest: float
    sliding: float
    speed: float | None = None
    radius: float | None = None
    length: float | None = None
    collar: float | None = None
    width: float | None = None
    flank: float | None = None
    across: Attached | None = None
    place: Place | None = None
    loss: Loss | None = None

    @property
    def word(self) -> str:
        """What its key in the file is called: `friction`, or `efficiency` of a coupling."""
        return "efficiency" if self.loss is not None and self.loss.turns else "friction"


def rubbing_words(named: Iterable[Rubbing]) -> str:
    """`friction of A, B and efficiency of G`: joints and couplings by what rubs there."""
    names: dict[str, list[str]] = {}
    for one in named:
        names.setdefault(one.word, []).append(one.joint)
    return " and ".join(f"{word} of {', '.join(own)}" for word, own in names.items())


class Contact(NamedTuple):
    """A magnitude in the normal load, `weight` times (z: the joint's axis, F_r = F - (z.F) z)

    - radial: |share F_r + tilt M x z|,
    - along: |share u.F + tilt u.(M x z) + roll z.M|, u: the direction, as drawn,
    - total: share |F|.
    """

    kind: Literal["radial", "along", "total"]
    weight: float = 1.0
    share: float = 0.0
    tilt: float = 0.0
    roll: float = 0.0
    direction: Vector = ZERO


Contacts = Callable[[Rubbing, Vector, float], Iterator[Contact]]
"""The contacts of a friction at a joint with an axis as drawn and a pitch (m per rad)."""


class FrictionLaw(NamedTuple):
    """How a pair rubs: in which of its turns and slides, by which contacts, from which keys.

    `needs` are keys that must be given; `missed`: what is not counted without a key.
    """

    contacts: Contacts
    turns: Motion | None = None
    slides: Motion | None = None
    needs: tuple[str, ...] = ()
    may: tuple[str, ...] = ()
    missed: tuple[tuple[str, Literal["tilting moment", "axial force", "moment about it"]], ...] = ()


def _bearings(rubbing: Rubbing) -> tuple[tuple[float, float], ...]:
    """Share and tilt of the bearings along an axis: one, or two `length` apart."""
    if rubbing.length is None:
        return ((1.0, 0.0),)
    return (0.5, 1.0 / rubbing.length), (0.5, -1.0 / rubbing.length)


def journal(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """Bearings that take radial force and tilting moment, and a collar for the axial force."""
    for share, tilt in _bearings(rubbing):
        yield Contact("radial", 1.0, share, tilt)
    if rubbing.collar is not None:
        assert rubbing.radius is not None
        yield Contact("along", rubbing.collar / rubbing.radius, 1.0, direction=axis)


def guide(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """Shoes at both ends of a length, on both sides of a width.

    With `across` each shoe has a face along the width and one square to it; without, it takes its
    part of force and tilting moment as one vector, and its part of the moment about the axis in
    full.
    """
    width, across = rubbing.width, rubbing.across
    for share, tilt in _bearings(rubbing):
        if across is None or width is None:
            yield Contact("radial", 1.0, share, tilt)
            continue
        yield Contact("along", 1.0, share, tilt, direction=across.vector)
        up = cross(axis, across.vector)
        for side in (1.0, -1.0):
            roll = side * share / width
            yield Contact("along", 1.0, 0.5 * share, 0.5 * tilt, roll, up)
    if across is None and width is not None:
        yield Contact("along", 2.0 / width, roll=1.0)


def thread(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """The flanks of a thread, by the force square to the helix on the mean cylinder."""
    radius = rubbing.radius
    assert radius is not None
    turn = square_root(radius * radius + pitch * pitch)
    flank = 1.0 if rubbing.flank is None else cos(rubbing.flank)
    yield Contact(
        "along", 1.0 / flank, radius / turn, roll=-pitch / (turn * radius), direction=axis
    )


def ball(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere in its socket."""
    yield Contact("total", 1.0, 1.0)


def plane(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere on a plane."""
    yield Contact("along", 1.0, 1.0, direction=axis)


def groove(rubbing: Rubbing, axis: Vector, pitch: float) -> Iterator[Contact]:
    """A sphere in a groove."""
    yield Contact("radial", 1.0, 1.0)


# What an entry of the joint table tells of a pair, and what follows from it.
#
# A pair is a chain of elementary displacements from its first link to its second (`steps`);
# freedoms count along that chain. What depends on the type is asked here, as a property, never by
# its letter.

FIRST, SECOND = 0, 1
"""The pair's links."""


class DrawnDirection(NamedTuple):
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


class PairStep(NamedTuple):
    """A part of a pair: its letter, and along what it is drawn.

    Without `along` it is the one that leads from the drawing of the first link to that of the
    second; the parts before and behind it stand on one link. `between`: it rides on neither link,
    but square to the turn before it and the turn behind it.
    """

    letter: str
    along: DrawnDirection | None = None
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
    axis: DrawnDirection | None = DrawnDirection(SECOND)
    on_thread: bool = False

    @property
    def is_angle(self) -> bool:
        """Whether it is an angle, else a length; the parameter of a curve, a number, counts as an
        angle."""
        return self.dimension != LENGTH


class Drawing(NamedTuple):
    """How a pair's frames are drawn, from which keys of its section: the `kind` is one of those of
    building/joints.py, or of a pair on a track (building/tracks.py)."""

    kind: str
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
    steps: tuple[PairStep, ...]
    named: tuple[Coordinate, ...]
    drawing: Drawing
    axis: DrawnDirection | None = None
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
    def free(self) -> dict[str, tuple[tuple[int, DrawnDirection | None], ...]]:
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
    def is_carried(self) -> bool:
        """Whether it goes along a curve or over a surface."""
        return any(ELEMENTARY[letter].is_carriage for letter in self.parts)

    @cached_property
    def is_threaded(self) -> bool:
        """Whether it has a lead."""
        return any(ELEMENTARY[letter].is_thread for letter in self.parts)

    @cached_property
    def counts_turns(self) -> bool:
        """Whether a full turn of some coordinate is another place."""
        return any(ELEMENTARY[letter].counts_turns for letter in self.parts)

    @cached_property
    def is_ball(self) -> bool:
        """Whether it is a ball and socket, nothing else."""
        return len(self.parts) == 1 and ELEMENTARY[self.parts[0]].is_ball

    @cached_property
    def is_slider(self) -> bool:
        """Whether it is a slide along an axis, nothing else."""
        return len(self.parts) == 1 and self.slides == (True,)

    @cached_property
    def is_bearing(self) -> bool:
        """Whether it turns about one axis, and at most slides along it freely."""
        axes = {coordinate.axis for coordinate in self.named}
        angles = sum(coordinate.is_angle for coordinate in self.named)
        return angles == len(axes) == 1 and None not in axes and not self.is_threaded

    @cached_property
    def is_guide(self) -> bool:
        """Whether it guides along or about one axis."""
        return len(self.parts) == 1 and ELEMENTARY[self.parts[0]].has_axis

    @cached_property
    def is_oriented(self) -> bool:
        """Whether it turns as a ball does: an orientation, for which no coordinate stands."""
        return any(ELEMENTARY[letter].is_ball for letter in self.parts)

    @cached_property
    def turns_in_plane(self) -> bool:
        """Whether it is a pair of a plane that turns: it holds by a force through its point."""
        return self.space == 3 and any(coordinate.is_angle for coordinate in self.named)

    @property
    def is_free(self) -> bool:
        """Whether it holds nothing: it is no part of the machine, but tells or drives a pose."""
        return self.freedoms == 6


@cache
def _closing_codes() -> dict[str, int]:
    from mechkin_cli.kernel import _kernel

    return {row["letter"]: row["code"] for row in _kernel.joint_table()}


class Attached(NamedTuple):
    """A point or a direction carried by a link, as drawn at home."""

    link: str
    vector: Vector
