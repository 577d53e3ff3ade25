"""A checked file to its problem: units, parameters, links, joints, points, motion, loads,
tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

from mechkin_cli.building.assembly import build_assembly, build_follow
from mechkin_cli.building.columns import build_tables, used_quantities
from mechkin_cli.building.fields import Fields, Path, read_parameters
from mechkin_cli.building.linkage import build_linkage, is_link
from mechkin_cli.building.loads import LoadBuilder
from mechkin_cli.building.memory import row_limit
from mechkin_cli.building.motion import build_motion
from mechkin_cli.building.sizes import check_blocks, check_size
from mechkin_cli.building.source import Source
from mechkin_cli.building.unit_system import note_force_unit, read_units
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.expressions import Quantity
from mechkin_cli.mechanism.held import Held
from mechkin_cli.mechanism.holding import held_freedoms
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.model import Attached, Link, Mechanism
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.reading.parser import in_order
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of, needs_all_links
from mechkin_cli.solver.graph import SolverGraph, UnsolvableGraph, build_graph
from mechkin_cli.tables.layout import TableLayout, default_table
from mechkin_cli.units import LENGTH

_NOTHING: Mapping[str, Quantity] = MappingProxyType({})


class Built(NamedTuple):
    """The problem of a file, its solver graph (or why it cannot be solved as it is driven), its
    tables, the source it names, and what was read."""

    problem: Problem
    graph: SolverGraph | Diagnostic
    tables: tuple[TableLayout, ...]
    own_tables: bool
    source: str
    read: Source


def build(source: Source, given: Mapping[str, Quantity] = _NOTHING) -> Built:
    """Builds everything that a file describes; `given` are values instead of some parameters'.

    Raises:
        InvalidFile: with every independent error, each at its line.
    """
    file = source.file
    fields = read_fields(source, given)
    problem = build_problem(fields, file)
    tables = build_tables(fields, file.tables, problem.quantities())
    if not file.tables:
        timed = problem.motion.time is not None
        names = [driven.name for driven in problem.motion.inputs]
        tables = (default_table(problem.mechanism.coordinates, names, timed=timed),)
    if file.loads or needs_forces(problem, tables):
        note_force_unit(fields)
    follow = build_follow(fields, file.follow, problem.mechanism.joints)
    problem = replace(problem, hold_idle=file.idle == "hold", follow=follow)
    if not fields.error_count:
        problem = replace(problem, held=_held(problem))
    graph = _graph(fields, file, problem)
    if isinstance(graph, SolverGraph):
        check_spins(fields, problem, tables)
        if problem.held:
            from mechkin_cli.mechanism.idle import without_spin

            problem = without_spin(problem)
    errors = [d for d in fields.diagnostics if d.severity == "error"]
    if errors or graph is None:
        raise InvalidFile(in_order(fields.diagnostics))
    problem = replace(problem, diagnostics=tuple(in_order(fields.diagnostics)))
    return Built(problem, graph, tables, bool(file.tables), file.source or "", source)


def _held(problem: Problem) -> tuple[Held, ...]:
    """What holds the idle freedoms."""
    held, as_drawn = held_freedoms(problem.mechanism, problem.motion.driven)
    if not as_drawn:
        return held
    from mechkin_cli.freedoms.held_along import held_along

    return held_along(problem, held)


def read_fields(source: Source, given: Mapping[str, Quantity] = _NOTHING) -> Fields:
    """Units and parameters of a file, `given` as in `build`; what is wrong is noted."""
    units, wrong_units = read_units(source.document, source.file.units)
    fields = Fields(source.document, units, diagnostics=wrong_units)
    read_parameters(fields, source.file.parameters, given)
    return fields


def build_problem(fields: Fields, file: MechanismFile) -> Problem:
    """The mechanism with its loads, its motion and assembly."""
    links, joints = build_linkage(fields, file)
    points, directions = _points(fields, file, links), _directions(fields, file, links)
    motion = build_motion(fields, file.motion, joints, row_limit(file, joints))
    assembly = build_assembly(fields, file.assembly, joints)
    name = file.name or fields.document.file
    mechanism = Mechanism(name, links, joints, points, directions)
    problem = Problem(mechanism, motion, assembly, fields.units, dict(fields.parameters))
    loads = LoadBuilder(fields, links, joints, points, problem.quantities())
    loads.add_all(file.loads)
    mechanism = replace(mechanism, loads=tuple(loads.loads), gravity=loads.gravity)
    return replace(problem, mechanism=mechanism, load_laws=loads.laws)


def _points(fields: Fields, file: MechanismFile, links: Mapping[str, Link]) -> dict[str, Attached]:
    return {
        name: Attached(p.link, fields.vector(("points", name, "at"), p.at, LENGTH))
        for name, p in file.points.items()
        if is_link(fields, ("points", name, "link"), p.link, links)
    }


def _directions(
    fields: Fields, file: MechanismFile, links: Mapping[str, Link]
) -> dict[str, Attached]:
    return {
        name: Attached(d.link, fields.direction(("directions", name, "vector"), d.vector))
        for name, d in file.directions.items()
        if is_link(fields, ("directions", name, "link"), d.link, links)
    }


def check_spins(fields: Fields, problem: Problem, tables: Sequence[TableLayout]) -> None:
    """Where forces or energies are wanted, what spins freely must have no cause to spin."""
    idle = find_legs(problem.mechanism) or problem.held
    if not (idle and needs_all_links(problem.mechanism, _used(problem, tables))):
        return
    from mechkin_cli.mechanism.idle import spin_errors

    for link, diagnostic in spin_errors(problem):
        place = fields.document.place(("links", link))
        fields.diagnostics.append(diagnostic._replace(place=place))


def needs_forces(problem: Problem, tables: Sequence[TableLayout]) -> bool:
    """Whether some column reads a force."""
    return bool(demand_of(problem.mechanism, _used(problem, tables)) & Demand.FORCES)


def _used(problem: Problem, tables: Sequence[TableLayout]) -> list[Wanted]:
    """The quantities that some tables read."""
    quantities = problem.quantities()
    return [quantities[name] for name in used_quantities(tables, quantities)]


def _place_of(file: MechanismFile, joints: Sequence[str]) -> Path:
    """Where the first of some joints is written."""
    for i, row in enumerate(file.chain):
        if row.joint in joints[:1]:
            return ("chain", i, "joint")
    return ("joints", *joints[:1])


def _graph(
    fields: Fields, file: MechanismFile, problem: Problem
) -> SolverGraph | Diagnostic | None:
    """The solver graph; only asked for when the parts are sound, to avoid follow-up errors."""
    if fields.error_count or not check_size(fields, problem.mechanism):
        return None
    try:
        graph = build_graph(problem.solved_mechanism, problem.driven)
    except UnsolvableGraph as error:
        driven = problem.motion.inputs
        path = ("motion", "inputs") if driven else _place_of(file, error.joints)
        return error.diagnostic._replace(place=fields.document.place(path))
    return graph if check_blocks(fields, graph) else None
