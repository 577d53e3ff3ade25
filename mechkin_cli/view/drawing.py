"""The small picture of a mechanism: its first position with a solution, and its points' paths.

Links are lines, areas, stars, bars or discs in their colours, as `view.shapes` has them; joints are
symbols; a joint on ground stands on a hatched foot. Wheels of couplings have their teeth. Feet,
paths and belts are drawn first, then links, then joints, each from far to near, what is as near in
the order of the file. Numbers have one decimal.

In reading order: the projection, the picture. The projection is isometric: all three axes are
shortened alike, seen from the corner (1, 1, 1). With x', y', z' the axes turned so that z' points
up, a point stands at (y' - x')/sqrt(2) to the right and (2z' - x' - y')/sqrt(6) upwards, and is
(x' + y' + z')/sqrt(3) near. A curved groove or slot has its own curve as walls, a curved surface
lines of its parameters. Of threads, and of teeth that lean or run to an apex, that is drawn which
faces the eye.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from math import copysign, isfinite, sqrt
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import DrawnWheel, ViewSettings
from mechkin_cli.mechanism import (
    FIRST,
    GROUND_NAME,
    SECOND,
    Attached,
    Frame,
    Joint,
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
    drawn_points,
    half_axis,
    half_frame,
    link_poses,
    link_shape,
    stops_of,
)
from mechkin_cli.view.page import FLATNESS, POINTS_APART, thinned
from mechkin_cli.view.symbols import (
    RAIL,
    ROD,
    SHORT,
    THICK,
    Disc,
    Half,
    Mark,
    Place,
    Stroke,
    bar,
    ground_mark,
    line,
    moved,
    slide_stops,
    symbol,
    turn_stops,
)
from mechkin_cli.view.tracks import DrawnTrack, drawn_track
from mechkin_cli.view.wheels import (
    belt_line,
    cable_line,
    cable_pulleys,
    facing_teeth,
    facing_threads,
    is_solid,
    round_about,
    runs_of,
    toothed_faces,
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


PICTURE_NAME = "picture.svg"
"""Of the file beside a mechanism's tables."""

WIDTH, HEIGHT, MARGIN = 200.0, 150.0, 24.0
MOST_PATH_POINTS = 120
TUBE, CUP = 0.6, 0.92
"""Length of a cylinder's tube in parts of that from eye to eye, or of its least where its stroke is
known."""

SPINDLE, NUT = 3.2, 5.5
"""Radius of a spindle, and half the length of a nut, in points."""

LEAST_THREAD, MOST_THREAD, MOST_STARTS = 3.2, 8.0, 4
"""From thread to thread on the picture: finer ones are drawn coarser; coarser ones of a spindle,
which may have any number of starts, with some."""

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
    marks = SmallPicture(result, settings or ViewSettings()).marks()
    size = f'width="{WIDTH:.0f}" height="{HEIGHT:.0f}" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'
    return "\n".join([head, f"<style>{STYLE}</style>", *(m.svg for m in marks), "</svg>", ""])


