"""The small picture of a mechanism: its first position with a solution, and its points' paths.

Links are lines, areas, stars, bars or discs in their colours, as `view.shapes` has them; joints are
symbols; a joint on ground stands on a hatched foot. Wheels of couplings have their teeth. Feet,
paths and belts are drawn first, then links, then joints, each from far to near, what is as near in
the order of the file. Numbers have one decimal.

In reading order: the projection, elements of SVG, symbols of joints, the picture. The projection is
isometric: all three axes are shortened alike, seen from the corner (1, 1, 1). With x', y', z' the
axes turned so that z' points up, a point stands at (y' - x')/sqrt(2) to the right and
(2z' - x' - y')/sqrt(6) upwards, and is (x' + y' + z')/sqrt(3) near. A joint's symbol follows from
its entry in the joint table: a turn about an axis is a pin along it; a slide a block on a rail,
with a turn a sleeve, on a thread a nut with its grooves; a ball stands in a ring, on a plate, or
between the walls of a groove; two turns are a cross of their axes. A curved groove or slot has its
own curve as walls, a curved surface lines of its parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from math import sqrt
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import DrawnWheel, ViewSettings
from mechkin_cli.mechanism import (
    FIRST,
    GROUND_NAME,
    SECOND,
    Attached,
    Joint,
    JointType,
    Mechanism,
    diagonal,
    is_written,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.view.cams import DrawnCam, drawn_cams
from mechkin_cli.view.joints import (
    HOME,
    Shape,
    carried,
    drawn_joints,
    half_axis,
    half_frame,
    link_poses,
    link_shape,
)
from mechkin_cli.view.page import FLATNESS, POINTS_APART, thinned
from mechkin_cli.view.tracks import DrawnTrack, drawn_track
from mechkin_cli.view.wheels import (
    belt_line,
    cable_line,
    cable_pulleys,
    round_about,
    wheel_outlines,
)

if TYPE_CHECKING:
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Result


class Isometric(NamedTuple):
    """The axis (0, 1, 2) of ground that points up, and whether it does so backwards."""

    up: int = 2
    down: bool = False

    def seen(self, points: Floats) -> Floats:
        """Places (..., 3) on the picture: to the right, upwards, and how near."""
        x, y, z = (points[..., (self.up + k) % 3] for k in (1, 2, 3))
        if self.down:
            y, z = -y, -z
        return np.stack(
            [(y - x) / sqrt(2.0), (2.0 * z - x - y) / sqrt(6.0), (x + y + z) / sqrt(3.0)], axis=-1
        )


def isometric(mechanism: Mechanism) -> Isometric:
    """The projection of a mechanism: up is against gravity, else z, or y where all axes about which
    joints turn are along z, so that a plane linkage stands upright."""
    gravity = np.array(mechanism.gravity)
    if gravity.any():
        axis = int(np.argmax(np.abs(gravity)))
        return Isometric(axis, bool(gravity[axis] > 0.0))
    turning = [
        joint.on_first.z
        for joint in drawn_joints(mechanism)
        if not all(joint.type.slides) or joint.type.is_oriented
    ]
    flat = [max(abs(axis[0]), abs(axis[1])) <= FLATNESS for axis in turning]
    return Isometric(1) if flat and all(flat) else Isometric(2)


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


def bar(a: Place, b: Place, width: float, *, round_ends: bool) -> list[Mark]:
    """A bar of paper with an edge of ink."""
    edge = 2.4
    inside = (a, b) if round_ends else _shortened(a, b, edge / 2.0)
    outer = Stroke((a, b), "k", width, round_ends=round_ends)
    return [outer, Stroke(inside, "p", width - edge, round_ends=round_ends)]


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


PIN, BLOCK, PLATE, GROOVE, CROSS, RAIL = 5.0, 7.0, 11.0, 12.0, 8.0, 9.0
"""Half lengths in points."""

THICK, BALL, ROD = 8.0, 5.0, 3.2
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
    grooves = _slashes(second) if kind.is_threaded else []
    return [*_rail(first, second), *sides, *grooves]


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


PICTURE_NAME = "picture.svg"
"""Of the file beside a mechanism's tables."""

WIDTH, HEIGHT, MARGIN = 200.0, 150.0, 24.0
MOST_PATH_POINTS = 120
TUBE = 0.6
"""Length of a cylinder's tube in parts of that from eye to eye."""

SLOT = 13.0
"""Width of a curved groove, over its walls."""

SURFACE_LINES = 4
"""Cells of a curved surface from line to line."""

LEAST_PITCH = 2.5
"""From tooth to tooth on the picture: below it wheels are circles."""

NEAR_DECIMALS = 6
"""Of how near a thing is, in parts of the mechanism's size: the rest is rounding."""

