"""Curves of a run, as plain data and drawn."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.plots.answers import *
    from mechkin_cli.plots.bands import *
    from mechkin_cli.plots.curves import *
    from mechkin_cli.plots.thinned import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "answers": "answer_image",
        "bands": "Band Bands",
        "curves": "Drawing Picture PlotCurve drawing drawn format_of image picture table_drawing",
        "thinned": "thinned_picture",
    },
)