class SmallPicture:
    """A run's first position on the picture.

    Args:
        result: the run.
        settings: the shapes of its links, and which are hidden.
        marked: points that have to have their place on the picture, too.
    """

    def __init__(
        self, result: Result, settings: ViewSettings, marked: Sequence[Attached] = ()
    ) -> None:
        self._marked = marked
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
        spindles = sorted(self._spindles(), key=itemgetter(0))
        joints = sorted(self._symbols(), key=itemgetter(0))
        return [
            *self._feet(),
            *self._paths(),
            *self._track_marks(),
            *self._belts(),
            *self._cylinders(),
            *self._cables(),
            *(m for _, marks in [*links, *spindles, *joints] for m in marks),
        ]

    def placed(self, link: str, points: Floats, row: int = 0) -> Floats:
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
        parts = [self.placed(link, shape.outline) for link, shape in self._link_shapes()]
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                parts.append(self.placed(link, np.array([half_frame(joint, side).o])))
        parts += [self._path(at.link, at.vector) for at in self.moving_points()]
        parts += [self.placed(cam.link, cam.line) for cam in self._cams]
        parts += [self.placed(track.link, track.line) for track in self._tracks]
        parts += [self.placed(at.link, np.array([at.vector])) for at in self._marked]
        for between in self.settings.between:
            if between.kind == "cylinder":
                parts += [self.placed(at.link, np.array([at.vector])) for at in between.ends]
        for places, _, rims in self._ropes:
            parts += [self.view.seen(each) for each in (places, *rims)]
        for wheel in self._drawn_wheels():
            parts += [self.placed(wheel.link, line) for line in wheel_outlines(wheel, False)]
        parts = [part for part in parts if part.size] or [np.zeros((1, 3))]
        every = np.concatenate(parts)[:, :2]
        low, high = every.min(axis=0), every.max(axis=0)
        room = np.array([WIDTH, HEIGHT]) - 2.0 * MARGIN
        self.scale = float(np.min(room / np.maximum(high - low, POINTS_APART * self.size)))
        self.middle = (low + high) / 2.0

    def on_picture(self, seen: Floats) -> Place:
        """Where what is seen stands."""
        x, y = self.scale * (seen[:2] - self.middle)
        # the feet below the joints need some room, too
        return WIDTH / 2.0 + float(x), HEIGHT / 2.0 - 4.0 - float(y)

    def _all_on_picture(self, seen: Sequence[Floats] | Floats) -> tuple[Place, ...]:
        return tuple(self.on_picture(one) for one in seen)

    def _link_shapes(self) -> Iterator[tuple[str, Shape]]:
        shapes = self.settings.shapes
        # ground is seen by its feet, unless it has a shape of its own
        shown = [link for link in self.links if link != GROUND_NAME or link in shapes]
        return (
            (link, link_shape(self.mechanism, link, self.size, shapes.get(link)))
            for link in shown
            if link not in self.settings.hidden
        )

    def moving_points(self) -> Iterator[Attached]:
        """The named points of links that move."""
        return (at for at in self.mechanism.points.values() if at.link in self.links[1:])

    def _ink(self, link: str) -> str:
        return "k" if link == GROUND_NAME else f"l{(self.links.index(link) - 1) % len(COLOURS)}"

    def _shapes(self) -> Iterator[Item]:
        for link, shape in self._link_shapes():
            if shape.kind == "none":
                continue
            seen, ink = self.placed(link, shape.outline), self._ink(link)
            places = sorted(self.on_picture(one) for one in seen)
            near = round(float(seen[:, 2].sum()) / len(seen) / self.size, NEAR_DECIMALS)
            if shape.centre is not None:
                centre = self.on_picture(self.placed(link, shape.centre[None])[0])
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
            seen = self.placed(cam.link, cam.line)
            places = tuple(self.on_picture(one) for one in seen)
            near = round(float(seen[:, 2].mean()) / self.size, NEAR_DECIMALS)
            yield near, [Stroke(places, self._ink(cam.link), 1.2, closed=True, filled=True)]

    def _wheels(self) -> Iterator[Item]:
        """Wheels and racks of couplings, in the colour of their link; rings are open."""
        for wheel in self._drawn_wheels():
            toothed = wheel.pitch * self.scale >= LEAST_PITCH
            ink = self._ink(wheel.link)
            marks: list[Mark] = []
            if toothed and is_solid(wheel):
                marks += self._aslant(wheel)
            else:
                for outline in wheel_outlines(wheel, toothed):
                    places = self._all_on_picture(self.placed(wheel.link, outline))
                    edge = _hull(sorted(places)) if wheel.is_worm else places
                    marks.append(Stroke(edge, ink, 1.2, closed=True, filled=not wheel.inner))
            if wheel.is_worm:
                lead, half = 2.0 * np.pi * wheel.radius / wheel.lean, 0.5 * wheel.width
                marks += self._thread(
                    wheel.link, wheel.on, wheel.radius, lead, wheel.teeth, (-half, half)
                )
            height = self.placed(wheel.link, np.array([wheel.on.o]))[0, 2]
            yield round(float(height) / self.size, NEAR_DECIMALS), marks

    def _aslant(self, wheel: DrawnWheel) -> Iterator[Mark]:
        """The tips of teeth that face the eye, from their far ends on, and before them the face
        that does."""
        low, high = (self.placed(wheel.link, face) for face in toothed_faces(wheel))
        _, axes = self._seen_frame(wheel.link, wheel.on)
        front, back = (high, low) if axes[2, 2] > 0.0 else (low, high)
        ink = self._ink(wheel.link)
        facing = facing_teeth(wheel, axes)
        for run in runs_of(facing):
            far = back.reshape(-1, 4, 3)[run].reshape(-1, 3)
            yield Stroke(self._all_on_picture(far), ink, 0.8, closed=bool(facing.all()))
        for tooth in np.flatnonzero(facing):
            k = 4 * int(tooth) + 1
            corners = self._all_on_picture([front[k], front[k + 1], back[k + 1], back[k]])
            yield Stroke(corners, ink, 0.8, closed=True, filled=True)
        yield Stroke(self._all_on_picture(front), ink, 1.2, closed=True, filled=True)

    def _seen_frame(self, link: str, frame: Frame) -> tuple[Floats, Floats]:
        """Origin (3,) and axes (3, 3) of a frame as drawn on a link, as they are seen."""
        origin = np.array(frame.o)
        axes = [origin + np.array(axis) for axis in (frame.x, frame.y, frame.z)]
        seen = self.placed(link, np.array([origin, *axes]))
        return seen[0], seen[1:] - seen[0]

    def _thread(
        self,
        link: str,
        on: Frame,
        radius: float,
        lead: float,
        starts: int,
        ends: tuple[float, float],
    ) -> Iterator[Mark]:
        """A thread of some `starts`, of 0 of so many as are seen well; of one so fine that its
        lines would run together a coarser one."""
        origin, axes = self._seen_frame(link, on)
        apart = self.scale * float(np.hypot(*axes[2, :2]))
        starts = starts or int(min(max(abs(lead) * apart / MOST_THREAD, 1.0), MOST_STARTS))
        if abs(lead) * apart < LEAST_THREAD * starts:
            lead, starts = copysign(LEAST_THREAD / apart, lead), 1
        for turn in facing_threads(origin, axes, radius, lead, starts, ends):
            yield Stroke(self._all_on_picture(turn), self._ink(link), 0.9)

    def _spindles(self) -> Iterator[Item]:
        """Spindles of screws, from their bearing on, and of H joints, with their thread as far as
        their nut; and nuts of screws."""
        hidden = self.settings.hidden
        screws = [
            (each.link, each.on, each.lead, each.bearing, (each.nut_link, each.nut))
            for each in self.settings.screws
        ]
        threaded = [joint for joint in self.joints if joint.type.is_threaded]
        screws += [
            (one.first, one.on_first, one.lead, 0.0, (one.second, one.on_second))
            for one in threaded
        ]
        for number, (link, on, lead, bearing, nut) in enumerate(screws):
            origin, axes = self._seen_frame(link, on)
            if link in hidden or np.hypot(*axes[2, :2]) < SHORT:
                continue
            middle, along = self._seen_frame(*nut)
            ways = bearing, float((middle - origin) @ axes[2])
            beyond = 2.0 * RAIL / self.scale
            ends = min(ways) - beyond, max(ways) + beyond
            a, b = (self.on_picture(origin + end * axes[2]) for end in ends)
            marks = bar(a, b, 2.0 * SPINDLE + 1.0, ink=self._ink(link), edge=1.0)
            if lead:
                marks += self._thread(link, on, SPINDLE / self.scale, lead, 0, ends)
            if number < len(self.settings.screws) and nut[0] not in hidden:
                by = NUT / self.scale * along[2]
                c, d = self.on_picture(middle - by), self.on_picture(middle + by)
                marks += bar(c, d, 15.0, ink=self._ink(nut[0]))
            yield round(float(origin[2]) / self.size, NEAR_DECIMALS), marks

    def _belts(self) -> Iterator[Mark]:
        for belt in self.settings.belts:
            seen = self.placed(belt.link, belt_line(belt))
            places = tuple(self.on_picture(one) for one in seen)
            yield Stroke(places, self._ink(belt.link), 1.6, closed=True)

    def _cables(self) -> Iterator[Mark]:
        for _, rope, rims in self._ropes:
            for rim in rims:
                places = tuple(self.on_picture(one) for one in self.view.seen(rim))
                yield Stroke(places, "k", 1.2, closed=True, filled=True)
            yield Stroke(tuple(self.on_picture(one) for one in self.view.seen(rope)), "k", 1.2)

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
            for course in track.lines(SURFACE_LINES):
                places = self._all_on_picture(self.placed(track.link, course))
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
                    self.on_picture(self.placed(at.link, np.array([at.vector]))[0])
                    for at in part.ends
                )
                yield line(foot, eye, width=2.0)
                along = eye[0] - foot[0], eye[1] - foot[1]
                share = TUBE
                if part.stroke is not None:
                    ends = [self.placed(at.link, np.array([at.vector]))[0] for at in part.ends]
                    length = float(np.linalg.norm(ends[1] - ends[0]))
                    share = min(CUP * part.stroke[0] / length, 1.0) if length else TUBE
                yield from bar(foot, moved(foot, along, share), THICK, round_ends=False)

    def _symbols(self) -> Iterator[Item]:
        for joint in self.joints:
            first, second = self._half(joint, FIRST), self._half(joint, SECOND)
            place = self.placed(joint.second, np.array([half_frame(joint, SECOND).o]))[0]
            near = round(float(place[2]) / self.size, NEAR_DECIMALS)
            yield near, [*self._stops(joint, first, second), *symbol(joint.type, first, second)]

    def _stops(self, joint: Joint, first: Half, second: Half) -> Iterator[Mark]:
        """Where `limits:` end the turn of a pin, or a slide on a rail where that is on the
        picture."""
        kind = joint.type
        if kind.is_carried or kind.is_ball or kind.is_oriented or kind.has_slip:
            return
        stops = stops_of(self.result.problem, joint)
        if "slide" in stops and sum(kind.slides) <= 1:
            low, high = (
                end if self._is_on(moved(first.place, first.axis, end)) else None
                for end in (self.scale * each for each in stops["slide"])
            )
            yield from slide_stops(first, second, (low, high))
        if "turn" in stops and not any(kind.slides):
            frame, place = joint.on_second, np.array(joint.on_second.o)
            off = np.mean(drawn_points(self.mechanism, joint.second), axis=0) - place
            hand = float(np.arctan2(off @ np.array(frame.y), off @ np.array(frame.x)))
            low, high = (end + hand if isfinite(end) else None for end in stops["turn"])
            yield from turn_stops(first, second, (low, high))

    @staticmethod
    def _is_on(place: Place) -> bool:
        edge = MARGIN / 3.0
        return edge < place[0] < WIDTH - edge and edge < place[1] < HEIGHT - edge

    def _half(self, joint: Joint, side: int) -> Half:
        link = joint.first if side == FIRST else joint.second
        frame = half_frame(joint, side)
        point = np.array(frame.o)
        axes = [point + np.array(axis) for axis in (half_axis(joint, side), frame.x, frame.y)]
        seen = self.placed(link, np.array([point, *axes]))
        along = [(float(a[0] - seen[0, 0]), float(seen[0, 1] - a[1])) for a in seen[1:]]
        return Half(self.on_picture(seen[0]), *along)

    def _feet(self) -> Iterator[Mark]:
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                if link == GROUND_NAME:
                    yield from ground_mark(self._half(joint, side).place)

    def _paths(self) -> Iterator[Mark]:
        for at in self.moving_points():
            path = tuple(self.on_picture(one) for one in self._path(at.link, at.vector))
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
