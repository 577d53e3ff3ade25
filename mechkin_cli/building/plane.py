"""A file in a plane as one in space: the plane is z = 0, and its normal is the axis of all turns.

Every key keeps its path, so that errors are reported where a value is written; the values that a
plane file omits are literals, which have no errors of their own. That no cut joint repeats the
constraints of the plane is up to the pairs (mechanism/pairs.py).
"""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.schema import (
    AnyFile,
    AnyLoad,
    DirectionOfLink,
    ForceOnLink,
    FrictionAtJoint,
    Gravity,
    Link,
    LinkInertia,
    MechanismFile,
    PointOfLink,
    TorqueOnLink,
    fields_of,
    links_joints as spatial,
    plane as written,
    section_of,
)

Texts = tuple[str, ...]
Place = str | Texts
"""A vector of the plane, or the name of a point."""

_NORMAL: Texts = ("0", "0", "1")
_DOWN: Texts = ("0", "-1", "0")


class PlaneInSpace(MechanismFile):
    """A file in a plane as one in space."""

    in_plane = True


class _PinInSlot(spatial.PointJoint):
    """Ps with the normal that it turns about."""

    type: str
    normal: Texts
    slot: Texts


def in_space(file: AnyFile) -> MechanismFile:
    """A file in a plane as one in space."""
    assert isinstance(file, written.PlaneFile)
    common = {field.name: getattr(file, field.name) for field in fields_of(AnyFile).values()}
    return section_of(
        PlaneInSpace,
        **common,
        links={name: _link(link) for name, link in file.links.items()},
        joints={name: _joint(joint) for name, joint in file.joints.items()},
        points={
            name: section_of(PointOfLink, link=point.link, at=_flat(point.at))
            for name, point in file.points.items()
        },
        directions={
            name: section_of(DirectionOfLink, link=one.link, vector=_flat(one.vector))
            for name, one in file.directions.items()
        },
        loads=tuple(_load(load) for load in file.loads),
    )


def _flat(place: Place) -> Place:
    """A vector of the plane in space; a name stays a name."""
    return place if isinstance(place, str) else (*place, "0")


def _each(place: Place | Mapping[str, Place]) -> Place | Mapping[str, Place]:
    """One vector, or one per link, in space."""
    if isinstance(place, Mapping):
        return {link: _flat(one) for link, one in place.items()}
    return _flat(place)


def _link(link: written.PlaneLink) -> Link:
    centre, normal = link.center_of_mass, link.inertia
    return section_of(
        Link,
        mass=link.mass,
        center_of_mass=None if centre is None else _flat(centre),
        inertia=None if normal is None else section_of(LinkInertia, zz=normal),
    )


def _joint(joint: spatial.JointBase) -> spatial.AnyJoint:
    links = joint.links
    if isinstance(joint, written.PlaneRevoluteJoint):
        zero = None if joint.zero is None else _each(joint.zero)
        of_pin = {"links": links, "point": _each(joint.point), "axis": _NORMAL, "zero": zero}
        return section_of(spatial.RevoluteJoint, type=joint.type, **of_pin)
    if isinstance(joint, written.PlanePrismaticJoint):
        # seen along the axis, the normal of either drawing is the plane's
        square = dict.fromkeys(links, _NORMAL)
        of_guide = {"point": _each(joint.point), "axis": _each(joint.axis), "zero": square}
        return section_of(spatial.PrismaticJoint, type=joint.type, links=links, **of_guide)
    if isinstance(joint, written.PinInSlotJoint):
        of_slot = {"point": _each(joint.point), "normal": _NORMAL, "slot": _flat(joint.slot)}
        return section_of(_PinInSlot, type=joint.type, links=links, **of_slot)  # type: ignore[return-value]
    assert isinstance(joint, written.PlaneWeldJoint)
    return section_of(spatial.WeldJoint, type="W", links=links)


def _load(load: object) -> AnyLoad:
    if isinstance(load, written.PlaneGravity):
        g = load.g if isinstance(load.g, str) else _flat(load.g)
        direction = None if load.direction is None else _flat(load.direction)
        if isinstance(g, str) and direction is None:
            direction = _DOWN
        return section_of(Gravity, type=load.type, g=g, direction=direction, runs=load.runs)
    if isinstance(load, written.PlaneForce):
        force = (*load.force, "0")
        of_force = {"link": load.link, "point": _flat(load.point), "force": force}
        return section_of(ForceOnLink, type=load.type, axes=load.axes, runs=load.runs, **of_force)
    if isinstance(load, written.PlaneTorque):
        of_torque = {"link": load.link, "torque": ("0", "0", load.torque)}
        return section_of(TorqueOnLink, type=load.type, runs=load.runs, **of_torque)
    if isinstance(load, written.PlaneFriction):
        common = {field.name: getattr(load, field.name) for field in fields_of(type(load)).values()}
        return section_of(FrictionAtJoint, **common)
    return load  # type: ignore[return-value]
