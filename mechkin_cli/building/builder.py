"""A checked file to its problem: units, parameters, links, joints, points, motion, loads, tables;
then limits on well-formed files, named expressions, unused parameters.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from mechkin_cli import mobility
from mechkin_cli.assembly import is_home_singular
from mechkin_cli.building.cables import build_cables
from mechkin_cli.building.couplings import (
    build_couplings,
    coupled_joints,
    refuse_tied_friction,
)
from mechkin_cli.building.cylinders import build_cylinders, define_cylinders
from mechkin_cli.building.datum import Datum, datum_of
from mechkin_cli.building.fields import (
    AlreadyRefused,
    Fields,
    Path,
    is_link,
    note_force_unit,
    read_parameters,
    read_points,
    read_units,
)
from mechkin_cli.building.friction import without_friction
from mechkin_cli.building.joints import build_linkage
from mechkin_cli.building.limits import build_limits
from mechkin_cli.building.loads import LoadBuilder, build_drives, note_own_motors
from mechkin_cli.building.motion import build_motion, point_guides
from mechkin_cli.building.play import build_plays, loose_in_sweep, note_tight, with_plays
from mechkin_cli.building.responses import (
    build_assembly,
    build_follow,
    held_of,
    note_spins,
    settled,
)
from mechkin_cli.building.rest import near_rest
from mechkin_cli.building.source import without_collection
from mechkin_cli.building.spacing import numbers_per_row
from mechkin_cli.building.tables import (
    ColumnSample,
    build_coefficients,
    build_tables,
    problem_of,
    runs_of,
    used_quantities,
)
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Number
from mechkin_cli.expressions import (
    Definitions,
    ExpressionError,
    Move,
    Name,
    Node,
    OperationNode,
    Quantity,
    in_order as expressions_in_order,
    parse,
)
from mechkin_cli.mechanism import (
    TIME_OF_ROW,
    ZERO,
    Attached,
    LockedFreedom,
    Mechanism,
    MotionInputs,
    Problem,
    Vector,
    Wanted,
    counted,
    differentiation,
)
from mechkin_cli.plan import Demand, demand_of, needs_all_links
from mechkin_cli.reading import Document, in_order
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.schema import Flanks, MechanismFile
from mechkin_cli.session import Session, solver_graph
from mechkin_cli.structure import (
    SolverGraph,
    UnsolvableGraph,
    is_too_large,
    listed,
    most_equations,
)
from mechkin_cli.tables import CoefficientsLayout, TableLayout
from mechkin_cli.tolerances import SMALLEST_SIZE
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building.start_graphs import Graphs
    from mechkin_cli.building.view import ViewSettings
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import AnyBalance, ResponseProblem
    from mechkin_cli.session import Structure


_NOTHING: Mapping[str, Quantity] = MappingProxyType({})
_NO_GRAPHS: Mapping[str, SolverGraph | Diagnostic] = MappingProxyType({})


class Built(NamedTuple):
    """The problem of a file, its solver graph (or why it cannot be solved as it is driven), its
    tables, the source it names, the file as read and its document, its runs by name, the solver
    graphs at the starts of its responses, coefficients, balances, the settings of its view, and the
    mechanism in the kernel as it was looked at on the way."""

    problem: Problem
    graph: SolverGraph | Diagnostic
    tables: tuple[TableLayout, ...]
    own_tables: bool
    source: str
    file: MechanismFile
    document: Document
    runs: tuple[str, ...] = (SWEEP,)
    response_graphs: Mapping[str, SolverGraph | Diagnostic] = _NO_GRAPHS
    coefficients: tuple[CoefficientsLayout, ...] = ()
    balances: tuple[AnyBalance, ...] = ()
    view: ViewSettings | None = None
    structure: Structure | None = None

    def tables_of(self, run: str) -> tuple[TableLayout, ...]:
        """The tables that read a run."""
        return tuple(table for table in self.tables if table.run == run)


@without_collection()
def build(
    file: MechanismFile,
    document: Document,
    given: Mapping[str, Quantity] = _NOTHING,
    alike: Sequence[LockedFreedom] = (),
) -> Built:
    """Builds everything that a file describes; `given` values replace those of some parameters.
    What holds a design `alike` as drawn, as `Problem.stopped`, is what holds this one if it can.

    Raises:
        InvalidFile: with every independent error, each at its line.
    """
    fields = read_fields(file, document, given)
    problem = build_problem(fields, file)
    datum = datum_of(problem.mechanism)
    if datum != ZERO:
        fields = read_fields(file, document, given, datum=datum)
        problem = build_problem(fields, file)
    problem = replace(problem, hold_idle=file.idle == "hold")
    problem = _with_definitions(fields, file, problem)
    if file.equilibria and not fields.error_count:
        from mechkin_cli.building.start_graphs import with_starts

        # what rows of equilibria have goes by their coordinates
        problem = with_starts(problem)
    tables = build_tables(fields, file, problem)
    own = [table for table in tables if table.run == SWEEP]
    balances = _balances(fields, file, problem)
    coefficients = build_coefficients(fields, file, problem, tables)
    view = _view(fields, file, problem)
    with_names, used = problem, used_by(problem, own)
    forces = bool(demand_of(problem.mechanism, used) & Demand.FORCES)
    # the unit of forces that are computed stands above their column
    if file.loads or any(run.efforts for run in file.free_runs.values()):
        note_force_unit(fields)
    if forces:
        note_own_motors(fields, file.motion, file.actuators)
    problem = replace(problem, follow=build_follow(fields, file.follow, problem.mechanism.joints))
    if not fields.error_count:
        problem = replace(problem, held=held_of(problem))
    graph, structure = _graph(fields, file, problem), None
    if isinstance(graph, SolverGraph):
        session = Session.of(problem, graph)
        structure = session.structure
        if is_home_singular(session):
            held = mobility.held_to_family(problem, alike)
            if held != problem.held:
                problem = replace(problem, held=held)
                graph = _graph(fields, file, problem)
    if isinstance(graph, SolverGraph):
        check_spins(fields, problem, used)
        problem = settled(problem)
    graphs: Graphs = {}
    if problem.responses and graph is not None:
        from mechkin_cli.building.start_graphs import with_graphs

        problem, graphs = with_graphs(fields, problem)
    errors = [d for d in fields.diagnostics if d.severity == "error"]
    if errors or graph is None:
        raise InvalidFile(in_order(fields.diagnostics))
    if file.parameters:
        note_unused(fields)
    problem = replace(problem, diagnostics=tuple(in_order(fields.diagnostics)))
    if not problem.held and problem.mechanism is with_names.mechanism:
        problem = problem.with_quantities_of(with_names)
    read = (bool(file.tables), file.source or "", file, document)
    others = (coefficients, balances, view, structure)
    return Built(problem, graph, tables, *read, runs_of(file), graphs, *others)


@without_collection()
def read_and_build(read: Callable[..., tuple[MechanismFile, Document]], *args: Any) -> Built:
    """What `read` gives of a file, a text or data, built.

    Raises:
        UsageError, InvalidFile: as `read` and `build`.
    """
    return build(*read(*args))


def _with_definitions(fields: Fields, file: MechanismFile, problem: Problem) -> Problem:
    """The problem with the file's named expressions, in which derivatives are known now."""

    def differentiate(nodes: tuple[Node, ...], by: Name, offset: int) -> tuple[Node, ...]:
        if SWEEP in fields.failed:
            refused = AlreadyRefused(by.text)
            raise ExpressionError(refused.message, offset) from refused
        return differentiation(problem)(nodes, by, offset)

    fields.definitions = replace(fields.definitions, differentiate=differentiate)
    if file.quantities:
        take_derivatives(fields)
        check_quantities(fields, file, problem)
    return replace(problem, definitions=fields.definitions)


