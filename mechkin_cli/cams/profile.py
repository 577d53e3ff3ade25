"""The profile of a disc cam that moves its follower by a function of its turn.

The cam turns by theta about its centre, counter-clockwise. Everything is first found where the
follower is, in axes that stand: the centre is the origin; a translating follower moves along +y, on
the line x = offset; an oscillating one turns about a pivot at x = distance, its arm over the cam,
clockwise as it rises. Turned back by theta these are places on the cam. With w the centre of a
roller there and ' the derivative by theta, w' less the motion of the cam is the tangent of the
pitch curve,

    t = w' - J w,  t' = w'' - 2 J w' - w,  J a quarter turn,

and the curvature follows from both. A flat face is the tangent of the profile: with p its distance
from the centre and psi the angle of its normal, the radius of curvature is p + d2p/dpsi2. The
pressure angle phi lies between the normal of the profile and the motion of the follower, with

    tan(phi) = (s' - offset)/(s + sqrt((base_radius + radius)^2 - offset^2))

for a translating roller.
Source: R. L. Norton, Cam Design and Manufacturing Handbook, chapters 7 and 13.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import cos, of_one, of_two, sin

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Follower
    from mechkin_cli.show import Bools, Floats


class Profile(NamedTuple):
    """A cam at some turns (rows,), in SI and the cam's own axes, those of the drawing at turn 0.

    Attributes:
        pitch: path of the roller's centre or the knife's edge (2, rows); nan for a flat face.
        surface: the profile (2, rows).
        pressure: pressure angle (rows,).
        radius: of curvature of the profile (rows,), negative where it is hollow, and where the cam
            would be cut under.
        hollow: whether the profile is hollow (rows,).
    """

    pitch: Floats
    surface: Floats
    pressure: Floats
    radius: Floats
    hollow: Bools

    @property
    def roundness(self) -> Floats:
        """The radius where the profile is round, else infinite (rows,). Where it is not above zero
        the profile would be cut away again: nothing of the cam could touch the follower there."""
        return np.where(self.hollow, np.inf, self.radius)


def profile_of(follower: Follower, turn: Floats, orders: Floats) -> Profile:
    """The profile at turns (rows,), where the follower's coordinate and its derivatives are known
    (4, rows)."""
    with np.errstate(all="ignore"):
        if follower.contact == "flat":
            return _flat(follower, turn, orders)
        return _rolled(follower, turn, orders)


Plane = tuple[Any, Any]
"""x and y, each (rows,)."""


def _rolled(follower: Follower, turn: Floats, orders: Floats) -> Profile:
    w, w1, w2, way = _centre(follower, orders)
    t = w1[0] + w[1], w1[1] - w[0]
    bend = w2[0] + 2.0 * w1[1] - w[0], w2[1] - 2.0 * w1[0] - w[1]
    size = np.sqrt(t[0] * t[0] + t[1] * t[1])
    # the pitch curve runs clockwise round the cam, where it is round
    pitch_radius = -(size * size * size) / _across(t, bend)
    normal = -t[1] / size, t[0] / size
    surface = w[0] - follower.radius * normal[0], w[1] - follower.radius * normal[1]
    pressure = of_two("ATAN2", t[0] * way[0] + t[1] * way[1], _across(t, way))
    radius = pitch_radius - follower.radius
    hollow = pitch_radius < 0.0
    return Profile(_on_cam(w, turn), _on_cam(surface, turn), pressure, radius, hollow)


def _centre(follower: Follower, orders: Floats) -> tuple[Plane, Plane, Plane, Plane]:
    """The roller's centre with two derivatives, and the unit vector along which it rises."""
    prime = follower.base_radius + follower.radius
    lift, first, second = orders[:3]
    one, zero = np.ones(lift.shape), np.zeros(lift.shape)
    if not follower.oscillates:
        offset = follower.offset * one
        height = np.sqrt(prime * prime - follower.offset * follower.offset) + lift
        return (offset, height), (zero, first), (zero, second), (zero, one)
    arm, distance = follower.arm, follower.distance
    angle = lift + _lowest(follower)
    s, c = sin(angle), cos(angle)
    centre = distance - arm * c, arm * s
    rate = arm * first
    more, turned = arm * second, arm * first * first
    return (
        centre,
        (rate * s, rate * c),
        (more * s + turned * c, more * c - turned * s),
        (s, c),
    )


def _lowest(follower: Follower) -> float:
    """The angle of an oscillating follower's arm, or face, from the line to the cam's centre where
    it lies on the base circle."""
    distance, arm = follower.distance, follower.arm
    if follower.contact == "flat":
        lowest = of_one("ASIN", (follower.base_radius + follower.offset) / distance)
    else:
        prime = follower.base_radius + follower.radius
        cosine = (distance * distance + arm * arm - prime * prime) / (2.0 * distance * arm)
        lowest = of_one("ACOS", cosine)
    return float(lowest)


def _flat(follower: Follower, turn: Floats, orders: Floats) -> Profile:
    lift, first, second = orders[:3]
    if not follower.oscillates:
        height = follower.base_radius + lift
        contact = first, height
        radius, pressure = height + second, np.zeros(lift.shape)
    else:
        angle = lift + _lowest(follower)
        s, c = sin(angle), cos(angle)
        distance, offset = follower.distance, follower.offset
        # the face touches where the normal goes through the pole of cam and follower
        pole = first * distance / (1.0 + first)
        along = (distance - pole) * c
        rise = (distance - pole) * s - offset
        contact = pole + rise * s, rise * c
        # of p by psi = 90 deg - angle - turn
        p, p1 = distance * s - offset, distance * c * first
        p2 = distance * (c * second - s * first * first)
        q1, q2 = -(1.0 + first), -second
        radius = p + (p2 * q1 - p1 * q2) / (q1 * q1 * q1)
        pressure = of_two("ATAN2", offset * np.ones(lift.shape), along)
    nothing = np.full((2, lift.size), np.nan)
    never = np.zeros(lift.shape, dtype=np.bool_)
    return Profile(nothing, _on_cam(contact, turn), pressure, radius, never)


def _across(a: Plane, b: Plane) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _on_cam(place: Plane, turn: Floats) -> Floats:
    """A place where the follower is, in the axes of the cam."""
    s, c = sin(turn), cos(turn)
    return np.stack([c * place[0] + s * place[1], c * place[1] - s * place[0]])
