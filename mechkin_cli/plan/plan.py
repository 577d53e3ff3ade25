"""From the layout to the records of the kernel's plan: joints, closures, places, blocks, inputs,
inertias, loads, friction and the points that define the size.

Lengths are in the kernel's unit: a force goes with 1 / length, a moment with 1 / length squared
(length: the unit in m). The values of loads that vary are computed row by row (`plan.programs`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from mechkin_cli.mechanism import (
    GROUND_NAME,
    UPPER_HALF,
    ZERO,
    Attached,
    Bushing,
    Damper,
    JointLoad,
    LinkLoad,
    Spring,
    Varying,
    add,
    cross,
    scale,
    subtract,
    turned_tensor,
)
from mechkin_cli.plan.layout import Layout, coordinate_axis
from mechkin_cli.plan.records import ContactCode, FreeCode, LoadCode, PlanRecord, hand_over, record

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism import Constraint, Load, Loss, Motion, Rubbing, Vector
    from mechkin_cli.structure import Loop


NO_MOTION = -1
"""For turns or slides that do not rub."""


def _friction(layout: Layout, rubbing: Rubbing) -> Iterator[PlanRecord]:
    """A friction, followed by its contacts."""
    if rubbing.loss is not None:
        yield from _loss(layout, rubbing, rubbing.loss)
        return
    joint, unit = layout.mechanism.joints[rubbing.joint], layout.length
    law, axis = joint.type.friction, joint.axis
    assert law is not None
    yield record(
        "add_friction",
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
        layout.course_of(joint.name),
    )
    for contact in law.contacts(rubbing, axis.vector, joint.pitch):
        yield record(
            "add_contact",
            ContactCode[contact.kind.upper()],
            # a couple goes with one length more than a force
            contact.weight,
            contact.share,
            contact.tilt * unit,
            contact.roll * unit,
            layout.vector(Attached(axis.link, contact.direction)),
        )


def _loss(layout: Layout, rubbing: Rubbing, loss: Loss) -> Iterator[PlanRecord]:
    """The friction of a coupling; about an axis as of surfaces on the radius 1."""
    along, turns = FreeCode.ALONG, loss.turns
    yield record(
        "add_friction",
        layout.loss_number[rubbing.joint],
        along if turns else NO_MOTION,
        NO_MOTION if turns else along,
        layout.link_number[loss.carrier],
        False,
        layout.vector(Attached(loss.carrier, loss.axis)),
        1.0 if turns else 0.0,
        0.0,
        rubbing.at_rest,
        rubbing.sliding,
        1.0,
        -1,
    )
    # the mean of the moments on both sides has half the loss in it
    share, own = (loss.load, 0.5) if turns else (loss.load * layout.length, 0.0)
    yield record("add_contact", ContactCode.TRANSMITTED, 1.0, share, 0.0, own, ZERO)


def _pushes(layout: Layout) -> Iterator[PlanRecord]:
    """What couplings push apart with, as frictions without a motion: the coefficient 1 by the
    multiplier."""
    first_place = len(layout.place_number) + len(layout.loss_number)
    numbers = enumerate(layout.pushes.values(), start=first_place)
    for number, (first, _) in numbers:
        link, none = layout.link_number[first], NO_MOTION
        size = (ZERO, 0.0, 0.0, 1.0, 1.0, 1.0, -1)
        yield record("add_friction", number, none, none, link, False, *size)
        yield record("add_contact", ContactCode.TRANSMITTED, 1.0, 1.0, 0.0, 0.0, ZERO)


def _code(motion: Motion | None) -> int:
    return NO_MOTION if motion is None else FreeCode[motion.upper()]


def load_record(layout: Layout, load: Load) -> PlanRecord:
    """The record of one load; of a varying one without its value."""
    unit = layout.length
    if isinstance(load, LinkLoad):
        return _link_load(layout, load)
    if isinstance(load, JointLoad):
        axis, reference, freedom, slide = load_coordinate(layout, load.joint, load.coordinate)
        varies = isinstance(load.amount, Varying)
        constant = 0.0 if isinstance(load.amount, Varying) else load.amount
        value = (constant / (unit if slide else (unit * unit)), 0.0, 0.0)
        code = LoadCode.COORDINATE
        return record("add_load", code, axis, reference, freedom, ZERO, ZERO, value, varies)
    if isinstance(load, Bushing):
        return _bushing(layout, load)
    if load.between:
        p, q = load.between
        if isinstance(load, Spring):
            data = (load.stiffness, load.free / unit, load.preload / unit)
            code = LoadCode.SPRING
        else:
            data, code = (load.damping, 0.0, 0.0), LoadCode.DAMPER
        links = layout.link_number[p.link], layout.link_number[q.link]
        return record("add_load", code, *links, 0, layout.point(p), layout.point(q), data, False)
    return _joint_spring(layout, load)


def _bushing(layout: Layout, load: Bushing) -> PlanRecord:
    unit = layout.length
    first, second = (layout.link_number[name] for name in load.links)
    on_first, on_second = load.frames
    # by a deflection in length units, the force and the moment are in theirs
    scales = [1.0] * 3 + [1.0 / unit] * 3
    matrix = [
        entry * (scales[i] * scales[k])
        for (i, k), entry in zip(UPPER_HALF, load.matrix, strict=True)
    ]
    free = [*scale(1.0 / unit, load.free[:3]), *load.free[3:]]  # type: ignore[arg-type]
    frames = layout.frame_on(first, on_first), layout.frame_on(second, on_second)
    return record("add_bushing", load.damps, first, second, *frames, matrix, free)


def _link_load(layout: Layout, load: LinkLoad) -> PlanRecord:
    own_axes = load.axes == "link"
    x, y, z = (0.0 if isinstance(amount, Varying) else amount for amount in load.value)
    value = layout.vector(Attached(load.link, (x, y, z))) if own_axes else (x, y, z)
    if load.kind == "force":
        code = LoadCode.FORCE_LINK if own_axes else LoadCode.FORCE_GROUND
        value = scale(1.0 / layout.length, value)
        point = layout.point(Attached(load.link, load.point))
    else:
        code = LoadCode.TORQUE_LINK if own_axes else LoadCode.TORQUE_GROUND
        value, point = scale(1.0 / (layout.length * layout.length), value), ZERO
    link, varies = layout.link_number[load.link], bool(load.varying)
    return record("add_load", code, link, -1, 0, point, ZERO, value, varies)


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


def _joint_spring(layout: Layout, load: Spring | Damper) -> PlanRecord:
    place = load_coordinate(layout, load.joint or "", load.coordinate or "")
    axis, reference, freedom, slide = place
    per = 1.0 if slide else (layout.length * layout.length)
    if isinstance(load, Spring):
        code = LoadCode.COORDINATE_SPRING
        free = load.free / layout.length if slide else load.free
        preload = load.preload / (layout.length if slide else (layout.length * layout.length))
        data = (load.stiffness / per, free, preload)
    else:
        code = LoadCode.COORDINATE_DAMPER
        data = (load.damping / per, 0.0, 0.0)
    return record("add_load", code, axis, reference, freedom, ZERO, ZERO, data, False)


NO_AXIS = -1
"""For the axis of a coordinate that no user knows, which is driven only while a dead centre is
searched for, and of the coordinates of a pose, which holds nothing."""


def build_plan(layout: Layout, size: float | None = None) -> Plan:
    """The plan of a layout; `size` of the mechanism in m (None: that of its drawing).

    Raises:
        ValueError: numbers that are not finite.
    """
    return hand_over(plan_records(layout, size))


def plan_records(layout: Layout, size: float | None = None) -> list[PlanRecord]:
    """The records of a plan in the order in which its constants are numbered."""
    return [
        record(
            "units",
            layout.length,
            add(layout.mechanism.datum, layout.origin),
            layout.mechanism.box_diagonal() if size is None else size,
        ),
        *_tree_joints(layout),
        *_functions(layout),
        *(
            each
            for closing in zip(layout.graph.closings, layout.graph.loops, strict=True)
            for each in _closing(layout, *closing)
        ),
        *_places(layout),
        *_axes(layout),
        *_courses(layout),
        *_free_motions(layout),
        *_blocks(layout),
        *_inputs(layout),
        record("set_gravity", scale(1.0 / layout.length, layout.mechanism.gravity)),
        *_inertias(layout),
        *(load_record(layout, load) for load in layout.mechanism.loads),
        *(each for rubbing in layout.mechanism.frictions for each in _friction(layout, rubbing)),
        *_pushes(layout),
        *_load_program(layout),
        *_drives(layout),
        *_size_points(layout),
    ]


def _tree_joints(layout: Layout) -> Iterator[PlanRecord]:
    for carrier in layout.carriers:
        yield record(
            "add_tree_joint",
            carrier.part.type.code,
            carrier.parent,
            (
                layout.graph.edges[carrier.edge].joint.pitch
                if carrier.part.track is None
                else carrier.part.sense
            )
            / layout.length,
            layout.frame_on(carrier.parent, carrier.part.before),
        )


def _closing(layout: Layout, constraint: Constraint, loop: Loop) -> Iterator[PlanRecord]:
    if constraint.terms:
        yield from _relation(layout, constraint, loop)
        return
    passed = [(k, float(s)) for e, s in loop for k in layout.parts_of[e]]
    first, second = layout.link_number[constraint.first], layout.link_number[constraint.second]
    one, other = constraint.frames
    frames = layout.frame_on(first, one), layout.frame_on(second, other)
    hung = constraint.hung
    if hung is None or constraint.length is None:
        code, parameter = constraint.code, constraint.parameter
        yield record("add_closing_joint", code, first, second, *frames, parameter, passed)
        return
    yield record(
        "add_hung_links",
        layout.link_number[hung.body],
        layout.link_number[hung.rod] if hung.rod else -1,
        first,
        second,
        *frames,
        constraint.length / layout.length,
        hung.line,
        hung.slide_sign,
        passed,
    )


def _relation(layout: Layout, constraint: Constraint, loop: Loop) -> Iterator[PlanRecord]:
    relation = layout.mechanism.couplings[constraint.owner]
    rows = layout.relation_rows(relation, loop)
    total = relation.total / layout.length if relation.length else relation.total
    places = [(row.part, row.sign, row.freedom, row.axis, row.function) for row in rows]
    factors, arguments = [row.factor for row in rows], [row.argument for row in rows]
    yield record("add_relation", relation.length, places, factors, arguments, total)
    mesh = relation.mesh
    if mesh is None:
        return
    signs, carrier = dict(loop), layout.link_number[mesh.carrier]
    point, *forces = _force_of(layout, mesh.carrier, mesh.point, mesh.along, mesh.apart)
    way = [(layout.edge_number[name], sense) for name, sense in mesh.way]
    path = [(k, float(signs[e] * sense)) for e, sense in way for k in layout.parts_of[e]]
    yield record("add_mesh", carrier, point, *forces, path)
    if mesh.other is not None:
        yield record("add_force", *_force_of(layout, mesh.carrier, *mesh.other))


def _force_of(
    layout: Layout, carrier: str, point: Vector, *parts: Vector
) -> tuple[Vector, Vector, Vector]:
    """A force of a mesh in the carrier's frame: its point, and its parts per unit moment."""
    along, apart = (scale(layout.length, layout.vector(Attached(carrier, part))) for part in parts)
    return layout.point(Attached(carrier, point)), along, apart