def _balances(fields: Fields, file: MechanismFile, problem: Problem) -> tuple[AnyBalance, ...]:
    if not file.balances or SWEEP in fields.failed:
        return ()
    from mechkin_cli.building.tables import build_balances

    return build_balances(fields, file.balances, problem)


def _view(fields: Fields, file: MechanismFile, problem: Problem) -> ViewSettings | None:
    if file.view is None and not file.couplings and not file.cylinders:
        return None
    from mechkin_cli.building.view import build_view

    return build_view(fields, file.view, file.couplings, file.cylinders, problem.mechanism)


def read_fields(
    file: MechanismFile,
    document: Document,
    given: Mapping[str, Quantity] = _NOTHING,
    moved: Move | None = None,
    *,
    datum: Vector = ZERO,
) -> Fields:
    """Units and parameters of a file, `given` as in `build`, `moved` as in `evaluate_parameters`;
    places are measured from the `datum` (m). Errors are noted."""
    units, errors = read_units(document, file.units)
    fields = Fields(document, units, diagnostics=[*document.notes, *errors], plane=file.in_plane)
    read_parameters(fields, file.parameters, given, moved)
    if datum != ZERO:
        fields.datum = Datum(datum, file.parameters, given, units)
    define_cylinders(fields, file)
    if file.quantities:
        read_quantities(fields, file.quantities)
    return fields


