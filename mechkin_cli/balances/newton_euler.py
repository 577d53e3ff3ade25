"""The dense system of reactions: unknowns and conditions of each pair, coefficients and right side,
its solution, and two tables of it.

Pairs, as the dissertation on successive screws writes them (sections 3.4 to 3.14): a pair on one
axis A has a force F and a moment M about the origin with F.A = 0 and (M - O x F).A = 0; what it can
take along the axis, FA, or about it, MA, stands apart; a screw takes FA with MA = -p FA. A ball has
three forces through its centre. Any other pair has six components, and a condition for each of its
freedoms.

System: rows are force and moment of every moving link, then the pairs' conditions; columns all
components of all reactions, then the efforts and what couplings transmit, by their teeth if they
have any: the part that pushes wheels apart goes with the magnitude of the rest, by its sign at the
row. Rows by columns times unknowns equal the right side:
what pairs and drives exert on a link is the opposite of loads, gravity and inertia.

Tables: numbers are in the file's units, so that an unknown in its unit times a coefficient has the
unit of its equation; moments are about the ground origin. The system's own solution stands beside
the unknowns where it is square: the reactions of the other tables by another method.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.balances.dense import (
    RowMotion,
    Wrench,
    borne_wrenches,
    coordinate_wrench,
    force_at,
    row_motion,
)
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.mechanism import (
    GROUND_NAME,
    ZERO,
    Attached,
    Joint,
    Mesh,
    Relation,
    Vector,
    add,
    cross,
    eliminated,
    scale,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import CoefficientsLayout, Columns, TableColumn, words_of
from mechkin_cli.tolerances import DENSE_PIVOT, DENSE_ROUNDING
from mechkin_cli.units import DIMENSIONLESS, FORCE, LENGTH, MOMENT, Dimension, UnitSystem

if TYPE_CHECKING:
    from mechkin_cli.sweep import Result

UNIT_AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_XYZ = "xyz"


class PairTerm(NamedTuple):
    """An unknown or a condition of a joint.

    Of an unknown `wrench` is what it exerts on the second link per unit, in SI, and on the first
    its opposite, and `rank` orders the unknowns as the source does: forces, moments, what stands
    apart, efforts. What acts on other links has its wrenches by them in `others`. Of a condition
    `wrench` has the factors of F and M in the sum that vanishes.
    """

    name: str
    joint: str
    dimension: Dimension
    wrench: Wrench
    rank: int = 0
    others: tuple[tuple[str, Wrench], ...] = ()

    @property
    def group(self) -> str:
        """Name of an unknown without its axis: O1.F of O1.Fx, O3.F of O3.F B."""
        return self.name if self.rank in (2, 4) else self.name[: len(self.joint) + 2]

    def reversed(self) -> PairTerm:
        """The unknown that counts the other way."""
        return self._replace(
            name=f"{self.name} reversed",
            wrench=self.wrench.times(-1.0),
            others=tuple((link, wrench.times(-1.0)) for link, wrench in self.others),
        )

    def on(self, link: str, ends: tuple[str, str]) -> Wrench:
        """What it exerts on a link per unit; `ends` are its joint's."""
        found = self.wrench.times(float(ends[1] == link) - float(ends[0] == link))
        for name, wrench in self.others:
            found = found.plus(wrench) if name == link else found
        return found

    def coefficient(self, unknown: PairTerm) -> float:
        """The factor of an unknown in this condition."""
        factors, wrench = self.wrench, unknown.wrench
        parts = zip((*factors.force, *factors.moment), (*wrench.force, *wrench.moment), strict=True)
        total = 0.0
        for factor, component in parts:
            total += factor * component
        return total


PairTerms = tuple[list[PairTerm], list[PairTerm]]
"""The unknowns and the conditions of one pair."""

Along = tuple[tuple[str, Attached], tuple[str, Attached]]
"""Two named directions of the forces of a ball; the third is their cross product."""


def pair_terms(joint: Joint, motion: RowMotion, along: Mapping[str, Along]) -> PairTerms:
    """Unknowns and conditions of a pair; `along` by the names of balls."""
    if joint.type.is_free:
        return [], []
    if joint.type.is_guide:
        return _guide(joint, motion)
    slides = [
        _no_force(joint, motion.direction(at), f"along slide{number}")
        for number, at in _numbered(joint.free_slides)
    ]
    if joint.type.is_oriented:
        return _ball(joint, motion, along.get(joint.name)), slides
    turns = [
        _no_moment(joint, motion, motion.direction(at), f"about turn{number}")
        for number, at in _numbered(joint.free_turns or ())
    ]
    return _components(joint), [*slides, *turns]


