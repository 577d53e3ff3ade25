"""The proven number of assemblies of a small loop at given upstream states.

The loop is reduced to one polynomial (`loop_polynomial`), whose real roots are counted
(`real_roots`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.solver.loop_chain import chain_of
from mechkin_cli.solver.loop_polynomial import reduced
from mechkin_cli.solver.real_roots import Trigonometric, count_polynomial_roots, count_roots

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout


class Count(NamedTuple):
    """A loop's number of assemblies at its upstream states, None where rounding leaves it open, and
    the most that such a loop has."""

    real: int | None
    most: int


def state_error(number: int) -> float:
    """The error of the upstream states of a block: inputs are given, unknowns are found."""
    return tolerances.ROOT_STATE_ERROR if number else tolerances.ROOT_ROUNDING


def count_assemblies(layout: Layout, number: int, base: Floats, error: float) -> Count | None:
    """The count of a block, upstream states as in `base` (states,) but for `error`; None for loops
    of other kinds."""
    chain = chain_of(layout, number, base)
    found = None if chain is None else reduced(chain)
    if found is None:
        return None
    polynomial, regularity, most = found
    if polynomial is None or regularity < tolerances.ROOT_REGULAR:
        return Count(None, most)
    doubt = error / (regularity * regularity)
    if isinstance(polynomial, Trigonometric):
        return Count(count_roots(polynomial, doubt), most)
    return Count(count_polynomial_roots(polynomial, doubt), most)
