"""Assur groups: the smallest sets of links that are placed together, in order.

In a component whose screws have order d, every link has d freedoms against the component's entry,
and a joint of f freedoms has d - f equations between its links, one more for every input; another
constraint has its own. The Dulmage-Mendelsohn parts of that system are the Assur groups, whatever
tree is laid through them later (Assur 1914; for the matching Shai 2010). Regions of lower order
(regions.py) have their own count: `d_r` freedoms a link beside the pose of the region's frame.

What the screws as drawn leave undetermined is counted once more with all freedoms of a link: a
drawing can be special, and the dimensions of an overconstrained loop decide later. If that is
enough, all that hangs together is one group; what is undetermined even then is not driven.

Where there are more equations than freedoms, all this only proposes groups: ranks decide (`rank`).

Couplings are no edges of the network. Each takes up one of the freedoms that its joints' components
lack drives for (`coupled_groups`); what two of them say of each other is solved together.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mechkin_cli import tolerances
from mechkin_cli.structure.matching import Matching, Row
from mechkin_cli.structure.network import (
    Connection,
    Region,
    Subgraph,
    depths,
    find_regions,
    incidence,
    order_of,
)
from mechkin_cli.structure.rank import Rates, determined_sets

Undriven = tuple[tuple[Connection, ...], int]
"""Connections whose freedoms are not all determined, and how many more inputs they need."""


def assur_groups(
    component: Subgraph, places: Iterable[Rates]
) -> tuple[list[Subgraph], Undriven | None]:
    """The groups of a component in order, and what nothing drives.

    `places` are read only where there are too many equations: the rates at places where the
    mechanism is assembled, of which the first that determines everything decides.
    """
    if component.loops < 2:
        # one loop, or one connection in no loop
        unknown = sum(c.freedoms - c.driven for c in component.connections)
        missing = unknown - component.space * component.loops
        if missing > 0:
            return [], (component.connections, missing)
        return [component], None
    order = order_of(component.connections)
    system = _System(component, order, [])
    is_redundant = system.matching.is_redundant
    if order > 3 and is_redundant:
        system = _System(component, order, find_regions(component, order))
    groups = system.groups()
    placed = {link for group in groups for link in group.links}
    rest = _rest(component, placed)
    if rest is not None:
        loose = _System(rest, rest.space, []).undriven()
        if loose is not None:
            return groups, (_own_names(component, loose[0]), loose[1])
        groups += _pieces(component, rest)
    return _determined(component, groups, places) if is_redundant else groups, None


def coupled_groups(
    components: Sequence[Subgraph],
    found: Sequence[tuple[list[Subgraph], Undriven | None]],
    couplings: Sequence[Connection],
) -> tuple[list[Subgraph], list[Undriven]]:
    """The groups of all components with the couplings, and what nothing drives then.

    A component that nothing drives is one group with the couplings that drive it. A coupling that
    drives none is redundant: the groups of its joints are solved together with it.

    Args:
        components: each after the one that it hangs on.
        found: their own groups, as `assur_groups` gives them.
        couplings: their joints are among the components' connections.
    """
    number = {
        name: k
        for k, part in enumerate(components)
        for c in part.connections
        for name in c.constraint.joints
    }
    members = [sorted({number[t.joint.name] for t in c.constraint.terms}) for c in couplings]
    short = [0 if undriven is None else undriven[1] for _, undriven in found]
    matching = Matching(
        short, [Row(c.equations, tuple(m)) for c, m in zip(couplings, members, strict=True)]
    )
    if left := sum(matching.free):
        loose = [found[k][1] for k in sorted(matching.undetermined())]
        touched = tuple(c for undriven in loose if undriven is not None for c in undriven[0])
        return [], [(touched, left)]
    groups: list[Subgraph] = []
    for k, (part, (own, undriven)) in enumerate(zip(components, found, strict=True)):
        if undriven is None:
            groups += own
            continue
        driving = tuple(couplings[row] for row in matching.taken[k])
        groups.append(Subgraph(part.entry, part.links, (*part.connections, *driving)))
    placed = {c.name for group in groups for c in group.connections}
    for c in couplings:
        if c.name not in placed:
            groups = _joined_by(groups, c)
    return groups, []


def _joined_by(groups: Sequence[Subgraph], coupling: Connection) -> list[Subgraph]:
    """The groups of a coupling's joints as one with it, in the place of the first."""
    joints = {term.joint.name for term in coupling.constraint.terms}
    inside = [any(joints & set(c.constraint.joints) for c in group.connections) for group in groups]
    own = [group for group, member in zip(groups, inside, strict=True) if member]
    links = tuple(link for group in own for link in group.links)
    connections = tuple(c for group in own for c in group.connections)
    whole = Subgraph(own[0].entry, links, (*connections, coupling))
    first = inside.index(True)
    others = [group for group, member in zip(groups, inside, strict=True) if not member]
    return [*others[:first], whole, *others[first:]]


