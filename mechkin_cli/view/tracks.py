"""Curves and surfaces of joints as they are drawn: places along them, on the joint's second link.

A curve is drawn from end to end; of a surface that has no end, what the drawing has near it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import Joint
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

STEPS = 96
"""Of a curve from end to end."""

CELLS = 40
"""Of a surface along each parameter."""

NEAR = 0.1
"""Of what has no end, to both sides of the place as drawn, in parts of its range."""


class DrawnTrack(NamedTuple):
    """Places (m) in the home drawing of a joint's second link: of a curve (n, 3), `closed` (last to
    first) or not; of a surface (n, m, 3) by u and v."""

    link: str
    places: Floats
    closed: bool

    @property
    def is_surface(self) -> bool:
        """Whether it has two parameters."""
        return self.places.ndim == 3

    @property
    def line(self) -> Floats:
        """All places (n, 3)."""
        return self.places.reshape(-1, 3)

    def lines(self, every: int) -> list[Floats]:
        """The curve, or lines of the surface along u and along v, one in `every`."""
        if not self.is_surface:
            return [self.places]
        across = self.places.swapaxes(0, 1)
        return [*self.places[::every], *across[::every]]


def drawn_track(joint: Joint) -> DrawnTrack | None:
    """The curve or surface of a joint; None of one that has none."""
    part = next((part for part in joint.parts if part.track is not None), None)
    if part is None or part.track is None:
        return None
    track = part.track
    is_curve = len(track.ends) == 1
    parameters = []
    for name, (low, high), here in zip(track.names, track.ends, part.at, strict=True):
        first, last = low, high
        if name in track.endless:
            by = NEAR * (high - low)
            first, last = max(low, float(here) - by), min(high, float(here) + by)
        parameters.append(np.linspace(first, last, (STEPS if is_curve else CELLS) + 1))
    grid = np.meshgrid(*parameters, indexing="ij")
    found = np.stack(track.places_at(np.array([one.ravel() for one in grid])), axis=1)
    closed = is_curve and track.closed[0]
    places = found[:-1] if closed else found
    return DrawnTrack(
        joint.second, places.reshape((-1, 3) if is_curve else (*grid[0].shape, 3)), closed
    )
