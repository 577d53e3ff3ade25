"""The page of `mechkin view`: the mechanism as drawn, its poses, curves, tables and notes.

Lengths and angles are in the file's units; a link's pose is its displacement from the drawing.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.view.branch import run_marks as run_marks
    from mechkin_cli.view.drawing import (
        PICTURE_NAME as PICTURE_NAME,
        mechanism_picture as mechanism_picture,
    )
    from mechkin_cli.view.page import PAGE_NAME as PAGE_NAME
    from mechkin_cli.view.scene import view_page as view_page, write_view as write_view

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "branch": "run_marks",
        "drawing": "PICTURE_NAME mechanism_picture",
        "page": "PAGE_NAME",
        "scene": "view_page write_view",
    },
)
