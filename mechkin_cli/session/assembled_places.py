"""A mechanism's structure in the kernel, and places where it is assembled to take ranks at.

The first place is the drawing itself if it is assembled; else what Newton's method makes of it, all
loops of a component in one block. A drawing may be a special position, so places with the inputs
moved a little follow. If nothing closes, the drawing has to do as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Attached,
    Frame,
    Mechanism,
    add,
    cross,
    norm,
    scale,
    subtract,
)
from mechkin_cli.memo import Memo, remembered
from mechkin_cli.plan import Layout, OutputPlan, Readout, build_plan, home_inputs, home_state
from mechkin_cli.record import dataclass, field, replace
from mechkin_cli.session.inputs import closing_slots, tree_slots
from mechkin_cli.session.kernel_run import Ask, RowInputs, run, turn_count
from mechkin_cli.structure import (
    Rates,
    SolverGraph,
    UnsolvableGraph,
    build_graph,
    connections_of,
    is_too_large,
    middle_and_size,
    reduce,
    whole_link,
)

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.show import Floats


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
    def closing_slots(self) -> Mapping[tuple[int, int], int]:
        """Rows of the turns of cut joints, as `inputs.closing_slots`."""
        return closing_slots(self.plan)

    @cached_property
    def tree_slots(self) -> Mapping[int, int]:
        """Rows of the whole turns of the tree's angles, as `inputs.tree_slots`."""
        return tree_slots(self.plan)

    @cached_property
    def turns(self) -> int:
        """How many rows `Followed.turns` has."""
        return turn_count(self.plan)

    def turn_slot(self, quantity: Wanted) -> int | None:
        """The row of a joint's angle in `Followed.turns`, None where it has no turns."""
        layout = self.layout
        reference = layout.joint_reference[quantity.owner]
        freedom = layout.mechanism.joints[quantity.owner].type.freedom_of[quantity.coordinate]
        if reference < 0:
            return self.closing_slots.get((-1 - reference, freedom))
        return self.tree_slots.get(layout.state(layout.edge_number[quantity.owner], freedom))

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


Poses = Callable[[str], Frame]


def assembled_places(mechanism: Mechanism, graph: Callable[[], SolverGraph]) -> Iterator[Poses]:
    """Where the links' drawings stand; `graph` closes all loops of a component at once."""
    yield from closed_places(mechanism, graph)
    if not is_drawn_assembled(mechanism):
        yield _as_drawn


def closed_places(
    mechanism: Mechanism, graph: Callable[[], SolverGraph], at: Sequence[float] = ()
) -> Iterator[Poses]:
    """As `assembled_places`, without a drawing that is not assembled; beside it the inputs stand
    `at` these values (rad, m), or at zero."""
    drawn = is_drawn_assembled(mechanism)
    if drawn:
        yield _as_drawn
    structure = _structure(mechanism, graph)
    if structure is not None:
        moves = [(move, off) for off in (1.0, 0.0) for move in tolerances.PLACE_MOVES]
        for move, off in moves if drawn else [(0.0, 0.0), *moves]:
            poses = _closed(structure, at, move, off * move)
            if poses is not None:
                yield poses


def is_drawn_assembled(mechanism: Mechanism) -> bool:
    """Whether all joints are drawn with their frames on each other, and points at the distances
    that constraints keep."""
    most = tolerances.LOOP_RANK
    size = mechanism.box_diagonal()
    parts = [part for joint in mechanism.joints.values() for part in joint.parts]
    turns = [
        norm(subtract(one, other))
        for part in parts
        if not part.type.is_ball
        for one, other in zip(part.before[:3], part.after[:3], strict=True)
    ]
    apart = [norm(subtract(add(part.before.o, part.way), part.after.o)) for part in parts]
    for constraint in mechanism.constraints:
        if constraint.length is not None:
            foot, head = (at.vector for at in constraint.points)
            apart.append(abs(norm(subtract(head, foot)) - constraint.length))
    return max(turns, default=0.0) <= most and max(apart, default=0.0) <= most * size


