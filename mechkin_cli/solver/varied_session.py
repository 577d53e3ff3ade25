"""The session of one variant: the base's structure with other constants."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel._kernel import VariantEnd
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import Readout
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.same_structure import graph_of
from mechkin_cli.solver.session import Continued, Session

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.model import Attached
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.variation import FirstAssembly, Variation


class VariedSession(Session):
    """A session whose first assembly is continued from the base's.

    Args:
        variation: how the base depends on the parameters.
        values: (parameters,) of the variant, in SI.
        problem: its problem.
        start: the base's first assembly.
    """

    def __init__(
        self, variation: Variation, values: Floats, problem: Problem, start: FirstAssembly
    ) -> None:
        base = variation.base
        self.__dict__.update(base.__dict__)
        self.variation = variation
        self.values = values
        self.problem = problem
        self.graph = graph_of(problem.solved_mechanism, base.graph)
        for found in ("plan", "layout", "inputs", "route"):
            self.__dict__.pop(found, None)
        self._readouts, self._kept, self._own = {}, {}, {}
        end, size, state = variation.reading(()).runs(Demand.POSITION, start).start(values)
        lost = end != VariantEnd.COMPLETE
        self.continued = Continued(None if lost else np.asarray(state), start.row)
        self.size = base.size if lost else size
        self.layout = Layout(problem.laid_mechanism, self.graph, base.layout.length, problem.laws)
        self.plan = variation.plan(values, start.size if lost else size)
        self.inputs = variation.inputs(values)

    def readout(self, wanted: Iterable[Wanted], points: Iterable[Attached] = ()) -> Readout:
        """As `Session.readout`; constants of quantities are replayed."""
        wanted, points = tuple(wanted), tuple(points)
        key = (tuple(quantity.name for quantity in wanted), points)
        if points or key in self._readouts:
            return super().readout(wanted, points)
        reading = self.variation.reading(wanted)
        found = reading.readout._replace(outputs=reading.outputs(self.values))
        self._readouts[key] = found
        return found
