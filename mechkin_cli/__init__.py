"""mechkin: positions, rates, reactions and tables of spatial mechanisms from one text file.

import mechkin_cli as mk

m = mk.load("mechanisms/rcsr.yaml")
r = m.analyze()
r["O4.theta"]          # array over the rows, in the file's units
"""

from __future__ import annotations

TYPE_CHECKING = False  # what the package itself loads, every command waits for
if TYPE_CHECKING:
    from typing import Any

    from mechkin_cli.diagnostics import Diagnostic, InvalidFile, MechkinError, UsageError
    from mechkin_cli.expressions import ExpressionError
    from mechkin_cli.interface import Analysis, Model, load, loads
    from mechkin_cli.status import Status

_PLACES = {
    "Analysis": "interface",
    "Diagnostic": "diagnostics",
    "ExpressionError": "expressions",
    "InvalidFile": "diagnostics",
    "MechkinError": "diagnostics",
    "Model": "interface",
    "Status": "status",
    "UsageError": "diagnostics",
    "load": "interface",
    "loads": "interface",
}

__all__ = [
    "Analysis",
    "Diagnostic",
    "ExpressionError",
    "InvalidFile",
    "MechkinError",
    "Model",
    "Status",
    "UsageError",
    "load",
    "loads",
]


def __getattr__(name: str) -> Any:
    """Imports the public names when they are first used, so that start-up stays short."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)
