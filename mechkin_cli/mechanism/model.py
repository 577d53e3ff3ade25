"""A mechanism as data: SI units, home drawing, ground axes.

Links are the vertices and joints the edges of the mechanism graph; `ground` is the link that does
not move.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import SHORT_LIST
from mechkin_cli.exact import TURN
from mechkin_cli.mechanism.pair_type import (
    FIRST,
    SECOND,
    Attached,
    DrawnDirection,
    JointType,
    Part,
    Rubbing,
    Screw,
)
from mechkin_cli.mechanism.pairs import JOINT_TYPES, joint_type
from mechkin_cli.mechanism.vectors import (
    ZERO,
    Frame,
    Vector,
    cross,
    dot,
    frame_about,
    norm,
    perpendicular,
    scale,
    subtract,
    upright,
)
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.tape import largest, nonzero, smallest

if TYPE_CHECKING:
    from mechkin_cli.mechanism.wanted import Wanted


# Where the efforts act that keep up the motion of the inputs: at these, or at actuators.
#
# The motion is prescribed at the inputs. Without actuators each input has a drive of its own,
# unless a tie moves it: then the motor of the input that it follows carries what the tie transmits.
# Actuators do the virtual work of the inputs' generalised efforts: J^T t = Q, where J are the rates
# of the actuators' coordinates by those of the inputs (docs/numerics.md, Actuators).

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Drives(NamedTuple):
    """The inputs, the actuators (none: the inputs' own drives), and ties (input, leader) by number
    of the inputs; a leader is tied to nothing, an input may be tied to several."""

    inputs: tuple[Coordinate, ...]
    actuators: tuple[Coordinate, ...] = ()
    ties: tuple[tuple[int, int], ...] = ()

    @property
    def acting(self) -> tuple[Coordinate, ...]:
        """Where efforts act."""
        return self.actuators or self.inputs

    @property
    def freedoms(self) -> int:
        """How many inputs move on their own."""
        return len(self.inputs) - len({tied for tied, _ in self.ties})

    @property
    def are_plain(self) -> bool:
        """Whether each input has a drive of its own."""
        return not self.actuators and not self.ties


def without_effort(
    name: str, quantities: Mapping[str, Wanted], drives: Drives | None, *, response: bool = False
) -> str | None:
    """Why nothing acts where `name` asks for an effort, where efforts act, and what to do; None for
    other names.

    Args:
        name: of a quantity that there is not, such as `B.effort` or `B.s.effort`.
        quantities: those that there are, by name.
        drives: of a sweep.
        response: whether the rows are those of a response, whose file gives the efforts.
    """
    owner, _, word = name.rpartition(".")
    if word != "effort":
        return None
    places = {
        wanted.name: wanted
        for wanted in quantities.values()
        if wanted.kind == "coordinate" and wanted.order == 0
    }
    here = [full for full, wanted in places.items() if owner in (full, wanted.owner)]
    efforts = {full: f"{full}.effort" for full in places if f"{full}.effort" in quantities}
    asked = [efforts[full] for full in here if full in efforts]
    if asked:
        return f"it has two efforts: ask for {' or '.join(asked)}"
    if not here:
        if all(wanted.owner != owner for wanted in quantities.values()):
            return None
        return f"{owner} has no coordinate: {_listed('efforts act at', efforts, quantities)}"
    at = " and ".join(here)
    if response:
        acting = _listed("efforts act at", efforts, quantities)
        return f"no effort acts at {at} in this response: {acting}, or name {at} under efforts"
    if drives is not None and drives.actuators:
        is_input = here[0] in (".".join(pair) for pair in drives.inputs)
        acting = _listed("actuators act at", efforts, quantities)
        what = f"the input {at}" if is_input else at
        return f"no effort acts at {what}: {acting}, or add {at} to actuators"
    what = "are not inputs" if len(here) > 1 else "is not an input"
    inputs = _listed("inputs are" if len(efforts) > 1 else "the input is", efforts, quantities)
    return f"{at} {what}: {inputs}, or drive {at}"


def _listed(words: str, efforts: Mapping[str, str], quantities: Mapping[str, Wanted]) -> str:
    """Where efforts act, and how the first of them is called."""
    if not efforts:
        return "there is no effort"
    first = next(iter(efforts))
    short = f"{quantities[efforts[first]].owner}.effort"
    ask = short if short in quantities else efforts[first]
    most = list(efforts)[:SHORT_LIST]
    more = f" and {len(efforts) - len(most)} more" if len(efforts) > len(most) else ""
    return f"{words} {', '.join(most)}{more}; ask for {ask}"


GROUND_NAME = "ground"

Tensor = tuple[float, float, float, float, float, float]
"""xx, yy, zz, xy, xz, yz."""


class RigidLink(NamedTuple):
    """A rigid body; mass in kg, mass centre in m, inertia about the mass centre in kg m^2."""

    name: str
    mass: float = 0.0
    center_of_mass: Vector = ZERO
    inertia: Tensor = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    @property
    def has_mass(self) -> bool:
        """Whether the link has inertia of any kind."""
        return any(moment != 0.0 for moment in (self.mass, *self.inertia))


def is_written(name: str) -> bool:
    """Whether a link or joint stands in the file: names of what guides a point have a dot."""
    return "." not in name


class Joint(NamedTuple):
    """A pair between two links.

    `on_first` and `on_second` are the pair's frames as drawn on either link: z the axis (normal,
    groove); they coincide where all coordinates are zero. U, Ss, Sc and Cp turn about z of the
    first, then about z of the second, and x, square to both, is what coincides. `parts` is the
    same as a chain of elementary displacements. `lead` (H) is the slide per turn in m. `plane`: its
    links stay in the plane z = 0, and it holds them in that plane alone.
    """

    name: str
    letter: str
    first: str
    second: str
    on_first: Frame
    on_second: Frame
    parts: tuple[Part, ...]
    lead: float = 0.0
    plane: bool = False

    @property
    def type(self) -> JointType:
        """The joint's row of the joint table."""
        return joint_type(self.letter, self.plane)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Full names of the coordinates: `O2.theta`, `O2.s`."""
        return tuple(f"{self.name}.{coordinate}" for coordinate in self.type.coordinates)

    @property
    def carries(self) -> bool:
        """Whether it is a joint of the machine, at which an effort can act."""
        return is_written(self.name) and not self.type.is_free

    @property
    def point(self) -> Attached:
        """The joint's point: what runs on a plane or in a groove of the second link rides on the
        first, other points on the second."""
        if self.type.point_on == FIRST:
            return Attached(self.first, self.on_first.o)
        return Attached(self.second, self.on_second.o)

    @property
    def axis(self) -> Attached:
        """The axis (normal, groove) of a joint that has one, else z of its second frame."""
        return self.drawn(self.type.axis or DrawnDirection(SECOND))

    def drawn(self, direction: DrawnDirection) -> Attached:
        """A direction of the joint table as drawn with this joint."""
        link, frame = ((self.first, self.on_first), (self.second, self.on_second))[direction.side]
        if direction.axis == "own":
            own = next(i for i, step in enumerate(self.type.steps) if step.along == direction)
            return Attached(link, self.parts[own].before.z)
        vector: Vector = getattr(frame, direction.axis)
        return Attached(link, scale(-1.0, vector) if direction.reverse else vector)

    @property
    def pitch(self) -> float:
        """Slide per radian of a joint with a lead, in m; 0 without one."""
        return self.lead / TURN

    def unit_of(self, coordinate: str, length: float) -> float:
        """A coordinate (rad, m) per unit of its freedom, whose slides are told in `length` (m)."""
        known = self.type.coordinate.get(coordinate)
        if known is None:  # a freedom without a name
            return length if coordinate.startswith("slide ") else 1.0
        if known.on_thread:
            return self.pitch
        return 1.0 if known.is_angle else length

    def freedom_number(self, coordinate: str) -> int:
        """The freedom of a coordinate; `turn 2` and `slide 3` stand for those without
        a name."""
        known = self.type.freedom_of.get(coordinate)
        return int(coordinate.rpartition(" ")[2]) if known is None else known

    @property
    def screws(self) -> tuple[Screw, ...]:
        """The unit screws of its freedoms as drawn (about the ground origin, m)."""
        return tuple(screw for part in self.parts for screw in part.screws(self.pitch))

    @property
    def free_slides(self) -> tuple[Attached, ...]:
        """Directions along which it takes no force, whatever its coordinates are."""
        return self._free("slide")

    @property
    def free_turns(self) -> tuple[Attached, ...] | None:
        """Directions about which it takes no moment about its point; None for all of a ball."""
        return None if self.type.is_oriented else self._free("turn")

    def _free(self, motion: str) -> tuple[Attached, ...]:
        if self.type.is_threaded:
            return ()
        return tuple(
            # a part that leads from one drawing to the other stands behind slides alone
            Attached(self.first, self.parts[step].before.z) if along is None else self.drawn(along)
            for step, along in self.type.free[motion]
        )

    @property
    def parameter(self) -> float:
        """What its closing equations have to know: the cosine of the angle between its axes, or
        between its axis and its pin, which is -y of the first frame."""
        if self.type.parameter == "between axes":
            return dot(self.on_first.z, self.on_second.z)
        if self.type.parameter == "from axis to pin":
            return -dot(self.axis.vector, self.on_first.y)
        return 0.0


class Varying(NamedTuple):
    """A load's value that is another in every row: law `number` of those that the problem holds.

    `moving` says that the law reads rates.
    """

    number: int
    moving: bool = False


Amount = float | Varying
"""A force (N) or moment (N m)."""


class LinkLoad(NamedTuple):
    """A force (N, at a point of the link) or torque (N m) on a link, in ground or link axes."""

    kind: Literal["force", "torque"]
    link: str
    value: tuple[Amount, Amount, Amount]
    axes: Literal["ground", "link"] = "ground"
    point: Vector = ZERO

    @property
    def amounts(self) -> tuple[Amount, Amount, Amount]:
        """The three components."""
        return self.value


class JointLoad(NamedTuple):
    """A torque on a joint's theta (N m) or a force on its s (N): on the second link, opposite on
    the first."""

    joint: str
    coordinate: str
    value: Amount

    @property
    def amounts(self) -> tuple[Amount]:
        """The value."""
        return (self.value,)


class Spring(NamedTuple):
    """A spring between two points (N/m) or on a joint coordinate (N/m or N m/rad)."""

    between: tuple[Attached, Attached] | None
    joint: str | None
    coordinate: str | None
    stiffness: float
    free: float
    preload: float


class Damper(NamedTuple):
    """A viscous damper between two points (N s/m) or on a joint coordinate (or N m s/rad)."""

    between: tuple[Attached, Attached] | None
    joint: str | None
    coordinate: str | None
    damping: float


Load = LinkLoad | JointLoad | Spring | Damper


def varying(load: Load) -> tuple[Varying, ...]:
    """The values of a load that are another in every row."""
    amounts: tuple[Amount, ...] = load.amounts if isinstance(load, LinkLoad | JointLoad) else ()
    return tuple(amount for amount in amounts if isinstance(amount, Varying))


def renumbered(load: Load, numbers: Mapping[int, int]) -> Load:
    """The load with the laws of its values under other numbers."""
    if isinstance(load, JointLoad):
        return load._replace(value=_renumbered(load.value, numbers))
    if isinstance(load, LinkLoad):
        x, y, z = (_renumbered(amount, numbers) for amount in load.value)
        return load._replace(value=(x, y, z))
    return load


def _renumbered(amount: Amount, numbers: Mapping[int, int]) -> Amount:
    if isinstance(amount, Varying):
        return amount._replace(number=numbers[amount.number])
    return amount


@dataclass(frozen=True)
class Mechanism:
    """Links and joints by name in the order written; gravity in m/s^2; what drives it, where it is
    known. `plane`: everything stays in the plane z = 0."""

    name: str
    links: Mapping[str, RigidLink]
    joints: Mapping[str, Joint]
    points: Mapping[str, Attached] = field(default_factory=dict)
    directions: Mapping[str, Attached] = field(default_factory=dict)
    loads: tuple[Load, ...] = ()
    gravity: Vector = ZERO
    drives: Drives | None = None
    frictions: tuple[Rubbing, ...] = ()
    plane: bool = False

    @property
    def space(self) -> int:
        """Freedoms of a free link: six, or three in a plane."""
        return 3 if self.plane else 6

    @property
    def coordinates(self) -> tuple[str, ...]:
        """All coordinates in joint order."""
        return tuple(name for joint in self.joints.values() for name in joint.coordinates)

    @cached_property
    def joints_of(self) -> Mapping[str, tuple[Joint, ...]]:
        """The joints at each link, in order."""
        found: dict[str, list[Joint]] = {name: [] for name in (GROUND_NAME, *self.links)}
        for joint in self.joints.values():
            found[joint.first].append(joint)
            found[joint.second].append(joint)
        return {name: tuple(joints) for name, joints in found.items()}

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """Its legs; no leg ends on another leg's links."""
        return _find_legs(self)

    @property
    def loops(self) -> int:
        """Number of independent loops."""
        moving = sum(name != GROUND_NAME for name in self.links)
        return len(self.joints) - moving

    def box_diagonal(self) -> float:
        """Diagonal of the box of all joint points as drawn, in m; 1 if they all coincide."""
        return self._box_diagonal

    @cached_property
    def _box_diagonal(self) -> float:
        return diagonal([at.vector for _, at in self.joint_points()])

    def joint_points(self) -> tuple[tuple[str, Attached], ...]:
        """Every joint's point on each of its links, by joint name; welds have none."""
        return self._joint_points

    @cached_property
    def _joint_points(self) -> tuple[tuple[str, Attached], ...]:
        found = []
        for joint in self.joints.values():
            if joint.type.has_point and is_written(joint.name):
                found.append((joint.name, Attached(joint.first, joint.on_first.o)))
                found.append((joint.name, Attached(joint.second, joint.on_second.o)))
        return tuple(found)


