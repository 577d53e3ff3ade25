"""The quantities that are derived from others after a run, by name.

`J.q0` ... `J.q3`, `J.turn` of joints whose orientation has no coordinate; `L.screw_axis`,
`L.finite_axis`, ... of links; `J.theta.mechanical_advantage` of every coordinate that is no input;
`J.theta.transmission_angle` where one joint alone drives a link that is hinged to ground.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from mechkin_cli.mechanism.joint import GROUND_NAME, Joint, is_told, is_written
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.motion import ORDERS
from mechkin_cli.mechanism.pair_type import Attached
from mechkin_cli.mechanism.pairs import JOINT_TYPES, PLANE_JOINT_TYPES, dimension_of, is_angle
from mechkin_cli.mechanism.quantities import BEARING_KINDS, Elements, effort_quantity, in_plane
from mechkin_cli.mechanism.vectors import ZERO
from mechkin_cli.mechanism.wanted import Kind, Wanted
from mechkin_cli.units import (
    ANGLE,
    DIMENSIONLESS,
    ENERGY,
    LENGTH,
    TIME,
    Dimension,
)

# The coefficients of what is linear in the inputs' accelerations, by name.
#
# Every acceleration, reaction and effort is a*alpha + b, with the acceleration alpha of an input
# (dissertation, (3.54)-(3.61)): `Q.per_acceleration` is a, for the first input that moves, with no
# other accelerated, and `Q.per.A.theta_ddot` for each of several inputs; `Q.without_acceleration`
# is b, with no input accelerated. `A.theta.reduced_inertia` is the effort of an input per its own
# acceleration, `A.theta.effort.per.A.theta_ddot`; with `A.theta.effort.per.B.theta_ddot` these are
# the matrix of Lagrange's equations in the inputs.

COEFFICIENT_KINDS: set[str] = {"per_acceleration", "without_acceleration"}

DRIVEN_KINDS: set[str] = {*COEFFICIENT_KINDS, "transmission_angle"}
"""What is read in a response as if the start's coordinates were driven: a force that nothing drives
is in no equilibrium."""

_FORCES = {
    "force",
    "moment",
    "moment_about_origin",
    "effort",
    "shaking_force",
    "shaking_moment",
    "inertia_force",
    "inertia_moment",
}
_AT = " at "

Input = tuple[str, str]
"""Joint and coordinate."""


def coefficient_catalogue(
    known: Mapping[str, Wanted], inputs: Sequence[Input], leading: Input
) -> dict[str, Wanted]:
    """Every coefficient of the quantities that are `known`; `leading` is the input that is meant
    where none is named."""
    found = [*_of_inertias(inputs)]
    taken = frozenset(inputs)
    for quantity in known.values():
        if _is_linear(quantity, taken):
            found.append(_per(quantity, leading, f"{quantity.name}.per_acceleration"))
            for joint, coordinate in inputs if len(inputs) > 1 else ():
                name = f"{quantity.name}.per.{joint}.{coordinate}_ddot"
                found.append(_per(quantity, (joint, coordinate), name))
            found.append(_without(quantity))
    return {wanted.name: wanted for wanted in found}


def base_name(coefficient: Wanted) -> str:
    """The quantity whose coefficient it is."""
    return coefficient.coordinate.partition(_AT)[0]


def accelerated(coefficient: Wanted) -> Input | None:
    """The input by whose acceleration it is; None: no input is accelerated."""
    joint, _, coordinate = coefficient.coordinate.partition(_AT)[2].rpartition(".")
    return (joint, coordinate) if joint else None


def base_quantity(known: Mapping[str, Wanted], name: str) -> Wanted:
    """The quantity of a coefficient's base name; inputs have efforts, whatever else is known."""
    if name in known:
        return known[name]
    joint, coordinate, _ = name.rsplit(".", 2)
    return effort_quantity(joint, coordinate)


def _of_inertias(inputs: Sequence[Input]) -> Iterator[Wanted]:
    for joint, coordinate in inputs:
        effort = effort_quantity(joint, coordinate)
        yield _per(effort, (joint, coordinate), f"{joint}.{coordinate}.reduced_inertia")


