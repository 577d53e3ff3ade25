"""A joint of a mechanism: its pair between two links, as it is drawn."""

from __future__ import annotations

from collections.abc import Iterable

from mechkin_cli.exact import TURN
from mechkin_cli.mechanism.pair_type import (
    FIRST,
    SECOND,
    Attached,
    DrawnDirection,
    JointType,
    Part,
    Screw,
)
from mechkin_cli.mechanism.pairs import JOINT_TYPES, PLAY, PLAY_ANGLE, joint_type
from mechkin_cli.mechanism.track import Track
from mechkin_cli.mechanism.vectors import (
    Frame,
    Vector,
    dot,
    frame_about,
    perpendicular,
    scale,
    upright,
)
from mechkin_cli.record import NamedTuple

GROUND_NAME = "ground"


def is_written(name: str) -> bool:
    """Whether a link or joint stands in the file: names of what guides a point have a dot."""
    return "." not in name


def is_told(name: str) -> bool:
    """Whether users see the coordinates of a joint: the name of one that stands for a part of
    something else, as of a cable's stretch, has a blank."""
    return " " not in name


class Joint(NamedTuple):
    """A pair between two links.

    `on_first` and `on_second` are the pair's frames as drawn on either link: z the axis (normal,
    groove); they coincide where all coordinates are zero. U, Ss, Sc and Cp turn about z of the
    first, then about z of the second, and x, square to both, is what coincides. `parts` is the
    same as a chain of elementary displacements. `lead` (H) is the slide per turn in m. `plane`: its
    links stay in the plane z = 0, and it holds them in that plane alone. `counted`: a coupling goes
    by its coordinates, so that a turn more is another place.
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
    counted: bool = False

    @property
    def type(self) -> JointType:
        """The joint's row of the joint table."""
        return joint_type(self.letter, self.plane, self.counted)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Full names of the coordinates: `O2.theta`, `O2.s`."""
        return tuple(f"{self.name}.{coordinate}" for coordinate in self.type.coordinates)

    @property
    def carries(self) -> bool:
        """Whether it is a joint of the machine, at which an effort can act."""
        return is_written(self.name) and not self.type.is_free

    @property
    def is_telescope(self) -> bool:
        """Whether it is the slide of a cylinder, whose links are its own."""
        return is_written(self.name) and not (is_written(self.first) or is_written(self.second))

    @property
    def is_play(self) -> bool:
        """Whether it is that of a coupling's flanks, no joint of the machine."""
        return self.letter in (PLAY, PLAY_ANGLE)

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
    def track(self) -> Track:
        """The curve or surface of a joint that goes along one."""
        return next(part.track for part in self.parts if part.track is not None)

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


def told_coordinates(joints: Iterable[Joint]) -> tuple[str, ...]:
    """Full names of the coordinates of some joints that users see."""
    return tuple(name for joint in joints if is_told(joint.name) for name in joint.coordinates)


def frame_on(joint: Joint, link: str) -> Frame:
    """A joint's frame as drawn on one of its links."""
    return joint.on_first if joint.first == link else joint.on_second


def far_link(joint: Joint, link: str) -> str:
    """The link at a joint's other end."""
    return joint.second if joint.first == link else joint.first


def counted(joint: Joint) -> Joint:
    """A joint whose turns are counted: each turn of its chain a part of its own."""
    parts = tuple(each for part in joint.parts for each in part.counted())
    return joint._replace(parts=parts, counted=True)


# A pair that holds a slide: a plane on the link, square to the slide, keeps a point of its
# neighbour.
#
# Whatever else moves, a slide of the link along the plane's normal takes the plane off the point at
# the same rate, so the hold is never singular.

_STOP = "Sp"


def stop_of(joint: Joint, link: str, slide: Vector) -> Joint:
    """The pair beside a joint that keeps one of its links from sliding along a unit vector on that
    link's drawing."""
    far = far_link(joint, link)
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
