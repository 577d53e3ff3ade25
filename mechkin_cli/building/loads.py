"""Loads of the file to loads of the mechanism; `actuators:` - the coordinates at which efforts act.

A file in mm whose gravity is 9.81 computes with a thousandth of it, and nothing else in it looks
wrong: so bare numbers of gravity are checked against usual units.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING, Literal

from mechkin_cli.building.fields import (
    CODE,
    Fields,
    Path,
    is_coordinate,
    place_at,
    refuse_efforts,
    without,
)
from mechkin_cli.building.friction import build_friction
from mechkin_cli.building.tables import unknown_run
from mechkin_cli.diagnostics import Diagnostic, Number, nearest_hint
from mechkin_cli.expressions import ExpressionError, literal, number_of
from mechkin_cli.mechanism import (
    GROUND_NAME,
    ZERO,
    Amount,
    Attached,
    Damper,
    Drives,
    Joint,
    JointLoad,
    LinkLoad,
    Load,
    Mechanism,
    MotionInputs,
    RigidLink,
    Rubbing,
    Spring,
    Vector,
    Wanted,
    add,
    is_angle,
    scale,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import (
    AnyLoad,
    BushingBetweenLinks,
    DamperAtJoint,
    DamperBetweenPoints,
    FollowingInput,
    ForceOnJoint,
    ForceOnLink,
    FrictionAtJoint,
    Gravity,
    MotionSection,
    SpringAtJoint,
    SpringBetweenPoints,
    TableValue,
    TorqueOnJoint,
    TorqueOnLink,
)
from mechkin_cli.tolerances import GRAVITY_ON_EARTH, LARGEST_NUMBER
from mechkin_cli.units import (
    ACCELERATION,
    ANGLE,
    DAMPING,
    FORCE,
    LENGTH,
    MOMENT,
    STIFFNESS,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
    Dimension,
    parse_unit,
)

if TYPE_CHECKING:
    from mechkin_cli.building.load_laws import LoadLaws
    from mechkin_cli.mechanism import LoadLaw


STANDARD = 9.80665
"""m/s^2, by the third General Conference on Weights and Measures."""

DOWN: Vector = (0.0, 0.0, -1.0)

USUAL = ("m/s^2", "mm/s^2", "cm/s^2", "in/s^2", "ft/s^2")
"""Units in which people know the number of gravity."""


def gravity_of(fields: Fields, path: Path, section: Gravity) -> Vector:
    """The acceleration of free fall in m/s^2; doubts are noted in `fields`."""
    if section.g == "standard":
        standard = number_of(str(STANDARD))
        assert standard is not None
        if section.direction is None:
            return scale(standard, DOWN)
        return scale(standard, fields.direction((*path, "direction"), section.direction))
    vector = fields.vector((*path, "g"), section.g, ACCELERATION)
    _check_unit(fields, (*path, "g"), section.g)
    return vector


def _check_unit(fields: Fields, path: Path, texts: tuple[str, ...]) -> None:
    """Warns where bare numbers are standard gravity in some usual unit, but not in the file's."""
    bare = [literal(text) or 0.0 for text in texts]
    number = sqrt(sum(value * value for value in bare if abs(value) < LARGEST_NUMBER))
    in_si = number * fields.units.factor(ACCELERATION)
    units = [unit for unit in USUAL if _like_gravity(number * float(parse_unit(unit).factor))]
    if fields.error_count or _like_gravity(in_si) or not units:
        return
    own = fields.units.label(ACCELERATION)
    pairs = list(zip(bare, texts, strict=True))[: 2 if fields.plane else 3]
    meant = ", ".join(f"{text.strip()} {units[0]}" if value else text for value, text in pairs)
    fields.note(
        Diagnostic(
            "gravity-unit",
            "warning",
            f"gravity is {number:.6g} {own} here, the number of gravity in {units[0]}",
            fields.document.place(path),
            measured=f"{in_si:.4g} m/s^2",
            hint=f"write g: [{meant}], or g: standard with its direction; {own} if that is meant",
            numbers=(Number("gravity", in_si, "m/s^2"),),
        )
    )


def _like_gravity(in_si: float) -> bool:
    return abs(in_si - STANDARD) <= GRAVITY_ON_EARTH * STANDARD


