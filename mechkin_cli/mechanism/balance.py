"""Balances of the sweep over a cycle: what a file asks for, checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mechkin_cli.diagnostics import Place
    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism.problem import Problem


class Cycle(NamedTuple):
    """The rows from the first to the last, which repeats it, at equal distances of `name`: an
    input, number `number`, that turns `turns` times, or `time` (number None)."""

    name: str
    number: int | None
    turns: int
    step: float
    """From row to row, in rad or s."""
    first: float
    """At the first row, in rad or s."""


@dataclass(frozen=True)
class Balance:
    """One balance; `name` is the stem of its files, `place` where the file says it."""

    name: str
    title: str
    place: Place
    cycle: Cycle


@dataclass(frozen=True)
class Work(Balance):
    """Work of every effort and load."""


@dataclass(frozen=True)
class Harmonics(Balance):
    """Fourier coefficients of some expressions, of `orders` times the turn of the input, or of the
    whole of time."""

    of: tuple[tuple[str, Expression], ...]
    orders: tuple[float, ...]


@dataclass(frozen=True)
class Flywheel(Balance):
    """The flywheel for an unevenness at a mean rate (rad/s); None: the input's in the rows."""

    unevenness: float
    rate: float


AnyBalance = Work | Harmonics | Flywheel


def read_by(balances: Iterable[AnyBalance], problem: Problem) -> list[str]:
    """Names of the quantities that balances read at once."""
    found: list[str] = []
    for balance in balances:
        if isinstance(balance, Harmonics):
            known = problem.quantities()
            for _, expression in balance.of:
                names = sorted(expression.names)
                found += [n if n in known else n.rpartition(".")[0] for n in names]
        else:
            found += [f"{joint}.{coordinate}.effort" for joint, coordinate in problem.acting]
    return [name for name in dict.fromkeys(found) if name in problem.quantities()]