def diagonal(points: list[Vector]) -> float:
    """Diagonal of the box of some points; 1 where they all coincide (a mechanism without
    lengths)."""
    from mechkin_cli.mechanism.vectors import norm, subtract

    if not points:
        return 1.0
    low = tuple(smallest(*(p[i] for p in points)) for i in range(3))
    high = tuple(largest(*(p[i] for p in points)) for i in range(3))
    return nonzero(norm(subtract(high, low)))  # type: ignore[arg-type]


# Legs: links with two spheres and telescopes between two spheres, as distances between two points.
#
# A link whose only joints are two spherical joints (S-S), or two links that slide on each other
# along the line of their spheres (S-P-S), keep the distance of two points of other links and
# nothing else; they spin freely about the line of their spheres. So they close a loop with one
# equation, and need no freedom of their own.


@dataclass(frozen=True)
class Leg:
    """A leg from the sphere `start` on link `first` to the sphere `end` on link `second`.

    `body` is the link at `start`; a telescope has a `rod` at `end` that moves by `slide`.
    """

    start: Joint
    end: Joint
    first: str
    second: str
    body: str
    slide: Joint | None = None
    rod: str | None = None

    @property
    def links(self) -> tuple[str, ...]:
        """The leg's own links."""
        return (self.body,) if self.rod is None else (self.body, self.rod)

    @property
    def joints(self) -> tuple[str, ...]:
        """The leg's joints, in order."""
        middle = (self.slide.name,) if self.slide is not None else ()
        return (self.start.name, *middle, self.end.name)

    @property
    def words(self) -> str:
        """The idle freedom in an engineer's words."""
        spins = "spins" if self.rod is None else "spin"
        return f"{' and '.join(self.links)} {spins} freely about {self.start.name}-{self.end.name}"

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

    def _outward_axis(self) -> Vector:
        """The way in which the rod moves against `body` where the slide grows, in its drawing."""
        assert self.slide is not None
        axis = frame_on(self.slide, self.body).z
        return axis if self.slide.first == self.body else scale(-1.0, axis)

    def _end_on_body(self) -> Vector:
        if self.slide is None or self.rod is None:
            return frame_on(self.end, self.body).o
        on_rod, on_body = frame_on(self.slide, self.rod), frame_on(self.slide, self.body)
        x, y, z = on_rod.local(frame_on(self.end, self.rod).o)
        parts = (scale(x, on_body.x), scale(y, on_body.y), scale(z, on_body.z))
        place = on_body.o
        for part in parts:
            place = subtract(place, scale(-1.0, part))
        return place


