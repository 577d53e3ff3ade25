"""The picture of modes of vibration: a panel for each, with the mechanism where it vibrates about,
and arrows along which its points, joints, ends of springs and mass centres move, the longest one of
the same length in each panel."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from html import escape
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import ViewSettings
from mechkin_cli.mechanism import GROUND_NAME, Attached, is_written
from mechkin_cli.record import NamedTuple
from mechkin_cli.view.drawing import HEIGHT, STYLE, WIDTH, SmallPicture
from mechkin_cli.view.symbols import Mark, Place, Stroke, line, moved

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Mechanism
    from mechkin_cli.sweep import Result

COLUMNS = 3
"""Panels beside each other."""

TITLE = 20.0
"""Height of a panel's title, points."""

LONGEST, LEAST, HEAD = 26.0, 2.0, 5.0
"""Points: the longest arrow of a panel, the shortest that is drawn, and the largest head."""

_STYLE = (
    ".v{stroke:#cf222e}.v.a{fill:#cf222e;fill-opacity:1}text{font:12px sans-serif;fill:#24292f}"
    "@media(prefers-color-scheme:dark){.v{stroke:#ff7b72}.v.a{fill:#ff7b72}text{fill:#e6edf3}}"
)


class ShownMode(NamedTuple):
    """A mode: its title, and two rows, the place itself and one a little beside it along the
    mode."""

    title: str
    rows: Result


def mode_picture(modes: Sequence[ShownMode], settings: ViewSettings | None = None) -> str:
    """The picture of some modes as one SVG file with a newline at its end; `settings`: the shapes
    of links, and which are hidden."""
    settings = settings or ViewSettings()
    columns = min(COLUMNS, max(len(modes), 1))
    lines = -(-len(modes) // columns)
    width, height = columns * WIDTH, lines * (HEIGHT + TITLE)
    size = f'width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.0f} {height:.0f}"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size}>',
        f"<style>{STYLE}{_STYLE}</style>",
    ]
    for number, mode in enumerate(modes):
        x, y = number % columns * WIDTH, number // columns * (HEIGHT + TITLE)
        shown = _shown_points(mode.rows.problem.mechanism, settings.hidden)
        picture = SmallPicture(mode.rows, settings, shown)
        parts += [
            f'<g transform="translate({x:.0f} {y:.0f})">',
            f'<text x="{WIDTH / 2.0:.0f}" y="14" text-anchor="middle">{escape(mode.title)}</text>',
            f'<g transform="translate(0 {TITLE:.0f})">',
            *(mark.svg for mark in (*picture.marks(), *_arrows(picture, shown))),
            "</g></g>",
        ]
    return "\n".join([*parts, "</svg>", ""])


def _arrows(picture: SmallPicture, shown: Sequence[Attached]) -> Iterator[Mark]:
    """Along which what moves does, each once."""
    ways: dict[Place, Place] = {}
    for at in shown:
        points = np.array([at.vector])
        begin, end = (picture.placed(at.link, points, row)[0] for row in (0, 1))
        way = picture.scale * (end - begin)
        ways.setdefault(picture.on_picture(begin), (float(way[0]), -float(way[1])))
    longest = max((hypot(*way) for way in ways.values()), default=0.0)
    if not longest > 0.0:
        return
    for place, way in ways.items():
        by = way[0] * (LONGEST / longest), way[1] * (LONGEST / longest)
        length = hypot(*by)
        if length < LEAST:
            continue
        along = by[0] / length, by[1] / length
        aside = -along[1], along[0]
        tip, head = moved(place, along, length), min(HEAD, 0.6 * length)
        neck = moved(tip, along, -head)
        yield line(place, neck, "v", 1.6)
        corners = (moved(neck, aside, 0.5 * head), tip, moved(neck, aside, -0.5 * head))
        yield Stroke(corners, "v", 0.8, closed=True, filled=True)


def _shown_points(mechanism: Mechanism, hidden: Collection[str]) -> list[Attached]:
    """Points of links that move and are shown: those with a name, joints, ends of springs,
    dampers and bushings, and mass centres."""
    found = [*mechanism.points.values(), *(at for _, at in mechanism.joint_points())]
    found += [at for load in mechanism.loads for at in load.fastened_at]
    found += [
        Attached(name, link.center_of_mass) for name, link in mechanism.links.items() if link.mass
    ]
    return [
        at
        for at in found
        if at.link != GROUND_NAME and is_written(at.link) and at.link not in hidden
    ]
