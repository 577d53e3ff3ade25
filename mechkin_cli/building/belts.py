"""Belts, chains and screws to relations between coordinates, and to the forces that carry them.

A belt: r_a phi_a = r_b phi_b, phi the turns of two pulleys against their carrier about one
direction; crossed, they turn opposite ways. A chain of pitch p on wheels of z teeth is a belt on
radii z p / (2 pi), which it has on the average of a tooth.

Both strands pull at the two pulleys along the lines that touch both. With a moment M on the first
pulley their tensions differ by M / r_a: they are T + M / (2 r_a) and T - M / (2 r_a) with the
pretension T, which both have at rest and which pulls the axes towards each other by twice its part
along the line of centres. Without pretension the slack strand carries nothing.

A screw: s = -h phi, phi the turn of the screw in its bearing and s the slide of the nut along its
axis, h the lead per radian, positive for a right-hand thread. The same holds where the nut turns
and the screw slides. The thread carries a force along its axis, and the moment h times that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.wheels import Turning, against, turning_and_sliding, wheels_on_one_carrier
from mechkin_cli.mechanism import (
    Attached,
    Joint,
    Mesh,
    Relation,
    Tension,
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
from mechkin_cli.schema import BeltCoupling, ChainCoupling, ScrewCoupling
from mechkin_cli.tape import square_root
from mechkin_cli.units import DIMENSIONLESS, FORCE, LENGTH


def belt_relation(
    fields: Fields,
    path: Path,
    section: BeltCoupling | ChainCoupling,
    joints: Mapping[str, Joint],
) -> Relation | None:
    """The relation of two pulleys, or of two chain wheels; None where errors are noted."""
    radii = belt_radii(fields, path, section)
    pretension = belt_pretension(fields, path, section)
    pair = wheels_on_one_carrier(fields, path, section.joints, joints, "pulley")
    if pair is None:
        return None
    _, first, second = pair
    if radii is None or pretension is None:
        return None
    crossed = isinstance(section, BeltCoupling) and section.crossed
    distance = _distance(fields, path, pair, radii)
    if distance is None:
        return None
    slides = (*first.slides, *second.slides)
    if pretension != 0.0 and slides:
        name = slides[0].joint.name
        text = f"the pulley at {name} may slide along its axis, where pretension tilts the belt"
        fields.error("pulley-slides", (*path, "pretension"), text, f"make {name} an R joint")
        return None
    same = dot(first.axis.z, second.axis.z) > 0.0
    ratio = radii[1] / radii[0]
    ratio = ratio if same == crossed else -ratio
    terms = (*first.terms, *(t._replace(factor=ratio * t.factor) for t in second.terms))
    return _strands(
        Relation(terms, length=False), pair, radii, distance, crossed, pretension, joints
    )


def belt_radii(
    fields: Fields, path: Path, section: BeltCoupling | ChainCoupling
) -> list[float] | None:
    """Radii (m) on which the middle of a belt, or the average of a chain, runs; None where errors
    are noted."""
    errors = fields.error_count
    if isinstance(section, ChainCoupling):
        key, texts = "teeth", section.teeth
        numbers = [fields.number((*path, key, i), t, DIMENSIONLESS) for i, t in enumerate(texts)]
        pitch = fields.number((*path, "pitch"), section.pitch, LENGTH)
        if fields.error_count == errors and not pitch > tolerances.SMALLEST_DIVISOR:
            text = f"the pitch of a chain is {section.pitch}"
            fields.error("no-wheel", (*path, "pitch"), text, limit="more than 0")
        radii = [number * pitch / (2.0 * pi) for number in numbers]
    else:
        key, texts = "radii", section.radii
        numbers = [fields.number((*path, key, i), text, LENGTH) for i, text in enumerate(texts)]
        radii = numbers
    if fields.error_count == errors:
        for i, number in enumerate(numbers):
            if not number > tolerances.SMALLEST_DIVISOR:
                text = f"the {key} of a pulley are {texts[i]}"
                hint = "give positive numbers; crossed: true turns pulleys opposite ways"
                fields.error("no-wheel", (*path, key, i), text, hint, limit="more than 0")
    return radii if fields.error_count == errors else None


def belt_pretension(
    fields: Fields, path: Path, section: BeltCoupling | ChainCoupling
) -> float | None:
    """That of each strand at rest (N), 0 without one; None where errors are noted."""
    if section.pretension is None:
        return 0.0
    errors = fields.error_count
    pretension = fields.number((*path, "pretension"), section.pretension, FORCE)
    if fields.error_count > errors:
        return None
    if not pretension > 0.0:
        text = f"the pretension is {section.pretension}"
        hint = "leave it out: then the slack strand carries nothing"
        fields.error("no-pretension", (*path, "pretension"), text, hint, limit="more than 0")
        return None
    return pretension


def _distance(
    fields: Fields,
    path: Path,
    pair: tuple[str, Turning, Turning],
    radii: Sequence[float],
) -> float | None:
    """The distance of two parallel axes, which leaves room for both pulleys (m)."""
    _, first, second = pair
    tilt = norm(cross(first.axis.z, second.axis.z))
    if tilt > tolerances.PARALLEL:
        fields.error(
            "belt-oblique",
            (*path, "joints"),
            "the axes of these pulleys are not parallel as drawn",
            "draw them parallel, or write a linear coupling for the motion alone",
            measured=f"sine of the angle between them {float(tilt):.3g}",
            limit=f"{tolerances.PARALLEL:g}",
        )
        return None
    distance = norm(_across(first, second))
    if not distance > radii[0] + radii[1]:
        measured, limit = (
            fields.units.text(float(x), LENGTH) for x in (distance, radii[0] + radii[1])
        )
        fields.error(
            "pulleys-overlap",
            (*path, "joints"),
            "the pulleys lie on one another where they are drawn",
            "draw the axes further apart than the sum of the radii",
            measured=f"axes {measured} apart",
            limit=f"more than {limit}",
        )
        return None
    return distance


def _across(first: Turning, second: Turning) -> Vector:
    """From the first axis to the second, square to both, in the plane of the first one's point."""
    apart = subtract(second.axis.o, first.axis.o)
    return subtract(apart, scale(dot(apart, first.axis.z), first.axis.z))


