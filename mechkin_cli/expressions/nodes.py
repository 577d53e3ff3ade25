"""Nodes of a parsed expression, kept in postfix order: operands before their operation.

Postfix order makes evaluation a loop over a stack, so long sums need no recursion.
"""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.units import CompoundUnit


class Number(NamedTuple):
    """A number as written, with the unit behind it if there is one."""

    value: float
    unit: CompoundUnit | None
    text: str
    offset: int
    joined_units: tuple[tuple[str, int], ...] = ()
    """Unit words that follow `*` or `/`, with offsets: they could be meant as parameters."""


class Name(NamedTuple):
    """A name with dots; a last part `x`, `y` or `z` may be a component of what comes before it,
    unless it is `whole`."""

    text: str
    offset: int
    whole: bool = False


class Operation(NamedTuple):
    """An operation or function on the `arity` values before it; `symbol` is its table key."""

    symbol: str
    arity: int
    offset: int


Node = Number | Name | Operation
