"""Idle freedoms held at a coordinate: a slipper's turn on its plate, a sleeve's on its pin.

Some links may move, in a chain as one body, while all others stay at rest. No equation tells that
motion, so one coordinate of it is held where it is drawn (or where `near` puts it), as if it were
an input at rest; nothing that is not conventional depends on it. Links between two spheres have no
such coordinate and are legs (legs.py).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.mechanism.common_motions import (
    PLACES,
    Common,
    Freedom,
    General,
    advance_of,
    common_motions,
    line_of,
    same_line,
    scaled_screw,
)
from mechkin_cli.mechanism.elementary import Screw
from mechkin_cli.mechanism.held_balls import HeldBall, ball_line, held_ball
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.legs import find_legs, frame_on
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, norm, scale

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Line(NamedTuple):
    """A line that a link carries, on its drawing: unit vector, and a point in m."""

    along: Vector
    start: Vector


class Held(NamedTuple):
    """An idle freedom of some links, held at a coordinate of one of the joints around them.

    `moves` are the coordinates that move with it; `axes` the line about which each link turns, None
    where it does not turn about a line of its own; `slides` whether it slides without a turn;
    `holding` names the effort that holds it; `ball` is the joint that has the coordinate where it
    is a turn of a ball.
    """

    links: tuple[str, ...]
    joints: tuple[str, ...]
    coordinate: Coordinate
    moves: frozenset[Coordinate]
    axes: Mapping[str, Line | None]
    slides: bool
    holding: str
    ball: HeldBall | None = None

    @property
    def name(self) -> str:
        """The coordinate's name."""
        return ".".join(self.coordinate)

    @property
    def convention(self) -> str:
        """What is told of it by convention."""
        if self.ball is None:
            return f"{self.name} is held as it is drawn"
        return f"the turn of {self.coordinate[0]} about that line is held as it is drawn"

    @property
    def cure(self) -> str:
        """How to have a pose of its own."""
        return f"drive {self.name}" if self.ball is None else f"replace {self.coordinate[0]} by U"

    @property
    def words(self) -> str:
        """The idle freedom in an engineer's words."""
        spins = self.ball is not None or any(self.axes.values())
        kind = "slide" if self.slides else "spin" if spins else "move"
        verb = f"{kind}s" if len(self.links) == 1 else f"{kind} together"
        where = "along" if self.slides else "about" if spins else "between"
        return f"{' and '.join(self.links)} {verb} freely {where} {'-'.join(self.joints)}"


def held_freedoms(mechanism: Mechanism, driven: Collection[Coordinate]) -> tuple[Held, ...]:
    """The idle freedoms that can be held at a coordinate, small groups of links first."""
    size = mechanism.box_diagonal()
    found: list[Held] = []
    origin = next((joint.point.vector for joint in mechanism.joints.values()), ZERO)
    general = [General(place, size, origin) for place in range(PLACES)]
    legs = {frozenset(leg.links) for leg in find_legs(mechanism)}
    for links, inner, border in _groups(mechanism):
        if _is_all_told(links, border, found) or frozenset(links) in legs:
            continue
        taken = [*driven, *(one.coordinate for one in found)]
        still = [
            (joint.name, joint.type.freedom_of[coordinate])
            for joint in border
            for name, coordinate in taken
            if name == joint.name and coordinate in joint.type.freedom_of
        ]
        first = common_motions(links, inner, border, still, general[0])
        if not first.rates:
            continue
        places = [first]
        places += [common_motions(links, inner, border, still, one) for one in general[1:]]
        named = _held_of(links, border, places, size)
        found += named
        fewest = min(len(common.rates) for common in places)
        in_leg = any(leg & {*links} for leg in legs)
        if fewest == 1 and not named and not in_leg:
            free = [joint for joint in border if all(joint.name != name for name, _ in taken)]
            found += _held_by_ball(mechanism, links, border, free, places, size)
    return tuple(_from_ground(one, origin) for one in found)


def _from_ground(held: Held, origin: Vector) -> Held:
    """With lines from the ground's origin instead of another."""
    axes = {
        link: None if line is None else Line(line.along, add(line.start, origin))
        for link, line in held.axes.items()
    }
    return held._replace(axes=axes)


def _is_all_told(links: Sequence[str], border: Sequence[Joint], found: Sequence[Held]) -> bool:
    """Whether all joints lead to one link, so that what moves there is a freedom like any other, or
    the links' spin is that of fewer links between balls."""
    others = {end for joint in border for end in (joint.first, joint.second)}
    told = any(one.ball is not None and {*one.links} <= {*links} for one in found)
    return told or len(others.difference(links)) < 2


