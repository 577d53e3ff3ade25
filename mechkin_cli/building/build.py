"""A checked file to its problem: units, parameters, links, joints, points, motion, loads,
tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from mechkin_cli.analysis.idle import spin_errors
from mechkin_cli.analysis.problem import Problem
from mechkin_cli.building.columns import build_tables, used_quantities
from mechkin_cli.building.coordinates import dimension_of, is_coordinate
from mechkin_cli.building.fields import Fields, Path, read_parameters, read_units
from mechkin_cli.building.joints import build_joints
from mechkin_cli.building.links import build_links
from mechkin_cli.building.loads import LoadBuilder
from mechkin_cli.building.motion import build_motion
from mechkin_cli.building.sizes import check_loops, check_memory
from mechkin_cli.building.source import Source
from mechkin_cli.diagnostics import Diagnostic, InvalidFile
from mechkin_cli.expressions.errors import nearest
from mechkin_cli.mechanism.model import GROUND_NAME, Attached, Joint, Link, Mechanism
from mechkin_cli.mechanism.motion import Assembly, Motion
from mechkin_cli.reading.parser import in_order
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.graph import SolverGraph, UnsolvableGraph, build_graph
from mechkin_cli.tables.layout import TableLayout, default_table
from mechkin_cli.units import LENGTH


class Built(NamedTuple):
    """The problem of a file, its solver graph (or why it cannot be solved as it is driven), its
    tables, and the source it names."""

    problem: Problem
    graph: SolverGraph | Diagnostic
    tables: tuple[TableLayout, ...]
    own_tables: bool
    source: str = ""


def build(source: Source) -> Built:
    """Builds everything that a file describes.

    Raises:
        InvalidFile: with every independent error, each at its line.
    """
    file, document = source.file, source.document
    units, wrong_units = read_units(document, _unit_texts(file.units))
    fields = Fields(document, units, diagnostics=wrong_units)
    read_parameters(fields, file.parameters)
    links = build_links(fields, file.links, "unphysical-inertia" in file.accept)
    pairs = _chain_pairs(file)
    links |= {name: Link(name) for _, name in pairs if name != GROUND_NAME and name not in links}
    joints = _joints(fields, file, links, pairs)
    points = {
        name: Attached(p.link, fields.vector(("points", name, "at"), p.at, LENGTH))
        for name, p in file.points.items()
        if _link_known(fields, ("points", name, "link"), p.link, links)
    }
    directions = {
        name: Attached(d.link, fields.direction(("directions", name, "vector"), d.vector))
        for name, d in file.directions.items()
        if _link_known(fields, ("directions", name, "link"), d.link, links)
    }
    motion = build_motion(fields, file.motion, joints)
    assembly = _assembly(fields, file.assembly, joints)
    mechanism = Mechanism(
        name=file.name or document.file,
        links=links,
        joints=joints,
        points=points,
        directions=directions,
    )
    problem = Problem(mechanism, motion, assembly, units, dict(fields.parameters))
    loads = LoadBuilder(fields, links, joints, points, problem.quantities())
    loads.add_all(file.loads)
    mechanism = replace(mechanism, loads=tuple(loads.loads), gravity=loads.gravity)
    problem = replace(problem, mechanism=mechanism, load_laws=loads.laws)
    tables = build_tables(fields, file.tables, problem.quantities())
    if not file.tables:
        names = [i.name for i in motion.inputs]
        tables = (default_table(mechanism.coordinates, names, timed=motion.time is not None),)
    check_memory(fields, mechanism, motion, tables)
    follow = _followed(fields, file.follow, joints)
    problem = replace(problem, hold_idle=file.idle == "hold", follow=follow)
    graph = _graph(fields, file, mechanism, motion)
    if isinstance(graph, SolverGraph) and needs_forces(problem, tables):
        for link, diagnostic in spin_errors(problem):
            place = fields.document.place(("links", link))
            fields.diagnostics.append(diagnostic._replace(place=place))
    errors = [d for d in fields.diagnostics if d.severity == "error"]
    if errors or graph is None:
        raise InvalidFile(in_order(fields.diagnostics))
    problem = replace(problem, diagnostics=tuple(in_order(fields.diagnostics)))
    return Built(problem, graph, tables, bool(file.tables), file.source or "")


def _followed(
    fields: Fields, names: tuple[str, ...] | None, joints: Mapping[str, Joint]
) -> tuple[str, ...] | None:
    for i, name in enumerate(names or ()):
        if name not in joints and not fields.is_refused(name):
            hint = nearest(name, list(joints))
            fields.error("unknown-joint", ("follow", i), f"there is no joint {name}", hint)
    return names


def needs_forces(problem: Problem, tables: Sequence[TableLayout]) -> bool:
    """Whether some column reads a force."""
    quantities = problem.quantities()
    wanted = [quantities[name] for name in used_quantities(tables, quantities)]
    return bool(demand_of(problem.mechanism, wanted) & Demand.FORCES)


def _unit_texts(section: object) -> dict[str, str]:
    names = ("length", "angle", "mass", "force", "time", "angular_rate")
    return {name: getattr(section, name) for name in names}


def _link_known(
    fields: Fields, path: tuple[str, ...], name: str, links: Mapping[str, object]
) -> bool:
    if name == GROUND_NAME or name in links:
        return True
    fields.refused.add(path[1])
    hint = nearest(name, [GROUND_NAME, *links])
    fields.error("unknown-link", path, f"there is no link {name}", hint)
    return False


def _joints(
    fields: Fields,
    file: MechanismFile,
    links: Mapping[str, Link],
    chain_pairs: Sequence[tuple[str, str]],
) -> dict[str, Joint]:
    """The joints of `joints:` and of `chain:`; every link must be joined to ground by them."""
    joints = build_joints(fields, file.joints, links)
    if chain_pairs:
        from mechkin_cli.building.chain import build_chain

        joints |= build_chain(fields, file.chain, chain_pairs)
    pairs = [(joint.links[0], joint.links[1]) for joint in file.joints.values()]
    _check_connected(fields, links, [*pairs, *chain_pairs])
    return joints


def _chain_pairs(file: MechanismFile) -> list[tuple[str, str]]:
    """The two links of every joint of the chain: each row's joint lies behind the link before."""
    return list(pairwise([GROUND_NAME, *(row.link for row in file.chain)]))


