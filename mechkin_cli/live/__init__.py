"""What a page needs to compute a run with other parameters by itself.

A record of plain data: the plan with its tape for the kernel in the page (`kernel/wasm`), programs
of cells, and what hangs on parameters in the drawing. The page gives the bytes that
`Model.with_parameters` gives; what it cannot compute is named, with the command that does.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.live.record import *

__getattr__, __dir__ = lazy_names(__name__, {"record": "live_record"})
