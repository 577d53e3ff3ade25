"""The finite motions of the whole from those of its parts (`Motions`), and idle freedoms: motions
of one link, or of a few as one body, that leave all others at rest.

`idle_freedoms` finds and describes those of one configuration. `held_along` locks those that links
have only where their mechanism takes them: a slide may stand square to the normal of a plane
because the other joints turn both about that normal alone, and its link then slides between them at
every position of the mechanism, though not if the joints were moved at will. Such motions are
looked for where the drawing has more of them than its joints alone have anywhere, at general
configurations of the mechanism.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property, reduce
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.idle import PLACES, LinkMotion, RigidGroup, held_groups
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.mechanism import Joint, LockedFreedom, Mechanism, Problem, Vector
from mechkin_cli.mobility.configurations import Body, Configuration, LoopPart, home
from mechkin_cli.mobility.dimension import LocalFreedom, freedom_of, relative_rates, still_along
from mechkin_cli.mobility.opened import rank_of
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Motions:
    """Motions from a `start` whose parts have the `freedoms`; every part has a component."""

    def __init__(
        self, body: Body, start: Configuration, freedoms: Sequence[tuple[LoopPart, LocalFreedom]]
    ) -> None:
        self.body, self.start, self.freedoms = body, start, freedoms

    @cached_property
    def dimensions(self) -> tuple[int, ...]:
        """Dimensions of all components that meet at the start, the largest first."""
        sums = reduce(
            lambda known, part: {a + b for a in known for b in part[1].dimensions},
            self.freedoms,
            {int(self.body.free.size)},
        )
        return tuple(sorted(sums, reverse=True))

    @property
    def mobility(self) -> int:
        """The largest dimension."""
        return self.dimensions[0]

    @property
    def places(self) -> int:
        """How many places beside the start were looked at."""
        return max((len(f.components) for _, f in self.freedoms if f.dimensions != (0,)), default=0)

    @cached_property
    def general(self) -> Configuration:
        """A general configuration of the largest component."""
        return self._at([freedom.components[0].state for _, freedom in self.freedoms])

    @cached_property
    def others(self) -> tuple[Configuration, ...]:
        """General configurations of more components, one of each dimension first."""
        every = [
            [c.state for c in freedom.components]
            + [place for c in freedom.components for place in c.places[1:]]
            for _, freedom in self.freedoms
        ]
        most = min(max(map(len, every), default=0), tolerances.MOBILITY_OTHERS)
        return tuple(
            self._at([p[k] if k < len(p) else p[0] for p in every]) for k in range(1, most)
        )

    def _at(self, states: Sequence[Floats]) -> Configuration:
        """The configuration whose parts are as in a state each."""
        loops, start = self.body.loops, self.start.state[None]
        steps = np.zeros((1, self.body.count))
        for (part, _), state in zip(self.freedoms, states, strict=True):
            steps[:, part.columns] = part.steps(state[None], start)
        return Configuration(self.body, loops.moved(start, steps)[0])

    @cached_property
    def stresses(self) -> Floats:
        """Stresses (equations, redundant) at the general configuration."""
        jacobian = self.general.jacobian
        zero = tolerances.MOBILITY_RANK_REACHED
        is_regular = True
        for part, freedom in self.freedoms:
            rank = part.rank(part.own(jacobian), tolerances.MOBILITY_RANK_REACHED)
            if rank.motions.shape[1] > freedom.first.motions.shape[1]:  # as `rank_reached`
                zero = tolerances.RANK_ZERO
                rank = part.rank(part.own(jacobian), zero)
            is_regular = is_regular and rank.stresses.shape[1] == part.held
        if is_regular:
            return np.zeros((len(jacobian), 0))
        if not self.body.mechanism.plane:
            return rank_of(jacobian, zero).stresses
        # what the plane holds is no constraint: of each cut the moment about z, forces along x, y
        cuts = self.body.loops.cut_rows
        rows = (6 * np.arange(cuts // 6)[:, None] + (2, 3, 4)).ravel()
        rows = np.concatenate([rows, np.arange(cuts, len(jacobian))])
        inside = rank_of(jacobian[rows], zero).stresses
        stresses = np.zeros((len(jacobian), inside.shape[1]))
        stresses[rows] = inside
        return stresses

    @cached_property
    def tangents(self) -> Floats:
        """Motions (freedoms, mobility) of the largest component at the general configuration."""
        return self._beside([freedom.components[0].tangents for _, freedom in self.freedoms])

    @cached_property
    def rates(self) -> Floats:
        """The same with each freedom in a unit of its own."""
        return self._beside([relative_rates(part, f.components[0]) for part, f in self.freedoms])

    def _beside(self, of_parts: Sequence[Floats]) -> Floats:
        """Motions of the whole from those of its parts and what moves alone."""
        motions = np.zeros((self.body.count, self.mobility))
        free = self.body.free
        motions[free, np.arange(free.size)] = 1.0
        column = free.size
        for (part, _), own in zip(self.freedoms, of_parts, strict=True):
            motions[part.columns, column : column + own.shape[1]] = own
            column += own.shape[1]
        return motions

    @cached_property
    def doubt(self) -> float:
        """How far entries of the tangents may be off."""
        doubts = (c.doubt for _, freedom in self.freedoms for c in freedom.components)
        return max(doubts, default=tolerances.RANK_ZERO)

    @cached_property
    def fixed(self) -> tuple[str, ...]:
        """Coordinates that no motion changes."""
        moving = np.zeros(self.body.count, dtype=np.bool_)
        moving[self.body.free] = True
        for part, freedom in self.freedoms:
            for component in freedom.every:
                rates = np.abs(relative_rates(part, component)).max(axis=1, initial=0.0)
                moving[part.columns] |= rates > max(component.doubt, tolerances.RANK_ZERO)
            families = [family for family in freedom.families if family[0].dimension]
            if len(families) > 1 or any(family[0].excess for family in families):
                # next to where equations touch their solutions steps tell better than rates
                along = [still_along(part, self.start.state, family) for family in families]
                moving[list(set(along[0]).intersection(*along[1:]))] = False
        return self.body.coordinates(~moving)


class IdleFreedom(NamedTuple):
    """The links that move together, and how, in words."""

    links: tuple[str, ...]
    sentence: str


def idle_freedoms(
    configuration: Configuration, driven: Sequence[tuple[str, str]]
) -> tuple[IdleFreedom, ...]:
    """Freedoms that move no input and nothing but a link between two or more joints."""
    idle: list[IdleFreedom] = []
    known = np.zeros((configuration.body.count, 0))
    for names, border, motions in _group_motions(configuration, driven):
        new = motions @ _split(motions - known @ (known.T @ motions))[0]
        if not new.shape[1]:
            continue
        known = np.linalg.qr(np.concatenate([known, new], axis=1))[0]
        for twist in _turns_and_slides(configuration.twists[names[0]] @ new).T:
            verb, how = _words(border, twist)
            verb = f"{verb} together" if len(names) > 1 else f"{verb}s"
            idle.append(IdleFreedom(names, f"{' and '.join(names)} {verb} freely {how}"))
    return tuple(idle)


def _group_motions(
    configuration: Configuration, driven: Sequence[tuple[str, str]]
) -> Iterator[tuple[tuple[str, ...], tuple[Joint, ...], Floats]]:
    """Groups of links, few first, with the joints to others and their motions (freedoms, count) as
    one body that move no input and leave all others at rest."""
    body = configuration.body
    columns = [body.column(*each) for each in driven]
    for links, border in _groups(configuration):
        motions = _common_motions(configuration, links, border)
        names = tuple(name for name in body.links if name in links)
        yield names, tuple(border), motions @ _split(motions[columns])[1]


def _split(matrix: Floats) -> tuple[Floats, Floats]:
    """Orthonormal bases of what a matrix, with entries of the order of one, does not map to zero,
    and of what it does."""
    if not matrix.size:
        count = matrix.shape[1]
        return np.zeros((count, 0)), np.eye(count)
    _, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > tolerances.SAME_COMMON_MOTION))
    return right[:rank].T, right[rank:].T


def _turns_and_slides(twists: Floats) -> Floats:
    """Unit twists (6, count) that span the same: turns, then slides."""
    turning, sliding = _split(twists[:3] / np.linalg.norm(twists, axis=0).max())
    turns, slides = twists @ turning, twists @ sliding
    along = np.linalg.qr(slides[3:])[0]
    turns[3:] -= along @ (along.T @ turns[3:])  # no turn advances where a slide does
    basis: Floats = np.concatenate([turns, slides], axis=1)
    basis /= np.linalg.norm(basis, axis=0)
    return basis


def _groups(configuration: Configuration) -> Iterator[tuple[set[str], list[Joint]]]:
    """Groups of links between two others or more, with the joints to these; small groups first."""
    body = configuration.body
    at = body.mechanism.joints_of
    place = {joint.name: k for k, joint in enumerate(body.mechanism.joints.values())}
    for count in range(1, min(tolerances.MOST_IDLE_LINKS, len(body.links) - 1) + 1):
        for chosen in joined_links(body.mechanism, body.links, count):
            group = set(chosen)
            around = {joint.name: joint for link in chosen for joint in at[link]}
            border = [j for j in around.values() if (j.first in group) != (j.second in group)]
            others = {end for j in border for end in (j.first, j.second)} - group
            if len(others) >= 2:
                yield group, sorted(border, key=lambda joint: place[joint.name])


def joined_links(mechanism: Mechanism, links: Sequence[str], count: int) -> list[tuple[str, ...]]:
    """The choices of so many links with as many joints between them, less one, in the order of
    `combinations`: they are grown from link to link."""
    rank = {link: k for k, link in enumerate(links)}
    if count == 1:
        return [(link,) for link in links]
    next_to: dict[int, list[int]] = {k: [] for k in rank.values()}
    for joint in mechanism.joints.values():
        if joint.first in rank and joint.second in rank and joint.first != joint.second:
            next_to[rank[joint.first]].append(rank[joint.second])
            next_to[rank[joint.second]].append(rank[joint.first])
    found: set[tuple[int, ...]] = {(k,) for k in rank.values()}
    for _ in range(count - 1):
        found = {
            tuple(sorted((*some, other)))
            for some in found
            for k in some
            for other in next_to[k]
            if other not in some
        }
    return [tuple(links[k] for k in some) for some in sorted(found)]


def _common_motions(configuration: Configuration, links: set[str], border: list[Joint]) -> Floats:
    """Motions (freedoms, count) of the links as one body that leave the others at rest: nothing but
    the joints around them moves."""
    body = configuration.body
    moving = [column for joint in border for column in body.columns[joint.name]]
    number, (of_equations, of_bodies) = body.loops.number, configuration.moved_by
    near = {number[link] for link in links}.union(*(of_bodies[column] for column in moving))
    twists = {k: configuration.every_twist[k][:, moving] for k in near}
    one = twists[number[min(links)]]
    for link in links:
        twists[number[link]] = twists[number[link]] - one
    rest = [twists[k] for k in map(number.__getitem__, body.links) if k in near]
    equations = sorted(set[int]().union(*(of_equations[column] for column in moving)))
    matrix = np.concatenate([configuration.jacobian[np.ix_(equations, moving)], *rest])
    # what these joints do not move says nothing
    matrix = matrix[np.any(matrix != 0.0, axis=1)]
    _, values, right = np.linalg.svd(matrix, full_matrices=len(matrix) < len(moving))
    least = tolerances.RANK_ZERO * values.max(initial=0.0)  # welds alone have none
    motions = np.zeros((body.count, len(moving) - int(np.count_nonzero(values > least))))
    motions[moving] = right[len(moving) - motions.shape[1] :].T
    return motions


def _words(border: Sequence[Joint], twist: Floats) -> tuple[str, str]:
    """Verb, and about or along what."""
    spin, slide = twist[:3], twist[3:]
    names = ", ".join(joint.name for joint in border)
    if np.max(np.abs(spin)) < tolerances.MOBILITY_NO_TWIST:
        return "slide", f"along the axis of {names}"
    if abs(float(spin @ slide)) > tolerances.MOBILITY_NO_TWIST:
        return "move", f"along the thread of {names}"
    if all(joint.type.is_oriented for joint in border):
        return "spin", "about " + "-".join(joint.name for joint in border)
    return "turn", f"about the common axis of {names}"


def held_along(problem: Problem, known: tuple[LockedFreedom, ...]) -> tuple[LockedFreedom, ...]:
    """What locks the idle freedoms of a mechanism on its path; `known` if there are no more, or if
    the drawing is not assembled or a special position."""
    body = Body(problem.mechanism)
    places = _places(body)
    if not places:
        return known
    driven = problem.motion.driven
    groups = []
    for at_places in zip(*(_group_motions(place, driven) for place in places), strict=True):
        links, joints, _ = at_places[0]
        motions = [
            _motions(place, links, joints, at_place[2])
            for place, at_place in zip(places, at_places, strict=True)
        ]
        group = RigidGroup(links, joints, motions)
        groups += [group] if group.count else []
    x, y, z = (float(c) for c in body.centre)
    held = held_groups(problem.mechanism, driven, groups, body.size, (x, y, z))
    locked = [{(one.links, one.coordinate) for one in some} for some in (held, known)]
    if locked[0] == locked[1]:
        return known
    return tuple(one._replace(everywhere=False) for one in held)


def _places(body: Body) -> list[Configuration]:
    """General configurations next to the drawing."""
    start, random = home(body), RandomStarts()
    if not start.assembled:
        return []
    # at a branch point one branch may leave idle what another needs
    freedoms = [(p, freedom_of(p, start.state, random, regular=True)) for p in body.parts]
    if any(f.doubt or f.dimensions != (f.first.motions.shape[1],) for _, f in freedoms):
        return []
    motions = Motions(body, start, freedoms)
    places = [motions.general]
    while len(places) < PLACES:
        heading = motions.tangents @ random.between(1.0, motions.tangents.shape[1])
        heading *= tolerances.IDLE_MOVE / max(1.0, float(np.abs(heading).max(initial=0.0)))
        moved = motions.general.moved(heading).closed()
        if not moved.assembled:
            return []
        places.append(moved)
    return places


def _motions(
    place: Configuration, links: tuple[str, ...], joints: tuple[Joint, ...], motions: Floats
) -> list[LinkMotion]:
    """Motions (freedoms, count) with the links' twists on their own drawings."""
    body = place.body
    link_motions = []
    for motion in motions.T:
        rates = {
            (joint.name, freedom): float(motion[column])
            for joint in joints
            for freedom, column in enumerate(body.columns[joint.name])
        }
        twists = {}
        for link in links:
            twist, (turn, origin) = place.twists[link] @ motion, place.poses[link]
            linear = turn.T @ (twist[3:] + np.cross(twist[:3], origin))
            twists[link] = _vector(turn.T @ twist[:3]), _vector(linear)
        link_motions.append(LinkMotion(rates, twists))
    return link_motions


def _vector(entries: Floats) -> Vector:
    """Rounded, so that no plan holds digits that change with the linear algebra of a machine."""
    x, y, z = (round(float(entry), tolerances.IDLE_DECIMALS) for entry in entries)
    return (x, y, z)