def _check_connected(
    fields: Fields, links: Mapping[str, object], pairs: Sequence[tuple[str, str]]
) -> None:
    """Every link must be joined, by way of others, to ground."""
    reached, grown = {GROUND_NAME}, True
    if any(name not in links and name != GROUND_NAME for pair in pairs for name in pair):
        return  # a misspelt link, reported at its joint
    while grown:
        before = len(reached)
        for first, second in pairs:
            if first in reached or second in reached:
                reached |= {first, second}
        grown = len(reached) > before
    for name in links:
        if name not in reached:
            fields.key_error(
                "disconnected-link",
                ("links", name),
                f"link {name} is not joined to ground, nor to a link that is",
                "add a joint, or remove the link",
            )


def _assembly(fields: Fields, section: object, joints: Mapping[str, Joint]) -> Assembly:
    if section is None:
        return Assembly()
    near = {}
    for name, text in section.near.items():  # type: ignore[attr-defined]
        path = ("assembly", "near", name)
        if is_coordinate(fields, path, name, joints):
            near[name] = fields.number(path, text, dimension_of(name.partition(".")[2]))
    return Assembly(near, section.mode, section.turns)  # type: ignore[attr-defined]


def _place_of(file: MechanismFile, joints: Sequence[str]) -> Path:
    """Where the first of some joints is written."""
    for i, row in enumerate(file.chain):
        if row.joint in joints[:1]:
            return ("chain", i, "joint")
    return ("joints", *joints[:1])


def _graph(
    fields: Fields, file: MechanismFile, mechanism: Mechanism, motion: Motion
) -> SolverGraph | Diagnostic | None:
    """The solver graph; only asked for when the parts are sound, to avoid follow-up errors."""
    if fields.error_count or not check_loops(fields, mechanism):
        return None
    try:
        return build_graph(mechanism, motion.driven)
    except UnsolvableGraph as error:
        path = ("motion", "inputs") if motion.inputs else _place_of(file, error.joints)
        return error.diagnostic._replace(place=fields.document.place(path))
