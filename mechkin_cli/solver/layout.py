"""From the solver graph to the kernel's plan: scaled lengths, link frames, reversed joints.

The kernel's length unit is a power of two near the mechanism's size, so scaling never rounds. Its
origin is the ground origin unless the drawing lies far from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import frexp, ldexp, pi
from typing import TYPE_CHECKING

from mechkin_cli.mechanism.frames import GROUND, Frame
from mechkin_cli.mechanism.model import (
    GROUND_NAME,
    Attached,
    Damper,
    Joint,
    JointLoad,
    LinkLoad,
    Mechanism,
    Spring,
)
from mechkin_cli.mechanism.vectors import ZERO, Vector, norm, scale, subtract
from mechkin_cli.solver.codes import LoadCode
from mechkin_cli.solver.graph import SolverGraph

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Place, Plan

FAR_DRAWING = 4.0
"""Distance of the drawing from the ground origin, in sizes, beyond which the kernel works about
its own origin."""


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
        points = [j.on_first.o for j in self.mechanism.joints.values()]
        centre = scale(1.0 / len(points), _sum(points)) if points else ZERO
        return centre if norm(centre) > FAR_DRAWING * self.mechanism.box_diagonal() else ZERO

    @cached_property
    def link_number(self) -> dict[str, int]:
        """Number of each link; ground is -1."""
        return {GROUND_NAME: -1} | {e.child: k for k, e in enumerate(self.graph.edges)}

    @cached_property
    def link_frame(self) -> dict[str, Frame]:
        """Frame of each link in its own drawing (m): the child side of its tree joint."""
        frames = {GROUND_NAME: Frame(GROUND.x, GROUND.y, GROUND.z, self.origin)}
        for edge in self.graph.edges:
            side = edge.joint.on_second if edge.forward else edge.joint.on_first
            frames[edge.child] = side if edge.forward else _reversed(edge.joint, side)
        return frames

    @cached_property
    def joint_reference(self) -> dict[str, int]:
        """The kernel's number of a joint: k for a tree joint, -1-c for a closing joint."""
        tree = {e.joint.name: k for k, e in enumerate(self.graph.edges)}
        return tree | {c.joint.name: -1 - k for k, c in enumerate(self.graph.closings)}

    @cached_property
    def first_column(self) -> tuple[int, ...]:
        """First column of each tree joint."""
        return _running(e.joint.type.freedoms for e in self.graph.edges)

    @cached_property
    def first_state(self) -> tuple[int, ...]:
        """First state of each tree joint."""
        return _running(e.joint.type.states for e in self.graph.edges)

    def point(self, at: Attached) -> Vector:
        """A point of a link in the link's frame, in length units."""
        return scale(1.0 / self.length, self.link_frame[at.link].local(at.vector))

    def vector(self, at: Attached) -> Vector:
        """A direction of a link in the link's frame."""
        return self.link_frame[at.link].components(at.vector)

    def frame_on(self, link: str, frame: Frame) -> list[float]:
        """A frame drawn on a link, in the link's frame and length units, as the kernel takes it."""
        inner = self.link_frame[link].of(frame)
        return [*inner.x, *inner.y, *inner.z, *scale(1.0 / self.length, inner.o)]

    def place(self, joint: Joint, sign: float) -> Place:
        """The joint as its user sees it; point and axis ride on the second link."""
        from mechkin_cli.kernel import _kernel

        return _kernel.Place(
            self.link_number[joint.first],
            self.link_number[joint.second],
            self.point(Attached(joint.second, joint.on_second.o)),
            self.vector(Attached(joint.second, joint.on_second.z)),
            sign,
        )

    def build(self, size: float | None = None) -> Plan:
        """The kernel's plan without outputs; `size` (m) normalises residual and condition."""
        from mechkin_cli.kernel import _kernel

        plan = _kernel.Plan(self.length, self.origin, size or self.mechanism.box_diagonal())
        for edge in self.graph.edges:
            joint = edge.joint
            side = joint.on_first if edge.forward else _reversed(joint, joint.on_second)
            plan.add_tree_joint(
                joint.type.code,
                self.link_number[edge.parent],
                joint.lead / (2.0 * pi) / self.length,
                self.frame_on(edge.parent, side),
                self.place(joint, 1.0 if edge.forward else -1.0),
            )
        for closing in self.graph.closings:
            joint = closing.joint
            plan.add_closing_joint(
                joint.type.code,
                self.link_number[joint.first],
                self.link_number[joint.second],
                self.frame_on(joint.first, joint.on_first),
                self.frame_on(joint.second, joint.on_second),
                list(closing.loop),
                self.place(joint, 1.0),
            )
        self._add_blocks(plan)
        for (number, freedom), (_, coordinate) in zip(
            self.graph.inputs, self.graph.driven, strict=True
        ):
            plan.add_input(self.first_column[number] + freedom, coordinate == "s")
        self._add_inertias(plan)
        for load in self.mechanism.loads:
            self._add_load(plan, load)
        plan.finish()
        return plan

    def _add_blocks(self, plan: Plan) -> None:
        placed: set[int] = set()
        for block in self.graph.blocks:
            needed = {
                k for c in block.closings for k in self._carriers(self.graph.closings[c].joint)
            }
            fresh = sorted(needed - placed)
            unknown = [self.first_column[k] + f for k, f in block.unknowns]
            plan.add_block(len(block.closings), fresh, unknown)
            placed |= needed
        plan.set_rest([k for k in range(len(self.graph.edges)) if k not in placed])

    def _carriers(self, joint: Joint) -> set[int]:
        """Tree joints on the ways from ground to both links of a joint."""
        found = set()
        for link in (joint.first, joint.second):
            k = self.link_number[link]
            while k >= 0:
                found.add(k)
                k = self.link_number[self.graph.edges[k].parent]
        return found

    def _add_inertias(self, plan: Plan) -> None:
        plan.set_gravity(scale(1.0 / self.length, self.mechanism.gravity))
        for name, link in self.mechanism.links.items():
            if name == GROUND_NAME or not link.has_mass:
                continue
            centre = self.point(Attached(name, link.center_of_mass))
            tensor = [
                i / self.length**2 for i in _turned_tensor(link.inertia, self.link_frame[name])
            ]
            plan.set_inertia(self.link_number[name], link.mass, centre, tensor)

    def _add_load(self, plan: Plan, load: LinkLoad | JointLoad | Spring | Damper) -> None:
        unit = self.length
        if isinstance(load, LinkLoad):
            self._add_link_load(plan, load)
        elif isinstance(load, JointLoad):
            slide = load.coordinate == "s"
            code = LoadCode.JOINT_FORCE if slide else LoadCode.JOINT_TORQUE
            value = load.value / (unit if slide else unit**2)
            plan.add_load(code, self.joint_reference[load.joint], -1, ZERO, ZERO, (value, 0.0, 0.0))
        elif load.between:
            p, q = load.between
            if isinstance(load, Spring):
                data = (load.stiffness, load.free / unit, load.preload / unit)
                code = LoadCode.SPRING
            else:
                data, code = (load.damping, 0.0, 0.0), LoadCode.DAMPER
            links = self.link_number[p.link], self.link_number[q.link]
            plan.add_load(code, *links, self.point(p), self.point(q), data)
        else:
            self._add_joint_spring(plan, load)

    def _add_link_load(self, plan: Plan, load: LinkLoad) -> None:
        own_axes = load.axes == "link"
        value = self.vector(Attached(load.link, load.value)) if own_axes else load.value
        if load.kind == "force":
            code = LoadCode.FORCE_LINK if own_axes else LoadCode.FORCE_GROUND
            value, point = (
                scale(1.0 / self.length, value),
                self.point(Attached(load.link, load.point)),
            )
        else:
            code = LoadCode.TORQUE_LINK if own_axes else LoadCode.TORQUE_GROUND
            value, point = scale(1.0 / self.length**2, value), ZERO
        plan.add_load(code, self.link_number[load.link], -1, point, ZERO, value)

    def _add_joint_spring(self, plan: Plan, load: Spring | Damper) -> None:
        slide = load.coordinate == "s"
        per = 1.0 if slide else self.length**2
        reference = self.joint_reference[load.joint or ""]
        if isinstance(load, Spring):
            code = LoadCode.JOINT_SPRING_S if slide else LoadCode.JOINT_SPRING_THETA
            free = load.free / self.length if slide else load.free
            preload = load.preload / (self.length if slide else self.length**2)
            data = (load.stiffness / per, free, preload)
        else:
            code = LoadCode.JOINT_DAMPER_S if slide else LoadCode.JOINT_DAMPER_THETA
            data = (load.damping / per, 0.0, 0.0)
        plan.add_load(code, reference, -1, ZERO, ZERO, data)


def _reversed(joint: Joint, frame: Frame) -> Frame:
    """A joint's frame for a tree that passes the joint backwards: the same coordinate about -z."""
    return frame if joint.letter == "S" else frame.flipped()


def _sum(points: list[Vector]) -> Vector:
    total = ZERO
    for p in points:
        total = subtract(total, scale(-1.0, p))
    return total


def _running(counts: object) -> tuple[int, ...]:
    starts, total = [], 0
    for count in counts:  # type: ignore[attr-defined]
        starts.append(total)
        total += count
    return tuple(starts)


def _turned_tensor(tensor: tuple[float, ...], frame: Frame) -> tuple[float, ...]:
    """A tensor in ground axes expressed in a frame's axes: xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = tensor

    def times(a: Vector) -> Vector:
        return (
            xx * a[0] + xy * a[1] + xz * a[2],
            xy * a[0] + yy * a[1] + yz * a[2],
            xz * a[0] + yz * a[1] + zz * a[2],
        )

    x, y, z = (frame.components(times(axis)) for axis in (frame.x, frame.y, frame.z))
    return (x[0], y[1], z[2], y[0], z[0], z[1])