class LoadBuilder:
    """Turns load sections into loads; errors are noted in `fields`.

    Args:
        fields: of the file, with units and parameters.
        links, joints, points: of the mechanism, by name.
        runs: quantities that loads may read in each run, by the run's name.
    """

    def __init__(
        self,
        fields: Fields,
        links: Mapping[str, RigidLink],
        joints: Mapping[str, Joint],
        points: Mapping[str, Attached],
        runs: Mapping[str, Mapping[str, Wanted]],
    ) -> None:
        self.fields, self.runs = fields, runs
        self.links, self.joints, self.points = links, joints, points
        self._acting: Collection[str] = runs.keys()
        self._of_runs: list[tuple[Collection[str], Load | Vector | Rubbing]] = []

    @cached_property
    def _laws(self) -> LoadLaws:
        from mechkin_cli.building.load_laws import LoadLaws

        return LoadLaws(self.fields, self.runs)

    def add_all(self, sections: Sequence[AnyLoad]) -> None:
        """Reads every load of the file."""
        for i, section in enumerate(sections):
            path: Path = ("loads", i)
            self._acting = self._runs_of(path, section.runs)
            self._add(path, section)

    def add_effort(self, path: Path, name: str, value: str | TableValue, run: str) -> JointLoad:
        """The effort along a coordinate that exists, in one run."""
        self._acting = (run,)
        joint, _, coordinate = name.rpartition(".")
        dimension = MOMENT if is_angle(coordinate) else FORCE
        load = JointLoad(joint, coordinate, self._value(path, value, dimension, name))
        self._put(load)
        return load

    def of_run(
        self, run: str, mechanism: Mechanism
    ) -> tuple[Mechanism, tuple[LoadLaw, ...], dict[int, int]]:
        """The mechanism with the loads of a run; the laws of those that vary, numbered in the order
        of the loads; and these numbers by those that the laws have among those of all runs."""
        loads: list[Load] = [*mechanism.pretensions]
        frictions: list[Rubbing] = [*mechanism.losses]
        gravity, numbers = ZERO, dict[int, int]()
        for runs, item in self._of_runs:
            if run not in runs:
                continue
            if isinstance(item, Rubbing):
                frictions.append(item)
                continue
            if not isinstance(item, Load):
                gravity = add(gravity, item)
                continue
            for amount in item.varying:
                numbers.setdefault(amount.number, len(numbers))
            loads.append(item.renumbered(numbers))
        laws = () if self.fields.error_count else tuple(self._laws.laws[n] for n in numbers)
        acting = replace(mechanism, loads=tuple(loads), gravity=gravity, frictions=tuple(frictions))
        return acting, laws, numbers

    def _runs_of(self, path: Path, names: Sequence[str] | None) -> Collection[str]:
        for i, name in enumerate(names or ()):
            if name not in self.runs and not self.fields.is_refused(name):
                unknown_run(self.fields, (*path, "runs", i), name, self.runs)
        return self.runs.keys() if names is None else names

    def _put(self, load: Load | Vector | Rubbing) -> None:
        self._of_runs.append((self._acting, load))

    def _add(self, path: Path, section: AnyLoad) -> None:
        if isinstance(section, Gravity):
            self._put(gravity_of(self.fields, path, section))
        elif isinstance(section, (ForceOnJoint, TorqueOnJoint)):
            self._add_to_joint(path, section)
        elif isinstance(section, (ForceOnLink, TorqueOnLink)):
            self._add_to_link(path, section)
        elif isinstance(section, (SpringBetweenPoints, DamperBetweenPoints)):
            self._add_between(path, section)
        elif isinstance(section, BushingBetweenLinks):
            from mechkin_cli.building.bushings import build_bushing

            for load in build_bushing(self.fields, path, section, self.links):
                self._put(load)
        elif isinstance(section, FrictionAtJoint):
            self._add_friction(path, section)
        else:
            self._add_at_joint(path, section)

    def _add_to_link(self, path: Path, section: ForceOnLink | TorqueOnLink) -> None:
        if not self._known(path, "link", section.link, self.links):
            return
        point = ZERO
        if isinstance(section, ForceOnLink):
            texts, dimension = section.force, FORCE
            point = place_at(self.fields, (*path, "point"), section.point, section.link)
        else:
            texts, dimension = section.torque, MOMENT
        x, y, z = (
            self._value((*path, section.type, i), text, dimension, "time")
            for i, text in enumerate(texts)
        )
        called = section.name or ""
        self._put(LinkLoad(section.type, section.link, (x, y, z), section.axes, point, called))

    def _add_to_joint(self, path: Path, section: ForceOnJoint | TorqueOnJoint) -> None:
        coordinate: Literal["theta", "s"] = "theta" if isinstance(section, TorqueOnJoint) else "s"
        if not self._has_coordinate(path, section.joint, coordinate):
            return
        dimension = MOMENT if is_angle(coordinate) else FORCE
        name = f"{section.joint}.{coordinate}"
        value = self._value((*path, "value"), section.value, dimension, name)
        self._put(JointLoad(section.joint, coordinate, value, section.name or ""))

    def _add_between(self, path: Path, section: SpringBetweenPoints | DamperBetweenPoints) -> None:
        first, second = section.between
        if first == second:
            text = f"a {section.type} from {first} to itself has no direction"
            self.fields.error("same-point", (*path, "between", 1), text, "name two points")
            return
        ends = []
        for i, name in enumerate(section.between):
            if not self._known((*path, "between"), i, name, self.points):
                return
            ends.append(self.points[name])
        number = self.fields.number
        if isinstance(section, SpringBetweenPoints):
            stiffness = number((*path, "stiffness"), section.stiffness, STIFFNESS)
            free = number((*path, "free"), section.free, LENGTH)
            preload = number((*path, "preload"), section.preload, FORCE)
            self._put(Spring((ends[0], ends[1]), None, None, stiffness, free, preload))
        else:
            damping = number((*path, "damping"), section.damping, DAMPING)
            self._put(Damper((ends[0], ends[1]), None, None, damping))

    def _add_at_joint(self, path: Path, section: SpringAtJoint | DamperAtJoint) -> None:
        joint, coordinate = section.joint, section.coordinate
        if not self._has_coordinate(path, joint, coordinate):
            return
        turning = is_angle(coordinate)
        number = self.fields.number
        if isinstance(section, SpringAtJoint):
            stiffness_of = TORSIONAL_STIFFNESS if turning else STIFFNESS
            stiffness = number((*path, "stiffness"), section.stiffness, stiffness_of)
            free = number((*path, "free"), section.free, ANGLE if turning else LENGTH)
            preload = number((*path, "preload"), section.preload, MOMENT if turning else FORCE)
            self._put(Spring(None, joint, coordinate, stiffness, free, preload))
        else:
            damping_of = TORSIONAL_DAMPING if turning else DAMPING
            damping = number((*path, "damping"), section.damping, damping_of)
            self._put(Damper(None, joint, coordinate, damping))

    def _value(self, path: Path, text: str | TableValue, dimension: Dimension, over: str) -> Amount:
        """A number, or a law where the value varies; a table runs over the quantity `over`."""
        if not isinstance(text, str):
            self._laws.acting(self._acting)
            return self._laws.by_table(path, text, over, dimension)
        try:
            expression = self.fields.definitions.parse(text)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return 0.0
        if expression.names <= self.fields.parameters.keys():
            return self.fields.number(path, text, dimension)
        self._laws.acting(self._acting)
        return self._laws.by_expression(path, expression, dimension)

    def _known(self, path: Path, key: str | int, name: str, known: Mapping[str, object]) -> bool:
        if name in known or (key == "link" and name == GROUND_NAME):
            if name == GROUND_NAME:
                self.fields.error("load-on-ground", (*path, key), "a load on ground moves nothing")
                return False
            return True
        if self.fields.is_refused(name):
            return False
        what = "link" if key == "link" else "point"
        hint = nearest_hint(name, list(known))
        if what == "point" and name in self.joints:
            hint = f"{name} is a joint: name its point under points"
        self.fields.error(f"unknown-{what}", (*path, key), f"there is no {what} {name}", hint)
        return False

    def _add_friction(self, path: Path, section: FrictionAtJoint) -> None:
        joint = self._joint(path, section.joint)
        if joint is None:
            return
        if section.law != "viscous" and any(
            isinstance(item, Rubbing) and item.joint == joint.name and set(runs) & set(self._acting)
            for runs, item in self._of_runs
        ):
            text = f"the friction of {joint.name} is given twice"
            self.fields.error("friction", (*path, "joint"), text, "keep one of the two")
        else:
            for item in build_friction(self.fields, path, section, joint):
                self._put(item)

    def _joint(self, path: Path, name: str) -> Joint | None:
        if self.fields.is_refused(name):
            return None
        if name not in self.joints:
            hint = nearest_hint(name, list(self.joints))
            self.fields.error("unknown-joint", (*path, "joint"), f"there is no joint {name}", hint)
        return self.joints.get(name)

    def _has_coordinate(self, path: Path, name: str, coordinate: str) -> bool:
        joint = self._joint(path, name)
        if joint is None:
            return False
        if coordinate not in joint.type.coordinates:
            named = (*path, "coordinate")
            place = named if self.fields.document.node(named) else (*path, "joint")
            self.fields.error(CODE, place, *without(joint, coordinate))
            return False
        if not joint.carries:
            text = f"{name} is not a joint of the machine and carries no load"
            hint = "put the load on a link, or between points"
            self.fields.error("load-on-pose", (*path, "joint"), text, hint)
            return False
        return True


