"""Gears and racks to relations between coordinates, and to the forces of their teeth.

A gear: N_a phi_a + N_b phi_b = 0, phi the turns of its wheels against their carrier about one
direction (Willis 1841); the sign of the second term is the other one where a ring has its teeth
inside. A wheel that turns on another link than the carrier turns against it by the sum of its own
coordinate and that of the joint between the two links, which has the same axis.

Teeth act by a force at the pitch point, which rides on the carrier. With a moment M on the first
wheel, of pitch radius r, its tangential part is M / r, its axial one that by the tangent of the
helix angle; and it pushes the wheels apart by that by the tangent of the pressure angle in the
section square to the axes, whichever flank bears. All but the tangential part does no work where
wheels do not slide along their axes; where they do, the relation tells of that, too.

A rack: s = r phi, the pinion's turn being positive where it moves the pitch point along the rack.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path, place_at
from mechkin_cli.mechanism import (
    Frame,
    Joint,
    Mesh,
    Relation,
    Term,
    Vector,
    add,
    cross,
    dot,
    frame_on,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import GearCoupling, RackCoupling
from mechkin_cli.tape import cos, sin
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH

_QUARTER = 0.5 * pi


class Turning(NamedTuple):
    """How a wheel turns against a carrier, and slides along its axis: the terms of both, the axis
    as drawn on the carrier, about which they count, and the way from wheel to carrier (`Mesh`)."""

    terms: tuple[Term, ...]
    slides: tuple[Term, ...]
    axis: Frame
    way: tuple[tuple[str, int], ...]

    @property
    def back(self) -> tuple[tuple[str, int], ...]:
        """The way from carrier to wheel."""
        return tuple((name, -sense) for name, sense in reversed(self.way))


def gear_relation(
    fields: Fields, path: Path, section: GearCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    """The relation of two wheels; None where errors are noted in `fields`."""
    numbers = _ratio(fields, path, section)
    pair = wheels_on_one_carrier(fields, path, section.joints, joints, "wheel")
    if pair is None:
        return None
    carrier, first, second = pair
    teeth = _teeth(fields, path, section)
    if numbers is None or teeth is None:
        return None
    if norm(cross(first.axis.z, second.axis.z)) > tolerances.PARALLEL:
        return _oblique(fields, path, section, pair, numbers, teeth)
    same = dot(first.axis.z, second.axis.z) > 0.0
    ratio = numbers[1] / numbers[0]
    ratio = -ratio if same == section.internal else ratio
    terms = (*first.terms, *(t._replace(factor=ratio * t.factor) for t in second.terms))
    if section.ideal:
        return Relation(terms, length=False)
    found = _pitch_circles(fields, path, section, (first.axis, second.axis), numbers, teeth)
    if found is None:
        return None
    radius, outward, is_ring = found
    mesh = _mesh(carrier, first, (*first.way, *second.back), radius, outward, teeth)
    if is_ring:
        mesh = mesh._replace(apart=scale(-1.0, mesh.apart))
    # along the axis a wheel gives way by its helix
    by = teeth.helix_tangent / radius
    slides = (
        *(t._replace(factor=-by * t.factor) for t in first.slides),
        *(t._replace(factor=(by if same else -by) * t.factor) for t in second.slides),
    )
    return Relation((*terms, *(t for t in slides if t.factor != 0.0)), length=False, mesh=mesh)


class _Teeth(NamedTuple):
    """Tangents of the pressure angle in the section square to the axis, and of the helix angle,
    with the cosine of the latter."""

    pressure_tangent: float
    helix_tangent: float
    helix_cosine: float


def _teeth(fields: Fields, path: Path, section: GearCoupling | RackCoupling) -> _Teeth | None:
    """The form of teeth; angles of a quarter turn are noted in `fields`."""
    angles, errors = [], fields.error_count
    for key in ("pressure_angle", "helix"):
        text = getattr(section, key)
        angle = 0.0 if text is None else fields.number((*path, key), text, ANGLE)
        least = 0.0 if key == "pressure_angle" else -_QUARTER
        if not least <= angle < _QUARTER or angle == -_QUARTER:
            told = fields.units.text(float(angle), ANGLE)
            fields.error(
                "no-teeth",
                (*path, key),
                f"there are no teeth with a {key.replace('_', ' ')} of {told}",
                "usual are pressure angles of 20 deg and helix angles of up to 45 deg",
                limit="less than a quarter turn",
            )
        angles.append(angle)
    if fields.error_count > errors:
        return None
    pressure, helix = angles
    cosine = cos(helix)
    # tan(transverse) = tan(normal) / cos(helix)
    return _Teeth(sin(pressure) / cos(pressure) / cosine, sin(helix) / cosine, cosine)


def _pitch_circles(
    fields: Fields,
    path: Path,
    section: GearCoupling,
    axes: tuple[Frame, Frame],
    numbers: tuple[float, float],
    teeth: _Teeth,
) -> tuple[float, Vector, bool] | None:
    """The pitch radius of the first wheel (m), the unit vector from its axis to the pitch point,
    and whether it is the ring."""
    one, other = axes
    apart = subtract(other.o, one.o)
    across = subtract(apart, scale(dot(apart, one.z), one.z))
    distance = norm(across)
    is_ring = section.internal and numbers[0] > numbers[1]
    total = numbers[1] - numbers[0] if section.internal else numbers[0] + numbers[1]
    total = -total if is_ring else total
    if total == 0.0 or distance == 0.0:
        text = "these wheels have no pitch point: they would lie on one another"
        hint = "draw the axes apart, or write ideal: true for moments alone"
        fields.error("no-pitch-point", path, text, hint)
        return None
    wanted = None
    if section.radii is not None:
        one_radius, other_radius = (
            fields.number((*path, "radii", i), text, LENGTH) for i, text in enumerate(section.radii)
        )
        wanted = other_radius - one_radius if section.internal else one_radius + other_radius
        wanted = -wanted if is_ring else wanted
        if abs(one_radius * numbers[1] - other_radius * numbers[0]) > tolerances.PARALLEL * (
            one_radius * numbers[1]
        ):
            text = "teeth and radii tell different ratios"
            fields.error("teeth-do-not-fit", (*path, "radii"), text, "leave out one of the two")
            return None
    elif section.module is not None:
        module = fields.number((*path, "module"), section.module, LENGTH)
        wanted = module * total / (2.0 * teeth.helix_cosine)
    key = "module" if section.radii is None else "radii"
    hint = "draw the axes at the sum of the pitch radii, of a ring and its pinion at the difference"
    if wanted is not None and not _fits(fields, (*path, key), distance, wanted, hint):
        return None
    # a ring and its pinion have their pitch point beyond the pinion's axis, seen from the ring's
    beyond = -1.0 if section.internal and not is_ring else 1.0
    return numbers[0] * distance / total, scale(beyond / distance, across), is_ring


def _fits(fields: Fields, path: Path, distance: float, wanted: float, hint: str) -> bool:
    """Whether axes are drawn as far apart (m) as their wheels need; else an error is noted."""
    if abs(distance - wanted) <= tolerances.PARALLEL * distance:
        return True
    drawn, needed = (fields.units.text(float(x), LENGTH) for x in (distance, wanted))
    measured = f"axes {drawn} apart, by the wheels {needed}"
    text = "the wheels do not mesh where they are drawn"
    fields.error("centre-distance", path, text, hint, measured=measured)
    return False


def _oblique(
    fields: Fields,
    path: Path,
    section: GearCoupling,
    pair: tuple[str, Turning, Turning],
    numbers: tuple[float, float],
    teeth: _Teeth,
) -> Relation | None:
    """Wheels whose axes meet (bevel wheels), or pass each other (crossed helical wheels, worms)."""
    carrier, first, second = pair
    one, other = first.axis, second.axis
    if section.internal:
        text = "a ring with teeth inside has an axis parallel to its pinion's"
        hint = "draw the axes parallel, or leave out internal"
        fields.error("oblique-ring", (*path, "internal"), text, hint)
        return None
    normal, apart = cross(one.z, other.z), subtract(other.o, one.o)
    square = dot(normal, normal)
    foot = add(one.o, scale(dot(cross(apart, other.z), normal) / square, one.z))
    far = add(other.o, scale(dot(cross(apart, one.z), normal) / square, other.z))
    gap = subtract(far, foot)
    radius = 1.0
    if section.radii is not None:
        radius = fields.number((*path, "radii", 0), section.radii[0], LENGTH)
    elif not section.ideal:
        text = "the axes of these wheels are not parallel: teeth alone do not tell where they mesh"
        hint = "give radii, of bevel wheels at the middle of their faces, or write ideal: true"
        fields.error("no-radii", path, text, hint)
        return None
    meet = norm(gap) <= tolerances.PARALLEL * max(norm(apart), norm(subtract(one.o, foot)))
    find = _bevel if meet else _crossed
    mesh = find(fields, path, section, (first, second), numbers, teeth, (foot, gap, radius))
    if mesh is None:
        return None
    by_turn, by_slide = _work(mesh, other)
    ratio = numbers[1] / numbers[0]
    if not section.ideal and abs(abs(by_turn) - ratio) > tolerances.PARALLEL * ratio:
        fields.error(
            "teeth-do-not-fit",
            path,
            "by its radii and helix the second wheel turns another amount than by its teeth",
            "of bevel wheels radii are in proportion to teeth, of crossed ones radii by the cosine "
            "of the helix",
            measured=f"{float(1.0 / abs(by_turn)):.9g} turns for one of the first wheel",
            limit=f"{float(1.0 / ratio):.9g}",
        )
        return None
    ratio = ratio if by_turn > 0.0 else -ratio
    terms = (*first.terms, *(t._replace(factor=ratio * t.factor) for t in second.terms))
    if section.ideal:
        return Relation(terms, length=False)
    own = -dot(mesh.along, one.z)
    slides = (
        *(t._replace(factor=own * t.factor) for t in first.slides),
        *(t._replace(factor=by_slide * t.factor) for t in second.slides),
    )
    mesh = mesh._replace(carrier=carrier)
    return Relation((*terms, *(t for t in slides if t.factor != 0.0)), length=False, mesh=mesh)


def _work(mesh: Mesh, axis: Frame) -> tuple[float, float]:
    """What the force of a mesh along its flank does at a turn about, and a slide along, an axis."""
    arm = subtract(mesh.point, axis.o)
    return dot(cross(arm, mesh.along), axis.z), dot(mesh.along, axis.z)


def _bevel(
    fields: Fields,
    path: Path,
    section: GearCoupling,
    wheels: tuple[Turning, Turning],
    numbers: tuple[float, float],
    teeth: _Teeth,
    place: tuple[Vector, Vector, float],
) -> Mesh | None:
    """Teeth of pitch cones with one apex, which lie on the side of their joints' points."""
    first, second = wheels
    apex, _, radius = place
    if teeth.helix_tangent != 0.0 and not section.ideal:
        text = "these axes meet: forces of spiral teeth are not computed"
        fields.error(
            "spiral-bevel", (*path, "helix"), text, "leave out helix, or write ideal: true"
        )
        return None
    ways = [subtract(wheel.axis.o, apex) for wheel in wheels]
    for number, way in enumerate(ways):
        if norm(way) == 0.0:
            text = f"the point of {section.joints[number]} is where the axes of both wheels meet"
            hint = "draw it where the wheel is, on its side of that point"
            fields.error("wheel-at-apex", (*path, "joints", number), text, hint)
            return None
    one, other = (unit(way) for way in ways)
    across = subtract(other, scale(dot(one, other), one))
    outward = unit(across)
    # the pitch line lies between the axes, its distances from them in proportion to the teeth
    line = unit(add(scale(numbers[1] / numbers[0] + dot(one, other), one), across))
    sine, cosine = dot(line, outward), dot(line, one)
    point = add(apex, scale(radius / sine, line))
    along = scale(-1.0 / radius, cross(first.axis.z, outward))
    push = add(scale(-sine, one), scale(cosine, outward))
    apart = scale(teeth.pressure_tangent / radius, push)
    return Mesh("", point, along, apart, (*first.way, *second.back))


