"""`balances:` - what the sweep sums up to over a cycle, a small table each."""

from typing import Annotated, Any, Literal

from mechkin_cli.schema.alternatives import Tag, by_word
from mechkin_cli.schema.base import Section, refuse
from mechkin_cli.schema.coefficients import Coefficients
from mechkin_cli.schema.rules import After, Barred, Limits, Named, Shown
from mechkin_cli.schema.scalars import (
    CYCLE_PATTERN,
    AnyDimension,
    CoordinateRate,
    Dimensionless,
    Text,
)
from mechkin_cli.schema.tables import TAKEN_FOR_EDITORS, Table, TableName, free_name

CycleName = Annotated[
    str,
    Limits(pattern=CYCLE_PATTERN),
    Shown(("string",), "an input that turns, or time", ("A.theta", "time")),
    Named("CycleName"),
]
BalanceName = Annotated[TableName, After(free_name), Barred(TAKEN_FOR_EDITORS)]


class _Balance(Section):
    """A balance over the rows from the first to the last, which repeats the first."""

    name: BalanceName
    """Name of the files written, without ending."""
    title: Text | None = None
    """Heading in Markdown; left out, the name."""
    cycle: CycleName | None = None
    """What goes round over the rows, once or several times: an input that turns, or `time`; left
    out, time where the sweep has one, else the input that moves."""


class WorkBalance(_Balance):
    """The work of every effort and load over the cycle."""

    type: Literal["work"]


class HarmonicsBalance(_Balance):
    """Fourier coefficients of quantities over the cycle."""

    type: Literal["harmonics"]
    of: Annotated[tuple[AnyDimension, ...], Limits(min_length=1, max_length=100)]
    """Expressions of one dimension; a vector stands for its three components."""
    orders: Annotated[tuple[Dimensionless, ...], Limits(min_length=1, max_length=1000)] = (
        "0",
        "1",
        "2",
        "3",
        "4",
    )
    """Orders: cosines and sines of so many times the angle, or periods in the rows' time. Where the
    rows turn k times, multiples of 1/k are orders, too. Left out, [0, 1, 2, 3, 4]."""


class FlywheelBalance(_Balance):
    """The flywheel that a machine needs that a constant effort drives."""

    type: Literal["flywheel"]
    unevenness: Dimensionless
    """Coefficient of fluctuation: (largest - least angular rate) / their mean."""
    rate: CoordinateRate | None = None
    """That mean; left out, the rate of the input in the sweep."""


_WORDS = {"work": "(work)", "harmonics": "(harmonics)", "flywheel": "(flywheel)"}


def _tag(mapping: dict[str, Any]) -> str | None:
    word = mapping.get("type")
    return _WORDS.get(word) if isinstance(word, str) else None


AnyBalance = WorkBalance | HarmonicsBalance | FlywheelBalance
Balance = Annotated[
    Annotated[WorkBalance, Tag("(work)")]
    | Annotated[HarmonicsBalance, Tag("(harmonics)")]
    | Annotated[FlywheelBalance, Tag("(flywheel)")],
    by_word("type", _tag, ", ".join(_WORDS)),
]


def refuse_clashes(
    balances: tuple[AnyBalance, ...], tables: tuple[Table | Coefficients, ...]
) -> None:
    """Balances and tables are written to files of their names; file systems may ignore case."""
    # without tables the sweep writes one of its own name
    taken = {table.name.casefold() for table in tables} or {"sweep"}
    for index, balance in enumerate(balances):
        if balance.name.casefold() in taken:
            text = f"another table or balance is called {balance.name}"
            raise refuse("table-clash", text, "rename one of them", "balances", index, "name")
        taken.add(balance.name.casefold())
