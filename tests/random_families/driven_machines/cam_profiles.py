"""Profiles of disc cams for every follower: places, radii of curvature and pressure angles.

The follower is a complex number in the frame of the ground, which the cam's turn takes back; its
derivatives give tangents and curvatures. A flat face is the tangent of its cam: the distance of the
axis from it, by the direction of its normal, is the support function of the profile.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun

LIMIT = 1e-9
Places = np.ndarray
"""Places in the plane as complex numbers."""


class Cut(NamedTuple):
    """A profile with its normals out of the cam, and the ways that the follower goes, in frames of
    the cam."""

    profile: Places
    radius: Floats
    normal: Places
    way: Places


def _traced(
    place: Places, first: Places, second: Places, way: Places, turn: Floats, r: float
) -> Cut:
    """By the centre of a roller of radius r against the ground and its derivatives by the turn."""
    back = np.exp(-1j * turn)
    tangent, bent = back * (first - 1j * place), back * (second - 2j * first - place)
    speed = np.abs(tangent)
    # the cam turns counter-clockwise, so that its profile is passed clockwise
    normal = 1j * tangent / speed
    curvature = -(np.conj(tangent) * bent).imag / speed**3
    return Cut(back * place - r * normal, 1.0 / curvature - r, normal, back * way)


def _laid(
    far: float, below: float, angle: Floats, first: Floats, second: Floats, turn: Floats
) -> Cut:
    """By a flat face that swings about a pivot on the right, at a distance from the axis."""
    back, normal = np.exp(-1j * turn), 1j * np.exp(-1j * angle)
    distance = far * np.sin(angle) - below
    # by the direction of the normal, which turns by -(1 + first)
    along = -far * np.cos(angle) * first / (1.0 + first)
    bend = (np.cos(angle) * second - np.sin(angle) * first**2 * (1.0 + first)) / (1.0 + first) ** 3
    place = normal * (distance + 1j * along)
    return Cut(back * place, distance + far * bend, back * normal, -1j * back * (place - far))


def judge(rng: np.random.Generator, judged: Judged) -> None:
    swings, contact = bool(rng.integers(2)), str(rng.choice(["knife", "roller", "flat"]))
    kind = "oscillating" if swings else "translating"
    judged.remark = f"{kind} {contact}"
    size = float(10.0 ** rng.uniform(-2, 2))
    base, waves = float(rng.uniform(0.3, 0.6)) * size, int(rng.integers(1, 4))
    rise = float(rng.uniform(0.02, 0.1)) * (0.8 if swings else size)
    follower: dict[str, Any] = {"type": kind, "contact": contact, "base_radius": base}
    roller = below = far = arm = 0.0
    if contact == "roller":
        roller = follower["radius"] = float(rng.uniform(0.05, 0.15)) * size
    if swings:
        far = follower["distance"] = float(rng.uniform(0.9, 1.2)) * size
    if swings and contact != "flat":
        arm = follower["arm"] = far - float(rng.uniform(0.0, 0.25)) * size
    elif swings or contact != "flat":
        below = follower["offset"] = float(rng.uniform(-0.1, 0.2 if swings else 0.1)) * size
    moved = {"type": "R", "links": ["ground", "s"], "point": [1, 0]}
    if not swings:
        moved = {"type": "P", "links": ["ground", "s"], "point": [0, 1], "axis": [0, 1]}
    value = f"{rise!r} {'rad' if swings else 'm'}*(1 - cos({waves}*theta))"
    given = {"type": "function", "of": "A.theta", "gives": "S.theta" if swings else "S.s"}
    data = begun(plane=True) | {
        "links": {"a": {}, "s": {}},
        "joints": {"A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]}, "S": moved},
        "couplings": {"K": given | {"value": value, "follower": follower}},
    }
    cam = judged.model(data).cam("K")
    turn = np.asarray(cam.turn, float)
    judged.rows += len(turn)

    lift = rise * (1.0 - np.cos(waves * turn))
    first, second = rise * waves * np.sin(waves * turn), rise * waves**2 * np.cos(waves * turn)
    if swings and contact == "flat":
        lowest = np.arcsin((base + below) / far)
        cut = _laid(far, below, lowest + lift, first, second, turn)
    elif swings:
        opening = (far**2 + arm**2 - (base + roller) ** 2) / (2.0 * far * arm)
        lever = arm * np.exp(-1j * (np.arccos(opening) + lift))
        place, rate, bend = far - lever, 1j * first * lever, (1j * second + first**2) * lever
        cut = _traced(place, rate, bend, 1j * lever, turn, roller)
    elif contact == "flat":
        back = np.exp(-1j * turn)
        profile = back * (first + 1j * (base + lift))
        cut = Cut(profile, base + lift + second, 1j * back, 1j * back)
    else:
        lowest = np.sqrt((base + roller) ** 2 - below**2)
        place = below + 1j * (lowest + lift)
        cut = _traced(place, 1j * first, 1j * second, 1j + 0.0 * turn, turn, roller)

    judged.compare("profile", cam.profile, [cut.profile.real, cut.profile.imag], size, LIMIT)
    # as curvatures, of a roller's centre: radii grow without bound where a cam is nearly straight
    found = np.asarray(cam.radius, float)
    curved = 1.0 / (found + roller), 1.0 / (cut.radius + roller)
    if contact == "flat":
        curved = found / size**2, cut.radius / size**2
    judged.compare("radius", *curved, 1.0 / size, LIMIT)
    leans = np.abs(np.angle(cut.normal * np.conj(cut.way)))
    judged.compare("pressure angle", np.abs(cam.pressure_angle), leans, 1.0, LIMIT)
