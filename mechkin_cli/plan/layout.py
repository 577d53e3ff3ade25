"""The layout of a mechanism in the kernel: numbers, scaled lengths, link frames, reversed joints;
axes of coordinates; states and inputs of the home drawing.

The kernel's length unit is a power of two near the mechanism's size, so scaling never rounds. Its
origin is the ground origin unless the drawing lies far from it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Attached,
    Drives,
    Frame,
    Joint,
    Mechanism,
    Part,
    Vector,
    dot,
    frame_on,
    norm,
    scale,
    subtract,
    upright,
)
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.structure import Loop, SolverGraph, TreeEdge
from mechkin_cli.tape import next_power_of_two

if TYPE_CHECKING:
    from mechkin_cli.mechanism import (
        CoordinateLaw,
        Extent,
        Fleet,
        Laws,
        Relation,
        Swing,
        Term,
        Track,
    )
    from mechkin_cli.show import Bools, Floats


class Carrier(NamedTuple):
    """A kernel joint: one part of a tree edge, passed outward. It carries the body of its own
    number.

    `first_freedom` is the number of its first freedom among the user's freedoms of the joint.
    """

    edge: int
    part: Part
    parent: int
    first_freedom: int
    column: int
    state: int


NO_FREEDOM = -1
"""For a part of a joint that a relation only leads through."""


NO_FUNCTION = -1
"""For a coordinate that is a term of a relation itself."""


class RelationRow(NamedTuple):
    """A part of a joint that a coupling has a term of: the kernel joint, its direction in the tree,
    the freedom there that is the coordinate, the axis of that, and its factor in length units. With
    a function, its number, and what a unit of the coordinate is in its argument (rad, m)."""

    part: int
    sign: float
    freedom: int
    axis: int
    factor: float
    function: int
    argument: float


def is_lifted(extent: Extent | Swing, value: Floats) -> Bools:
    """Whether a length of a cable (m) is less than nothing, beyond rounding."""
    size = float(extent.drawn if extent.most is None else extent.most)
    return np.asarray(value < -tolerances.PARALLEL * size)


@dataclass(frozen=True)
class Layout:
    """Numbers, scale and frames of a mechanism and its solver graph, and the laws of its loads that
    vary. All methods are pure."""

    mechanism: Mechanism
    graph: SolverGraph
    unit: float | None = None
    laws: Laws | None = None
    drawn_about: Vector | None = None

    @cached_property
    def length(self) -> float:
        """The length unit in m: `unit`, or the power of two next to the size of the drawing."""
        if self.unit is not None:
            return self.unit
        return next_power_of_two(self.mechanism.box_diagonal())

    @cached_property
    def origin(self) -> Vector:
        """The kernel's origin in m: `drawn_about`, or the centre of a drawing that is far away."""
        if self.drawn_about is not None:
            return self.drawn_about
        points = [at.vector for _, at in self.mechanism.joint_points()]
        total = ZERO
        for point in points:
            total = subtract(total, scale(-1.0, point))
        centre = scale(1.0 / len(points), total) if points else ZERO
        near = tolerances.FAR_DRAWING * self.mechanism.box_diagonal()
        return centre if norm(centre) > near else ZERO

    @cached_property
    def carriers(self) -> tuple[Carrier, ...]:
        """The kernel's tree joints; bodies between the parts of a joint have no name."""
        carriers: list[Carrier] = []
        body = {GROUND_NAME: -1}
        column = state = 0
        for number, edge in enumerate(self.graph.edges):
            parent = body[edge.parent]
            for part, first_freedom in _hung(edge) if edge.hung else _outward(edge):
                carriers.append(Carrier(number, part, parent, first_freedom, column, state))
                parent = len(carriers) - 1
                column += len(part.type.freedoms)
                state += part.type.states
            body[edge.child] = parent
        return tuple(carriers)

    @cached_property
    def link_number(self) -> dict[str, int]:
        """The kernel's body of each link; ground is -1."""
        last = {carrier.edge: k for k, carrier in enumerate(self.carriers)}
        return {GROUND_NAME: -1} | {e.child: last[n] for n, e in enumerate(self.graph.edges)}

    @cached_property
    def body_frame(self) -> tuple[Frame, ...]:
        """Frame of each body in its own drawing (m): the far side of its part; last: ground."""
        ground = Frame(GROUND.x, GROUND.y, GROUND.z, self.origin)
        return (*(carrier.part.after for carrier in self.carriers), ground)

    @cached_property
    def link_frame(self) -> dict[str, Frame]:
        """Frame of each link in its own drawing (m)."""
        return {name: self.body_frame[number] for name, number in self.link_number.items()}

    @cached_property
    def edge_number(self) -> dict[str, int]:
        """Number of the tree edge of each joint that is one."""
        return {edge.joint.name: k for k, edge in enumerate(self.graph.edges)}

    @cached_property
    def joint_reference(self) -> dict[str, int]:
        """The kernel's number of a joint: k of its last part for a tree joint, -1-c for a closing
        joint."""
        tree = {e.joint.name: self.link_number[e.child] for e in self.graph.edges}
        closings = enumerate(self.graph.closings)
        return tree | {c.name: -1 - k for k, c in closings if not c.terms}

    @cached_property
    def coupling_number(self) -> dict[str, int]:
        """The closing number of each coupling."""
        return {c.owner: k for k, c in enumerate(self.graph.closings) if c.terms}

    @cached_property
    def hung_number(self) -> dict[str, int]:
        """Number of each hung body in the kernel."""
        hung = [c.links[0] for c in self.graph.closings if c.links]
        return {body: k for k, body in enumerate(hung)}

    @cached_property
    def place_number(self) -> dict[str, int]:
        """Number of the place in the kernel of each joint."""
        return {name: k for k, name in enumerate(self.mechanism.joints)}

    @cached_property
    def loss_number(self) -> dict[str, int]:
        """Number of the place in the kernel of each coupling that rubs."""
        rubbing = (one.joint for one in self.mechanism.frictions if one.loss is not None)
        return {name: k for k, name in enumerate(rubbing, start=len(self.mechanism.joints))}

    @cached_property
    def pushes(self) -> dict[str, tuple[str, str]]:
        """Both links of each coupling that pushes them apart, where something rubs: such a force
        goes by a magnitude, as friction does, and both are solved for together. Their places in the
        kernel stand behind those of `place_number` and `loss_number`."""
        if not self.mechanism.frictions:
            return {}
        joints = self.mechanism.joints
        return {
            c.owner: mesh.ends(joints)
            for c in self.graph.closings
            if (relation := self.mechanism.couplings.get(c.owner)) is not None
            and (mesh := relation.mesh) is not None
            and relation.pushes_apart
        }

    @cached_property
    def axis_number(self) -> dict[tuple[str, str], int]:
        """Number of the axis of each coordinate (joint, name) along which loads may act."""
        pairs = [
            (joint.name, coordinate)
            for joint in self.mechanism.joints.values()
            if not joint.type.is_free
            for coordinate in joint.type.coordinates
        ]
        return {pair: k for k, pair in enumerate(pairs)}

    @cached_property
    def parts_of(self) -> tuple[tuple[int, ...], ...]:
        """The kernel joints of each tree edge, outward."""
        joints: list[list[int]] = [[] for _ in self.graph.edges]
        for k, carrier in enumerate(self.carriers):
            joints[carrier.edge].append(k)
        return tuple(tuple(parts) for parts in joints)

    def carrier_of(self, edge: int, freedom: int) -> tuple[int, int]:
        """The kernel joint that has a user's freedom of a tree edge, and its freedom there."""
        for k in self.parts_of[edge]:
            carrier = self.carriers[k]
            count = len(carrier.part.type.freedoms)
            if 0 <= freedom - carrier.first_freedom < count:
                return k, freedom - carrier.first_freedom
        raise IndexError(f"edge {edge} has no freedom {freedom}")

    def column(self, edge: int, freedom: int) -> int:
        """Column of a user's freedom of a tree edge."""
        k, local = self.carrier_of(edge, freedom)
        return self.carriers[k].column + local

    def state(self, edge: int, freedom: int) -> int:
        """State of a user's scalar freedom of a tree edge."""
        k, local = self.carrier_of(edge, freedom)
        return self.carriers[k].state + local

    @cached_property
    def states(self) -> int:
        """Length of the state vector."""
        return sum(c.part.type.states for c in self.carriers)

    @cached_property
    def carried(self) -> tuple[tuple[int, Track], ...]:
        """The kernel joints that go along a curve or over a surface, with that."""
        tracks = ((k, carrier.part.track) for k, carrier in enumerate(self.carriers))
        return tuple((k, track) for k, track in tracks if track is not None)

    def course_of(self, joint: str) -> int:
        """The kernel joint by which a joint goes along a curve or over a surface; -1: it does
        not."""
        edges = self.graph.edges
        found = (k for k, _ in self.carried if edges[self.carriers[k].edge].joint.name == joint)
        return next(found, -1)

    @cached_property
    def functions(self) -> tuple[CoordinateLaw, ...]:
        """The functions of the plan, in order."""
        relations = self.mechanism.couplings.values()
        return tuple(t.law for r in relations for t in r.terms if t.law is not None)

    def extents(self, states: Floats) -> Iterator[tuple[str, Extent | Swing, Floats]]:
        """Those of cables, with the coupling's name, and their values (m) at some states (states,
        places)."""
        for name, relation in self.mechanism.couplings.items():
            for extent in relation.extents:
                value = extent.value(partial(self._value, states))
                yield name, extent, np.full(states.shape[1], value)

    def fleets(self, states: Floats) -> Iterator[tuple[str, Fleet, Floats]]:
        """Those of cables, with the coupling's name, and the tangents of their angles at some
        states (states, places)."""
        for name, relation in self.mechanism.couplings.items():
            for fleet in relation.fleets:
                value = self._value(states, fleet.term)
                yield name, fleet, value if fleet.length is None else value / float(fleet.length)

    def _value(self, states: Floats, term: Term) -> Floats:
        """A factor times a coordinate (rad, m) that has a state, at some states."""
        freedom = term.joint.freedom_number(term.coordinate)
        state = states[self.state(self.edge_number[term.joint.name], freedom)]
        unit = term.joint.unit_of(term.coordinate, self.length)
        value: Floats = float(term.factor) * unit * state
        return value

    def relation_rows(self, relation: Relation, loop: Loop) -> list[RelationRow]:
        """All parts of the joints of a coupling; those that have none of its coordinates come
        first."""
        signs, rows = dict(loop), []
        for term in relation.terms:
            edge = self.edge_number[term.joint.name]
            own, freedom = self.carrier_of(edge, term.joint.freedom_number(term.coordinate))
            axis, factor = self.axis_number[term.joint.name, term.coordinate], term.factor
            is_angle = term.joint.type.coordinate[term.coordinate].is_angle
            unit = 1.0 if is_angle else self.length
            function = NO_FUNCTION if term.law is None else self.functions.index(term.law)
            if function == NO_FUNCTION:
                factor = factor * unit
            if relation.length:
                factor = factor / self.length
            rows += [
                RelationRow(
                    k,
                    float(signs[edge]),
                    freedom if k == own else NO_FREEDOM,
                    axis,
                    factor,
                    function,
                    unit,
                )
                for k in self.parts_of[edge]
            ]
        return sorted(rows, key=lambda row: row.freedom != NO_FREEDOM)

    def point(self, at: Attached) -> Vector:
        """A point of a link in the link's frame, in length units."""
        return scale(1.0 / self.length, self.link_frame[at.link].local(at.vector))

    def vector(self, at: Attached) -> Vector:
        """A direction of a link in the link's frame."""
        return self.link_frame[at.link].components(at.vector)

    def frame_on(self, body: int, frame: Frame) -> list[float]:
        """A frame drawn on a body, in the body's frame and length units, as the kernel takes it."""
        inner = self.body_frame[body].of(frame)
        return [*inner.x, *inner.y, *inner.z, *scale(1.0 / self.length, inner.o)]

    @cached_property
    def drives(self) -> Drives | None:
        """The drives of the inputs, where those of the graph are the mechanism's own and some of
        them have no drive of their own."""
        drives = self.mechanism.drives
        if drives is None or drives.are_plain:
            return None
        return drives if self.graph.driven[: len(drives.inputs)] == drives.inputs else None


