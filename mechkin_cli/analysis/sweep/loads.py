"""Loads that vary where one has no value: which, and what to say."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.mechanism.load_laws import quantities_read, undefined_laws

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Bools
    from mechkin_cli.diagnostics import Diagnostic


def undefined_loads(result: Result, lost: Bools) -> list[Diagnostic]:
    """What to say of the rows (rows,) of a result in which some load has no value.

    The laws are evaluated once more, from the same quantities as in the kernel and with the same
    bits, to tell them apart.
    """
    known = result.problem.quantities()
    result.read([known[name] for name in quantities_read(result.problem)])
    return undefined_laws(result.problem, result.quantity, lost)
