"""From a mechanism and its inputs to its solver graph."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from mechkin_cli.mechanism.model import GROUND_NAME, Mechanism
from mechkin_cli.solver.graph import errors
from mechkin_cli.solver.graph.assur import Group, Undriven, assur_groups
from mechkin_cli.solver.graph.blocks import NothingSolved, in_order, lay_blocks
from mechkin_cli.solver.graph.components import biconnected
from mechkin_cli.solver.graph.network import Connection, connections_of, distances, incidence
from mechkin_cli.solver.graph.rates import Rates, unit_of
from mechkin_cli.solver.graph.records import SolverGraph, TreeEdge, UnsolvableGraph
from mechkin_cli.solver.graph.regions import order_of
from mechkin_cli.solver.graph.tree_edges import Ways, spanning_tree
from mechkin_cli.solver.graph.trees import NothingCloses, closings_of, tree_depths
from mechkin_cli.solver.reduction import Reduction, cut_link, reduce


def build_graph(
    mechanism: Mechanism,
    inputs: Sequence[tuple[str, str]],
    closed_at: Sequence[str] | None = None,
) -> SolverGraph:
    """The solver graph of a mechanism whose `inputs` (joint, coordinate) are driven.

    `closed_at` forces the closing joints (one per independent loop).

    Raises:
        UnsolvableGraph: links not connected to ground, no joint to close a loop at, undriven or
            overconstrained loops.
    """
    return _built(mechanism, inputs, closed_at, _Places(mechanism, inputs))


class _Places:
    """The rates at places where a mechanism is assembled, each found when it is asked for."""

    def __init__(self, mechanism: Mechanism, inputs: Sequence[tuple[str, str]]) -> None:
        self._sought = self._seek(mechanism, inputs)
        self._found: list[Rates] = []

    def __iter__(self) -> Iterator[Rates]:
        yield from self._found
        for rates in self._sought:
            self._found.append(rates)
            yield rates

    @staticmethod
    def _seek(mechanism: Mechanism, inputs: Sequence[tuple[str, str]]) -> Iterator[Rates]:
        from mechkin_cli.solver.assembled_places import assembled_places

        def coarse() -> SolverGraph:
            return _built(mechanism, inputs, None, ())

        joints = mechanism.joints
        driven = {(name, joints[name].freedom_number(c)) for name, c in inputs}
        unit = unit_of(mechanism)
        for poses in assembled_places(mechanism, coarse):
            yield Rates(poses, driven, unit)


def _built(
    mechanism: Mechanism,
    inputs: Sequence[tuple[str, str]],
    closed_at: Sequence[str] | None,
    places: Iterable[Rates],
) -> SolverGraph:
    """As `build_graph`; without places whatever has too many equations is one block."""
    whole = reduce(mechanism)
    while True:
        connections = connections_of(mechanism, whole, inputs)
        groups = _groups(mechanism, whole, connections, inputs, places)
        try:
            names = _closing_names(whole, groups) if closed_at is None else list(closed_at)
            return _laid(mechanism, whole, groups, names, inputs)
        except NothingCloses as loop:
            whole = _cut(mechanism, whole, connections, loop.connections)
        except NothingSolved as block:
            if closed_at is not None:
                raise errors.driven_solid(block.connections, block.equations) from None
            whole = _cut(mechanism, whole, connections, _carried_loop(block, connections))


def _groups(
    mechanism: Mechanism,
    whole: Reduction,
    connections: Sequence[Connection],
    inputs: Sequence[tuple[str, str]],
    places: Iterable[Rates],
) -> list[Group]:
    """The Assur groups of all components, each after those that it hangs on."""
    components = biconnected(connections, incidence(connections), GROUND_NAME)
    reached = {link for component in components for link in component.links}
    if apart := [link for link in whole.links if link not in reached]:
        raise errors.disconnected(apart)
    found: list[Group] = []
    loose: list[Undriven] = []
    for component in components:
        groups, undriven = assur_groups(component, places)
        found += groups
        if undriven is not None:
            loose.append(undriven)
    if loose:
        raise errors.undriven(mechanism, inputs, loose)
    return found


def _closing_names(whole: Reduction, groups: Sequence[Group]) -> list[str]:
    """The closing joints of all groups: fewest equations first, then as written."""
    depth = {GROUND_NAME: 0}
    chosen: dict[str, int] = {}
    for group in groups:
        some = {c.name: c.equations for c in closings_of(group, depth)}
        tree = [c for c in group.connections if c.leg is None and c.name not in some]
        depth.update(tree_depths(tree, depth))
        chosen.update(some)
    written = [name for name in whole.joints if name in chosen]
    return sorted(written, key=chosen.__getitem__)


def _carried_loop(block: NothingSolved, connections: Sequence[Connection]) -> list[Connection]:
    """A loop that its closing joint alone would have to follow, with that joint as an unknown.

    Raises:
        UnsolvableGraph: a closing joint does not follow the inputs as they are drawn, or there is
            none.
    """
    named = {c.name: c for c in connections}
    found: list[Connection] = []
    for names in block.loops:
        own, *around = loop = [named[name] for name in names]
        are_inputs = all(c.driven == c.freedoms for c in around)
        if are_inputs and order_of(loop) > order_of([own]):
            raise errors.driven_solid(block.connections, block.equations)
        if not found and own.freedoms:
            found = loop
    if not found:
        raise errors.driven_solid(block.connections, block.equations)
    return found


def _cut(
    mechanism: Mechanism,
    whole: Reduction,
    connections: Sequence[Connection],
    loop: Sequence[Connection],
) -> Reduction:
    """With the link of the loop that is farthest from ground cut in two halves."""
    members = {c.name for c in loop}
    names = [name for name in whole.joints if name in members]
    ends = [link for c in loop for link in (c.first, c.second)]
    inside = [link for link in whole.links if ends.count(link) == 2]
    if not inside:
        raise errors.no_closing_joint(mechanism.name, names)
    away = distances(connections, incidence(connections), GROUND_NAME)
    return cut_link(whole, max(inside, key=away.__getitem__), names)


def _laid(
    mechanism: Mechanism,
    whole: Reduction,
    groups: Sequence[Group],
    names: Sequence[str],
    inputs: Sequence[tuple[str, str]],
) -> SolverGraph:
    """Tree, closings and blocks for chosen closing joints."""
    names = [name for name in names if name in whole.joints]
    edges = spanning_tree(whole, names)
    if edges is None:
        raise errors.no_closing_joint(mechanism.name, tuple(mechanism.joints))
    ways = Ways(edges)
    driven = []
    for name, coordinate in inputs:
        if name not in ways.number:
            raise errors.input_closes(name)
        k = ways.number[name]
        driven.append((k, edges[k].joint.freedom_number(coordinate)))
    closings = {name: ways.closing(whole.joints[name]) for name in names}
    closings |= {leg.end.name: ways.leg(leg) for leg in whole.legs}
    place = {name: k for k, name in enumerate(closings)}
    order = in_order(groups, edges, place)
    laid, blocks, solved = lay_blocks(order, edges, closings, place, driven)
    everything = {(k, f) for k, e in enumerate(edges) for f in range(e.freedoms)}
    short = any(len(block.unknowns) > block.equations for block in blocks)
    if short or everything - solved:
        raise _left_over(mechanism, groups, inputs, edges, everything - solved)
    return SolverGraph(tuple(edges), tuple(laid), tuple(blocks), tuple(driven), tuple(inputs))


def _left_over(
    mechanism: Mechanism,
    groups: Sequence[Group],
    inputs: Sequence[tuple[str, str]],
    edges: Sequence[TreeEdge],
    unknown: set[tuple[int, int]],
) -> UnsolvableGraph:
    """Freedoms in no loop's way."""
    names = {edges[k].joint.name for k, _ in unknown}
    members = [c for group in groups for c in group.connections]
    concerned = tuple(c for c in members if c.name in names) or tuple(members)
    return errors.undriven(mechanism, inputs, [Undriven(concerned, max(1, len(unknown)))])
