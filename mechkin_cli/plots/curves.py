"""Curves and pictures: which curves stand against what and what is marked, as plain data; and
pictures as matplotlib draws them, SVG, PNG and PDF, with the same bytes for the same rows.

A curve is a column by its label, a quantity or an expression, with its unit. Numbers stand over one
column, a panel for each unit. Vectors are drawn in a plane with equal axes instead: a position
gives the curve of its point, a force its polar diagram about the origin. Two columns of the same
unit of length or force are drawn in such a plane, too.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Sequence
from itertools import cycle
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import Columns, TableColumn, TableLayout, Words, row_texts, run_parameter
from mechkin_cli.tolerances import LARGEST_DRAWN
from mechkin_cli.units import FORCE, LENGTH, MOMENT
from mechkin_cli.verdict import Status, has_solution
from mechkin_cli.view import run_marks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Figure
    from matplotlib.typing import ColorType
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Readable
    from mechkin_cli.tables import Columns, TableLayout


class PlotCurve(NamedTuple):
    """Values over the rows (rows,), of a vector (rows, components), nan where there is none."""

    label: str
    unit: str
    values: Floats

    @property
    def is_vector(self) -> bool:
        """Whether it has components."""
        return self.values.ndim > 1

    @property
    def words(self) -> str:
        """Label and unit."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label


def curve_of(analysis: Readable, name: str) -> PlotCurve:
    """A column of the run's tables by its label, or else a quantity or an expression.

    Raises:
        UsageError: what is named is words.
        ExpressionError: neither a label nor an expression of quantities.
    """
    columns = (column for table in analysis.tables for column in table.columns)
    column = next((one for one in columns if one.label == name), None)
    if column is not None:
        return _column_curve(column)
    if name in row_texts(analysis.run):
        raise _not_numbers(name)
    result = analysis.result
    quantity = result.problem.definitions.parse(name).evaluate(result.quantity, result.units)
    return PlotCurve(name, result.units.label(quantity.dimension), analysis[name])


def _column_curve(column: TableColumn) -> PlotCurve:
    if isinstance(column.values, Words):
        raise _not_numbers(column.label)
    # what is rounding of zero would fill a picture of its own
    values = np.where(np.abs(column.values) <= column.rounding, 0.0, column.values)
    return PlotCurve(column.label, column.unit, values)


def parameter_curve(analysis: Readable) -> PlotCurve:
    """What the run goes along; where nothing moves, the numbers of the rows."""
    along = run_parameter(analysis.result)
    if along is None:
        return PlotCurve("row", "", np.arange(1.0, analysis.rows + 1))
    return PlotCurve(along.name, along.unit, along.values)


def _not_numbers(name: str) -> UsageError:
    return UsageError(f"{name} is words, which cannot be drawn; take a column of numbers")


COMPONENTS = "xyz"


class Picture(NamedTuple):
    """What is drawn.

    Attributes:
        title: above it.
        x: against which the curves of all panels stand; in a plane one for each curve.
        panels: the curves of each, all of one unit, from top to bottom; in a plane one.
        is_plane: both axes are of one unit and drawn to one scale.
        parameter: what the run goes along.
        marks: dead centres, branch points and events: where, by that parameter, and in words.
        solved: rows with a position (rows,).
        doubtful: verdicts other than ok of rows that have one: words and rows (rows,).
    """

    title: str
    x: tuple[PlotCurve, ...]
    panels: tuple[tuple[PlotCurve, ...], ...]
    is_plane: bool
    parameter: PlotCurve
    marks: tuple[tuple[float, str], ...]
    solved: Bools
    doubtful: tuple[tuple[str, Bools], ...]

    def __repr__(self) -> str:
        curves = ", ".join(curve.words for panel in self.panels for curve in panel)
        return f"Picture of {curves} over {', '.join(dict.fromkeys(c.words for c in self.x))}"


class Drawing(NamedTuple):
    """What a picture is made of, of some rows of a run.

    Attributes:
        title: above it.
        curves: what is drawn.
        against: against what; None: the run's parameter.
        parameter: what the run goes along.
        marks: as those of a picture.
        status: verdicts, codes of `Status` (rows,).
        plane_units: of what may stand in a plane.
    """

    title: str
    curves: tuple[PlotCurve, ...]
    against: PlotCurve | None
    parameter: PlotCurve
    marks: tuple[tuple[float, str], ...]
    status: NDArray[np.int8]
    plane_units: frozenset[str]