def _outward(edge: TreeEdge) -> list[tuple[Part, int]]:
    """The parts of an edge from parent to child, each with its first freedom in the user's
    count."""
    parts, first = [], 0
    for part in edge.joint.parts:
        parts.append((part, first))
        first += len(part.type.freedoms)
    if edge.forward:
        return parts
    return [(part.reversed(), start) for part, start in reversed(parts)]


def _hung(edge: TreeEdge) -> list[tuple[Part, int]]:
    """The one part of a hung body: its sphere, without a freedom."""
    parent, body = (frame_on(edge.joint, link) for link in (edge.parent, edge.child))
    return [(Part("L", upright(parent.o), upright(body.o)), 0)]


def coordinate_axis(joint: Joint, coordinate: str) -> tuple[bool, Attached, Attached]:
    """The axis of one of a joint's coordinates: the unit wrench that works on it and on no other of
    its joint.

    It is a couple (or, for a slide, as the first value shows, a force through the joint's point)
    along a sum of two vectors that ride on links, in the home drawing. The sum is only needed for
    two turns, whose axes may be oblique: their dual basis is (z1 - c z2) / (1 - c^2) with c =
    z1 . z2.
    """
    known = joint.type.coordinate[coordinate]
    if joint.type.chain[known.freedom].motion == "carriage":
        # the kernel knows the slope of the course
        return False, Attached(joint.second, ZERO), Attached(joint.second, ZERO)
    if known.axis is not None:
        return not known.is_angle, joint.drawn(known.axis), Attached(joint.second, ZERO)
    axes = Attached(joint.first, joint.on_first.z), Attached(joint.second, joint.on_second.z)
    is_first = known == next(each for each in joint.type.named if each.axis is None)
    turn, other = axes if is_first else axes[::-1]
    c = dot(joint.on_first.z, joint.on_second.z)
    dual = 1.0 / (1.0 - c * c)
    along = Attached(turn.link, scale(dual, turn.vector))
    return False, along, Attached(other.link, scale(-c * dual, other.vector))


def home_state(layout: Layout) -> Floats:
    """States of the home drawing (states,): every coordinate is zero there but those of guided
    points (`building.motion`)."""
    state = np.zeros(layout.states)
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state] = 1.0
        elif carrier.part.track is not None:
            state[carrier.state : carrier.state + len(carrier.part.at)] = carrier.part.at
        elif carrier.part.drawn != 0.0:
            state[carrier.state] = carrier.part.drawn / layout.length
    return state


def home_inputs(layout: Layout) -> Floats:
    """The inputs of the home drawing (inputs,)."""
    state = home_state(layout)
    inputs = [
        state[layout.state(edge, freedom)] if edge >= 0 else 0.0
        for edge, freedom in layout.graph.inputs
    ]
    return np.array(inputs, dtype=np.float64)
