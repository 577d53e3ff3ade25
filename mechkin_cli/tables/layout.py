"""Table layouts: which columns a table has, under which labels, with how many decimals.

At the end, texts of a file as they stand in tables. A spreadsheet computes a cell of a CSV file
that begins with =, +, - or @; it takes one that begins with an apostrophe for text. In Markdown
what would be markup is escaped. Numbers never come here.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Protocol, TypeVar
from urllib.parse import quote

from mechkin_cli import expressions
from mechkin_cli.record import NamedTuple
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.expressions import Expression


ROW_TEXTS = ("row.mode", "row.status")
"""Quantities of a row that are texts: each can only be a column of its own."""

ROW_PROOF = "row.proof"
"""A text of the rows of a sweep: what is proven of it."""

ROW_EVENT = "row.event"
"""A text of the rows of a response: what ended it there; of equilibria: whether it is stable."""

ROW_NUMBER = "row.number"
"""Stands for the number of a printed row, counted from 1, where no column can find it."""

ROW_NUMBERS = ("row.residual", "row.condition", "row.power_error")
"""Quantities of a row that are dimensionless numbers."""


class ColumnLayout(NamedTuple):
    """One column; `decimals` holds for Markdown alone, None leaves them to the values."""

    label: str
    expression: Expression
    decimals: int | None = None


class Remark(NamedTuple):
    """Why printed values differ, in words; `labels` of the columns meant, () for all.

    A remark with `data` is about these numbers instead: they are not in the source's text, and the
    words say where they are from.
    """

    text: str
    labels: tuple[str, ...] = ()
    data: tuple[str, ...] = ()


class PrintedSource(NamedTuple):
    """Where the printed values of a table stand: a path relative to the mechanism file.

    `rows_by` is the label by whose values printed rows are found, `ROW_NUMBER` where the n-th
    printed row is the n-th computed one, and None for the first printed column.
    """

    file: str
    remarks: tuple[Remark, ...] = ()
    rows_by: str | None = None


class TableLayout(NamedTuple):
    """One table.

    Attributes:
        name: the stem of its files.
        title: its heading in Markdown.
        run: whose rows it has.
        summary: what stands below it, names of `summary.REDUCTIONS`.
        plot_x: label of the column over which its picture is drawn; None: the run's parameter.
        plot_y: labels of the columns that are drawn; () all others.
    """

    name: str
    title: str
    columns: tuple[ColumnLayout, ...]
    published: PrintedSource | None = None
    run: str = SWEEP
    summary: tuple[str, ...] = ()
    plot_x: str | None = None
    plot_y: tuple[str, ...] = ()


def row_texts(run: str) -> tuple[str, ...]:
    """The quantities that are texts in the rows of a run."""
    return (*ROW_TEXTS, ROW_PROOF if run == SWEEP else ROW_EVENT)


class CoefficientsLayout(NamedTuple):
    """A table of the dense system at one row (counted from 1); its unknowns have one of their own.

    `along` names two directions of the forces of some balls, `counted` the unknowns that the source
    counts. `equations` (links, joints) and `unknowns` (such as O1.F) come first in that order, with
    - before what changes its sign.
    """

    name: str
    title: str
    row: int = 1
    along: Mapping[str, tuple[str, str]] = MappingProxyType({})
    counted: int | None = None
    equations: tuple[str, ...] = ()
    unknowns: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, str]:
        """Names of the two tables."""
        return self.name, f"{self.name}_unknowns"


class _Named(Protocol):
    @property
    def name(self) -> str: ...


Layout = TypeVar("Layout", bound=_Named)


def chosen(layouts: tuple[Layout, ...], names: Collection[str] | None) -> tuple[Layout, ...]:
    """Those named; None for all."""
    return layouts if names is None else tuple(one for one in layouts if one.name in names)


def default_table(
    coordinates: Sequence[str], efforts: Collection[str], *, run: str = SWEEP, timed: bool = False
) -> TableLayout:
    """The table of a run that has none, called after it: all coordinates, their rates, the efforts;
    of a response what ended it, too.

    `coordinates` are the dotted names in joint order, `efforts` those of them with an effort;
    `timed` puts the time of the rows first. Each column is labelled with the name of its quantity.
    """
    rates = [f"{name}_dot" for name in coordinates]
    names = [*(["time"] if timed else []), *coordinates, *rates, *effort_names(efforts)]
    names += [ROW_EVENT] if run != SWEEP else []
    columns = tuple(ColumnLayout(name, expressions.parse(name)) for name in names)
    return TableLayout(run, "Coordinates, rates and efforts", columns, run=run)


def resting_table(
    coordinates: Sequence[str], efforts: Collection[str], told: Sequence[str], run: str
) -> TableLayout:
    """The table of equilibria that have none, called after their run: all coordinates, the efforts,
    and what is `told` of each equilibrium."""
    names = [*coordinates, *effort_names(efforts), ROW_EVENT, *told]
    columns = tuple(ColumnLayout(name, expressions.parse(name)) for name in names)
    return TableLayout(run, "Coordinates, efforts and stability", columns, run=run)


def counted(count: int, noun: str) -> str:
    """A count with its noun.

    >>> counted(1, "cell"), counted(3, "cell")
    ('1 cell', '3 cells')
    """
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def effort_names(inputs: Collection[str]) -> list[str]:
    """Name of each input's effort: `O1.effort`, or `O2.s.effort` where O2 has several inputs."""
    joints = [name.rpartition(".")[0] for name in inputs]
    return [
        f"{joint}.effort" if joints.count(joint) == 1 else f"{name}.effort"
        for name, joint in zip(inputs, joints, strict=True)
    ]


_FORMULA = re.compile(r"(^|[;\t\r\n])(?=[\s'\"]*[=+\-@＝＋－＠])|^(?=[\t\r\n])")
_MARKUP = re.compile(r"[\\|`*\[\]~]|(?<![^\W_])_|_(?![^\W_])")
_ENTITY = re.compile(r"&(?=#?\w+;)")
_BLOCK = re.compile(r"^(?=[#>+=-])|^(\d{1,9})(?=[.)])")
_TURNS_THE_LINE = re.compile("[\u202a-\u202e\u2066-\u2069]")
"""Characters after which text runs the other way: a page shows other words than it holds."""


def csv_text(text: str) -> str:
    """The text, with an apostrophe where a spreadsheet would find a formula.

    Example:
        >>> csv_text("=1+1"), csv_text("a; -b"), csv_text("max(a, -b)")
        ("'=1+1", "a;' -b", 'max(a, -b)')
    """
    return _FORMULA.sub(lambda found: f"{found[0]}'", text)


def markdown_text(text: str) -> str:
    r"""The text in one line and without markup.

    Example:
        >>> markdown_text("theta_1 [a](b) <b>|"), markdown_text("R&D &lt;")
        ('theta_1 \\[a\\](b) &lt;b>\\|', 'R&D &amp;lt;')
    """
    line = _TURNS_THE_LINE.sub("", " ".join(text.split()))
    line = _MARKUP.sub(lambda found: f"\\{found[0]}", line)
    return _ENTITY.sub("&amp;", line).replace("<", "&lt;")


def markdown_line(text: str) -> str:
    """As `markdown_text`, for a text that begins a line or an item of a list."""
    return _BLOCK.sub(lambda found: f"{found[0]}\\", markdown_text(text))


def link_target(path: str) -> str:
    """A relative path as it stands in a link."""
    return quote(path, safe="/", errors="surrogateescape")
