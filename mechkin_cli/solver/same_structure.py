"""A solver graph carried over to a mechanism of the same structure and other dimensions."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.mechanism.legs import Leg
from mechkin_cli.mechanism.model import Joint, Mechanism
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.reduction import reduce


def graph_of(mechanism: Mechanism, graph: SolverGraph) -> SolverGraph:
    """The graph with the joints and legs of `mechanism` in the places of those with their names."""
    reduction = reduce(mechanism)
    joints = {**mechanism.joints, **reduction.joints}
    legs = {leg.body: leg for leg in reduction.legs}

    def renewed(joint: Joint) -> Joint:
        other = joints.get(joint.name)  # the weld of a cut link has no dimensions
        return joint if other is None else other._replace(first=joint.first, second=joint.second)

    edges = tuple(edge._replace(joint=renewed(edge.joint)) for edge in graph.edges)
    closings = tuple(
        closing._replace(joint=renewed(closing.joint), leg=_leg(closing.leg, legs))
        for closing in graph.closings
    )
    return graph._replace(edges=edges, closings=closings)


def _leg(leg: Leg | None, legs: Mapping[str, Leg]) -> Leg | None:
    return None if leg is None else legs[leg.body]
