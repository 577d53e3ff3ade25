"""The benchmark's mechanisms with solutions that share no formula with the package."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from benchmark import loop_loads, reference, specimens
from benchmark.arithmetic import Arithmetic
from benchmark.specimen import Specimen

from benchmarks import rcsr, sevenr


@dataclass(frozen=True)
class ExactSpecimen(Specimen):
    """A mechanism and what is right.

    Args:
        solution: everything in extended precision for positions (rows) of the input and guesses
            (coordinates, rows).
        row_by_row: the same in any arithmetic.
        zeros: what is zero by its nature; rounding there has no size to be compared with.
    """

    solution: Callable[[Any, Any], dict[str, Any]]
    row_by_row: Callable[[Any, Any, Arithmetic], dict[str, Any]]
    zeros: frozenset[str] = frozenset()


def rcsr_specimen(scale: float = 1.0) -> ExactSpecimen:
    """The mechanism of the dissertation, all lengths times `scale`."""
    size = rcsr.dimensions(scale)
    return ExactSpecimen(
        **vars(specimens.rcsr_specimen(scale)),
        solution=partial(reference.solution, size),
        row_by_row=partial(reference.row_by_row, size),
        # a sphere transmits no moment
        zeros=frozenset({"O3.moment"}),
    )


def sevenr_specimen(scale: float = 1.0) -> ExactSpecimen:
    """The general loop of seven revolutes, all lengths times `scale`."""
    loop = sevenr.dimensions(scale)
    return ExactSpecimen(
        **vars(specimens.sevenr_specimen(scale)),
        solution=partial(loop_loads.loop_solution, loop),
        row_by_row=partial(loop_loads.loop_row_by_row, loop),
    )
