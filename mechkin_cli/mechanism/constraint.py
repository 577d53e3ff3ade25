"""Constraints: equations between the coordinates of a mechanism, each with a multiplier.

A spanning tree has coordinates; whatever else holds links together is a constraint of one of the
kinds in this file. A kind says

- between which links it stands, for which joints, and by whose name it goes (`first`, `second`,
  `joints`, `joint`);
- its equations: how many, by which entry of the kernel (`kernel/core/joints`: residual, columns of
  the Jacobian, right sides for velocity, acceleration and jerk), on which frames and with which
  numbers of the drawing (`equations`, `code`, `frames`, `parameter`, `length`);
- what its multipliers are: the wrench on its second link, read off at `joint`; without coordinates,
  the line of its force (`force_line`);
- what it counts as: the freedoms that it leaves between its links, and whether a tree may go
  through it instead (`freedoms`, `has_coordinates`);
- between which coordinates its equation is, where it is one of joints anywhere in the mechanism
  (`terms`); it is then no edge between two links;
- which links of its own it places, with which freedoms, and how they spin idly (`links`,
  `own_edges`, `slides`, `hung`, `spin`);
- what it is called (`label`, `words`).

Nothing else asks for a kind: structure, plan, search, idle freedoms, tables and page read these. A
new kind is a class here, in `find_constraints` if no single joint is one, and an entry of the
kernel.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import cached_property

from mechkin_cli import tolerances
from mechkin_cli.mechanism.curve import CoordinateLaw
from mechkin_cli.mechanism.joint import GROUND_NAME, Joint, far_link, frame_on
from mechkin_cli.mechanism.pair_type import Attached, Condition, Rubbing
from mechkin_cli.mechanism.pairs import CLOSING_CONDITIONS
from mechkin_cli.mechanism.vectors import (
    Frame,
    Line,
    Vector,
    cross,
    dot,
    norm,
    scale,
    subtract,
)
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tape import largest

JointsAt = Mapping[str, tuple[Joint, ...]]
"""The joints at each link, in order."""


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
    where it is known, less than `most`; else the cable does what `words` say."""

    words: str
    drawn: float
    terms: tuple[Term, ...]
    most: float | None = None


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
    strands with `tensions`, by name. `pull` is what it pulls two points of links towards each
    other with (N) when it transmits nothing. `extents`: those of a cable. One that a cam keeps may
    know its `follower`, which is nothing to the motion. `loss`: what rubs in it."""

    terms: tuple[Term, ...]
    length: bool
    total: float = 0.0
    mesh: Mesh | None = None
    tensions: tuple[tuple[str, Tension], ...] = ()
    pull: tuple[Attached, Attached, float] | None = None
    extents: tuple[Extent, ...] = ()
    follower: Follower | None = None
    loss: Rubbing | None = None

    @property
    def has_teeth(self) -> bool:
        """Whether the force of its mesh is one."""
        return self.mesh is not None and self.mesh.other is None

    @property
    def pushes_apart(self) -> bool:
        """Whether it acts by a force that goes with the magnitude of its multiplier."""
        return self.mesh is not None and any(part != 0.0 for part in self.mesh.apart)


OwnEdge = tuple[Joint, str, str, bool]
"""A joint by which a constraint carries a link of its own, its parent and child, and whether two
points place that link, so that the joint has no freedom."""


@dataclass(frozen=True)
class Constraint:
    """Equations between two links; their multipliers are the wrench of `joint`, whose name they
    have.

    What follows are the answers of a kind that has none of its own.
    """

    joint: Joint
    first: str
    second: str

    @property
    def name(self) -> str:
        """Its joint's name."""
        return self.joint.name

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that it stands for, in order."""
        return (self.name,)

    @property
    def placed(self) -> tuple[str, ...]:
        """The links that stand where its equations say, those that they are written in and its
        own."""
        return self.joint.first, self.joint.second

    @property
    def is_reversed(self) -> bool:
        """Whether its multipliers push the joint's first link, not its second."""
        return False

    @property
    def equations(self) -> int:
        """Number of its equations."""
        return 1

    @property
    def space(self) -> int:
        """Freedoms of a free body where it works: six, or three in a plane."""
        return self.joint.type.space

    @property
    def freedoms(self) -> int:
        """Freedoms that it leaves between its links, its own included."""
        return self.space - self.equations + len(self.slides)

    @property
    def has_coordinates(self) -> bool:
        """Whether a tree may go through it, so that it has equations only where a loop is cut."""
        return False

    @property
    def conditions(self) -> tuple[Condition, ...] | None:
        """The elementary conditions of its equations, where nothing but frames stands in them."""
        return None

    @property
    def frames(self) -> tuple[Frame, Frame]:
        """Its frames as drawn on both links."""
        return self.joint.on_first, self.joint.on_second

    @property
    def points(self) -> tuple[Attached, ...]:
        """Its points on both links."""
        one, other = self.frames
        return Attached(self.first, one.o), Attached(self.second, other.o)

    @property
    def code(self) -> int:
        """The kernel's code of its equations."""
        return self.joint.type.code

    @property
    def parameter(self) -> float:
        """What its equations have to know of the drawing beside the frames."""
        return 0.0

    @property
    def length(self) -> float | None:
        """The length between its points that it keeps, in m."""
        return None

    def force_line(self, place: Callable[[Attached], Vector]) -> tuple[Vector, Vector]:
        """A point of the line of its force, and the unit vector along it, where `place` gives the
        points of links."""
        raise NotImplementedError

    @property
    def terms(self) -> tuple[Term, ...]:
        """The coordinates that its equation is between; none where it is between two links."""
        return ()

    @property
    def slides(self) -> tuple[Joint, ...]:
        """The slides between its own links, which its equations determine unless they are
        driven."""
        return ()

    @property
    def links(self) -> tuple[str, ...]:
        """Its own links."""
        return ()

    @property
    def own_edges(self) -> tuple[OwnEdge, ...]:
        """What carries its own links."""
        return ()

    @property
    def hung(self) -> DistanceConstraint | None:
        """The leg whose own links hang between its points and spin."""
        return None

    @property
    def kind(self) -> str:
        """The letter of its kind."""
        return self.joint.letter

    @property
    def label(self) -> str:
        """How it is called where loops are closed."""
        return f"{self.name} ({self.kind})"

    @property
    def words(self) -> str:
        """What its equations keep, where its joint does not tell."""
        return ""


