"""Chooses for each idle motion of a group of links a coordinate that locks it, or one more pair.

First those coordinates that the motion moves at the same rate wherever the mechanism goes, angles
before slides. A slide between two tilted planes has none where the planes' coordinates stand on the
other links; a plane on the link, square to the slide, then keeps a point of its neighbour (Sp), and
holds it everywhere. What has no named coordinate left is held by turns of a ball or by slides on a
plane (`Holder`).

Balls as three turns, one after the other, of which some can be held: where an idle spin moves no
coordinate that has a name, a ball around the links is replaced by turns about an axis of the far
link, about what is square to both, and about the line of the near link; the last one is held. It is
singular where the line comes to lie along the first axis, which is chosen as that of a joint of the
far link, about which the line as a rule goes round. Where there is no line, the turns are about the
axes of the drawing; if all three are held, they are never singular.

Exact numbers (`exact_holds`): where a made pair stands is that of the joint that it belongs to,
along which axes it holds is a choice of the doubles. An axis that was chosen in doubles is made a
unit vector, and a frame of such axes orthonormal, so that the pair is one; which one it is, only
conventional quantities depend on.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence

from mechkin_cli import tolerances
from mechkin_cli.idle.find import (
    Coordinate,
    DrawnGroup,
    Freedom,
    IdleBasis,
    LinkMotion,
    RigidGroup,
    idle_groups,
    is_pure_turn,
    is_slide,
    line_of,
)
from mechkin_cli.mechanism import (
    GROUND,
    ZERO,
    Frame,
    Joint,
    Line,
    LockedFreedom,
    Mechanism,
    Part,
    Screw,
    Vector,
    add,
    cross,
    dot,
    frame_about,
    frame_on,
    is_turn,
    is_unnamed,
    norm,
    perpendicular,
    scale,
    slide_name,
    stop_of,
    subtract,
    turn_name,
    unit,
)

Triad = tuple[Vector, Vector, Vector]


def _turns_with_line(
    mechanism: Mechanism, joint: Joint, link: str, line: Vector
) -> tuple[Joint, int]:
    """A joint whose ball is three turns, one of them about a line (a unit vector) on the drawing of
    one of its links; and the number of that freedom."""
    far = joint.second if joint.first == link else joint.first
    ball = next(part for part in joint.parts if part.type.is_ball)
    own, other = (ball.before, ball.after) if link == joint.first else (ball.after, ball.before)
    first = _axis_of(mechanism, joint, far, other, own, line)
    parts: list[Part] = []
    number = held = 0
    for part in joint.parts:
        if not part.type.is_ball:
            parts.append(part)
            number += len(part.type.freedoms)
            continue
        near = part.after if link == joint.second else part.before
        last = near.components(line)
        middle = unit(cross(last, first))
        triad = (first, middle, last) if link == joint.second else (last, middle, first)
        held = number + (2 if link == joint.second else 0)
        parts += _turns(part, [(z, middle if z is not middle else last) for z in triad])
        number += 3
    return joint._replace(parts=tuple(parts)), held


def three_turns(joint: Joint, axes: Triad = (GROUND.x, GROUND.y, GROUND.z)) -> Joint:
    """A joint whose ball is turns about three axes, square to each other, in its own axes as
    drawn."""
    x, y, z = axes
    parts: list[Part] = []
    for part in joint.parts:
        parts += _turns(part, [(x, y), (y, z), (z, x)]) if part.type.is_ball else [part]
    return joint._replace(parts=tuple(parts))


def _turns(ball: Part, axes: Sequence[tuple[Vector, Vector]]) -> list[Part]:
    """A ball as turns about the first of each pair of axes, given in its own axes."""
    before = [_about(ball.before, z, x) for z, x in axes]
    after = [*before[:-1], _about(ball.after, *axes[-1])]
    return [Part("R", *frames) for frames in zip(before, after, strict=True)]


def _axis_of(
    mechanism: Mechanism, joint: Joint, far: str, other: Frame, own: Frame, line: Vector
) -> Vector:
    """An axis of the far link, in the ball's own axes: of its joint that stands squarest to the
    line as drawn, else any that is square to it."""
    drawn = own.components(line)
    axes = [
        other.components(frame_on(one, far).z)
        for one in mechanism.joints_of[far]
        if one is not joint and one.type.is_guide
    ]
    axes = [axis for axis in axes if abs(dot(axis, drawn)) < tolerances.HELD_ACROSS]
    if not axes:
        return perpendicular(drawn)
    return min(axes, key=lambda axis: abs(dot(axis, drawn)))


def _about(frame: Frame, z: Vector, x: Vector) -> Frame:
    """A frame at the origin of another, its z and x given in that one's axes."""
    return frame_about(frame.vector(z), frame.vector(x), frame.o)


