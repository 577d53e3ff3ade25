"""The closed list of quantities that a mechanism has, with their dimensions.

`J.theta`, `J.theta_dot`, `J.force`, `p.position`, `L.omega`, `ground.shaking_force`,
`row.residual`, `time`, ... (format 1, Quantities). Directions and parameters stand by their own
names; those that are computed from others after a run stand in `derived_quantities`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, TypeVar

from mechkin_cli.expressions import (
    Expression,
    Quantity,
    Resolve,
    parse,
)
from mechkin_cli.mechanism.held import LockedFreedom
from mechkin_cli.mechanism.joint import GROUND_NAME, Joint, is_written
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.motion import ORDERS
from mechkin_cli.mechanism.pairs import dimension_of, is_angle, joint_type
from mechkin_cli.mechanism.relation import Relation
from mechkin_cli.mechanism.wanted import Kind, Wanted
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_RATE,
    DIMENSIONLESS,
    ENERGY,
    FORCE,
    JERK,
    LENGTH,
    MOMENT,
    POWER,
    STIFFNESS,
    TIME,
    TORSIONAL_STIFFNESS,
    VELOCITY,
    Dimension,
)

if TYPE_CHECKING:
    from mechkin_cli.mechanism.constraint import DistanceConstraint
    from mechkin_cli.mechanism.pair_type import Rubbing

TIME_OF_ROW = Wanted("time", "time", "row", TIME, False)
"""The moment of a row."""

SELF_LOCKING = Wanted("self locking", "self_locking", GROUND_NAME, DIMENSIONLESS, False)
"""1 where a drive that would brake without friction has to push."""

REST_SHARE = Wanted("rest share", "rest_share", GROUND_NAME, DIMENSIONLESS, False)
"""The part of their friction that joints at rest need so that nothing has to drive them."""

REACTION_LEVEL = Wanted("reaction level", "reaction_level", GROUND_NAME, FORCE, False)
"""The largest component of force, or moment in length units, of all joints."""

ACTUATION = Wanted("actuation", "actuation", GROUND_NAME, DIMENSIONLESS, False)
"""The least rate of the actuators, all together, in a motion of length one."""

_GROUND: dict[str, tuple[Kind, Dimension]] = {
    "shaking_force": ("shaking_force", FORCE),
    "shaking_moment": ("shaking_moment", MOMENT),
    "inertia_force": ("inertia_force", FORCE),
    "inertia_moment": ("inertia_moment", MOMENT),
}
_ENERGIES: tuple[Kind, ...] = ("kinetic_energy", "potential_energy")
_ROW: tuple[Kind, ...] = ("residual", "condition", "power_error", "error_bound")
_OF_RESPONSES: dict[Kind, Dimension] = {
    "work": ENERGY,
    "dissipated": ENERGY,
    "energy_error": DIMENSIONLESS,
}
_JOINT_WRENCH: dict[str, tuple[Kind, Dimension]] = {
    "force": ("force", FORCE),
    "moment": ("moment", MOMENT),
    "moment_about_origin": ("moment_about_origin", MOMENT),
    "total_force": ("total_force", FORCE),
    "total_moment": ("total_moment", MOMENT),
}


_OF_ALL = (GROUND_NAME, "row", "time")
"""First words of the quantities that a mechanism has as a whole."""


class Elements(NamedTuple):
    """What of a mechanism has quantities: all of it, or what goes by one name, the first word of
    the names of its quantities; with the joints at every link."""

    joints: Sequence[Joint]
    joints_of: Mapping[str, Sequence[Joint]]
    links: Sequence[str]
    points: Sequence[str]
    directions: Sequence[str]
    couplings: Mapping[str, Relation]
    frictions: Sequence[Rubbing]
    spins: Sequence[DistanceConstraint]
    bushings: Sequence[str]
    plane: bool
    word: str | None = None

    @classmethod
    def of(cls, mechanism: Mechanism) -> Elements:
        """All of a mechanism."""
        return cls(
            tuple(mechanism.joints.values()),
            mechanism.joints_of,
            tuple(mechanism.links),
            tuple(mechanism.points),
            tuple(mechanism.directions),
            mechanism.couplings,
            mechanism.frictions,
            mechanism.spins,
            mechanism.named_bushings,
            mechanism.plane,
        )


T = TypeVar("T")


def first_word(name: str) -> str:
    """What a quantity is of, by its name.

    >>> first_word("A.theta_dot")
    'A'
    """
    return name.partition(".")[0]


class ElementsByName:
    """What of a mechanism goes by one name."""

    def __init__(self, mechanism: Mechanism) -> None:
        self._of = mechanism
        named: tuple[Mapping[str, object], ...] = (
            *(mechanism.joints, mechanism.links, mechanism.points),
            *(mechanism.directions, mechanism.couplings),
        )
        # what stands in the file has one word; what guides a point has more
        self._longer = [_by_word((name for name in some if "." in name), str) for some in named]
        self._frictions = _by_word(mechanism.frictions, lambda rubbing: rubbing.joint)
        self._spins = _by_word(mechanism.spins, lambda spin: spin.holding)

    def __call__(self, word: str) -> Elements:
        """The joints, links and so on of this name."""
        of = self._of

        def own(number: int, some: Mapping[str, T]) -> dict[str, T]:
            names = (word, *self._longer[number].get(word, ()))
            return {name: some[name] for name in names if name in some}

        return Elements(
            tuple(own(0, of.joints).values()),
            of.joints_of,
            tuple(own(1, of.links)),
            tuple(own(2, of.points)),
            tuple(own(3, of.directions)),
            own(4, of.couplings),
            self._frictions.get(word, ()),
            self._spins.get(word, ()),
            [name for name in of.named_bushings if name == word],
            of.plane,
            word,
        )


def _by_word(some: Iterable[T], name: Callable[[T], str]) -> dict[str, list[T]]:
    found: dict[str, list[T]] = {}
    for one in some:
        found.setdefault(first_word(name(one)), []).append(one)
    return found


class Catalogue(Mapping[str, Wanted]):
    """Quantities by name, which are made when they are asked for: coordinates and their rates by
    joint, others by their first word, first without and then with coefficients, or all.

    A mechanism of a thousand loops has a hundred thousand quantities, of which a run reads a few;
    most are coefficients, and most of what is read are coordinates.
    """

    def __init__(
        self,
        of: Callable[[str | None, bool], Mapping[str, Wanted]],
        moving: Callable[[str], Mapping[str, Wanted]],
    ) -> None:
        self._of, self._moving = of, moving
        self._coordinates: dict[str, Mapping[str, Wanted]] = {}
        self._plain: dict[str, Mapping[str, Wanted]] = {}
        self._own: dict[str, Mapping[str, Wanted]] = {}
        self._every: Mapping[str, Wanted] | None = None

    def __getitem__(self, name: str) -> Wanted:
        if self._every is not None:
            return self._every[name]
        joint = name.rpartition(".")[0]
        known = self._coordinates.get(joint)
        if known is None:
            known = self._coordinates[joint] = self._moving(joint)
        if name in known:
            return known[name]
        word = name.partition(".")[0]
        if word not in self._plain:
            self._plain[word] = self._of(word, False)
        if name in self._plain[word]:
            return self._plain[word][name]
        if word not in self._own:
            self._own[word] = self._of(word, True)
        return self._own[word][name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    @property
    def made(self) -> set[str]:
        """The first words of those made so far one by one."""
        some = (self._coordinates, self._plain, self._own)
        return {first_word(word) for made in some for word, own in made.items() if own}

    @property
    def _all(self) -> Mapping[str, Wanted]:
        if self._every is None:
            self._every = self._of(None, True)
        return self._every


def catalogue(
    elements: Elements,
    driven: Sequence[tuple[str, str]],
    *,
    timed: bool = False,
    held: Sequence[LockedFreedom] = (),
) -> dict[str, Wanted]:
    """Every quantity by name; efforts act at what is `driven` (joint, coordinate), `timed` rows
    have a time, and what is `held` that which holds it."""
    found = {}
    for wanted in (
        *_of_coordinates(elements),
        *_of_joints(elements),
        *_of_efforts(driven),
        *_of_points(elements),
        *_of_links(elements),
        *_of_frictions(elements),
        *_of_couplings(elements),
        *_of_bushings(elements),
        *_of_held(held),
        *_of_ground(elements.word),
    ):
        found[wanted.name] = wanted
    if elements.plane:
        found = in_plane(found)
    if timed:
        found["time"] = TIME_OF_ROW
    return found


_IN_PLANE: tuple[Kind, ...] = (
    *("point", "direction", "joint_point", "slip", "axis", "screw_point", "finite_point"),
    *("force", "total_force", "friction_force", "shaking_force", "inertia_force", "tooth_force"),
    *("bushing_force", "bushing_shift"),
)
_ALONG_NORMAL: tuple[Kind, ...] = (
    *("omega", "alpha", "moment", "total_moment", "moment_about_origin", "friction_moment"),
    *("shaking_moment", "inertia_moment", "bushing_moment", "bushing_turn"),
)
_WITHOUT_MEANING: tuple[Kind, ...] = ("screw_pitch", "finite_slide")
_TOLD = dict.fromkeys(_IN_PLANE, "xy") | dict.fromkeys(_ALONG_NORMAL, "z")


def in_plane(found: Mapping[str, Wanted]) -> dict[str, Wanted]:
    """What users see of quantities in a plane: two components of what lies in it, of turns and
    moments that about its normal. What the plane holds is not computed, and has no name."""
    return {
        name: wanted._replace(told=_TOLD.get(wanted.kind, wanted.told))
        for name, wanted in found.items()
        if wanted.kind not in _WITHOUT_MEANING and (wanted.kind in _TOLD or not wanted.vector)
    }


def coordinate_quantities(mechanism: Mechanism) -> list[Wanted]:
    """The joint coordinates themselves, in joint order."""
    return [
        Wanted(name, "coordinate", joint.name, known.dimension, False, known.name)
        for joint in mechanism.joints.values()
        for name, known in zip(joint.coordinates, joint.type.named, strict=True)
    ]


def _of_coordinates(elements: Elements) -> Iterator[Wanted]:
    for joint in elements.joints:
        yield from coordinates_of(joint)


def coordinates_of(joint: Joint) -> Iterator[Wanted]:
    """The coordinates of a joint and their rates."""
    owner = joint.name
    for word, dimension, coordinate, order in _rated(joint.letter, joint.plane, joint.counted):
        yield Wanted(f"{owner}.{word}", "coordinate", owner, dimension, False, coordinate, order)


@cache
def _rated(letter: str, plane: bool, counted: bool) -> list[tuple[str, Dimension, str, int]]:
    """The words of a type's coordinates and their rates, with what each is."""
    found = []
    for known in joint_type(letter, plane, counted).named:
        dimension = known.dimension
        for order, suffix in enumerate(ORDERS):
            found.append((f"{known.name}{suffix}", dimension, known.name, order))
            dimension = dimension / TIME
    return found


