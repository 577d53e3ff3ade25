"""`efficiency:` and `friction:` of couplings to what rubs in them.

An efficiency eta is the share of the power put in that comes out, whichever side drives. With the
moments M_1 and M_2 that a coupling has for a wheel, seen from either side of the loss, the loss is
a moment k (|M_1| + |M_2|) against the wheel's turn, k = (1 - eta)/(1 + eta): then the smaller power
is eta times the larger one. That is dry friction of the coefficient 2 k, whose normal load is the
mean of both moments.

Teeth of wheels whose axes pass each other slide along their flanks at the pitch point, of a worm
nearly as fast as it turns. The force square to the flanks, the root of the squares of its parts in
the pitch plane and square to that, presses them on each other; friction acts along the flank, on
the second wheel and opposite on the first (Shigley, Mechanical Engineering Design, force analysis
of worm gearing).
"""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.wheels import Turning, against, on_one_carrier
from mechkin_cli.mechanism import (
    Joint,
    Loss,
    Relation,
    Rubbing,
    cross,
    dot,
    norm,
    subtract,
    unit,
)
from mechkin_cli.schema import (
    BeltCoupling,
    ChainCoupling,
    GearCoupling,
    RackCoupling,
    ScrewCoupling,
)
from mechkin_cli.tape import plain, square_root
from mechkin_cli.units import DIMENSIONLESS

Lossy = GearCoupling | RackCoupling | BeltCoupling | ChainCoupling | ScrewCoupling


def with_losses(
    fields: Fields, path: Path, section: Lossy, joints: Mapping[str, Joint], relation: Relation
) -> Relation:
    """The relation with what rubs in it; errors are noted in `fields`."""
    rubs = isinstance(section, GearCoupling) and section.friction is not None
    if section.efficiency is None and not rubs:
        return relation
    one, other = (joints[name] for name in section.joints)
    if isinstance(section, RackCoupling | ScrewCoupling):
        shared = {one.first, one.second} & {other.first, other.second}
        carrier = min(shared, key=(one.first, one.second).index)
        wheels: tuple[Turning, ...] = (against(one, carrier),)
    else:
        pair = on_one_carrier(one, other, joints)
        assert pair is not None  # else the coupling is no relation
        carrier, *turnings = pair
        wheels = tuple(turnings)
    if isinstance(section, GearCoupling) and section.friction is not None:
        at = (*path, "friction")
        coefficient = _friction(fields, at, section.friction)
        loss = _along_flanks(fields, at, relation, wheels, joints)
    else:
        assert section.efficiency is not None
        at = (*path, "efficiency")
        share = _share(fields, at, section.efficiency)
        coefficient = None if share is None else 2.0 * (1.0 - share) / (1.0 + share)
        loss = _about_axis(carrier, relation, wheels, joints)
    if loss is None or coefficient is None:
        return relation
    place = fields.document.place(at)
    name = str(path[-1])
    return relation._replace(loss=Rubbing(name, coefficient, coefficient, place=place, loss=loss))


def _share(fields: Fields, path: Path, text: str) -> float | None:
    """An efficiency: more than 0, at most 1; None where an error is noted.

    As it goes to 0, the moment that moves a load grows beyond all bounds: with 0 such a row has no
    forces.
    """
    share = _number(fields, path, text)
    if share is None or 0.0 < share <= 1.0:
        return share
    name = path[-2]
    told = f"efficiency of {name} is {text}: more power would come out than is put in"
    hint = "write the share that comes out: 0.98 for 98 %"
    if share <= 0.0:
        told = f"efficiency of {name} is {text}: nothing would come out, whatever is put in"
        hint = (
            "write the share that comes out, as 0.98 of one pair of spur wheels; a worm that its "
            "wheel does not drive has friction: 0.2 instead, and what transmits nothing is no "
            "coupling"
        )
    fields.error("no-loss", path, told, hint, limit="more than 0, at most 1")
    return None


def _friction(fields: Fields, path: Path, text: str) -> float | None:
    """A coefficient of friction, at least 0; None where an error is noted."""
    coefficient = _number(fields, path, text)
    if coefficient is None or coefficient >= 0.0:
        return coefficient
    told = f"friction of {path[-2]} is {text}"
    hint = "write the coefficient: 0.05 to 0.1 is usual with oil"
    fields.error("no-loss", path, told, hint, limit="at least 0")
    return None


def _number(fields: Fields, path: Path, text: str) -> float | None:
    errors = fields.error_count
    number = fields.number(path, text, DIMENSIONLESS)
    return number if fields.error_count == errors else None


def _about_axis(
    carrier: str, relation: Relation, wheels: tuple[Turning, ...], joints: Mapping[str, Joint]
) -> Loss:
    """A loss of moment: what rubs against the turn of a wheel that turns on the carrier itself."""
    wheel = next(each for each in wheels if len(each.terms) == 1)
    place = carrier, carrier, _link(wheel, joints), wheel.axis.o, wheel.axis.z
    at_first = 1.0 if wheel is wheels[0] else 0.0
    return Loss(*place, True, _moment_of(relation, wheel), _turns_of(wheels[0]), at_first)


def _moment_of(relation: Relation, wheel: Turning) -> float:
    """The moment on a wheel, about its axis, by a unit of the relation's multiplier."""
    own = wheel.terms[0]
    return next(
        term.factor * own.factor
        for term in relation.terms
        if term.joint == own.joint and term.coordinate == own.coordinate
    )


def _turns_of(wheel: Turning) -> tuple[tuple[str, int], ...]:
    """The coordinates of a wheel's turn, and whether they count as the first of them does (1) or
    backwards (-1)."""
    is_forward = wheel.terms[0].factor > 0.0
    return tuple(
        (f"{term.joint.name}.{term.coordinate}", 1 if (term.factor > 0.0) == is_forward else -1)
        for term in wheel.terms
    )


def _along_flanks(
    fields: Fields,
    path: Path,
    relation: Relation,
    wheels: tuple[Turning, ...],
    joints: Mapping[str, Joint],
) -> Loss | None:
    """What rubs along the flanks of crossed helical wheels; None where an error is noted."""
    one, other = (wheel.axis for wheel in wheels)
    normal = cross(one.z, other.z)
    apart = subtract(other.o, one.o)
    meet = abs(dot(normal, apart)) <= tolerances.PARALLEL * norm(apart) * norm(normal)
    mesh = relation.mesh
    if mesh is None or norm(normal) <= tolerances.PARALLEL or meet:
        text = "only teeth of wheels whose axes pass each other slide at their pitch point"
        hint = "write efficiency: 0.98 for the losses of other wheels"
        if mesh is None:
            text, hint = "an ideal coupling has no teeth that slide", "leave out ideal"
        fields.error("no-sliding", path, text, hint)
        return None
    flank = unit(cross(normal, mesh.along))
    press = square_root(dot(mesh.along, mesh.along) + dot(mesh.apart, mesh.apart))
    place = mesh.carrier, *mesh.ends(joints), mesh.point, flank
    # how fast the pitch point of each moves along the flank when the first turns by a unit
    speeds = [dot(cross(axis.z, subtract(mesh.point, axis.o)), flank) for axis in (one, other)]
    speeds[1] = -speeds[1] / _moment_of(relation, wheels[1])
    at_first = plain(speeds[0] / (speeds[0] - speeds[1]))
    return Loss(*place, False, press, _turns_of(wheels[0]), at_first)


def _link(wheel: Turning, joints: Mapping[str, Joint]) -> str:
    """The link that turns."""
    name, sense = wheel.way[0]
    return joints[name].first if sense > 0 else joints[name].second
