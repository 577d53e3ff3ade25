"""`limits:` to the ends of coordinates in SI, and inputs that are too large to compute with."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building.cylinders import SLIDE
from mechkin_cli.building.fields import Fields, Path, is_coordinate
from mechkin_cli.building.tracks import track_ends
from mechkin_cli.mechanism import Joint, Limit, Relation, dimension_of
from mechkin_cli.schema import LimitSection, MechanismFile
from mechkin_cli.tape import within
from mechkin_cli.tolerances import LARGEST_NUMBER, LARGEST_TURNS
from mechkin_cli.units import ANGLE, DIMENSIONLESS

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


def build_limits(
    fields: Fields,
    file: MechanismFile,
    joints: Mapping[str, Joint],
    couplings: Mapping[str, Relation],
) -> tuple[Limit, ...]:
    """Where coordinates end (rad, m): by `limits:`, the strokes of cylinders, the ends of curves
    and of surfaces and the tables of couplings; of two for one coordinate what both leave. Errors
    are noted in `fields`."""
    written: dict[str, tuple[Path, tuple[str, ...] | LimitSection]] = {
        name: (("limits", name), section) for name, section in file.limits.items()
    }
    for cylinder, section in file.cylinders.items():
        name = f"{cylinder}.{SLIDE}"
        if section.stroke is None or cylinder not in joints:
            continue
        if name in written:
            text = f"the limits of {name} are its stroke"
            fields.key_error("two-choices", ("limits", name), text, "keep one of the two")
            continue
        written[name] = ("cylinders", cylinder, "stroke"), section.stroke
    limits = {limit.name: limit for limit in _written(fields, written, joints)}
    for limit in (*_of_tracks(fields, file, joints), *_of_tables(fields, couplings)):
        other = limits.get(limit.name, limit)
        ends = max(limit.low, other.low), min(limit.high, other.high)
        limits[limit.name] = other._replace(low=ends[0], high=ends[1])
    return tuple(limits.values())


def read_restitution(fields: Fields, path: Path, text: str) -> float | None:
    """The part of a rate in the section at `path`; None where an error is noted."""
    place, errors = (*path, "restitution"), fields.error_count
    restitution = fields.number(place, text, DIMENSIONLESS)
    if fields.error_count > errors:
        return None
    if not (restitution >= 0.0 and restitution <= 1.0):
        text = "a restitution is a number from 0 to 1"
        fields.error("no-restitution", place, text, "write the part of the rate")
        return None
    return restitution


def _of_tracks(fields: Fields, file: MechanismFile, joints: Mapping[str, Joint]) -> Iterator[Limit]:
    """The ends of curves and surfaces."""
    for (joint, coordinate), (path, low, high) in track_ends(fields, file, joints).items():
        yield Limit(joint, coordinate, low, high, fields.document.key_place(path))


def _of_tables(fields: Fields, couplings: Mapping[str, Relation]) -> Iterator[Limit]:
    """The ends of the tables of couplings, but of those that hold for every turn."""
    for name, relation in couplings.items():
        for term in relation.terms:
            if term.law is not None and term.law.curve is not None and term.law.period == 0.0:
                place, curve = fields.document.place(("couplings", name)), term.law.curve
                yield Limit(term.joint.name, term.coordinate, curve.first, curve.last, place)


def _written(
    fields: Fields,
    sections: Mapping[str, tuple[Path, tuple[str, ...] | LimitSection]],
    joints: Mapping[str, Joint],
) -> Iterator[Limit]:
    """The limits that a file writes as numbers: by coordinate the place and what stands there."""
    for name, (path, written) in sections.items():
        if not is_coordinate(fields, path, name, joints):
            continue
        joint, _, coordinate = name.rpartition(".")
        dimension = dimension_of(coordinate)
        ends, errors = [], fields.error_count
        low, high = ("min", "max") if isinstance(written, LimitSection) else (0, 1)
        texts = (written.min, written.max) if isinstance(written, LimitSection) else written
        for key, text, none in zip((low, high), texts, (-inf, inf), strict=True):
            ends.append(none if text is None else fields.number((*path, key), text, dimension))
        if fields.error_count > errors:
            continue
        if not ends[0] < ends[1]:
            hint = "write the least value first, then the largest"
            text = f"the limits of {name} leave it no room"
            fields.error("no-room", (*path, high), text, hint)
            continue
        restitution = None
        if isinstance(written, LimitSection) and written.restitution is not None:
            restitution = read_restitution(fields, path, written.restitution)
            if restitution is None:
                continue
        here = fields.document.key_place(path)
        yield Limit(joint, coordinate, ends[0], ends[1], here, restitution)


_ORDERS = ("value", "rate", "acceleration", "jerk")


def refuse_too_large(
    fields: Fields, joints: Mapping[str, Joint], path: Path, written: Floats, in_si: list[Floats]
) -> None:
    """Notes numbers of the input at `path` that are too large to compute with: values, as `written`
    and in SI, and rates."""
    name = str(path[-1])
    for word, values in zip(_ORDERS, in_si, strict=False):
        if not within(values, LARGEST_NUMBER):
            fields.error(
                "too-large",
                path,
                f"the {word} of {name} grows too large to compute with",
                "check the law and its units",
                measured=f"{float(np.abs(values).max()):.4g} in SI units",
                limit=f"{LARGEST_NUMBER:g}",
            )
            return
    joint, _, coordinate = name.rpartition(".")
    _refuse_lost_turns(fields, path, joints[joint], coordinate, in_si[0], written)


def _refuse_lost_turns(
    fields: Fields, path: Path, joint: Joint, coordinate: str, in_si: Floats, written: Floats
) -> None:
    """Notes an angle of more turns than leave a place within one."""
    most = 2.0 * pi * LARGEST_TURNS
    if not joint.type.chain[joint.freedom_number(coordinate)].is_cyclic or within(in_si, most):
        return
    unit = fields.units.label(ANGLE)
    fields.error(
        "too-large",
        path,
        f"{path[-1]} has so many turns that nothing is left of the place within one",
        "write the angle within a turn",
        measured=f"{float(np.abs(written).max()):.4g} {unit}",
        limit=f"{float(fields.units.from_si(most, ANGLE)):.4g} {unit}",
    )
