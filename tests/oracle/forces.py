"""Joint reactions and input efforts: free-body equations of every link in one dense linear system.

Unknown are six components per joint (the constraint wrench that the first link exerts on the
second: force, and moment about `J.point`) and one effort per input. Equations: per moving link sum
F = m a and sum M = r x m a + I alpha + omega x I omega about the ground origin; per freedom of a
joint the component that it cannot transmit is zero. No virtual power, no elimination by hand.

A leg that spins freely about the line between two spheres (`oracle.idle`) is held at its spin rate
by one more unknown, a moment along the line; it is zero where the leg is symmetric.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

from oracle.bodies import Bodies
from oracle.idle import legs, line
from oracle.kinematics import Solution
from oracle.mechanism import Joint, Load, Mechanism
from oracle.numerics import Number, linear_solve, mp
from oracle.series import coefficient
from oracle.vectors import (
    IDENTITY,
    add,
    apply,
    cross,
    dot,
    product,
    scale,
    subtract,
    transpose,
    unit,
)

Wrench = tuple[list[Number], list[Number]]
"""Force, and moment about the ground origin."""


@dataclass(frozen=True)
class Reactions:
    """By joint: the wrench that the first link exerts on the second; by driven coordinate: the
    effort.

    The wrench is the constraint's alone, without drive efforts and loads on the joint's coordinate.
    `power` is the sum of the powers of all inputs and loads less the rate of kinetic energy;
    `power_size` is the sum of their absolute values.
    """

    force: dict[str, list[Number]]
    moment: dict[str, list[Number]]
    moment_about_origin: dict[str, list[Number]]
    effort: dict[str, Number]
    holding: list[Number]
    """Moment along its line that each idle leg would need to keep its spin rate."""
    power: Number
    power_size: Number


def newton_euler(
    mechanism: Mechanism, solution: Solution, drives: Sequence[str] | None = None
) -> Reactions:
    """Reactions and efforts of a solution; raises `UnsolvableError` where they are not unique.

    Efforts act at the coordinates `drives`, or else at the inputs.
    """
    drives = solution.inputs if drives is None else tuple(drives)
    columns = {
        f"{name}.{i}": 6 * k + i for k, name in enumerate(mechanism.joints) for i in range(6)
    }
    columns |= {name: len(columns) + k for k, name in enumerate(drives)}
    lines = _lines(mechanism, solution)
    columns |= {f"leg {k}": len(columns) + k for k in range(len(lines))}
    matrix, right = _free_bodies(mechanism, solution, columns, drives)
    for k, (link, direction) in enumerate(lines):
        first = 6 * list(mechanism.links).index(link) + 3
        for i in range(3):
            matrix[first + i][columns[f"leg {k}"]] = direction[i]
    for name, joint in mechanism.joints.items():
        for row in _freedoms(joint, solution, name):
            matrix.append(_spread(len(columns), [columns[f"{name}.{i}"] for i in range(6)], row))
            right.append(mp.zero)
    found = linear_solve(matrix, right)
    force = {n: found[columns[f"{n}.0"] : columns[f"{n}.3"]] for n in mechanism.joints}
    moment = {n: found[columns[f"{n}.3"] : columns[f"{n}.5"] + 1] for n in mechanism.joints}
    effort = {name: found[columns[name]] for name in drives}
    about_origin = {
        n: add(moment[n], cross(solution.joint_point(n), force[n])) for n in mechanism.joints
    }
    powers = powers_of(mechanism, solution, effort)
    holding = [found[columns[f"leg {k}"]] for k in range(len(lines))]
    total, absolute = mp.fsum(powers), mp.fsum(abs(power) for power in powers)
    return Reactions(force, moment, about_origin, effort, holding, total, absolute)


def _lines(mechanism: Mechanism, solution: Solution) -> list[tuple[str, list[Number]]]:
    """A link and the direction between the spheres of every idle leg."""
    bodies, found = Bodies(mechanism), []
    for leg in legs(mechanism):
        direction = [coefficient(x, 0) for x in line(bodies, leg, solution.poses)]
        found.append((leg.links[0], unit(direction)))
    return found


def _spread(width: int, places: list[int], values: list[Number]) -> list[Number]:
    row = [mp.zero] * width
    for place, value in zip(places, values, strict=True):
        row[place] = value
    return row


def _free_bodies(
    mechanism: Mechanism, solution: Solution, columns: dict[str, int], drives: Sequence[str]
) -> tuple[list[list[Number]], list[Number]]:
    """Six equations per moving link: unknown wrenches = inertia less applied loads."""
    matrix: list[list[Number]] = []
    right: list[Number] = []
    applied = _applied(mechanism, solution)
    places = {name: solution.joint_point(name) for name in mechanism.joints}
    for link in mechanism.links:
        rows = [[mp.zero] * len(columns) for _ in range(6)]
        for name, joint in mechanism.joints.items():
            sign = (joint.second == link) - (joint.first == link)
            for i in range(3) if sign else ():
                push, twist = columns[f"{name}.{i}"], columns[f"{name}.{i + 3}"]
                rows[i][push] = rows[3 + i][twist] = mp.mpf(sign)
                for k, lever in enumerate(cross(places[name], IDENTITY[i])):
                    rows[3 + k][push] = sign * lever
        for coordinate in drives:
            name, kind = coordinate.split(".")
            joint = mechanism.joints[name]
            sign = (joint.second == link) - (joint.first == link)
            for k, value in enumerate(unit_effort(solution, name, kind)):
                rows[k][columns[coordinate]] = sign * value
        force, moment = _inertia(mechanism, solution, link)
        matrix += rows
        right += [a - b for a, b in zip([*force, *moment], chain(*applied[link]), strict=True)]
    return matrix, right


def unit_effort(solution: Solution, name: str, coordinate: str) -> list[Number]:
    """Force and moment about the origin on the second link of a unit effort on a coordinate.

    It does work on no other coordinate of the joint: the moment of an effort on theta1 of a U lies
    in the plane of the two axes, square to the second.
    """
    joint = solution.mechanism.joints[name]
    place, nothing = solution.joint_point(name), [mp.zero] * 3
    match coordinate:
        case "theta":
            return nothing + solution.joint_axis(name)
        case "theta1" | "theta2":
            own, other = _on_first(solution, joint, joint.axes[0]), solution.joint_axis(name)
            if coordinate == "theta2":
                own, other = other, own
            square = subtract(own, scale(other, dot(own, other)))
            return nothing + scale(square, 1 / dot(square, own))
        case "s":
            # the sphere of an Sg belongs to the first link: the second is pushed back
            push = scale(solution.joint_axis(name), -1 if joint.type == "Sg" else 1)
        case "x":
            push = _on_first(solution, joint, joint.x)
        case "y":
            push = _on_first(solution, joint, cross(joint.axes[0], joint.x))
    return [*push, *cross(place, push)]


def _on_first(solution: Solution, joint: Joint, vector: Any) -> list[Number]:
    return apply(solution.rotation(joint.first)[0], vector)


def _inertia(mechanism: Mechanism, solution: Solution, name: str) -> Wrench:
    """m a, and the rate of the moment of momentum about the origin."""
    link = mechanism.links[name]
    place, _, acceleration, _ = solution.motion(name, link.mass_centre)
    rotation = solution.rotation(name)[0]
    tensor = product(rotation, link.inertia, transpose(rotation))
    omega, alpha = solution.omega(name), solution.alpha(name)
    force = scale(acceleration, link.mass)
    spin = add(apply(tensor, alpha), cross(omega, apply(tensor, omega)))
    return force, add(cross(place, force), spin)


def _applied(mechanism: Mechanism, solution: Solution) -> dict[str, Wrench]:
    """The sum of the loads on every link."""
    applied: dict[str, Any] = {link: ([mp.zero] * 3, [mp.zero] * 3) for link in mechanism.links}
    for load in mechanism.loads:
        for link, (force, moment) in _wrenches(mechanism, solution, load):
            if link != "ground":
                applied[link] = add(applied[link][0], force), add(applied[link][1], moment)
    return applied


def _wrenches(mechanism: Mechanism, solution: Solution, load: Load) -> list[tuple[str, Wrench]]:
    nothing = [mp.zero] * 3
    if load.type == "gravity":
        weights = []
        for name, link in mechanism.links.items():
            force = scale(load.vector, link.mass)
            place = solution.motion(name, link.mass_centre)[0]
            weights.append((name, (force, cross(place, force))))
        return weights
    if load.joint:
        joint = mechanism.joints[load.joint]
        kind = "s" if load.type == "force" else "theta"
        values = scale(unit_effort(solution, load.joint, kind), amount(load.value, solution))
        force, moment = values[:3], values[3:]
        return [
            (joint.second, (force, moment)),
            (joint.first, (scale(force, -1), scale(moment, -1))),
        ]
    vector = [amount(component, solution) for component in load.vector]
    if load.turns_with_link:
        vector = apply(solution.rotation(load.link)[0], vector)
    if load.type == "torque":
        return [(load.link, (nothing, vector))]
    return [(load.link, (vector, cross(solution.motion(load.link, load.point)[0], vector)))]


def amount(value: Any, solution: Solution) -> Number:
    """A number, or a law of the solution's quantities."""
    if not callable(value):
        return value

    def quantity(name: str) -> Number:
        owner, word, *component = name.split(".")
        if component:
            place = "xyz".index(component[0])
            if word == "omega":
                return solution.omega(owner)[place]
            return solution.point(owner)[("position", "velocity").index(word)][place]
        return solution[name]

    return value(quantity)


