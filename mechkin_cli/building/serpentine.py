"""Belts and chains over more than two pulleys to relations, one for each strand but one.

The belt passes the pulleys in the order of their joints, with its face or, outside its loop, with
its back. Its strands are common tangents. Let the strand k run from pulley a to pulley b with the
tension T_k. All tensions are that of the tensioner's strand, T, and what is beyond it:

    T_k = T + D_k,    r_a phi_a = +-r_b phi_b,

the multiplier of the relation being the moment of D_k on pulley a. D_k acts along its strand alone,
which is the force of the relation (`Mesh`). T pulls in all strands, and so at each pulley by T
times the difference of the directions in which the belt leaves it and comes to it, along a fixed
line of the carrier through the axis: these forces are constant and together zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.belts import belt_pretension, belt_radii, on_wheel
from mechkin_cli.building.cable_places import Place, stretch
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.wheels import Turning, against, wheel_bearings
from mechkin_cli.kernel.functions import total
from mechkin_cli.mechanism import (
    ZERO,
    Attached,
    Joint,
    Mesh,
    Relation,
    Tension,
    Vector,
    add,
    cross,
    dot,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import BeltCoupling, ChainCoupling
from mechkin_cli.tape import of_two
from mechkin_cli.units import ANGLE, LENGTH


class BeltLoop(NamedTuple):
    """A belt over several pulleys on one carrier, as drawn: the pulleys, where the belt passes them
    in the plane of the first one's point, and the directions of the strands that leave each."""

    carrier: str
    wheels: tuple[Turning, ...]
    places: tuple[Place, ...]
    along: tuple[Vector, ...]

    def leaves(self, k: int) -> Vector:
        """Where the belt leaves pulley k (m)."""
        place = self.places[k]
        return add(place.centre.vector, scale(place.beside, cross(place.axis, self.along[k])))

    def comes(self, k: int) -> Vector:
        """Where the strand that leaves pulley k comes to the next one (m)."""
        place = self.places[(k + 1) % len(self.places)]
        return add(place.centre.vector, scale(place.beside, cross(place.axis, self.along[k])))

    def moment(self, k: int) -> float:
        """That of a unit force in the belt on pulley k about its own axis, in the way the belt
        runs (m)."""
        same = dot(self.wheels[k].axis.z, self.places[k].axis) > 0.0
        beside = self.places[k].beside
        return -beside if same else beside

    def wrap(self, k: int) -> float:
        """The angle by which the belt turns on pulley k, from 0 to 2 pi."""
        place = self.places[k]
        one, other = self.along[k - 1], self.along[k]
        turned = of_two("ATAN2", dot(cross(one, other), place.axis), dot(one, other))
        angle: float = -place.side * turned
        return angle if angle > -tolerances.PARALLEL else angle + 2.0 * pi


def serpentine_relations(
    fields: Fields,
    path: Path,
    section: BeltCoupling | ChainCoupling,
    joints: Mapping[str, Joint],
) -> dict[str, Relation]:
    """The relations of a belt over more than two pulleys by name: the coupling's, a dot and the
    joint of the pulley that the strand leaves. None where errors are noted."""
    radii = belt_radii(fields, path, section)
    pretension = belt_pretension(fields, path, section)
    if radii is None or pretension is None:
        return {}
    loop = belt_loop(fields, path, section, radii, joints)
    if loop is None:
        return {}
    count = len(section.joints)
    assert section.tensioner is not None
    held = (section.joints.index(section.tensioner) - 1) % count
    pulls = _pulls(loop, pretension, joints) if pretension != 0.0 else ()
    found = {}
    for k in range(count):
        if k != held:
            relation = _strand(loop, k, (k + 1) % count, pretension)
            found[f"{path[-1]}.{section.joints[k]}"] = relation._replace(pulls=pulls)
            pulls = ()
    return found


