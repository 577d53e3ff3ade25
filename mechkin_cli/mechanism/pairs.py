"""The joint table: all that defines a pair is in its one entry.

Its closing equations, with their derivatives, the wrenches they transmit and the side condition
that tells an assembly from a false root of them, are composed in the kernel's entry of the letter
`closing` (kernel/core/joints/pairs.hpp).
"""

from __future__ import annotations

from functools import cache

from mechkin_cli.mechanism import pair_type as friction
from mechkin_cli.mechanism.pair_type import (
    COUNTED_AS,
    FIRST,
    SECOND,
    Condition,
    Coordinate,
    Drawing,
    DrawnDirection,
    FrictionLaw,
    JointType,
    PairStep,
)
from mechkin_cli.record import replace
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH, Dimension

_X1, _Y1, _Z1 = DrawnDirection(FIRST, "x"), DrawnDirection(FIRST, "y"), DrawnDirection(FIRST)
_X2, _Y2, _Z2 = DrawnDirection(SECOND, "x"), DrawnDirection(SECOND, "y"), DrawnDirection(SECOND)
_BACK = DrawnDirection(SECOND, reverse=True)
_OWN = DrawnDirection(FIRST, "own")


def _angle(name: str, freedom: int, axis: DrawnDirection | None = _Z2) -> Coordinate:
    return Coordinate(name, ANGLE, freedom, axis)


def _length(
    name: str, freedom: int, axis: DrawnDirection = _Z2, *, on_thread: bool = False
) -> Coordinate:
    return Coordinate(name, LENGTH, freedom, axis, on_thread)


def _parameter(name: str, freedom: int) -> Coordinate:
    """Of a curve or surface: a plain number, in SI where it stands for an angle or a length."""
    return Coordinate(name, DIMENSIONLESS, freedom)


def _turns(freedom: int) -> tuple[Coordinate, Coordinate]:
    return _angle("theta1", freedom, None), _angle("theta2", freedom + 1, None)


_TWO_TURNS = (PairStep("R"), PairStep("R", _Z2))
_AXIS = Drawing("axis", ("axis",))

_TABLE = (
    JointType(
        "R",
        (PairStep("R"),),
        (_angle("theta", 0),),
        _AXIS,
        axis=_Z2,
        closing="R",
        softer=("S", "C"),
        friction=FrictionLaw(
            friction.journal,
            turns="along",
            needs=("radius",),
            may=("length", "collar"),
            missed=(("length", "tilting moment"), ("collar", "axial force")),
        ),
    ),
    JointType(
        "P",
        (PairStep("P"),),
        (_length("s", 0),),
        _AXIS,
        axis=_Z2,
        closing="P",
        softer=("C",),
        friction=FrictionLaw(
            friction.guide,
            slides="along",
            may=("length", "width", "across"),
            missed=(("length", "tilting moment"), ("width", "moment about it")),
        ),
    ),
    # a closing joint would lose the count of its turns
    JointType(
        "H",
        (PairStep("H"),),
        (_angle("theta", 0), _length("s", 0, on_thread=True)),
        _AXIS,
        axis=_Z2,
        friction=FrictionLaw(
            friction.thread, turns="along", slides="along", needs=("radius",), may=("flank",)
        ),
    ),
    JointType(
        "C",
        (PairStep("C"),),
        (_angle("theta", 0), _length("s", 1)),
        _AXIS,
        axis=_Z2,
        closing="C",
        friction=FrictionLaw(
            friction.journal,
            turns="along",
            slides="along",
            needs=("radius",),
            may=("length",),
            missed=(("length", "tilting moment"),),
        ),
    ),
    JointType(
        "S",
        (PairStep("S"),),
        (),
        Drawing("ball"),
        closing="S",
        friction=FrictionLaw(friction.ball, turns="all", needs=("radius",)),
    ),
    JointType(
        "Sp",
        (PairStep("S"), PairStep("P", _X2), PairStep("P", _Y2)),
        (),
        Drawing("ball on", ("normal",)),
        axis=_Z2,
        point_on=FIRST,
        closing="Sp",
        friction=FrictionLaw(friction.plane, slides="square"),
    ),
    # where s grows, the second link runs back along its groove
    JointType(
        "Sg",
        (PairStep("S"), PairStep("P", _BACK)),
        (_length("s", 3, _BACK),),
        Drawing("ball on", ("groove",)),
        axis=_Z2,
        point_on=FIRST,
        closing="Sg",
        friction=FrictionLaw(friction.groove, slides="along"),
    ),
    JointType(
        "U",
        _TWO_TURNS,
        _turns(0),
        Drawing("two axes", ("axis", "axis2")),
        closing="U",
        parameter="between axes",
    ),
    JointType(
        "E",
        (PairStep("P", _X1), PairStep("P", _Y1), PairStep("R")),
        (_length("x", 0, _X1), _length("y", 1, _Y1), _angle("theta", 2)),
        Drawing("plane", ("normal", "x")),
        axis=_Z2,
        closing="E",
    ),
    JointType("W", (PairStep("W"),), (), Drawing("weld"), point_on=None, closing="W"),
    # a universal joint with square axes
    JointType(
        "Ss",
        _TWO_TURNS,
        _turns(0),
        Drawing(
            "square axes",
            ("slot", "pin"),
            "the slot's plane holds the pin: give the normal of that plane",
        ),
        closing="U",
    ),
    JointType(
        "Sc",
        (PairStep("P", _OWN), *_TWO_TURNS),
        (_length("s", 0, _OWN), *_turns(1)),
        Drawing("slotted", ("axis", "pin")),
        axis=_OWN,
        closing="Sc",
        parameter="from axis to pin",
    ),
    JointType(
        "Cp",
        (*_TWO_TURNS, PairStep("P", _X2), PairStep("P", _Y2)),
        (*_turns(0), _length("x", 2, _X2), _length("y", 3, _Y2)),
        Drawing(
            "square axes",
            ("axis", "normal"),
            "a cylinder touches a plane along a line only with its axis square to the normal",
        ),
        axis=_Z1,
        point_on=FIRST,
        closing="Cp",
    ),
    # the pose of the second link against the first: it holds nothing
    JointType(
        "F",
        (
            *(PairStep("P", axis) for axis in (_X1, _Y1, _Z1)),
            PairStep("R"),
            PairStep("R", _Y2, between=True),
            PairStep("R", _X2),
        ),
        (
            *(_length(name, freedom, _Z1) for freedom, name in enumerate(("x", "y", "z"))),
            *(_angle(name, freedom, None) for freedom, name in enumerate(("rz", "ry", "rx"), 3)),
        ),
        Drawing("ball"),
    ),
)