def drawing(
    analysis: Readable,
    title: str,
    y: Sequence[str | PlotCurve],
    x: str | PlotCurve | None = None,
    places: PlotCurve | None = None,
) -> Drawing:
    """What the picture of some columns, quantities or expressions is made of; in the file's units.

    Args:
        analysis: of the run, or of a part of it.
        title: above the picture.
        y: what is drawn; vectors alone, or numbers alone.
        x: against what; None: the run's parameter.
        places: what the run goes along at the rows of a part; None: they are all.

    Raises:
        UsageError: nothing to draw, words, or numbers beyond every axis.
        ExpressionError: an unknown name, or dimensions that do not fit.
    """
    drawn = tuple(one if isinstance(one, PlotCurve) else curve_of(analysis, one) for one in y)
    if not drawn:
        raise UsageError(f"{title} has nothing to draw; name what to draw, with --y A.effort")
    against = curve_of(analysis, x) if isinstance(x, str) else x
    for curve in drawn if against is None else (*drawn, against):
        _refuse_huge(curve)
    along = parameter_curve(analysis) if places is None else places
    marks = run_marks(analysis, along.label, along.values, whole=places is None)
    label = analysis.result.units.label
    return Drawing(
        title,
        drawn,
        against,
        along,
        tuple((float(str(mark["x"])), str(mark["text"])) for mark in marks),
        analysis.result.status,
        frozenset(label(dimension) for dimension in (LENGTH, FORCE, MOMENT)),
    )


def _refuse_huge(curve: PlotCurve) -> None:
    largest = np.max(np.abs(curve.values), where=np.isfinite(curve.values), initial=0.0)
    if largest > LARGEST_DRAWN:
        reached = f"{curve.label} reaches {largest:.3g} {curve.unit}".rstrip()
        raise UsageError(
            f"{reached}, and no axis goes beyond {LARGEST_DRAWN:g}; draw it in a larger unit, or "
            "a part of it"
        )


def picture(one: Drawing) -> Picture:
    """The picture of a drawing.

    Raises:
        UsageError: what cannot stand in one picture.
    """
    drawn, along = one.curves, one.parameter
    if any(curve.is_vector for curve in drawn):
        xs, ys = _in_plane(drawn, one.against)
        return _picture(one, xs, (ys,), is_plane=True)
    against = one.against or along
    if against.is_vector:
        raise UsageError(f"{against.label} is a vector; draw over a number, such as its .x")
    units = dict.fromkeys(curve.unit for curve in drawn)
    panels = tuple(tuple(c for c in drawn if c.unit == u) for u in units)
    is_plane = against.label != along.label and set(units) == {against.unit}
    is_plane &= against.unit in one.plane_units
    xs = len(drawn) * (against,) if is_plane else (against,)
    return _picture(one, xs, panels, is_plane=is_plane)


def _picture(
    one: Drawing,
    x: tuple[PlotCurve, ...],
    panels: tuple[tuple[PlotCurve, ...], ...],
    *,
    is_plane: bool,
) -> Picture:
    doubtful = tuple(
        (status.label, one.status == status)
        for status in Status
        if status not in (Status.ok, Status.dead_centre)  # the latter is a mark
        and status.has_solution
        and bool((one.status == status).any())
    )
    solved = has_solution(one.status)
    return Picture(one.title, x, panels, is_plane, one.parameter, one.marks, solved, doubtful)


def _in_plane(
    drawn: Sequence[PlotCurve], against: PlotCurve | None
) -> tuple[tuple[PlotCurve, ...], tuple[PlotCurve, ...]]:
    """Vectors by the two components in which they spread most, all by the same."""
    numbers = [curve.label for curve in drawn if not curve.is_vector]
    if numbers or against is not None:
        other = numbers[0] if numbers or against is None else against.label
        vector = next(curve.label for curve in drawn if curve.is_vector)
        raise UsageError(
            f"{vector} is a vector, which is drawn in a plane of its own, without {other}; "
            "for curves over a column write its components: .x, .y or .z"
        )
    units = {curve.unit for curve in drawn}
    if len(units) > 1:
        listed = " and ".join(sorted(units))
        raise UsageError(f"vectors in {listed} do not go into one plane; draw them one by one")
    # a vector of a plane has two components; those without a number come last
    spreads = [_spread(values) for values in np.concatenate([c.values for c in drawn]).T]
    first, second = sorted(sorted(range(len(spreads)), key=lambda k: -spreads[k])[:2])

    def components(k: int) -> tuple[PlotCurve, ...]:
        return tuple(
            PlotCurve(f"{curve.label}.{COMPONENTS[k]}", curve.unit, curve.values[:, k])
            for curve in drawn
        )

    return components(first), components(second)


