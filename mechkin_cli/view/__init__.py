"""The page of `mechkin view`: the mechanism as drawn, its poses, curves, tables and notes.

Lengths and angles are in the file's units; a link's pose is its displacement from the drawing.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.view.branch import *
    from mechkin_cli.view.drawing import *
    from mechkin_cli.view.following import *
    from mechkin_cli.view.gallery import *
    from mechkin_cli.view.joints import *
    from mechkin_cli.view.mode_shapes import *
    from mechkin_cli.view.notebook import *
    from mechkin_cli.view.page import *
    from mechkin_cli.view.scene import *
    from mechkin_cli.view.server import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "branch": "run_marks",
        "drawing": "PICTURE_NAME mechanism_picture",
        "following": "Changed Follower Seen Wish",
        "gallery": "INDEX_NAME Card card_of index_page",
        "joints": "carried continuous drawn_joints half_axis half_frame link_poses link_shape "
        "plane_of_motion upwards",
        "mode_shapes": "ShownMode mode_picture",
        "notebook": "Page widget_of",
        "page": "PAGE_NAME Lengths packed",
        "scene": "view_page write_view",
        "server": "LiveServer",
    },
)
