"""Why a path ends where it does, and the session that goes on where that is a dead centre: one in
which a joint coordinate is driven in place of one input, which is found instead.

Near a dead centre of the input the branch is a function of the coordinate, and not of the input.
Tree, states and columns are those of the session that it was made of.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import PassageEnd
from mechkin_cli.record import NamedTuple
from mechkin_cli.session.following import (
    BranchFold,
    BranchPoint,
    Followed,
    Runaway,
    find_runaway,
    step_limits,
)
from mechkin_cli.session.kernel_run import Ask, RowInputs
from mechkin_cli.session.session import Session
from mechkin_cli.structure import exchanged
from mechkin_cli.tolerances import FREE_INPUT_MISS, FREE_INPUT_STEP

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


def find_limit(session: Session, followed: Followed) -> BranchFold | Runaway | BranchPoint | None:
    """What ended a branch, or None where it is not known."""
    found = followed.ending
    if found is not None and found.kind == PassageEnd.DEAD_CENTRE:
        return BranchFold(found.inputs, found.state, found.inputs_beyond, found.beyond)
    runaway = find_runaway(session.layout, followed.state)
    if runaway is None and found is not None and found.kind == PassageEnd.BRANCH_POINT:
        return BranchPoint(found.inputs, found.state)
    return runaway


def moves_freely(session: Session, inputs: Floats, state: Floats) -> bool:
    """Whether the loops still close, to third order, a little further on each input in turn, with
    the others held; False also where the rates are not known, as next to a dead centre.

    Args:
        session: the mechanism as it is driven.
        inputs: (inputs,) in kernel units.
        state: (states,) closed there.
    """
    limits = step_limits()
    for number in range(inputs.size):
        direction = np.zeros(inputs.size)
        direction[number] = 1.0
        stepper = _kernel.Stepper.straight(
            session.plan, inputs.tolist(), direction.tolist(), limits
        )
        node = stepper.close(0.0, state.tolist())
        if node is None:
            return False
        guess = np.asarray(stepper.predict(node, FREE_INPUT_STEP))[:, None]
        moved = (inputs + FREE_INPUT_STEP * direction)[:, None]
        batch = session.run(RowInputs(moved, guess), Ask(iterations=0))
        if not batch.residual[0] <= FREE_INPUT_MISS:
            return False
    return True


class ExchangedCoordinate(NamedTuple):
    """A coordinate that the mechanism is driven by or solved for: (edge, freedom), (joint,
    coordinate), its column and state, and whether a full turn of it is the same place."""

    at: tuple[int, int]
    name: tuple[str, str]
    column: int
    state: int
    is_cyclic: bool


class Exchanged(NamedTuple):
    """A session, and what was exchanged in it: the input `number` is now the coordinate `driven`,
    and `freed` is found."""

    session: Session
    number: int
    driven: ExchangedCoordinate
    freed: ExchangedCoordinate


def exchange(session: Session, number: int, block: int, first: Floats) -> Exchanged | None:
    """The session driven at that unknown of a block which moves most, in place of input `number`;
    None where all unknowns of the block are turns of balls.

    Args:
        session: the mechanism as it is driven.
        number: of the input.
        block: the one that has a dead centre.
        first: derivatives of the columns along the branch (columns,).
    """
    graph = session.graph
    unknowns = [_scalar(session, at) for at in graph.blocks[block].unknowns]
    scalars = [unknown for unknown in unknowns if unknown is not None]
    freed = _scalar(session, graph.inputs[number])
    if not scalars or freed is None:
        return None
    driven = max(scalars, key=lambda unknown: abs(float(first[unknown.column])))
    other = exchanged(graph, number, driven.at, driven.name)
    found = session.exchanged(other)
    return Exchanged(found, number, driven, freed)


def _scalar(session: Session, at: tuple[int, int]) -> ExchangedCoordinate | None:
    """A freedom of the tree as a coordinate; None for one of a ball."""
    layout, (edge, freedom) = session.layout, at
    joint = session.graph.edges[edge].joint
    kernel_joint, local = layout.carrier_of(edge, freedom)
    kind = layout.carriers[kernel_joint].part.type
    if kind.is_ball:
        return None
    names = [name for name, of in joint.type.scalars.items() if of == freedom]
    unnamed = f"{'slide' if kind.slides[local] else 'turn'} {freedom}"
    name = (joint.name, names[0] if names else unnamed)
    column, state = layout.column(edge, freedom), layout.state(edge, freedom)
    return ExchangedCoordinate(at, name, column, state, kind.freedoms[local].is_cyclic)
