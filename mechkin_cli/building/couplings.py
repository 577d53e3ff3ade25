"""`couplings:` to relations between coordinates, each a sum of terms that is constant; a term is a
coordinate or a function of it.

What wheels and teeth come to is in `wheels.py`, belts, chains and screws in `belts.py`, those over
more than two pulleys in `serpentine.py`, cables in `cables.py`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi

import numpy as np

from mechkin_cli.building.belts import belt_relation, screw_relation
from mechkin_cli.building.fields import Fields, Path, is_coordinate
from mechkin_cli.building.law_reading import Over, note_bends, read_law
from mechkin_cli.building.law_shapes import LawOfCoordinate, PiecewiseLaw
from mechkin_cli.building.load_laws import join, joining_of, note_overshoot, read_rows
from mechkin_cli.building.losses import Lossy, with_losses
from mechkin_cli.building.serpentine import serpentine_relations
from mechkin_cli.building.wheels import gear_relation, on_one_carrier, rack_relation
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions import ExpressionError, Quantity, Resolve, scalar
from mechkin_cli.mechanism import (
    CoordinateLaw,
    ExpressionOf,
    Follower,
    Joint,
    Problem,
    Relation,
    Term,
    dimension_of,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import (
    AnyCoupling,
    CableCoupling,
    ExpressionLaw,
    FollowerSection,
    FrictionAtJoint,
    FunctionCoupling,
    GearCoupling,
    JoinedTable,
    LinearCoupling,
    RackCoupling,
    ScrewCoupling,
    TableCoupling,
    TableLaw,
)
from mechkin_cli.tape import is_traced, plain
from mechkin_cli.tolerances import TABLE_END
from mechkin_cli.units import ANGLE, LENGTH, Dimension


def coupled_joints(
    fields: Fields, couplings: Mapping[str, AnyCoupling], joints: Mapping[str, Joint]
) -> set[str]:
    """Names of the joints that couplings have coordinates of: those that they name, and those that
    join the link on which a wheel turns to its carrier."""
    named = {name for section in couplings.values() for name in _joints_of(section)}
    found = named & joints.keys()
    if fields.error_count:  # axes may be none
        return found
    for section in couplings.values():
        wheels = [joints[name] for name in _joints_of(section) if name in joints]
        if len(wheels) != 2 or not all(wheel.type.is_bearing for wheel in wheels):
            continue
        pair = on_one_carrier(wheels[0], wheels[1], joints)
        if pair is not None:
            found |= {name for turning in pair[1:] for name, _ in turning.way}
    return found


def _joints_of(section: AnyCoupling) -> Iterable[str]:
    if isinstance(section, LinearCoupling):
        return [term.rpartition(".")[0] for term in section.terms]
    if isinstance(section, FunctionCoupling | TableCoupling):
        return [name.rpartition(".")[0] for name in (_leading(section), section.gives)]
    if isinstance(section, CableCoupling):
        return [place.drum for place in section.path if place.drum is not None]
    return section.joints


def _leading(section: FunctionCoupling | TableCoupling) -> str:
    return section.of if isinstance(section, FunctionCoupling) else section.over


def build_couplings(
    fields: Fields,
    couplings: Mapping[str, AnyCoupling],
    joints: Mapping[str, Joint],
    cables: Mapping[str, Relation],
) -> dict[str, Relation]:
    """The relations of a file's couplings, by name, with the losses of those that have some.

    Args:
        fields: where errors are noted; a coupling with one is left out.
        couplings: the file's sections.
        joints: those of the file, of which the coupled ones count their turns (`coupled_joints`).
        cables: the relations of cables, which have links and joints of their own.
    """
    found: dict[str, Relation | None] = {}
    drawn = not fields.error_count  # else axes may be none
    for name, section in couplings.items():
        path: Path = ("couplings", name)
        if isinstance(section, LinearCoupling):
            found[name] = _linear(fields, path, section, joints)
        elif isinstance(section, FunctionCoupling | TableCoupling):
            found[name] = _followed(fields, path, section, joints)
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
        elif len(section.joints) > 2:
            found |= serpentine_relations(fields, path, section, joints)
            continue
        else:
            found[name] = belt_relation(fields, path, section, joints)
        relation = found[name]
        if relation is not None and isinstance(section, Lossy):
            found[name] = with_losses(fields, path, section, joints, relation)
    return {name: relation for name, relation in found.items() if relation is not None}


def refuse_tied_friction(fields: Fields, loads: Sequence[object], problem: Problem) -> None:
    """Notes friction at inputs that are tied (`{with: ..., drive: tie}`): it depends on what
    transmits the tie, which no file says."""
    for i, load in enumerate(loads):
        if isinstance(load, FrictionAtJoint) and load.joint in problem.tied:
            tie, cure = problem.tied[load.joint]
            text = f"{tie}, and how that loads {load.joint} is not said"
            fields.error("rubbing", ("loads", i), text, f"{cure}, or leave out the friction")


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


def _followed(
    fields: Fields,
    path: Path,
    section: FunctionCoupling | TableCoupling,
    joints: Mapping[str, Joint],
) -> Relation | None:
    """The coordinate that follows, less the function of the one that leads."""
    leading, key = _leading(section), "of" if isinstance(section, FunctionCoupling) else "over"
    places = {(*path, key): leading, (*path, "gives"): section.gives}
    if not all(
        is_coordinate(fields, at, name, joints, at_key=False) for at, name in places.items()
    ):
        return None
    ends = [(joints[name.rpartition(".")[0]], name.rpartition(".")[2]) for name in places.values()]
    (first, coordinate), (second, follows) = ends
    if first == second and first.type.freedom_of[coordinate] == first.type.freedom_of[follows]:
        text = f"{leading} and {section.gives} are one freedom"
        hint = "name a coordinate of another joint"
        fields.error("one-freedom", (*path, "gives"), text, hint)
        return None
    dimensions = dimension_of(coordinate), dimension_of(follows)
    law = _law(fields, path, section, dimensions)
    if law is None:
        return None
    terms = (Term(second, follows, 1.0), Term(first, coordinate, -1.0, law))
    follower = None
    if section.follower is not None:
        follower = _follower(fields, (*path, "follower"), section.follower, dimensions)
    return Relation(terms, dimensions[1] == LENGTH, follower=follower)


def _follower(
    fields: Fields, path: Path, section: FollowerSection, dimensions: tuple[Dimension, Dimension]
) -> Follower | None:
    """The follower of a cam; None where errors are noted."""
    errors = fields.error_count
    swings = section.type == "oscillating"
    for is_right, text, hint in (
        (dimensions[0] == ANGLE, "a cam turns, this one slides", "leave out follower"),
        (
            (dimensions[1] == ANGLE) == swings,
            f"a {section.type} follower has {'an angle' if swings else 'a length'} as coordinate",
            f"write type: {'translating' if swings else 'oscillating'}",
        ),
    ):
        if not is_right:
            fields.error("follower", path, text, hint)
            return None
    base, offset = (
        fields.number((*path, key), text, LENGTH)
        for key, text in (("base_radius", section.base_radius), ("offset", section.offset))
    )
    radius, arm, distance = (
        0.0 if text is None else fields.number((*path, key), text, LENGTH)
        for key, text in (
            ("radius", section.radius),
            ("arm", section.arm),
            ("distance", section.distance),
        )
    )
    if fields.error_count > errors:
        return None
    for key, value in (("base_radius", base), ("radius", radius), ("arm", arm)):
        if getattr(section, key) is not None and not value > 0.0:
            text, hint = f"{key} is positive", f"write a positive {key}"
            measured = fields.units.text(value, LENGTH)
            fields.error("follower", (*path, key), text, hint, measured=measured)
            return None
    if not _reaches(section, base + radius, offset, arm, distance):
        text = "the follower does not reach the base circle"
        hint = "change offset" if not swings else "change arm or distance"
        fields.error("follower", path, text, hint)
        return None
    return Follower(swings, section.contact, base, radius, offset, arm, distance)


def _reaches(
    section: FollowerSection, prime: float, offset: float, arm: float, distance: float
) -> bool:
    """Whether the follower can touch the base circle, with the centre of its roller or its edge on
    a circle of radius `prime`."""
    if section.type == "translating":
        return section.contact == "flat" or abs(offset) < prime
    if section.contact == "flat":
        return abs(prime + offset) < distance
    return abs(distance - arm) < prime < distance + arm


def _law(
    fields: Fields,
    path: Path,
    section: FunctionCoupling | TableCoupling,
    dimensions: tuple[Dimension, Dimension],
) -> CoordinateLaw | None:
    """How the second coordinate follows the first, of these dimensions; None where errors are
    noted."""
    if isinstance(section, TableCoupling):
        return _by_table(fields, (*path, "table"), section.table, section, dimensions)
    if section.value is not None:
        return _by_expression(fields, (*path, "value"), section.of, section.value, dimensions)
    assert section.law is not None
    path = (*path, "law")
    if isinstance(section.law, TableLaw):
        return _by_table(fields, (*path, "file"), section.law.file, section.law, dimensions)
    if isinstance(section.law, ExpressionLaw):
        text = section.law.value
        return _by_expression(fields, (*path, "value"), section.of, text, dimensions)
    errors = fields.error_count
    over = Over(dimensions[0], 0.0, in_si=True)
    law = read_law(fields, path, section.law, dimensions[1], over)
    if fields.error_count > errors:
        return None
    assert isinstance(law, PiecewiseLaw)  # no expression
    if not law.is_recorded:  # else noted when the file was read
        note_bends(fields, path, section.law, dimensions[1], over)
    return CoordinateLaw(LawOfCoordinate(law.pieces, law.period))


def _by_expression(
    fields: Fields, path: Path, argument: str, text: str, dimensions: tuple[Dimension, Dimension]
) -> CoordinateLaw | None:
    try:
        expression = fields.definitions.parse(text)
        of = ExpressionOf(expression, argument, dimensions[0], fields.parameters)
        sample = _sampled(of.resolve(np.ones(1)))
        scalar(expression.in_doubles, dimensions[1], fields.units, sample)
        if not expression.names - fields.parameters.keys():
            hint = f"write an expression of {argument}"
            raise ExpressionError("this value never changes", 0, hint)
    except ExpressionError as error:
        fields.expression_error(path, error)
        return None
    return CoordinateLaw(of)


def _sampled(resolve: Resolve) -> Resolve:
    """As `resolve`, with a number in the place of one that is only recorded."""

    def quantity(name: str) -> Quantity:
        found = resolve(name)
        return replace(found, value=np.ones(1)) if is_traced(found.value) else found

    return quantity


def _by_table(
    fields: Fields,
    path: Path,
    file: str,
    joined: JoinedTable,
    dimensions: tuple[Dimension, Dimension],
) -> CoordinateLaw | None:
    rows = read_rows(fields, path, file, *dimensions)
    if rows is None:
        return None
    x, y = (
        [plain(fields.units.to_si(value, dimension)) for value in column]
        for column, dimension in zip(rows, dimensions, strict=True)
    )
    span = x[-1] - x[0]
    turns = dimensions[0] == ANGLE and abs(span - 2.0 * pi) <= TABLE_END * span
    repeats = turns and rows[1][0] == rows[1][-1]
    interpolation, ends = joining_of(joined)
    if repeats and joined.ends is None:
        ends = "periodic"
    curve = join(fields, path, x, y, interpolation, ends)
    if curve is None:
        return None
    note_overshoot(fields, path, curve, dimensions)
    return CoordinateLaw(curve=curve, period=span if repeats else 0.0)


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