def _determined(
    component: Subgraph, proposed: Sequence[Subgraph], places: Iterable[Rates]
) -> list[Subgraph]:
    """The groups by ranks; what they leave open is solved together."""
    best: tuple[list[tuple[str, ...]], tuple[str, ...]] | None = None
    for rates in places:
        sets, left = determined_sets(component, [group.links for group in proposed], rates)
        if best is None or len(left) < len(best[1]):
            best = sets, left
        if not best[1]:
            break
    if best is None:
        return [component]
    return _with_connections(component, [*best[0], *([best[1]] if best[1] else [])])


def _with_connections(component: Subgraph, sets: Iterable[tuple[str, ...]]) -> list[Subgraph]:
    """Sets of links as groups, each with the connections that its links are the last to reach;
    own slides of constraints come by themselves."""
    groups: list[Subgraph] = []
    inside = {component.entry}
    waiting = list(component.connections)
    for links in sets:
        inside.update(links)
        reached = [c for c in waiting if c.first in inside and c.second in inside]
        waiting = [c for c in waiting if c.first not in inside or c.second not in inside]
        slides = [c for c in reached if c.own_unknowns]
        members = tuple(c for c in reached if c not in slides)
        own = set(links)
        ordered = tuple(link for link in component.links if link in own)
        groups.append(Subgraph(component.entry, ordered, members))
        groups += [Subgraph(component.entry, (), (c,)) for c in slides]
    return groups


def _rest(component: Subgraph, placed: set[str]) -> Subgraph | None:
    """The component with what is placed put into its entry; None if nothing is left."""
    if len(placed) == len(component.links):
        return None

    def of(link: str) -> str:
        return component.entry if link in placed else link

    moved = [c._replace(first=of(c.first), second=of(c.second)) for c in component.connections]
    return Subgraph.of(component.entry, tuple(c for c in moved if c.first != c.second))


def _pieces(component: Subgraph, rest: Subgraph) -> list[Subgraph]:
    """What hangs together without the entry, each as one group."""
    at = incidence(rest.connections)
    pieces: list[Subgraph] = []
    seen = {rest.entry}
    for start in rest.links:
        if start in seen:
            continue
        front, members = [start], set[int]()
        seen.add(start)
        for link in front:
            members.update(at[link])
            ends = [rest.connections[k].other(link) for k in at[link]]
            more = [other for other in dict.fromkeys(ends) if other not in seen]
            seen.update(more)
            front += more
        own = _own_names(component, [rest.connections[k] for k in members])
        pieces.append(Subgraph(component.entry, tuple(front), own))
    return pieces


def _own_names(component: Subgraph, connections: Sequence[Connection]) -> tuple[Connection, ...]:
    """The same connections as they are in the component."""
    names = {c.name for c in connections}
    return tuple(c for c in component.connections if c.name in names)