def _of_joints(elements: Elements) -> Iterator[Wanted]:
    for joint in elements.joints:
        if not is_written(joint.name) or joint.is_play:
            continue
        if joint.type.has_point:
            yield Wanted(f"{joint.name}.point", "joint_point", joint.name, LENGTH, True)
        if joint.type.has_slip:
            yield Wanted(f"{joint.name}.slip", "slip", joint.name, LENGTH, True)
        if joint.type.axis is not None:
            yield Wanted(f"{joint.name}.axis", "axis", joint.name, DIMENSIONLESS, True)
        for word, (kind, dimension) in _JOINT_WRENCH.items():
            if kind in ("moment", "total_moment") and not joint.type.has_point:
                continue
            if kind == "force" and joint.is_telescope:
                continue  # a cylinder's force is that along it
            yield Wanted(f"{joint.name}.{word}", kind, joint.name, dimension, True)


def effort_quantity(joint: str, coordinate: str) -> Wanted:
    """The effort at a coordinate, by its long name."""
    dimension = MOMENT if is_angle(coordinate) else FORCE
    return Wanted(f"{joint}.{coordinate}.effort", "effort", joint, dimension, False, coordinate)


def _of_frictions(elements: Elements) -> Iterator[Wanted]:
    for rubbing in elements.frictions:
        owner = rubbing.joint
        turns = rubbing.loss is not None and rubbing.loss.turns
        load = MOMENT if turns else FORCE
        yield Wanted(f"{owner}.normal_load", "normal_load", owner, load, False)
        yield Wanted(f"{owner}.friction_force", "friction_force", owner, FORCE, True)
        yield Wanted(f"{owner}.friction_moment", "friction_moment", owner, MOMENT, True)
        yield Wanted(f"{owner}.friction_power", "friction_power", owner, POWER, False)