COLOURS = (
    ("#0969da", "#58a6ff"),
    ("#bc4c00", "#ffa657"),
    ("#1a7f37", "#57d364"),
    ("#8250df", "#d2a8ff"),
    ("#bf3989", "#ff9bce"),
    ("#9a6700", "#e3b341"),
    ("#1b7c83", "#56d4dd"),
    ("#a40e26", "#ff7b72"),
)
"""Of links in the order of the file, on light and on dark."""

STYLE = "".join(
    (
        "path{fill:none;stroke-linejoin:round}.k{stroke:#24292f}.p{stroke:#fff}",
        ".d{fill:#fff;stroke:#24292f;stroke-width:1.2}.i{fill:#24292f}.a{fill-opacity:.16}",
        ".k.a{fill:#24292f}.t{stroke-opacity:.55}",
        *(f".l{k}{{stroke:{c}}}.l{k}.a{{fill:{c}}}" for k, (c, _) in enumerate(COLOURS)),
        "@media(prefers-color-scheme:dark){.k{stroke:#e6edf3}.p{stroke:#0d1117}",
        ".d{fill:#0d1117;stroke:#e6edf3}.i,.k.a{fill:#e6edf3}",
        *(f".l{k}{{stroke:{c}}}.l{k}.a{{fill:{c}}}" for k, (_, c) in enumerate(COLOURS)),
        "}",
    )
)


Item = tuple[float, list[Mark]]
"""How near it is, and what is drawn."""


def mechanism_picture(result: Result, settings: ViewSettings | None = None) -> str:
    """The picture of a run as one SVG file with a newline at its end; `settings`: the shapes of its
    links, and which are hidden."""
    marks = _Scene(result, settings or ViewSettings()).marks()
    size = f'width="{WIDTH:.0f}" height="{HEIGHT:.0f}" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'
    return "\n".join([head, f"<style>{STYLE}</style>", *(m.svg for m in marks), "</svg>", ""])


