"""What couplings keep: sums of coordinates of joints anywhere in a mechanism, the forces by which
they act, and what is measured of cables."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from mechkin_cli.kernel.functions import total
from mechkin_cli.mechanism.curve import CoordinateLaw
from mechkin_cli.mechanism.joint import Joint
from mechkin_cli.mechanism.pair_type import Attached, Rubbing
from mechkin_cli.mechanism.vectors import Vector
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import cos, plain, sin, square_root

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Term(NamedTuple):
    """A joint's coordinate with its factor: a number, a length per rad (m) or an angle per length
    (rad/m); or where it has a law, a number times the law's value at the coordinate."""

    joint: Joint
    coordinate: str
    factor: float
    law: CoordinateLaw | None = None


class Mesh(NamedTuple):
    """Forces that a coupling acts by, on the carrier's drawing: a point (m) of the line of the
    first, as the pitch point of teeth, and that force on the second wheel per unit moment on the
    first: `along`, as of a flank, and `apart` per magnitude, both in 1/m. `way` leads from the
    first wheel to the second: joints, each passed from its first link to its second (1) or back
    (-1). `other`: point, `along` and `apart` of a second force."""

    carrier: str
    point: Vector
    along: Vector
    apart: Vector
    way: tuple[tuple[str, int], ...]
    other: tuple[Vector, Vector, Vector] | None = None

    def ends(self, joints: Mapping[str, Joint]) -> tuple[str, str]:
        """The links at both ends of its way: the first wheel and the second."""
        (first, ahead), (last, onward) = self.way[0], self.way[-1]
        one, other = joints[first], joints[last]
        return (
            one.first if ahead > 0 else one.second,
            other.second if onward > 0 else other.first,
        )


class Tension(NamedTuple):
    """What pulls in a strand (N): `along` per unit moment on the first wheel and `apart` per its
    magnitude (both 1/m), beside what is there `at_rest`."""

    along: float
    apart: float
    at_rest: float


class Extent(NamedTuple):
    """A length of a cable (m): as `drawn`, and what `terms` add to it. It is more than nothing and,
    where it is known, less than `most`; else the cable does what `words` say at `place`."""

    words: str
    place: str
    drawn: float
    terms: tuple[Term, ...]
    most: float | None = None

    def value(self, read: Callable[[Term], Floats]) -> Floats | float:
        """At the states at which `read` finds the terms (states,)."""
        value: Floats | float = plain(self.drawn) + total(read(term) for term in self.terms)
        return value


class Arm(NamedTuple):
    """From a pulley's centre to the end of a stretch in its plane: two components (m), as drawn,
    and the direction in which a `slide` moves it, if one does."""

    drawn: tuple[float, float]
    along: tuple[float, float]
    slide: Term | None

    def value(self, read: Callable[[Term], Floats]) -> list[Floats | float]:
        """Its components at the states at which `read` finds the terms (states,)."""
        by = 0.0 if self.slide is None else read(self.slide)
        return [plain(a) + by * plain(b) for a, b in zip(self.drawn, self.along, strict=True)]


class Swing(NamedTuple):
    """How far the `end` to which a pulley turns is on its right side (m), as `drawn`: to the left
    of another arm, its `base`, beyond the centre by an `offset`; else the pulley would swing round,
    which `words` say, at `place`. The end's arm turns in the pulley's plane by `turn`."""

    words: str
    place: str
    drawn: float
    offset: float
    base: Arm
    end: Arm
    turn: Term
    most: None = None

    def value(self, read: Callable[[Term], Floats]) -> Floats:
        """At the states at which `read` finds the terms (states,)."""
        turn = read(self.turn)
        (x, y), (out, beside) = self.base.value(read), self.end.value(read)
        across = out * cos(turn) - beside * sin(turn), out * sin(turn) + beside * cos(turn)
        aside = (x * across[1] - y * across[0]) / square_root(x * x + y * y)
        value: Floats = plain(self.offset) + aside
        return value


class Fleet(NamedTuple):
    """How a stretch of a cable leaves the plane of a pulley or its line: a `term` that is an angle
    (rad), or over the `length` of the stretch (m) the tangent of one; else the cable does what
    `words` say."""

    words: str
    term: Term
    length: float | None = None


class Follower(NamedTuple):
    """What a disc cam moves: it `oscillates` about a pivot or slides, with a `contact` by a knife's
    edge, a roller of a `radius` or a flat face. Lengths in m: the cam's base circle; by how much a
    slide's line passes the cam's axis, or a face its pivot; an oscillating one's arm and the
    distance of both axes."""

    oscillates: bool
    contact: str
    base_radius: float
    radius: float = 0.0
    offset: float = 0.0
    arm: float = 0.0
    distance: float = 0.0


class Relation(NamedTuple):
    """What a coupling keeps: the sum of its `terms`, an angle or a `length`, is `total` (rad,
    m). It acts along its coordinates, or by a `mesh`, whose work at them is the same: teeth, or
    strands with `tensions`, by name. `pulls` are what it pulls two points of links towards each
    other with (N) when it transmits nothing. `extents` and `fleets`: those of a cable. One that a
    cam keeps may know its `follower`, which is nothing to the motion. `loss`: what rubs in it."""

    terms: tuple[Term, ...]
    length: bool
    total: float = 0.0
    mesh: Mesh | None = None
    tensions: tuple[tuple[str, Tension], ...] = ()
    pulls: tuple[tuple[Attached, Attached, float], ...] = ()
    extents: tuple[Extent | Swing, ...] = ()
    fleets: tuple[Fleet, ...] = ()
    follower: Follower | None = None
    loss: Rubbing | None = None

    @property
    def has_play(self) -> bool:
        """Whether the last of its terms is the play of its flanks."""
        return self.terms[-1].joint.is_play

    @property
    def along_coordinates(self) -> tuple[Term, ...]:
        """The terms that it acts on along their coordinates: those that its mesh does not pass."""
        passed = () if self.mesh is None else [name for name, _ in self.mesh.way]
        return tuple(term for term in self.terms if term.joint.name not in passed)

    @property
    def has_teeth(self) -> bool:
        """Whether the force of its mesh is one, and no strand's."""
        return self.mesh is not None and self.mesh.other is None and not self.tensions

    @property
    def pushes_apart(self) -> bool:
        """Whether it acts by a force that goes with the magnitude of its multiplier."""
        return self.mesh is not None and any(part != 0.0 for part in self.mesh.apart)