def _spread(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else -1.0


def table_drawing(
    analysis: Readable,
    layout: TableLayout,
    table: Columns,
    x: str | None = None,
    places: PlotCurve | None = None,
) -> Drawing:
    """What the picture of a table is made of: as its `plot:` says, else all its numbers over the
    run's parameter.

    Args:
        x: a label or an expression that takes the place of the one in `plot:`.
        places: as of `drawing`.

    Raises:
        UsageError: it has no numbers, or names a column of words.
        ExpressionError: `x` is an unknown name.
    """
    x = layout.plot_x if x is None else x
    if layout.plot_y:
        by_label = {column.label: column for column in table.columns}
        drawn = [_column_curve(by_label[label]) for label in layout.plot_y]
    else:
        inputs = analysis.result.inputs
        left_out = {c.label for c in layout.columns if c.expression.text.strip() in inputs}
        left_out.add(parameter_curve(analysis).label if x is None else x)
        drawn = [
            _column_curve(column)
            for column in table.columns
            if column.label not in left_out and not isinstance(column.values, Words)
        ]
    return drawing(analysis, table.title or table.name, drawn, x, places)


_NO_DATES: dict[str, dict[str, None]] = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
FORMATS = tuple(_NO_DATES)
"""Endings of the files that can be written."""

_STYLE: dict[str, Any] = {
    "svg.hashsalt": "mechkin",
    "text.parse_math": False,  # a $ of a title is a $, and no formula
    "axes.grid": True,
    "grid.color": "#d8dee4",
    "axes.axisbelow": True,
    "axes.edgecolor": "#57606a",
    "axes.titlesize": "medium",
    "legend.fontsize": "small",
    "legend.frameon": False,
    "font.size": 9.0,
    "lines.linewidth": 1.6,
    "savefig.dpi": 150,
}
_WIDTH, _HEIGHT, _ABOVE, _PLANE = 7.2, 2.3, 1.0, 5.6
_ALONG = 8
"""Rows of a curve in a plane that carry the value of the run's parameter."""

_GAP, _GAP_ALPHA = "#eac54f", 0.25
_MARKS = ("#a40e26", "#57606a")
_DOUBTFUL = ("o", "s", "D", "^", "v", "<", ">")


def format_of(path: PurePath) -> str:
    """The format that a file's ending names.

    Raises:
        UsageError: it names none.
    """
    ending = path.suffix.removeprefix(".").lower()
    if ending not in FORMATS:
        raise UsageError(f"{path}: pictures end in .{', .'.join(FORMATS)}")
    return ending


def drawn(picture: Picture) -> Figure:
    """The picture.

    Raises:
        UsageError: matplotlib is not there.
    """
    matplotlib = _matplotlib()
    with matplotlib.rc_context(_STYLE):
        return _plane_figure(picture) if picture.is_plane else _over_a_column(picture)


def image(picture: Picture, ending: str) -> bytes:
    """A file with the picture, without dates or names of programs; errors as `drawn`."""
    return figure_bytes(lambda: drawn(picture), ending)


def figure_bytes(draw: Callable[[], Figure], ending: str) -> bytes:
    """A file with the figure that is drawn; as `image`."""
    matplotlib, stream = _matplotlib(), io.BytesIO()
    with matplotlib.rc_context(_STYLE), warnings.catch_warnings():
        # the empty boxes in the picture say so themselves
        warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from", UserWarning)
        draw().savefig(stream, format=ending, metadata=_NO_DATES[ending])
    return stream.getvalue()


def _matplotlib() -> Any:
    try:
        import matplotlib.figure
    except ImportError:
        raise UsageError(
            "pictures are drawn by matplotlib, which is not there: pip install 'mechkin[plot]'"
        ) from None
    return matplotlib


def empty_figure(height: float) -> Figure:
    """A figure of the width of all, and a height in inches."""
    figure: Figure = _matplotlib().figure.Figure(figsize=(_WIDTH, height), layout="constrained")
    return figure


def _over_a_column(picture: Picture) -> Figure:
    count = len(picture.panels)
    figure = empty_figure(_ABOVE + _HEIGHT * count)
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    (x,) = picture.x
    over_parameter = x.label == picture.parameter.label
    for axes, panel in zip(panels, picture.panels, strict=True):
        for curve in panel:
            (line,) = axes.plot(x.values, curve.values, label=curve.label)
            _single_rows(axes, picture, x.values, curve.values, line.get_color())
            if not over_parameter:
                _marked_rows(axes, picture, x.values, curve.values)
        if over_parameter:
            _gaps(axes, picture)
            for place, _ in picture.marks:
                axes.axvline(place, color=_MARKS[0], linestyle="--", linewidth=1.0)
        names = ", ".join(dict.fromkeys(curve.label for curve in panel))
        alone = len(panel) == 1
        unit = f"[{panel[0].unit}]" if panel[0].unit else ""
        axes.set_ylabel(f"{names} {unit}".strip() if alone else unit)
        if not alone or axes is panels[0]:
            _legend(axes, picture, over_parameter, with_marks=axes is panels[0])
    figure.align_ylabels(panels)
    panels[-1].set_xlabel(x.words)
    panels[0].set_title(picture.title)
    return figure


def _plane_figure(picture: Picture) -> Figure:
    figure = empty_figure(_PLANE)
    axes = figure.subplots()
    (panel,) = picture.panels
    for x, y in zip(picture.x, panel, strict=True):
        label = _vector_name(x, y)
        (line,) = axes.plot(x.values, y.values, label=label)
        colour = line.get_color()
        _single_rows(axes, picture, x.values, y.values, colour)
        _along(axes, picture, x.values, y.values, colour)
        _marked_rows(axes, picture, x.values, y.values)
    axes.set_aspect("equal", adjustable="datalim")
    axes.axhline(0.0, color=_MARKS[1], linewidth=0.6)
    axes.axvline(0.0, color=_MARKS[1], linewidth=0.6)
    axes.set_xlabel(_axis(picture.x))
    axes.set_ylabel(_axis(panel))
    axes.set_title(f"{picture.title}\nnumbers: {picture.parameter.words}")
    _legend(axes, picture, over_parameter=False, with_marks=True)
    return figure


def _axis(curves: tuple[PlotCurve, ...]) -> str:
    """The name of an axis: of one curve its own, of several their common component."""
    names = list(dict.fromkeys(curve.label for curve in curves))
    if len(names) == 1:
        return curves[0].words
    component = {name.rpartition(".")[2] for name in names}
    name = component.pop() if len(component) == 1 else ", ".join(names)
    return f"{name} [{curves[0].unit}]" if curves[0].unit else name


def _vector_name(x: PlotCurve, y: PlotCurve) -> str:
    """The vector whose components they are; of two columns the second."""
    stem = y.label.rpartition(".")[0]
    return stem if stem and x.label.rpartition(".")[0] == stem else y.label


def _single_rows(axes: Axes, picture: Picture, x: Floats, y: Floats, colour: ColorType) -> None:
    """Rows between two gaps, of which a line shows nothing, and rows with a doubtful verdict."""
    known = np.isfinite(x) & np.isfinite(y)
    before = np.concatenate([[False], known[:-1]])
    behind = np.concatenate([known[1:], [False]])
    alone = known & ~before & ~behind
    if alone.any():
        axes.plot(x[alone], y[alone], ".", color=colour)
    for (_, rows), shape in zip(picture.doubtful, cycle(_DOUBTFUL), strict=False):
        axes.plot(x[rows], y[rows], shape, markersize=5, markerfacecolor="none", color=colour)


def _along(axes: Axes, picture: Picture, x: Floats, y: Floats, colour: ColorType) -> None:
    """Values of the run's parameter along a curve."""
    known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    for row in known[:: max(1, -(-known.size // _ALONG))].tolist():
        axes.plot(x[row], y[row], "o", color=colour, markersize=3.5)
        text = f"{picture.parameter.values[row]:.4g}"
        axes.annotate(text, (x[row], y[row]), (4, 4), textcoords="offset points", fontsize="small")


def _gaps(axes: Axes, picture: Picture) -> None:
    """Shades the rows without a position."""
    places = picture.parameter.values
    edges = np.diff(np.concatenate([[0], (~picture.solved).astype(np.int8), [0]])).nonzero()[0]
    for first, behind in edges.reshape(-1, 2).tolist():
        start, end = places[max(first - 1, 0)], places[min(behind, places.size - 1)]
        axes.axvspan(start, end, color=_GAP, alpha=_GAP_ALPHA, linewidth=0.0)


def _marked_rows(axes: Axes, picture: Picture, x: Floats, y: Floats) -> None:
    """The row with a position that is next to each mark."""
    solved = np.flatnonzero(picture.solved)
    for place, _ in picture.marks if solved.size else ():
        row = solved[np.argmin(np.abs(picture.parameter.values[solved] - place))]
        axes.plot(x[row], y[row], "X", color=_MARKS[0], markersize=7)


def _legend(axes: Axes, picture: Picture, over_parameter: bool, *, with_marks: bool) -> None:
    from matplotlib.patches import Patch

    lines = axes.get_legend_handles_labels()[0]
    entries: list[Any] = list(lines) if len(lines) > 1 or picture.is_plane else []
    for (words, _), shape in zip(picture.doubtful, cycle(_DOUBTFUL), strict=False):
        entries.append(_entry(words, color=_MARKS[1], marker=shape, markerfacecolor="none"))
    if with_marks:
        style = {"linestyle": "--"} if over_parameter else {"marker": "X"}
        entries += [_entry(words, color=_MARKS[0], **style) for _, words in picture.marks]
        if not picture.solved.all() and over_parameter:
            entries.append(Patch(color=_GAP, alpha=_GAP_ALPHA, label="no position"))
    if entries:
        axes.legend(handles=entries, loc="best")


def _entry(words: str, **style: Any) -> Any:
    from matplotlib.lines import Line2D

    return Line2D([], [], **{"linestyle": "", **style}, label=words)