class _Scene:
    """A run's first position on the picture."""

    def __init__(self, result: Result, settings: ViewSettings) -> None:
        self.result = result
        self.settings = settings
        self.mechanism = result.problem.mechanism
        moving = (name for name in self.mechanism.links if name != GROUND_NAME)
        self.links = [GROUND_NAME, *filter(is_written, moving)]
        poses = link_poses(result, self.links)
        solved = np.flatnonzero(result.solved)
        home = np.tile(np.array(HOME), (1, len(self.links), 1))
        self.poses = poses[solved] if solved.size else home
        self.view = isometric(self.mechanism)
        self.joints = drawn_joints(self.mechanism)
        self.size = diagonal([at.vector for _, at in self.mechanism.joint_points()]) or 1.0
        self._fit()

    def marks(self) -> list[Mark]:
        """Everything from back to front."""
        links = sorted([*self._shapes(), *self._wheels(), *self._discs()], key=itemgetter(0))
        joints = sorted(self._symbols(), key=itemgetter(0))
        return [
            *self._feet(),
            *self._paths(),
            *self._track_marks(),
            *self._belts(),
            *self._cylinders(),
            *self._cables(),
            *(m for _, marks in [*links, *joints] for m in marks),
        ]

    def _placed(self, link: str, points: Floats, row: int = 0) -> Floats:
        """Points as drawn on a link (points, 3) as they are seen: right, up, near."""
        pose = self.poses[row, self.links.index(link)]
        return np.array([self.view.seen(carried(pose, tuple(point))) for point in points])

    def _path(self, link: str, point: Sequence[float]) -> Floats:
        """A point of a link over the rows, as it is seen."""
        rows = thinned(range(len(self.poses)), MOST_PATH_POINTS)
        x, y, z = point
        return self.view.seen(carried(self.poses[rows, self.links.index(link)], (x, y, z)))

    def _fit(self) -> None:
        """Where the middle of all that is drawn is, and points per length."""
        parts = [self._placed(link, shape.outline) for link, shape in self._link_shapes()]
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                parts.append(self._placed(link, np.array([half_frame(joint, side).o])))
        parts += [self._path(at.link, at.vector) for at in self._moving_points()]
        parts += [self._placed(cam.link, cam.line) for cam in self._cams]
        parts += [self._placed(track.link, track.line) for track in self._tracks]
        for between in self.settings.between:
            if between.kind == "cylinder":
                parts += [self._placed(at.link, np.array([at.vector])) for at in between.ends]
        for places, _, rims in self._ropes:
            parts += [self.view.seen(each) for each in (places, *rims)]
        for wheel in self._drawn_wheels():
            parts += [self._placed(wheel.link, line) for line in wheel_outlines(wheel, False)]
        parts = [part for part in parts if part.size] or [np.zeros((1, 3))]
        every = np.concatenate(parts)[:, :2]
        low, high = every.min(axis=0), every.max(axis=0)
        room = np.array([WIDTH, HEIGHT]) - 2.0 * MARGIN
        self.scale = float(np.min(room / np.maximum(high - low, POINTS_APART * self.size)))
        self.middle = (low + high) / 2.0

    def _on_picture(self, seen: Floats) -> Place:
        x, y = self.scale * (seen[:2] - self.middle)
        # the feet below the joints need some room, too
        return WIDTH / 2.0 + float(x), HEIGHT / 2.0 - 4.0 - float(y)

    def _link_shapes(self) -> Iterator[tuple[str, Shape]]:
        shapes = self.settings.shapes
        # ground is seen by its feet, unless it has a shape of its own
        shown = [link for link in self.links if link != GROUND_NAME or link in shapes]
        return (
            (link, link_shape(self.mechanism, link, self.size, shapes.get(link)))
            for link in shown
            if link not in self.settings.hidden
        )

    def _moving_points(self) -> Iterator[Attached]:
        return (at for at in self.mechanism.points.values() if at.link in self.links[1:])

    def _ink(self, link: str) -> str:
        return "k" if link == GROUND_NAME else f"l{(self.links.index(link) - 1) % len(COLOURS)}"

    def _shapes(self) -> Iterator[Item]:
        for link, shape in self._link_shapes():
            if shape.kind == "none":
                continue
            seen, ink = self._placed(link, shape.outline), self._ink(link)
            places = sorted(self._on_picture(one) for one in seen)
            near = round(float(seen[:, 2].sum()) / len(seen) / self.size, NEAR_DECIMALS)
            if shape.centre is not None:
                centre = self._on_picture(self._placed(link, shape.centre[None])[0])
                marks: list[Mark] = [
                    Stroke((centre, place), ink, ROD, round_ends=True) for place in places
                ]
            elif shape.kind in ("plate", "wheel"):
                marks = [Stroke(_hull(places), ink, 2.4, closed=True, filled=True)]
            elif shape.kind == "cylinder" and places[0] != places[-1]:
                thick = 10.0 if shape.radius is None else 2.0 * self.scale * shape.radius
                marks = [
                    Stroke(
                        _oblong(places[0], places[-1], thick), ink, 1.6, closed=True, filled=True
                    )
                ]
            else:
                thick = ROD if shape.radius is None else 2.0 * self.scale * shape.radius
                marks = [Stroke(tuple(places), ink, thick, round_ends=True)]
            yield near, marks

    def _drawn_wheels(self) -> list[DrawnWheel]:
        hidden = self.settings.hidden
        rollers = [cam.roller for cam in self._cams if cam.roller is not None]
        wheels = (*self.settings.wheels, *rollers)
        return [one for one in wheels if one.link not in hidden]

    @cached_property
    def _cams(self) -> list[DrawnCam]:
        hidden = self.settings.hidden
        return [cam for cam in drawn_cams(self.mechanism) if cam.link not in hidden]

    def _discs(self) -> Iterator[Item]:
        for cam in self._cams:
            seen = self._placed(cam.link, cam.line)
            places = tuple(self._on_picture(one) for one in seen)
            near = round(float(seen[:, 2].mean()) / self.size, NEAR_DECIMALS)
            yield near, [Stroke(places, self._ink(cam.link), 1.2, closed=True, filled=True)]

    def _wheels(self) -> Iterator[Item]:
        """Wheels and racks of couplings, in the colour of their link; rings are open."""
        for wheel in self._drawn_wheels():
            toothed = wheel.pitch * self.scale >= LEAST_PITCH
            ink = self._ink(wheel.link)
            marks: list[Mark] = []
            for line in wheel_outlines(wheel, toothed):
                places = [self._on_picture(one) for one in self._placed(wheel.link, line)]
                outline = _hull(sorted(places)) if wheel.is_worm else tuple(places)
                marks.append(Stroke(outline, ink, 1.2, closed=True, filled=not wheel.inner))
            height = self._placed(wheel.link, np.array([wheel.on.o]))[0, 2]
            yield round(float(height) / self.size, NEAR_DECIMALS), marks

    def _belts(self) -> Iterator[Mark]:
        for belt in self.settings.belts:
            seen = self._placed(belt.link, belt_line(belt))
            places = tuple(self._on_picture(one) for one in seen)
            yield Stroke(places, self._ink(belt.link), 1.6, closed=True)

    def _cables(self) -> Iterator[Mark]:
        for _, line, rims in self._ropes:
            for rim in rims:
                places = tuple(self._on_picture(one) for one in self.view.seen(rim))
                yield Stroke(places, "k", 1.2, closed=True, filled=True)
            yield Stroke(tuple(self._on_picture(one) for one in self.view.seen(line)), "k", 1.2)

    @cached_property
    def _ropes(self) -> list[tuple[Floats, Floats, list[Floats]]]:
        """The places and the line of each cable, and the rims of its pulleys, in the pose drawn
        (m)."""
        found = []
        for cable in self.settings.cables:
            own = [self.poses[0, self.links.index(at.link)] for at in cable.places]
            places = np.array(
                [carried(pose, at.vector) for pose, at in zip(own, cable.places, strict=True)]
            )
            zero = np.zeros(3)
            axes = np.array(
                [
                    carried(pose, axis) - carried(pose, zero)
                    for pose, axis in zip(own, cable.axes, strict=True)
                ]
            )
            shape = cable.beside, axes, cable.swivels
            rims = [
                centre + abs(beside) * round_about(axis)
                for centre, axis, beside in zip(
                    *cable_pulleys(places, *shape), cable.beside, strict=True
                )
                if beside
            ]
            found.append((places, cable_line(places, *shape), rims))
        return found

    @cached_property
    def _tracks(self) -> list[DrawnTrack]:
        found = (drawn_track(joint) for joint in self.joints)
        hidden = self.settings.hidden
        return [track for track in found if track is not None and track.link not in hidden]

    def _track_marks(self) -> Iterator[Mark]:
        """Walls beside curves, and lines on surfaces, in the colour of their link."""
        for track in self._tracks:
            ink = self._ink(track.link)
            for line in track.lines(SURFACE_LINES):
                places = tuple(self._on_picture(one) for one in self._placed(track.link, line))
                if track.is_surface:
                    yield Stroke(places, f"{ink} t", 0.8)
                else:
                    closed, round_ends = track.closed, not track.closed
                    yield Stroke(places, ink, SLOT, closed=closed, round_ends=round_ends)
                    yield Stroke(places, "p", SLOT - 2.4, closed=closed, round_ends=round_ends)

    def _cylinders(self) -> Iterator[Mark]:
        """Cylinders between two points: a rod, and over most of it a tube."""
        for part in self.settings.between:
            if part.kind == "cylinder":
                foot, eye = (
                    self._on_picture(self._placed(at.link, np.array([at.vector]))[0])
                    for at in part.ends
                )
                yield line(foot, eye, width=2.0)
                along = eye[0] - foot[0], eye[1] - foot[1]
                yield from bar(foot, moved(foot, along, TUBE), THICK, round_ends=False)

    def _symbols(self) -> Iterator[Item]:
        for joint in self.joints:
            first, second = self._half(joint, FIRST), self._half(joint, SECOND)
            place = self._placed(joint.second, np.array([half_frame(joint, SECOND).o]))[0]
            near = round(float(place[2]) / self.size, NEAR_DECIMALS)
            yield near, symbol(joint.type, first, second)

    def _half(self, joint: Joint, side: int) -> Half:
        link = joint.first if side == FIRST else joint.second
        frame = half_frame(joint, side)
        point = np.array(frame.o)
        axes = [point + np.array(axis) for axis in (half_axis(joint, side), frame.x, frame.y)]
        seen = self._placed(link, np.array([point, *axes]))
        along = [(float(a[0] - seen[0, 0]), float(seen[0, 1] - a[1])) for a in seen[1:]]
        return Half(self._on_picture(seen[0]), *along)

    def _feet(self) -> Iterator[Mark]:
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                if link == GROUND_NAME:
                    yield from ground_mark(self._half(joint, side).place)

    def _paths(self) -> Iterator[Mark]:
        for at in self._moving_points():
            path = tuple(self._on_picture(one) for one in self._path(at.link, at.vector))
            if len(path) > 1:
                yield Stroke(path, f"{self._ink(at.link)} t", 1.0)
            yield Disc(path[0], 1.8, is_ink=True)


def _oblong(a: Place, b: Place, width: float) -> tuple[Place, ...]:
    """The corners of what is as wide on both sides of a line."""
    length = ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5
    across = ((a[1] - b[1]) / length, (b[0] - a[0]) / length)
    by = width / 2.0
    return moved(a, across, -by), moved(b, across, -by), moved(b, across, by), moved(a, across, by)


def _hull(places: list[Place]) -> tuple[Place, ...]:
    """The convex hull of sorted places (Andrew's monotone chain), counted from the leftmost."""
    chains: list[list[Place]] = []
    for ordered in (places, places[::-1]):
        chain: list[Place] = []
        for place in ordered:
            while len(chain) > 1 and _turns_right(chain[-2], chain[-1], place):
                chain.pop()
            chain.append(place)
        chains.append(chain)
    return (*chains[0][:-1], *chains[1][:-1])


def _turns_right(a: Place, b: Place, c: Place) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0
