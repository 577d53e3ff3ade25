"""`tables:` - the layouts a run writes, one file each: columns are expressions over quantities.

Also `coefficients:`, the dense system of all reactions at one row, and `balances:`, sums of the
sweep over a cycle.
"""

from typing import Annotated, Any, ClassVar, Literal, TypeVar

from mechkin_cli.schema.base import (
    NOTHING,
    Limits,
    Rule,
    SchemaName,
    Section,
    Shown,
    by_word,
    each_once,
    refuse,
)
from mechkin_cli.schema.scalars import (
    CSV_PATH_PATTERN,
    CYCLE_PATTERN,
    DEVICE,
    SIGNED_PATTERN,
    TABLE_NAME_PATTERN,
    AnyDimension,
    CoordinateRate,
    CsvPath,
    Dimensionless,
    Name,
    RunName,
    Text,
    WholeNumber,
)

TableName = Annotated[
    str,
    Limits(pattern=TABLE_NAME_PATTERN),
    Shown(("string",), "letters, digits, - and _; the name of the file written", ("table_03",)),
    SchemaName("TableName"),
]


ROW_NUMBER = "row.number"
# JSON Schema has no flag for ignoring case
TAKEN_FOR_EDITORS = (
    "^([Rr][Oo][Ww][Ss]|[Ee][Rr][Rr][Aa][Tt][Aa]|[Dd][Ii][Ss][Aa][Gg][Rr][Ee][Ee][Mm][Ee][Nn][Tt][Ss]|[Cc][Oo][Nn]|[Pp][Rr][Nn]|[Aa][Uu][Xx]|[Nn][Uu][Ll]"
    "|[Cc][Oo][Mm][0-9]|[Ll][Pp][Tt][0-9])$"
)


class Column(Section):
    """One column. A plain text stands for a column whose label and value are that text."""

    advice: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("unit", "units"), "a column is in the units of the file, units:"),
        **dict.fromkeys(("name", "title", "header"), "write label: torque"),
        **dict.fromkeys(("digits", "precision", "places", "format"), "write decimals: 3"),
        **dict.fromkeys(("expression", "formula", "quantity", "of"), "write value: O.theta"),
    }

    label: Text
    """Heading of the column."""
    value: AnyDimension
    """An expression over quantities and parameters; with commas or brackets it stands in quotes. A
    vector becomes a column for each component, with `.x`, `.y`, `.z` behind the label."""
    decimals: Annotated[WholeNumber, Limits(ge=0, le=17)] | None = None
    """Decimals in Markdown, CSV always has all digits; left out, six significant digits of the
    largest value."""


def _in_full(value: Any) -> Any:
    return {"label": value, "value": value} if isinstance(value, (str, int, float)) else value


ColumnOrText = Annotated[
    Column,
    Rule(_in_full, before=True),
    Shown(("string", "number"), "label and value in one: O1.theta", is_short=True),
]


class PrintedRemark(Section):
    """Why printed values differ from computed ones, for the errata page."""

    columns: Annotated[tuple[Text, ...], Limits(min_length=1)] | None = None
    """Labels of the columns it holds for; left out, all."""
    data: Annotated[tuple[Text, ...], Limits(min_length=1)] | None = None
    """Numbers that the source does not give, where the remark says how they were found; left out,
    none."""
    text: Text
    """The reason in words."""


class PublishedValues(Section):
    """Values printed in the source. A plain path stands for the file without remarks."""

    file: CsvPath
    """The values as printed: a CSV file with the labels of the table, the first one in front."""
    rows_by: Text | None = None
    """Label of the column that finds the rows, or `row.number`; left out, the first one printed."""
    remarks: tuple[PrintedRemark, ...] = ()
    """Why values differ, in words; left out, nothing is known."""


def _with_file(value: Any) -> Any:
    return {"file": value} if isinstance(value, str) else value


_PATH_ALONE = "a CSV file with the printed values, relative to the mechanism file"
PathOrPublishedValues = Annotated[
    PublishedValues,
    Rule(_with_file, before=True),
    Shown(("string",), _PATH_ALONE, pattern=CSV_PATH_PATTERN, is_short=True),
]

_TAKEN = {
    "rows": "every run writes a table rows of its own",
    "errata": "the comparison with printed values is written to the page errata",
    "disagreements": "printed cells that do not agree are written to a table disagreements",
}


def free_name(name: str) -> str:
    """The name, if nothing else is written to its files."""
    if name.casefold() in _TAKEN:
        raise refuse("reserved-name", _TAKEN[name.casefold()], "rename it")
    if DEVICE.fullmatch(name):
        raise refuse("reserved-name", f"{name} is a device on Windows, not a file", "rename it")
    return name


def _differing_labels(columns: tuple[Column, ...]) -> tuple[Column, ...]:
    labels = [column.label for column in columns]
    for index, label in enumerate(labels):
        if label in labels[:index]:
            hint = "give each column of a table its own label"
            text = f"the label {label!r} is used twice"
            raise refuse("label-clash", text, hint, index, "label")
    return columns