def _functions(layout: Layout) -> Iterator[PlanRecord]:
    if not layout.functions and not layout.carried:
        return
    from mechkin_cli.plan.programs import function_record, track_record

    yield from map(function_record, layout.functions)
    for k, track in layout.carried:
        yield track_record(track, layout.carriers[k].part.before.o)


def _places(layout: Layout) -> Iterator[PlanRecord]:
    backward = {e.joint.name for e in layout.graph.edges if not e.forward}
    # the multipliers push the second link, whether that is the joint's second or first
    backward |= {c.name for c in layout.graph.closings if c.is_reversed}
    for name, joint in layout.mechanism.joints.items():
        yield record(
            "add_place",
            layout.joint_reference[name],
            layout.link_number[joint.first],
            layout.link_number[joint.second],
            layout.link_number[joint.point.link],
            layout.point(joint.point),
            -1.0 if name in backward else 1.0,
        )
    for rubbing in layout.mechanism.frictions:
        loss = rubbing.loss
        if loss is None:
            continue
        yield record(
            "add_place",
            -1 - layout.coupling_number[rubbing.joint],
            *(layout.link_number[link] for link in (loss.first, loss.second, loss.carrier)),
            layout.point(Attached(loss.carrier, loss.point)),
            1.0,
        )
    for name, links in layout.pushes.items():
        mesh = layout.mechanism.couplings[name].mesh
        assert mesh is not None
        yield record(
            "add_place",
            -1 - layout.coupling_number[name],
            *(layout.link_number[link] for link in (*links, mesh.carrier)),
            layout.point(Attached(mesh.carrier, mesh.point)),
            1.0,
        )


