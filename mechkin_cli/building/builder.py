"""A checked file to its problem: units, parameters, links, joints, points, motion, loads,
tables.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from mechkin_cli.building.assembly import build_assembly, build_follow, held_of, note_spins, settled
from mechkin_cli.building.fields import (
    Fields,
    Path,
    is_link,
    note_force_unit,
    read_parameters,
    read_points,
    read_units,
)
from mechkin_cli.building.links import build_linkage
from mechkin_cli.building.loads import LoadBuilder, build_drives, note_own_motors
from mechkin_cli.building.motion import build_motion, point_guides, row_limit
from mechkin_cli.building.source import MechanismSource
from mechkin_cli.building.tables import (
    ColumnSample,
    build_coefficients,
    build_tables,
    quantities_of,
    runs_of,
    used_quantities,
)
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Number
from mechkin_cli.expressions import (
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
    Attached,
    Mechanism,
    MotionInputs,
    Problem,
    RigidLink,
    Wanted,
)
from mechkin_cli.plan import Demand, demand_of, needs_all_links
from mechkin_cli.reading import in_order
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.schema import MechanismFile
from mechkin_cli.session import solver_graph
from mechkin_cli.structure import SolverGraph, UnsolvableGraph, listed
from mechkin_cli.tables import CoefficientsLayout, TableLayout
from mechkin_cli.tolerances import MOST_EQUATIONS, SMALLEST_SIZE
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.building.view import ViewSettings
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import AnyBalance, ResponseProblem


# `assembly:` and `follow:`: which assembly is meant, and which loops are followed.


# Idle freedoms of a built problem: what holds them, and what must not drive them.


# Limits on a well-formed file: equations of one block, and how small a mechanism may be.
#
# A file within all limits of the reader can still ask for more than a machine has: the work grows
# with the cube of the equations that must be solved together. And it can be drawn so small that
# what is divided by its size squared, such as inertias, is no number any more.


def check_blocks(fields: Fields, graph: SolverGraph) -> bool:
    """Whether every block is small enough; if not, the first that is not is noted."""
    for block in graph.blocks:
        if block.equations <= MOST_EQUATIONS:
            continue
        closings = [graph.closings[c] for c in block.closings]
        members = {graph.edges[k].joint.name for closing in closings for k, _ in closing.loop}
        joints = sorted(members | {closing.joint.name for closing in closings})
        fields.error(
            "block-too-large",
            ("joints",),
            f"{len(closings)} loops through {len(joints)} joints must be solved together: "
            f"{listed(joints)}",
            "drive a coordinate inside, or write parts that do not act on each other in files of "
            "their own",
            measured=f"{block.equations} closing equations",
            limit=f"{MOST_EQUATIONS} closing equations",
            numbers=(Number("closing equations", block.equations, limit=MOST_EQUATIONS),),
        )
        return False
    return True


def check_size(fields: Fields, mechanism: Mechanism) -> bool:
    """Whether the mechanism as drawn is large enough to compute with; if not, that is noted."""
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


# Notes parameters that nothing in the file uses: one that is misspelt where it was meant, or a
# remainder.
#
# Names are looked for in all texts of the file but those for people, so that no form of a section
# has to be known here: a name that stands anywhere an expression might stand counts as used.

_NAME: Final = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_FOR_PEOPLE: Final = ("name", "title", "source", "label", "text")
_OF_NAMES: Final = ("parameters", "quantities")
"""Sections whose keys are names that the file chooses."""


def note_unused(fields: Fields) -> None:
    """A note at every parameter that no expression uses, and at those that only such ones use."""
    # as written: a value from outside that names nothing makes nothing superfluous
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
            _note(fields, name, users[name])


def _note(fields: Fields, name: str, users: list[str]) -> None:
    but = f" but {', '.join(users)}, which nothing uses" if users else ""
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
    read: MechanismSource
    runs: tuple[str, ...] = (SWEEP,)
    response_graphs: Mapping[str, SolverGraph | Diagnostic] = _NO_GRAPHS
    coefficients: tuple[CoefficientsLayout, ...] = ()
    balances: tuple[AnyBalance, ...] = ()
    view: ViewSettings | None = None

    def tables_of(self, run: str) -> tuple[TableLayout, ...]:
        """The tables that read a run."""
        return tuple(table for table in self.tables if table.run == run)


def build(source: MechanismSource, given: Mapping[str, Quantity] = _NOTHING) -> Built:
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
        from mechkin_cli.building.responses import with_graphs

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
        from mechkin_cli.mechanism import differentiation

        return differentiation(problem)(nodes, by, offset)

    fields.definitions = replace(fields.definitions, differentiate=differentiate)
    if file.quantities:
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
    source: MechanismSource, given: Mapping[str, Quantity] = _NOTHING, moved: Move | None = None
) -> Fields:
    """Units and parameters of a file, `given` as in `build`, `moved` as in `evaluate_parameters`;
    what is wrong is noted."""
    units, wrong_units = read_units(source.document, source.file.units)
    fields = Fields(source.document, units, diagnostics=wrong_units, plane=source.file.in_plane)
    read_parameters(fields, source.file.parameters, given, moved)
    if source.file.quantities:
        read_quantities(fields, source.file.quantities)
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
    fields: Fields, file: MechanismFile, links: Mapping[str, RigidLink]
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
        graph = solver_graph(problem.solved_mechanism, problem.driven)
    except UnsolvableGraph as error:
        driven = problem.motion.inputs
        path = ("motion", "inputs") if driven else _place_of(file, error.joints)
        return error.diagnostic._replace(place=fields.document.place(path))
    return graph if check_blocks(fields, graph) else None


# `quantities:` to named expressions; each is checked where it is written.


def read_quantities(fields: Fields, texts: Mapping[str, str]) -> None:
    """Puts the named expressions into `fields.definitions`; those that depend on themselves or are
    no expressions are refused, with a message."""
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
        if any(need not in fields.definitions.named for need in needs[name]):
            continue
        try:
            found = fields.definitions.expanded(expressions[name])
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
            continue
        fields.definitions = fields.definitions.adding(name, found)
    for circle in errors:
        fields.expression_error(("quantities", circle.name or ""), circle)
    fields.refused |= texts.keys() - fields.definitions.named.keys()


def take_derivatives(fields: Fields) -> None:
    """Writes out the derivatives in the named expressions; one that is not known is refused, with a
    message."""
    named = fields.definitions.named
    fields.definitions = replace(fields.definitions, named={})
    for name, expression in named.items():
        try:
            found = fields.definitions.expanded(expression)
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
            fields.refused.add(name)
            continue
        fields.definitions = fields.definitions.adding(name, found)


def check_quantities(fields: Fields, file: MechanismFile, problem: Problem) -> None:
    """Notes what is wrong with a quantity in every run of the file, at its place; what uses it gets
    no message of its own."""
    runs = runs_of(file)
    samples = [
        _NamedValues(ColumnSample(fields, quantities_of(problem, run), run), {}) for run in runs
    ]
    for name in fields.definitions.named:
        expression = parse(file.quantities[name])
        if _uses(expression) & fields.refused:
            fields.refused.add(name)
            continue
        wrong = [_error_of(fields, name, expression, sample) for sample in samples]
        if all(error is not None for error in wrong) and wrong[0] is not None:
            fields.expression_error(("quantities", name), wrong[0])
            fields.refused.add(name)


def _uses(expression: Expression) -> set[str]:
    names = (node.text for node in expression.nodes if isinstance(node, Name))
    return {name.partition(".")[0] for name in names}


@dataclass(frozen=True)
class _NamedValues:
    """A run's sample with the values of named expressions, so that each is evaluated once."""

    sample: ColumnSample
    known: dict[str, Quantity]

    def __call__(self, name: str) -> Quantity:
        return self.known[name] if name in self.known else self.sample(name)


def _error_of(
    fields: Fields, name: str, expression: Expression, sample: _NamedValues
) -> ExpressionError | None:
    """What is wrong with a named expression whose names are known; else keeps its value."""
    try:
        if any(map(_is_derivative, expression.nodes)):
            whole = fields.definitions.expanded(expression)
            sample.known[name] = whole.evaluate(sample.sample, fields.units)
        else:
            sample.known[name] = expression.evaluate(sample, fields.units)
    except ExpressionError as error:
        return error
    return None


def _is_derivative(node: Node) -> bool:
    return isinstance(node, OperationNode) and node.symbol == "derivative"