def _crossed(
    fields: Fields,
    path: Path,
    section: GearCoupling,
    wheels: tuple[Turning, Turning],
    numbers: tuple[float, float],
    teeth: _Teeth,
    place: tuple[Vector, Vector, float],
) -> Mesh | None:
    """Helical teeth that meet in one point between the axes."""
    first, second = wheels
    foot, gap, radius = place
    if section.helix is None or section.teeth is None:
        text = "these axes pass each other: such wheels have teeth with a helix angle"
        hint = "give teeth, and the helix of the first wheel (of a worm 90 deg less its lead angle)"
        fields.error("no-helix", path, text, hint)
        return None
    distance = norm(gap)
    if section.radii is not None:
        total = radius + fields.number((*path, "radii", 1), section.radii[1], LENGTH)
        hint = "draw the axes at the sum of the pitch radii"
        if not _fits(fields, (*path, "radii"), distance, total, hint):
            return None
    else:
        radius = 0.5 * distance  # which way the second wheel turns does not depend on it
    outward = scale(1.0 / distance, gap)
    moved = first._replace(axis=first.axis._replace(o=foot))
    return _mesh("", moved, (*first.way, *second.back), radius, outward, teeth)


def _mesh(
    carrier: str,
    first: Turning,
    way: tuple[tuple[str, int], ...],
    radius: float,
    outward: Vector,
    teeth: _Teeth,
) -> Mesh:
    """The force on the second of two wheels at the pitch point of the first: against the moment on
    that, and away from it."""
    z = first.axis.z
    around = cross(z, outward)
    along = add(scale(-1.0, around), scale(teeth.helix_tangent, z))
    point = add(first.axis.o, scale(radius, outward))
    forces = scale(1.0 / radius, along), scale(teeth.pressure_tangent / radius, outward)
    return Mesh(carrier, point, *forces, way)


