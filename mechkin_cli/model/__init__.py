"""`load`, `Model` and `Analysis`: mechkin for Python programs. The commands call nothing else."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.model.model import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "model": "Model load loads",
    },
)
