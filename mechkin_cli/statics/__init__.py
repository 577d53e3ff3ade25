"""Where loads balance: generalised forces of free mechanisms, and how they change about a place."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.statics.forces import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "forces": "Derivative DrivenAt Forces ForcesAt FreePlace differentiated summed",
    },
)
