"""`couplings:` to relations between coordinates, each a sum of terms that is constant.

A gear: N_a phi_a + N_b phi_b = 0, phi the turns of its wheels against their carrier about one
direction (Willis 1841); the sign of the second term is the other one where a ring has its teeth
inside. A wheel that turns on another link than the carrier turns against it by the sum of its own
coordinate and that of the joint between the two links, which has the same axis.

A rack: s = r phi, the pinion's turn being positive where it moves the pitch point along the rack.
"""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path, is_coordinate, place_at
from mechkin_cli.diagnostics import Number, nearest_hint
from mechkin_cli.mechanism import (
    Frame,
    Joint,
    Relation,
    Term,
    cross,
    dimension_of,
    dot,
    frame_on,
    norm,
    subtract,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import AnyCoupling, GearCoupling, LinearCoupling, RackCoupling
from mechkin_cli.units import DIMENSIONLESS, LENGTH


def coupled_joints(couplings: Mapping[str, AnyCoupling]) -> set[str]:
    """Names of the joints that couplings name."""
    return {
        name
        for section in couplings.values()
        for name in (
            [term.rpartition(".")[0] for term in section.terms]
            if isinstance(section, LinearCoupling)
            else section.joints
        )
    }


def build_couplings(
    fields: Fields, couplings: Mapping[str, AnyCoupling], joints: Mapping[str, Joint]
) -> dict[str, Relation]:
    """The relations of a file's couplings; errors are noted in `fields`."""
    found: dict[str, Relation | None] = {}
    for name, section in couplings.items():
        path: Path = ("couplings", name)
        if isinstance(section, LinearCoupling):
            found[name] = _linear(fields, path, section, joints)
        elif not _are_joints(fields, path, section.joints, joints):
            found[name] = None
        elif isinstance(section, GearCoupling):
            found[name] = _gear(fields, path, section, joints)
        else:
            found[name] = _rack(fields, path, section, joints)
    return {name: relation for name, relation in found.items() if relation is not None}


def _linear(
    fields: Fields, path: Path, section: LinearCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    names = list(section.terms)
    known = [is_coordinate(fields, (*path, "terms", name), name, joints) for name in names]
    if not all(known):
        return None
    first = dimension_of(names[0].rpartition(".")[2])
    terms: list[Term] = []
    for name, text in section.terms.items():
        owner, _, coordinate = name.rpartition(".")
        dimension = first / dimension_of(coordinate)
        errors = fields.error_count
        factor = fields.number((*path, "terms", name), text, dimension)
        if factor == 0.0 and fields.error_count == errors:
            text = f"the factor of {name} is zero"
            fields.error("zero-factor", (*path, "terms", name), text, "leave the coordinate out")
        joint = joints[owner]
        for other in terms:
            if other.joint == joint and _freedom(other) == joint.type.freedom_of[coordinate]:
                text = f"{name} is {owner}.{other.coordinate} by the lead of its thread"
                hint = "name one of the two coordinates"
                fields.key_error("one-freedom", (*path, "terms", name), text, hint)
                return None
        terms.append(Term(joint, coordinate, factor))
    total = fields.number((*path, "sum"), section.sum, first)
    return Relation(tuple(terms), first == LENGTH, total)


def _freedom(term: Term) -> int:
    return term.joint.type.freedom_of[term.coordinate]


def _are_joints(
    fields: Fields, path: Path, names: tuple[str, ...], joints: Mapping[str, Joint]
) -> bool:
    unknown = [name for name in names if name not in joints]
    for i, name in enumerate(names):
        if name in unknown and not fields.is_refused(name):
            hint = nearest_hint(name, list(joints))
            fields.error("unknown-joint", (*path, "joints", i), f"there is no joint {name}", hint)
    return not unknown


class _Turning(NamedTuple):
    """How a wheel turns against a carrier: the terms of its angle, and its axis as drawn on the
    carrier, about which the angle counts."""

    terms: tuple[Term, ...]
    axis: Frame


def _gear(
    fields: Fields, path: Path, section: GearCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    wheels = [joints[name] for name in section.joints]
    for i, joint in enumerate(wheels):
        if not joint.type.is_bearing:
            text = f"{joint.name} is of type {joint.letter}: a wheel turns on an R or C joint"
            fields.error(
                "wheel-joint", (*path, "joints", i), text, "name the joint that it turns on"
            )
            return None
    numbers = _ratio(fields, path, section)
    pair = _on_one_carrier(wheels[0], wheels[1], joints)
    if pair is None:
        one, other = (joint.name for joint in wheels)
        fields.error(
            "no-carrier",
            (*path, "joints"),
            f"the wheels at {one} and {other} turn on no common link, nor on links that a joint "
            "about the axis of one of them joins",
            "put both wheels on one link, or join the links that they turn on by an R joint about "
            "the axis of one wheel",
        )
        return None
    first, second = pair
    tilt = norm(cross(first.axis.z, second.axis.z))
    if tilt > tolerances.PARALLEL:
        fields.error(
            "axes-not-parallel",
            (*path, "joints"),
            f"the axes of {wheels[0].name} and {wheels[1].name} are not parallel as drawn",
            "draw them parallel; other gears are couplings of type linear",
            measured=f"sine of the angle between them {tilt:.3g}",
            limit=f"{tolerances.PARALLEL:g}",
            numbers=(Number("sine of the angle", float(tilt), limit=tolerances.PARALLEL),),
        )
        return None
    if numbers is None:
        return None
    ratio = numbers[1] / numbers[0]
    same = dot(first.axis.z, second.axis.z) > 0.0
    ratio = -ratio if same == section.internal else ratio
    return Relation(
        (*first.terms, *(t._replace(factor=ratio * t.factor) for t in second.terms)), False
    )


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
            if not number > 0.0:
                text = f"the {key} of a wheel are {texts[i]}"
                hint = "give positive numbers; internal: true is for a ring with its teeth inside"
                fields.error("no-wheel", (*path, key, i), text, hint, limit="more than 0")
    return (one, other) if fields.error_count == errors else None


def _on_one_carrier(
    one: Joint, other: Joint, joints: Mapping[str, Joint]
) -> tuple[_Turning, _Turning] | None:
    """How two wheels turn against one carrier."""
    shared = {one.first, one.second} & {other.first, other.second}
    if shared:
        carrier = min(shared, key=(one.first, one.second).index)
        return _against(one, carrier), _against(other, carrier)
    for near, far, swapped in ((one, other, False), (other, one, True)):
        for base in (near.first, near.second):
            for carrier in (far.first, far.second):
                for between in joints.values():
                    if {between.first, between.second} == {base, carrier} and _on_one_axis(
                        near, between, base
                    ):
                        pair = _through(near, between, base, carrier), _against(far, carrier)
                        return (pair[1], pair[0]) if swapped else pair
    return None


def _against(joint: Joint, carrier: str) -> _Turning:
    """The wheel at a joint's other link against the carrier."""
    sign = 1.0 if joint.first == carrier else -1.0
    return _Turning((Term(joint, "theta", sign),), frame_on(joint, carrier))


def _through(wheel: Joint, between: Joint, base: str, carrier: str) -> _Turning:
    """A wheel on another link than the carrier: against that link, and with it."""
    own, with_base = _against(wheel, base), _against(between, carrier)
    # about the axis of the joint between them
    same = dot(frame_on(wheel, base).z, frame_on(between, base).z) > 0.0
    sign = 1.0 if same else -1.0
    terms = tuple(term._replace(factor=sign * term.factor) for term in own.terms)
    return _Turning((*terms, *with_base.terms), with_base.axis)


def _on_one_axis(one: Joint, other: Joint, link: str) -> bool:
    """Whether two joints of a link turn about one line of its drawing."""
    if not (one.type.is_bearing and other.type.is_bearing):
        return False
    a, b = frame_on(one, link), frame_on(other, link)
    apart = subtract(b.o, a.o)
    off = norm(cross(a.z, apart))
    near = tolerances.PARALLEL * (norm(apart) or 1.0)
    return norm(cross(a.z, b.z)) <= tolerances.PARALLEL and (off == 0.0 or off <= near)


def _rack(
    fields: Fields, path: Path, section: RackCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    pinion, rack = (joints[name] for name in section.joints)
    if not pinion.type.is_bearing or not rack.type.is_slider:
        fields.error(
            "rack-joints",
            (*path, "joints"),
            f"{pinion.name} is of type {pinion.letter} and {rack.name} of type {rack.letter}: a "
            "rack is between the R or C joint of a pinion and the P joint of a rack",
            "name the pinion's joint, then the rack's",
        )
        return None
    shared = {pinion.first, pinion.second} & {rack.first, rack.second}
    if not shared:
        text = f"the pinion at {pinion.name} and the rack at {rack.name} have no common link"
        fields.error("no-carrier", (*path, "joints"), text, "put both on one link")
        return None
    carrier = min(shared, key=(pinion.first, pinion.second).index)
    errors = fields.error_count
    radius = fields.number((*path, "radius"), section.radius, LENGTH)
    about, along = frame_on(pinion, carrier), frame_on(rack, carrier)
    pitch = along.o if section.at is None else place_at(fields, (*path, "at"), section.at)
    if fields.error_count > errors:
        return None
    if not radius > 0.0:
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
    turn = 1.0 if pinion.first == carrier else -1.0
    slide = 1.0 if rack.first == carrier else -1.0
    side = 1.0 if lever > 0.0 else -1.0
    by_rack = -(turn * slide * side) / radius
    return Relation((Term(pinion, "theta", 1.0), Term(rack, "s", by_rack)), length=False)
