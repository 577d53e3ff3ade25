"""A mechanism as data: SI units, home drawing, ground axes.

Links are the vertices and joints the edges of the mechanism graph; `ground` is the link that does
not move.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING, Literal

from mechkin_cli.diagnostics import SHORT_LIST
from mechkin_cli.mechanism.constraint import (
    Constraint,
    DistanceConstraint,
    InputConstraint,
    find_constraints,
)
from mechkin_cli.mechanism.joint import (
    GROUND_NAME,
    Joint,
    is_told,
    is_written,
    told_coordinates,
)
from mechkin_cli.mechanism.pair_type import Attached, Rubbing
from mechkin_cli.mechanism.relation import Extent, Relation
from mechkin_cli.mechanism.vectors import ZERO, Frame, Vector, norm, subtract
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.tape import largest, nonzero, smallest

if TYPE_CHECKING:
    from typing import Self

    from mechkin_cli.mechanism.wanted import Wanted


# Where the efforts act that keep up the motion of the inputs: at these, or at actuators.
#
# The motion is prescribed at the inputs. Without actuators each input has a drive of its own,
# unless a constraint moves it: then the motor of its leader carries what the constraint transmits.
# Actuators do the virtual work of the inputs' generalised efforts: J^T t = Q, where J are the rates
# of the actuators' coordinates by those of the inputs (docs/numerics.md, Actuators).

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Drives(NamedTuple):
    """The inputs, the actuators (none: the inputs' own drives), and the constraints between inputs;
    a leader has none, an input may have several."""

    inputs: tuple[Coordinate, ...]
    actuators: tuple[Coordinate, ...] = ()
    constraints: tuple[InputConstraint, ...] = ()

    @property
    def acting(self) -> tuple[Coordinate, ...]:
        """Where efforts act."""
        return self.actuators or self.inputs

    @property
    def freedoms(self) -> int:
        """How many inputs move on their own."""
        return len(self.inputs) - len({c.input for c in self.constraints})

    @property
    def are_plain(self) -> bool:
        """Whether each input has a drive of its own."""
        return not self.actuators and not self.constraints


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


class Varying(NamedTuple):
    """A load's value that changes from row to row: law `number` of those that the problem holds.

    `moving` says that the law reads rates.
    """

    number: int
    moving: bool = False


Amount = float | Varying
"""A force (N) or moment (N m)."""


class _Load:
    """What is asked of a load, with the answers of a kind that has none of its own."""

    @property
    def amounts(self) -> tuple[Amount, ...]:
        """Its values that may be others in every row."""
        return ()

    @property
    def varying(self) -> tuple[Varying, ...]:
        """Its values that are others in every row."""
        return tuple(amount for amount in self.amounts if isinstance(amount, Varying))

    @property
    def reads_rates(self) -> bool:
        """Whether its force depends on rates."""
        return any(amount.moving for amount in self.varying)

    @property
    def has_potential(self) -> bool:
        """Whether its work is stored as potential energy."""
        return False

    @property
    def dissipates(self) -> bool:
        """Whether its work is dissipated."""
        return False

    @property
    def acts_at(self) -> Coordinate | None:
        """The joint coordinate at which it acts; None: it acts elsewhere."""
        return None

    @property
    def ends(self) -> tuple[Attached, ...]:
        """The points that it pulls towards each other, if any."""
        return ()

    @property
    def fastened_at(self) -> tuple[Attached, ...]:
        """The points of links at which it is fastened, if any."""
        return self.ends

    @property
    def owner(self) -> str:
        """The name of its quantities, if it has some."""
        return ""

    @property
    def called(self) -> str:
        """Its own name in the file, if it is a force or torque that has one."""
        return ""

    @property
    def of_one(self) -> LinkLoad | JointLoad | None:
        """A force or moment of one in its direction; None where it has no direction, or none that
        is known without its values."""
        return None

    def renumbered(self, numbers: Mapping[int, int]) -> Self:
        """The load with the laws of its values under other numbers."""
        return self


@dataclass(frozen=True)
class LinkLoad(_Load):
    """A force (N, at a point of the link) or torque (N m) on a link, in ground or link axes."""

    kind: Literal["force", "torque"]
    link: str
    value: tuple[Amount, Amount, Amount]
    axes: Literal["ground", "link"] = "ground"
    point: Vector = ZERO
    called: str = ""

    @property
    def of_one(self) -> LinkLoad | None:
        """As of every load."""
        found = _direction(self.value)
        return None if found is None else replace(self, value=(found[0], found[1], found[2]))

    @property
    def amounts(self) -> tuple[Amount, ...]:
        """The three components."""
        return self.value

    def renumbered(self, numbers: Mapping[int, int]) -> Self:
        """As of every load."""
        x, y, z = (_renumbered(amount, numbers) for amount in self.value)
        return replace(self, value=(x, y, z))


@dataclass(frozen=True)
class JointLoad(_Load):
    """A torque on a joint's theta (N m) or a force on its s (N): on the second link, opposite on
    the first."""

    joint: str
    coordinate: str
    amount: Amount
    called: str = ""

    @property
    def of_one(self) -> JointLoad | None:
        """As of every load."""
        found = _direction((self.amount,))
        return None if found is None else replace(self, amount=found[0])

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"

    @property
    def amounts(self) -> tuple[Amount, ...]:
        """Its amount."""
        return (self.amount,)

    @property
    def acts_at(self) -> Coordinate:
        """As of every load."""
        return self.joint, self.coordinate

    def renumbered(self, numbers: Mapping[int, int]) -> Self:
        """As of every load."""
        return replace(self, amount=_renumbered(self.amount, numbers))


class _Element(_Load):
    """A spring or a damper: between two points, or on a joint coordinate."""

    between: tuple[Attached, Attached] | None
    joint: str | None
    coordinate: str | None

    @property
    def acts_at(self) -> Coordinate | None:
        """As of every load."""
        if self.joint is None or self.coordinate is None:
            return None
        return self.joint, self.coordinate

    @property
    def ends(self) -> tuple[Attached, ...]:
        """As of every load."""
        return self.between or ()


@dataclass(frozen=True)
class Spring(_Element):
    """A spring between two points (N/m) or on a joint coordinate (N/m or N m/rad)."""

    between: tuple[Attached, Attached] | None
    joint: str | None
    coordinate: str | None
    stiffness: float
    free: float
    preload: float

    @property
    def has_potential(self) -> bool:
        """It stores all that it takes."""
        return True


@dataclass(frozen=True)
class Damper(_Element):
    """A viscous damper between two points (N s/m) or on a joint coordinate (or N m s/rad)."""

    between: tuple[Attached, Attached] | None
    joint: str | None
    coordinate: str | None
    damping: float

    @property
    def reads_rates(self) -> bool:
        """Its force is that of a rate."""
        return True

    @property
    def dissipates(self) -> bool:
        """It gives nothing back."""
        return True


UPPER_HALF = tuple((i, k) for i in range(6) for k in range(i, 6))
"""The places of the numbers of a symmetric matrix of six rows."""


@dataclass(frozen=True)
class Bushing(_Load):
    """A spring, or a damper, between two frames in all six directions.

    Its law stands in kernel/core/forces/bushings.hpp. The matrix is symmetric, its upper half row
    after row: N/m, N/rad, N m/rad, or per s. `free` are three shifts in m and the components of a
    rotation vector. Without a name it has no quantities.
    """

    name: str
    links: tuple[str, str]
    frames: tuple[Frame, Frame]
    matrix: tuple[float, ...]
    free: tuple[float, ...]
    damps: bool

    @property
    def owner(self) -> str:
        """As of every load."""
        return self.name

    @property
    def fastened_at(self) -> tuple[Attached, ...]:
        """As of every load."""
        origins = (frame.o for frame in self.frames)
        return tuple(Attached(*end) for end in zip(self.links, origins, strict=True))

    @property
    def reads_rates(self) -> bool:
        """As of every load."""
        return self.damps

    @property
    def has_potential(self) -> bool:
        """As of every load."""
        return not self.damps

    @property
    def dissipates(self) -> bool:
        """As of every load."""
        return self.damps


Load = LinkLoad | JointLoad | Spring | Damper | Bushing


def _direction(amounts: tuple[Amount, ...]) -> list[float] | None:
    """Numbers of length one as those of a load; of one that varies alone, along its axis."""
    constant = [0.0 if isinstance(amount, Varying) else float(amount) for amount in amounts]
    varies = [float(isinstance(amount, Varying)) for amount in amounts]
    if any(varies):
        return varies if sum(varies) == 1.0 and not any(constant) else None
    size = sqrt(sum(amount * amount for amount in constant))
    return [amount / size for amount in constant] if size > 0.0 else None


def _renumbered(amount: Amount, numbers: Mapping[int, int]) -> Amount:
    """The amount with its law, if it has one, under another number."""
    if isinstance(amount, Varying):
        return amount._replace(number=numbers[amount.number])
    return amount


@dataclass(frozen=True)
class Mechanism:
    """Links and joints by name in the order written; gravity in m/s^2; what drives it, where it is
    known. `plane`: everything stays in the plane z = 0. All places are measured from the
    `datum` (m), in the ground's axes. `couplings`: relations between coordinates, by name. `kept`:
    joints that close no loop, since their coordinates are needed."""

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
    datum: Vector = ZERO
    couplings: Mapping[str, Relation] = field(default_factory=dict)
    kept: frozenset[str] = frozenset()

    @property
    def space(self) -> int:
        """Freedoms of a free link: six, or three in a plane."""
        return 3 if self.plane else 6

    @cached_property
    def pretensions(self) -> tuple[Spring, ...]:
        """What couplings pull with when they transmit nothing, as springs without stiffness."""
        found = []
        for relation in self.couplings.values():
            for one, other, pull in relation.pulls:
                length = norm(subtract(other.vector, one.vector))
                found.append(Spring((one, other), None, None, 0.0, length, pull))
        return tuple(found)

    @property
    def named_bushings(self) -> tuple[str, ...]:
        """The bushings that have quantities, by name."""
        return tuple(dict.fromkeys(load.owner for load in self.loads if load.owner))

    @property
    def losses(self) -> tuple[Rubbing, ...]:
        """What rubs in couplings."""
        found = (relation.loss for relation in self.couplings.values())
        return tuple(loss for loss in found if loss is not None)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """All coordinates that users see, in joint order."""
        return told_coordinates(self.joints.values())

    @cached_property
    def joints_of(self) -> Mapping[str, tuple[Joint, ...]]:
        """The joints at each link, in order."""
        found: dict[str, list[Joint]] = {name: [] for name in (GROUND_NAME, *self.links)}
        for joint in self.joints.values():
            found[joint.first].append(joint)
            found[joint.second].append(joint)
        return {name: tuple(joints) for name, joints in found.items()}

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """The constraints that are no single joint."""
        joints = self.joints.values()
        return find_constraints(self.links, joints, self.joints_of, self.couplings)

    @cached_property
    def spins(self) -> tuple[DistanceConstraint, ...]:
        """The idle freedoms of their own links."""
        return tuple(c.hung for c in self.constraints if c.hung is not None)

    @cached_property
    def told_spins(self) -> tuple[DistanceConstraint, ...]:
        """Those that users see, which are none of stretches of cables."""
        return tuple(spin for spin in self.spins if any(map(is_written, spin.links)))

    @property
    def has_arcs(self) -> bool:
        """Whether cables run over pulleys, which they may leave."""
        relations = self.couplings.values()
        arcs = any(extent.most is not None for each in relations for extent in each.extents)
        return arcs or any(each.fleets for each in relations)

    @property
    def loops(self) -> int:
        """Number of independent loops."""
        moving = sum(name != GROUND_NAME for name in self.links)
        return len(self.joints) - moving

    @property
    def told_loops(self) -> int:
        """Those that users see: stretches of cables close none."""
        return (
            self.loops
            - sum(not is_told(name) for name in self.joints)
            + sum(not is_told(name) for name in self.links)
        )

    def told_name(self, name: str) -> str:
        """What a link or joint is called: a part of a cable is that cable, and where."""
        return name if is_told(name) else self._told_stretches[name.partition(" ")[0]]

    @cached_property
    def _told_stretches(self) -> dict[str, str]:
        return {
            extent.terms[0].joint.name.partition(" ")[0]: f"cable {name} {extent.place}"
            for name, relation in self.couplings.items()
            for extent in relation.extents
            if isinstance(extent, Extent) and extent.most is None
        }

    @property
    def kutzbach(self) -> int:
        """Kutzbach's count of freedoms: 6 (n - 1 - j) + sum f, in a plane 3 (n - 1 - j) + sum f,
        less one for every coupling."""
        freedoms = sum(joint.type.freedoms for joint in self.joints.values())
        unseen = len(self.spins) - len(self.told_spins)
        return freedoms - unseen - self.space * self.loops - len(self.couplings)

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
    if not points:
        return 1.0
    low = tuple(smallest(*(p[i] for p in points)) for i in range(3))
    high = tuple(largest(*(p[i] for p in points)) for i in range(3))
    return nonzero(norm(subtract(high, low)))  # type: ignore[arg-type]
