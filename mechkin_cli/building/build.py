"""A checked file to its problem: units, parameters, links, joints, points, motion, loads,
tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.building.actuators import build_drives, note_own_motors
from mechkin_cli.building.assembly import build_assembly, build_follow
from mechkin_cli.building.coefficients import build_coefficients
from mechkin_cli.building.columns import build_tables, used_quantities
from mechkin_cli.building.fields import Fields, Path, read_parameters
from mechkin_cli.building.idle import held_of, note_spins, settled
from mechkin_cli.building.linkage import build_linkage
from mechkin_cli.building.loads import LoadBuilder
from mechkin_cli.building.memory import row_limit
from mechkin_cli.building.motion import build_motion
from mechkin_cli.building.places import is_link, read_points
from mechkin_cli.building.point_inputs import point_guides
from mechkin_cli.building.run_names import runs_of
from mechkin_cli.building.sizes import check_blocks, check_size
from mechkin_cli.building.source import Source
from mechkin_cli.building.unit_system import note_force_unit, read_units
from mechkin_cli.building.unused import note_unused
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.expressions import Quantity
from mechkin_cli.expressions.parameters import Move
from mechkin_cli.mechanism.model import Attached, Link, Mechanism
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import TIME_OF_ROW, Wanted
from mechkin_cli.reading.parser import in_order
from mechkin_cli.runs import SWEEP
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of, needs_all_links
from mechkin_cli.solver.graph import SolverGraph, UnsolvableGraph, build_graph
from mechkin_cli.tables.layout import CoefficientsLayout, TableLayout

if TYPE_CHECKING:
    from mechkin_cli.expressions.nodes import Name, Node
    from mechkin_cli.mechanism.balance import AnyBalance
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.view.settings import ViewSettings

_NOTHING: Mapping[str, Quantity] = MappingProxyType({})
_NO_GRAPHS: Mapping[str, SolverGraph | Diagnostic] = MappingProxyType({})


class Built(NamedTuple):
    """The problem of a file, its solver graph (or why it cannot be solved as it is driven), its
    tables, the source it names, what was read, its runs by name, the solver graphs at the starts of
    its responses, and how it wants to be shown."""

    problem: Problem
    graph: SolverGraph | Diagnostic
    tables: tuple[TableLayout, ...]
    own_tables: bool
    source: str
    read: Source
    runs: tuple[str, ...] = (SWEEP,)
    response_graphs: Mapping[str, SolverGraph | Diagnostic] = _NO_GRAPHS
    coefficients: tuple[CoefficientsLayout, ...] = ()
    balances: tuple[AnyBalance, ...] = ()
    view: ViewSettings | None = None

    def tables_of(self, run: str) -> tuple[TableLayout, ...]:
        """The tables that read a run."""
        return tuple(table for table in self.tables if table.run == run)


def build(source: Source, given: Mapping[str, Quantity] = _NOTHING) -> Built:
    """Builds everything that a file describes; `given` are values instead of some parameters'.

    Raises:
        InvalidFile: with every independent error, each at its line.
    """
    file = source.file
    fields = read_fields(source, given)
    problem = replace(build_problem(fields, file), hold_idle=file.idle == "hold")
    problem = _with_definitions(fields, file, problem)
    tables = build_tables(fields, file, problem)
    own = [table for table in tables if table.run == SWEEP]
    balances = _balances(fields, file, problem)
    coefficients = build_coefficients(fields, file, problem, tables)
    view = _view(fields, file, problem)
    forces = needs_forces(problem, own)
    if file.loads or file.responses or coefficients or forces:
        note_force_unit(fields)
    if forces:
        note_own_motors(fields, file.motion, file.actuators)
    follow = build_follow(fields, file.follow, problem.mechanism.joints)
    problem = replace(problem, follow=follow)
    if not fields.error_count:
        problem = replace(problem, held=held_of(problem))
    graph = _graph(fields, file, problem)
    if isinstance(graph, SolverGraph):
        check_spins(fields, problem, own)
        problem = settled(problem)
    graphs: dict[str, SolverGraph | Diagnostic] = {}
    if problem.responses and graph is not None:
        from mechkin_cli.building.response_graphs import with_graphs

        problem, graphs = with_graphs(fields, problem)
    errors = [d for d in fields.diagnostics if d.severity == "error"]
    if errors or graph is None:
        raise InvalidFile(in_order(fields.diagnostics))
    if file.parameters:
        note_unused(fields)
    problem = replace(problem, diagnostics=tuple(in_order(fields.diagnostics)))
    read = (bool(file.tables), file.source or "", source)
    others = (coefficients, balances, view)
    return Built(problem, graph, tables, *read, runs_of(file), graphs, *others)


def _with_definitions(fields: Fields, file: MechanismFile, problem: Problem) -> Problem:
    """The problem with the file's named expressions, in which derivatives are known now."""

    def differentiate(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
        # loaded only where a derivative is written
        from mechkin_cli.mechanism.influence import differentiation

        return differentiation(problem)(nodes, by, offset)

    fields.definitions = replace(fields.definitions, differentiate=differentiate)
    if file.quantities:
        from mechkin_cli.building.quantities import check_quantities, take_derivatives

        take_derivatives(fields)
        check_quantities(fields, file, problem)
    return replace(problem, definitions=fields.definitions)


def _balances(fields: Fields, file: MechanismFile, problem: Problem) -> tuple[AnyBalance, ...]:
    if not file.balances:
        return ()
    from mechkin_cli.building.balances import build_balances

    return build_balances(fields, file.balances, problem)


def _view(fields: Fields, file: MechanismFile, problem: Problem) -> ViewSettings | None:
    if file.view is None:
        return None
    from mechkin_cli.building.view import build_view

    return build_view(fields, file.view, problem.mechanism)


def read_fields(
    source: Source, given: Mapping[str, Quantity] = _NOTHING, moved: Move | None = None
) -> Fields:
    """Units and parameters of a file, `given` as in `build`, `moved` as in `evaluate_parameters`;
    what is wrong is noted."""
    units, wrong_units = read_units(source.document, source.file.units)
    fields = Fields(source.document, units, diagnostics=wrong_units, plane=source.file.in_plane)
    read_parameters(fields, source.file.parameters, given, moved)
    if source.file.quantities:
        from mechkin_cli.building.quantities import read_quantities

        read_quantities(fields, source.file.quantities)
    return fields


def build_problem(
    fields: Fields,
    file: MechanismFile,
    *,
    responses: bool = True,
    motion: Motion | None = None,
    moving: Mapping[str, Response] | None = None,
) -> Problem:
    """The mechanism with its loads, its motion and assembly, and the file's `responses`; a `motion`
    that is given is not built anew, nor is what `moving` responses do in time."""
    points = read_points(fields, file)
    links, joints = build_linkage(fields, file)
    directions = _directions(fields, file, links)
    guides = point_guides(fields, file.motion, points)
    links, joints = links | guides.links, joints | guides.joints
    limit = row_limit(file, joints)
    if motion is None:
        motion = build_motion(fields, file.motion, joints, limit)
    assembly = build_assembly(fields, file.assembly, joints)
    name = file.name or fields.document.file
    drives = build_drives(fields, file.actuators, file.motion, joints, motion)
    mechanism = Mechanism(
        name, links, joints, points, directions, drives=drives, plane=fields.plane
    )
    problem = Problem(mechanism, motion, assembly, fields.units, dict(fields.parameters))
    loads = LoadBuilder(fields, links, joints, points, _quantities_of_runs(file, problem))
    loads.add_all(file.loads)
    acting = loads.of_run(SWEEP)
    problem = replace(problem, mechanism=acting.on(mechanism), load_laws=acting.laws)
    if not (file.responses and responses):
        return problem
    from mechkin_cli.building.responses import build_responses

    found = build_responses(fields, file.responses, problem, loads, limit, moving)
    return replace(problem, responses=found)


def _quantities_of_runs(file: MechanismFile, problem: Problem) -> dict[str, Mapping[str, Wanted]]:
    """What loads may read in each run, by its name: rows of responses have a time."""
    swept = problem.quantities()
    timed = swept if "time" in swept or not file.responses else {**swept, "time": TIME_OF_ROW}
    return {name: swept if name == SWEEP else timed for name in runs_of(file)}


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
    if needs_all_links(problem.mechanism, _used(problem, tables)):
        note_spins(fields, problem)


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