_BUSHING: dict[str, tuple[Kind, Dimension]] = {
    "force": ("bushing_force", FORCE),
    "moment": ("bushing_moment", MOMENT),
    "shift": ("bushing_shift", LENGTH),
    "turn": ("bushing_turn", ANGLE),
}


def _of_bushings(elements: Elements) -> Iterator[Wanted]:
    """What each exerts on its second link, the moment about its point there, in ground axes, and
    its deflection in its own axes."""
    for name in elements.bushings:
        for word, (kind, dimension) in _BUSHING.items():
            yield Wanted(f"{name}.{word}", kind, name, dimension, True)


def _of_couplings(elements: Elements) -> Iterator[Wanted]:
    """What each applies at the first of its angles and of its slides, and by its teeth."""
    for name, relation in elements.couplings.items():
        places: dict[tuple[Kind, Dimension], str] = {}
        for term in relation.terms:
            if not is_written(term.joint.name) or term.joint.is_play:
                continue
            angle = is_angle(term.coordinate)
            what: tuple[Kind, Dimension] = (
                ("coupling_torque", MOMENT) if angle else ("coupling_force", FORCE)
            )
            places.setdefault(what, f"{term.joint.name}.{term.coordinate}")
        for (kind, dimension), at in places.items():
            word = kind.removeprefix("coupling_")
            yield Wanted(f"{name}.{word}", kind, name, dimension, False, at)
        if relation.has_teeth:
            yield Wanted(f"{name}.tooth_force", "tooth_force", name, FORCE, True)
        yield from strands_of(name, relation)