@dataclass(frozen=True)
class PairConstraint(Constraint):
    """A joint that closes a loop: what the pair holds (`mechanism/pairs.py`)."""

    @classmethod
    def of(cls, joint: Joint) -> PairConstraint:
        """That of a joint."""
        return cls(joint, joint.first, joint.second)

    @property
    def equations(self) -> int:
        """As the joint table says; 0 for a pair that closes no loop."""
        return self.joint.type.equations

    @property
    def freedoms(self) -> int:
        """Those of the pair."""
        return self.joint.type.freedoms

    @property
    def has_coordinates(self) -> bool:
        """A tree may go through any joint."""
        return True

    @property
    def conditions(self) -> tuple[Condition, ...] | None:
        """As the joint table says."""
        return CLOSING_CONDITIONS.get(self.joint.type.closing or "")

    @property
    def parameter(self) -> float:
        """That of the joint."""
        return self.joint.parameter


# Distances: links with two spheres and telescopes between two spheres.
#
# A link whose only joints are two spherical joints (S-S), or two links that slide on each other
# along the line of their spheres (S-P-S), a *leg*, keep the distance of two points of other links
# and nothing else; they spin freely about the line of their spheres. So they close a loop with one
# equation, and need no freedom of their own.


@dataclass(frozen=True)
class DistanceConstraint(Constraint):
    """A leg from the sphere `start` on link `first` to the sphere `joint` on link `second`.

    `body` is the link at `start`; a telescope has a `rod` at the end that moves by `slide`.
    """

    start: Joint
    body: str
    slide: Joint | None = None
    rod: str | None = None

    @property
    def joints(self) -> tuple[str, ...]:
        """Both spheres, and the slide between them."""
        return (self.start.name, *(slide.name for slide in self.slides), self.name)

    @property
    def is_reversed(self) -> bool:
        """Where the sphere's first link is the one that the leg ends at."""
        return self.second == self.joint.first

    @property
    def frames(self) -> tuple[Frame, Frame]:
        """Those of its spheres on the links that it joins."""
        return frame_on(self.start, self.first), frame_on(self.joint, self.second)

    @property
    def length(self) -> float:
        """The distance of the spheres, the slide at zero, in m."""
        return norm(self.span)

    def force_line(self, place: Callable[[Attached], Vector]) -> tuple[Vector, Vector]:
        """From sphere to sphere."""
        foot, head = (place(at) for at in self.points)
        span = subtract(head, foot)
        return foot, scale(1.0 / (norm(span) or 1.0), span)

    @property
    def slides(self) -> tuple[Joint, ...]:
        """That of a telescope."""
        return () if self.slide is None else (self.slide,)

    @property
    def links(self) -> tuple[str, ...]:
        """The leg's own links."""
        return (self.body,) if self.rod is None else (self.body, self.rod)

    @property
    def own_edges(self) -> tuple[OwnEdge, ...]:
        """Its body hangs between the spheres, a rod slides on it."""
        hangs = (self.start, self.first, self.body, True)
        if self.slide is None or self.rod is None:
            return (hangs,)
        return hangs, (self.slide, self.body, self.rod, False)

    @property
    def hung(self) -> DistanceConstraint:
        """Body and rod hang on the line of the spheres and spin about it."""
        return self

    @property
    def label(self) -> str:
        """By its joints."""
        return "-".join(self.joints)

    @property
    def words(self) -> str:
        """The distance of its spheres."""
        return f"the distance {self.label}"

    @cached_property
    def span(self) -> Vector:
        """From sphere to sphere in the drawing of `body`, the slide at zero, in m."""
        return subtract(self._end_on_body(), frame_on(self.start, self.body).o)

    @cached_property
    def line(self) -> Vector:
        """Unit vector from sphere to sphere in the drawing of `body`."""
        span = self.span
        length = norm(span)
        if self.slide is None or length > 0.0:
            return scale(1.0 / length, span)
        return self._outward_axis()

    @cached_property
    def slide_sign(self) -> float:
        """Rate of the distance by the slide: 1 or -1; 0 without a slide."""
        if self.slide is None:
            return 0.0
        return 1.0 if dot(self._outward_axis(), self.line) > 0.0 else -1.0

    def line_of(self, link: str) -> Line:
        """The line of the spheres on the drawing of one of its own links."""
        if link == self.body:
            return Line(self.line, frame_on(self.start, link).o)
        assert self.slide is not None
        return Line(frame_on(self.slide, link).z, frame_on(self.joint, link).o)

    def _outward_axis(self) -> Vector:
        """The way in which the rod moves against `body` where the slide grows, in its drawing."""
        assert self.slide is not None
        axis = frame_on(self.slide, self.body).z
        return axis if self.slide.first == self.body else scale(-1.0, axis)

    def _end_on_body(self) -> Vector:
        if self.slide is None or self.rod is None:
            return frame_on(self.joint, self.body).o
        on_rod, on_body = frame_on(self.slide, self.rod), frame_on(self.slide, self.body)
        x, y, z = on_rod.local(frame_on(self.joint, self.rod).o)
        parts = (scale(x, on_body.x), scale(y, on_body.y), scale(z, on_body.z))
        place = on_body.o
        for part in parts:
            place = subtract(place, scale(-1.0, part))
        return place

    @property
    def is_straight(self) -> bool:
        """Whether the slide runs along the line of the spheres."""
        assert self.slide is not None
        off_line = cross(self.span, frame_on(self.slide, self.body).z)
        return norm(off_line) <= tolerances.LEG_SLIDE * norm(self.span)

    # the idle turn of its links about the line of its spheres: their pose is the shortest turn from
    # the drawing, and their rate about the line is zero (kernel/core/joints/hung_bodies.hpp)

    @property
    def idle_words(self) -> str:
        """The idle freedom of its links, which spin as one, in an engineer's words."""
        spins = "spins" if len(self.links) == 1 else "spin"
        line = f"{self.start.name}-{self.joint.name}"
        return f"{' and '.join(self.links)} {spins} freely about {line}"

    @property
    def lines(self) -> Mapping[str, Line | None]:
        """The line about which each link turns, on its own drawing."""
        return {link: self.line_of(link) for link in self.links}

    @property
    def convention(self) -> str:
        """What is told of the idle freedom by convention."""
        return "its pose is the shortest turn from the drawing and it does not spin"

    @property
    def cure(self) -> str:
        """How to have a pose of its own."""
        return "replace one S by U"

    @property
    def holding(self) -> str:
        """The quantity that holds it."""
        return f"{self.links[0]}.holding_moment"