def build_problem(
    fields: Fields,
    file: MechanismFile,
    *,
    responses: bool = True,
    motion: MotionInputs | None = None,
    moving: Mapping[str, ResponseProblem] | None = None,
) -> Problem:
    """The mechanism with its loads, its motion and assembly, and the file's `responses`; a `motion`
    is not built again, nor are the motions in time of `moving` responses."""
    points = read_points(fields, file)
    links, joints = build_linkage(fields, file)
    telescopes, slides = build_cylinders(fields, file.cylinders, points)
    links, joints = links | telescopes, joints | slides
    for coupled in coupled_joints(fields, file.couplings, joints):
        joints[coupled] = counted(joints[coupled])
    cable_links, cable_joints, cables = build_cables(fields, file.couplings, joints, points)
    couplings = build_couplings(fields, file.couplings, joints, cables)
    directions = {
        name: Attached(d.link, fields.direction(("directions", name, "vector"), d.vector))
        for name, d in file.directions.items()
        if is_link(fields, ("directions", name, "link"), d.link, links)
    }
    guide_links, guide_joints = point_guides(fields, file.motion, points)
    links = links | guide_links | cable_links
    joints = joints | guide_joints | cable_joints
    plays, flanks = build_plays(fields, file.couplings, couplings, joints)
    moving_joints = joints | {name: play.terms[-1].joint for name, play in plays.items()}
    per_row = numbers_per_row(file, moving_joints)
    if motion is None:
        motion = build_motion(fields, file.motion, moving_joints, per_row)
    assembly = build_assembly(fields, file.assembly, joints)
    motion = near_rest(motion, assembly, fields.units)
    limits = (*build_limits(fields, file, joints, couplings), *flanks.values())
    name = file.name or fields.document.file
    drives = build_drives(fields, file.actuators, file.motion, joints, motion)
    mechanism = Mechanism(
        name, links, joints, points, directions, drives=drives, plane=fields.plane
    )
    mechanism = replace(mechanism, datum=fields.origin, couplings=couplings)
    loose = loose_in_sweep(plays, motion)
    note_tight(fields, plays, loose)
    mechanism = with_plays(mechanism, loose)
    problem = Problem(mechanism, motion, assembly, fields.units, dict(fields.parameters))
    problem = replace(problem, limits=limits)
    # rows of responses have a time, and all plays
    swept = problem.quantities()
    timed = swept if "time" in swept or not file.free_runs else {**swept, "time": TIME_OF_ROW}
    if plays and file.free_runs:
        timed = {**replace(problem, mechanism=with_plays(mechanism, plays)).quantities(), **timed}
    quantities = {name: swept if name == SWEEP else timed for name in runs_of(file)}
    loads = LoadBuilder(fields, links, joints, points, quantities)
    loads.add_all(file.loads)
    mechanism, laws, _ = loads.of_run(SWEEP, mechanism)
    if motion.rest is not None and file.actuators:
        text = "efforts of actuators do not go with coordinates that rest under the loads"
        fields.error("rest-and-actuators", ("actuators",), text, "remove actuators:, or rest:")
    if motion.rest is not None:
        mechanism = without_friction(fields, mechanism, ("motion", "rest"))
    problem = replace(problem, mechanism=mechanism, load_laws=laws)
    refuse_tied_friction(fields, file.loads, problem)
    if not (file.free_runs and responses):
        return problem
    from mechkin_cli.building.responses import build_responses

    free = replace(problem, mechanism=with_plays(mechanism, plays))
    args = (fields, file.free_runs, free, loads, moving)
    return replace(problem, responses=build_responses(*args))


def check_spins(fields: Fields, problem: Problem, used: Sequence[Wanted]) -> None:
    """Notes links that spin freely and have a cause to spin, where `used` quantities are forces or
    energies."""
    if needs_all_links(problem.mechanism, used):
        note_spins(fields, problem)


def used_by(problem: Problem, tables: Sequence[TableLayout]) -> list[Wanted]:
    """The quantities that some tables read."""
    quantities = problem.quantities()
    return [quantities[name] for name in used_quantities(tables, quantities)]


