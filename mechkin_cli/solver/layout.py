"""From the solver graph to the kernel's plan: scaled lengths, link frames, reversed joints.

The kernel's length unit is a power of two near the mechanism's size, so scaling never rounds. Its
origin is the ground origin unless the drawing lies far from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import frexp, ldexp, pi
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.mechanism.frames import GROUND, Frame, turned_tensor, upright
from mechkin_cli.mechanism.joint_types import tree_types
from mechkin_cli.mechanism.legs import frame_on
from mechkin_cli.mechanism.model import (
    GROUND_NAME,
    Attached,
    Damper,
    Joint,
    JointLoad,
    LinkLoad,
    Mechanism,
    Part,
    Spring,
    Varying,
    varying,
)
from mechkin_cli.mechanism.vectors import ZERO, Vector, norm, scale, subtract
from mechkin_cli.solver.axes import coordinate_axis
from mechkin_cli.solver.codes import LoadCode
from mechkin_cli.solver.graph import Closing, SolverGraph, TreeEdge

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan

FAR_DRAWING = 4.0
"""Distance of the drawing from the ground origin, in sizes, beyond which the kernel works about
its own origin."""


NO_AXIS = -1
"""Stands for the axis of a coordinate that no user knows: it is driven only while a dead centre is
looked for."""


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


@dataclass(frozen=True)
class Layout:
    """How a mechanism lies in the kernel: numbering, scale, frames. All methods are pure."""

    mechanism: Mechanism
    graph: SolverGraph

    @cached_property
    def length(self) -> float:
        """The length unit in m: the power of two next to the size of the home drawing."""
        mantissa, exponent = frexp(self.mechanism.box_diagonal())
        return ldexp(1.0, exponent if mantissa > 0.7 else exponent - 1)

    @cached_property
    def origin(self) -> Vector:
        """The kernel's origin in m."""
        points = [at.vector for _, at in self.mechanism.joint_points()]
        centre = scale(1.0 / len(points), _sum(points)) if points else ZERO
        return centre if norm(centre) > FAR_DRAWING * self.mechanism.box_diagonal() else ZERO

    @cached_property
    def carriers(self) -> tuple[Carrier, ...]:
        """The kernel's tree joints; bodies between the parts of a joint have no name."""
        found: list[Carrier] = []
        body = {GROUND_NAME: -1}
        column = state = 0
        for number, edge in enumerate(self.graph.edges):
            parent = body[edge.parent]
            for part, first_freedom in _hung(edge) if edge.hung else _outward(edge):
                found.append(Carrier(number, part, parent, first_freedom, column, state))
                parent = len(found) - 1
                column += tree_types()[part.letter].freedoms
                state += tree_types()[part.letter].states
            body[edge.child] = parent
        return tuple(found)

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
    def joint_reference(self) -> dict[str, int]:
        """The kernel's number of a joint: k of its last part for a tree joint, -1-c for a closing
        joint."""
        tree = {e.joint.name: self.link_number[e.child] for e in self.graph.edges}
        return tree | {c.joint.name: -1 - k for k, c in enumerate(self.graph.closings)}

    @cached_property
    def leg_number(self) -> dict[str, int]:
        """Number of each leg in the kernel, by its body."""
        legs = [c.leg for c in self.graph.closings if c.leg is not None]
        return {leg.body: k for k, leg in enumerate(legs)}

    @cached_property
    def place_number(self) -> dict[str, int]:
        """Number of each joint's place in the kernel."""
        return {name: k for k, name in enumerate(self.mechanism.joints)}

    @cached_property
    def axis_number(self) -> dict[tuple[str, str], int]:
        """Number of the axis of each coordinate (joint, name)."""
        pairs = [
            (joint.name, coordinate)
            for joint in self.mechanism.joints.values()
            for coordinate in joint.type.coordinates
        ]
        return {pair: k for k, pair in enumerate(pairs)}

    def carrier_of(self, edge: int, freedom: int) -> tuple[int, int]:
        """The kernel joint that has a user's freedom of a tree edge, and its freedom there."""
        for k, carrier in enumerate(self.carriers):
            count = tree_types()[carrier.part.letter].freedoms
            if carrier.edge == edge and 0 <= freedom - carrier.first_freedom < count:
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

    @property
    def states(self) -> int:
        """Length of the state vector."""
        return sum(tree_types()[c.part.letter].states for c in self.carriers)

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

    def build(self, size: float | None = None) -> Plan:
        """The kernel's plan without outputs; `size` (m) normalises residual and condition."""
        from mechkin_cli.kernel import _kernel

        plan = _kernel.Plan(self.length, self.origin, size or self.mechanism.box_diagonal())
        for carrier in self.carriers:
            lead = self.graph.edges[carrier.edge].joint.lead
            plan.add_tree_joint(
                tree_types()[carrier.part.letter].code,
                carrier.parent,
                lead / (2.0 * pi) / self.length,
                self.frame_on(carrier.parent, carrier.part.before),
            )
        for closing in self.graph.closings:
            self._add_closing(plan, closing)
        self._add_places(plan)
        self._add_blocks(plan)
        for (edge, freedom), (name, coordinate) in zip(
            self.graph.inputs, self.graph.driven, strict=True
        ):
            joint = self.graph.edges[edge].joint
            along_thread = joint.letter == "H" and coordinate == "s"
            force_per_torque = 2.0 * pi * self.length / joint.lead if along_thread else 1.0
            axis = self.axis_number.get((name, coordinate), NO_AXIS)
            plan.add_input(self.column(edge, freedom), axis, force_per_torque)
        self._add_inertias(plan)
        for load in self.mechanism.loads:
            self._add_load(plan, load)
        plan.finish()
        return plan

    def _add_closing(self, plan: Plan, closing: Closing) -> None:
        joint, leg = closing.joint, closing.leg
        loop = [(k, s) for e, s in closing.loop for k in self._parts_of(e)]
        if leg is None:
            first, second = self.link_number[joint.first], self.link_number[joint.second]
            frames = self.frame_on(first, joint.on_first), self.frame_on(second, joint.on_second)
            plan.add_closing_joint(joint.type.code, first, second, *frames, joint.parameter, loop)
            return
        first, second = self.link_number[leg.first], self.link_number[leg.second]
        ends = frame_on(leg.start, leg.first), frame_on(leg.end, leg.second)
        plan.add_leg(
            self.link_number[leg.body],
            self.link_number[leg.rod] if leg.rod else -1,
            first,
            second,
            self.frame_on(first, ends[0]),
            self.frame_on(second, ends[1]),
            norm(leg.span) / self.length,
            leg.line,
            leg.slide_sign,
            loop,
        )

    def _parts_of(self, edge: int) -> list[int]:
        return [k for k, carrier in enumerate(self.carriers) if carrier.edge == edge]

    def _add_places(self, plan: Plan) -> None:
        backward = {e.joint.name for e in self.graph.edges if not e.forward}
        # a leg pushes the link at its end, whether that is the sphere's first or second
        backward |= {
            c.joint.name
            for c in self.graph.closings
            if c.leg is not None and c.leg.second == c.joint.first
        }
        for name, joint in self.mechanism.joints.items():
            plan.add_place(
                self.joint_reference[name],
                self.link_number[joint.first],
                self.link_number[joint.second],
                self.link_number[joint.point.link],
                self.point(joint.point),
                -1.0 if name in backward else 1.0,
            )
        for name, coordinate in self.axis_number:
            axis = coordinate_axis(self.mechanism.joints[name], coordinate)
            (one, two) = axis.terms
            plan.add_axis(
                self.place_number[name],
                axis.slide,
                self.link_number[one.link],
                self.vector(one),
                self.link_number[two.link],
                self.vector(two),
            )

    def _add_blocks(self, plan: Plan) -> None:
        placed: set[int] = set()
        for block in self.graph.blocks:
            joints = [self.graph.closings[c].joint for c in block.closings]
            needed = {k for joint in joints for k in self._ways(joint)}
            unknown = [self.column(k, f) for k, f in block.unknowns]
            plan.add_block(len(block.closings), sorted(needed - placed), unknown)
            placed |= needed
        plan.set_rest([k for k in range(len(self.carriers)) if k not in placed])

    def _ways(self, joint: Joint) -> set[int]:
        """Kernel joints on the ways from ground to both links of a joint."""
        found = set()
        for link in (joint.first, joint.second):
            k = self.link_number[link]
            while k >= 0:
                found.add(k)
                k = self.carriers[k].parent
        return found

    def _add_inertias(self, plan: Plan) -> None:
        plan.set_gravity(scale(1.0 / self.length, self.mechanism.gravity))
        for name, link in self.mechanism.links.items():
            if name == GROUND_NAME or not link.has_mass:
                continue
            centre = self.point(Attached(name, link.center_of_mass))
            tensor = [
                i / (self.length * self.length)
                for i in turned_tensor(link.inertia, self.link_frame[name])
            ]
            plan.set_inertia(self.link_number[name], link.mass, centre, tensor)

    def _add_load(self, plan: Plan, load: LinkLoad | JointLoad | Spring | Damper) -> None:
        unit = self.length
        if isinstance(load, LinkLoad):
            self._add_link_load(plan, load)
        elif isinstance(load, JointLoad):
            axis, reference, freedom, slide = self._coordinate(load.joint, load.coordinate)
            varies = isinstance(load.value, Varying)
            constant = 0.0 if isinstance(load.value, Varying) else load.value
            value = (constant / (unit if slide else (unit * unit)), 0.0, 0.0)
            code = LoadCode.COORDINATE
            plan.add_load(code, axis, reference, freedom, ZERO, ZERO, value, varies)
        elif load.between:
            p, q = load.between
            if isinstance(load, Spring):
                data = (load.stiffness, load.free / unit, load.preload / unit)
                code = LoadCode.SPRING
            else:
                data, code = (load.damping, 0.0, 0.0), LoadCode.DAMPER
            links = self.link_number[p.link], self.link_number[q.link]
            plan.add_load(code, *links, 0, self.point(p), self.point(q), data)
        else:
            self._add_joint_spring(plan, load)

    def _add_link_load(self, plan: Plan, load: LinkLoad) -> None:
        own_axes = load.axes == "link"
        x, y, z = (0.0 if isinstance(amount, Varying) else amount for amount in load.value)
        value = self.vector(Attached(load.link, (x, y, z))) if own_axes else (x, y, z)
        if load.kind == "force":
            code = LoadCode.FORCE_LINK if own_axes else LoadCode.FORCE_GROUND
            value, point = (
                scale(1.0 / self.length, value),
                self.point(Attached(load.link, load.point)),
            )
        else:
            code = LoadCode.TORQUE_LINK if own_axes else LoadCode.TORQUE_GROUND
            value, point = scale(1.0 / (self.length * self.length), value), ZERO
        link, varies = self.link_number[load.link], bool(varying(load))
        plan.add_load(code, link, -1, 0, point, ZERO, value, varies)

    def _coordinate(self, name: str, coordinate: str) -> tuple[int, int, int, bool]:
        """Axis, kernel joint and freedom there of a joint's coordinate, and whether it is a
        slide."""
        joint = self.mechanism.joints[name]
        freedom = joint.type.freedom_of[coordinate]
        slide = is_slide(coordinate)
        axis = self.axis_number[name, coordinate]
        for number, edge in enumerate(self.graph.edges):
            if edge.joint.name == name:
                return axis, *self.carrier_of(number, freedom), slide
        return axis, self.joint_reference[name], freedom, slide

    def _add_joint_spring(self, plan: Plan, load: Spring | Damper) -> None:
        axis, reference, freedom, slide = self._coordinate(load.joint or "", load.coordinate or "")
        per = 1.0 if slide else (self.length * self.length)
        if isinstance(load, Spring):
            code = LoadCode.COORDINATE_SPRING
            free = load.free / self.length if slide else load.free
            preload = load.preload / (self.length if slide else (self.length * self.length))
            data = (load.stiffness / per, free, preload)
        else:
            code = LoadCode.COORDINATE_DAMPER
            data = (load.damping / per, 0.0, 0.0)
        plan.add_load(code, axis, reference, freedom, ZERO, ZERO, data)


def is_slide(coordinate: str) -> bool:
    """Whether a coordinate is a length; the s of a helical joint is one though its freedom is an
    angle."""
    return coordinate in ("s", "x", "y")


def _outward(edge: TreeEdge) -> list[tuple[Part, int]]:
    """The parts of an edge from parent to child, each with its first freedom in the user's
    count."""
    parts, first = [], 0
    for part in edge.joint.parts:
        parts.append((part, first))
        first += tree_types()[part.letter].freedoms
    if edge.forward:
        return parts
    return [(part.reversed(), start) for part, start in reversed(parts)]


def _hung(edge: TreeEdge) -> list[tuple[Part, int]]:
    """The one part of a leg's body: its sphere, without a freedom."""
    parent, body = (frame_on(edge.joint, link) for link in (edge.parent, edge.child))
    return [(Part("L", upright(parent.o), upright(body.o)), 0)]


def _sum(points: list[Vector]) -> Vector:
    total = ZERO
    for p in points:
        total = subtract(total, scale(-1.0, p))
    return total