def _is_linear(quantity: Wanted, inputs: Collection[Input]) -> bool:
    if quantity.kind == "coordinate":
        return quantity.order == 2 and (quantity.owner, quantity.coordinate) not in inputs
    if quantity.kind == "point":
        return quantity.order == 2
    return quantity.kind == "alpha" or quantity.kind in _FORCES


def _per(quantity: Wanted, by: Input, name: str) -> Wanted:
    dimension = quantity.dimension / _acceleration(by[1])
    return _coefficient(quantity, "per_acceleration", name, dimension, f"{_AT}{by[0]}.{by[1]}")


def _without(quantity: Wanted) -> Wanted:
    name = f"{quantity.name}.without_acceleration"
    return _coefficient(quantity, "without_acceleration", name, quantity.dimension, "")


def _coefficient(quantity: Wanted, kind: Kind, name: str, dimension: Dimension, by: str) -> Wanted:
    # order 2 says that it is of a motion, and needs no forces
    order = 0 if quantity.kind in _FORCES else 2
    base = f"{quantity.name}{by}"
    return quantity._replace(
        name=name, kind=kind, dimension=dimension, coordinate=base, order=order
    )


def _acceleration(coordinate: str) -> Dimension:
    return dimension_of(coordinate) / TIME / TIME


QUATERNION = ("q0", "q1", "q2", "q3")
"""Names of a joint's quaternion, scalar first."""

ORIENTATION_KINDS = {"quaternion", "turn"}
INSTANT_KINDS = {"screw_axis", "screw_point", "screw_pitch"}
FINITE_KINDS = {"finite_axis", "finite_point", "finite_angle", "finite_slide"}
TRANSMISSION_KINDS: tuple[Kind, ...] = ("transmission_angle", "dynamic_transmission_angle")
POWER_KINDS = {"mechanical_advantage", *TRANSMISSION_KINDS}
LEDGER: dict[str, tuple[Kind, Dimension]] = {
    "work": ("ledger_work", ENERGY),
    "dissipated": ("ledger_dissipated", ENERGY),
    "energy_error": ("ledger_energy_error", DIMENSIONLESS),
}
LEDGER_KINDS = {kind for kind, _ in LEDGER.values()}
DERIVED_KINDS = (
    ORIENTATION_KINDS
    | {"arc_length"}
    | INSTANT_KINDS
    | FINITE_KINDS
    | POWER_KINDS
    | COEFFICIENT_KINDS
    | LEDGER_KINDS
    | BEARING_KINDS
)

PARAMETER = "u"
"""The coordinate along a curve."""

_ORIENTED = [kind.letter for kind in JOINT_TYPES.values() if kind.is_oriented]
_PINS = [kind.letter for kind in PLANE_JOINT_TYPES.values() if kind.turns_in_plane]
_GUIDES = [kind.letter for kind in JOINT_TYPES.values() if kind.is_guide]


def _either(letters: Sequence[str]) -> str:
    return f"{', '.join(letters[:-1])} or {letters[-1]}"


_SCREWS: tuple[tuple[Kind, Dimension, bool, int], ...] = (
    ("screw_axis", DIMENSIONLESS, True, 1),
    ("screw_point", LENGTH, True, 1),
    ("screw_pitch", LENGTH / ANGLE, False, 1),
    ("finite_axis", DIMENSIONLESS, True, 0),
    ("finite_point", LENGTH, True, 0),
    ("finite_angle", ANGLE, False, 0),
    ("finite_slide", LENGTH, False, 0),
)
_OF_RESPONSES = (
    "is told of the rows of a response: name it in the table, run: NAME, or respond(NAME)"
)
_HINTS: dict[str, str] = {
    **{word: f"row.{word} {_OF_RESPONSES}" for word in ("event", "work", "dissipated")},
    "energy_error": f"row.energy_error {_OF_RESPONSES}",
    **dict.fromkeys(
        TRANSMISSION_KINDS,
        f"a transmission angle has theta or s, unless an input, of an {_either(_GUIDES)} between "
        f"ground and a link with exactly one other joint, of type {_either(_ORIENTED)}; in a plane "
        f"{_either(_PINS)}, and no input",
    ),
    "reduced_inertia": "inputs have a reduced inertia: A.theta.reduced_inertia; of two inputs "
    "it is A.theta.effort.per.B.theta_ddot",
    "per": "accelerations, reactions and efforts have coefficients of the acceleration of each of "
    "several inputs, such as A.theta.effort.per.B.theta_ddot",
    **dict.fromkeys(
        sorted(COEFFICIENT_KINDS),
        "accelerations, reactions and efforts have these coefficients, such as "
        "A.theta_ddot.per_acceleration, where there is an input",
    ),
    "mechanical_advantage": (
        "a mechanical advantage has every coordinate that is no input (J.theta, J.s, ...), where "
        "there is an input"
    ),
    **dict.fromkeys(
        [str(kind) for kind in sorted(BEARING_KINDS)],
        "joints with an axis (R, P, H, C; the normal or groove of others) have bearing loads",
    ),
    "turn": f"joints of type {', '.join(_ORIENTED)} have an orientation",
} | dict.fromkeys(QUATERNION, f"joints of type {', '.join(_ORIENTED)} have an orientation")


