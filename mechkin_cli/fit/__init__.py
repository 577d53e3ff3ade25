"""Dimensions that fit: parameters sought so that quantities follow what is asked."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.fit.result import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "result": "Fit fit_of",
    },
)
