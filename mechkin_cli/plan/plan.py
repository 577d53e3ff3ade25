"""From the layout to the records of the kernel's plan: joints, closures, places, blocks, inputs,
inertias, loads and the points that tell the size.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from mechkin_cli.mechanism import (
    GROUND_NAME,
    ZERO,
    Attached,
    Constraint,
    Damper,
    JointLoad,
    LinkLoad,
    Spring,
    Varying,
    cross,
    scale,
    turned_tensor,
    varying,
)
from mechkin_cli.plan.codes import ContactCode, FreeCode, LoadCode
from mechkin_cli.plan.layout import Layout, coordinate_axis
from mechkin_cli.plan.records import (
    Actuator,
    AppliedLoad,
    ClosingJoint,
    Driven,
    FreeDirections,
    Friction,
    HungLinks,
    Inertia,
    Input,
    JointAxis,
    JointPlace,
    PlanBlock,
    PlanContact,
    PlanGravity,
    PlanRecord,
    Program,
    Rest,
    SizePoint,
    Transmission,
    TreeJoint,
    Units,
    hand_over,
)
from mechkin_cli.structure import CutJoint

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Motion, Rubbing


# The friction of joints as records of the kernel's plan, lengths in the kernel's unit.

NO_MOTION = -1
"""Stands for turns or slides that do not rub."""


def friction_records(layout: Layout) -> Iterator[Friction | PlanContact]:
    """Each friction, followed by its contacts."""
    for rubbing in layout.mechanism.frictions:
        yield from _records(layout, rubbing)


def _records(layout: Layout, rubbing: Rubbing) -> Iterator[Friction | PlanContact]:
    joint, unit = layout.mechanism.joints[rubbing.joint], layout.length
    law, axis = joint.type.friction, joint.axis
    assert law is not None
    yield Friction(
        layout.place_number[joint.name],
        _code(law.turns),
        _code(law.slides),
        layout.link_number[axis.link],
        rubbing.speed is not None,
        layout.vector(axis),
        0.0 if rubbing.radius is None else rubbing.radius / unit,
        joint.pitch / unit,
        rubbing.at_rest,
        rubbing.sliding,
        1.0 if rubbing.speed is None else rubbing.speed / unit,
    )
    for contact in law.contacts(rubbing, axis.vector, joint.pitch):
        yield PlanContact(
            ContactCode[contact.kind.upper()],
            # a couple goes with one length more than a force
            contact.weight,
            contact.share,
            contact.tilt * unit,
            contact.roll * unit,
            layout.vector(Attached(axis.link, contact.direction)),
        )


def _code(motion: Motion | None) -> int:
    return NO_MOTION if motion is None else FreeCode[motion.upper()]


# The loads of a mechanism as records of the kernel's plan: codes, links or coordinates, values.
#
# A force goes with 1 / length, a moment with 1 / length squared (length: the kernel's unit in m).
# The values of loads that vary are given row by row (`varying_loads`).


def load_record(layout: Layout, load: LinkLoad | JointLoad | Spring | Damper) -> AppliedLoad:
    """The record of one load; of a varying one without its value."""
    unit = layout.length
    if isinstance(load, LinkLoad):
        return _link_load(layout, load)
    if isinstance(load, JointLoad):
        axis, reference, freedom, slide = load_coordinate(layout, load.joint, load.coordinate)
        varies = isinstance(load.value, Varying)
        constant = 0.0 if isinstance(load.value, Varying) else load.value
        value = (constant / (unit if slide else (unit * unit)), 0.0, 0.0)
        code = LoadCode.COORDINATE
        return AppliedLoad(code, axis, reference, freedom, ZERO, ZERO, value, varies)
    if load.between:
        p, q = load.between
        if isinstance(load, Spring):
            data = (load.stiffness, load.free / unit, load.preload / unit)
            code = LoadCode.SPRING
        else:
            data, code = (load.damping, 0.0, 0.0), LoadCode.DAMPER
        links = layout.link_number[p.link], layout.link_number[q.link]
        return AppliedLoad(code, *links, 0, layout.point(p), layout.point(q), data)
    return _joint_spring(layout, load)


def _link_load(layout: Layout, load: LinkLoad) -> AppliedLoad:
    own_axes = load.axes == "link"
    x, y, z = (0.0 if isinstance(amount, Varying) else amount for amount in load.value)
    value = layout.vector(Attached(load.link, (x, y, z))) if own_axes else (x, y, z)
    if load.kind == "force":
        code = LoadCode.FORCE_LINK if own_axes else LoadCode.FORCE_GROUND
        value, point = (
            scale(1.0 / layout.length, value),
            layout.point(Attached(load.link, load.point)),
        )
    else:
        code = LoadCode.TORQUE_LINK if own_axes else LoadCode.TORQUE_GROUND
        value, point = scale(1.0 / (layout.length * layout.length), value), ZERO
    link, varies = layout.link_number[load.link], bool(varying(load))
    return AppliedLoad(code, link, -1, 0, point, ZERO, value, varies)


def load_coordinate(layout: Layout, name: str, coordinate: str) -> tuple[int, int, int, bool]:
    """Axis, kernel joint and freedom there of a joint's coordinate, and whether it is a
    slide."""
    joint = layout.mechanism.joints[name]
    freedom = joint.type.freedom_of[coordinate]
    slide = not joint.type.coordinate[coordinate].is_angle
    axis = layout.axis_number[name, coordinate]
    for number, edge in enumerate(layout.graph.edges):
        if edge.joint.name == name:
            return axis, *layout.carrier_of(number, freedom), slide
    return axis, layout.joint_reference[name], freedom, slide


def _joint_spring(layout: Layout, load: Spring | Damper) -> AppliedLoad:
    axis, reference, freedom, slide = load_coordinate(
        layout, load.joint or "", load.coordinate or ""
    )
    per = 1.0 if slide else (layout.length * layout.length)
    if isinstance(load, Spring):
        code = LoadCode.COORDINATE_SPRING
        free = load.free / layout.length if slide else load.free
        preload = load.preload / (layout.length if slide else (layout.length * layout.length))
        data = (load.stiffness / per, free, preload)
    else:
        code = LoadCode.COORDINATE_DAMPER
        data = (load.damping / per, 0.0, 0.0)
    return AppliedLoad(code, axis, reference, freedom, ZERO, ZERO, data)


NO_AXIS = -1
"""Stands for the axis of a coordinate that no user knows, which is driven only while a dead centre
is looked for, and of the coordinates of a pose, which holds nothing."""


def build_plan(layout: Layout, size: float | None = None) -> Plan:
    """As `Layout.build`."""
    return hand_over(plan_records(layout, size))


def _drawn_size(layout: Layout) -> float:
    return layout.mechanism.box_diagonal()


def plan_records(layout: Layout, size: float | None = None) -> list[PlanRecord]:
    """The records of a plan in the order in which its constants are numbered."""
    return [
        Units(layout.length, layout.origin, _drawn_size(layout) if size is None else size),
        *_tree_joints(layout),
        *(_closing(layout, closing) for closing in layout.graph.closings),
        *_places(layout),
        *_axes(layout),
        *_free_motions(layout),
        *_blocks(layout),
        *_inputs(layout),
        PlanGravity(scale(1.0 / layout.length, layout.mechanism.gravity)),
        *_inertias(layout),
        *(load_record(layout, load) for load in layout.mechanism.loads),
        *friction_records(layout),
        *_load_program(layout),
        *_drives(layout),
        *_size_points(layout),
    ]


def _tree_joints(layout: Layout) -> Iterator[TreeJoint]:
    for carrier in layout.carriers:
        yield TreeJoint(
            carrier.part.type.code,
            carrier.parent,
            layout.graph.edges[carrier.edge].joint.pitch / layout.length,
            layout.frame_on(carrier.parent, carrier.part.before),
        )


def _closing(layout: Layout, closing: CutJoint) -> ClosingJoint | HungLinks:
    constraint = closing.constraint
    loop = [(k, float(s)) for e, s in closing.loop for k in layout.parts_of[e]]
    first, second = layout.link_number[constraint.first], layout.link_number[constraint.second]
    one, other = constraint.frames
    frames = layout.frame_on(first, one), layout.frame_on(second, other)
    hung = constraint.hung
    if hung is None or constraint.length is None:
        return ClosingJoint(constraint.code, first, second, *frames, constraint.parameter, loop)
    return HungLinks(
        layout.link_number[hung.body],
        layout.link_number[hung.rod] if hung.rod else -1,
        first,
        second,
        *frames,
        constraint.length / layout.length,
        hung.line,
        hung.slide_sign,
        loop,
    )


def _places(layout: Layout) -> Iterator[JointPlace]:
    backward = {e.joint.name for e in layout.graph.edges if not e.forward}
    # the multipliers push the second link, whether that is the joint's second or first
    backward |= {c.name for c in layout.graph.closings if c.constraint.is_reversed}
    for name, joint in layout.mechanism.joints.items():
        yield JointPlace(
            layout.joint_reference[name],
            layout.link_number[joint.first],
            layout.link_number[joint.second],
            layout.link_number[joint.point.link],
            layout.point(joint.point),
            -1.0 if name in backward else 1.0,
        )


def _axes(layout: Layout) -> Iterator[JointAxis]:
    for name, coordinate in layout.axis_number:
        axis = coordinate_axis(layout.mechanism.joints[name], coordinate)
        (one, two) = axis.terms
        yield JointAxis(
            layout.place_number[name],
            axis.slide,
            layout.link_number[one.link],
            layout.vector(one),
            layout.link_number[two.link],
            layout.vector(two),
        )


def _free_motions(layout: Layout) -> Iterator[FreeDirections]:
    """Of every joint: a slide or a turn along one direction, or square to one, or every one."""
    for name, joint in layout.mechanism.joints.items():
        place = layout.place_number[name]
        for slide, free in ((True, joint.free_slides), (False, joint.free_turns)):
            if free is None or len(free) > 2:
                yield FreeDirections(place, slide, FreeCode.ALL, -1, ZERO)
            elif slide and len(free) == 2:
                one, two = free
                normal = Attached(one.link, cross(one.vector, two.vector))
                yield _free(layout, place, slide, FreeCode.SQUARE, normal)
            else:
                for at in free:
                    yield _free(layout, place, slide, FreeCode.ALONG, at)


def _free(layout: Layout, place: int, slide: bool, code: FreeCode, at: Attached) -> FreeDirections:
    return FreeDirections(place, slide, code, layout.link_number[at.link], layout.vector(at))


def _blocks(layout: Layout) -> Iterator[PlanBlock | Rest]:
    placed: set[int] = set()
    for block in layout.graph.blocks:
        constraints = [layout.graph.closings[c].constraint for c in block.closings]
        needed = _new_on_ways(layout, constraints, placed)
        if block.charts:
            needed |= _new_carrying(layout, block.unknowns, placed | needed)
        unknown = [layout.column(k, f) for k, f in block.unknowns]
        yield PlanBlock(len(block.closings), sorted(needed), unknown, block.charts)
        placed |= needed
    yield Rest([k for k in range(len(layout.carriers)) if k not in placed])


def _new_on_ways(layout: Layout, constraints: Iterable[Constraint], placed: set[int]) -> set[int]:
    """Kernel joints on the ways from ground to what some constraints place that are not placed yet.

    What carries a placed one is placed too.
    """
    found: set[int] = set()
    for link in (link for constraint in constraints for link in constraint.placed):
        k = layout.link_number[link]
        while k >= 0 and k not in placed and k not in found:
            found.add(k)
            k = layout.carriers[k].parent
    return found


def _new_carrying(
    layout: Layout, unknowns: Iterable[tuple[int, int]], placed: set[int]
) -> set[int]:
    """Kernel joints with some freedoms, and what carries them, that are not placed yet."""
    found: set[int] = set()
    for edge, freedom in unknowns:
        k, _ = layout.carrier_of(edge, freedom)
        while k >= 0 and k not in placed and k not in found:
            found.add(k)
            k = layout.carriers[k].parent
    return found


def _inputs(layout: Layout) -> Iterator[Input]:
    graph = layout.graph
    for (edge, freedom), (name, coordinate) in zip(graph.inputs, graph.driven, strict=True):
        joint = graph.edges[edge].joint
        # a force along a thread is driven as the torque about it
        known = joint.type.coordinate.get(coordinate)
        on_thread = known is not None and known.on_thread
        force_per_torque = layout.length / joint.pitch if on_thread else 1.0
        axis = layout.axis_number.get((name, coordinate), NO_AXIS)
        yield Input(layout.column(edge, freedom), axis, force_per_torque)


def _inertias(layout: Layout) -> Iterator[Inertia]:
    for name, link in layout.mechanism.links.items():
        if name == GROUND_NAME or not link.has_mass:
            continue
        centre = layout.point(Attached(name, link.center_of_mass))
        tensor = [
            i / (layout.length * layout.length)
            for i in turned_tensor(link.inertia, layout.link_frame[name])
        ]
        yield Inertia(layout.link_number[name], link.mass, centre, tensor)


def _load_program(layout: Layout) -> list[Program]:
    if layout.laws is None:
        return []
    from mechkin_cli.plan.programs import load_program

    return load_program(layout)


def _drives(layout: Layout) -> Iterator[Driven | Actuator | Transmission]:
    drives = layout.drives
    if drives is None:
        return
    yield Driven(len(drives.inputs))
    for joint, coordinate in drives.actuators:
        axis, reference, freedom, _ = load_coordinate(layout, joint, coordinate)
        yield Actuator(axis, reference, freedom)
    yield from (Transmission(*constraint) for constraint in drives.constraints)


def _size_points(layout: Layout) -> Iterator[SizePoint]:
    for _, at in layout.mechanism.joint_points():
        ground = at.link == GROUND_NAME
        yield SizePoint(layout.link_number[at.link], at.vector if ground else layout.point(at))


# Values of varying loads as the kernel takes them.
#
# A load along a coordinate has one column, a load on a link three: its components in the axes that
# it is given in, in the kernel's units, in the order of the mechanism's loads.
