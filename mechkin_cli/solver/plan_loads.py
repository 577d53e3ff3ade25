"""The loads of a mechanism as records of the kernel's plan: codes, links or coordinates, values.

A force goes with 1 / length, a moment with 1 / length squared (length: the kernel's unit in m). The
values of loads that vary are given row by row (`varying_loads`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.model import (
    Attached,
    Damper,
    JointLoad,
    LinkLoad,
    Spring,
    Varying,
    varying,
)
from mechkin_cli.mechanism.vectors import ZERO, scale
from mechkin_cli.solver.codes import LoadCode
from mechkin_cli.solver.records import AppliedLoad

if TYPE_CHECKING:
    from mechkin_cli.solver.layout import Layout


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
