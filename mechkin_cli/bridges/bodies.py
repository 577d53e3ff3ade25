"""Bodies on moving joints, as robot files have them, written as a mechanism file.

Everything is drawn in one pose, in ground axes (m, rad, kg): that in which the other file is
written. A coordinate that is not zero in it (`ref`) makes its joint one that is drawn on either
link. A body that is welded to another and carries nothing else is half of that other one, cut where
a loop was opened: it is put back, so that its joint closes the loop.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.bridges.markup import about
from mechkin_cli.bridges.parts import Imported, listed, refuse
from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.schema import RESERVED

WORLD: Final = ""
"""The body that does not move, which is `ground`."""

_NOTHING: Final = ("null", "Null", "NULL")
"""Names that YAML reads as an empty value."""

WIDTH: Final = 96
"""Columns of a line that is not broken."""


class Turning(NamedTuple):
    """A joint between a body and its parent, or the last of several: `axis` (unit) and `anchor` in
    the drawing, its coordinate `ref` there, its limits, spring and damper."""

    name: str
    motion: Literal["turn", "slide", "ball", "free"]
    axis: Any
    anchor: Any
    ref: float = 0.0
    limits: tuple[float, float] | None = None
    stiffness: float = 0.0
    spring_ref: float = 0.0
    damping: float = 0.0


@dataclass
class Body:
    """A body: its frame (4, 4), mass centre and inertia in the drawing."""

    name: str
    parent: str
    frame: Any
    at: Place
    joints: list[Turning] = field(default_factory=list)
    mass: float = 0.0
    centre: Any = None
    inertia: Any = None
    shift: Any = None
    whole: str | None = None
    """Of a half that was put back: the body that it is a part of, and how it is displaced there."""

    def add(self, mass: float, centre: Any, inertia: Any) -> None:
        """Adds a mass with its centre, and the inertia about it."""
        own = np.zeros((3, 3)) if self.inertia is None else self.inertia
        if self.centre is None:
            self.mass, self.centre, self.inertia = mass, np.asarray(centre), np.asarray(inertia)
            return
        total = self.mass + mass
        apart = np.asarray(centre) - self.centre
        share = mass / total if total else 0.5
        reduced = self.mass * share
        self.inertia = (
            own + inertia + reduced * (apart @ apart * np.eye(3) - np.outer(apart, apart))
        )
        self.centre, self.mass = self.centre + share * apart, total


class Closing(NamedTuple):
    """What keeps two bodies together: points of both in the drawing (n, 3), of a hinge two of its
    axis; a weld has one, where sites are brought together by `shift` of the first body."""

    name: str
    kind: Literal["ball", "hinge", "weld"]
    first: str
    second: str
    on_first: Any
    on_second: Any
    at: Place
    shift: Any = None


class Sum(NamedTuple):
    """Factors of joints, by name, and what the sum of their coordinates (rad, m) by them is."""

    name: str
    factors: dict[str, float]
    total: float
    at: Place


class Line(NamedTuple):
    """A spring or damper between two named points."""

    kind: Literal["spring", "damper"]
    points: tuple[str, str]
    values: dict[str, float]


@dataclass
class Robot:
    """What a robot file tells; `held` are joints that are kept where they are, by name."""

    name: str
    file: str
    format: str
    bodies: dict[str, Body] = field(default_factory=dict)
    closings: list[Closing] = field(default_factory=list)
    sums: list[Sum] = field(default_factory=list)
    held: dict[str, float] = field(default_factory=dict)
    points: dict[str, tuple[str, Any]] = field(default_factory=dict)
    lines: list[Line] = field(default_factory=list)
    gravity: Any = None
    angle: Literal["rad", "deg"] = "rad"
    left_out: dict[str, list[str]] = field(default_factory=dict)
    exact: dict[str, Any] = field(default_factory=dict)
    """Mass and inertia of bodies that the file gives others, which its program needs."""

    def leave_out(self, what: str, name: str = "") -> None:
        """Notes something that the mechanism file will not have."""
        known = self.left_out.setdefault(what, [])
        if name not in known:
            known.append(name)


Choose = Callable[[list[str], Callable[[list[str]], str]], list[str]]
"""Takes coordinates, the first of which move on their own, and what makes the file's text of those
that are driven; gives these."""


def mechanism_text(robot: Robot, choose: Choose) -> Imported:
    """The mechanism file of a robot.

    Args:
        robot: what its file tells.
        choose: which coordinates are driven where the file holds none and has loops.

    Raises:
        InvalidFile: a loop that cannot be closed as it is.
    """
    _put_halves_back(robot)
    return _Writer(robot).imported(choose)


def _put_halves_back(robot: Robot) -> None:
    carried = {body.parent for body in robot.bodies.values()}
    pointed = {body for body, _ in robot.points.values()}
    for closing in [each for each in robot.closings if each.kind == "weld"]:
        held = [n for c in robot.closings if c is not closing for n in (c.first, c.second)]
        to_second = np.eye(4) if closing.shift is None else closing.shift
        for half, whole in ((closing.first, closing.second), (closing.second, closing.first)):
            body = robot.bodies.get(half)
            if body is None or whole == WORLD or half in carried | pointed or half in held:
                continue
            if not body.joints or body.parent == whole or robot.bodies[whole].whole:
                continue
            body.shift = to_second if half == closing.first else np.linalg.inv(to_second)
            body.whole = whole
            if body.centre is not None:
                turn = body.shift[:3, :3]
                centre = turn @ body.centre + body.shift[:3, 3]
                robot.bodies[whole].add(body.mass, centre, turn @ body.inertia @ turn.T)
            robot.closings.remove(closing)
            break


class _Writer:
    """Writes the sections of a mechanism file, and remembers what things are called there."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        joints = [joint.name for body in robot.bodies.values() for joint in body.joints]
        stems = [name.rpartition(".")[0] for name in joints]
        self.theirs = {*robot.bodies, *joints, *stems, *robot.points}
        self.taken = {"ground", *RESERVED, *_NOTHING}
        self.links: dict[str, str] = {WORLD: "ground"}
        self.coordinates: dict[str, tuple[str, bool]] = {}
        """Of the joints of the other file: the coordinate here, and whether it is an angle."""
        self.led: set[str] = set()
        """Joints of the other file that follow another one along a thread."""
        self.is_idle = False
        self.renamed: dict[str, str] = {}
        self.near: dict[str, str] = {}
        self.poses: list[str] = []
        self.lines: dict[str, list[str]] = {
            name: []
            for name in ("links", "joints", "points", "couplings", "limits", "inputs", "loads")
        }

    def imported(self, choose: Choose) -> Imported:
        """The text, and what was left out of it."""
        robot = self.robot
        for name, one in robot.bodies.items():
            if one.whole is None:
                self.links[name] = self._name(name)
                self._put("links", _entry(self.links[name], self._link(one)))
        for each in robot.bodies.values():
            self._carry(each)
        for closing in robot.closings:
            self._close(closing)
        points = {}
        for name, (body, place) in robot.points.items():
            points[name] = self._name(name)
            link = self.links[self._whole(body)]
            self._put("points", f"{points[name]}: {{link: {link}, at: {_vector(place)}}}")
        self._sums()
        self._loads(points)
        self._held()
        if not self.lines["inputs"]:
            self._drive(choose)
        return Imported(self._text(), tuple(self._notes()))

    def _put(self, section: str, line: str) -> None:
        self.lines[section].append(f"  {line}")

    def _name(self, wanted: str) -> str:
        """A name that is free, as like the other file's as a mechanism file takes it."""
        name = re.sub(r"[^A-Za-z0-9_]+", "_", wanted)[:60].strip("_") or "part"
        if name[0].isdigit():
            name = f"_{name}"
        found, number = name, 1
        while found in self.taken:
            number += 1
            found = f"{name}_{number}"
        self.taken.add(found)
        if found != wanted and wanted in self.theirs:
            self.renamed[wanted] = found
        return found

    def _whole(self, body: str) -> str:
        return self.robot.bodies[body].whole or body if body else body

    def _link(self, body: Body) -> list[str]:
        mass, inertia = body.mass, body.inertia
        if body.name in self.robot.exact:
            mass, *entries = self.robot.exact[body.name]
            xx, yy, zz, xy, xz, yz = entries
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        parts = []
        if mass and body.centre is not None:
            parts += [f"mass: {_number(mass)}", f"center_of_mass: {_vector(body.centre)}"]
        if inertia is not None and np.any(inertia):
            keys = (
                ("xx", 0, 0),
                ("yy", 1, 1),
                ("zz", 2, 2),
                ("xy", 0, 1),
                ("xz", 0, 2),
                ("yz", 1, 2),
            )
            scale = float(np.max(np.abs(inertia)))
            told = [
                f"{key}: {_number(inertia[i, j])}"
                for key, i, j in keys
                if abs(inertia[i, j]) > tolerances.IMPORT_ROUNDING * scale
            ]
            parts.append(f"inertia: {{{', '.join(told)}}}")
        return parts

    # Joints.

    def _carry(self, body: Body) -> None:
        first = self.links[self._whole(body.parent)]
        second = self.links[body.whole or body.name]
        shift = np.eye(4) if body.shift is None else body.shift
        joints = body.joints
        if not joints:
            self._joint(f"{body.name}_fixed", "W", first, second)
            return
        if self._as_one(body, first, second, shift):
            return
        for number, joint in enumerate(joints, 1):
            is_last = number == len(joints)
            link = second
            if not is_last:
                link = self._name(f"{body.name}_{number}")
                self._put("links", f"{link}: {{}}")
            self._single(joint, first, link, shift if is_last else np.eye(4))
            first = link

    def _as_one(self, body: Body, first: str, second: str, shift: Any) -> bool:
        """Writes several joints as one pair that has their freedoms, where there is one."""
        joints = body.joints
        motions = [joint.motion for joint in joints]
        apart = any(joint.ref for joint in joints) or not _is_none(shift)
        if sorted(motions) == ["slide", "turn"]:
            turn, slide = sorted(joints, key=lambda joint: joint.motion != "turn")
            if float(np.linalg.norm(turn.axis - slide.axis)) > tolerances.SAME_PLACE:
                return False
            lead = self._lead(turn, slide)
            kind, more = ("C", "") if lead is None else ("H", f"lead: {_number(lead)}")
            places = _on_axis(turn.axis, turn.anchor, turn.ref, slide.ref, shift, first, second)
            own = self._joint(_stem(joints), kind, first, second, *places, more)
            self._coordinate(turn, f"{own}.theta", True)
            self._coordinate(slide, f"{own}.s", False)
            if lead is not None:
                self.led.add(slide.name)
            return True
        if motions == ["turn", "turn"] and not apart:
            one, two = joints
            if (
                np.linalg.norm(one.anchor - two.anchor) > tolerances.SAME_PLACE
                or abs(one.axis @ two.axis) > 0.999
            ):
                return False
            places = f"point: {_vector(one.anchor)}", f"axis: {_vector(one.axis)}"
            own = self._joint(
                _stem(joints), "U", first, second, *places, f"axis2: {_vector(two.axis)}"
            )
            self._coordinate(one, f"{own}.theta1", True)
            self._coordinate(two, f"{own}.theta2", True)
            return True
        if motions == ["slide", "slide", "turn"]:
            x, y, turn = joints
            if np.linalg.norm(np.cross(x.axis, y.axis) - turn.axis) > tolerances.SAME_PLACE:
                return False
            # the body turns about its own point, wherever the slides have carried it
            at_zero = turn.anchor - x.ref * x.axis - y.ref * y.axis
            place = shift @ [*turn.anchor, 1.0]
            ways = about(turn.axis, turn.ref) @ x.axis
            places = (
                _either("point", first, at_zero, second, place[:3]),
                _either("normal", first, turn.axis, second, shift[:3, :3] @ turn.axis),
                _either("x", first, x.axis, second, shift[:3, :3] @ ways),
            )
            own = self._joint(_stem(joints), "E", first, second, *places)
            for joint, word in zip(joints, ("x", "y", "theta"), strict=True):
                self._coordinate(joint, f"{own}.{word}", word == "theta")
            return True
        return False

    def _lead(self, turn: Turning, slide: Turning) -> float | None:
        """Length per turn, where a sum says nothing but that the slide goes with the turn."""
        for one in self.robot.sums:
            if set(one.factors) != {turn.name, slide.name} or not one.factors[slide.name]:
                continue
            slope = -one.factors[turn.name] / one.factors[slide.name]
            total = one.total / one.factors[slide.name]
            if slope and abs(total) <= tolerances.SAME_PLACE:
                self.robot.sums.remove(one)
                return slope * 2.0 * np.pi
        return None

    def _single(self, joint: Turning, first: str, second: str, shift: Any) -> None:
        if joint.motion in ("ball", "free"):
            kind = "S" if joint.motion == "ball" else "F"
            at = (shift @ [*joint.anchor, 1.0])[:3]
            place = _either("point", first, joint.anchor, second, at)
            own = self._joint(joint.name, kind, first, second, place)
            if joint.motion == "free":
                self.poses.append(own)
            return
        is_turn = joint.motion == "turn"
        refs = (joint.ref, 0.0) if is_turn else (0.0, joint.ref)
        places = _on_axis(joint.axis, joint.anchor, *refs, shift, first, second)
        own = self._joint(joint.name, "R" if is_turn else "P", first, second, *places)
        self._coordinate(joint, f"{own}.{'theta' if is_turn else 's'}", is_turn)

    def _joint(self, name: str, kind: str, first: str, second: str, *more: str) -> str:
        own = self._name(name)
        keys = [f"type: {kind}", f"links: [{first}, {second}]", *(each for each in more if each)]
        self._put("joints", _entry(own, keys))
        return own

    def _coordinate(self, joint: Turning, name: str, is_angle: bool) -> None:
        self.coordinates[joint.name] = name, is_angle
        if joint.ref:
            self.near[name] = self._value(joint.ref, is_angle)
        if joint.limits is not None:
            low, high = (self._value(value, is_angle) for value in joint.limits)
            self._put("limits", f"{name}: [{low}, {high}]")
        owner, _, word = name.partition(".")
        at = f"joint: {owner}, coordinate: {word}"
        if joint.stiffness:
            free = self._value(joint.spring_ref, is_angle)
            values = f"stiffness: {_number(joint.stiffness)}, free: {free}"
            self._put("loads", f"- {{type: spring, {at}, {values}}}")
        if joint.damping:
            self._put("loads", f"- {{type: damper, {at}, damping: {_number(joint.damping)}}}")

    def _value(self, value: float, is_angle: bool) -> str:
        """A coordinate (rad, m) in the file's units."""
        in_degrees = is_angle and self.robot.angle == "deg"
        return _number(float(np.degrees(value)) if in_degrees else value)

    def _close(self, closing: Closing) -> None:
        first = self.links[self._whole(closing.first)]
        second = self.links[self._whole(closing.second)]
        if first == second:
            hint = "leave it out, or name another body"
            refuse("same-link", f"{closing.name} joins {first} to itself", closing.at, hint)
        one, other = closing.on_first, closing.on_second
        if closing.kind == "weld":
            if closing.shift is not None and not _is_none(closing.shift, tolerances.WELD_GAP):
                apart = float(np.max(np.abs(closing.shift - np.eye(4))))
                told = f"the weld {closing.name} is apart in the drawing"
                hint = "draw both bodies where they are welded"
                refuse("weld-apart", told, closing.at, hint, f"{apart:.3g} (m or rad)")
            self._joint(closing.name, "W", first, second)
            return
        places = [_either("point", first, one[0], second, other[0])]
        if closing.kind == "hinge":
            axes = [(p[1] - p[0]) / np.linalg.norm(p[1] - p[0]) for p in (one, other)]
            places.append(_either("axis", first, axes[0], second, axes[1]))
        kind = "S" if closing.kind == "ball" else "R"
        self._joint(closing.name, kind, first, second, *places)

    # The other sections.

    def _sums(self) -> None:
        for one in self.robot.sums:
            terms = []
            known = [(self.coordinates.get(name), value) for name, value in one.factors.items()]
            if any(found is None for found, _ in known):
                told = f"{one.name} goes by a joint that has no coordinate"
                refuse("no-coordinate", told, one.at, "leave it out")
            (_, first_is_angle), leading = known[0][0] or ("", False), known[0][1]
            for found, value in known:
                assert found is not None
                name, is_angle = found
                unit = ""
                if is_angle != first_is_angle:
                    unit = " rad/m" if first_is_angle else " m/rad"
                terms.append(f"{name}: {_number(value / leading)}{unit}")
            told = f"type: linear, terms: {{{', '.join(terms)}}}"
            total = one.total / leading
            if abs(total) > tolerances.IMPORT_ROUNDING:
                told += f", sum: {_number(total)} {'rad' if first_is_angle else 'm'}"
            self._put("couplings", f"{self._name(one.name)}: {{{told}}}")

    def _held(self) -> None:
        for joint, value in self.robot.held.items():
            found = self.coordinates.get(joint)
            if found is None:
                self.robot.leave_out("joints held that have no coordinate", joint)
                continue
            self._put("inputs", f"  {found[0]}: {{at: {self._value(value, found[1])}}}")

    def _drive(self, choose: Choose) -> None:
        """Drives all coordinates of a tree, the first one over its range; some where there are
        loops."""
        led = self.led | {next(iter(one.factors)) for one in self.robot.sums}
        free = [name for joint, (name, _) in self.coordinates.items() if joint not in led]
        words = ("x", "y", "z", "rz", "ry", "rx")
        poses = [f"{name}.{word}" for name in self.poses for word in words]

        def text(chosen: list[str]) -> str:
            near = self.near
            told = [f"    {name}: {{at: {near.get(name, '0')}}}" for name in (*chosen, *poses)]
            self.lines["inputs"] = told
            return self._text()

        halves = any(body.whole for body in self.robot.bodies.values())
        if self.robot.closings or halves:
            chosen = choose(free, text)
            text(chosen)
            self.is_idle = bool(free) and not chosen and not poses
            return
        text(free)
        if free:
            low, high = self._range(free[0], dict(self.coordinates.values())[free[0]])
            line = f"    {free[0]}: {{from: {low}, to: {high}, count: 19}}"
            self.lines["inputs"][0] = line

    def _range(self, name: str, is_angle: bool) -> tuple[str, str]:
        """Over which a coordinate is driven: its limits, else a quarter of a turn, or 0.1 m."""
        start = f"  {name}: ["
        for line in self.lines["limits"]:
            if line.startswith(start):
                low, high = line.removeprefix(start).removesuffix("]").split(", ")
                return low, high
        return ("0", "90 deg") if is_angle else ("0", "0.1")

    def _loads(self, points: dict[str, str]) -> None:
        gravity = self.robot.gravity
        if gravity is not None and np.any(gravity):
            self.lines["loads"].insert(0, f"  - {{type: gravity, g: {_vector(gravity)}}}")
        for line in self.robot.lines:
            one, other = (points[name] for name in line.points)
            values = ", ".join(f"{key}: {_number(value)}" for key, value in line.values.items())
            self._put("loads", f"- {{type: {line.kind}, between: [{one}, {other}], {values}}}")

    def _text(self) -> str:
        robot = self.robot
        title = re.sub(r"[^\w .,+-]+", "_", robot.name, flags=re.ASCII)[:100].strip() or "mechanism"
        source = re.sub(r"[^\w .+-]+", "_", Path(robot.file).name, flags=re.ASCII)
        parts = [f"# From {source} ({robot.format})."]
        parts += [f"# Left out: {what}." for what in map(_told, robot.left_out.items())]
        parts += [f"# Renamed: {self._renamed()}."] if self.renamed else []
        parts += [
            "format: 1",
            f'name: "{title}"',
            f"units: {{length: m, angle: {robot.angle}, mass: kg, force: N}}",
        ]
        for section in ("links", "joints", "points", "couplings", "limits"):
            if self.lines[section]:
                parts += ["", f"{section}:", *self.lines[section]]
        if self.near:
            near = ", ".join(f"{name}: {value}" for name, value in self.near.items())
            parts += ["", f"assembly: {{near: {{{near}}}}}   # as drawn in {source}"]
        if self.lines["inputs"]:
            parts += ["", "motion:", "  inputs:   # held by at:; moved by from:, to:, step:"]
            parts += self.lines["inputs"]
        if self.lines["loads"]:
            parts += ["", "loads:", *self.lines["loads"]]
        return "\n".join(parts) + "\n"

    def _renamed(self) -> str:
        """What is called otherwise here, since names are letters, digits and underscores."""
        plain = {
            found: "".join(c if c.isprintable() else "_" for c in wanted[:40])
            for wanted, found in self.renamed.items()
        }
        return listed(f"{wanted} is {found}" for found, wanted in plain.items())

    def _notes(self) -> Iterator[Diagnostic]:
        if self.renamed:
            yield Diagnostic("renamed", "note", f"renamed: {self._renamed()}")
        if self.is_idle:
            told = "no inputs were found that drive it in the drawn pose"
            hint = "write motion: with as many inputs as mechkin mobility finds freedoms"
            yield Diagnostic("not-driven", "warning", told, hint=hint)
        for item in self.robot.left_out.items():
            yield Diagnostic("left-out", "warning", f"left out: {_told(item)}")


