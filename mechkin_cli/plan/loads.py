"""Loads in the plan: what each gives to the kernel's columns, constant or by a law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mechkin_cli.mechanism import Amount, JointLoad, LinkLoad, Load, Varying, is_angle, varying
from mechkin_cli.plan.layout import Layout


def kernel_columns(layout: Layout, values: Mapping[int, Any]) -> list[Any]:
    """The columns of the loads from the values in SI of laws, by their numbers: rows or recorded
    numbers."""
    return [
        column
        for load in layout.mechanism.loads
        if varying(load)
        for column in _columns(layout, load, values)
    ]


def _columns(layout: Layout, load: Load, values: Mapping[int, Any]) -> list[Any]:
    length = layout.length
    if isinstance(load, JointLoad):
        per = length * length if is_angle(load.coordinate) else length
        return [_amount(load.value, values) / per]
    assert isinstance(load, LinkLoad)
    per = 1.0 / length if load.kind == "force" else 1.0 / (length * length)
    given = [_amount(amount, values) for amount in load.value]
    if load.axes == "link":
        frame = layout.link_frame[load.link]
        given = [_along(axis, given) for axis in (frame.x, frame.y, frame.z)]
    return [per * component for component in given]


def _amount(amount: Amount, values: Mapping[int, Any]) -> Any:
    return values[amount.number] if isinstance(amount, Varying) else amount


def _along(axis: Sequence[float], given: Sequence[Any]) -> Any:
    return axis[0] * given[0] + axis[1] * given[1] + axis[2] * given[2]
