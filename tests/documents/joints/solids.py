"""Solids in two shades, seen isometrically, as elements of SVG with one decimal.

A picture is painted in the order in which its parts are drawn: what is nearer comes later. Points
are (x, y, z) with z up; x comes towards the viewer to the left, y to the right.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, pi, sin
from typing import Final

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.view.drawing import Isometric
from mechkin_cli.view.symbols import Place, number

Point = tuple[float, float, float]
Vectors = NDArray[np.float64]

WIDTH, HEIGHT, SCALE = 150, 120, 20.0
ROUND: Final = 40
"""Corners of a circle."""
_VIEW: Final = Isometric()

STYLE = (
    "path,circle{stroke:#24292f;stroke-width:.8;stroke-linejoin:round}"
    ".a0{fill:#a5cdf7}.a1{fill:#5b9fe3}.a2{fill:#2f74bd}"
    ".b0{fill:#ffd9a8}.b1{fill:#f2a654}.b2{fill:#c5761d}"
    ".c0{fill:#e3e6e8}.c1{fill:#b4bac0}.c2{fill:#82898f}"
    ".n{fill:none;stroke:#24292f}.x{fill:none;stroke:#57606a;stroke-dasharray:7 2 1.5 2}"
    ".v{fill:none;stroke:#cf222e;stroke-width:1.5}.h{fill:#cf222e;stroke:none}"
    "text{font:italic 11px sans-serif;fill:#cf222e}"
    "@media(prefers-color-scheme:dark){.x{stroke:#8b949e}.v{stroke:#ff7b72}.h{fill:#ff7b72}"
    "text{fill:#ff7b72}}"
)
"""a: the first link, b: the second, c: what belongs to neither; 0 is lit, 2 in the shade."""


class Drawing:
    """What has been painted so far; `centre` is the point in the middle of the picture."""

    def __init__(self, centre: Point = (0.0, 0.0, 0.0)) -> None:
        self.parts: list[str] = []
        self.middle = _VIEW.seen(np.array(centre))

    def svg(self, name: str) -> str:
        """The whole file."""
        size = f'width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'
        title = f"<title>{name}</title>"
        return "\n".join([head, title, f"<style>{STYLE}</style>", *self.parts, "</svg>", ""])

    def at(self, point: Sequence[float]) -> Place:
        """A point on the picture."""
        x, y, _ = _VIEW.seen(np.array(point, dtype=float)) - self.middle
        return WIDTH / 2 + SCALE * float(x), HEIGHT / 2 - SCALE * float(y)

    def path(self, points: Iterable[Sequence[float]], ink: str, *, closed: bool = True) -> None:
        """An area, or a line."""
        self._flat([self.at(point) for point in points], ink, closed=closed)

    def box(self, low: Point, high: Point, ink: str) -> None:
        """A block along the axes: its three faces that are seen."""
        (a, b, c), (x, y, z) = low, high
        self.path([(x, b, c), (x, y, c), (x, y, z), (x, b, z)], f"{ink}2")
        self.path([(a, y, c), (x, y, c), (x, y, z), (a, y, z)], f"{ink}1")
        self.path([(a, b, z), (x, b, z), (x, y, z), (a, y, z)], f"{ink}0")

    def cylinder(self, a: Point, b: Point, radius: float, ink: str, corners: int = ROUND) -> None:
        """Along an axis from its far end to its near one, which is seen; with six corners a nut."""
        ends = [ring(end, np.subtract(b, a), radius, corners) for end in (a, b)]
        if corners == ROUND:
            hull = _hull([self.at(point) for end in ends for point in end])
            self._flat(hull, f"{ink}1")
        else:
            for k in range(corners):
                sides = [ends[0][k], ends[0][k - 1], ends[1][k - 1], ends[1][k]]
                if _area([self.at(p) for p in sides]) > 0.0:
                    self.path(sides, f"{ink}{1 + k % 2}")
        self.path(ends[1], f"{ink}0")

    def ball(self, centre: Point, radius: float, ink: str) -> None:
        """A ball with a light on it."""
        x, y = self.at(centre)
        r = SCALE * radius
        self._circle(x, y, r, f"{ink}1")
        self.parts.append(
            f'<circle class="{ink}0" style="stroke:none" cx="{number(x - 0.3 * r)}" '
            f'cy="{number(y - 0.35 * r)}" r="{number(0.35 * r)}"/>'
        )

    def bowl_behind(self, centre: Point, radius: float, ink: str) -> None:
        """The inside of a half ball that is open upwards."""
        self.path(ring(centre, np.array([0.0, 0, 1]), radius), f"{ink}2")

    def bowl_before(self, centre: Point, inner: float, outer: float, ink: str) -> None:
        """Its wall towards the viewer, and the edge on it."""
        x, y = self.at(centre)
        r, flat = SCALE * outer, 1.0 / 3.0**0.5
        turns = [pi * k / 20 for k in range(21)]
        edge = [(x + r * cos(t), y + flat * r * sin(t)) for t in turns]
        below = [(x + r * cos(t), y + r * sin(t)) for t in reversed(turns)]
        self._flat([*edge, *below], f"{ink}1")
        rim = [(x + SCALE * inner * cos(t), y + flat * SCALE * inner * sin(t)) for t in turns]
        self._flat([*edge, *reversed(rim)], f"{ink}0")

    def axis(self, a: Point, b: Point) -> None:
        """A line of dashes and dots."""
        self.path([a, b], "x", closed=False)

    def arrow(self, a: Point, b: Point, label: str, *, beyond: float = 0.7) -> None:
        """A sense along a line."""
        self._pointed([self.at(a), self.at(b)])
        at = np.array(b) + beyond * (np.array(b) - a) / np.linalg.norm(np.subtract(b, a))
        self._label(self.at(at), label)

    def turn(
        self,
        centre: Point,
        axis: Point,
        radius: float,
        label: str,
        *,
        start: float = 0.0,
        through: float = 4.2,
        shift: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """A sense about an axis, right-handed."""
        angles = np.linspace(start, start + through, 24)
        places = [self.at(p) for p in _on_ring(centre, np.array(axis, float), radius, angles)]
        self._pointed(places)
        x, y = places[0]
        self._label((x + shift[0], y + shift[1]), label)

    def _pointed(self, places: list[Place]) -> None:
        self._flat(places, "v", closed=False)
        (x, y), (a, b) = places[-1], places[-2]
        length = ((x - a) ** 2 + (y - b) ** 2) ** 0.5
        u, v = (x - a) / length, (y - b) / length
        tip = (x + 5 * u, y + 5 * v)
        self._flat([tip, (x - 3 * v, y + 3 * u), (x + 3 * v, y - 3 * u)], "h")

    def _label(self, place: Place, label: str) -> None:
        x, y = place
        self.parts.append(
            f'<text x="{number(x)}" y="{number(y + 4)}" text-anchor="middle">{label}</text>'
        )

    def _circle(self, x: float, y: float, r: float, ink: str) -> None:
        self.parts.append(
            f'<circle class="{ink}" cx="{number(x)}" cy="{number(y)}" r="{number(r)}"/>'
        )

    def _flat(self, places: Sequence[Place], ink: str, *, closed: bool = True) -> None:
        way = "L".join(f"{number(x)} {number(y)}" for x, y in places)
        self.parts.append(f'<path class="{ink}" d="M{way}{"Z" * closed}"/>')


def ring(centre: Sequence[float], axis: Vectors, radius: float, corners: int = ROUND) -> Vectors:
    """A circle about an axis, as points."""
    return _on_ring(centre, axis, radius, 2.0 * pi * np.arange(corners) / corners)


def _on_ring(centre: Sequence[float], axis: Vectors, radius: float, angles: Vectors) -> Vectors:
    """Points that turn right-handed about the axis; angle 0 is up, or along x about z."""
    z = axis / np.linalg.norm(axis)
    up = np.array([1.0, 0, 0]) if abs(z[2]) > 0.9 else np.array([0.0, 0, 1])
    x = up - np.dot(up, z) * z
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    return np.asarray(centre) + radius * (np.outer(np.cos(angles), x) + np.outer(np.sin(angles), y))


def _hull(places: list[Place]) -> list[Place]:
    chains: list[list[Place]] = []
    for way in (sorted(places), sorted(places)[::-1]):
        chain: list[Place] = []
        for place in way:
            while len(chain) > 1 and _area([chain[-2], chain[-1], place]) <= 1e-9:
                chain.pop()
            chain.append(place)
        chains.append(chain[:-1])
    return chains[0] + chains[1]


def _area(places: Sequence[Place]) -> float:
    (a, b), (c, d), (e, f), *_ = places
    return (c - a) * (f - b) - (d - b) * (e - a)