Screws = dict[str, Screw | None]

EQUAL = 1.0 + tolerances.HELD_RATE
"""Factor up to which two rates count as equal."""


class Holder:
    """Takes groups one after the other; lengths in parts of `size` (m)."""

    def __init__(
        self, mechanism: Mechanism, driven: Collection[Coordinate], size: float, origin: Vector
    ) -> None:
        self.mechanism, self.size, self.origin = mechanism, size, origin
        self.held: list[LockedFreedom] = []
        self.split: set[str] = set()
        self.taken = {*driven}
        self.basis = IdleBasis()
        self.inside = {name for c in mechanism.constraints for name in c.joints}

    def leave(self, group: RigidGroup) -> None:
        """Accounts for the motions of a group that need nothing to hold them."""
        while group.count:
            group.take(group.left[0][0][1].fastest_freedom, self.basis)

    def named(self, group: RigidGroup) -> list[tuple[Joint, str, Freedom]]:
        """The coordinates by which a group may be held: angles first, of one turn before two."""
        candidates = [
            (joint, name, (joint.name, freedom))
            for joint in group.joints
            if joint.name not in self.inside
            for name, freedom in joint.type.scalars.items()
            if (joint.name, name) not in self.taken
            and group.count
            and group.least_rate((joint.name, freedom)) > tolerances.HELD_RATE
        ]

        def order(candidate: tuple[Joint, str, Freedom]) -> tuple[bool, bool]:
            coordinate = candidate[0].type.coordinate[candidate[1]]
            return not coordinate.is_angle, coordinate.axis is None

        return sorted(candidates, key=order)

    def steady(self, group: RigidGroup) -> list[tuple[Joint, str, Freedom]]:
        """Those that move at the same rate wherever the mechanism goes."""
        return [one for one in self.named(group) if group.is_steady(one[2])]

    def hold(self, group: RigidGroup) -> None:
        """Holds whatever a group may do beside what is held."""
        group.reduce(self.basis)
        centre, first = _centre(group, self.size, self.origin), len(self.held)
        while group.count and self._hold_once(group):
            pass
        self.leave(group)
        if len(self.held) - first > 1:
            self._name_each(first, centre)

    def _hold_once(self, group: RigidGroup) -> bool:
        """Holds one of the motions that are left, if that is possible."""
        named, steady = self.named(group), self.steady(group)
        if not steady and self._hold_by_stop(group):
            return True
        if named:
            unsteady = sorted(named, key=lambda one: -group.least_rate(one[2]))
            joint, name, freedom = (steady or unsteady)[0]
            screws = self._screws(group)
            self._put(group, (joint.name, name), group.take(freedom, self.basis), screws)
            return True
        # three turns of one ball are never singular together
        begun = self._unnamed(group, self.split, tolerances.HELD_WELL, slides=False)
        if begun is None and self._hold_by_line(group):
            return True
        return self._hold_by_unnamed(group, begun)

    def _screws(self, group: RigidGroup) -> Screws:
        return {link: group.carried(link) for link in group.links}

    def _hold_by_stop(self, group: RigidGroup) -> bool:
        """Holds the slide of a link along a line that it carries by one more pair."""
        screws = self._screws(group)
        for joint in group.joints:
            link = joint.second if joint.second in group.links else joint.first
            screw = screws[link]
            if screw is None or not is_slide(screw) or joint.name in self.inside:
                continue
            motion = group.take(group.left[0][0][0].fastest_freedom, self.basis)
            self._put(group, None, motion, screws, stop=stop_of(joint, link, screw[1]))
            return True
        return False

    def _balls(self, group: RigidGroup) -> list[Joint]:
        """The balls around a group that may become three turns, plain ones first."""
        told = {one.told.name for one in self.held if one.told is not None}
        busy = {*told, *self.inside, *(name for name, _ in self.taken)}
        balls = [j for j in group.joints if j.type.is_oriented and j.name not in busy]
        return sorted(balls, key=lambda joint: joint.type.has_slip)

    def _hold_by_line(self, group: RigidGroup) -> bool:
        """Holds one turn about a line of a link at a ball."""
        screws = self._screws(group)
        _, motion = group.left[0][0]
        for ball in self._balls(group) if group.count == 1 else ():
            link = ball.second if ball.second in group.links else ball.first
            line = self._line(group, ball, link, screws[link])
            if line is None:
                continue
            turns, freedom = _turns_with_line(self.mechanism, ball, link, line)
            chain = enumerate(ball.type.chain)
            own = [(ball.name, number) for number, one in chain if one.motion == "ball"]
            most = max(own, key=motion.part)
            if motion.part(most) <= tolerances.HELD_RATE:
                continue
            coordinate = (ball.name, turn_name(freedom))
            self._put(group, coordinate, group.take(most, self.basis), screws, told=turns)
            return True
        return False

    def _line(
        self, group: RigidGroup, ball: Joint, link: str, screw: Screw | None
    ) -> Vector | None:
        """The unit vector along the line about which a group turns at a ball: that which a link
        carries, or that of two balls as drawn, unless they coincide."""
        if screw is not None:
            return screw[0] if any(screw[0]) else None
        other = next((j for j in group.joints if j is not ball and j.type.is_oriented), None)
        if other is None or len(group.joints) > 2:
            return None
        end = other.second if other.second in group.links else other.first
        line = subtract(frame_on(other, end).o, frame_on(ball, link).o)
        length = norm(line)
        return scale(1.0 / length, line) if length > tolerances.COMMON_MOTION * self.size else None

    def _hold_by_unnamed(self, group: RigidGroup, best: tuple[Joint, int, str] | None) -> bool:
        """Holds what is left at a turn of a ball or a slide without a name: that which moves most,
        if none is `best`."""
        if best is None:
            balls = {joint.name for joint in self._balls(group)} | self.split
            best = self._unnamed(group, balls, tolerances.HELD_RATE)
        if best is None:
            return False
        joint, number, name = best
        self.split.add(joint.name)
        motion = group.take((joint.name, number), self.basis)
        turns = three_turns(joint) if joint.type.is_oriented else None
        self._put(group, (joint.name, name), motion, {}, told=turns)
        return True

    def _unnamed(
        self, group: RigidGroup, balls: Collection[str], least: float, *, slides: bool = True
    ) -> tuple[Joint, int, str] | None:
        """The turn of one of some balls, or slide, that moves most, and more than `least`."""
        # of equal ones the first is taken, whatever rounding says
        best: tuple[Joint, int, str] | None = None
        for joint in group.joints:
            for number, freedom in enumerate(joint.type.chain):
                of_ball = freedom.motion == "ball"
                name = turn_name(number) if of_ball else slide_name(number)
                named = number in joint.type.scalars.values() or (joint.name, name) in self.taken
                allowed = joint.name in balls if of_ball else slides
                if named or joint.name in self.inside or not allowed:
                    continue
                rate = group.least_rate((joint.name, number))
                if rate > least:
                    best, least = (joint, number, name), rate * EQUAL
        return best

    def _put(
        self,
        group: RigidGroup,
        coordinate: Coordinate | None,
        motion: LinkMotion,
        screws: Screws,
        *,
        told: Joint | None = None,
        stop: Joint | None = None,
    ) -> None:
        """Records what holds a motion."""
        slides = any(is_slide(screw) for screw in screws.values())
        axes: dict[str, Line | None] = {}
        for link in group.links:
            screw = screws.get(link)
            axes[link] = None
            if screw is not None and is_pure_turn(screw):
                along, point = line_of(screw)
                axes[link] = Line(along, scale(self.size, point))
        if coordinate is not None:
            self.taken.add(coordinate)
        kind = "moment" if coordinate is not None and is_turn(coordinate[1]) else "force"
        holding = f"{group.links[0]}.holding_{kind}"
        if any(one.holding == holding for one in self.held):
            holding = f"{group.links[-1]}.holding_{kind}"
        least = tolerances.HELD_RATE * tolerances.SAME_COMMON_MOTION * motion.fastest
        moves = frozenset(
            (joint.name, name)
            for joint in group.joints
            for name, freedom in joint.type.freedom_of.items()
            if abs(motion.rates.get((joint.name, freedom), 0.0)) > least
        )
        joints = tuple(joint.name for joint in group.joints)
        miss = motion.miss / (motion.fastest or 1.0)
        held = LockedFreedom(
            group.links, joints, coordinate, moves, axes, slides, holding, told, stop, miss=miss
        )
        self.held.append(held)

    def _name_each(self, first: int, centre: Line | None) -> None:
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


