"""Coulomb friction of joints by hand: bearing loads from equilibrium, forces by fixed point.

Every contact's load is written out from the force and moment of the joint in axes of its own; the
friction forces are found by repeating z = mu N(z), with N from dense free-body equations: slow, and
nothing of the package's system. A file's friction loads are `rubbings`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from oracle.document import document
from oracle.expressions import Scope
from oracle.forces import Reactions, newton_euler
from oracle.kinematics import Solution
from oracle.mechanism import Load, Mechanism
from oracle.numerics import Number, mp
from oracle.units import Units
from oracle.vectors import IDENTITY, add, apply, cross, dot, norm, scale, subtract, unit

_LENGTHS = ("radius", "length", "collar", "width")
_ROUNDS = 2_000


class NoFixedPoint(Exception):
    """Friction does not come to rest: it jams, or nearly."""


@dataclass(frozen=True)
class Rubbing:
    """Friction of a joint in the base; the coefficient by speed of the surfaces."""

    joint: str
    at_rest: Number
    sliding: Number
    speed: Number | None
    lengths: dict[str, Number]
    across: list[Number] | None
    flank: Number

    def coefficient(self, speed: Number) -> Number:
        if speed == 0:
            return self.at_rest
        if self.speed is None:
            return self.sliding
        return self.sliding + (self.at_rest - self.sliding) * mp.exp(-((speed / self.speed) ** 2))


@dataclass(frozen=True)
class Rubbed:
    """Reactions with friction; by joint: normal load, force and moment of friction on the second
    link (about the joint's point), and the power that it takes."""

    reactions: Reactions
    normal: dict[str, Number]
    force: dict[str, list[Number]]
    moment: dict[str, list[Number]]
    power: dict[str, Number]


def without_friction(source: Any) -> dict[str, Any]:
    """A document without its friction loads, as the reader takes it."""
    data = document(source)
    loads = [load for load in data.get("loads", []) if load["type"] != "friction"]
    return data | {"loads": loads}


def rubbings(source: Any, **parameters: str) -> list[Rubbing]:
    """The friction loads of a document."""
    data = document(source)
    scope = Scope(Units(data.get("units")), data.get("parameters", {}) | parameters)
    return [_rubbing(scope, load) for load in data["loads"] if load["type"] == "friction"]


def _rubbing(scope: Scope, load: dict[str, Any]) -> Rubbing:
    given = load["coefficient"]
    texts = given if isinstance(given, dict) else {"static": given, "sliding": given}
    at_rest, sliding = (scope.scalar(texts[key], "number") for key in ("static", "sliding"))
    speed = scope.scalar(texts["speed"], "speed") if "speed" in texts else None
    lengths = {key: scope.scalar(load[key], "length") for key in _LENGTHS if key in load}
    across = unit(scope.vector(load["across"], "number")) if "across" in load else None
    flank = scope.scalar(load.get("flank", "0"), "angle")
    return Rubbing(load["joint"], at_rest, sliding, speed, lengths, across, flank)


def rub(
    mechanism: Mechanism,
    solution: Solution,
    found: list[Rubbing],
    actuators: Sequence[str] | None = None,
) -> Rubbed:
    """Reactions with friction, every joint in motion, the efforts at the inputs or `actuators`."""
    plain = newton_euler(mechanism, solution, actuators)
    directions = [_direction(solution, each) for each in found]
    by_unit = []
    for each, (direction, _) in zip(found, directions, strict=True):
        loads = [*mechanism.loads, *_drag(mechanism, solution, each, direction, mp.one)]
        by_unit.append(newton_euler(replace(mechanism, loads=loads), solution, actuators))
    z = _fixed_point(solution, found, directions, plain, by_unit)
    loads = list(mechanism.loads)
    for each, (direction, _), value in zip(found, directions, z, strict=True):
        loads += _drag(mechanism, solution, each, direction, value)
    reactions = newton_euler(replace(mechanism, loads=loads), solution, actuators)
    normal, force, moment, power = {}, {}, {}, {}
    for each, (direction, speed), value in zip(found, directions, z, strict=True):
        joint = each.joint
        normal[joint] = _normal_load(solution, each)(
            reactions.force[joint], reactions.moment[joint]
        )
        force[joint] = scale(direction[0], -value)
        moment[joint] = scale(direction[1], -value)
        power[joint] = value * speed
    return Rubbed(reactions, normal, force, moment, power)


def _drag(
    mechanism: Mechanism, solution: Solution, each: Rubbing, direction: Any, value: Number
) -> list[Load]:
    """The friction as loads on both links."""
    joint, point = mechanism.joints[each.joint], solution.joint_point(each.joint)
    found = []
    for link, sign in ((joint.second, -1), (joint.first, 1)):
        if link == "ground":
            continue
        force, couple = (scale(part, sign * value) for part in direction)
        origin = solution.motion(link, [mp.zero] * 3)[0]
        moment = add(couple, cross(subtract(point, origin), force))
        found.append(Load("force", link=link, point=[mp.zero] * 3, vector=force))
        found.append(Load("torque", link=link, vector=moment))
    return found


def _fixed_point(
    solution: Solution, found: list[Rubbing], directions: Any, plain: Any, by_unit: Any
) -> list[Number]:
    base = [[*plain.force[each.joint], *plain.moment[each.joint]] for each in found]
    gain = [
        [subtract([*one.force[each.joint], *one.moment[each.joint]], own) for one in by_unit]
        for each, own in zip(found, base, strict=True)
    ]
    normal = [_normal_load(solution, each) for each in found]
    factor = [each.coefficient(speed) for each, (_, speed) in zip(found, directions, strict=True)]
    z = [mp.zero] * len(found)
    for _ in range(_ROUNDS):
        new = []
        for k, own in enumerate(base):
            loads = [
                mp.fdot([one, *z], [1, *parts]) for one, *parts in zip(own, *gain[k], strict=True)
            ]
            new.append(factor[k] * normal[k](loads[:3], loads[3:]))
        change = max(abs(a - b) for a, b in zip(new, z, strict=True))
        z = new
        if change <= mp.mpf(10) ** -25 * max(*z, mp.mpf(10) ** -25):
            return z
    raise NoFixedPoint


def _axes(solution: Solution, each: Rubbing) -> tuple[list[Number], list[Number], list[Number]]:
    """Axis z of the joint now, and two directions square to it; x across a guide."""
    joint = solution.mechanism.joints[each.joint]
    if joint.axes is None:
        return IDENTITY[2], IDENTITY[0], IDENTITY[1]
    z = solution.joint_axis(each.joint)
    if each.across is not None:
        across = apply(solution.rotation(joint.second)[0], each.across)
    else:
        across = min(IDENTITY, key=lambda v: abs(dot(v, z)))
    x = unit(subtract(across, scale(z, dot(z, across))))
    return z, x, cross(z, x)


def _direction(solution: Solution, each: Rubbing) -> tuple[Any, Number]:
    """Force and couple that a unit of friction takes from the second link, and the speed."""
    joint = solution.mechanism.joints[each.joint]
    point = solution.joint_point(each.joint)
    z = _axes(solution, each)[0]
    velocity, omega = [mp.zero] * 3, [mp.zero] * 3
    for link, sign in ((joint.second, 1), (joint.first, -1)):
        if link == "ground":
            continue
        turn = solution.omega(link)
        origin, speed = solution.motion(link, [mp.zero] * 3)[:2]
        here = add(speed, cross(turn, subtract(point, origin)))
        velocity, omega = add(velocity, scale(here, sign)), add(omega, scale(turn, sign))
    radius = each.lengths.get("radius", mp.zero)
    along, about = scale(z, dot(z, velocity)), scale(z, dot(z, omega))
    nothing = [mp.zero] * 3
    slide, turn = {
        "R": (nothing, about),
        "P": (along, nothing),
        "C": (along, about),
        "H": (along, about),
        "S": (nothing, omega),
        "Sp": (subtract(velocity, along), nothing),
        "Sg": (along, nothing),
    }[joint.type]
    speed = mp.sqrt(dot(slide, slide) + radius**2 * dot(turn, turn))
    return (scale(slide, 1 / speed), scale(turn, radius**2 / speed)), speed


def _normal_load(solution: Solution, each: Rubbing) -> Callable[[Any, Any], Number]:
    """The normal load from the joint's force and moment about its point."""
    axes = _axes(solution, each)
    z, x, y = axes
    kind, lead = solution.mechanism.joints[each.joint].type, mp.zero
    if kind == "H":
        lead = solution.mechanism.joints[each.joint].lead

    def normal(force: Any, moment: Any) -> Number:
        f = [dot(axis, force) for axis in (x, y, z)]
        m = [dot(axis, moment) for axis in (x, y, z)]
        return _normal(each, kind, lead, f, m)

    return normal


def _normal(each: Rubbing, kind: str, lead: Number, force: Any, moment: Any) -> Number:
    lengths = each.lengths
    (fx, fy, fz), (mx, my, _) = force, moment
    if kind == "S":
        return norm(force)
    if kind == "Sp":
        return abs(fz)
    if kind == "Sg":
        return mp.hypot(fx, fy)
    if kind == "H":
        lead_angle = mp.atan2(lead / (2 * mp.pi), lengths["radius"])
        return abs(fz) / mp.cos(lead_angle) / mp.cos(each.flank)
    if kind == "P":
        return _guide(lengths, each.across is not None, (fx, fy), moment)
    total = mp.hypot(fx, fy)
    if "length" in lengths:
        # upper bearing at + length / 2: moments about the lower one
        half = lengths["length"] / 2
        upper = (fx * half + my) / (2 * half), (fy * half - mx) / (2 * half)
        total = mp.hypot(*upper) + mp.hypot(fx - upper[0], fy - upper[1])
    if "collar" in lengths:
        total += lengths["collar"] / lengths["radius"] * abs(fz)
    return total


def _guide(lengths: Any, faced: bool, force: Any, moment: Any) -> Number:
    """Four shoes, at +- length / 2 along z and +- width / 2 along x."""
    (fx, fy), (mx, my, mz) = force, moment
    total = mp.zero
    ends = (1, -1) if "length" in lengths else (0,)
    for end in ends:
        lever = 1 / lengths["length"] if end else mp.zero
        at_end = fx / len(ends) + end * my * lever, fy / len(ends) - end * mx * lever
        if not faced or "width" not in lengths:
            total += mp.hypot(*at_end)
            continue
        total += abs(at_end[0])
        couple = mz / len(ends) / lengths["width"]
        total += abs(at_end[1] / 2 + couple) + abs(at_end[1] / 2 - couple)
    if not faced and "width" in lengths:
        total += 2 * abs(mz) / lengths["width"]
    return total
