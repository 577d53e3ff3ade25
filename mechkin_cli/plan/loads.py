"""The columns of varying loads in the kernel: one of a load along a coordinate, three of one on a
link, in the order of the mechanism's loads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mechkin_cli.mechanism import Amount, JointLoad, LinkLoad, Load, Varying, dot, is_angle, varying
from mechkin_cli.plan.layout import Layout


def kernel_columns(layout: Layout, values: Mapping[int, Any]) -> list[Any]:
    """The columns of the loads from the values in SI of laws, by their numbers: rows or recorded
    numbers. Those of a link are components in the axes of the load, in the kernel's units."""
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
    components: Any = [_amount(amount, values) for amount in load.value]
    if load.axes == "link":
        frame = layout.link_frame[load.link]
        components = [dot(axis, components) for axis in (frame.x, frame.y, frame.z)]
    return [per * component for component in components]


def _amount(amount: Amount, values: Mapping[int, Any]) -> Any:
    return values[amount.number] if isinstance(amount, Varying) else amount
