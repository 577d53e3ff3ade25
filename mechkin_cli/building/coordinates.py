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
    joint, _, coordinate = name.partition(".")
    if joint in joints:
        if coordinate in joints[joint].type.coordinates:
            return True
        fields.key_error(CODE, path, *without(joints[joint], coordinate))
    elif not fields.is_refused(joint):
        known = [c for joint in joints.values() for c in joint.coordinates]
        fields.key_error(CODE, path, f"{name} is no coordinate", nearest_hint(name, known))
    return False


def without(joint: Joint, coordinate: str) -> tuple[str, str]:
    """Message and hint for a joint that lacks a coordinate."""
    have = ", ".join(joint.type.coordinates) or "none"
    message = f"{joint.name} is of type {joint.letter} and has no coordinate {coordinate}"
    return message, f"its coordinates: {have}"