def _ratio(fields: Fields, path: Path, section: GearCoupling) -> tuple[float, float] | None:
    """Teeth or radii of both wheels."""
    key, texts, dimension = "teeth", section.teeth, DIMENSIONLESS
    if texts is None:
        key, texts, dimension = "radii", section.radii, LENGTH
    assert texts is not None
    errors = fields.error_count
    one, other = (fields.number((*path, key, i), text, dimension) for i, text in enumerate(texts))
    if fields.error_count == errors:
        for i, number in enumerate((one, other)):
            if not number > tolerances.SMALLEST_DIVISOR:
                text = f"the {key} of a wheel are {texts[i]}"
                hint = "give positive numbers; internal: true is for a ring with its teeth inside"
                fields.error("no-wheel", (*path, key, i), text, hint, limit="more than 0")
    return (one, other) if fields.error_count == errors else None


def wheel_bearings(
    fields: Fields, path: Path, names: tuple[str, ...], joints: Mapping[str, Joint], word: str
) -> list[Joint] | None:
    """The joints that wheels turn on, which a coupling names; None where errors are noted."""
    for i, name in enumerate(names):
        joint = joints[name]
        if not joint.type.is_bearing:
            text = f"{joint.name} is of type {joint.letter}: a {word} turns on an R or C joint"
            hint = "name the joint that it turns on"
            fields.error("wheel-joint", (*path, "joints", i), text, hint)
            return None
    return [joints[name] for name in names]