def _groups(
    mechanism: Mechanism,
) -> Iterator[tuple[tuple[str, ...], tuple[Joint, ...], tuple[Joint, ...]]]:
    """Links, joints between them and joints to others: single links with two or more joints, then
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


def _held_of(
    links: tuple[str, ...], border: Sequence[Joint], places: Sequence[Common], size: float
) -> list[Held]:
    """A coordinate for each common motion, as far as coordinates have names."""
    fewest = min(places, key=lambda common: len(common.rates))
    motions = list(range(len(fewest.rates)))
    rates = [dict(motion) for motion in fewest.rates]
    twists = [dict(twist) for twist in fewest.twists]
    named = [
        ((joint.name, name), (joint.name, freedom), joint.type.coordinate[name].is_angle)
        for joint in border
        for name, freedom in joint.type.scalars.items()
    ]
    named.sort(key=lambda one: not one[2])
    chosen: list[tuple[Coordinate, int]] = []
    for coordinate, freedom, _ in named:
        left = [k for k in motions if k not in [n for _, n in chosen]]
        if not left:
            break
        best = max(left, key=lambda k: abs(rates[k][freedom]) / _fastest(rates[k]))
        if abs(rates[best][freedom]) <= tolerances.HELD_RATE * _fastest(rates[best]):
            continue
        _take_out(rates, twists, best, freedom)
        chosen.append((coordinate, best))
    several = len(motions) > 1 or len({len(common.rates) for common in places}) > 1
    found = []
    for coordinate, k in chosen:
        kind = "moment" if is_angle(coordinate[1]) else "force"
        holding = f"{links[0]}.holding_{kind}"
        if len(chosen) > 1:
            holding = f"{'.'.join(coordinate)}.effort"
        screws = _carried(links, twists[k], places, several)
        found.append(_held(links, border, coordinate, rates[k], screws, size, holding))
    return found


def _held_by_ball(
    mechanism: Mechanism,
    links: tuple[str, ...],
    border: Sequence[Joint],
    free: Sequence[Joint],
    places: Sequence[Common],
    size: float,
) -> list[Held]:
    """The spin of some links about the line of two balls around them, held at one of these that is
    `free`."""
    balls = [joint for joint in border if joint.type.is_oriented]
    balls.sort(key=lambda joint: (joint not in free, joint.type.has_slip))
    if len(border) != 2 or len(balls) != 2 or balls[0] not in free:
        return []
    ends = [joint.first if joint.first in links else joint.second for joint in balls]
    centres = [frame_on(joint, link).o for joint, link in zip(balls, ends, strict=True)]
    line = ball_line(centres[0], centres[1], size)
    if line is None:
        return []
    ball = held_ball(mechanism, balls[0], ends[0], line)
    coordinate = (balls[0].name, ball.coordinate)
    screws = _carried(links, places[0].twists[0], places, several=False)
    holding = f"{links[0]}.holding_moment"
    held = _held(links, border, coordinate, places[0].rates[0], screws, size, holding)
    return [held._replace(ball=ball)]


def _fastest(rates: Mapping[Freedom, float]) -> float:
    return max(abs(rate) for rate in rates.values())


def _take_out(
    rates: Sequence[dict[Freedom, float]],
    twists: Sequence[dict[str, Screw]],
    best: int,
    freedom: Freedom,
) -> None:
    """Leaves the rate of a freedom to one motion alone."""
    for k, other in enumerate(rates):
        if k == best or other[freedom] == 0.0:
            continue
        factor = other[freedom] / rates[best][freedom]
        for known in other:
            other[known] -= factor * rates[best][known]
        for link, (angular, linear) in twists[k].items():
            one = twists[best][link]
            twists[k][link] = (
                tuple(a - factor * b for a, b in zip(angular, one[0], strict=True)),
                tuple(a - factor * b for a, b in zip(linear, one[1], strict=True)),
            )  # type: ignore[assignment]


def _carried(
    links: Sequence[str], twists: Mapping[str, Screw], places: Sequence[Common], several: bool
) -> dict[str, Screw | None]:
    """The motion as a screw that each link carries with it, None where it carries none."""
    found: dict[str, Screw | None] = {}
    for link in links:
        screws = [scaled_screw(common.twists[0][link]) for common in places] if not several else []
        carried = not several and all(same_line(screws[0], other) for other in screws[1:])
        found[link] = scaled_screw(twists[link]) if carried else None
    return found


def _held(
    links: tuple[str, ...],
    border: Sequence[Joint],
    coordinate: Coordinate,
    rates: Mapping[Freedom, float],
    screws: Mapping[str, Screw | None],
    size: float,
    holding: str,
) -> Held:
    moving = tolerances.HELD_RATE * tolerances.SAME_COMMON_MOTION
    moves = frozenset(
        (joint.name, name)
        for joint in border
        for name, freedom in joint.type.freedom_of.items()
        if abs(rates[joint.name, freedom]) > moving * _fastest(rates)
    )
    axes: dict[str, Line | None] = {}
    slides = False
    for link, screw in screws.items():
        turns = screw is not None and max(abs(c) for c in screw[0]) > 0.0
        slides = slides or (screw is not None and not turns)
        pure = turns and screw is not None and norm(advance_of(screw)) <= moving
        axes[link] = None
        if pure and screw is not None:
            along, point = line_of(screw)
            axes[link] = Line(along, scale(size, point))
    joints = tuple(joint.name for joint in border)
    return Held(links, joints, coordinate, moves, axes, slides, holding)
