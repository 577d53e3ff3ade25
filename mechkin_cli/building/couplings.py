"""`couplings:` to relations between coordinates, each a sum of terms that is constant.

What wheels and teeth come to is in `wheels.py`, belts, chains and screws in `belts.py`,
cables in `cables.py`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mechkin_cli.building.belts import belt_relation, screw_relation
from mechkin_cli.building.fields import Fields, Path, is_coordinate
from mechkin_cli.building.wheels import gear_relation, rack_relation
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.mechanism import Joint, Relation, Term, dimension_of
from mechkin_cli.schema import (
    AnyCoupling,
    CableCoupling,
    FrictionAtJoint,
    GearCoupling,
    LinearCoupling,
    RackCoupling,
    ScrewCoupling,
)
from mechkin_cli.units import LENGTH


def coupled_joints(couplings: Mapping[str, AnyCoupling]) -> set[str]:
    """Names of the joints that couplings name."""
    return {
        name
        for section in couplings.values()
        for name in (
            [term.rpartition(".")[0] for term in section.terms]
            if isinstance(section, LinearCoupling)
            else ()
            if isinstance(section, CableCoupling)
            else section.joints
        )
    }


def build_couplings(
    fields: Fields,
    couplings: Mapping[str, AnyCoupling],
    joints: Mapping[str, Joint],
    cables: Mapping[str, Relation],
) -> dict[str, Relation]:
    """The relations of a file's couplings, `cables` among them; errors are noted in `fields`."""
    found: dict[str, Relation | None] = {}
    drawn = not fields.error_count  # else axes may be none
    for name, section in couplings.items():
        path: Path = ("couplings", name)
        if isinstance(section, LinearCoupling):
            found[name] = _linear(fields, path, section, joints)
        elif isinstance(section, CableCoupling):
            found[name] = cables.get(name)
        elif not _are_joints(fields, path, section.joints, joints) or not drawn:
            found[name] = None
        elif isinstance(section, GearCoupling):
            found[name] = gear_relation(fields, path, section, joints)
        elif isinstance(section, RackCoupling):
            found[name] = rack_relation(fields, path, section, joints)
        elif isinstance(section, ScrewCoupling):
            found[name] = screw_relation(fields, path, section, joints)
        else:
            found[name] = belt_relation(fields, path, section, joints)
    return {name: relation for name, relation in found.items() if relation is not None}


def refuse_friction(
    fields: Fields, loads: Iterable[object], couplings: Mapping[str, Relation]
) -> None:
    """Notes teeth that push wheels apart, and belts without pretension, where joints rub: friction
    is solved for by reactions that are linear in it."""
    if not any(isinstance(load, FrictionAtJoint) and load.law != "viscous" for load in loads):
        return
    for name, relation in couplings.items():
        if relation.pushes_apart and relation.tensions:
            text = "with friction in joints a strand that goes slack is not computed"
            hint = "give the pretension, or leave out the friction"
            fields.error("rubbing", ("couplings", name), text, hint)
        elif relation.pushes_apart:
            text = "with friction in joints the force that pushes wheels apart is not computed"
            hint = "leave out pressure_angle, or the friction"
            fields.error("rubbing", ("couplings", name, "pressure_angle"), text, hint)


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