def _distances(
    links: Iterable[str], joints_at: JointsAt, size: float
) -> Iterator[DistanceConstraint]:
    """The distances of a mechanism; none ends on another one's links."""
    taken: set[str] = set()
    ends: set[str] = set()
    for name in links:
        found = _distance_at(name, joints_at, taken, size)
        if found is None or ends & set(found.links) or taken & {found.first, found.second}:
            continue
        yield found
        taken.update(found.links)
        ends.update((found.first, found.second))


def _distance_at(
    name: str, joints_at: JointsAt, taken: Collection[str], size: float
) -> DistanceConstraint | None:
    """The distance whose first own link is `name`, if there is one; `size` is the drawing's."""
    if name == GROUND_NAME or name in taken or len(joints_at[name]) != 2:
        return None
    start, other = joints_at[name]
    if not start.type.is_ball:
        start, other = other, start
    if not start.type.is_ball:
        return None
    first = far_link(start, name)
    if other.type.is_ball:
        rigid = DistanceConstraint(other, first, far_link(other, name), start, name)
        apart = rigid.length > tolerances.PARALLEL * size
        return rigid if rigid.first != rigid.second and apart else None
    rod = far_link(other, name)
    if not other.type.is_slider or rod == GROUND_NAME or len(joints_at[rod]) != 2 or rod in taken:
        return None
    end = next(joint for joint in joints_at[rod] if joint is not other)
    if not end.type.is_ball:
        return None
    found = DistanceConstraint(end, first, far_link(end, rod), start, name, other, rod)
    return found if found.first != found.second and found.is_straight else None