JOINT_TYPES = {entry.letter: entry for entry in _TABLE}
"""The pairs that a file may have, by letter."""

_IN_PLANE = (
    replace(
        JOINT_TYPES["R"],
        axis=None,
        closing="R2",
        softer=(),
        friction=FrictionLaw(friction.journal, turns="along", needs=("radius",)),
    ),
    replace(
        JOINT_TYPES["P"],
        closing="P2",
        softer=(),
        friction=FrictionLaw(
            friction.guide, slides="along", may=("length",), missed=(("length", "tilting moment"),)
        ),
    ),
    # as with Sg, the second link runs back along its slot where s grows
    JointType(
        "Ps",
        (PairStep("R"), PairStep("P", DrawnDirection(SECOND, "x", reverse=True))),
        (_angle("theta", 0), _length("s", 1, DrawnDirection(SECOND, "x", reverse=True))),
        Drawing("plane", ("normal", "slot")),
        axis=_X2,
        point_on=FIRST,
        closing="Ps2",
        shape="Sg",
        friction=FrictionLaw(friction.groove, slides="along"),
    ),
    replace(JOINT_TYPES["W"], closing="W2"),
)

_ON_CURVE = "on a curve"

_CARRIED = (
    JointType(
        f"Sg {_ON_CURVE}",
        (PairStep("S"), PairStep("G")),
        (_parameter("u", 3),),
        Drawing("ball on track"),
        point_on=FIRST,
        shape="Sg",
        friction=FrictionLaw(friction.groove, slides="along"),
    ),
    JointType(
        "Sp on a surface",
        (PairStep("S"), PairStep("A")),
        (_parameter("u", 3), _parameter("v", 4)),
        Drawing("ball on track"),
        point_on=FIRST,
        shape="Sp",
        friction=FrictionLaw(friction.plane, slides="square"),
    ),
    # parts of the others
    JointType("G", (PairStep("G"),), (_parameter("u", 0),), Drawing("ball on track")),
    JointType(
        "A",
        (PairStep("A"),),
        (_parameter("u", 0), _parameter("v", 1)),
        Drawing("ball on track"),
    ),
)
_PIN_ON_CURVE = JointType(
    f"Ps {_ON_CURVE}",
    (PairStep("R"), PairStep("G")),
    (_angle("theta", 0), _parameter("u", 1)),
    Drawing("pin on track"),
    point_on=FIRST,
    shape="Sg",
    friction=FrictionLaw(friction.groove, slides="along"),
    space=3,
)
CARRIED_TYPES = {entry.letter: entry for entry in (*_CARRIED, _PIN_ON_CURVE)}
"""The pairs along curves and over surfaces, which close no loop: a closing pair has no parameter
that tells where on its curve it is."""

PLANE_JOINT_TYPES = {entry.letter: replace(entry, space=3) for entry in _IN_PLANE}
"""The pairs that a plane file may have, by letter: what their links do in the plane z = 0, turns
about z and slides square to it, and closing equations of that plane alone."""

