"""The oracle's answers for one row by the quantities' names: 40-digit numbers in arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from oracle import Mechanism, Reactions, Solution
from oracle.forces import amount, unit_effort
from oracle.vectors import add, apply, cross, dot, product, scale, subtract, transpose

_COORDINATE_OF = {"torque": "theta", "force": "s"}


def expected(mechanism: Mechanism, solution: Solution, loads: Reactions) -> dict[str, np.ndarray]:
    """Coordinates, points, links, joints, reactions, efforts, what ground feels."""
    found: dict[str, Any] = {}
    for name, joint in mechanism.joints.items():
        # a weld has no place of its own
        if joint.type != "W":
            found[f"{name}.moment"] = loads.moment[name]
            found[f"{name}.total_moment"] = _total(solution, loads, name)[3:]
        found[f"{name}.force"] = loads.force[name]
        found[f"{name}.total_force"] = _total(solution, loads, name)[:3]
        found[f"{name}.moment_about_origin"] = loads.moment_about_origin[name]
    found |= {f"{name}.effort": effort for name, effort in loads.effort.items()}
    shaking = _on_ground(mechanism, solution, loads)
    found |= {"ground.shaking_force": shaking[:3], "ground.shaking_moment": shaking[3:]}
    return motion_of(mechanism, solution) | _arrays(found)


def motion_of(mechanism: Mechanism, solution: Solution) -> dict[str, np.ndarray]:
    """What needs no reactions: coordinates, points, links, inertia forces, energies."""
    found: dict[str, Any] = {}
    for name, joint in mechanism.joints.items():
        for coordinate in joint.coordinates:
            for suffix in ("", "_dot", "_ddot", "_dddot"):
                found[f"{name}.{coordinate}{suffix}"] = solution[f"{name}.{coordinate}{suffix}"]
        if joint.axes and joint.type != "U":
            found[f"{name}.axis"] = solution.joint_axis(name)
        if joint.type in ("Sp", "Sg"):
            contact = solution.motion(joint.second, joint.points[1])[0]
            found[f"{name}.slip"] = subtract(solution.joint_point(name), contact)
        if joint.type != "W":
            found[f"{name}.point"] = solution.joint_point(name)
    for name in mechanism.points:
        words = ("position", "velocity", "acceleration", "jerk")
        found |= {f"{name}.{w}": v for w, v in zip(words, solution.point(name), strict=True)}
    for name in mechanism.links:
        found |= {f"{name}.omega": solution.omega(name), f"{name}.alpha": solution.alpha(name)}
    inertia = _inertia(mechanism, solution)
    found |= {"ground.inertia_force": inertia[:3], "ground.inertia_moment": inertia[3:]}
    found["row.kinetic_energy"] = _kinetic_energy(mechanism, solution)
    found["row.potential_energy"] = _potential_energy(mechanism, solution)
    return _arrays(found)


def _arrays(found: dict[str, Any]) -> dict[str, np.ndarray]:
    return {name: np.array(value, dtype=object, ndmin=1) for name, value in found.items()}


def _total(solution: Solution, loads: Reactions, name: str) -> list[Any]:
    """Force, and moment about the joint's point, of constraint and drives together."""
    total: list[Any] = [*loads.force[name], *loads.moment_about_origin[name]]
    for driven, effort in loads.effort.items():
        joint, _, coordinate = driven.partition(".")
        if joint == name:
            total = add(total, scale(unit_effort(solution, name, coordinate), effort))
    if solution.mechanism.joints[name].type == "W":
        return total
    lever = cross(solution.joint_point(name), total[:3])
    return [*total[:3], *subtract(total[3:], lever)]


def _kinetic_energy(mechanism: Mechanism, solution: Solution) -> Any:
    """Half of m v.v + omega.I omega in ground axes."""
    twice = 0
    for name, link in mechanism.links.items():
        velocity, omega = solution.motion(name, link.mass_centre)[1], solution.omega(name)
        rotation = solution.rotation(name)[0]
        tensor = product(rotation, link.inertia, transpose(rotation))
        twice += link.mass * dot(velocity, velocity) + dot(omega, apply(tensor, omega))
    return twice / 2


def _potential_energy(mechanism: Mechanism, solution: Solution) -> Any:
    """Of gravity alone, from the ground origin."""
    total = 0
    for load in mechanism.loads:
        if load.type == "gravity":
            for name, link in mechanism.links.items():
                place = solution.motion(name, link.mass_centre)[0]
                total -= link.mass * dot(load.vector, place)
    return total


def _on_ground(mechanism: Mechanism, solution: Solution, loads: Reactions) -> list[Any]:
    """Force and moment about the origin: joints at ground, with their drives and joint loads."""
    total: list[Any] = [0] * 6
    for name, joint in mechanism.joints.items():
        sign = (joint.second == "ground") - (joint.first == "ground")
        wrench = [*loads.force[name], *loads.moment_about_origin[name]]
        along = [(c.split(".")[1], e) for c, e in loads.effort.items() if c.split(".")[0] == name]
        own = [x for x in mechanism.loads if x.joint == name]
        along += [(_COORDINATE_OF[x.type], amount(x.value, solution)) for x in own]
        for coordinate, value in along:
            wrench = add(wrench, scale(unit_effort(solution, name, coordinate), value))
        total = add(total, scale(wrench, sign))
    return total


def _inertia(mechanism: Mechanism, solution: Solution) -> list[Any]:
    """The sum of -m a, and of -(r x m a + I alpha + omega x I omega)."""
    total: list[Any] = [0] * 6
    for name, link in mechanism.links.items():
        place, _, acceleration, _ = solution.motion(name, link.mass_centre)
        force = scale(acceleration, -link.mass)
        rotation = solution.rotation(name)[0]
        tensor = product(rotation, link.inertia, transpose(rotation))
        omega, alpha = solution.omega(name), solution.alpha(name)
        spin = add(apply(tensor, alpha), cross(omega, apply(tensor, omega)))
        total = add(total, [*force, *add(cross(place, force), scale(spin, -1))])
    return total