def _axes(layout: Layout) -> Iterator[PlanRecord]:
    for name, coordinate in layout.axis_number:
        slide, one, two = coordinate_axis(layout.mechanism.joints[name], coordinate)
        yield record(
            "add_axis",
            layout.place_number[name],
            slide,
            layout.link_number[one.link],
            layout.vector(one),
            layout.link_number[two.link],
            layout.vector(two),
        )


def _courses(layout: Layout) -> Iterator[PlanRecord]:
    """The functions of carriages stand behind those of coordinates."""
    for number, (k, track) in enumerate(layout.carried, start=len(layout.functions)):
        joint = layout.graph.edges[layout.carriers[k].edge].joint
        pairs = [(joint.name, name) for name in track.names]
        axes = [layout.axis_number[pair] for pair in pairs if pair in layout.axis_number]
        yield record("set_course", k, number, axes)


def _free_motions(layout: Layout) -> Iterator[PlanRecord]:
    """Of every joint: a slide or a turn along one direction, or square to one, or every one."""
    for name, joint in layout.mechanism.joints.items():
        place = layout.place_number[name]
        for slide, free in ((True, joint.free_slides), (False, joint.free_turns)):
            if free is None or len(free) > 2:
                yield record("add_free_motion", place, slide, FreeCode.ALL, -1, ZERO)
            elif slide and len(free) == 2:
                one, two = free
                normal = Attached(one.link, cross(one.vector, two.vector))
                yield _free(layout, place, slide, FreeCode.SQUARE, normal)
            else:
                for at in free:
                    yield _free(layout, place, slide, FreeCode.ALONG, at)


