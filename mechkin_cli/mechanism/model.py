"""A mechanism as data: SI units, home drawing, ground axes.

Links are the vertices and joints the edges of the mechanism graph; `ground` is the link that does
not move.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.joint_types import JointType, joint_types
from mechkin_cli.mechanism.vectors import ZERO, Vector, dot

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
        return self.mass != 0.0 or any(self.inertia)


class Part(NamedTuple):
    """An elementary displacement of a joint's chain; its frame as drawn on the body before and
    after it."""

    letter: str
    before: Frame
    after: Frame

    def reversed(self) -> Part:
        """The same part passed the other way: the same coordinate about the reversed axis."""
        if self.letter in "SW":
            return Part(self.letter, self.after, self.before)
        return Part(self.letter, self.after.flipped(), self.before.flipped())


class Joint(NamedTuple):
    """A pair between two links.

    `on_first` and `on_second` are the pair's frames as drawn on either link: z the axis (normal,
    groove); they coincide where all coordinates are zero. U, Ss, Sc and Cp turn about z of the
    first, then about z of the second, and x, square to both, is what coincides. `parts` is the
    same as a chain of elementary displacements. `lead` (H) is the slide per turn in m.
    """

    name: str
    letter: str
    first: str
    second: str
    on_first: Frame
    on_second: Frame
    parts: tuple[Part, ...]
    lead: float = 0.0

    @property
    def type(self) -> JointType:
        """The joint's row of the joint table."""
        return joint_types()[self.letter]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Full names of the coordinates: `O2.theta`, `O2.s`."""
        return tuple(f"{self.name}.{coordinate}" for coordinate in self.type.coordinates)

    @property
    def point(self) -> Attached:
        """The joint's point: what runs on a plane or in a groove of the second link rides on the
        first, other points on the second."""
        if self.letter in ("Sp", "Sg", "Cp"):
            return Attached(self.first, self.on_first.o)
        return Attached(self.second, self.on_second.o)

    @property
    def axis(self) -> Attached:
        """The axis (normal, groove) of a joint that has one; a cylinder's rides on the first
        link."""
        if self.letter in ("Sc", "Cp"):
            return Attached(self.first, self.parts[0].before.z)
        return Attached(self.second, self.on_second.z)

    @property
    def parameter(self) -> float:
        """Cosine of the angle between the axes of U, between axis and pin of Sc."""
        if self.letter == "U":
            return dot(self.on_first.z, self.on_second.z)
        return -dot(self.axis.vector, self.on_first.y) if self.letter == "Sc" else 0.0


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
    coordinate: Literal["theta", "s"]
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


@dataclass(frozen=True)
class Mechanism:
    """Links and joints by name in the order written; gravity in m/s^2."""

    name: str
    links: Mapping[str, Link]
    joints: Mapping[str, Joint]
    points: Mapping[str, Attached] = field(default_factory=dict)
    directions: Mapping[str, Attached] = field(default_factory=dict)
    loads: tuple[Load, ...] = ()
    gravity: Vector = ZERO

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
        points = [at.vector for _, at in self.joint_points()]
        return diagonal(points)

    def joint_points(self) -> list[tuple[str, Attached]]:
        """Every joint's point on each of its links, by joint name; welds have none."""
        found = []
        for joint in self.joints.values():
            if joint.letter != "W":
                found.append((joint.name, Attached(joint.first, joint.on_first.o)))
                found.append((joint.name, Attached(joint.second, joint.on_second.o)))
        return found


def diagonal(points: list[Vector]) -> float:
    """Diagonal of the box of some points; 1 where they all coincide (a mechanism without
    lengths)."""
    from mechkin_cli.mechanism.vectors import norm, subtract

    if not points:
        return 1.0
    low = tuple(min(p[i] for p in points) for i in range(3))
    high = tuple(max(p[i] for p in points) for i in range(3))
    return norm(subtract(high, low)) or 1.0  # type: ignore[arg-type]
