"""A mechanism and its graph in the kernel: what sessions of one structure share."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from mechkin_cli.memo import Memo, remembered
from mechkin_cli.plan import Layout, OutputPlan, Readout, build_plan
from mechkin_cli.record import dataclass, field
from mechkin_cli.session.inputs import TurnSlots

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Attached, Wanted


Coordinate = tuple[str, str]
"""(joint, coordinate)."""


@dataclass(frozen=True, eq=False)
class Structure:
    """A mechanism and its graph in the kernel: what depends neither on rows nor on the choice of
    the first assembly.

    Attributes:
        layout: how the mechanism lies in the kernel.
        driven: its inputs (joint, coordinate).
        closed_at: cut joints that were asked for instead of the best ones.
        built: the plan, where it is not that of the layout alone.
        varied: the readout of some quantities, where their constants follow from those of another
            structure.
    """

    layout: Layout
    driven: tuple[Coordinate, ...]
    closed_at: tuple[str, ...] | None = None
    built: Plan | None = None
    varied: Callable[[tuple[Wanted, ...]], Readout] | None = None
    memo: Memo = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def plan(self) -> Plan:
        """The frozen plan; residual and condition in parts of the drawing's size."""
        return build_plan(self.layout) if self.built is None else self.built

    @cached_property
    def turn_slots(self) -> TurnSlots:
        """Where the turns of angles stand among `Followed.turns`."""
        return TurnSlots.of(self.plan)

    @remembered
    def readout(self, wanted: tuple[Wanted, ...], points: tuple[Attached, ...]) -> Readout:
        """The outputs that give some quantities, and the places of some points."""
        if self.varied is not None and not points:
            return self.varied(wanted)
        outputs = OutputPlan(self.layout, self.plan, self.driven)
        for quantity in wanted:
            outputs.add(quantity)
        slots = [outputs.add_point(at, 0) for at in points]
        return Readout(outputs.outputs, outputs.slots, slots, wanted)