def _graph(
    fields: Fields, file: MechanismFile, problem: Problem
) -> SolverGraph | Diagnostic | None:
    """The solver graph; None where there are errors already, to avoid others that follow."""
    if fields.error_count or not check_size(fields, problem.mechanism):
        return None
    try:
        graph = solver_graph(problem.solved_mechanism, problem.driven)
    except UnsolvableGraph as error:
        path: Path = ("joints", *error.joints[:1])
        if problem.motion.inputs:
            path = ("motion", "inputs")
        for i, row in enumerate(file.chain):
            if row.joint in error.joints[:1] and not problem.motion.inputs:
                path = ("chain", i, "joint")
        return error.diagnostic._replace(place=fields.document.place(path))
    return graph if check_blocks(fields, graph) else None


def motion_as_built(
    built: Built, problem: Problem, given: Mapping[str, Quantity]
) -> MotionInputs | None:
    """The motion that `build` finds with `given` parameters, for a problem that has all but that;
    None where it would say something of it, or where more than the inputs goes by it."""
    file = built.file
    sections = file.couplings.values()
    plays = any(isinstance(one, Flanks) and one.backlash is not None for one in sections)
    if plays or problem.has_idle:
        return None
    fields = read_fields(file, built.document, given, datum=problem.mechanism.datum)
    said = len(fields.diagnostics)
    joints = problem.mechanism.joints
    motion = build_motion(fields, file.motion, joints, numbers_per_row(file, joints))
    return None if len(fields.diagnostics) > said else motion


def graph_as_built(problem: Problem, alike: Sequence[LockedFreedom] = ()) -> SolverGraph | None:
    """The solver graph that `build` finds of a problem that has no errors; None where it would say
    something of it, or hold other freedoms. `alike` as in `build`."""
    held = held_of(problem)
    if held != problem.held:
        problem = replace(problem, held=held)
    try:
        graph = solver_graph(problem.solved_mechanism, problem.driven)
    except UnsolvableGraph:
        return None
    if is_too_large(graph):
        return None
    if is_home_singular(Session.of(problem, graph)):
        own = mobility.held_to_family(problem, alike)
        return None if own != problem.held else graph
    return graph


def check_blocks(fields: Fields, graph: SolverGraph) -> bool:
    """Whether every block is small enough, since the work grows with the cube of the equations to
    solve together, or with their number where they are a band; the first that is not is noted."""
    for block in graph.blocks:
        most = most_equations(graph, block)
        if block.equations <= most:
            continue
        closings = [graph.closings[c] for c in block.closings]
        members = {graph.edges[k].joint.name for k in graph.passed(block)}
        joints = sorted(members | {closing.joint.name for closing in closings})
        fields.error(
            "block-too-large",
            ("joints",),
            f"{len(closings)} loops through {len(joints)} joints must be solved together: "
            f"{listed(joints)}",
            "drive a coordinate inside, or write parts that do not act on each other in files of "
            "their own",
            measured=f"{block.equations} closing equations",
            limit=f"{most} closing equations",
            numbers=(Number("closing equations", block.equations, limit=most),),
        )
        return False
    return True


def check_size(fields: Fields, mechanism: Mechanism) -> bool:
    """Whether the mechanism as drawn is large enough for quotients by its size squared, such as
    inertias; if not, that is noted."""
    size = mechanism.box_diagonal()
    if SMALLEST_SIZE <= size < inf:
        return True
    size = 0.0 if size == inf else size  # of numbers whose inverses overflow
    fields.error(
        "too-small",
        ("joints",),
        "the mechanism as drawn is too small to compute with",
        "check exponents and units of its lengths",
        measured=f"all joints within {size:.4g} m",
        limit=f"{SMALLEST_SIZE:g} m",
        numbers=(Number("size", size, "m", limit=SMALLEST_SIZE),),
    )
    return False


def read_quantities(fields: Fields, texts: Mapping[str, str]) -> None:
    """Puts the named expressions into `fields.definitions`; those that depend on themselves or are
    not expressions are refused, with a message."""
    expressions: dict[str, Expression] = {}
    for name, text in texts.items():
        try:
            expressions[name] = parse(text)
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
    needs = {
        name: sorted({used.partition(".")[0] for used in expression.names} & texts.keys())
        for name, expression in expressions.items()
    }
    errors: list[ExpressionError] = []
    for name in expressions_in_order(expressions, needs, errors, "quantities"):
        if all(need in fields.definitions.named for need in needs[name]):
            _define(fields, name, expressions[name])
    for circle in errors:
        fields.expression_error(("quantities", circle.name or ""), circle)
    fields.refused |= texts.keys() - fields.definitions.named.keys()


