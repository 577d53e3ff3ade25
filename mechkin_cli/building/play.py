"""`backlash:` of couplings to flanks between which they have play.

Such a coupling does not keep the sum f = 0 of its terms. It measures that by one coordinate more,
the play p, along which a link without mass moves:

    r f - p = 0,    -b/2 <= p <= b/2,

b the backlash, r the pitch radius of the first wheel, 1 where b is an angle, and f such that the
first coordinate has the factor 1. Between its limits
nothing acts on that link, so that the coupling transmits nothing. At one of them a flank pushes,
what the limit gives goes on to the coupling's other coordinates as from an ordinary one, and the
limit's restitution is that of the flanks. The play is positive where the first joint is ahead.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.building.limits import read_restitution
from mechkin_cli.building.wheels import on_one_carrier
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    PLAY,
    PLAY_ANGLE,
    Joint,
    Limit,
    Mechanism,
    MotionInputs,
    Relation,
    RigidLink,
    Term,
    counted,
    dimension_of,
    dot,
    frame_about,
    is_angle,
    joint_type,
    norm,
    scale,
    subtract,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import (
    AnyCoupling,
    ChainCoupling,
    Flanks,
    GearCoupling,
    LinearCoupling,
    RackCoupling,
    ScrewCoupling,
)
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH, Dimension


def build_plays(
    fields: Fields,
    couplings: Mapping[str, AnyCoupling],
    relations: Mapping[str, Relation],
    joints: Mapping[str, Joint],
) -> tuple[dict[str, Relation], dict[str, Limit]]:
    """The relations of couplings that have play, with its term, and its limits, by the names of the
    couplings; errors are noted in `fields`."""
    plays: dict[str, Relation] = {}
    limits: dict[str, Limit] = {}
    for name, section in couplings.items():
        if not isinstance(section, Flanks) or section.backlash is None or name not in relations:
            continue
        path: Path = ("couplings", name)
        relation, errors = relations[name], fields.error_count
        _, dimension = fields.of_any_dimension((*path, "backlash"), section.backlash)
        of_first = dimension_of(relation.terms[0].coordinate)
        if fields.error_count > errors:
            continue
        wanted = _meant(section, of_first, dimension)
        backlash = fields.number((*path, "backlash"), section.backlash, wanted)
        restitution: float | None = 0.0
        if section.restitution is not None:
            restitution = read_restitution(fields, path, section.restitution)
        if fields.error_count > errors:
            continue
        if not backlash > 0.0:
            text = f"the backlash of {name} is {section.backlash}"
            hint = "leave it out: then the flanks have no play"
            fields.error("no-backlash", (*path, "backlash"), text, hint, limit="more than 0")
            continue
        if isinstance(section, ChainCoupling) and section.pretension is not None:
            text = "a chain with pretension is tight on both sides: it has no play"
            hint = "leave out pretension, or backlash"
            fields.error("tight-chain", (*path, "backlash"), text, hint)
            continue
        radius = 1.0
        if wanted == LENGTH and of_first == ANGLE:
            radius = _radius(fields, path, section, relation, joints)
            if fields.error_count > errors:
                continue
        kind = PLAY if wanted == LENGTH else PLAY_ANGLE
        term = Term(_play(name, kind, fields.plane), kind, -relation.terms[0].factor / radius)
        plays[name] = relation._replace(terms=(*relation.terms, term))
        place = fields.document.place((*path, "backlash"))
        limits[name] = Limit(name, kind, -0.5 * backlash, 0.5 * backlash, place, restitution)
    return plays, limits


def with_plays(mechanism: Mechanism, plays: Mapping[str, Relation]) -> Mechanism:
    """The mechanism in which some couplings have play."""
    if not plays:
        return mechanism
    joints = {name: relation.terms[-1].joint for name, relation in plays.items()}
    links = {joint.second: RigidLink(joint.second) for joint in joints.values()}
    return replace(
        mechanism,
        links={**mechanism.links, **links},
        joints={**mechanism.joints, **joints},
        couplings={**mechanism.couplings, **plays},
    )


def loose_in_sweep(plays: Mapping[str, Relation], motion: MotionInputs) -> dict[str, Relation]:
    """Couplings that have their play in a sweep, too: whose play is an input, or all of whose other
    coordinates are. Others stand in the middle of it. Without a sweep all have their play."""
    if not motion.inputs:
        return dict(plays)
    driven = set(motion.driven)
    found = {}
    for name, relation in plays.items():
        *own, play = [(term.joint.name, term.coordinate) for term in relation.terms]
        if play in driven or driven.issuperset(own):
            found[name] = relation
    return found


def note_tight(
    fields: Fields, plays: Mapping[str, Relation], loose: Mapping[str, Relation]
) -> None:
    """Notes that couplings with play stand in the middle of it in a sweep, but for those that are
    `loose` there."""
    for name in plays:
        if name in loose:
            continue
        play = f"{name}.{plays[name].terms[-1].coordinate}"
        text = f"in the sweep the flanks of {name} stand in the middle of their play, as drawn"
        place = fields.document.place(("couplings", name, "backlash"))
        hint = f"to have them on one flank make {play} an input"
        fields.note(Diagnostic("mid-play", "note", text, place, hint=hint))


def _meant(section: Flanks, of_first: Dimension, written: Dimension) -> Dimension:
    """What a backlash is: an angle or a length, as it is written; a number alone a length, of a sum
    of coordinates what the first of them is."""
    if isinstance(section, LinearCoupling):
        return of_first
    return ANGLE if written == ANGLE else LENGTH


def _radius(
    fields: Fields,
    path: Path,
    section: Flanks,
    relation: Relation,
    joints: Mapping[str, Joint],
) -> float:
    """The length (m) along which flanks move per radian of the first joint."""
    if isinstance(section, RackCoupling):
        return fields.number((*path, "radius"), section.radius, LENGTH)
    if isinstance(section, ScrewCoupling):
        lead = fields.number((*path, "lead"), section.lead, LENGTH)
        return abs(lead) / (2.0 * pi)
    if isinstance(section, ChainCoupling):
        teeth = fields.number((*path, "teeth", 0), section.teeth[0], DIMENSIONLESS)
        return teeth * fields.number((*path, "pitch"), section.pitch, LENGTH) / (2.0 * pi)
    assert isinstance(section, GearCoupling)
    if section.radii is not None:
        return fields.number((*path, "radii", 0), section.radii[0], LENGTH)
    one, other = (joints[name] for name in section.joints)
    pair = on_one_carrier(one, other, joints)
    if relation.mesh is None or pair is None:
        text = "the pitch radii of these wheels are not told, so that a backlash is an angle"
        hint = "write the angle of the first wheel: backlash: 0.1 deg; or give radii"
        fields.error("no-radii", (*path, "backlash"), text, hint)
        return 1.0
    axis = pair[1].axis
    arm = subtract(relation.mesh.point, axis.o)
    return norm(subtract(arm, scale(dot(arm, axis.z), axis.z)))


def _play(name: str, kind: str, plane: bool) -> Joint:
    """The joint of a coupling's play; where it is drawn does not matter."""
    entry = joint_type(kind, plane)
    along = GROUND.z if is_angle(kind) else GROUND.x
    frame = frame_about(along, GROUND.y, GROUND.o)
    parts = parts_of(entry, Halves(frame, frame, (frame, frame)))
    link = f"{name}.{kind}"
    return counted(Joint(name, kind, GROUND_NAME, link, frame, frame, parts, plane=plane))