def _free(layout: Layout, place: int, slide: bool, code: FreeCode, at: Attached) -> PlanRecord:
    return record(
        "add_free_motion", place, slide, code, layout.link_number[at.link], layout.vector(at)
    )


def _blocks(layout: Layout) -> Iterator[PlanRecord]:
    placed: set[int] = set()
    for block in layout.graph.blocks:
        constraints = [layout.graph.closings[c] for c in block.closings]
        links = [link for constraint in constraints for link in constraint.placed]
        passed = [k for c in block.closings for k, _ in layout.graph.loops[c]]
        links += [layout.graph.edges[k].child for k in passed]
        needed = _new_on_paths(layout, [layout.link_number[link] for link in links], placed)
        if block.charts:
            ends = [layout.carrier_of(*unknown)[0] for unknown in block.unknowns]
            needed |= _new_on_paths(layout, ends, placed | needed)
        unknown = [layout.column(k, f) for k, f in block.unknowns]
        yield record("add_block", len(block.closings), sorted(needed), unknown, block.charts)
        placed |= needed
    yield record("set_rest", [k for k in range(len(layout.carriers)) if k not in placed])


def _new_on_paths(layout: Layout, ends: Iterable[int], placed: set[int]) -> set[int]:
    """Kernel joints on the paths from ground to some that are not placed yet; the joints before a
    placed one are placed, too."""
    new: set[int] = set()
    for k in ends:
        while k >= 0 and k not in placed and k not in new:
            new.add(k)
            k = layout.carriers[k].parent
    return new


def _inputs(layout: Layout) -> Iterator[PlanRecord]:
    graph = layout.graph
    for (edge, freedom), (name, coordinate) in zip(graph.inputs, graph.driven, strict=True):
        joint = graph.edges[edge].joint
        # a force along a thread is driven as the torque about it
        known = joint.type.coordinate.get(coordinate)
        on_thread = known is not None and known.on_thread
        force_per_torque = layout.length / joint.pitch if on_thread else 1.0
        axis = layout.axis_number.get((name, coordinate), NO_AXIS)
        yield record("add_input", layout.column(edge, freedom), axis, force_per_torque)


def _inertias(layout: Layout) -> Iterator[PlanRecord]:
    for name, link in layout.mechanism.links.items():
        if name == GROUND_NAME or not link.has_mass:
            continue
        centre = layout.point(Attached(name, link.center_of_mass))
        tensor = [
            i / (layout.length * layout.length)
            for i in turned_tensor(link.inertia, layout.link_frame[name])
        ]
        yield record("set_inertia", layout.link_number[name], link.mass, centre, tensor)


def _load_program(layout: Layout) -> Iterator[PlanRecord]:
    if layout.laws is None:
        return
    from mechkin_cli.plan.programs import load_program

    yield from (record("set_load_program", *program) for program in load_program(layout))


def _drives(layout: Layout) -> Iterator[PlanRecord]:
    drives = layout.drives
    if drives is None:
        return
    yield record("set_driven", len(drives.inputs))
    for joint, coordinate in drives.actuators:
        axis, reference, freedom, _ = load_coordinate(layout, joint, coordinate)
        yield record("add_actuator", axis, reference, freedom)
    yield from (record("add_input_constraint", *constraint) for constraint in drives.constraints)


def _size_points(layout: Layout) -> Iterator[PlanRecord]:
    for _, at in layout.mechanism.joint_points():
        on_ground = at.link == GROUND_NAME
        point = subtract(at.vector, layout.origin) if on_ground else layout.point(at)
        yield record("add_size_point", layout.link_number[at.link], point)
