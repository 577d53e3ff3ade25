"""A session in which a joint coordinate is driven in place of one input, which is found instead.

Near a dead centre of the input the branch is a function of the coordinate, and not of the input.
Tree, states and columns are those of the session that it was made of.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.record import NamedTuple
from mechkin_cli.session.session import Session
from mechkin_cli.structure import exchanged

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


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


# Places where a mechanism is assembled, next to its drawing, to take ranks at.
#
# The drawing itself if it is assembled; else what Newton's method makes of it, all loops of a
# component in one block. A drawing may be a special position, so places with the inputs moved a
# little follow. If nothing closes, the drawing has to do as it is.
