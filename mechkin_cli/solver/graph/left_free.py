"""Whether something can move at assembled places while some coordinates rest.

Where constraints are redundant, counting equations does not tell; the rank of the loops' screws at
places where they are closed does.
"""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.mechanism.model import GROUND_NAME, Mechanism
from mechkin_cli.solver.graph.build import build_graph
from mechkin_cli.solver.graph.network import connections_of
from mechkin_cli.solver.graph.rates import Rates, unit_of
from mechkin_cli.solver.reduction import reduce


def left_free(mechanism: Mechanism, inputs: Mapping[tuple[str, str], float]) -> list[bool]:
    """For each assembled place whether some link can move while the inputs rest; none where no
    place is found, or the ranks would take too long.

    Args:
        mechanism: with pairs that hold idle freedoms.
        inputs: (joint, coordinate) that rest, and where (rad, m).
    """
    from mechkin_cli.solver.assembled_places import closed_places

    whole, names, at = reduce(mechanism), list(inputs), list(inputs.values())
    connections = connections_of(mechanism, whole, names)
    driven = {(name, mechanism.joints[name].freedom_number(c)) for name, c in inputs}
    unit, found = unit_of(mechanism), []
    for poses in closed_places(mechanism, lambda: build_graph(mechanism, names), at):
        rates = Rates(poses, driven, unit)
        still = rates.still(whole.links, connections, {GROUND_NAME})
        if rates.work:
            found.append(set(whole.links) > still)
    return found
