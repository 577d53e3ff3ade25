"""The small picture of a mechanism: its first position with a solution, and the ways of its points.

Links are lines, areas or stars in their colours, as `view.shapes` has them; joints are symbols; a
joint on ground stands on a hatched foot. Feet and ways are drawn first, then links, then joints,
each from far to near, what is as near in the order of the file. Numbers have one decimal.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.mechanism.joint_type import FIRST, SECOND
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, diagonal, is_written
from mechkin_cli.view.drawing.isometric import isometric
from mechkin_cli.view.drawing.strokes import Disc, Mark, Place, Stroke
from mechkin_cli.view.drawing.symbols import Half, ground_mark, symbol
from mechkin_cli.view.joints import drawn_joints, half_axis, half_frame
from mechkin_cli.view.limits import POINTS_APART
from mechkin_cli.view.poses import HOME, carried, link_poses
from mechkin_cli.view.shapes import link_shape
from mechkin_cli.view.thinning import thinned

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.arrays import Floats

NAME = "picture.svg"
"""Of the file beside a mechanism's tables."""

WIDTH, HEIGHT, MARGIN = 200.0, 150.0, 24.0
MOST_PATH_POINTS = 120

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


class _Item(NamedTuple):
    """What is drawn at once, and how near it is."""

    near: float
    marks: list[Mark]


def mechanism_picture(result: Result) -> str:
    """The picture of a run as one SVG file with a newline at its end."""
    scene = _Scene(result)
    marks = [mark for item in scene.items() for mark in item.marks]
    size = f'width="{WIDTH:.0f}" height="{HEIGHT:.0f}" viewBox="0 0 {WIDTH:.0f} {HEIGHT:.0f}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'
    return "\n".join([head, f"<style>{STYLE}</style>", *(m.svg for m in marks), "</svg>", ""])


class _Scene:
    """A run's first position on the picture."""

    def __init__(self, result: Result) -> None:
        self.result = result
        self.mechanism = result.problem.mechanism
        self.links = [GROUND_NAME, *filter(is_written, self._moving())]
        poses = link_poses(result, self.links)
        solved = np.flatnonzero(result.solved)
        home = np.tile(np.array(HOME), (1, len(self.links), 1))
        self.poses = poses[solved] if solved.size else home
        self.view = isometric(self.mechanism)
        self.joints = drawn_joints(self.mechanism)
        self.size = diagonal([at.vector for _, at in self.mechanism.joint_points()]) or 1.0
        self._fit()

    def items(self) -> list[_Item]:
        """Everything from back to front."""
        links, joints = (
            sorted(found, key=lambda item: item.near) for found in (self._shapes(), self._symbols())
        )
        return [*self._feet(), *self._paths(), *links, *joints]

    def _moving(self) -> list[str]:
        return [name for name in self.mechanism.links if name != GROUND_NAME]

    def _placed(self, link: str, points: Floats, row: int = 0) -> Floats:
        """Points as drawn on a link (points, 3) as they are seen: right, up, near."""
        pose = self.poses[row, self.links.index(link)]
        return np.array([self.view.seen(carried(pose, tuple(point))) for point in points])

    def _way(self, link: str, point: Sequence[float]) -> Floats:
        """A point of a link over the rows, as it is seen."""
        rows = thinned(range(len(self.poses)), MOST_PATH_POINTS)
        x, y, z = point
        return self.view.seen(carried(self.poses[rows, self.links.index(link)], (x, y, z)))

    def _fit(self) -> None:
        """Where the middle of all that is drawn is, and points per length."""
        parts = [self._placed(link, shape.points) for link, shape in self._link_shapes()]
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                parts.append(self._placed(link, np.array([half_frame(joint, side).o])))
        parts += [self._way(at.link, at.vector) for _, at in self._named()]
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

    def _link_shapes(self) -> Iterator[tuple[str, Any]]:
        for link in self.links[1:]:
            yield link, link_shape(self.mechanism, link, self.size)

    def _named(self) -> Iterator[tuple[str, Any]]:
        for name, at in self.mechanism.points.items():
            if at.link in self.links[1:]:
                yield name, at

    def _ink(self, link: str) -> str:
        return f"l{(self.links.index(link) - 1) % len(COLOURS)}"

    def _shapes(self) -> Iterator[_Item]:
        for link, shape in self._link_shapes():
            if shape.kind == "none":
                continue
            seen, ink = self._placed(link, shape.points), self._ink(link)
            places = sorted(self._on_picture(one) for one in seen)
            near = _rounded(float(seen[:, 2].sum()) / len(seen) / self.size)
            if shape.kind == "star":
                centre = self._on_picture(self._placed(link, shape.centre[None])[0])
                marks: list[Mark] = [_rod((centre, place), ink) for place in places]
            elif shape.kind == "plate":
                marks = [Stroke(_hull(places), ink, 2.4, closed=True, filled=True)]
            else:
                marks = [_rod(tuple(places), ink)]
            yield _Item(near, marks)

    def _symbols(self) -> Iterator[_Item]:
        for joint in self.joints:
            first, second = self._half(joint, FIRST), self._half(joint, SECOND)
            place = self._placed(joint.second, np.array([half_frame(joint, SECOND).o]))[0]
            near = _rounded(float(place[2]) / self.size)
            yield _Item(near, symbol(joint.type, first, second))

    def _half(self, joint: Joint, side: int) -> Half:
        link = joint.first if side == FIRST else joint.second
        frame = half_frame(joint, side)
        point = np.array(frame.o)
        axes = [point + np.array(axis) for axis in (half_axis(joint, side), frame.x, frame.y)]
        seen = self._placed(link, np.array([point, *axes]))
        along = [(float(a[0] - seen[0, 0]), float(seen[0, 1] - a[1])) for a in seen[1:]]
        return Half(self._on_picture(seen[0]), *along)

    def _feet(self) -> Iterator[_Item]:
        for joint in self.joints:
            for side, link in ((FIRST, joint.first), (SECOND, joint.second)):
                if link == GROUND_NAME:
                    yield _Item(0.0, ground_mark(self._half(joint, side).place))

    def _paths(self) -> Iterator[_Item]:
        for _, at in self._named():
            way = tuple(self._on_picture(one) for one in self._way(at.link, at.vector))
            ink = self._ink(at.link)
            marks: list[Mark] = [Stroke(way, f"{ink} t", 1.0)] if len(way) > 1 else []
            yield _Item(0.0, [*marks, Disc(way[0], 1.8, is_ink=True)])


def _rod(places: tuple[Place, ...], ink: str) -> Stroke:
    return Stroke(places, ink, 3.2, round_ends=True)


def _rounded(near: float) -> float:
    """What is as near but for rounding is as near."""
    return round(near, 6)


def _hull(places: list[Place]) -> tuple[Place, ...]:
    """The convex hull of sorted places (Andrew's monotone chain), counted from the leftmost."""
    chains: list[list[Place]] = []
    for way in (places, places[::-1]):
        chain: list[Place] = []
        for place in way:
            while len(chain) > 1 and _turns_right(chain[-2], chain[-1], place):
                chain.pop()
            chain.append(place)
        chains.append(chain)
    return (*chains[0][:-1], *chains[1][:-1])


def _turns_right(a: Place, b: Place, c: Place) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0