def effort(joint: Joint, coordinate: str, motion: RowMotion, word: str) -> PairTerm:
    """What the drive of a coordinate exerts; `word` names it."""
    known = joint.type.coordinate[coordinate]
    dimension = MOMENT if known.is_angle else FORCE
    wrench = coordinate_wrench(joint, coordinate, motion)
    return PairTerm(f"{joint.name}.{coordinate}.{word}", joint.name, dimension, wrench, 4)


def transmitted(
    name: str, relation: Relation, joints: Mapping[str, Joint], motion: RowMotion, sign: float
) -> PairTerm:
    """What a coupling transmits, a moment or a force at its first coordinate; `sign` is that of it
    at the row."""
    first = relation.terms[0]
    word, dimension = ("force", FORCE) if relation.length else ("torque", MOMENT)
    others: list[tuple[str, Wrench]] = []
    for term in relation.along_coordinates:
        joint = joints[term.joint.name]
        unit = coordinate_wrench(joint, term.coordinate, motion)
        wrench = unit.times(term.factor / first.factor)
        others += [(joint.second, wrench), (joint.first, wrench.times(-1.0))]
    if relation.mesh is not None:
        mesh = relation.mesh
        one, other = (_reached(mesh, joints, last) for last in (False, True))
        carrier = motion[mesh.carrier].frame
        push = add(mesh.along, scale(sign, mesh.apart))
        force = force_at(
            motion.point(Attached(mesh.carrier, mesh.point)), carrier.vector(push)
        ).times(1.0 / first.factor)
        others += [(other, force), (one, force.times(-1.0))]
    return PairTerm(f"{name}.{word}", name, dimension, Wrench(), 4, tuple(others))


def _reached(mesh: Mesh, joints: Mapping[str, Joint], last: bool) -> str:
    """The link of a mesh's first wheel, or of its second."""
    name, sense = mesh.way[-1 if last else 0]
    joint = joints[name]
    return joint.second if (sense > 0) is last else joint.first


def _guide(joint: Joint, motion: RowMotion) -> PairTerms:
    axis, point = motion.direction(joint.axis), motion.point(joint.point)
    conditions = [
        _no_force(joint, axis, "along the axis"),
        _no_moment(joint, motion, axis, "about the axis"),
    ]
    free = joint.type.free
    apart = []
    if joint.type.is_threaded:
        thread = force_at(point, axis).plus(Wrench(ZERO, scale(-joint.pitch, axis)))
        apart.append(PairTerm(f"{joint.name}.FA", joint.name, FORCE, thread, 2))
    else:
        if not free["slide"]:
            force = force_at(point, axis)
            apart.append(PairTerm(f"{joint.name}.FA", joint.name, FORCE, force, 2))
        if not free["turn"]:
            apart.append(PairTerm(f"{joint.name}.MA", joint.name, MOMENT, Wrench(ZERO, axis), 2))
    return [*_components(joint), *apart], conditions


def _ball(joint: Joint, motion: RowMotion, along: Along | None) -> list[PairTerm]:
    point = motion.point(joint.point)
    directions: Sequence[Vector] = UNIT_AXES
    names: Sequence[str] = _XYZ
    if along is not None:
        one, two = (motion.direction(at) for _, at in along)
        directions = (one, two, cross(one, two))
        first, second = (name for name, _ in along)
        names = (f" {first}", f" {second}", f" {first} x {second}")
    return [
        PairTerm(f"{joint.name}.F{name}", joint.name, FORCE, force_at(point, direction), 3)
        for name, direction in zip(names, directions, strict=True)
    ]


def _components(joint: Joint) -> list[PairTerm]:
    name, named = joint.name, list(zip(_XYZ, UNIT_AXES, strict=True))
    forces = [PairTerm(f"{name}.F{xyz}", name, FORCE, Wrench(axis, ZERO), 0) for xyz, axis in named]
    moments = [
        PairTerm(f"{name}.M{xyz}", name, MOMENT, Wrench(ZERO, axis), 1) for xyz, axis in named
    ]
    return [*forces, *moments]


def _numbered(free: Sequence[Attached]) -> Iterator[tuple[str, Attached]]:
    """Directions with a number where there are several."""
    for number, at in enumerate(free, start=1):
        yield (f" {number}" if len(free) > 1 else ""), at