def frame_on(joint: Joint, link: str) -> Frame:
    """A joint's frame as drawn on one of its links."""
    return joint.on_first if joint.first == link else joint.on_second


def find_legs(mechanism: Mechanism) -> tuple[Leg, ...]:
    """The legs of a mechanism; no leg ends on another leg's links."""
    return mechanism.legs


def _find_legs(mechanism: Mechanism) -> tuple[Leg, ...]:
    joints_of = mechanism.joints_of
    size = largest(0.0, *(norm(joint.on_first.o) for joint in mechanism.joints.values()))
    legs: list[Leg] = []
    taken: set[str] = set()
    ends: set[str] = set()
    for name in mechanism.links:
        leg = _leg_at(name, joints_of, taken, size)
        if leg is None or ends & set(leg.links) or taken & {leg.first, leg.second}:
            continue
        legs.append(leg)
        taken.update(leg.links)
        ends.update((leg.first, leg.second))
    return tuple(legs)


def _leg_at(
    name: str, joints_of: Mapping[str, tuple[Joint, ...]], taken: Collection[str], size: float
) -> Leg | None:
    """The leg whose first own link is `name`, if there is one; `size` is that of the drawing."""
    if name == GROUND_NAME or name in taken or len(joints_of[name]) != 2:
        return None
    start, other = joints_of[name]
    if not start.type.is_ball:
        start, other = other, start
    if not start.type.is_ball:
        return None
    first = _far(start, name)
    if other.type.is_ball:
        leg = Leg(start, other, first, _far(other, name), name)
        apart = norm(leg.span) > tolerances.PARALLEL * size
        return leg if leg.first != leg.second and apart else None
    rod = _far(other, name)
    if not other.type.is_slider or rod == GROUND_NAME or len(joints_of[rod]) != 2 or rod in taken:
        return None
    end = next(joint for joint in joints_of[rod] if joint is not other)
    if not end.type.is_ball:
        return None
    leg = Leg(start, end, first, _far(end, rod), name, other, rod)
    return leg if leg.first != leg.second and _is_straight(leg) else None