_HELD = {
    "z": "a plane file has x and y; what the plane holds is not computed",
    "axis": "a pin turns about the plane's normal; P and Ps have an axis",
    **dict.fromkeys(
        ("screw_axis", "finite_axis"), "every link turns about the plane's normal: omega tells it"
    ),
    **dict.fromkeys(
        ("screw_pitch", "finite_slide", "axial_force", "tilting_moment"),
        "it is along the plane's normal, and not computed in a plane file",
    ),
}


def derived_catalogue(
    elements: Elements,
    inputs: Sequence[tuple[str, str]],
    leading: tuple[str, str] | None,
) -> dict[str, Wanted]:
    """Every derived quantity by name; `inputs` (joint, coordinate), `leading` the one of them that
    mechanical advantages refer to."""
    found = [*_of_orientations(elements), *_of_curves(elements), *_of_screws(elements)]
    if leading is not None:
        found += _of_advantages(elements, inputs, leading[1])
    found += _of_transmissions(elements, inputs)
    known = {wanted.name: wanted for wanted in found}
    return in_plane(known) if elements.plane else known


def _of_curves(elements: Elements) -> Iterator[Wanted]:
    """Lengths along curves, from where their parameter is zero, or else from their begin, with
    their rates."""
    for joint in elements.joints:
        if joint.type.is_carried and joint.track.names == (PARAMETER,):
            dimension = LENGTH
            for order, suffix in enumerate(ORDERS):
                name = f"{joint.name}.s{suffix}"
                yield Wanted(name, "arc_length", joint.name, dimension, False, PARAMETER, order)
                dimension = dimension / TIME


def ledger_catalogue() -> dict[str, Wanted]:
    """What the rows of a sweep in time have beside others: the work of efforts and loads since the
    first row, what dampers took, and what is missing of their balance with the energies."""
    return {
        f"row.{word}": Wanted(f"row.{word}", kind, GROUND_NAME, dimension, False)
        for word, (kind, dimension) in LEDGER.items()
    }


MOST_NAMED = 4
"""Quantities of a joint, point or link that a message names."""


def hint_of(name: str, known: Mapping[str, Wanted]) -> str | None:
    """Which owners have the derived quantity that an unknown name asks for, or which of the `known`
    quantities is meant by a word of everyday speech; None for others.

    >>> hint_of("A.turn", {})
    'joints of type S, Sp, Sg have an orientation'
    """
    words = name.split(".")[1:]
    if name == "time":
        return "a sweep has time where its motion has: motion: {time: {from: 0, to: 2, step: 0.1}}"
    if words and (words[-1] == "jerk" or words[-1].endswith(ORDERS[3])):
        return "a jerk is known where a motion is prescribed; a response has none"
    told = next((_HINTS[word] for word in reversed(words) if word in _HINTS), None)
    return told or _meant_by(name, known)


# Everyday words for quantities of joints, points and links.