def _no_force(joint: Joint, axis: Vector, where: str) -> PairTerm:
    name = f"{joint.name}: no force in F {where}"
    return PairTerm(name, joint.name, FORCE, Wrench(axis, ZERO))


def _no_moment(joint: Joint, motion: RowMotion, axis: Vector, where: str) -> PairTerm:
    name = f"{joint.name}: no moment in M {where}"
    arm = scale(-1.0, cross(axis, motion.point(joint.point)))
    return PairTerm(name, joint.name, MOMENT, Wrench(arm, axis))


Matrix = list[list[float]]


class DenseSystem(NamedTuple):
    """`coefficients` (equations, unknowns) and `right` (equations,), in SI; `equations` by name and
    dimension."""

    equations: tuple[tuple[str, Dimension], ...]
    unknowns: tuple[PairTerm, ...]
    coefficients: Matrix
    right: list[float]


def dense_system(
    result: Result, row: int, along: Mapping[str, Along] = MappingProxyType({})
) -> DenseSystem:
    """The system at a row (counted from 0) that has a position; `along` as in `pair_terms`."""
    mechanism, motion = result.problem.mechanism, row_motion(result, row)
    pairs = [pair_terms(joint, motion, along) for joint in mechanism.joints.values()]
    drives = mechanism.drives
    # a motor that carries what another input needs gives another effort than acts at its own
    # coordinate
    word = "drive" if drives is not None and drives.constraints else "effort"
    inputs = [effort(mechanism.joints[j], c, motion, word) for j, c in result.problem.acting]
    related = [
        transmitted(name, relation, mechanism.joints, motion, _sign(result, name, relation, row))
        for name, relation in mechanism.couplings.items()
    ]
    terms = [*(unknown for of_pair, _ in pairs for unknown in of_pair), *inputs, *related]
    unknowns = tuple(sorted(terms, key=lambda unknown: unknown.rank))
    conditions = [condition for _, of_pair in pairs for condition in of_pair]
    ends = dict.fromkeys(mechanism.couplings, ("", ""))
    ends |= {joint.name: (joint.first, joint.second) for joint in mechanism.joints.values()}
    borne = borne_wrenches(result, motion, row)
    equations: list[tuple[str, Dimension]] = []
    coefficients: Matrix = []
    right: list[float] = []
    for name in mechanism.links:
        if name == GROUND_NAME:
            continue
        wrenches = [unknown.on(name, ends[unknown.joint]) for unknown in unknowns]
        for part, dimension in (("force", FORCE), ("moment", MOMENT)):
            for k, letter in enumerate("xyz"):
                equations.append((f"{name}: {part} {letter}", dimension))
                coefficients.append([getattr(wrench, part)[k] for wrench in wrenches])
                right.append(-getattr(borne[name], part)[k])
    for condition in conditions:
        equations.append((condition.name, condition.dimension))
        # of F and M of its pair, not of what stands apart, nor of its drive
        coefficients.append(
            [
                condition.coefficient(unknown)
                if unknown.joint == condition.joint and unknown.rank in (0, 1, 3)
                else 0.0
                for unknown in unknowns
            ]
        )
        right.append(0.0)
    return DenseSystem(tuple(equations), unknowns, coefficients, right)


def _sign(result: Result, name: str, relation: Relation, row: int) -> float:
    """The sign of what a coupling transmits at its first coordinate, where its teeth push apart."""
    if not relation.pushes_apart:
        return 0.0
    value = result.quantity(f"{name}.torque").value
    assert isinstance(value, np.ndarray)
    moment = float(value[row]) * relation.terms[0].factor
    return 1.0 if moment > 0.0 else -1.0


def arranged(system: DenseSystem, equations: Sequence[str], unknowns: Sequence[str]) -> DenseSystem:
    """The system with these links and joints, and these unknowns, first; - changes a sign."""
    owners = [name.partition(":")[0] for name, _ in system.equations]
    rows = _places(owners, equations)
    columns = _places([unknown.group for unknown in system.unknowns], unknowns)
    turned = [system.unknowns[j].reversed() if s < 0.0 else system.unknowns[j] for j, s in columns]
    matrix = [[s * t * system.coefficients[i][j] for j, t in columns] for i, s in rows]
    return DenseSystem(
        tuple(system.equations[i] for i, _ in rows),
        tuple(turned),
        matrix,
        [s * system.right[i] for i, s in rows],
    )