def _strands(
    relation: Relation,
    pair: tuple[str, Turning, Turning],
    radii: Sequence[float],
    distance: float,
    crossed: bool,
    pretension: float,
    joints: Mapping[str, Joint],
) -> Relation:
    """The relation with the pull of both strands along the lines that touch both pulleys."""
    carrier, first, second = pair
    along = scale(1.0 / distance, _across(first, second))
    aside = cross(first.axis.z, along)
    # from the first axis square to a strand: its parts along and beside the line of centres
    sine = (radii[0] + radii[1] if crossed else radii[0] - radii[1]) / distance
    cosine = square_root(1.0 - sine * sine)
    half = 0.5 / radii[0]
    forces = []
    for side in (-1.0, 1.0):
        # the strand of side -1 pulls at the first pulley in its positive sense, and so away from
        # the second, which it pulls back
        square = add(scale(sine, along), scale(side * cosine, aside))
        strand = add(scale(cosine, along), scale(-side * sine, aside))
        point = add(first.axis.o, scale(radii[0], square))
        apart = -half if pretension == 0.0 else 0.0
        forces.append((point, scale(side * half, strand), scale(apart, strand)))
    mesh = Mesh(carrier, *forces[0], (*first.way, *second.back), forces[1])
    if pretension == 0.0:
        tight, slack = Tension(0.0, 2.0 * half, 0.0), Tension(0.0, 0.0, 0.0)
        return relation._replace(mesh=mesh, tensions=(("tight", tight), ("slack", slack)))
    tensions = (
        ("tight", Tension(0.0, half, pretension)),
        ("slack", Tension(0.0, -half, pretension)),
    )
    centres = first.axis.o, add(first.axis.o, scale(distance, along))
    ends = (on_wheel(w, at, joints) for w, at in zip((first, second), centres, strict=True))
    one, other = ends
    pull = one, other, 2.0 * cosine * pretension
    return relation._replace(mesh=mesh, tensions=tensions, pulls=(pull,))


def on_wheel(wheel: Turning, at: Vector, joints: Mapping[str, Joint]) -> Attached:
    """A point of a wheel's axis, drawn on the carrier, as a point of the wheel."""
    link = ""
    for name, sense in reversed(wheel.way):
        joint = joints[name]
        near, link = (joint.second, joint.first) if sense > 0 else (joint.first, joint.second)
        one, other = frame_on(joint, near), frame_on(joint, link)
        at = add(other.o, scale(dot(subtract(at, one.o), one.z), other.z))
    return Attached(link, at)


def screw_relation(
    fields: Fields, path: Path, section: ScrewCoupling, joints: Mapping[str, Joint]
) -> Relation | None:
    """The relation of a screw and its nut on two joints; None where errors are noted."""
    words = ("screw", "the part that turns", "the part that slides")
    found = turning_and_sliding(fields, path, section.joints, joints, words)
    if found is None:
        return None
    turning, sliding, carrier = found
    errors = fields.error_count
    lead = fields.number((*path, "lead"), section.lead, LENGTH)
    if fields.error_count > errors:
        return None
    if abs(lead) <= tolerances.SMALLEST_DIVISOR:
        text = "a thread has a lead"
        hint = "give the length per turn, negative for a left-hand thread"
        fields.error("no-lead", (*path, "lead"), text, hint, limit="not 0")
        return None
    about, along = frame_on(turning, carrier), frame_on(sliding, carrier)
    tilt = norm(cross(about.z, along.z))
    if tilt > tolerances.PARALLEL:
        fields.error(
            "screw-oblique",
            (*path, "joints"),
            f"{sliding.name} does not slide along the axis of {turning.name} as drawn",
            "draw both parallel, or write a linear coupling for the motion alone",
            measured=f"sine of the angle between them {float(tilt):.3g}",
            limit=f"{tolerances.PARALLEL:g}",
        )
        return None
    screw = against(turning, carrier)
    sense = 1.0 if (sliding.first == carrier) == (dot(about.z, along.z) > 0.0) else -1.0
    per_length = 2.0 * pi / lead
    slides = (
        Term(sliding, "s", sense * per_length),
        *(t._replace(factor=-per_length * t.factor) for t in screw.slides),
    )
    # the flank pushes at two opposite points, as far off the axis as the lead is per radian
    arm = scale(lead / (2.0 * pi), unit(about.x))
    push, turn = scale(0.5 * per_length, about.z), scale(0.5 * per_length, unit(about.y))
    forces = [
        (add(about.o, scale(side, arm)), add(push, scale(-side, turn)), scale(0.0, push))
        for side in (1.0, -1.0)
    ]
    way = (*screw.way, (sliding.name, 1 if sliding.first == carrier else -1))
    mesh = Mesh(carrier, *forces[0], way, forces[1])
    return Relation((*screw.terms, *slides), length=False, mesh=mesh)
