"""The compiled core, and how to speak to it.

`_kernel` is built from `core/`, which knows no Python, and its skin `python/`; `functions` are
its elementary functions.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from mechkin_cli.diagnostics import MechkinError


class KernelMissing(MechkinError, ImportError):
    """The compiled module is not there."""


def __getattr__(name: str) -> Any:
    """Imports the compiled module when it is first needed."""
    if name != "_kernel":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    try:
        return import_module("mechkin_cli.kernel._kernel")
    except ModuleNotFoundError as error:
        raise KernelMissing(
            "mechkin's compiled core is missing: run 'pip install .' in the source folder and use "
            "the installed command (a source folder on Python's path hides the installed package)"
        ) from error