def _strand(loop: BeltLoop, k: int, to: int, pretension: float) -> Relation:
    """The relation of two pulleys by the strand from one to the other."""
    one, other = loop.wheels[k], loop.wheels[to]
    arm, back = loop.moment(k), loop.moment(to)
    ratio = -back / arm
    terms = (*one.terms, *(t._replace(factor=ratio * t.factor) for t in other.terms))
    pull = scale(-1.0 / arm, loop.along[k])
    mesh = Mesh(loop.carrier, loop.leaves(k), pull, ZERO, (*one.way, *other.back))
    tension = Tension(1.0 / arm, 0.0, pretension)
    return Relation(terms, length=False, mesh=mesh, tensions=(("tension", tension),))


def _pulls(
    loop: BeltLoop, pretension: float, joints: Mapping[str, Joint]
) -> tuple[tuple[Attached, Attached, float], ...]:
    """What the pretension pulls each pulley with, towards a point of the carrier."""
    found = []
    for k, (wheel, place) in enumerate(zip(loop.wheels, loop.places, strict=True)):
        both = subtract(loop.along[k], loop.along[k - 1])
        centre = place.centre.vector
        # any point of the line does
        end = Attached(loop.carrier, add(centre, scale(place.radius, unit(both))))
        found.append((on_wheel(wheel, centre, joints), end, pretension * norm(both)))
    return tuple(found)


def belt_loop(
    fields: Fields,
    path: Path,
    section: BeltCoupling | ChainCoupling,
    radii: Sequence[float],
    joints: Mapping[str, Joint],
) -> BeltLoop | None:
    """A belt over more than two pulleys as drawn; None where errors are noted."""
    pulleys = wheel_bearings(fields, path, section.joints, joints, "pulley")
    if pulleys is None:
        return None
    shared = [
        link
        for link in (pulleys[0].first, pulleys[0].second)
        if all(link in (joint.first, joint.second) for joint in pulleys)
    ]
    if not shared:
        fields.error(
            "no-carrier",
            (*path, "joints"),
            f"the pulleys at {', '.join(section.joints)} turn on no common link",
            "put all pulleys on one link",
        )
        return None
    wheels = tuple(against(joint, shared[0]) for joint in pulleys)
    if not _are_parallel(fields, path, section, wheels):
        return None
    axis, start = wheels[0].axis.z, wheels[0].axis.o
    centres = []
    for wheel in wheels:
        apart = subtract(wheel.axis.o, start)
        centres.append(add(start, subtract(apart, scale(dot(apart, axis), axis))))
    if not _are_apart(fields, path, section, centres, radii):
        return None
    way = _way_round(centres, axis)
    places = tuple(
        Place(Attached(shared[0], at), radius, way if name in section.outside else -way, axis=axis)
        for name, at, radius in zip(section.joints, centres, radii, strict=True)
    )
    along = tuple(
        stretch(one, other)[1] for one, other in zip(places, (*places[1:], places[0]), strict=True)
    )
    loop = BeltLoop(shared[0], wheels, places, along)
    return loop if _closes(fields, path, section, loop) else None


def _are_parallel(
    fields: Fields, path: Path, section: BeltCoupling | ChainCoupling, wheels: Sequence[Turning]
) -> bool:
    """Whether all axes are parallel, and no pulley slides; what is wrong is noted."""
    for name, wheel in zip(section.joints, wheels, strict=True):
        tilt = norm(cross(wheels[0].axis.z, wheel.axis.z))
        if tilt > tolerances.PARALLEL:
            fields.error(
                "belt-oblique",
                (*path, "joints"),
                f"the axes of {section.joints[0]} and {name} are not parallel as drawn",
                "draw them parallel, or write a linear coupling for the motion alone",
                measured=f"sine of the angle between them {float(tilt):.3g}",
                limit=f"{tolerances.PARALLEL:g}",
            )
            return False
        if wheel.slides:
            text = f"the pulley at {name} may slide along its axis, where the belt tilts"
            fields.error("pulley-slides", (*path, "joints"), text, f"make {name} an R joint")
            return False
    return True


