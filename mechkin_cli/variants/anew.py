"""A variant that is built anew, continued from the base variant all the same.

Where a recording does not hold (rows whose number depends on a parameter, loops that `follow:`
leaves out) the sessions on the way from the base's parameters (0) to the variant's (1) are built
one by one; the steps between them are those of every continuation (docs/numerics.md, Variants).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import choose_start
from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.kernel._kernel import Stepper
from mechkin_cli.plan import Layout
from mechkin_cli.session import Continued, Session, step_limits

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats
    from mechkin_cli.structure import SolverGraph


class AnewSession(Session):
    """The session of a variant that is built anew.

    Args:
        problem: the variant's problem.
        graph: its solver graph.
        base: the session of the file's own parameters.
        on_the_way: the session at a place between base (0) and variant (1).
    """

    def __init__(
        self,
        problem: Problem,
        graph: SolverGraph | None,
        base: Session,
        on_the_way: Callable[[float], Session],
    ) -> None:
        super().__init__(problem, graph, closed_at=base.closed_at, packing=base.packing)
        del self.continued  # found below when it is asked for
        self.base, self.on_the_way = base, on_the_way
        self.layout = _layout(self, base.layout.length)

    def derived(self, make: Callable[[Session], Problem]) -> Session:
        """As `Session.derived`, of the base and on the way, too."""
        base, on_the_way = self.base.derived(make), self.on_the_way
        other = AnewSession(make(self), None, base, lambda place: on_the_way(place).derived(make))
        other.text = self.text
        return other

    @cached_property
    def continued(self) -> Continued | None:  # type: ignore[override]
        """The base's first assembly brought here; None where it is to be chosen: the base has none,
        or another structure."""
        start = choose_start(self.base)
        if start.state is None or structure_of(self.graph) != structure_of(self.base.graph):
            return None
        rows = self.problem.motion.rows
        row = start.row if rows == self.base.problem.motion.rows else 0
        first, last = self.base.inputs.values[:, start.row], self.inputs.values[:, row]
        return Continued(self._brought(start.state, first, last), row)

    def _brought(self, state: Floats, first: Floats, last: Floats) -> Floats | None:
        """States at the end of the way from inputs to inputs; None where the branch ends before."""
        plans: dict[float, Plan] = {0.0: self.base.plan, 1.0: self.plan}
        structure, unit = structure_of(self.graph), self.layout.length

        def plan(place: float) -> Plan:
            if place not in plans:
                between = self.on_the_way(place)
                if structure_of(between.graph) != structure:
                    raise MechkinError("another structure on the way")
                plans[place] = _layout(between, unit).build()
            return plans[place]

        def at(place: float) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
            still = [0.0] * first.size
            return (first + place * (last - first)).tolist(), still, still

        limits = step_limits(tolerances.LONGEST_DIMENSION_STEP)
        try:
            node = Stepper.along(plan, at, True, limits).to_target(state.tolist())
        except MechkinError:
            return None  # what the file says does not hold somewhere on the way
        return None if node is None else np.array(node.state)


def _layout(session: Session, length: float) -> Layout:
    """How its mechanism lies in the kernel, with a length unit (m)."""
    problem = session.problem
    return Layout(problem.laid_mechanism, session.graph, length, problem.laws)


def structure_of(graph: SolverGraph) -> object:
    """What two graphs of the same structure have in common."""
    edges = tuple((edge.joint.name, edge.parent, edge.child) for edge in graph.edges)
    closings = tuple((closing.joint.name, closing.loop) for closing in graph.closings)
    return edges, closings, graph.blocks, graph.inputs