def wheels_on_one_carrier(
    fields: Fields, path: Path, names: tuple[str, ...], joints: Mapping[str, Joint], word: str
) -> tuple[str, Turning, Turning] | None:
    """As `on_one_carrier`, of the joints that a coupling names; None where errors are noted. `word`
    says what turns there: wheel or pulley."""
    bearings = wheel_bearings(fields, path, names, joints, word)
    if bearings is None:
        return None
    one, other = bearings
    pair = on_one_carrier(one, other, joints)
    if pair is None:
        fields.error(
            "no-carrier",
            (*path, "joints"),
            f"the {word}s at {one.name} and {other.name} turn on no common link, nor on links that "
            "a joint about the axis of one of them joins",
            f"put both {word}s on one link, or join the links that they turn on by an R joint "
            f"about the axis of one {word}",
        )
    return pair


def on_one_carrier(
    one: Joint, other: Joint, joints: Mapping[str, Joint]
) -> tuple[str, Turning, Turning] | None:
    """A carrier, and how two wheels turn against it."""
    shared = {one.first, one.second} & {other.first, other.second}
    if shared:
        carrier = min(shared, key=(one.first, one.second).index)
        return carrier, against(one, carrier), against(other, carrier)
    for near, far in ((one, other), (other, one)):
        for base, carrier in product((near.first, near.second), (far.first, far.second)):
            for between in joints.values():
                joins = {between.first, between.second} == {base, carrier}
                if joins and _on_one_axis(near, between, base):
                    pair = _through(near, between, base, carrier), against(far, carrier)
                    return (carrier, *pair) if near is one else (carrier, *pair[::-1])
    return None


def against(joint: Joint, carrier: str) -> Turning:
    """The wheel at a joint's other link against the carrier."""
    sense = 1 if joint.first == carrier else -1
    slides = (Term(joint, "s", float(sense)),) if any(joint.type.slides) else ()
    turn = Term(joint, "theta", float(sense))
    return Turning((turn,), slides, frame_on(joint, carrier), ((joint.name, -sense),))


def _through(wheel: Joint, between: Joint, base: str, carrier: str) -> Turning:
    """A wheel on another link than the carrier: against that link, and with it."""
    own, with_base = against(wheel, base), against(between, carrier)
    # about the axis of the joint between them
    same = dot(frame_on(wheel, base).z, frame_on(between, base).z) > 0.0
    sign = 1.0 if same else -1.0
    terms, slides = (
        (*(t._replace(factor=sign * t.factor) for t in of_own), *of_base)
        for of_own, of_base in ((own.terms, with_base.terms), (own.slides, with_base.slides))
    )
    # the wheel is where its own joint is drawn, which the joint between them carries over
    there, here = frame_on(between, base), frame_on(between, carrier)
    place = add(here.o, here.vector(there.local(frame_on(wheel, base).o)))
    axis = with_base.axis._replace(o=place)
    return Turning(terms, slides, axis, (*own.way, *with_base.way))