def _are_apart(
    fields: Fields,
    path: Path,
    section: BeltCoupling | ChainCoupling,
    centres: Sequence[Vector],
    radii: Sequence[float],
) -> bool:
    """Whether no pulleys lie on one another; what is wrong is noted."""
    for k, name in enumerate(section.joints):
        for other in range(k):
            distance, least = norm(subtract(centres[k], centres[other])), radii[k] + radii[other]
            if not distance > least:
                measured, limit = (fields.units.text(float(x), LENGTH) for x in (distance, least))
                fields.error(
                    "pulleys-overlap",
                    (*path, "joints"),
                    f"the pulleys at {section.joints[other]} and {name} lie on one another where "
                    "they are drawn",
                    "draw the axes further apart than the sum of the radii",
                    measured=f"axes {measured} apart",
                    limit=f"more than {limit}",
                )
                return False
    return True


def _way_round(centres: Sequence[Vector], axis: Vector) -> float:
    """1 where the belt runs anticlockwise about an axis, -1 where clockwise: by the area within."""
    area = 0.0
    for one, other in zip(centres, (*centres[1:], centres[0]), strict=True):
        from_first = subtract(one, centres[0]), subtract(other, centres[0])
        area = area + dot(cross(*from_first), axis)
    return 1.0 if area >= 0.0 else -1.0


def _closes(
    fields: Fields, path: Path, section: BeltCoupling | ChainCoupling, loop: BeltLoop
) -> bool:
    """Whether the belt touches each pulley and runs round once; what is wrong is noted."""
    wraps = [loop.wrap(k) for k in range(len(loop.places))]
    for name, wrap in zip(section.joints, wraps, strict=True):
        if not wrap > tolerances.FLEET:
            fields.error(
                "no-wrap",
                (*path, "joints"),
                f"the belt passes the pulley at {name} without touching it",
                "move it into the strand, or leave it out",
                measured=f"arc {fields.units.text(float(wrap), ANGLE)}",
                limit="more than 0",
            )
            return False
    way = -total(place.side * wrap for place, wrap in zip(loop.places, wraps, strict=True))
    if not abs(abs(way) - 2.0 * pi) < 1.0:
        fields.error(
            "belt-crosses",
            (*path, "joints"),
            "the belt does not run round once: it misses a pulley, or passes one on the wrong side",
            _ORDER,
            measured=f"turns {float(way) / (2.0 * pi):.3g}",
            limit="1 or -1",
        )
        return False
    return _is_free(fields, path, section, loop)


_ORDER = (
    "give the joints in the order in which the belt passes them, and under outside those that it "
    "touches with its back"
)


def _is_free(
    fields: Fields, path: Path, section: BeltCoupling | ChainCoupling, loop: BeltLoop
) -> bool:
    """Whether no strand crosses another one, or runs through a pulley; what is wrong is noted."""
    axis, count, names = loop.places[0].axis, len(loop.places), section.joints

    def side(k: int, at: Vector) -> float:
        return dot(cross(loop.along[k], subtract(at, loop.leaves(k))), axis)

    for k in range(count):
        start, end = loop.leaves(k), loop.comes(k)
        for other in range(k):
            near, far = loop.leaves(other), loop.comes(other)
            if side(k, near) * side(k, far) < 0.0 and side(other, start) * side(other, end) < 0.0:
                text = f"the strands that leave {names[other]} and {names[k]} cross"
                fields.error("belt-crosses", (*path, "joints"), text, _ORDER)
                return False
        for other in set(range(count)) - {k, (k + 1) % count}:
            place = loop.places[other]
            on = dot(loop.along[k], subtract(place.centre.vector, start))
            is_beside = 0.0 < on < dot(loop.along[k], subtract(end, start))
            if is_beside and abs(side(k, place.centre.vector)) < place.radius:
                text = (
                    f"the strand that leaves {names[k]} runs through the pulley at {names[other]}"
                )
                fields.error("belt-crosses", (*path, "joints"), text, _ORDER)
                return False
    return True
