"""Elements of the small pictures, and the symbols of joints.

A joint's symbol follows from its entry in the joint table: a turn about an axis is a pin along it;
a slide a block on a rail, with a turn a sleeve, on a thread a nut with its grooves; a ball stands
in a ring, on a plate, or between the walls of a groove; two turns are a cross of their axes. Where
`limits:` end a coordinate there are stops: marks across a rail, and ends of an arc about a pin.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

from mechkin_cli.mechanism import JointType
from mechkin_cli.record import NamedTuple

Place = tuple[float, float]
"""To the right and downwards, in points."""


class Stroke(NamedTuple):
    """A line through places, or the edge of an area where it is closed.

    `ink` names the class of its colour: `k` ink, `p` paper, `l0` to `l7` links; `filled` areas are
    of that colour with a paler inside.
    """

    places: tuple[Place, ...]
    ink: str
    width: float
    closed: bool = False
    filled: bool = False
    round_ends: bool = False

    @property
    def svg(self) -> str:
        """The element."""
        first, *rest = self.places
        path = f"M{_place(first)}" + "".join(f"L{_place(place)}" for place in rest)
        ends = ' stroke-linecap="round"' if self.round_ends else ""
        inside = f' class="{self.ink} a"' if self.filled else f' class="{self.ink}"'
        return (
            f'<path{inside} stroke-width="{self.width:.1f}"{ends} d="{path}{"Z" * self.closed}"/>'
        )


class Disc(NamedTuple):
    """A disc of paper with an edge of ink, or of ink alone."""

    centre: Place
    radius: float
    is_ink: bool = False

    @property
    def svg(self) -> str:
        """The element."""
        x, y = (number(value) for value in self.centre)
        kind = "i" if self.is_ink else "d"
        return f'<circle class="{kind}" cx="{x}" cy="{y}" r="{self.radius:.1f}"/>'


Mark = Stroke | Disc


def line(a: Place, b: Place, ink: str = "k", width: float = 1.2) -> Stroke:
    """A straight line."""
    return Stroke((a, b), ink, width)


def bar(
    a: Place,
    b: Place,
    width: float,
    *,
    round_ends: bool = False,
    ink: str = "k",
    edge: float = 1.2,
) -> list[Mark]:
    """A bar of paper with an edge of ink."""
    inside = (a, b) if round_ends else _shortened(a, b, edge)
    outer = Stroke((a, b), ink, width, round_ends=round_ends)
    return [outer, Stroke(inside, "p", width - 2.0 * edge, round_ends=round_ends)]


def moved(place: Place, by: Sequence[float], times: float) -> Place:
    """A place that is shifted."""
    return place[0] + times * by[0], place[1] + times * by[1]


def number(value: float) -> str:
    """With one decimal; zero has no sign."""
    return f"{round(value, 1) + 0.0:.1f}"


def _place(place: Place) -> str:
    return f"{number(place[0])} {number(place[1])}"


def _shortened(a: Place, b: Place, by: float) -> tuple[Place, Place]:
    length = ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5
    share = by / length if length > 2.0 * by else 0.0
    along = (b[0] - a[0], b[1] - a[1])
    return moved(a, along, share), moved(b, along, -share)


PIN, BLOCK, PLATE, GROOVE, CROSS, RAIL, STOP = 5.0, 7.0, 11.0, 12.0, 8.0, 9.0, 6.0
"""Half lengths in points."""

THICK, BALL, ROD, ARC = 8.0, 5.0, 3.2, 16.0
SHORT = 0.25
"""A pin that is seen more nearly end on than this is a disc."""


class Half(NamedTuple):
    """One link's half of a joint: its place, and what the axes of its frame are on the picture,
    shortened as they are seen."""

    place: Place
    axis: Place
    x: Place
    y: Place


def symbol(kind: JointType, first: Half, second: Half) -> list[Mark]:
    """A joint, from back to front."""
    slides, turns = sum(kind.slides), len(kind.slides) - sum(kind.slides)
    if kind.is_carried:
        turns_about_one = any(known.is_angle for known in kind.named)
        return _pin(first.place, first.axis) if turns_about_one else _ball(first.place)
    if kind.is_ball:
        return _ball(first.place)
    if kind.is_oriented:
        seat = _groove if kind.named else _plate
        return [*seat(second, first.place), *_ball(first.place)]
    if kind.has_slip:
        bed = _plate if slides > 1 else _groove
        return [*bed(second, first.place), *_pin(first.place, first.axis)]
    if turns > 1:
        rail = _rail(first, second) if slides else []
        return [*rail, *_cross(second.place, first.axis, second.axis)]
    if slides > 1:
        return [*_plate(first, second.place), Disc(second.place, 2.4, is_ink=True)]
    if not slides and not kind.is_threaded:
        return _pin(second.place, second.axis)
    sides = _block(second, round_ends=turns > 0)
    if kind.is_threaded:  # on its spindle
        return [*sides, *_slashes(second)]
    return [*_rail(first, second), *sides]


Ends = tuple[float | None, float | None]
"""Of a coordinate: None where it has no limit, or none that is drawn."""


def slide_stops(first: Half, second: Half, ends: Ends) -> list[Mark]:
    """Marks across a rail where what slides on it touches them; `ends`: of the slide, in points of
    a length that is seen in full."""
    length = (first.axis[0] ** 2 + first.axis[1] ** 2) ** 0.5
    if length < SHORT:
        return []
    across = -first.axis[1] / length, first.axis[0] / length
    marks: list[Mark] = []
    for end, side in zip(ends, (-1.0, 1.0), strict=True):
        if end is not None:
            place = moved(first.place, first.axis, end + side * (BLOCK + 1.5))
            marks.append(line(second.place, place, width=1.8))
            marks.append(line(moved(place, across, -STOP), moved(place, across, STOP), width=1.8))
    return marks


def turn_stops(first: Half, second: Half, ends: Ends) -> list[Mark]:
    """An arc about a pin between the `ends` of its turn (rad), with a mark at each."""
    low, high = ends
    if low is not None and high is not None and high - low > 2.0 * pi - 0.3:
        return []

    def at(turn: float, radius: float) -> Place:
        out = moved(second.place, first.x, radius * cos(turn))
        return moved(out, first.y, radius * sin(turn))

    start = (high or 0.0) - 1.0 if low is None else low
    end = start + 1.0 if high is None else high
    turns = [start + (end - start) * k / 24 for k in range(25)]
    marks: list[Mark] = [Stroke(tuple(at(turn, ARC) for turn in turns), "k", 0.9)]
    marks += [
        line(at(turn, ARC - STOP / 2.0), at(turn, ARC + STOP / 2.0), width=1.8)
        for turn in ends
        if turn is not None
    ]
    return marks


def ground_mark(place: Place) -> list[Mark]:
    """A hatched foot below a joint on ground."""
    x, y = place
    foot = y + 10.0
    starts = (x - 4.0, x, x + 4.0, x + 8.0)
    hatches = [line((k, foot), (k - 3.0, foot + 4.0), width=0.9) for k in starts]
    return [line((x, y), (x, foot)), line((x - 8.0, foot), (x + 8.0, foot), width=1.6), *hatches]


def _pin(place: Place, axis: Place) -> list[Mark]:
    if axis[0] ** 2 + axis[1] ** 2 < SHORT**2:
        return [Disc(place, THICK / 2.0), Disc(place, 1.0, is_ink=True)]
    ends = moved(place, axis, -PIN), moved(place, axis, PIN)
    return bar(*ends, THICK, round_ends=True)


def _block(half: Half, *, round_ends: bool) -> list[Mark]:
    length = (half.axis[0] ** 2 + half.axis[1] ** 2) ** 0.5
    if length < SHORT:
        return [Disc(half.place, THICK / 2.0)]
    ends = moved(half.place, half.axis, -BLOCK), moved(half.place, half.axis, BLOCK)
    return bar(*ends, THICK + 1.0, round_ends=round_ends)


def _rail(first: Half, second: Half) -> list[Mark]:
    """From the first link's half through the second's, a little beyond both."""
    by = first.axis
    ends = [moved(half.place, by, k * 2.0 * RAIL) for half in (first, second) for k in (-1, 1)]
    ends.sort(key=lambda place: (place[0] * by[0] + place[1] * by[1], place))
    return [line(ends[0], ends[-1], width=1.8)]


def _slashes(half: Half) -> list[Mark]:
    across = (-half.axis[1] + 0.3 * half.axis[0], half.axis[0] + 0.3 * half.axis[1])
    centres = [moved(half.place, half.axis, k * 4.0) for k in (-1, 0, 1)]
    return [line(moved(c, across, -3.6), moved(c, across, 3.6), width=0.9) for c in centres]


def _ball(place: Place) -> list[Mark]:
    return [Disc(place, BALL), Disc(place, 2.6, is_ink=True)]


def _plate(half: Half, touched: Place) -> list[Mark]:
    """A plate about its own place and the one that is touched."""
    to = touched[0] - half.place[0], touched[1] - half.place[1]
    area, way = _area(half.x, half.y), (0.0, 0.0)
    if abs(area) > SHORT**2:
        way = _area(to, half.y) / area, _area(half.x, to) / area
    left, low = (min(0.0, part) - PLATE for part in way)
    right, high = (max(0.0, part) + PLATE for part in way)
    corners = [
        moved(moved(half.place, half.x, a), half.y, b)
        for a, b in ((left, low), (right, low), (right, high), (left, high))
    ]
    return [Stroke(tuple(corners), "k", 1.2, closed=True, filled=True)]


def _groove(half: Half, touched: Place) -> list[Mark]:
    """The walls beside its own place and the one that is touched."""
    along = half.axis
    to = touched[0] - half.place[0], touched[1] - half.place[1]
    length = max(along[0] ** 2 + along[1] ** 2, SHORT**2)
    way = (to[0] * along[0] + to[1] * along[1]) / length
    start, end = min(0.0, way) - GROOVE, max(0.0, way) + GROOVE
    wall = max((half.x, half.y), key=lambda by: abs(_area(by, along)))
    sides = [moved(half.place, wall, k * 7.5) for k in (-1.0, 1.0)]
    return [line(moved(s, along, start), moved(s, along, end), width=1.8) for s in sides]


def _cross(place: Place, one: Place, other: Place) -> list[Mark]:
    arms: list[Mark] = []
    for by in (one, other):
        ends = moved(place, by, -CROSS), moved(place, by, CROSS)
        arms += [line(*ends, width=2.6), *(Disc(end, 2.2) for end in ends)]
    return arms


def _area(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[1] - a[1] * b[0]