FREE = JointType(
    "free",
    (PairStep("P", _X1), PairStep("P", _Y1), PairStep("P", _Z1), PairStep("S")),
    (_length("x", 0, _X1), _length("y", 1, _Y1), _length("z", 2, _Z1)),
    Drawing("ball"),
)
"""The pair without constraints by which the solver hangs a body that no joint leads to."""

PLAY, PLAY_ANGLE = "play", "lash"
"""The play of a coupling as a coordinate: a length, or an angle."""

_PLAYS = {
    PLAY: JointType(PLAY, (PairStep("P"),), (_length(PLAY, 0),), Drawing("weld"), point_on=None),
    PLAY_ANGLE: JointType(
        PLAY_ANGLE, (PairStep("R"),), (_angle(PLAY_ANGLE, 0),), Drawing("weld"), point_on=None
    ),
}
"""The pairs along which the flanks of couplings have play."""


_POINT = Condition("lengths", "xyz")
_ACROSS = Condition("lengths", "xy")
_PARALLEL = Condition("parallel")
_ORIENTATION = Condition("orientation")
_ANGLE = Condition("angle")

CLOSING_CONDITIONS = {
    "R": (_POINT, _PARALLEL),
    "P": (_ACROSS, _ORIENTATION),
    "C": (_ACROSS, _PARALLEL),
    "S": (_POINT,),
    "Sp": (Condition("lengths", "z", SECOND),),
    "Sg": (Condition("lengths", "xy", SECOND),),
    "U": (_POINT, _ANGLE),
    "E": (Condition("lengths", "z"), _PARALLEL),
    "W": (_POINT, _ORIENTATION),
}
"""By the letter of a closing pair the elementary conditions of its equations, in their order
(kernel/core/joints/pairs.hpp), where nothing but a joint's frames stands in them."""


_ALONG = {"x": _X1, "y": _Y1, "z": _Z1}
_SEATS = {1: "Sp", 2: "Sg", 3: "S"}
_PLANE_SEATS = {1: "Ps", 2: "R"}


def guide_letter(axes: str) -> str:
    """Stands for the slide along some of the axes x, y and z that guides a point which is an
    input."""
    return f"along {axes}"


def seat_letter(axes: str, plane: bool = False) -> str:
    """Stands for how that slide carries the point: on a plane, in a groove or in a socket; in a
    plane as a pin in a slot or in a hole."""
    return f"seat {(_PLANE_SEATS if plane else _SEATS)[len(axes)]}"


_AS_COUNTED = {"T": "R"}
"""An elementary displacement that is no pair of the file format: the pair that it is."""


@cache
def joint_type(letter: str, plane: bool = False, counted: bool = False) -> JointType:
    """The entry of a letter; in a plane, that of its links in the plane; `counted`: that of a joint
    whose turns are counted, which closes no loop, since that would lose them."""
    if counted:
        own = joint_type(letter, plane)
        steps = tuple(each for step in own.steps for each in _counted(step))
        return replace(own, steps=steps, closing=None)
    types = PLANE_JOINT_TYPES if plane else JOINT_TYPES
    kind, _, rest = letter.partition(" ")
    if letter in CARRIED_TYPES:
        return CARRIED_TYPES[letter]
    if letter in _PLAYS:
        return replace(_PLAYS[letter], space=3) if plane else _PLAYS[letter]
    if letter in _AS_COUNTED:
        return joint_type(_AS_COUNTED[letter], plane, counted=True)
    if kind == "along":
        return _guide(rest)
    if kind == "seat":
        return replace(types[rest], letter=letter, named=())
    return FREE if letter == FREE.letter else types[letter]


def _counted(step: PairStep) -> tuple[PairStep, ...]:
    first, *rest = COUNTED_AS.get(step.letter, (step.letter,))
    return step._replace(letter=first), *(PairStep(letter, step.along or _Z2) for letter in rest)


def _guide(axes: str) -> JointType:
    return JointType(
        guide_letter(axes),
        tuple(PairStep("P", _ALONG[axis]) for axis in axes),
        tuple(_length(axis, freedom, _ALONG[axis]) for freedom, axis in enumerate(axes)),
        Drawing("weld"),
        point_on=None,
    )


def dimension_of(coordinate: str) -> Dimension:
    """What coordinates of this name measure, in every pair that has it; a length where none has.

    >>> dimension_of("theta1") == ANGLE
    True
    """
    return _dimensions().get(coordinate, LENGTH)


def is_angle(coordinate: str) -> bool:
    """Whether coordinates of this name are angles, or the numbers that count as such."""
    return dimension_of(coordinate) != LENGTH


@cache
def _dimensions() -> dict[str, Dimension]:
    entries = (*_TABLE, *_IN_PLANE, *CARRIED_TYPES.values(), *_PLAYS.values())
    return {c.name: c.dimension for entry in entries for c in entry.named}
