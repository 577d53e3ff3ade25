"""The motion section to input values over the rows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.building.coordinates import is_coordinate
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.sequences import by_count, by_step
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.motion import DrivenInput, Motion
from mechkin_cli.units import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_RATE,
    LENGTH,
    VELOCITY,
)

Floats = NDArray[np.float64]

MOST_ROWS = 10_000_000
"""More rows than this are a slip of the pen: their tables would not fit into memory."""

_DIMENSIONS = {
    "theta": (ANGLE, ANGULAR_RATE, ANGULAR_ACCELERATION),
    "s": (LENGTH, VELOCITY, ACCELERATION),
}
_DIMENSIONS |= dict.fromkeys(("theta1", "theta2"), _DIMENSIONS["theta"])
_DIMENSIONS |= dict.fromkeys(("x", "y"), _DIMENSIONS["s"])


def build_motion(fields: Fields, section: Any, joints: Mapping[str, Joint]) -> Motion:
    """Inputs with their values; without inputs the motion has one row."""
    nothing = Motion((), 1)
    if section is None or not section.inputs:
        return nothing
    errors = fields.error_count
    inputs, rows = _inputs(fields, section, joints)
    if fields.error_count == errors:
        return Motion(inputs, rows)
    for joint in joints.values():
        efforts = (f"{name}.effort" for name in (joint.name, *joint.coordinates))
        fields.refused.update(efforts)
    return nothing


def _inputs(
    fields: Fields, section: Any, joints: Mapping[str, Joint]
) -> tuple[tuple[DrivenInput, ...], int]:
    if section.time is not None:
        fields.error(
            "time-laws",
            ("motion", "time"),
            "laws over time are not computed by this version",
            "give the inputs from, to and step",
        )
        return (), 1
    columns: dict[str, Floats] = {}
    for name, item in section.inputs.items():
        path: Path = ("motion", "inputs", name)
        if not is_coordinate(fields, path, name, joints) or _driven_twice(fields, name, joints):
            continue
        if hasattr(item, "value"):
            fields.error(
                "following-input",
                (*path, "with"),
                "inputs that follow an expression are not computed by this version",
                "list its values: equally long sequences run together",
            )
            continue
        errors = fields.error_count
        values = _values(fields, path, item, name.partition(".")[2])
        if fields.error_count == errors:
            columns[name] = values
    rows = _row_count(fields, columns)
    inputs = []
    for name, values in columns.items() if rows else ():
        written = np.broadcast_to(values, (rows,)).copy()
        inputs.append(_driven(fields, name, section.inputs[name], written))
    return tuple(inputs), rows


def _driven_twice(fields: Fields, name: str, joints: Mapping[str, Joint]) -> bool:
    """Whether `name` is the s of a helical joint whose theta is an input as well."""
    joint = joints[name.partition(".")[0]]
    turn = f"{joint.name}.theta"
    path: Path = ("motion", "inputs")
    twice = joint.letter == "H" and name != turn and fields.document.node((*path, turn)) is not None
    if twice:
        text = f"{turn} and {name} are one freedom"
        fields.key_error("driven-twice", (*path, name), text, "drive one of them")
    return twice


def _values(fields: Fields, path: Path, item: Any, coordinate: str) -> Floats:
    """Values in the file's units: x_i = from + i*step."""
    dimension = _DIMENSIONS[coordinate][0]
    if hasattr(item, "at"):
        return np.array([fields.written((*path, "at"), item.at, dimension)])
    if hasattr(item, "values"):
        texts = enumerate(item.values)
        return np.array([fields.written((*path, "values", i), t, dimension) for i, t in texts])
    first = fields.written((*path, "from"), item.first, dimension)
    last = fields.written((*path, "to"), item.last, dimension)
    if item.count is not None:
        if _too_many(fields, (*path, "count"), item.count):
            return np.array([first])
        return by_count(first, last, item.count)
    errors = fields.error_count
    step = abs(fields.written((*path, "step"), item.step, dimension))
    if fields.error_count > errors:
        return np.array([first])
    if step == 0.0:
        if first == last:
            return np.array([first])
        fields.error("zero-step", (*path, "step"), "the step is zero", "give the distance of rows")
        return np.array([first])
    ratio = abs(last - first) / step + 1e-9
    if _too_many(fields, (*path, "step"), ratio + 1.0):
        return np.array([first])
    return by_step(first, step if last >= first else -step, int(ratio) + 1)


def _too_many(fields: Fields, path: Path, count: float) -> bool:
    if count <= MOST_ROWS:
        return False
    fields.error(
        "too-many-rows",
        path,
        "this sweep has more rows than any table can use",
        "take a larger step",
        measured=f"{count:.4g} rows",
        limit=f"{MOST_ROWS} rows",
    )
    return True


def _row_count(fields: Fields, columns: Mapping[str, Floats]) -> int:
    """Rows that all inputs share, 0 where they do not."""
    lengths = {name: v.size for name, v in columns.items() if v.size > 1}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {n}" for name, n in lengths.items())
        fields.error(
            "row-counts",
            ("motion", "inputs"),
            "inputs that run together need equally many rows",
            "use the same number of values, or hold an input with at:",
            measured=words,
        )
        return 0
    return max(lengths.values(), default=1)


def _driven(fields: Fields, name: str, item: Any, written: Floats) -> DrivenInput:
    joint, _, coordinate = name.partition(".")
    path: Path = ("motion", "inputs", name)
    dimension, rate_dimension, acceleration_dimension = _DIMENSIONS[coordinate]
    rate = fields.number((*path, "rate"), item.rate, rate_dimension)
    acceleration = fields.number((*path, "acceleration"), item.acceleration, acceleration_dimension)
    values = np.asarray(fields.units.to_si(written.copy(), dimension), dtype=float)
    full = np.full(written.size, 1.0)
    return DrivenInput(joint, coordinate, values, written, rate * full, acceleration * full)
