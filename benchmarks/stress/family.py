"""What a family of hard mechanisms is made of."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from benchmarks.stress.quantity import Rows, Truth


@dataclass(frozen=True)
class Block:
    """Mechanisms of one make: their files, the places of their rows (mechanisms, rows) as written
    (degrees of the input, or moments in s), and what is true at places of the doubles nearest to
    the numbers of the files; `written` of these numbers themselves, where rows are proven."""

    texts: Sequence[str]
    places: Rows
    truth: Callable[[Rows], Truth]
    written: Callable[[Rows], Truth] | None = None


Make = Callable[[Sequence[random.Random]], Block]
"""Draws one mechanism of each generator."""


@dataclass(frozen=True)
class Family:
    """`what` is the sentence of the page; mechanism k is of make k modulo their number.

    A mechanism has `rows` rows, or those of `lengths` by its make: then there is one mechanism of
    each make, as far as the rows of the run go.
    """

    name: str
    what: str
    rows: int
    makes: tuple[Make, ...]
    response: bool = False
    """Whether its files have a response, whose errors count in parts of its tolerance."""
    lengths: tuple[int, ...] = ()
    proven: int = 1
    """Every how-many-th mechanism of a make is proven, too: a proof may take as long as a hundred
    solutions. 0: none, as there are no proofs of responses."""
    weight: float = 1.0
    """Its rows in parts of other families' rows: forty loops take as long as forty mechanisms."""

    def rows_of(self, number: int) -> int:
        """Of a mechanism."""
        return self.lengths[number % len(self.makes)] if self.lengths else self.rows
