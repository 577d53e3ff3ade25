"""The spanning tree from ground and the loops that its closings make with it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mechkin_cli.mechanism.legs import Leg
from mechkin_cli.mechanism.model import GROUND_NAME, Joint
from mechkin_cli.solver.graph.records import Closing, TreeEdge
from mechkin_cli.solver.reduction import Reduction


def spanning_tree(whole: Reduction, closing: Iterable[str]) -> list[TreeEdge] | None:
    """Edges from ground outward, breadth first, the legs last; None if no tree is left."""
    names = set(closing)
    free = [joint for name, joint in whole.joints.items() if name not in names]
    at: dict[str, list[Joint]] = {}
    for joint in free:
        at.setdefault(joint.first, []).append(joint)
        at.setdefault(joint.second, []).append(joint)
    reached = {GROUND_NAME}
    edges: list[TreeEdge] = []
    front = [GROUND_NAME]
    for link in front:
        for joint in at.get(link, ()):
            other = joint.second if link == joint.first else joint.first
            if other not in reached:
                reached.add(other)
                edges.append(TreeEdge(joint, link, other))
                front.append(other)
    if len(edges) != len(free) or len(reached) != len(whole.links) + 1:
        return None
    for leg in whole.legs:
        edges.append(TreeEdge(leg.start, leg.first, leg.body, hung=True))
        if leg.slide is not None and leg.rod is not None:
            edges.append(TreeEdge(leg.slide, leg.body, leg.rod))
    return edges


class Ways:
    """Ways through a tree."""

    def __init__(self, edges: Sequence[TreeEdge]) -> None:
        self.edges = edges
        self.carrier = {edge.child: k for k, edge in enumerate(edges)}
        self.depth = {GROUND_NAME: 0}
        for edge in edges:
            self.depth[edge.child] = self.depth[edge.parent] + 1
        self.number = {edge.joint.name: k for k, edge in enumerate(edges) if not edge.hung}

    def closing(self, joint: Joint) -> Closing:
        """A joint that closes a loop."""
        return Closing(joint, self._loop(joint.first, joint.second))

    def leg(self, leg: Leg) -> Closing:
        """A leg that closes one."""
        slides = [(self.number[leg.slide.name], -1)] if leg.slide is not None else []
        return Closing(leg.end, (*self._loop(leg.first, leg.second), *slides), leg)

    def _loop(self, one: str, other: str) -> tuple[tuple[int, int], ...]:
        """Edges from where the ways part to the other link (+1), then to the one (-1)."""
        first: list[tuple[int, int]] = []
        second: list[tuple[int, int]] = []
        while one != other:
            if self.depth[one] >= self.depth[other]:
                first.append((self.carrier[one], -1))
                one = self.edges[self.carrier[one]].parent
            else:
                second.append((self.carrier[other], 1))
                other = self.edges[self.carrier[other]].parent
        return (*reversed(second), *reversed(first))