def strands_of(name: str, relation: Relation) -> Iterator[Wanted]:
    """What pulls in the strands of a coupling."""
    for strand, _ in relation.tensions:
        yield Wanted(f"{name}.{strand}", "tension", name, FORCE, False, strand)


def friction_states(mechanism: Mechanism) -> list[Wanted]:
    """What the kernel says of each friction's answer, codes of its `FrictionState`."""
    return [
        Wanted(
            f"{rubbing.joint} friction state", "friction_state", rubbing.joint, DIMENSIONLESS, False
        )
        for rubbing in mechanism.frictions
    ]


def _of_efforts(driven: Sequence[tuple[str, str]]) -> Iterator[Wanted]:
    count = Counter(joint for joint, _ in driven)
    for joint, coordinate in driven:
        effort = effort_quantity(joint, coordinate)
        if count[joint] == 1:
            yield effort._replace(name=f"{joint}.effort")
        yield effort


def _of_points(elements: Elements) -> Iterator[Wanted]:
    words = (
        ("position", LENGTH),
        ("velocity", VELOCITY),
        ("acceleration", ACCELERATION),
        ("jerk", JERK),
    )
    for name in elements.points:
        for order, (word, dimension) in enumerate(words):
            yield Wanted(f"{name}.{word}", "point", name, dimension, True, order=order)
    for name in elements.directions:
        yield Wanted(name, "direction", name, DIMENSIONLESS, True)


def _of_links(elements: Elements) -> Iterator[Wanted]:
    for name in elements.links:
        if name != GROUND_NAME and is_written(name):
            yield Wanted(f"{name}.omega", "omega", name, ANGULAR_RATE, True)
            yield Wanted(f"{name}.alpha", "alpha", name, ANGULAR_ACCELERATION, True)
    for spin in elements.spins:
        yield Wanted(spin.holding, "holding_moment", spin.links[0], MOMENT, False)