class _System:
    """Nodes and rows of a component: links, frames of regions, own slides."""

    def __init__(self, component: Subgraph, order: int, regions: Sequence[Region]) -> None:
        self.component, self.order, self.regions = component, order, regions
        self.capacities: list[int] = []
        self.own: dict[str, tuple[int, ...]] = {component.entry: ()}
        self.home: dict[str, int] = {}
        self.frames: dict[int, tuple[int, ...]] = {}
        self.region_of: dict[int, int] = {}
        self._add_nodes()
        self.rows: list[Row] = [self._row(k) for k in range(len(component.connections))]
        for r in range(len(regions)):
            self._add_memberships(r)
        self.matching = Matching(self.capacities, self.rows)
        if self.matching.is_redundant:
            turns = self._turns()
            # nodes by the turns of all rows at each
            at: list[list[int]] = [[] for _ in self.capacities]
            for row, turn in sorted(zip(self.rows, turns, strict=True), key=lambda pair: pair[1]):
                for node in row.nodes:
                    at[node].append(turn)
            self.rows = [
                row._replace(nodes=tuple(sorted(row.nodes, key=at.__getitem__)))
                for row in self.rows
            ]
            self.matching = Matching(self.capacities, self.rows, turns)

    def _node(self, capacity: int) -> int:
        self.capacities.append(capacity)
        return len(self.capacities) - 1

    def _add_nodes(self) -> None:
        for r, region in enumerate(self.regions):
            for link in region.links:
                self.home.setdefault(link, r)
            for number in region.connections:
                self.region_of.setdefault(number, r)
        for r, region in enumerate(self.regions):
            held = self.component.entry in region.links
            self.frames[r] = () if held else (self._node(self.order - region.order),)
        for link in self.component.links:
            home = self.home.get(link)
            order = self.order if home is None else self.regions[home].order
            self.own[link] = (self._node(order),)

    def _pose(self, link: str) -> set[int]:
        """Nodes that place a link."""
        r = self.home.get(link) if link != self.component.entry else None
        return {*self.own[link], *(self.frames[r] if r is not None else ())}

    def _row(self, number: int) -> Row:
        """The equations of a connection."""
        c = self.component.connections[number]
        if not c.has_coordinates:
            nodes = self._pose(c.first) | self._pose(c.second)
            nodes |= {self._node(1) for _ in range(c.own_unknowns)}
            return Row(c.equations, tuple(sorted(nodes)))
        if number not in self.region_of:
            nodes, order = self._pose(c.first) | self._pose(c.second), self.order
        else:
            r = self.region_of[number]
            order, nodes = self.regions[r].order, set()
            for link in (c.first, c.second):
                at_home = self.home[link] == r or link == self.component.entry
                nodes |= set(self.own[link]) if at_home else self._pose(link) | {*self.frames[r]}
        return Row(max(0, order - c.freedoms) + c.driven, tuple(sorted(nodes)))

    def _add_memberships(self, r: int) -> None:
        """What keeps links that are at home elsewhere in a region's frame, unless their joints
        do."""
        region = self.regions[r]
        entry = self.component.entry
        guests = sorted(link for link in region.links if self.home[link] != r or link == entry)
        if not guests:
            return
        held = {link: link for link in guests}

        def root(link: str) -> str:
            while held[link] != link:
                link = held[link]
            return link

        for number in sorted(region.connections):
            c = self.component.connections[number]
            if self.region_of[number] < r and c.first in held and c.second in held:
                held[root(c.first)] = root(c.second)
        tops = {root(link) for link in guests}
        if entry in held:
            tops.discard(root(entry))
        for link in sorted(tops):
            nodes = self._pose(link) | {*self.frames[r]}
            self.rows.append(Row(self.order - region.order, tuple(sorted(nodes))))

    def _turns(self) -> list[int]:
        """Turns of the rows, by the place of the connections; memberships come last."""
        kinds = [
            (
                not c.has_coordinates,
                c.freedoms,
                c.driven,
                c.constraint.kind,
                row.equations,
                len(row.nodes),
            )
            for c, row in zip(self.component.connections, self.rows, strict=False)
        ]
        place = {number: k for k, number in enumerate(_by_structure(self.component, kinds))}
        return [place.get(number, number) for number in range(len(self.rows))]

    def groups(self) -> list[Subgraph]:
        """The groups of what is determined, in order."""
        parts = self.matching.parts(self.matching.undetermined())
        rank = {node: k for k, part in enumerate(parts) for node in part}
        links: list[list[str]] = [[] for _ in parts]
        for link in self.component.links:
            if self.own[link][0] in rank:
                links[rank[self.own[link][0]]].append(link)
        members: list[list[Connection]] = [[] for _ in parts]
        for number, c in enumerate(self.component.connections):
            nodes = self.rows[number].nodes
            ends = [k for link in (c.first, c.second) for k in self._pose(link)]
            if all(node in rank for node in (*nodes, *ends)):
                members[max(rank[node] for node in (*nodes, *ends))].append(c)
        entry = self.component.entry
        groups = zip(links, members, strict=True)
        return _attached([Subgraph(entry, tuple(some), tuple(by)) for some, by in groups])

    def undriven(self) -> Undriven | None:
        """What the equations do not determine."""
        loose = self.matching.undetermined()
        if not loose:
            return None
        pairs = zip(self.component.connections, self.rows, strict=False)
        touched = tuple(c for c, row in pairs if loose & {*row.nodes})
        return touched, sum(self.matching.free)