def _far(joint: Joint, link: str) -> str:
    return joint.second if joint.first == link else joint.first


def _is_straight(leg: Leg) -> bool:
    """Whether the slide runs along the line of the spheres."""
    assert leg.slide is not None
    off_line = cross(leg.span, frame_on(leg.slide, leg.body).z)
    return norm(off_line) <= tolerances.LEG_SLIDE * norm(leg.span)


# A pair that holds a slide: a plane on the link, square to the slide, keeps a point of its
# neighbour.
#
# Whatever else moves, a slide of the link along the plane's normal takes the plane off the point at
# the same rate, so the hold is never singular.

_STOP = "Sp"


def stop_of(joint: Joint, link: str, slide: Vector) -> Joint:
    """The pair beside a joint that keeps one of its links from sliding along a unit vector on that
    link's drawing."""
    far = joint.second if joint.first == link else joint.first
    centre = upright(frame_on(joint, far).o)
    plane = frame_about(slide, perpendicular(slide), frame_on(joint, link).o)
    ball, *ways = JOINT_TYPES[_STOP].steps
    parts = [Part(ball.letter, centre, upright(plane.o))]
    for way, z in zip(ways, (plane.x, plane.y), strict=True):
        along = frame_about(z, plane.z, plane.o)
        parts.append(Part(way.letter, along, along))
    # no user's name has a blank
    name = f"{joint.name} (stop)"
    return Joint(name, _STOP, far, link, centre, plane, tuple(parts))