def _freedoms(joint: Joint, solution: Solution, name: str) -> list[list[Number]]:
    """Rows on (force, moment about the joint point) that are zero: what the joint lets go."""
    nothing = [mp.zero] * 3
    moments = [[*nothing, *v] for v in IDENTITY]
    if joint.type in ("S", "W"):
        return moments if joint.type == "S" else []
    axis = solution.joint_axis(name)
    e = unit(cross(axis, min(IDENTITY, key=lambda v: abs(dot(v, axis)))))
    across = [[*v, *nothing] for v in (e, cross(axis, e))]
    turning, sliding = [*nothing, *axis], [*axis, *nothing]
    match joint.type:
        case "H":
            return [[*scale(axis, joint.lead / (2 * mp.pi)), *axis]]
        case "Sp":
            return [*moments, *across]
        case "Sg":
            return [*moments, sliding]
        case "E":
            return [*across, turning]
        case "U":
            return [[*nothing, *_on_first(solution, joint, joint.axes[0])], turning]
    return {"R": [turning], "P": [sliding], "C": [turning, sliding]}[joint.type]


def powers_of(mechanism: Mechanism, solution: Solution, effort: dict[str, Number]) -> list[Number]:
    """Powers of the inputs, of the loads, and less the rates of kinetic energy."""
    powers = [value * solution[name + "_dot"] for name, value in effort.items()]
    for load in mechanism.loads:
        powers += [
            _power(solution, link, wrench)
            for link, wrench in _wrenches(mechanism, solution, load)
            if link != "ground"
        ]
    for name in mechanism.links:
        powers.append(-_power(solution, name, _inertia(mechanism, solution, name)))
    return powers


def _power(solution: Solution, link: str, wrench: Wrench) -> Number:
    """The power of a wrench about the origin on a link: F . v + (M - r x F) . omega."""
    force, moment = wrench
    place, velocity, _, _ = solution.motion(link, [mp.zero] * 3)
    return dot(force, velocity) + dot(subtract(moment, cross(place, force)), solution.omega(link))
