"""Where loads balance: generalised forces of free mechanisms and how they change about a place, one
equilibrium, all in a window, the branch of equilibria along a sweep, and what each equilibrium is.

Hides how a search goes, and how rows of equilibria are made.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.statics.forces import *
    from mechkin_cli.statics.places import *
    from mechkin_cli.statics.rest import *
    from mechkin_cli.statics.result import *
    from mechkin_cli.statics.runs import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "forces": "Derivative DrivenAt Forces ForcesAt FreePlace combined differentiated summed",
        "places": "Place Statics",
        "rest": "UnsolvedText rested",
        "result": "EquilibriumResult",
        "runs": "balance balanced",
    },
)