def _of_held(held: Sequence[LockedFreedom]) -> Iterator[Wanted]:
    for one in held:
        if one.stop is not None:
            yield Wanted(one.holding, "force", one.stop.name, FORCE, True)
            continue
        kind: Kind = "holding_moment" if one.turns else "holding_force"
        dimension = MOMENT if one.turns else FORCE
        yield Wanted(one.holding, kind, one.links[0], dimension, False, one.name)


def _of_ground(only: str | None) -> Iterator[Wanted]:
    if only is not None and only not in _OF_ALL:
        return
    for word, (kind, dimension) in _GROUND.items():
        yield Wanted(f"ground.{word}", kind, GROUND_NAME, dimension, True)
    for word in _ENERGIES:
        yield Wanted(f"row.{word}", word, GROUND_NAME, ENERGY, False)
    for word in _ROW:
        yield Wanted(f"row.{word}", word, "row", DIMENSIONLESS, False)


def response_quantities() -> dict[str, Wanted]:
    """What rows of a response have beside a sweep's, by name: the work of efforts, drives and other
    loads since the first row, what dampers and friction took, and what is missing of their balance
    with the energies of motion, gravity and springs in parts of the largest of them."""
    return {
        f"row.{kind}": Wanted(f"row.{kind}", kind, "row", dimension, False)
        for kind, dimension in _OF_RESPONSES.items()
    }


def resting_quantities(coordinates: Sequence[str], *, rubs: bool = False) -> dict[str, Wanted]:
    """What rows of equilibria have, by name: the least stiffness against motions of some
    independent `coordinates`, the lowest natural frequency, and the largest force that does not
    balance in parts of the largest of those that do; with friction, which `rubs`, between which
    values of the coordinate it holds the mechanism."""
    slides = not any(map(is_angle, coordinates))
    stiffness = STIFFNESS if slides else TORSIONAL_STIFFNESS
    told: tuple[tuple[Kind, Dimension], ...] = (
        ("least_stiffness", stiffness),
        ("frequency", DIMENSIONLESS / TIME),
        ("imbalance", DIMENSIONLESS),
    )
    if rubs:
        along = dimension_of(coordinates[0])
        told += (("rest_from", along), ("rest_to", along))
    return {
        f"row.{kind}": Wanted(f"row.{kind}", kind, "row", dimension, False)
        for kind, dimension in told
    }


# Derivatives of positions by an input, as quantities of the mechanism.
#
# An acceleration per acceleration of an input is the velocity per its rate, and so the derivative
# of the position by the input (influence coefficients: J. Duffy, Analysis of Mechanisms and Robot
# Manipulators, 1980): `p.position` by `A.theta` is `p.acceleration.per_acceleration`. A direction d
# of a link moves by the cross product of the link's coefficient and d.


# What a joint transmits along its axis and square to it, as bearings are chosen by.
#
# Each is an expression of the joint's reaction, evaluated like any other: on rows, on other
# reactions in equilibrium where constraints are redundant, in double-double. What is square to the
# axis is unique in a plane linkage, though neither reaction nor moment of its pins is.


_LOADS: dict[Kind, tuple[str, Dimension]] = {
    "radial_force": ("norm(cross(J.axis, J.force))", FORCE),
    "axial_force": ("dot(J.axis, J.force)", FORCE),
    "tilting_moment": ("norm(cross(J.axis, J.moment))", MOMENT),
}
"""Expressions of a joint's reaction, in which J stands for the joint, and their dimensions."""

_LOADS_IN_PLANE: dict[Kind, tuple[str, Dimension]] = {"radial_force": ("norm(J.force)", FORCE)}
"""Pins, slots and guides transmit nothing else: along its axis a guide takes no force."""

_TOLD_IN_PLANE = "xy"

BEARING_KINDS: frozenset[str] = frozenset(_LOADS) | {
    "coupling_power",
    "coupling_efficiency",
}
"""These, and of a coupling its power, its effort at a coordinate by the rate of that, and its
efficiency."""