def build_drives(
    fields: Fields,
    names: tuple[str, ...],
    section: MotionSection | None,
    joints: Mapping[str, Joint],
    motion: MotionInputs,
) -> Drives:
    """The coordinates at which efforts act; errors are noted in `fields`."""
    errors = fields.error_count
    actuators = tuple(
        (joint, coordinate)
        for number, name in enumerate(names)
        if _is_actuator(fields, ("actuators", number), name, joints, names[:number])
        for joint, _, coordinate in (name.rpartition("."),)
    )
    drives = Drives(tuple(motion.driven), actuators, motion.constraints)
    if fields.error_count == errors and names:
        _check_count(fields, drives, section)
    if fields.error_count > errors:
        # efforts get no messages of their own
        refuse_efforts(fields, joints)
        return Drives(tuple(motion.driven), (), motion.constraints)
    return drives


def _is_actuator(
    fields: Fields, path: Path, name: str, joints: Mapping[str, Joint], before: tuple[str, ...]
) -> bool:
    if not is_coordinate(fields, path, name, joints, at_key=False):
        return False
    if name in before:
        fields.error("actuator-twice", path, f"{name} is an actuator already", "name it once")
        return False
    joint = joints[name.rpartition(".")[0]]
    if not joint.carries:
        text = f"{joint.name} is not a joint of the machine and carries no effort"
        fields.error(CODE, path, text, "name coordinates of joints between its links")
        return False
    return True