def take_derivatives(fields: Fields) -> None:
    """Expands the derivatives in the named expressions; one that is not known is refused, with a
    message."""
    named = fields.definitions.named
    fields.definitions = replace(fields.definitions, named={})
    for name, expression in named.items():
        _define(fields, name, expression)
    fields.refused |= named.keys() - fields.definitions.named.keys()


def _define(fields: Fields, name: str, expression: Expression) -> None:
    """Adds an expression to the definitions, in which those so far are known."""
    try:
        expanded = fields.definitions.expanded(expression)
    except ExpressionError as error:
        fields.expression_error(("quantities", name), error)
    else:
        fields.definitions = fields.definitions.adding(name, expanded)


def check_quantities(fields: Fields, file: MechanismFile, problem: Problem) -> None:
    """Notes the error of a quantity that has one in every run of the file, at its place;
    expressions that use it get no message of their own."""
    samples = [ColumnSample(fields, problem_of(problem, run), run) for run in runs_of(file)]
    values: list[dict[str, Quantity]] = [{} for _ in samples]
    named = fields.definitions.named
    # of what is no quantity of the file nothing is known here: it stands for what it is
    others = Definitions({n: one for n, one in named.items() if n not in file.quantities})
    for name in filter(file.quantities.__contains__, named):
        expression = others.expanded(parse(file.quantities[name]))
        uses = {node.text.partition(".")[0] for node in expression.nodes if isinstance(node, Name)}
        if uses & fields.refused:
            fields.refused.add(name)
            continue
        pairs = zip(samples, values, strict=True)
        errors = [_error_of(fields, name, expression, *pair) for pair in pairs]
        if all(error is not None for error in errors) and errors[0] is not None:
            fields.expression_error(("quantities", name), errors[0])
            fields.refused.add(name)


def _error_of(
    fields: Fields,
    name: str,
    expression: Expression,
    sample: ColumnSample,
    values: dict[str, Quantity],
) -> ExpressionError | None:
    """The error of a named expression in a run; without one its value joins those of the others, so
    that each is evaluated once."""
    try:
        if any(isinstance(n, OperationNode) and n.symbol == "derivative" for n in expression.nodes):
            whole = fields.definitions.expanded(expression)
            values[name] = whole.evaluate(sample, fields.units)
        else:
            values[name] = expression.evaluate(
                lambda used: values[used] if used in values else sample(used), fields.units
            )
    except ExpressionError as error:
        return error
    return None


_NAME: Final = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_FOR_PEOPLE: Final = ("name", "title", "source", "label", "text")
_OF_NAMES: Final = ("parameters", "quantities")
"""Sections whose keys are names that the file chooses."""


def note_unused(fields: Fields) -> None:
    """A note at every parameter that no expression uses, and at those that only such ones use.

    Names are looked up in all texts of the file except those for people, so that this is
    independent of the forms of sections: a name anywhere in a possible expression counts as used.
    """
    # as written: values from outside do not count
    document = fields.document
    data = (replace(document, overrides={}) if document.overrides else document).data
    section = data.get("parameters")
    if not isinstance(section, dict) or not section:
        return
    users: dict[str, list[str]] = {name: [] for name in section}
    for user, text in section.items():
        for used in set(_NAME.findall(str(text))) & section.keys():
            users[used].append(user)
    unused = set(section)
    front: set[str] = set()
    for text in _texts({key: value for key, value in data.items() if key != "parameters"}):
        front |= unused & set(_NAME.findall(text))
        unused -= front
        if not unused:
            return
    while front:
        unused -= front
        front = {name for name in unused if not unused.issuperset(users[name])}
    for name in section:
        if name in unused:
            but = f" but {', '.join(users[name])}, which nothing uses" if users[name] else ""
            place = fields.document.key_place(("parameters", name))
            text = f"nothing uses the parameter {name}{but}"
            hint = "remove it, or use it where it was meant"
            fields.note(Diagnostic("unused-parameter", "note", text, place, hint=hint))


def _texts(data: Any, key: str = "") -> Iterator[str]:
    """All texts below a part of the file in which an expression might stand."""
    if isinstance(data, dict):
        for inner, value in data.items():
            is_prose = inner in _FOR_PEOPLE and key not in _OF_NAMES
            if not (is_prose and isinstance(value, str)):
                yield from _texts(value, inner)
    elif isinstance(data, (list, tuple)):
        for value in data:
            yield from _texts(value, key)
    elif isinstance(data, str):
        yield data
