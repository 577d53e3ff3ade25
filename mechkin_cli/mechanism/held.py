"""What holds an idle freedom: a slipper's turn on its plate, a sleeve's on its pin, a ball's turns.

Some links may move, in a chain as one body, while all others stay at rest. No equation tells that
motion, so one coordinate of it is held where it is drawn (or where `near` puts it), as if it were
an input at rest; nothing that is not conventional depends on it. The own links of a constraint have
no such coordinate (constraint.py, `DistanceConstraint`).
"""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.mechanism.joint import GROUND_NAME, Joint
from mechkin_cli.mechanism.model import Coordinate, Mechanism
from mechkin_cli.mechanism.pairs import is_angle
from mechkin_cli.mechanism.vectors import Line
from mechkin_cli.record import NamedTuple


class LockedFreedom(NamedTuple):
    """An idle freedom of some links, and what holds it.

    `coordinate` is held, of one of the `joints` around the links; `told` is its joint where that is
    told as other turns to have it; or `stop`, one more pair, holds it. `moves` are the coordinates
    that move with it; `axes` the lines about which each link turns, None where it does not turn
    about lines of its own; `slides` whether it slides without a turn; `holding` names the effort
    that holds it. `everywhere`: it is idle wherever these joints are, not only where the mechanism
    takes them. `miss`: the twist (rad, parts of the size) by which the joints have the motion in
    common but for, where it is of speed one. Not `idle`: the loops stop it, but not to first order,
    wherever the inputs take the mechanism, so that it rests in every row and its equation is one
    that the loops imply.
    """

    links: tuple[str, ...]
    joints: tuple[str, ...]
    coordinate: Coordinate | None
    moves: frozenset[Coordinate]
    axes: Mapping[str, Line | None]
    slides: bool
    holding: str
    told: Joint | None = None
    stop: Joint | None = None
    everywhere: bool = True
    miss: float = 0.0
    idle: bool = True

    @property
    def name(self) -> str:
        """The coordinate's name, empty without one."""
        return ".".join(self.coordinate or ())

    def is_in(self, mechanism: Mechanism) -> bool:
        """Whether what holds it is a part of a mechanism."""
        if self.stop is not None:
            links = {GROUND_NAME, *mechanism.links}
            return {self.stop.first, self.stop.second} <= links
        return self.coordinate is not None and self.coordinate[0] in mechanism.joints

    @property
    def turns(self) -> bool:
        """Whether a moment holds it, not a force."""
        return self.coordinate is not None and is_turn(self.coordinate[1])

    @property
    def about_point(self) -> bool:
        """Whether the links turn about every line through a point."""
        return any(line is not None and line.along is None for line in self.axes.values())

    @property
    def convention(self) -> str:
        """What is told of it by convention."""
        if not self.idle:
            return "it rests in every row"
        if self.coordinate is None:
            return f"it stays at {self.joints[0]} as it is drawn"
        joint, coordinate = self.coordinate
        if not is_unnamed(coordinate):
            return f"{self.name} is held as it is drawn"
        if any(line is not None and line.along is not None for line in self.axes.values()):
            return f"the turn of {joint} about that line is held as it is drawn"
        what = "the turns" if is_turn(coordinate) else "the slides"
        return f"{what} of {joint} are held as they are drawn"

    @property
    def cure(self) -> str:
        """How to have a pose of its own."""
        if self.coordinate is None:
            return f"drive a slide of {self.joints[0]}"
        joint, coordinate = self.coordinate
        if not is_unnamed(coordinate):
            return f"drive {self.name}"
        return f"replace {joint} by {'W' if self.about_point else 'U'}"

    @property
    def words(self) -> str:
        """The freedom in an engineer's words."""
        if not self.idle:
            moves = "turns" if self.turns else "moves"
            return f"{' and '.join(self.links)} {moves} to first order only"
        spins = any(self.axes.values())
        kind = "slide" if self.slides else "spin" if spins else "move"
        verb = f"{kind}s" if len(self.links) == 1 else f"{kind} together"
        where = "along" if self.slides else "about" if spins else "between"
        if self.about_point:
            where = "about the centre of"
        return f"{' and '.join(self.links)} {verb} freely {where} {'-'.join(self.joints)}"


def turn_name(freedom: int) -> str:
    """The name of a ball's turn of its own; no user's name has a blank."""
    return f"turn {freedom}"


def slide_name(freedom: int) -> str:
    """The name of a slide that has none."""
    return f"slide {freedom}"


def is_unnamed(coordinate: str) -> bool:
    """Whether it is a freedom for which no user's name stands."""
    return " " in coordinate


def is_turn(coordinate: str) -> bool:
    """Whether a coordinate, with or without a name, is an angle."""
    return is_angle(coordinate) or coordinate.startswith("turn ")