_TURNING = {
    **dict.fromkeys(("angle", "rotation", "phi", "theta"), 0),
    **dict.fromkeys(("omega", "w", "rpm", "angular_velocity", "angular_speed", "angular_rate"), 1),
    **dict.fromkeys(("alpha", "angular_acceleration"), 2),
}
_SLIDING = dict.fromkeys(("displacement", "stroke", "travel", "extension", "slide", *"sxyz"), 0)
_ORDER_OF = {
    **_TURNING,
    **_SLIDING,
    **dict.fromkeys(("position", "pos", "place", "coordinate", "coordinates", "value"), 0),
    "q": 0,
    **dict.fromkeys(("velocity", "vel", "v", "speed", "rate"), 1),
    **dict.fromkeys(("acceleration", "accel", "acc", "a"), 2),
}
_EFFORTS = {
    "torque",
    "motor_torque",
    "drive_torque",
    "driving_torque",
    "motor",
    "drive",
    "actuator",
}
_REACTIONS = {"reaction", "reactions", "reaction_force", "joint_force", "load", "f"}
_REACTIONS |= {"bearing", "bearing_force", "bearing_load", "pin_force", "contact_force"}
_OF_JOINTS = {*_EFFORTS, *_REACTIONS, *_ORDER_OF, "force", "moment", "theta", "s", "friction"}
_COMPONENTS = {
    f"{short}{gap}{axis}": f"{word}.{axis}"
    for letter, word in (("f", "force"), ("m", "moment"), ("v", "velocity"), ("a", "acceleration"))
    for short, gap in ((letter, ""), (letter, "_"), (word, "_"))
    for axis in "xyz"
} | {axis: f"position.{axis}" for axis in "xyz"}
_OF_LINKS = (
    "a link has omega and alpha; its angle and its forces are those of its joints, and a point of "
    "it, named under points:, has position, velocity and acceleration"
)


def _meant_by(name: str, known: Mapping[str, Wanted]) -> str | None:
    """What to write for a word such as torque, speed or reaction; None for other words."""
    owner, _, rest = name.partition(".")
    word, _, part = rest.casefold().partition(".")
    if "energy" in (name, word):
        return "energies are row.kinetic_energy and row.potential_energy"
    own = {one.name: one for one in known.values() if one.owner == owner}
    if not own:
        alike = {one.owner for one in known.values() if one.owner.casefold() == owner.casefold()}
        return f"did you mean {min(alike)}.{rest}?" if alike and word else None
    if not word:
        few = sorted(own, key=lambda each: (len(each), each))[:MOST_NAMED]
        return f"write what of {owner}: {', '.join(few)}, ..."
    if word == "power":
        return f"a power is a product, such as {_power(owner, known)}"
    vector, _, axis = _COMPONENTS.get(word, f"{word}.x" if part else "").partition(".")
    if f"{owner}.{vector}" in own:
        vector = f"{owner}.{vector}"
        return f"its size is norm({vector})" if part else f"did you mean {vector}.{axis}?"
    efforts = [each for each in own if each.endswith(".effort")]
    if word in _EFFORTS and efforts:
        return f"did you mean {min(efforts, key=len)}?"
    if word in _EFFORTS and f"{owner}.moment" in own:
        acting = [each for each in known if each.endswith(".effort")]
        at = f"an effort acts where there is one: {min(acting, key=len)}; " if acting else ""
        return f"{at}what the joint transmits is {owner}.moment"
    if word == "friction" and f"{owner}.force" in own and f"{owner}.friction_force" not in own:
        return f"no friction acts: add loads: [{{type: friction, joint: {owner}, ...}}]"
    if word == "friction":
        meant = [one for one in own.values() if one.kind in ("friction_force", "friction_moment")]
    elif word in _REACTIONS:
        meant = [one for one in own.values() if one.kind in ("force", "moment")]
    else:
        is_known = word in _ORDER_OF and not (part and word in ("s", "theta"))
        meant = _in_order(own.values(), word) if is_known else []
    if meant:
        texts = [f"norm({one.name})" if len(one.places) > 1 else one.name for one in meant]
        return f"did you mean {' or '.join(texts)}?"
    return _OF_LINKS if f"{owner}.omega" in own and word in _OF_JOINTS else None


def _in_order(own: Iterable[Wanted], word: str) -> list[Wanted]:
    """Quantities of a joint, point or link by their order in time, angles or lengths as the word
    says."""
    order = _ORDER_OF[word]
    turning = {1: "omega", 2: "alpha"}.get(_TURNING.get(word, 0))
    found = [
        one
        for one in own
        if one.kind == turning or (one.kind in ("coordinate", "point") and one.order == order)
    ]
    coordinates = [one for one in found if one.kind == "coordinate"]
    turns = [one for one in coordinates if is_angle(one.coordinate)]
    slides = [one for one in coordinates if not is_angle(one.coordinate)]
    return (word in _TURNING and turns) or (word in _SLIDING and slides) or found