def _attached(groups: Sequence[Subgraph]) -> list[Subgraph]:
    """Joins a group to the next where it does not hang on what is placed before it.

    By number a stiff frame determines itself, wherever it is.
    """
    attached: list[Subgraph] = []
    placed: set[str] = set()
    waiting: Subgraph | None = None
    for one in groups:
        group = one if waiting is None else _together(waiting, one)
        waiting = None if _hangs(group, placed) else group
        if waiting is None:
            attached.append(group)
            placed.update(group.links)
    if waiting is not None:
        attached.append(_together(attached.pop(), waiting) if attached else waiting)
    return attached


def _together(one: Subgraph, other: Subgraph) -> Subgraph:
    return Subgraph(one.entry, one.links + other.links, one.connections + other.connections)


def _hangs(group: Subgraph, placed: set[str]) -> bool:
    """Whether joints lead from placed links to all links of a group, which moves something."""
    if not group.links:
        # it only places its own slide
        return all(c.constraint.slides for c in group.connections)
    waiting = set(group.links)
    joints = [c for c in group.connections if c.has_coordinates]
    at = incidence(joints)
    front = [link for link in at if link not in waiting and (link in placed or link == group.entry)]
    for link in front:
        for number in at[link]:
            other = joints[number].other(link)
            if other in waiting:
                waiting.discard(other)
                front.append(other)
    return not waiting


def _by_structure(component: Subgraph, kinds: Sequence[tuple[object, ...]]) -> list[int]:
    """Connections by their distance from the entry, then by type and surroundings.

    The order in which they are written decides only between connections that are otherwise
    indistinguishable (colour refinement; Weisfeiler, Leman 1968).
    """
    connections = component.connections
    at = incidence(connections)
    away = depths(connections, {component.entry: 0})
    color, count = dict(away), 0
    for _ in range(tolerances.REFINEMENT_ROUNDS):
        seen = {}
        for link, own in color.items():
            ends = ((*kinds[k], color[connections[k].other(link)]) for k in at[link])
            seen[link] = (own, *sorted(ends))
        ranks = {value: k for k, value in enumerate(sorted(set(seen.values())))}
        color = {link: ranks[value] for link, value in seen.items()}
        if len(ranks) == count:
            break
        count = len(ranks)

    def key(number: int) -> tuple[object, ...]:
        c = connections[number]
        far = sorted((away[c.first], away[c.second]), reverse=True)
        ends = sorted((color[c.first], color[c.second]))
        return (*far, *kinds[number], *ends)

    return sorted(range(len(connections)), key=key)