def bearing_catalogue(
    elements: Elements, efforts: Sequence[tuple[str, str]] = ()
) -> dict[str, Wanted]:
    """`J.radial_force`, `J.axial_force` and `J.tilting_moment` of every joint with an axis, in a
    plane the first alone, of every joint with a point; `K.power` of every coupling, and
    `K.efficiency` of those that rub."""
    loads = (
        *_bearing_loads_of_joints(elements),
        *_powers_of_couplings(elements),
        *_efficiencies(elements, efforts),
    )
    return {wanted.name: wanted for wanted in loads}


def bearing_load(wanted: Wanted, resolve: Resolve) -> Quantity:
    """The load as its expression gives it, in SI."""
    return _expression(wanted).evaluate(resolve)


def read_for(names: Iterable[str], known: Mapping[str, Wanted]) -> list[str]:
    """What has to be read for some quantities: reactions and axes in place of bearing loads.

    Raises:
        KeyError: an unknown quantity.
    """
    found: dict[str, None] = {}
    for name in names:
        wanted = known[name]
        is_load = wanted.kind in BEARING_KINDS
        parts = sorted(_expression(wanted).names) if is_load else [name]
        found |= dict.fromkeys(parts)
    return list(found)


def _bearing_loads_of_joints(elements: Elements) -> Iterator[Wanted]:
    loads, told = (_LOADS_IN_PLANE, _TOLD_IN_PLANE) if elements.plane else (_LOADS, "xyz")
    for joint in elements.joints:
        bears = joint.type.has_point and (elements.plane or joint.type.axis is not None)
        bears = bears and is_written(joint.name) and not joint.is_telescope
        for kind, (_, dimension) in loads.items() if bears else ():
            yield Wanted(f"{joint.name}.{kind}", kind, joint.name, dimension, False, told=told)


def _powers_of_couplings(elements: Elements) -> Iterator[Wanted]:
    """What each puts in at its first coordinate; all that it puts in is zero."""
    for name, relation in elements.couplings.items():
        first = relation.terms[0]
        if not is_written(first.joint.name):
            continue
        at = f"{first.joint.name}.{first.coordinate}"
        yield Wanted(f"{name}.power", "coupling_power", name, POWER, False, at)


def _efficiencies(elements: Elements, efforts: Sequence[tuple[str, str]]) -> Iterator[Wanted]:
    """Of couplings that rub: what the driven wheel gets of what the driving one puts in; none where
    no flank bears, of a play at which `efforts` are told."""
    for rubbing in elements.frictions:
        if rubbing.loss is None:
            continue
        owner, loss = rubbing.joint, rubbing.loss
        rate = " + ".join(f"({sense})*{name}_dot" for name, sense in loss.leading)
        first = f"({owner}.torque*({rate}) - {loss.at_first!r}*{owner}.friction_power)"
        second = f"(-{first} - {owner}.friction_power)"
        share = f"max({first}, {second})/(-min({first}, {second}))"
        # the root empties it where both put in power, and none comes out
        text = f"{share} + 0*sqrt({share})"
        last = elements.couplings[owner].terms[-1]
        if last.joint.is_play and (owner, last.coordinate) in efforts:
            pushed = f"{owner}.{last.coordinate}.effort"
            text += f" + 0*({pushed}/{pushed})"
        name = f"{owner}.efficiency"
        yield Wanted(name, "coupling_efficiency", owner, DIMENSIONLESS, False, text)


@cache
def _expression(wanted: Wanted) -> Expression:
    if wanted.kind == "coupling_efficiency":
        return parse(wanted.coordinate)
    if wanted.kind == "coupling_power":
        effort = "torque" if is_angle(wanted.coordinate.rpartition(".")[2]) else "force"
        return parse(f"{wanted.owner}.{effort} * {wanted.coordinate}_dot")
    loads = _LOADS_IN_PLANE if wanted.told == _TOLD_IN_PLANE else _LOADS
    return parse(loads[wanted.kind][0].replace("J.", f"{wanted.owner}."))
