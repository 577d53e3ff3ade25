"""`limits:` to the ends of coordinates in SI."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from mechkin_cli.building.fields import Fields, Path, is_coordinate
from mechkin_cli.mechanism import Joint, Limit, dimension_of
from mechkin_cli.schema import LimitSection


def build_limits(
    fields: Fields,
    limits: Mapping[str, tuple[str, str] | LimitSection],
    joints: Mapping[str, Joint],
) -> tuple[Limit, ...]:
    """Where the coordinates of `limits` end; errors are noted in `fields`."""
    found = []
    for name, written in limits.items():
        path: Path = ("limits", name)
        if not is_coordinate(fields, path, name, joints):
            continue
        joint, _, coordinate = name.rpartition(".")
        dimension = dimension_of(coordinate)
        ends, errors = [], fields.error_count
        low, high = (0, 1) if isinstance(written, tuple) else ("min", "max")
        texts = written if isinstance(written, tuple) else (written.min, written.max)
        for key, text, none in zip((low, high), texts, (-inf, inf), strict=True):
            ends.append(none if text is None else fields.number((*path, key), text, dimension))
        if fields.error_count > errors:
            continue
        if not ends[0] < ends[1]:
            hint = "write the least value first, then the largest"
            text = f"the limits of {name} leave it no room"
            fields.error("no-room", (*path, high), text, hint)
            continue
        found.append(Limit(joint, coordinate, ends[0], ends[1], fields.document.key_place(path)))
    return tuple(found)
