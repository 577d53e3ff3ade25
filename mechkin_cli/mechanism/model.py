"""A mechanism as data: SI units, home drawing, ground axes.

Links are the vertices and joints the edges of the mechanism graph; `ground` is the link that does
not move.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

from mechkin_cli.exact import TURN
from mechkin_cli.mechanism.drives import Drives
from mechkin_cli.mechanism.elementary import Part, Screw
from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.friction import Rubbing
from mechkin_cli.mechanism.joint_table import joint_type
from mechkin_cli.mechanism.joint_type import FIRST, SECOND, Drawn, JointType
from mechkin_cli.mechanism.vectors import ZERO, Vector, dot, scale
from mechkin_cli.tape.scalars import largest, nonzero, smallest

GROUND_NAME = "ground"

Tensor = tuple[float, float, float, float, float, float]
"""xx, yy, zz, xy, xz, yz."""


class Link(NamedTuple):
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
        return self.drawn(self.type.axis or Drawn(SECOND))

    def drawn(self, direction: Drawn) -> Attached:
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


class Attached(NamedTuple):
    """A point or a direction carried by a link, as drawn at home."""

    link: str
    vector: Vector


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
    links: Mapping[str, Link]
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
