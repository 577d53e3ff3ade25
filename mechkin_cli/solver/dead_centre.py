"""Dead centres (folds): where the input stops moving while another coordinate goes on.

Near a fold the roles are exchanged: a coordinate that moves fast is driven and the input becomes
unknown. There the branch is regular, and the fold is the zero of d(input)/d(coordinate), found by
Newton with the second derivative from the same factorisation; never a minimum of a determinant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.session import Session


MOTION = Demand.VELOCITY | Demand.ACCELERATION


class Exchanged(NamedTuple):
    """The same mechanism with coordinate `driven` (a column) in place of input number `input`."""

    session: Session
    input: int
    input_column: int
    driven: int
    driven_state: int
    input_state: int

    def at(self, inputs: Floats, state: Floats, value: float) -> Batch:
        """Closes the loops with the driven coordinate at `value`; derivatives with respect to
        it."""
        values = inputs.copy()
        values[self.input] = value
        rates = np.zeros_like(values)
        rates[self.input] = 1.0
        zeros = np.zeros((values.size, 1))
        return self.session.run(
            values[:, None],
            state[:, None],
            rates=rates[:, None],
            accelerations=zeros,
            demand=MOTION,
            derivatives=True,
            iterations=2 * tolerances.NEWTON_ITERATIONS,
        )


class DeadCentre(NamedTuple):
    """A fold: the input's value there (kernel units), the states, and the shape of the branch
    about it.

    `first` and `second` are derivatives of all columns with respect to the exchanged coordinate;
    the input's first derivative is zero there.
    """

    exchanged: Exchanged
    inputs: Floats
    state: Floats
    first: Floats
    second: Floats

    @property
    def value(self) -> float:
        """The input at the dead centre."""
        return float(self.state[self.exchanged.input_state])

    def guess(self, value: float, towards: Floats) -> Floats | None:
        """States where the input has `value`, on the side of the fold where `towards` lies.

        None where the branch does not reach that value.
        """
        e = self.exchanged
        ratio = 2.0 * (value - self.value) / float(self.second[e.input_column])
        if ratio < 0.0:
            return None
        side = 1.0 if towards[e.driven_state] >= self.state[e.driven_state] else -1.0
        state, driven = self.state, float(self.state[e.driven_state])
        target = driven + side * float(np.sqrt(ratio))
        for _ in range(tolerances.DEAD_CENTRE_ITERATIONS):
            found = e.at(self.inputs, state, target)
            if not found.good[0] or found.first is None:
                return None
            state, driven = found.states[:, 0], target
            slope = float(found.first[e.input_column, 0])
            miss = float(state[e.input_state]) - value
            if slope == 0.0:
                break
            target = driven - miss / slope
            if abs(target - driven) <= tolerances.DEAD_CENTRE_STEP:
                break
        return state


def exchange(session: Session, number: int, first: Floats) -> Exchanged | None:
    """The mechanism driven by its fastest scalar coordinate instead of input `number`.

    `first` are the derivatives of the columns along the branch. None if there is no such
    coordinate.
    """
    graph, layout = session.graph, session.layout
    inputs = set(graph.inputs)
    candidates = []
    for k, edge in enumerate(graph.edges):
        for coordinate, freedom in edge.joint.type.scalars.items():
            if (k, freedom) not in inputs:
                speed = abs(float(first[layout.column(k, freedom)]))
                if speed >= tolerances.EXCHANGE_SPEED:
                    candidates.append((-speed, k, freedom, coordinate))
    input_edge, input_freedom = graph.inputs[number]
    for _, k, freedom, coordinate in sorted(candidates):
        other = session.exchanged(number, (graph.edges[k].joint.name, coordinate))
        if other is not None:
            return Exchanged(
                other,
                number,
                layout.column(input_edge, input_freedom),
                layout.column(k, freedom),
                layout.state(k, freedom),
                layout.state(input_edge, input_freedom),
            )
    return None


def locate(
    session: Session, number: int, inputs: Floats, state: Floats, first: Floats
) -> DeadCentre | None:
    """The dead centre of input `number` next to a place on the branch, or None if Newton finds
    none.

    Args:
        session: the mechanism as it is driven.
        number: the input that was moving.
        inputs: (inputs,) values at the place.
        state: (states,) there.
        first: (columns,) derivatives along the branch there.
    """
    exchanged = exchange(session, number, first)
    if exchanged is None:
        return None
    value = float(state[exchanged.driven_state])
    for _ in range(tolerances.DEAD_CENTRE_ITERATIONS):
        found = exchanged.at(inputs, state, value)
        if not found.good[0] or found.first is None or found.second is None:
            return None
        state = found.states[:, 0]
        slope = float(found.first[exchanged.input_column, 0])
        curvature = float(found.second[exchanged.input_column, 0])
        if curvature == 0.0:
            return None
        step = -slope / curvature
        if abs(step) <= tolerances.DEAD_CENTRE_STEP:
            fold = inputs.copy()
            fold[exchanged.input] = value
            return DeadCentre(exchanged, fold, state, found.first[:, 0], found.second[:, 0])
        value += max(-tolerances.DEAD_CENTRE_STRIDE, min(tolerances.DEAD_CENTRE_STRIDE, step))
    return None
