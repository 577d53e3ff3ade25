"""What a joint transmits along its axis and square to it, as bearings are chosen by.

Each is an expression of the joint's reaction, evaluated like any other: on rows, on other reactions
in equilibrium where constraints are redundant, in double-double. What is square to the axis is
unique in a plane linkage, though neither reaction nor moment of its pins is.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import NamedTuple

from mechkin_cli.expressions import Expression, Quantity, Resolve, parse
from mechkin_cli.mechanism.model import Mechanism, is_written
from mechkin_cli.mechanism.quantities import Kind, Wanted
from mechkin_cli.units import FORCE, MOMENT, Dimension


class _Load(NamedTuple):
    """An expression of a joint's reaction, in which J stands for the joint."""

    text: str
    dimension: Dimension


_LOADS: dict[Kind, _Load] = {
    "radial_force": _Load("norm(cross(J.axis, J.force))", FORCE),
    "axial_force": _Load("dot(J.axis, J.force)", FORCE),
    "tilting_moment": _Load("norm(cross(J.axis, J.moment))", MOMENT),
}

_IN_PLANE: dict[Kind, _Load] = {"radial_force": _Load("norm(J.force)", FORCE)}
"""Pins, slots and guides transmit nothing else: along its axis a guide takes no force."""

_TOLD_IN_PLANE = "xy"

BEARING_KINDS: frozenset[str] = frozenset(_LOADS)


def bearing_catalogue(mechanism: Mechanism) -> dict[str, Wanted]:
    """`J.radial_force`, `J.axial_force` and `J.tilting_moment` of every joint with an axis; in a
    plane the first alone, of every joint with a point."""
    return {wanted.name: wanted for wanted in _of_joints(mechanism)}


def bearing_load(wanted: Wanted, resolve: Resolve) -> Quantity:
    """The load as its expression gives it, in SI."""
    return _expression(wanted).evaluate(resolve)


def read_for(names: Iterable[str], known: Mapping[str, Wanted]) -> list[str]:
    """What has to be read for some quantities: reactions and axes in place of bearing loads.

    Raises:
        KeyError: an unknown quantity.
    """
    found: dict[str, None] = {}
    for name in names:
        wanted = known[name]
        is_load = wanted.kind in BEARING_KINDS
        parts = sorted(_expression(wanted).names) if is_load else [name]
        found |= dict.fromkeys(parts)
    return list(found)


def _of_joints(mechanism: Mechanism) -> Iterator[Wanted]:
    loads, told = (_IN_PLANE, _TOLD_IN_PLANE) if mechanism.plane else (_LOADS, "xyz")
    for joint in mechanism.joints.values():
        bears = joint.type.has_point and (mechanism.plane or joint.type.axis is not None)
        for kind, load in loads.items() if bears and is_written(joint.name) else ():
            name, dimension = f"{joint.name}.{kind}", load.dimension
            yield Wanted(name, kind, joint.name, dimension, False, told=told)


@cache
def _expression(wanted: Wanted) -> Expression:
    loads = _IN_PLANE if wanted.told == _TOLD_IN_PLANE else _LOADS
    return parse(loads[wanted.kind].text.replace("J.", f"{wanted.owner}."))
