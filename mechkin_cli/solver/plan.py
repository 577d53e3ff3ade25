"""From the layout to the kernel's plan: joints, closures, places, blocks, inputs and inertias."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import TYPE_CHECKING

from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism.frames import turned_tensor
from mechkin_cli.mechanism.joint_types import tree_types
from mechkin_cli.mechanism.legs import frame_on
from mechkin_cli.mechanism.model import GROUND_NAME, Attached, Joint
from mechkin_cli.mechanism.vectors import norm, scale
from mechkin_cli.solver.axes import coordinate_axis
from mechkin_cli.solver.graph import Closing
from mechkin_cli.solver.plan_loads import add_load

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.solver.layout import Layout

NO_AXIS = -1
"""Stands for the axis of a coordinate that no user knows: it is driven only while a dead centre is
looked for."""


def build_plan(layout: Layout, size: float | None = None) -> Plan:
    """As `Layout.build`."""
    plan = _kernel.Plan(layout.length, layout.origin, size or layout.mechanism.box_diagonal())
    for carrier in layout.carriers:
        lead = layout.graph.edges[carrier.edge].joint.lead
        plan.add_tree_joint(
            tree_types()[carrier.part.letter].code,
            carrier.parent,
            lead / (2.0 * pi) / layout.length,
            layout.frame_on(carrier.parent, carrier.part.before),
        )
    for closing in layout.graph.closings:
        _add_closing(layout, plan, closing)
    _add_places(layout, plan)
    _add_blocks(layout, plan)
    _add_inputs(layout, plan)
    _add_inertias(layout, plan)
    for load in layout.mechanism.loads:
        add_load(layout, plan, load)
    plan.finish()
    return plan


def _add_closing(layout: Layout, plan: Plan, closing: Closing) -> None:
    joint, leg = closing.joint, closing.leg
    loop = [(k, s) for e, s in closing.loop for k in layout.parts_of[e]]
    if leg is None:
        first, second = layout.link_number[joint.first], layout.link_number[joint.second]
        frames = layout.frame_on(first, joint.on_first), layout.frame_on(second, joint.on_second)
        plan.add_closing_joint(joint.type.code, first, second, *frames, joint.parameter, loop)
        return
    first, second = layout.link_number[leg.first], layout.link_number[leg.second]
    ends = frame_on(leg.start, leg.first), frame_on(leg.end, leg.second)
    plan.add_leg(
        layout.link_number[leg.body],
        layout.link_number[leg.rod] if leg.rod else -1,
        first,
        second,
        layout.frame_on(first, ends[0]),
        layout.frame_on(second, ends[1]),
        norm(leg.span) / layout.length,
        leg.line,
        leg.slide_sign,
        loop,
    )


def _add_places(layout: Layout, plan: Plan) -> None:
    backward = {e.joint.name for e in layout.graph.edges if not e.forward}
    # a leg pushes the link at its end, whether that is the sphere's first or second
    backward |= {
        c.joint.name
        for c in layout.graph.closings
        if c.leg is not None and c.leg.second == c.joint.first
    }
    for name, joint in layout.mechanism.joints.items():
        plan.add_place(
            layout.joint_reference[name],
            layout.link_number[joint.first],
            layout.link_number[joint.second],
            layout.link_number[joint.point.link],
            layout.point(joint.point),
            -1.0 if name in backward else 1.0,
        )
    for name, coordinate in layout.axis_number:
        axis = coordinate_axis(layout.mechanism.joints[name], coordinate)
        (one, two) = axis.terms
        plan.add_axis(
            layout.place_number[name],
            axis.slide,
            layout.link_number[one.link],
            layout.vector(one),
            layout.link_number[two.link],
            layout.vector(two),
        )


def _add_blocks(layout: Layout, plan: Plan) -> None:
    placed: set[int] = set()
    for block in layout.graph.blocks:
        joints = [layout.graph.closings[c].joint for c in block.closings]
        needed = _new_on_ways(layout, joints, placed)
        unknown = [layout.column(k, f) for k, f in block.unknowns]
        plan.add_block(len(block.closings), sorted(needed), unknown)
        placed |= needed
    plan.set_rest([k for k in range(len(layout.carriers)) if k not in placed])


def _new_on_ways(layout: Layout, joints: Iterable[Joint], placed: set[int]) -> set[int]:
    """Kernel joints on the ways from ground to both links of some joints that are not placed yet.

    What carries a placed one is placed too.
    """
    found: set[int] = set()
    for link in (link for joint in joints for link in (joint.first, joint.second)):
        k = layout.link_number[link]
        while k >= 0 and k not in placed and k not in found:
            found.add(k)
            k = layout.carriers[k].parent
    return found


def _add_inputs(layout: Layout, plan: Plan) -> None:
    graph = layout.graph
    for (edge, freedom), (name, coordinate) in zip(graph.inputs, graph.driven, strict=True):
        joint = graph.edges[edge].joint
        along_thread = joint.letter == "H" and coordinate == "s"
        force_per_torque = 2.0 * pi * layout.length / joint.lead if along_thread else 1.0
        axis = layout.axis_number.get((name, coordinate), NO_AXIS)
        plan.add_input(layout.column(edge, freedom), axis, force_per_torque)


def _add_inertias(layout: Layout, plan: Plan) -> None:
    plan.set_gravity(scale(1.0 / layout.length, layout.mechanism.gravity))
    for name, link in layout.mechanism.links.items():
        if name == GROUND_NAME or not link.has_mass:
            continue
        centre = layout.point(Attached(name, link.center_of_mass))
        tensor = [
            i / (layout.length * layout.length)
            for i in turned_tensor(link.inertia, layout.link_frame[name])
        ]
        plan.set_inertia(layout.link_number[name], link.mass, centre, tensor)
