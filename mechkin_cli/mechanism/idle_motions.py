"""The motions that some links may make, as one body, while all others stay at rest.

Links with two joints and more, and chains of links with two joints each, are looked at one after
the other, few links first. A group's motions are those that no smaller group has: in S-E-C with
the axes in line the two links in between turn, each on its own, and that both turn together says
nothing more. This is a matter of the rates of all joints at one place, so motions are kept at each
general place (common_motions.py), and reduced by those that were found before.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.mechanism.common_motions import (
    DRAWN,
    PLACES,
    Freedom,
    General,
    Motion,
    advance_of,
    common_motions,
    same_line,
    scaled_screw,
)
from mechkin_cli.mechanism.elementary import Screw
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.vectors import Vector, norm

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Moving(NamedTuple):
    """A motion as a group makes it (`own`), and less the motions that were found before
    (`beside`)."""

    own: Motion
    beside: Motion

    def rate(self, freedom: Freedom) -> float:
        """The rate of a freedom beside what is found, in parts of the fastest."""
        return abs(self.beside.rates.get(freedom, 0.0)) / (self.beside.fastest or 1.0)

    def less(self, factor: float, other: Moving) -> Moving:
        """This, and another motion back by a factor."""
        return Moving(self.own.less(factor, other.own), self.beside.less(factor, other.beside))


class Found:
    """The idle motions that are accounted for, at each place, each with a freedom that no other of
    them moves."""

    def __init__(self) -> None:
        self._at: list[list[tuple[Freedom, Motion]]] = [[] for _ in range(PLACES)]

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self._at[0])

    def beside(self, place: int, motion: Motion) -> Motion:
        """A motion less those that were found."""
        for freedom, known in self._at[place]:
            if rate := motion.rates.get(freedom, 0.0):
                motion = motion.less(rate / known.rates[freedom], known)
        return motion

    def add(self, place: int, freedom: Freedom, motion: Motion) -> None:
        """One more, beside the others, with a freedom that tells it from them."""
        self._at[place].append((freedom, motion))


class Group:
    """Links that move as one body, and what they may do that is not accounted for.

    `joints` lead to other links; `left` are the motions at each place.
    """

    def __init__(
        self, links: tuple[str, ...], joints: tuple[Joint, ...], motions: list[list[Motion]]
    ) -> None:
        self.links, self.joints = links, joints
        self.left = [[Moving(motion, motion) for motion in place] for place in motions]

    @property
    def count(self) -> int:
        """How many motions are left: where there are the fewest, as others are accidents."""
        return min(len(place) for place in self.left)

    def look_beside(self, found: Found) -> None:
        """Leaves the motions that are independent of those found."""
        for place, motions in enumerate(self.left):
            kept: list[Moving] = []
            own = Found()
            for moving in motions:
                beside = own.beside(place, found.beside(place, moving.own))
                if beside.fastest > tolerances.SAME_COMMON_MOTION * moving.own.fastest:
                    freedom = max(beside.rates, key=lambda each: abs(beside.rates[each]))
                    own.add(place, freedom, beside)
                    kept.append(Moving(moving.own, beside))
            self.left[place] = kept

    def join(self, found: Found) -> None:
        """Accounts for all that is left, and keeps it."""
        for place, motions in enumerate(self.left):
            for _, beside in motions:
                freedom = max(beside.rates, key=lambda each: abs(beside.rates[each]))
                found.add(place, freedom, beside)

    def least_rate(self, freedom: Freedom) -> float:
        """The rate of a freedom in the motion that moves it most, at the place where it is
        least."""
        return min(max(moving.rate(freedom) for moving in place) for place in self.left)

    def take(self, freedom: Freedom, found: Found) -> Moving:
        """Accounts for the motion that moves a freedom most, which the others then leave at rest;
        gives it as it is at the first place."""
        taken = []
        for place, motions in enumerate(self.left):
            best = max(range(len(motions)), key=lambda k: motions[k].rate(freedom))
            one, own = motions[best], freedom
            if one.rate(own) <= tolerances.SAME_COMMON_MOTION:  # at rest here, by chance
                own = max(one.beside.rates, key=lambda each: abs(one.beside.rates[each]))
            rate = one.beside.rates[own]
            found.add(place, own, one.beside)
            self.left[place] = [
                other.less(other.beside.rates.get(own, 0.0) / rate, one)
                for k, other in enumerate(motions)
                if k != best
            ]
            taken.append(one)
        return taken[0]

    def carried(self, link: str) -> Screw | None:
        """The one motion left as a screw that a link carries with it, None where it carries
        none."""
        if any(len(place) != 1 for place in self.left):
            return None
        twists = [place[0].own.twists[link] for place in self.left]
        if not all(any(angular) or any(linear) for angular, linear in twists):
            return None
        screws = [scaled_screw(twist) for twist in twists]
        return screws[0] if all(same_line(screws[0], other) for other in screws[1:]) else None

    def is_steady(self, freedom: Freedom) -> bool:
        """Whether the one motion left moves a freedom as fast at every place; of several, which are
        told in no way of their own, nothing is said."""
        if any(len(place) != 1 for place in self.left):
            return True
        speeds = []
        for (moving,) in self.left:
            angular, linear = moving.own.twists[self.links[0]]
            turn, slide = norm(angular), norm(linear)
            if turn == slide == 0.0:
                return False
            speed = turn if turn > tolerances.SAME_COMMON_MOTION * slide else slide
            speeds.append(abs(moving.own.rates.get(freedom, 0.0)) / speed)
        apart = max(speeds) - min(speeds)
        return min(speeds) > tolerances.HELD_RATE and apart <= tolerances.SAME_COMMON_MOTION


def is_slide(screw: Screw | None) -> bool:
    """Whether a scaled screw slides and does not turn."""
    return screw is not None and not any(screw[0])


def is_pure_turn(screw: Screw | None) -> bool:
    """Whether a scaled screw turns and does not slide."""
    return (
        screw is not None
        and any(screw[0])
        and norm(advance_of(screw)) <= tolerances.SAME_COMMON_MOTION
    )


Chain = tuple[tuple[str, ...], tuple[Joint, ...], tuple[Joint, ...]]
"""Links, the joints between them, and the joints to other links."""


class Groups(NamedTuple):
    """Groups that may move wherever their joints are, few links first; `drawn` are all that may
    move as they are drawn, with the number of motions that they have anywhere."""

    groups: list[Group]
    drawn: list[Drawn]


class Drawn(NamedTuple):
    """A group as it is drawn, the freedoms of inputs there, and its number of motions anywhere."""

    chain: Chain
    still: list[Freedom]
    place: General
    anywhere: int

    def motions(self, still: Sequence[Freedom]) -> list[Motion]:
        """Its motions as drawn that leave the inputs and some more freedoms at rest."""
        return common_motions(*self.chain, [*self.still, *still], self.place)


def idle_groups(
    mechanism: Mechanism,
    driven: Collection[Coordinate],
    size: float,
    origin: Vector,
    legs: Collection[frozenset[str]],
) -> Groups:
    """Groups of links with common motions that move no driven coordinate; lengths in parts of
    `size` (m), about `origin` (m). Those of `legs` only where others are beside them."""
    drawn = General(DRAWN, size, origin)
    general = [General(place, size, origin) for place in range(PLACES)]
    groups: list[Group] = []
    waiting: list[tuple[Chain, list[Freedom]]] = []
    found: list[Drawn] = []
    for chain in _chains(mechanism):
        links, _, border = chain
        others = {end for joint in border for end in (joint.first, joint.second)}
        if len(others.difference(links)) < 2:
            continue  # a freedom like any other
        still = [
            (joint.name, joint.type.freedom_of[coordinate])
            for joint in border
            for name, coordinate in driven
            if name == joint.name
        ]
        if frozenset(links) in legs:
            waiting.append((chain, still))
            continue
        if not common_motions(*chain, still, drawn):
            continue
        group = Group(links, border, [common_motions(*chain, still, one) for one in general])
        found.append(Drawn(chain, still, drawn, group.count))
        groups += [group] if group.count else []
    beside = {joint.name for group in groups for joint in group.joints}
    for chain, still in waiting:
        if beside & {joint.name for joint in chain[2]}:
            motions = [common_motions(*chain, still, one) for one in general]
            groups.append(Group(chain[0], chain[2], motions))
    return Groups(groups, found)


def _chains(mechanism: Mechanism) -> Iterator[Chain]:
    """Single links with two or more joints, then
    chains of links with two joints each."""
    joints_of = mechanism.joints_of
    single = [name for name in mechanism.links if name != GROUND_NAME and len(joints_of[name]) > 1]
    for name in single:
        yield (name,), (), joints_of[name]
    chains: list[tuple[str, ...]] = [(name,) for name in single if len(joints_of[name]) == 2]
    inner: dict[tuple[str, ...], tuple[Joint, ...]] = dict.fromkeys(chains, ())
    for _ in range(tolerances.MOST_IDLE_LINKS - 1):
        longer = []
        for chain in chains:
            for joint in joints_of[chain[-1]]:
                far = joint.second if joint.first == chain[-1] else joint.first
                binary = far != GROUND_NAME and len(joints_of[far]) == 2
                if binary and far not in chain and joint not in inner[chain]:
                    grown = (*chain, far)
                    inner[grown] = (*inner[chain], joint)
                    longer.append(grown)
        chains = longer
        for chain in chains:
            if chain[0] > chain[-1]:
                continue
            ends = [
                next((j for j in joints_of[link] if j not in inner[chain]), None)
                for link in (chain[0], chain[-1])
            ]
            if ends[0] is not None and ends[1] is not None and ends[0] != ends[1]:
                yield chain, inner[chain], (ends[0], ends[1])