def _told(item: tuple[str, list[str]]) -> str:
    what, names = item
    known = [re.sub(r"[^\w ./+-]+", "_", name, flags=re.ASCII) for name in names if name]
    return f"{what}: {listed(known)}" if known else what


def _entry(name: str, keys: list[str]) -> str:
    """A named entry in one line, or in one for each key where it would be long."""
    line = f"{name}: {{{', '.join(keys)}}}"
    return line if len(line) <= WIDTH else "\n".join([f"{name}:", *(f"    {key}" for key in keys)])


def _stem(joints: Iterable[Turning]) -> str:
    """`O2` of O2.theta and O2.s; the first name of others."""
    names = [joint.name for joint in joints]
    stems = {name.rpartition(".")[0] for name in names}
    return next(iter(stems)) if len(stems) == 1 and "" not in stems else names[0]


def _is_none(shift: Any, most: float = tolerances.DRAWN_APART) -> bool:
    """Whether a displacement is none."""
    return bool(np.max(np.abs(shift - np.eye(4))) <= most)


def _on_axis(
    axis: Any, anchor: Any, theta: float, s: float, shift: Any, first: str, second: str
) -> tuple[str, ...]:
    """The keys of a joint about or along an axis, whose coordinates are theta and s as drawn."""
    if not theta and not s and _is_none(shift):
        return f"point: {_vector(anchor)}", f"axis: {_vector(axis)}"
    turn = shift[:3, :3]
    place = (shift @ [*(anchor + s * axis), 1.0])[:3]
    zero = np.eye(3)[int(np.argmin(np.abs(axis)))]
    zero = zero - (zero @ axis) * axis
    zero /= np.linalg.norm(zero)
    other = turn @ about(axis, theta) @ zero
    return (
        _either("point", first, anchor, second, place),
        f"axis: {{{first}: {_vector(axis)}, {second}: {_vector(turn @ axis)}}}",
        f"zero: {{{first}: {_vector(zero)}, {second}: {_vector(other)}}}",
    )


def _either(key: str, first: str, one: Any, second: str, other: Any) -> str:
    """A place or direction, or one for each link where they are apart."""
    if float(np.max(np.abs(np.asarray(one) - other))) <= tolerances.IMPORT_ROUNDING:
        return f"{key}: {_vector(one)}"
    return f"{key}: {{{first}: {_vector(one)}, {second}: {_vector(other)}}}"


def _vector(values: Any) -> str:
    """Three numbers; what is rounding of the largest is zero."""
    least = tolerances.IMPORT_ROUNDING * float(np.max(np.abs(values)))
    return f"[{', '.join(_number(v if abs(v) > least else 0.0) for v in values)}]"


def _number(value: float) -> str:
    """The number in at most 17 digits, in 15 where these give it to rounding."""
    short = f"{float(value) + 0.0:.15g}"
    return (
        short
        if abs(float(short) - value) <= tolerances.FIFTEEN_DIGITS * abs(value)
        else repr(float(value))
    )
