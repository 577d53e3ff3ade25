"""`load`, `Model` and `Analysis`: mechkin for Python programs. The commands call nothing else."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.model.analysis import Analysis as Analysis
    from mechkin_cli.model.model import Model as Model, load as load, loads as loads
    from mechkin_cli.model.runs import (
        a_packing as a_packing,
        refuse_loaded_spin as refuse_loaded_spin,
        response_name as response_name,
        run_name as run_name,
    )
    from mechkin_cli.model.settings import input_values as input_values

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "analysis": ["Analysis"],
        "model": ["Model", "load", "loads"],
        "runs": ["a_packing", "refuse_loaded_spin", "response_name", "run_name"],
        "settings": ["input_values"],
    },
)