def _on_one_axis(one: Joint, other: Joint, link: str) -> bool:
    """Whether two joints of a link turn about one line of its drawing."""
    if not (one.type.is_bearing and other.type.is_bearing):
        return False
    a, b = frame_on(one, link), frame_on(other, link)
    apart = subtract(b.o, a.o)
    off = norm(cross(a.z, apart))
    near = tolerances.PARALLEL * norm(apart)
    return norm(cross(a.z, b.z)) <= tolerances.PARALLEL and off <= near


def turning_and_sliding(
    fields: Fields,
    path: Path,
    names: tuple[str, ...],
    joints: Mapping[str, Joint],
    words: tuple[str, str, str],
) -> tuple[Joint, Joint, str] | None:
    """A joint that turns, one that slides, and the link that both are on; None where errors are
    noted. `words` say what the coupling is, and what turns and slides there."""
    turning, sliding = (joints[name] for name in names)
    what, turns, slides = words
    if not turning.type.is_bearing or not sliding.type.is_slider:
        fields.error(
            "coupled-joints",
            (*path, "joints"),
            f"{turning.name} is of type {turning.letter} and {sliding.name} of type "
            f"{sliding.letter}: a {what} is between the R or C joint of {turns} and the P joint of "
            f"{slides}",
            f"name the joint of {turns}, then that of {slides}",
        )
        return None
    shared = {turning.first, turning.second} & {sliding.first, sliding.second}
    if not shared:
        text = f"{turns} at {turning.name} and {slides} at {sliding.name} have no common link"
        fields.error("no-carrier", (*path, "joints"), text, "put both on one link")
        return None
    return turning, sliding, min(shared, key=(turning.first, turning.second).index)


def rack_relation(
    fields: Fields, path: Path, section: RackCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    """The relation of a pinion and its rack; None where errors are noted in `fields`."""
    words = ("rack", "the pinion", "the rack")
    found = turning_and_sliding(fields, path, section.joints, joints, words)
    if found is None:
        return None
    pinion, rack, carrier = found
    errors = fields.error_count
    radius = fields.number((*path, "radius"), section.radius, LENGTH)
    about, along = frame_on(pinion, carrier), frame_on(rack, carrier)
    pitch = along.o if section.at is None else place_at(fields, (*path, "at"), section.at)
    if fields.error_count > errors:
        return None
    if not radius > tolerances.SMALLEST_DIVISOR:
        text = f"the radius of a pinion is {section.radius}"
        fields.error(
            "no-wheel", (*path, "radius"), text, "give its pitch radius", limit="more than 0"
        )
        return None
    lever = dot(cross(about.z, subtract(pitch, about.o)), along.z)
    if abs(lever) <= tolerances.PARALLEL * radius:
        fields.error(
            "rack-through-axis",
            path,
            f"the rack's pitch line goes through the axis of {pinion.name}: on which side of the "
            "pinion it lies is not known",
            "write at: a point of the pitch line",
            measured=f"distance {fields.units.text(float(abs(lever)), LENGTH)}",
        )
        return None
    teeth = _teeth(fields, path, section)
    if teeth is None:
        return None
    wheel = against(pinion, carrier)
    slide = 1.0 if rack.first == carrier else -1.0
    side = 1.0 if lever > 0.0 else -1.0
    terms = (*wheel.terms, Term(rack, "s", -slide * side / radius))
    if section.ideal:
        return Relation(terms, length=False)
    # from the axis square to the pitch line
    outward = scale(side, cross(along.z, about.z))
    tilt = abs(dot(about.z, along.z))
    if tilt > tolerances.PARALLEL:
        fields.error(
            "rack-oblique",
            (*path, "joints"),
            f"the rack at {rack.name} does not run square to the axis of {pinion.name} as drawn",
            "draw it square, or write ideal: true for moment and force alone",
            measured=f"cosine of the angle between them {float(tilt):.3g}",
            limit=f"{tolerances.PARALLEL:g}",
        )
        return None
    way = (*wheel.way, (rack.name, 1 if rack.first == carrier else -1))
    mesh = _mesh(carrier, wheel, way, radius, outward, teeth)
    by = teeth.helix_tangent / radius
    slides = tuple(t._replace(factor=-by * t.factor) for t in wheel.slides if by != 0.0)
    return Relation((*terms, *slides), length=False, mesh=mesh)
