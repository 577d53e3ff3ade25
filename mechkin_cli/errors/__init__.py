"""True errors: the rows repeated in double-double, and how far the doubles were off."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.errors.errors import *
    from mechkin_cli.errors.rows import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "errors": "Errors repetition true_values",
        "rows": "KernelRows NotRepeated Repeated WORDS reason_of wide_run",
    },
)
