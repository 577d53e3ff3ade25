"""Motion under forces: start values, integration, events that end it, and its rows."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.response.integration import (
        Beginning as Beginning,
        integrate as integrate,
        with_loads as with_loads,
    )
    from mechkin_cli.response.result import ResponseResult as ResponseResult
    from mechkin_cli.response.runs import (
        Prepared as Prepared,
        integrated as integrated,
        prepare as prepare,
        read as read,
        respond as respond,
        watched_stop as watched_stop,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "integration": "Beginning integrate with_loads",
        "result": "ResponseResult",
        "runs": "Prepared integrated prepare read respond watched_stop",
    },
)
