"""All assemblies of a structure at some inputs, block by block from random starts.

Hides for which loops an equation proves their number, and when a search may stop.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.search.chain import *
    from mechkin_cli.search.clusters import *
    from mechkin_cli.search.search import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "chain": "has_one_assembly",
        "clusters": "Within is_in_reach pose_keys pose_number same_poses",
        "search": "Assemblies all_assemblies free_places single_assembly with_assemblies",
    },
)
