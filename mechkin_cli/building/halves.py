"""A pair as drawn on its two links."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.mechanism.frames import Frame, frame_about
from mechkin_cli.mechanism.joint_type import Drawn
from mechkin_cli.mechanism.vectors import Vector, scale


class Halves(NamedTuple):
    """The pair's frames on either link.

    `meeting`: frames, one on either drawing, that coincide where the coordinates are zero, of the
    part that leads from one drawing to the other; `own`: a frame beside them.
    """

    on_first: Frame
    on_second: Frame
    meeting: tuple[Frame, Frame]
    own: Frame | None = None

    def along(self, direction: Drawn) -> Frame:
        """The frame of a part that is drawn on one link, z along the direction."""
        frame = (self.on_first, self.on_second)[direction.side]
        if direction.axis == "own":
            assert self.own is not None
            return self.own
        if direction.axis == "z" and not direction.reverse:
            return frame
        along: Vector = getattr(frame, direction.axis)
        across = frame.x if direction.axis == "z" else frame.z
        return frame_about(scale(-1.0, along) if direction.reverse else along, across, frame.o)
