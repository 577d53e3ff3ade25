"""Cams cut for their followers: from a function between two coordinates and a follower to the
profile, its pressure angles and radii of curvature, and the files that a shop takes."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.cams.cam import POINTS as POINTS, Cam as Cam, cam_of as cam_of

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "cam": "Cam POINTS cam_of",
    },
)
