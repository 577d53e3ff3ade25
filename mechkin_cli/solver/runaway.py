"""Runaways: a branch that goes to infinity, a slide growing out of bounds before some input value.

RCCC is an example: its turns have a dead centre there, and its slides go with their rates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.solver.layout import Layout

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


class Runaway(NamedTuple):
    """The joint whose slide has grown the most, to `slide` (length units)."""

    joint: str
    slide: float


def find_runaway(layout: Layout, state: Floats) -> Runaway | None:
    """The longest slide at the last place of a branch that was lost, if it is out of bounds."""
    driven = {layout.state(edge, freedom) for edge, freedom in layout.graph.inputs}
    longest = Runaway("", 0.0)
    for carrier in layout.carriers:
        for freedom, slide in enumerate(carrier.part.type.slides):
            number = carrier.state + freedom
            length = float(state[number])
            if slide and number not in driven and abs(length) > abs(longest.slide):
                longest = Runaway(layout.graph.edges[carrier.edge].joint.name, length)
    return longest if abs(longest.slide) >= tolerances.RUNAWAY_SLIDE else None