class Plot(Section):
    """The picture that `mechkin plot` makes of a table."""

    x: Text | None = None
    """Label of the column against which the others stand; left out, time where the run has one,
    else its first input that moves."""
    y: Annotated[tuple[Text, ...], Limits(min_length=1)] = ()
    """Labels of the columns that are drawn; left out, all of numbers."""


SummaryWord = Literal["max", "min", "peak", "mean", "rms", "range"]


def _refuse_unknown(plot: Plot, labels: list[str]) -> None:
    named = [(plot.x, ("plot", "x"))] if plot.x is not None else []
    for label, at in (*named, *((y, ("plot", "y", k)) for k, y in enumerate(plot.y))):
        if label not in labels:
            text = f"the table has no column {label!r} to draw"
            raise refuse("unknown-label", text, f"labels are {', '.join(labels)}", *at)


class Table(Section):
    """A table with one row per position."""

    name: Annotated[TableName, Rule(free_name, barred=TAKEN_FOR_EDITORS)]
    """Name of the files written, without ending."""
    title: Text | None = None
    """Heading in Markdown; left out, the name."""
    run: RunName | None = None
    """The run it reads, `sweep` or the name of a response; left out, the sweep if there is one,
    else the only response."""
    columns: Annotated[
        tuple[ColumnOrText, ...], Limits(min_length=1, max_length=1000), Rule(_differing_labels)
    ]
    """The columns, from left to right."""
    summary: Annotated[tuple[SummaryWord, ...], Limits(min_length=1), Rule(each_once)] = ()
    """What stands below the table for each column that is computed: some of [max, min, peak, mean,
    rms, range]. `peak` is the largest magnitude; max, min and peak have their places; left
    out, nothing."""
    plot: Plot | None = None
    """The picture that `mechkin plot` makes of it; left out, all columns over the first input."""
    published: PathOrPublishedValues | None = None
    """Values printed in the source, as a CSV file with the same labels; left out, no comparison."""

    def check(self) -> None:
        """What is drawn and what is published names columns of the table."""
        labels = [column.label for column in self.columns]
        if self.plot is not None:
            _refuse_unknown(self.plot, labels)
        rows_by = self.published.rows_by if self.published else None
        if rows_by not in (None, ROW_NUMBER, *labels):
            text = f"the table has no column {rows_by!r} to find its rows by"
            hint = f"labels are {', '.join(labels)}; or write {ROW_NUMBER}"
            raise refuse("unknown-label", text, hint, "published", "rows_by")
        for index, remark in enumerate(self.published.remarks if self.published else ()):
            for place, label in enumerate(remark.columns or ()):
                if label not in labels:
                    text = f"the table has no column {label!r}"
                    at = ("published", "remarks", index, "columns", place)
                    raise refuse("unknown-label", text, f"labels are {', '.join(labels)}", *at)


SignedName = Annotated[
    str,
    Limits(pattern=SIGNED_PATTERN),
    Shown(("string",), "a name, with - where signs turn round", ("O1.F", "-O1.FA")),
    SchemaName("SignedName"),
]


class Coefficients(Section):
    """The equations of equilibrium of all links and the conditions of all pairs at one row.

    NAME.csv has an equation per row and an unknown per column, NAME_unknowns.csv the unknowns with
    their values.
    """

    name: Annotated[TableName, Rule(free_name, barred=TAKEN_FOR_EDITORS)]
    """Name of the files written, without ending."""
    title: Text | None = None
    """Heading in Markdown; left out, the name."""
    row: Annotated[WholeNumber, Limits(ge=1)] = 1
    """Row of the sweep, counted from 1."""
    along: dict[Name, Annotated[tuple[Name, ...], Limits(min_length=2, max_length=2)]] = NOTHING
    """Directions of two force components of a ball; the third is along their cross
    product; left out, those along x, y and z."""
    equations: tuple[SignedName, ...] = ()
    """Links and joints whose equations come first, in this order, with - where a joint's conditions
    are written along the opposite axis; left out, links come before joints."""
    unknowns: tuple[SignedName, ...] = ()
    """Unknowns whose columns come first, in this order, with - where they count the other way:
    `O1.F` is all three components; left out, forces come before moments, FA and MA, balls and
    efforts."""
    counted: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of unknowns that the source counts, to stand beside those here; left out, none
    does."""


CycleName = Annotated[
    str,
    Limits(pattern=CYCLE_PATTERN),
    Shown(("string",), "an input that turns, or time", ("A.theta", "time")),
    SchemaName("CycleName"),
]
BalanceName = Annotated[TableName, Rule(free_name, barred=TAKEN_FOR_EDITORS)]


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
        *("0", "1", "2", "3", "4"),
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


AnyBalance = WorkBalance | HarmonicsBalance | FlywheelBalance
Balance = Annotated[AnyBalance, by_word("type", ("work", "harmonics", "flywheel"))]

AnyTables = TypeVar("AnyTables", bound=tuple[Table, ...] | tuple[Coefficients, ...])


def differing_names(tables: AnyTables) -> AnyTables:
    """The tables, if no two would be written to the same file; file systems may ignore case."""
    names = [table.name.casefold() for table in tables]
    for index, name in enumerate(names):
        if name in names[:index]:
            text = f"two tables are called {tables[index].name}"
            raise refuse("table-clash", text, "rename one of them", index, "name")
    return tables


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
