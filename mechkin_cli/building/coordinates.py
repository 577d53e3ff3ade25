"""Joint coordinates that a file names: what they measure, whether they exist, and what to say where
they do not."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.mechanism import joint_table
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.units import TIME, Dimension

CODE = "unknown-coordinate"


def dimension_of(coordinate: str, order: int = 0) -> Dimension:
    """What a coordinate, or its derivative of some order over time, measures."""
    return joint_table.dimension_of(coordinate) / TIME**order


def is_coordinate(fields: Fields, path: Path, name: str, joints: Mapping[str, Joint]) -> bool:
    """Whether the key at `path` names a coordinate, such as `O2.theta`; if not, that is noted."""
    wrong = _wrong(fields, name, joints)
    if wrong:
        fields.key_error(CODE, path, *wrong)
    return wrong is None


def is_coordinate_at(fields: Fields, path: Path, name: str, joints: Mapping[str, Joint]) -> bool:
    """The same of the value at `path`."""
    wrong = _wrong(fields, name, joints)
    if wrong:
        fields.error(CODE, path, *wrong)
    return wrong is None


def _wrong(
    fields: Fields, name: str, joints: Mapping[str, Joint]
) -> tuple[str, str | None] | tuple[()] | None:
    """Message and hint where a name is no coordinate; none where that is said elsewhere."""
    joint, _, coordinate = name.rpartition(".")
    if joint in joints:
        if coordinate in joints[joint].type.coordinates:
            return None
        return without(joints[joint], coordinate)
    if fields.is_refused(joint):
        return ()
    known = [c for joint in joints.values() for c in joint.coordinates]
    return f"{name} is no coordinate", nearest_hint(name, known)


def without(joint: Joint, coordinate: str) -> tuple[str, str]:
    """Message and hint for a joint that lacks a coordinate."""
    have = ", ".join(joint.type.coordinates) or "none"
    message = f"{joint.name} is of type {joint.letter} and has no coordinate {coordinate}"
    return message, f"its coordinates: {have}"