def _places(names: Sequence[str], wanted: Sequence[str]) -> list[tuple[int, float]]:
    """Places of the names with their signs: of those wanted in that order, then of the others."""
    order = {text.removeprefix("-"): k for k, text in enumerate(wanted)}
    places = sorted(range(len(names)), key=lambda place: order.get(names[place], len(order)))
    return [(place, -1.0 if f"-{names[place]}" in wanted else 1.0) for place in places]


def solved(system: DenseSystem) -> list[float] | None:
    """The unknowns in SI, by elimination with row pivots; None where they are not as many as the
    equations or not independent of one another."""
    if len(system.equations) != len(system.unknowns):
        return None
    return eliminated(system.coefficients, system.right, DENSE_PIVOT)


def coefficient_tables(layout: CoefficientsLayout, result: Result) -> tuple[Columns, Columns]:
    """The coefficients with their right side, and the unknowns with their values; the row is among
    those of the result, which may be a part of the run's.

    Raises:
        UsageError: the row has no solution.
    """
    row = layout.row - 1 - result.row_states.span.first
    if not result.solved[row]:
        raise UsageError(
            f"the coefficients {layout.name} are wanted at row {layout.row}, which has no "
            "solution; give another row"
        )
    named = result.problem.mechanism.directions
    along = {
        name: ((one, named[one]), (two, named[two])) for name, (one, two) in layout.along.items()
    }
    system = arranged(dense_system(result, row, along), layout.equations, layout.unknowns)
    name, of_unknowns = layout.names
    size = f"{len(system.equations)} equations in {len(system.unknowns)} unknowns"
    if layout.counted is not None:
        size += f" (the source counts {layout.counted})"
    sizes = " and ".join(str(len(block.unknowns)) for block in result.graph.blocks)
    solved_with = f"with {sizes} unknowns" if sizes else "link by link"
    title = f"{layout.title}; row {layout.row}: {size}, solved here {solved_with}"
    coefficients = Columns(name, title, _coefficients(system, result.units), of_rows=False)
    title = f"{layout.title}; unknowns at row {layout.row}"
    unknowns = Columns(of_unknowns, title, _unknowns(system, result.units), of_rows=False)
    return coefficients, unknowns


def _coefficients(system: DenseSystem, units: UnitSystem) -> tuple[TableColumn, ...]:
    """Number and name of each equation, a column per unknown, the right side."""
    matrix = np.array(system.coefficients)
    columns = [
        _numbers("i", range(1, len(system.equations) + 1)),
        _words("equation", [name for name, _ in system.equations]),
    ]
    dimensions = [dimension for _, dimension in system.equations]
    for unknown, values in zip(system.unknowns, matrix.T, strict=True):
        per_unknown = [
            LENGTH if (dimension, unknown.dimension) == (MOMENT, FORCE) else DIMENSIONLESS
            for dimension in dimensions
        ]
        in_file = [
            units.from_si(float(value), per) for value, per in zip(values, per_unknown, strict=True)
        ]
        columns.append(_numbers(unknown.name, in_file))
    right = [units.from_si(v, d) for v, d in zip(system.right, dimensions, strict=True)]
    return (*columns, _numbers("right side", right))


def _unknowns(system: DenseSystem, units: UnitSystem) -> tuple[TableColumn, ...]:
    dimensions = [unknown.dimension for unknown in system.unknowns]
    values = _without_rounding(solved(system), dimensions)
    return (
        _numbers("j", range(1, len(system.unknowns) + 1)),
        _words("unknown", [unknown.name for unknown in system.unknowns]),
        _numbers("value", [units.from_si(v, d) for v, d in zip(values, dimensions, strict=True)]),
        _words("unit", [units.label(dimension) for dimension in dimensions]),
    )


def _without_rounding(
    values: Sequence[float] | None, dimensions: Sequence[Dimension]
) -> Sequence[float]:
    """The values with zeros for what is rounding; empty cells where there is no solution."""
    if values is None:
        return [float("nan")] * len(dimensions)
    largest: dict[Dimension, float] = {}
    for value, dimension in zip(values, dimensions, strict=True):
        largest[dimension] = max(abs(value), largest.get(dimension, 0.0))
    return [
        value if abs(value) > DENSE_ROUNDING * largest[dimension] else 0.0
        for value, dimension in zip(values, dimensions, strict=True)
    ]


def _numbers(label: str, values: Sequence[float] | range) -> TableColumn:
    return TableColumn(label, "", np.array(values, dtype=np.float64))


def _words(label: str, texts: Sequence[str]) -> TableColumn:
    return TableColumn(label, "", words_of(texts))