# Couplings: relations between coordinates of joints anywhere in a mechanism.


@dataclass(frozen=True)
class CouplingConstraint(Constraint):
    """The sum of some coordinates, each with its factor, is given: a gear, a rack, a differential.

    Its multiplier is a moment (N m), or where the sum is a length a force (N): the effort at each
    of its coordinates per unit of the factor, on the joint's second link and opposite on its first.
    Its work at all of them together is zero.
    """

    own_name: str
    relation: Relation

    @property
    def name(self) -> str:
        """That in the file."""
        return self.own_name

    @property
    def joints(self) -> tuple[str, ...]:
        """It stands for none."""
        return ()

    @property
    def placed(self) -> tuple[str, ...]:
        """The links of its joints."""
        ends = (link for term in self.terms for link in (term.joint.first, term.joint.second))
        return tuple(dict.fromkeys(ends))

    @property
    def points(self) -> tuple[Attached, ...]:
        """It holds none."""
        return ()

    @property
    def terms(self) -> tuple[Term, ...]:
        """Those of the relation."""
        return self.relation.terms

    @property
    def kind(self) -> str:
        """A word, no letter of a pair."""
        return "coupling"

    @property
    def words(self) -> str:
        """Its coordinates, or that it is a cable."""
        if self.relation.extents:
            return f"the length of {self.name}"
        names = dict.fromkeys(f"{term.joint.name}.{term.coordinate}" for term in self.terms)
        return f"a relation between {', '.join(names)}"


def find_constraints(
    links: Iterable[str],
    joints: Iterable[Joint],
    joints_at: JointsAt,
    couplings: Mapping[str, Relation],
) -> tuple[Constraint, ...]:
    """What holds the links of a mechanism together and is no single joint: distances, then
    couplings."""
    size = largest(0.0, *(norm(joint.on_first.o) for joint in joints))
    related = (
        CouplingConstraint(relation.terms[0].joint, GROUND_NAME, GROUND_NAME, name, relation)
        for name, relation in couplings.items()
    )
    return (*_distances(links, joints_at, size), *related)


# Inputs of one motor: `drive: tie`.


class InputConstraint(NamedTuple):
    """A tie: the motor of input `leader`, which follows none, moves `input`, too (both by number).

    Its equation is between inputs, which are given row by row, so that it closes nothing and only
    its Jacobian is needed: the rate of the input by the leader. Its multiplier is the effort at the
    input, which the leader's motor carries at that rate.
    """

    input: int
    leader: int
