"""scipy.optimize where it is installed; it is of the extra `fit`, and loaded when a fit begins."""

from __future__ import annotations

from typing import Any

from mechkin_cli.diagnostics import UsageError


def optimizer() -> Any:
    """scipy.optimize.

    Raises:
        UsageError: scipy is not installed.
    """
    try:
        import scipy.optimize
    except ImportError:
        raise UsageError("fit needs scipy: pip install 'mechkin[fit]'") from None
    return scipy.optimize