def _centre(group: RigidGroup, size: float, origin: Vector) -> Line | None:
    """The centre about which a link turns freely: that of two spheres in one place."""
    if len(group.links) > 1 or group.count != 3:
        return None
    balls = [joint for joint in group.joints if joint.type.is_oriented]
    centres = [frame_on(joint, group.links[0]).o for joint in balls]
    if len(centres) != len(group.joints):
        return None
    apart = max(norm(subtract(one, centres[0])) for one in centres)
    near = apart <= tolerances.COMMON_MOTION * size
    return Line(None, subtract(centres[0], origin)) if near else None


def held_freedoms(
    mechanism: Mechanism, driven: Collection[Coordinate]
) -> tuple[tuple[LockedFreedom, ...], bool]:
    """What holds the idle freedoms that joints have wherever they are, but spins, small
    groups of links first; and whether more, or other motions, may be idle because the mechanism
    keeps its joints as they are drawn."""
    size = mechanism.box_diagonal()
    origin = next((joint.point.vector for joint in mechanism.joints.values()), ZERO)
    groups, drawn = idle_groups(mechanism, driven, size, origin, _spinning(mechanism))
    held = held_groups(mechanism, driven, groups, size, origin)
    if any(_moves_as_drawn(one, held) for one in drawn):
        return held, True
    independent = IdleBasis()  # motions as drawn
    for one in drawn:
        group = RigidGroup(one.chain[0], one.chain[2], [one.motions([])])
        group.reduce(independent)
        group.join(independent)
    return held, independent.count != len(held)


