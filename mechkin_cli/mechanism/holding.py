"""Holds the idle freedoms of a mechanism: chooses a coordinate for each, or a pair that holds it.

First those coordinates that the motion moves at the same rate wherever the mechanism goes, angles
before slides. A slide between two tilted planes has none where the planes' coordinates stand on the
other links; a plane on the link, square to the slide, then keeps a point of its neighbour (Sp), and
holds it everywhere. What has no named coordinate left is held by turns of a ball or by slides on a
plane.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from mechkin_cli.mechanism.common_motions import Freedom
from mechkin_cli.mechanism.held import Held, Line, is_unnamed
from mechkin_cli.mechanism.holder import Holder
from mechkin_cli.mechanism.idle_motions import (
    Coordinate,
    Drawn,
    Found,
    Group,
    idle_groups,
)
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.vectors import ZERO, Vector, add


class Holding(NamedTuple):
    """What is held, small groups of links first; `as_drawn` says whether more, or other motions,
    may be idle because the mechanism keeps its joints as they are drawn."""

    held: tuple[Held, ...]
    as_drawn: bool


def held_freedoms(mechanism: Mechanism, driven: Collection[Coordinate]) -> Holding:
    """The idle freedoms that joints have wherever they are, but those of legs."""
    size = mechanism.box_diagonal()
    origin = next((joint.point.vector for joint in mechanism.joints.values()), ZERO)
    groups, drawn = idle_groups(mechanism, driven, size, origin, _legs(mechanism))
    held = held_groups(mechanism, driven, groups, size, origin)
    as_drawn = any(_moves_as_drawn(one, held) for one in drawn)
    return Holding(held, as_drawn or _count(drawn) != len(held))


def _count(drawn: Sequence[Drawn]) -> int:
    """How many independent motions some groups have as they are drawn."""
    found = Found()
    for one in drawn:
        group = Group(one.chain[0], one.chain[2], [one.motions([])])
        group.look_beside(found)
        group.join(found)
    return found.count


def _moves_as_drawn(group: Drawn, held: Sequence[Held]) -> bool:
    """Whether a group may do more as it is drawn than anywhere, or something that is not held."""
    if len(group.motions([])) > group.anywhere:
        return True
    links, _, border = group.chain
    still: list[Freedom] = []
    for one in held:
        if one.coordinate is None or is_unnamed(one.coordinate[1]):
            if {*one.links} & {*links}:
                return False
            continue
        joint = next((j for j in border if j.name == one.coordinate[0]), None)
        if joint is not None:
            still.append((joint.name, joint.type.freedom_of[one.coordinate[1]]))
    return bool(group.motions(still))


def held_groups(
    mechanism: Mechanism,
    driven: Collection[Coordinate],
    groups: Sequence[Group],
    size: float,
    origin: Vector,
) -> tuple[Held, ...]:
    """What holds the motions of some groups; lengths in parts of `size` (m), about `origin` (m)."""
    holder = Holder(mechanism, driven, size, origin)
    legs = _legs(mechanism)
    others = [group for group in groups if frozenset(group.links) not in legs]
    known = Found()
    for group in groups:
        if frozenset(group.links) in legs:
            group.join(known)
            holder.leave(group)
    for group in sorted(others, key=lambda group: len(group.links)):
        group.look_beside(known)
        group.join(known)
    # what can be held at few places has the choice before what can be held at many
    for group in sorted(others, key=lambda group: len(holder.steady(group))):
        holder.hold(group)
    return tuple(_from_ground(one, origin) for one in holder.held)


def _legs(mechanism: Mechanism) -> set[frozenset[str]]:
    return {frozenset(leg.links) for leg in find_legs(mechanism)}


def _from_ground(held: Held, origin: Vector) -> Held:
    """With lines from the ground's origin instead of another."""
    axes = {
        link: None if line is None else Line(line.along, add(line.start, origin))
        for link, line in held.axes.items()
    }
    return held._replace(axes=axes)
