"""A design and its runs: what a checked file is with the values of its parameters, the sweep and
the responses of it, and the `Analysis` that reads their results by name or expression.

Hides how runs are asked for, pickled and proven. Models with other values are made above, in
`variants`; `model` puts all questions together.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.analysis.analysis import *
    from mechkin_cli.analysis.certificate import *
    from mechkin_cli.analysis.design import *
    from mechkin_cli.analysis.runs import *
    from mechkin_cli.analysis.stream import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "analysis": "Analysis Solvable",
        "certificate": "Certificate",
        "design": "Design",
        "runs": "a_packing asking equilibrium input_values respond response_name run_free run_name "
        "run_sweep stream_run",
        "stream": "Block Ended PartRows Stream ended",
    },
)
