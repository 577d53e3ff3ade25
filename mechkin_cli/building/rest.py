"""Coordinates of a sweep that rest where the loads balance, as the file names them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building.fields import Fields, Path, dimension_of, is_coordinate
from mechkin_cli.mechanism import DrivenInput, Joint, MotionInputs, Rest

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Assembly
    from mechkin_cli.schema import MotionSection
    from mechkin_cli.units import UnitSystem


def resting(
    fields: Fields, section: MotionSection, motion: MotionInputs, joints: Mapping[str, Joint]
) -> MotionInputs | None:
    """The motion with the coordinates that nothing drives behind its inputs, all at rest; they
    stand as drawn until it is known where the loads balance."""
    errors = fields.error_count
    if motion.constraints:
        text = "a drive that is tied to another does not go with coordinates at rest"
        hint = "write a coupling instead of drive: tie, or drive: own"
        fields.error("rest-and-tie", ("motion", "rest"), text, hint)
    still = np.zeros(motion.rows)
    orders = np.zeros((4, motion.rows))
    inputs = []
    for item in motion.inputs:
        written = orders.copy()
        written[0] = item.written
        inputs.append(
            item._replace(rates=still, accelerations=still, jerks=still, written_orders=written)
        )
    taken = [(item.joint, item.coordinate) for item in inputs]
    for number, name in enumerate(section.rest):
        place: Path = ("motion", "rest", number)
        if not is_coordinate(fields, place, name, joints, at_key=False):
            continue
        joint, _, coordinate = name.rpartition(".")
        freedom = joints[joint].type.freedom_of
        if any(j == joint and freedom[c] == freedom[coordinate] for j, c in taken):
            text = f"{name} is the freedom of an input, or stands twice"
            fields.error("rest-and-input", place, text, "name a coordinate that nothing drives")
            continue
        taken.append((joint, coordinate))
        inputs.append(DrivenInput(joint, coordinate, still, still, still, still, orders))
    if fields.error_count > errors:
        return None
    free = tuple(range(len(motion.inputs), len(inputs)))
    return motion._replace(
        inputs=tuple(inputs),
        course=None,
        paths=(),
        unrated=(),
        constraint_rates=None,
        rest=Rest(free, tuple(taken[len(motion.inputs) :]), motion.course),
    )


def near_rest(motion: MotionInputs, assembly: Assembly, units: UnitSystem) -> MotionInputs:
    """The motion whose coordinates at rest stand where `assembly: near` has them."""
    if motion.rest is None:
        return motion
    inputs = list(motion.inputs)
    for number in motion.rest.inputs:
        item = inputs[number]
        value = assembly.near.get(item.name, 0.0)
        written = item.written_orders.copy()
        written[0] = float(units.from_si(value, dimension_of(item.coordinate)))
        values = np.full(motion.rows, value)
        inputs[number] = item._replace(values=values, written_orders=written)
    return motion._replace(inputs=tuple(inputs))