def _as_drawn(link: str) -> Frame:
    return GROUND


def _structure(mechanism: Mechanism, graph: Callable[[], SolverGraph]) -> Structure | None:
    """The mechanism in the kernel, where it can be solved as it is driven."""
    try:
        found = graph()
    except UnsolvableGraph:
        return None
    if is_too_large(found):
        return None
    # no load says where links stand
    return Structure(Layout(replace(mechanism, loads=(), frictions=()), found), tuple(found.driven))


def _displaced(layout: Layout, move: float) -> Floats:
    """The drawing with all coordinates but those of balls moved, up to so much."""
    state, random = home_state(layout), RandomStarts()
    for carrier in layout.carriers:
        if not carrier.part.type.is_ball:
            count = len(carrier.part.type.freedoms)
            state[carrier.state : carrier.state + count] += move + random.between(move, count)
    return state


def _closed(structure: Structure, at: Sequence[float], move: float, off: float) -> Poses | None:
    """The poses that Newton's method reaches with all inputs moved from where they stand, from a
    guess that is `off` the drawing; None where it does not close."""
    layout = structure.layout
    joints = layout.mechanism.joints
    stand = [
        value / joints[name].unit_of(coordinate, layout.length)
        for (name, coordinate), value in zip(structure.driven, at, strict=bool(at))
    ]
    origin, length = layout.origin, layout.length
    ends = (ZERO, scale(length, GROUND.x), scale(length, GROUND.y))
    links = [name for name in layout.mechanism.links if name != GROUND_NAME]
    points = [Attached(name, add(origin, end)) for name in links for end in ends]
    readout = structure.readout((), tuple(points))
    home = np.array(stand) if at else home_inputs(layout)
    inputs: Floats = home[:, None] + move
    guess = _displaced(layout, off)[:, None]
    batch = run(structure.plan, RowInputs(inputs, guess), Ask(readout=readout))
    if not batch.good[0] or batch.outputs is None:
        return None
    values = batch.outputs[:, 0].tolist()
    read = [(values[k], values[k + 1], values[k + 2]) for k in readout.points]
    found = {GROUND_NAME: GROUND}
    for number, name in enumerate(links):
        middle, *others = read[3 * number : 3 * number + 3]
        x, y = (scale(1.0 / length, subtract(end, middle)) for end in others)
        turn = Frame(x, y, cross(x, y), ZERO)
        back = add(add(scale(origin[0], x), scale(origin[1], y)), scale(origin[2], turn.z))
        found[name] = turn._replace(o=subtract(subtract(middle, layout.mechanism.datum), back))
    # the half of a cut link goes with the other
    return lambda link: found[whole_link(link)]


def solver_graph(
    mechanism: Mechanism,
    inputs: Sequence[Coordinate],
    closed_at: Sequence[str] | None = None,
) -> SolverGraph:
    """The solver graph of a mechanism whose `inputs` (joint, coordinate) are driven, with ranks
    taken at assembled places where counting does not tell; as `structure.build_graph`."""
    return build_graph(mechanism, inputs, assembled_places, closed_at)


def left_free(mechanism: Mechanism, inputs: Mapping[tuple[str, str], float]) -> list[bool]:
    """For each assembled place whether some link can move while the inputs rest; none where no
    place is found, or the ranks would take too long.

    Args:
        mechanism: with pairs that hold idle freedoms.
        inputs: (joint, coordinate) that rest, and where (rad, m).
    """

    whole, names, at = reduce(mechanism), list(inputs), list(inputs.values())
    connections = connections_of(mechanism, whole, names)
    driven = {(name, mechanism.joints[name].freedom_number(c)) for name, c in inputs}
    (middle, size), found = middle_and_size(mechanism), []
    for poses in closed_places(mechanism, lambda: solver_graph(mechanism, names), at):
        rates = Rates(poses, driven, middle, size)
        still = rates.still(whole.links, connections, {GROUND_NAME})
        if rates.work:
            found.append(set(whole.links) > still)
    return found