def _moves_as_drawn(group: DrawnGroup, held: Sequence[LockedFreedom]) -> bool:
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
    groups: Sequence[RigidGroup],
    size: float,
    origin: Vector,
) -> tuple[LockedFreedom, ...]:
    """What holds the motions of some groups; lengths in parts of `size` (m), about `origin` (m)."""
    holder = Holder(mechanism, driven, size, origin)
    spinning = _spinning(mechanism)
    others = [group for group in groups if frozenset(group.links) not in spinning]
    known = IdleBasis()
    for group in groups:
        if frozenset(group.links) in spinning:
            group.join(known)
            holder.leave(group)
    for group in sorted(others, key=lambda group: len(group.links)):
        group.reduce(known)
        group.join(known)
    # what can be held at few places has the choice before what can be held at many
    for group in sorted(others, key=lambda group: len(holder.steady(group))):
        holder.hold(group)
    from_ground = []
    for one in holder.held:
        axes = {
            link: None if line is None else Line(line.along, add(line.start, origin))
            for link, line in one.axes.items()
        }
        from_ground.append(one._replace(axes=axes))
    return tuple(from_ground)


def _spinning(mechanism: Mechanism) -> set[frozenset[str]]:
    return {frozenset(spin.links) for spin in mechanism.spins}


Lift = Callable[[float], float]
"""A double as a recorded number."""


def exact_holds(
    held: LockedFreedom, own: Mechanism, recorded: Mechanism, lift: Lift
) -> LockedFreedom:
    """What holds an idle freedom, with its pairs on recorded numbers.

    Args:
        held: in doubles.
        own: the mechanism in doubles.
        recorded: the mechanism on a recording.
        lift: puts a double on that recording.
    """
    if held.told is None and held.stop is None:
        return held
    placed = _Placed(own, recorded, lift)
    told = None if held.told is None else placed.told(held.told)
    stop = None if held.stop is None else placed.stop(held.stop)
    return held._replace(told=told, stop=stop)


class _Placed:
    """Frames of made pairs by the points of the joints beside them."""

    def __init__(self, own: Mechanism, recorded: Mechanism, lift: Lift) -> None:
        self.own, self.recorded, self.lift = own, recorded, lift
        pairs = zip(_frames(own), _frames(recorded), strict=True)
        self.points: dict[Vector, Vector] = {one.o: other.o for one, other in pairs}

    def told(self, joint: Joint) -> Joint:
        """A joint made of other parts; those that it has as written stay what they are."""
        written = self.recorded.joints[joint.name]
        known = zip(self.own.joints[joint.name].parts, written.parts, strict=True)
        same = {id(one): other for one, other in known}
        parts = tuple(same.get(id(part)) or self._part(part) for part in joint.parts)
        return written._replace(parts=parts)

    def stop(self, joint: Joint) -> Joint:
        """A pair of its own beside a joint."""
        parts = tuple(map(self._part, joint.parts))
        first, second = self._frame(joint.on_first), self._frame(joint.on_second)
        return joint._replace(on_first=first, on_second=second, parts=parts)

    def _part(self, part: Part) -> Part:
        before = self._frame(part.before)
        after = before if part.after == part.before else self._frame(part.after)
        return part._replace(before=before, after=after)

    def _frame(self, frame: Frame) -> Frame:
        z, x = unit(self._lifted(frame.z)), self._lifted(frame.x)
        return frame_about(z, x, self.points[frame.o])

    def _lifted(self, vector: Vector) -> Vector:
        return (self.lift(vector[0]), self.lift(vector[1]), self.lift(vector[2]))


def _frames(mechanism: Mechanism) -> Iterator[Frame]:
    for joint in mechanism.joints.values():
        yield from (joint.on_first, joint.on_second)
        for part in joint.parts:
            yield from (part.before, part.after)
