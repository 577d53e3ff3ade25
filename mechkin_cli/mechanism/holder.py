"""Chooses for each idle motion of a group of links a coordinate that holds it, or one more pair."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from mechkin_cli import tolerances
from mechkin_cli.mechanism.common_motions import Freedom, Motion, line_of
from mechkin_cli.mechanism.elementary import Screw
from mechkin_cli.mechanism.held import Held, Line, is_turn, slide_name, turn_name
from mechkin_cli.mechanism.held_balls import ball_line, held_ball, three_turns
from mechkin_cli.mechanism.idle_motions import (
    Coordinate,
    Found,
    Group,
    Moving,
    is_pure_turn,
    is_slide,
)
from mechkin_cli.mechanism.legs import find_legs, frame_on
from mechkin_cli.mechanism.model import Joint, Mechanism
from mechkin_cli.mechanism.stops import stop_of
from mechkin_cli.mechanism.vectors import Vector, norm, scale, subtract

Screws = dict[str, Screw | None]

EQUAL = 1.0 + tolerances.HELD_RATE
"""Factor up to which two rates count as equal."""


class Holder:
    """Takes groups one after the other; lengths in parts of `size` (m)."""

    def __init__(
        self, mechanism: Mechanism, driven: Collection[Coordinate], size: float, origin: Vector
    ) -> None:
        self.mechanism, self.size = mechanism, size
        self.origin = origin
        self.held: list[Held] = []
        self.split: set[str] = set()
        self.taken = {*driven}
        self.found = Found()
        self.in_legs = {name for leg in find_legs(mechanism) for name in leg.joints}

    def leave(self, group: Group) -> None:
        """Accounts for the motions of a group that need nothing to hold them."""
        while group.count:
            rates = group.left[0][0].beside.rates
            group.take(max(rates, key=lambda each: abs(rates[each])), self.found)

    def named(self, group: Group) -> list[tuple[Joint, str, Freedom]]:
        """The coordinates by which a group may be held: angles first, of one turn before two."""
        found = [
            (joint, name, (joint.name, freedom))
            for joint in group.joints
            if joint.name not in self.in_legs
            for name, freedom in joint.type.scalars.items()
            if (joint.name, name) not in self.taken
            and group.count
            and group.least_rate((joint.name, freedom)) > tolerances.HELD_RATE
        ]
        coordinates = [joint.type.coordinate[name] for joint, name, _ in found]
        order = sorted(
            range(len(found)),
            key=lambda k: (not coordinates[k].is_angle, coordinates[k].axis is None),
        )
        return [found[k] for k in order]

    def steady(self, group: Group) -> list[tuple[Joint, str, Freedom]]:
        """Those that move at the same rate wherever the mechanism goes."""
        return [one for one in self.named(group) if group.is_steady(one[2])]

    def hold(self, group: Group) -> None:
        """Holds whatever a group may do beside what is held."""
        group.look_beside(self.found)
        centre, first = _centre(group, self.size, self.origin), len(self.held)
        while group.count and self._hold_once(group):
            pass
        self.leave(group)
        if len(self.held) - first > 1:
            self._tell_apart(first, centre)

    def _hold_once(self, group: Group) -> bool:
        """Holds one of the motions that are left, if there is a way."""
        named, steady = self.named(group), self.steady(group)
        if not steady and self._hold_by_stop(group):
            return True
        if named:
            unsteady = sorted(named, key=lambda one: -group.least_rate(one[2]))
            joint, name, freedom = (steady or unsteady)[0]
            screws = self._screws(group)
            self._put(group, (joint.name, name), group.take(freedom, self.found), screws)
            return True
        # three turns of one ball are never singular together
        begun = self._unnamed(group, self.split, tolerances.HELD_WELL, slides=False)
        if begun is None and self._hold_by_line(group):
            return True
        return self._hold_by_unnamed(group, begun)

    def _screws(self, group: Group) -> Screws:
        return {link: group.carried(link) for link in group.links}

    def _hold_by_stop(self, group: Group) -> bool:
        """Holds the slide of a link along a line that it carries by one more pair."""
        screws = self._screws(group)
        for joint in group.joints:
            link = joint.second if joint.second in group.links else joint.first
            screw = screws[link]
            if screw is None or not is_slide(screw) or joint.name in self.in_legs:
                continue
            rates = group.left[0][0].own.rates
            stop = stop_of(joint, link, screw[1])
            freedom = max(rates, key=lambda each: abs(rates[each]))
            self._put(group, None, group.take(freedom, self.found), screws, stop=stop)
            return True
        return False

    def _balls(self, group: Group) -> list[Joint]:
        """The balls around a group that are free to be told otherwise, plain ones first."""
        told = {one.told.name for one in self.held if one.told is not None}
        busy = {*told, *self.in_legs, *(name for name, _ in self.taken)}
        balls = [j for j in group.joints if j.type.is_oriented and j.name not in busy]
        return sorted(balls, key=lambda joint: joint.type.has_slip)

    def _hold_by_line(self, group: Group) -> bool:
        """Holds one turn about a line of a link at a ball."""
        screws = self._screws(group)
        rates = group.left[0][0]
        for ball in self._balls(group) if group.count == 1 else ():
            link = ball.second if ball.second in group.links else ball.first
            line = self._line(group, ball, link, screws[link])
            if line is None:
                continue
            told, freedom = held_ball(self.mechanism, ball, link, line)
            own = _of_ball(ball)
            most = max(own, key=rates.rate)
            if rates.rate(most) <= tolerances.HELD_RATE:
                continue
            coordinate = (ball.name, turn_name(freedom))
            self._put(group, coordinate, group.take(most, self.found), screws, told=told)
            return True
        return False

    def _line(self, group: Group, ball: Joint, link: str, screw: Screw | None) -> Vector | None:
        """The line about which a group turns at a ball: that which a link carries, or that of two
        balls as drawn."""
        if screw is not None:
            return screw[0] if any(screw[0]) else None
        other = next((j for j in group.joints if j is not ball and j.type.is_oriented), None)
        if other is None or len(group.joints) > 2:
            return None
        end = other.second if other.second in group.links else other.first
        return ball_line(frame_on(ball, link).o, frame_on(other, end).o, self.size)

    def _hold_by_unnamed(self, group: Group, best: tuple[Joint, int, str] | None) -> bool:
        """Holds what is left at a turn of a ball or a slide without a name: that which moves most,
        if none is `best`."""
        if best is None:
            balls = {joint.name for joint in self._balls(group)} | self.split
            best = self._unnamed(group, balls, tolerances.HELD_RATE)
        if best is None:
            return False
        joint, number, name = best
        told_joint = three_turns(joint) if joint.type.is_oriented else None
        self.split.add(joint.name)
        moving = group.take((joint.name, number), self.found)
        self._put(group, (joint.name, name), moving, {}, told=told_joint)
        return True

    def _unnamed(
        self, group: Group, balls: Collection[str], least: float, *, slides: bool = True
    ) -> tuple[Joint, int, str] | None:
        """The turn of one of some balls, or slide, that moves most, and more than `least`."""
        # of equal ones the first is taken, whatever rounding says
        best: tuple[Joint, int, str] | None = None
        for joint in group.joints:
            for number, freedom in enumerate(joint.type.chain):
                of_ball = freedom.motion == "ball"
                name = turn_name(number) if of_ball else slide_name(number)
                told = number in joint.type.scalars.values() or (joint.name, name) in self.taken
                allowed = joint.name in balls if of_ball else slides
                if told or joint.name in self.in_legs or not allowed:
                    continue
                rate = group.least_rate((joint.name, number))
                if rate > least:
                    best, least = (joint, number, name), rate * EQUAL
        return best

    def _put(
        self,
        group: Group,
        coordinate: Coordinate | None,
        moving: Moving,
        screws: Screws,
        *,
        told: Joint | None = None,
        stop: Joint | None = None,
    ) -> None:
        """Notes what holds a motion."""
        slides = any(is_slide(screw) for screw in screws.values())
        axes = {link: _axis(screws.get(link), self.size) for link in group.links}
        if coordinate is not None:
            self.taken.add(coordinate)
        kind = "moment" if coordinate is not None and is_turn(coordinate[1]) else "force"
        holding = f"{group.links[0]}.holding_{kind}"
        if any(one.holding == holding for one in self.held):
            holding = f"{group.links[-1]}.holding_{kind}"
        moves = _moves(group.joints, moving.own)
        joints = tuple(joint.name for joint in group.joints)
        miss = moving.own.miss / (moving.own.fastest or 1.0)
        held = Held(
            group.links, joints, coordinate, moves, axes, slides, holding, told, stop, miss=miss
        )
        self.held.append(held)

    def _tell_apart(self, first: int, centre: Line | None) -> None:
        """Names for what holds several motions of one group; `centre` if they are turns about
        it."""
        for k, one in enumerate(self.held[first:], first):
            if centre is not None:
                one = one._replace(axes=dict.fromkeys(one.links, centre))
                self.held[k] = one
            if one.coordinate is None:
                continue
            joint, coordinate = one.coordinate
            holding = f"{joint}.{coordinate}.effort"
            if " " in coordinate:
                kind = "moment" if is_turn(coordinate) else "force"
                axis = int(coordinate.rpartition(" ")[2])
                holding = f"{one.links[0]}.holding_{kind}_{axis}"
            self.held[k] = one._replace(holding=holding)


def _of_ball(joint: Joint) -> list[Freedom]:
    """The freedoms of a joint's ball."""
    return [
        (joint.name, number)
        for number, freedom in enumerate(joint.type.chain)
        if freedom.motion == "ball"
    ]


def _centre(group: Group, size: float, origin: Vector) -> Line | None:
    """The centre about which a link turns in every way: of two spheres in one place."""
    if len(group.links) > 1 or group.count != 3:
        return None
    balls = [joint for joint in group.joints if joint.type.is_oriented]
    centres = [frame_on(joint, group.links[0]).o for joint in balls]
    if len(centres) != len(group.joints):
        return None
    apart = max(norm(subtract(one, centres[0])) for one in centres)
    near = apart <= tolerances.COMMON_MOTION * size
    return Line(None, subtract(centres[0], origin)) if near else None


def _moves(joints: Sequence[Joint], motion: Motion) -> frozenset[Coordinate]:
    moving = tolerances.HELD_RATE * tolerances.SAME_COMMON_MOTION * motion.fastest
    return frozenset(
        (joint.name, name)
        for joint in joints
        for name, freedom in joint.type.freedom_of.items()
        if abs(motion.rates.get((joint.name, freedom), 0.0)) > moving
    )


def _axis(screw: Screw | None, size: float) -> Line | None:
    if screw is None or not is_pure_turn(screw):
        return None
    along, point = line_of(screw)
    return Line(along, scale(size, point))
