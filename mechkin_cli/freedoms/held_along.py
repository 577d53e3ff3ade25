"""Idle freedoms that links have only where their mechanism takes them.

A slide may stand square to the normal of a plane because the other joints turn both about that
normal alone: its link then slides between them, at every position of the mechanism, though not if
the joints were moved at will. Such motions are looked for where the drawing has more of them than
its joints alone have anywhere, at general configurations of the mechanism.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.freedoms.configurations import Body, Configuration, home
from mechkin_cli.freedoms.idle import group_motions
from mechkin_cli.freedoms.local_dimension import freedom_of
from mechkin_cli.freedoms.motions import Motions
from mechkin_cli.mechanism.common_motions import PLACES, Motion
from mechkin_cli.mechanism.held import Held
from mechkin_cli.mechanism.holding import held_groups
from mechkin_cli.mechanism.idle_motions import Group
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.vectors import Vector
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def held_along(problem: Problem, known: tuple[Held, ...]) -> tuple[Held, ...]:
    """What holds the idle freedoms of a mechanism on its way; `known` if there are no more, or if
    the drawing is not assembled or a special position."""
    body = Body(problem.mechanism)
    places = _places(body)
    if not places:
        return known
    driven = problem.motion.driven
    groups = []
    at = [list(group_motions(place, driven)) for place in places]
    for (links, joints, first), *others in zip(*at, strict=True):
        motions = [_motions(places[0], links, joints, first)]
        motions += [
            _motions(place, links, joints, ways)
            for place, (_, _, ways) in zip(places[1:], others, strict=True)
        ]
        group = Group(links, joints, motions)
        groups += [group] if group.count else []
    x, y, z = (float(c) for c in body.centre)
    held = held_groups(problem.mechanism, driven, groups, body.size, (x, y, z))
    same = {(one.links, one.coordinate) for one in held} == {
        (one.links, one.coordinate) for one in known
    }
    if same:
        return known
    return tuple(one._replace(everywhere=False) for one in held)


def _places(body: Body) -> list[Configuration]:
    """General configurations next to the drawing."""
    start, random = home(body), RandomStarts()
    if not start.assembled:
        return []
    freedoms = [(p, freedom_of(p, start.state, random)) for p in body.parts]
    if any(
        found.doubt or found.dimensions != (found.first.motions.shape[1],) for _, found in freedoms
    ):
        return []  # at a branch point one way may leave idle what another needs
    motions = Motions(body, start, freedoms)
    found = [motions.general]
    while len(found) < PLACES:
        ways = motions.tangents
        heading = ways @ random.between(1.0, ways.shape[1])
        heading *= tolerances.IDLE_MOVE / max(1.0, float(np.abs(heading).max(initial=0.0)))
        moved = motions.general.moved(heading).closed()
        if not moved.assembled:
            return []
        found.append(moved)
    return found


def _motions(
    place: Configuration, links: tuple[str, ...], joints: tuple[Joint, ...], motions: Floats
) -> list[Motion]:
    """Motions (freedoms, count) with the links' twists on their own drawings."""
    body = place.body
    found = []
    for motion in motions.T:
        rates = {
            (joint.name, freedom): float(motion[column])
            for joint in joints
            for freedom, column in enumerate(body.columns[joint.name])
        }
        twists = {}
        for link in links:
            twist, pose = place.twists[link] @ motion, place.poses[link]
            spin = twist[:3]
            twists[link] = (
                _vector(pose.turn.T @ spin),
                _vector(pose.turn.T @ (twist[3:] + np.cross(spin, pose.place))),
            )
        found.append(Motion(rates, twists))
    return found


def _vector(entries: Floats) -> Vector:
    """Rounded, so that no plan holds digits that change with the linear algebra of a machine."""
    x, y, z = (round(float(entry), tolerances.IDLE_DECIMALS) for entry in entries)
    return (x, y, z)