def _check_count(fields: Fields, drives: Drives, section: MotionSection | None) -> None:
    count, freedoms = len(drives.actuators), drives.freedoms
    names = ", ".join(".".join(pair) for pair in drives.inputs)
    if not freedoms:
        if section is None or not section.inputs:
            text = "without inputs nothing moves that actuators could drive"
            fields.error("too-few-actuators", ("actuators",), text, "add inputs under motion")
        return
    if count < freedoms:
        fields.error(
            "too-few-actuators",
            ("actuators",),
            f"{count} actuator{'s cannot' if count > 1 else ' cannot'} carry the efforts of "
            f"{freedoms} inputs that move on their own: {names}",
            "name as many coordinates as inputs, or tie inputs to others ({with: ..., drive: tie})",
            measured=str(count),
            limit=f"at least {freedoms}",
        )
    elif count > freedoms:
        more = count - freedoms
        place = fields.document.place(("actuators",))
        text = (
            f"there {'is one actuator' if more == 1 else f'are {more} actuators'} more than "
            f"freedoms ({count} for {freedoms}): among the efforts that sustain the motion, these "
            "have the least sum of squares, with moments over the size of the mechanism"
        )
        hint = f"name {freedoms} coordinates for efforts that nothing else could be"
        fields.note(Diagnostic("shared-effort", "note", text, place, hint=hint))


def note_own_motors(fields: Fields, section: MotionSection | None, names: tuple[str, ...]) -> None:
    """Notes that inputs which follow others have their own motors, where the file leaves it
    open."""
    if section is None or names:
        return
    inputs = section.inputs.items()
    own = [n for n, item in inputs if isinstance(item, FollowingInput) and item.drive is None]
    if not own:
        return
    place = fields.document.key_place(("motion", "inputs", own[0]))
    text = f"{', '.join(own)} {'has a motor' if len(own) == 1 else 'have motors'} of "
    text += "its own" if len(own) == 1 else "their own"
    hint = "write drive: tie where the motor of the input that it follows moves it, else drive: own"
    fields.note(Diagnostic("own-motor", "note", text, place, hint=hint))
