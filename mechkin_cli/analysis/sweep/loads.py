"""Loads that vary where one has no value: which, and what to say."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.load_laws import law_value, quantities_read, undefined_laws

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.diagnostics import Diagnostic


def values_of_laws(result: Result) -> Floats:
    """Values of the laws (laws, rows) in SI: what the kernel has, before units and axes."""
    laws, rows = result.problem.load_laws, result.row_states.reached.size
    _read(result)
    values = [law_value(law, result.quantity, rows) for law in laws]
    return np.array(values).reshape(len(laws), rows)


def undefined_loads(result: Result, lost: Bools) -> list[Diagnostic]:
    """What to say of the rows (rows,) of a result in which some load has no value.

    The laws are evaluated once more, from the same quantities as in the kernel and with the same
    bits, to tell them apart.
    """
    _read(result)
    return undefined_laws(result.problem, result.quantity, lost)


def _read(result: Result) -> None:
    known = result.problem.quantities()
    result.read([known[name] for name in quantities_read(result.problem)])
