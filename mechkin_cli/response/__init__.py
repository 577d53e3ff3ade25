"""Motion under forces: start values, integration, events that end it, and its rows."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.response.blocks import *
    from mechkin_cli.response.integration import *
    from mechkin_cli.response.result import *
    from mechkin_cli.response.rows import *
    from mechkin_cli.response.runs import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "blocks": "ResponseBlocks",
        "integration": "Beginning Impact free_session integrate watched_stop with_loads",
        "result": "ENERGIES FreeResult ResponseResult",
        "rows": "Prepared",
        "runs": "integrated prepare read respond",
    },
)