def _power(owner: str, known: Mapping[str, Wanted]) -> str:
    """A power as an expression, of the owner's own effort if it has one."""
    efforts = [one for one in known.values() if one.kind == "effort"]
    own = [one for one in efforts if one.owner == owner]
    if not efforts:
        return "A.effort*A.theta_dot of an input"
    effort = min(own or efforts, key=lambda one: len(one.name))
    return f"{effort.name}*{effort.owner}.{effort.coordinate}_dot"


def hint_in_plane(name: str) -> str | None:
    """What a plane file has instead of a quantity of space; None for other names."""
    return _HELD.get(name.rpartition(".")[2])


_OF_MOTION = {
    "time",
    "effort",
    "per",
    "reduced_inertia",
    "mechanical_advantage",
    *COEFFICIENT_KINDS,
    *TRANSMISSION_KINDS,
    *LEDGER,
}


def is_of_motion(name: str) -> bool:
    """Whether it depends on what is driven if a quantity of this name is there.

    >>> is_of_motion("A.effort"), is_of_motion("A.phi")
    (True, False)
    """
    return not _OF_MOTION.isdisjoint(name.split("."))


def driving_joint(mechanism: Mechanism | Elements, joint: Joint) -> Joint | None:
    """The joint that alone drives the link which `joint` guides on ground, by a force through its
    point: a ball, in a plane a pin; None where the structure is another."""
    if not joint.type.is_guide or GROUND_NAME not in (joint.first, joint.second):
        return None
    link = output_link(joint)
    others = [other for other in mechanism.joints_of[link] if other is not joint]
    driver = others[0] if len(others) == 1 else None
    is_point = driver is not None and (driver.type.is_oriented or driver.type.turns_in_plane)
    return driver if is_point else None


def output_link(joint: Joint) -> str:
    """The moving link of a joint on ground."""
    return joint.second if joint.first == GROUND_NAME else joint.first


def reference_point(mechanism: Mechanism, link: str) -> Attached:
    """A point of a link near its joints, as drawn; the ground origin if it has only welds."""
    points = (at for _, at in mechanism.joint_points() if at.link == link)
    return next(points, Attached(link, ZERO))


def _of_orientations(elements: Elements) -> Iterator[Wanted]:
    for joint in elements.joints:
        if joint.type.is_oriented and is_written(joint.name):
            for word in QUATERNION:
                name = f"{joint.name}.{word}"
                yield Wanted(name, "quaternion", joint.name, DIMENSIONLESS, False, word)
            yield Wanted(f"{joint.name}.turn", "turn", joint.name, ANGLE, True)


def _of_screws(elements: Elements) -> Iterator[Wanted]:
    for link in elements.links:
        if link != GROUND_NAME and is_written(link):
            for kind, dimension, vector, order in _SCREWS:
                yield Wanted(f"{link}.{kind}", kind, link, dimension, vector, order=order)


def _of_advantages(
    elements: Elements, inputs: Sequence[tuple[str, str]], leading: str
) -> Iterator[Wanted]:
    for joint in elements.joints:
        for coordinate in joint.type.coordinates if is_told(joint.name) else ():
            if (joint.name, coordinate) not in inputs:
                name = f"{joint.name}.{coordinate}.mechanical_advantage"
                dimension = dimension_of(leading) / dimension_of(coordinate)
                kind: Kind = "mechanical_advantage"
                yield Wanted(name, kind, joint.name, dimension, False, coordinate)


def _of_transmissions(elements: Elements, inputs: Sequence[tuple[str, str]]) -> Iterator[Wanted]:
    driven = {joint for joint, _ in inputs}
    for joint in elements.joints:
        driver = driving_joint(elements, joint)
        if driver is not None and driver.name not in driven and is_told(joint.name):
            for coordinate in joint.type.coordinates:
                for kind in TRANSMISSION_KINDS if (joint.name, coordinate) not in inputs else ():
                    name = f"{joint.name}.{coordinate}.{kind}"
                    yield Wanted(name, kind, joint.name, ANGLE, False, coordinate)
