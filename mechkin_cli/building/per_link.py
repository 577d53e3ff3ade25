"""Vectors of a joint that may be given for either link: one vector stands for both."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.places import place_at
from mechkin_cli.mechanism.vectors import Vector
from mechkin_cli.schema.joints import PointJoint

Texts = tuple[str, ...]
"""The three components of a vector, as written."""


def points_of(fields: Fields, path: Path, section: PointJoint) -> tuple[Vector, Vector]:
    """The joint's point on either link, in m."""

    def read(where: Path, given: str | Texts) -> Vector:
        return place_at(fields, where, given)

    return _per_link(read, (*path, "point"), section.point, section.links)


def directions_of(
    fields: Fields, path: Path, section: PointJoint, key: str
) -> tuple[Vector, Vector]:
    """The unit vector under `key` on either link."""
    return _per_link(fields.direction, (*path, key), getattr(section, key), section.links)


def place_of(path: Path, section: PointJoint, key: str, side: int) -> Path:
    """Where the vector for the first (0) or second (1) link stands in the file."""
    given = getattr(section, key)
    return (*path, key, section.links[side]) if isinstance(given, Mapping) else (*path, key)


def _per_link(
    read: Callable[[Path, Any], Vector],
    path: Path,
    value: Any,
    links: Sequence[str],
) -> tuple[Vector, Vector]:
    if isinstance(value, Mapping):
        return read((*path, links[0]), value[links[0]]), read((*path, links[1]), value[links[1]])
    both = read(path, value)
    return both, both
