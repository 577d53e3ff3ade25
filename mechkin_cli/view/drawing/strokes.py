"""What drawings are made of: lines, areas and discs, in points of the picture, as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

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
        way = f"M{_place(first)}" + "".join(f"L{_place(place)}" for place in rest)
        ends = ' stroke-linecap="round"' if self.round_ends else ""
        inside = f' class="{self.ink} a"' if self.filled else f' class="{self.ink}"'
        return f'<path{inside} stroke-width="{self.width:.1f}"{ends} d="{way}{"Z" * self.closed}"/>'


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
