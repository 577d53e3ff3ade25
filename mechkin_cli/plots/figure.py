"""Pictures as matplotlib draws them: SVG, PNG and PDF, with the same bytes for the same rows."""

from __future__ import annotations

import io
import warnings
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Figure
    from matplotlib.typing import ColorType

    from mechkin_cli.plots.curves import Picture, PlotCurve
    from mechkin_cli.show import Floats


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
_DOUBTFUL = ("o", "s", "D")


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
        return _in_plane(picture) if picture.is_plane else _over_a_column(picture)


def image(picture: Picture, ending: str) -> bytes:
    """A file with the picture, without dates or names of programs; errors as `drawn`."""
    matplotlib, stream = _matplotlib(), io.BytesIO()
    with matplotlib.rc_context(_STYLE), warnings.catch_warnings():
        # the empty boxes in the picture say so themselves
        warnings.filterwarnings("ignore", r"Glyph \d+ .*missing from", UserWarning)
        drawn(picture).savefig(stream, format=ending, metadata=_NO_DATES[ending])
    return stream.getvalue()


def _matplotlib() -> Any:
    try:
        import matplotlib.figure
    except ImportError:
        raise UsageError(
            "pictures are drawn by matplotlib, which is not there: pip install 'mechkin[plot]'"
        ) from None
    return matplotlib


def _figure(height: float) -> Figure:
    figure: Figure = _matplotlib().figure.Figure(figsize=(_WIDTH, height), layout="constrained")
    return figure


def _over_a_column(picture: Picture) -> Figure:
    count = len(picture.panels)
    figure = _figure(_ABOVE + _HEIGHT * count)
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    (x,) = picture.x
    over_parameter = x.label == picture.parameter.label
    for axes, panel in zip(panels, picture.panels, strict=True):
        for curve in panel.curves:
            (line,) = axes.plot(x.values, curve.values, label=curve.label)
            _single_rows(axes, picture, x.values, curve.values, line.get_color())
            if not over_parameter:
                _marked_rows(axes, picture, x.values, curve.values)
        if over_parameter:
            _gaps(axes, picture)
            for place, _ in picture.marks:
                axes.axvline(place, color=_MARKS[0], linestyle="--", linewidth=1.0)
        names = ", ".join(dict.fromkeys(curve.label for curve in panel.curves))
        alone = len(panel.curves) == 1
        unit = f"[{panel.unit}]" if panel.unit else ""
        axes.set_ylabel(f"{names} {unit}".strip() if alone else unit)
        if not alone or axes is panels[0]:
            _legend(axes, picture, over_parameter, with_marks=axes is panels[0])
    figure.align_ylabels(panels)
    panels[-1].set_xlabel(x.words)
    panels[0].set_title(picture.title)
    return figure


def _in_plane(picture: Picture) -> Figure:
    figure = _figure(_PLANE)
    axes = figure.subplots()
    (panel,) = picture.panels
    for x, y in zip(picture.x, panel.curves, strict=True):
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
    axes.set_ylabel(_axis(panel.curves))
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
    for (_, rows), shape in zip(picture.doubtful, _DOUBTFUL, strict=False):
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
    for (words, _), shape in zip(picture.doubtful, _DOUBTFUL, strict=False):
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
