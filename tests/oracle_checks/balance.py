"""Momentum of all links, what acts on them from outside, and differences over time."""

from __future__ import annotations

from oracle import mp
from oracle.forces import unit_effort
from oracle.vectors import add, apply, cross, product, scale, transpose

STEP = mp.mpf("1e-7")
"""Time between neighbouring solutions."""

_COORDINATE_OF = {"torque": "theta", "force": "s"}


def difference(values):
    """The first derivative by central differences of fourth order: error about STEP^4 = 1e-28."""
    return (8 * (values[3] - values[1]) - (values[4] - values[0])) / (12 * STEP)


def length(vector):
    return max(map(abs, vector))


def momentum(found):
    """Linear momentum of all links, and its moment with their spins about the ground origin."""
    total = [mp.zero] * 6
    for name, link in found.mechanism.links.items():
        place, velocity, _, _ = found.motion(name, link.mass_centre)
        rotation = found.rotation(name)[0]
        spin = apply(product(rotation, link.inertia, transpose(rotation)), found.omega(name))
        linear = scale(velocity, link.mass)
        total = add(total, [*linear, *add(cross(place, linear), spin)])
    return total


def external(found, reactions):
    """Force and moment about the origin on all links together, from ground and the loads."""
    mechanism = found.mechanism
    total = [mp.zero] * 6
    for name, joint in mechanism.joints.items():
        sign = (joint.first == "ground") - (joint.second == "ground")
        wrench = [*reactions.force[name], *reactions.moment_about_origin[name]]
        total = add(total, scale(wrench, sign))
        efforts = [(c.split("."), e) for c, e in reactions.effort.items()]
        drives = [(coordinate, e) for (joint, coordinate), e in efforts if joint == name]
        drives += [(_COORDINATE_OF[x.type], x.value) for x in mechanism.loads if x.joint == name]
        for coordinate, value in drives:
            total = add(total, scale(unit_effort(found, name, coordinate), value * sign))
    for load in mechanism.loads:
        if load.type == "gravity":
            for name, link in mechanism.links.items():
                weight = scale(load.vector, link.mass)
                place = found.motion(name, link.mass_centre)[0]
                total = add(total, [*weight, *cross(place, weight)])
        elif load.link and load.type == "torque":
            total = add(total, [mp.zero] * 3 + list(load.vector))
        elif load.link:
            force = apply(found.rotation(load.link)[0], load.vector)
            place = found.motion(load.link, load.point)[0]
            total = add(total, [*force, *cross(place, force)])
    return total
