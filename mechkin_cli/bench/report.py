"""What was found, and its files: the machine; tables as data for programs, as text for a person, as
CSV and as Markdown; records as JSON, the page, the figure.

The figure shows time per position against error, a panel for each mechanism. Both axes are
logarithmic, both the same in all panels; nearer to the lower left corner is better. Numbers are
written with one decimal, so that the same records give the same bytes. Colours follow the reader's
light or dark scheme.
"""

from __future__ import annotations

import csv
import platform
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from io import StringIO
from math import floor, log10
from pathlib import Path
from statistics import median
from typing import Any, Literal, NamedTuple

import numpy as np

from mechkin_cli.bench.measurement import Bench, Measurement
from mechkin_cli.bench.methods import ANALYZED, FAMILY, FOLLOWED, UNIT
from mechkin_cli.kernel.functions import widths
from mechkin_cli.tables import json_text
from mechkin_cli.verdict import versions


def machine() -> dict[str, str]:
    """Processor, lane widths, and the versions that matter, by name."""
    return {
        "processor": _processor(),
        "lanes": "/".join(map(str, widths())),
        "Python": platform.python_version(),
        "numpy": np.__version__,
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


Cell = str | float | int | bool | None
Kind = Literal["text", "time", "error", "ratio", "percent", "number", "verdict"]


@dataclass(frozen=True)
class ReportColumn:
    """`key` names the column for programs, `label` (which may have two lines) for a person."""

    key: str
    label: str
    kind: Kind = "text"


@dataclass(frozen=True)
class ReportTable:
    """One part of the report; each row maps column keys to values."""

    name: str
    title: str
    columns: Sequence[ReportColumn]
    rows: Sequence[Mapping[str, Cell]]
    notes: Sequence[str] = field(default_factory=tuple)

    def record(self) -> dict[str, object]:
        """As plain data."""
        return {
            "title": self.title,
            "rows": [{c.key: row.get(c.key) for c in self.columns} for row in self.rows],
            "notes": list(self.notes),
        }

    def texts(self) -> list[list[str]]:
        """The cells as text, row by row."""
        return [[cell_text(row.get(c.key), c.kind) for c in self.columns] for row in self.rows]


def key_of(name: str) -> str:
    """A mechanism's name as part of a table's name: letters and digits, the rest as underscores."""
    return "".join(c if c.isalnum() else "_" for c in name.lower())


def cell_text(value: Cell, kind: Kind) -> str:
    """A cell for a person; nothing is an empty text."""
    if value is None:
        return ""
    if kind == "verdict":
        return "yes" if value else "no"
    if isinstance(value, str) or kind == "text":
        return str(value)
    if kind == "time":
        return _significant(value)
    if kind == "error":
        return f"{value:.1e}"
    if kind == "percent":
        return f"{100.0 * value:.0f}"
    return f"{value:.2f}" if kind == "ratio" else f"{value:.10g}"


def _significant(value: float) -> str:
    """Three significant digits without an exponent."""
    if value >= 100.0:
        return f"{value:.0f}"
    return f"{value:.1f}" if value >= 10.0 else f"{value:.2f}" if value >= 1.0 else f"{value:.3f}"


def plain_text(table: ReportTable) -> str:
    """Aligned columns, numbers to the right."""
    labels = [column.label.split("\n") for column in table.columns]
    depth = max(map(len, labels))
    head = [[""] * (depth - len(label)) + label for label in labels]
    lines = [list(line) for line in zip(*head, strict=True)] + table.texts()
    widths = [max(len(line[i]) for line in lines) for i in range(len(table.columns))]
    text = [table.title, ""]
    for line in lines:
        cells = [
            cell.ljust(width) if column.kind == "text" else cell.rjust(width)
            for cell, width, column in zip(line, widths, table.columns, strict=True)
        ]
        text.append("  ".join(cells).rstrip())
    return "\n".join([*text, *([""] if table.notes else []), *table.notes]) + "\n"


COLUMNS = (
    ReportColumn("family", "by"),
    ReportColumn("curve", "method"),
    ReportColumn("setting", "setting"),
    ReportColumn("microseconds", "us per\nrow", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nkernel", "time"),
    ReportColumn("position", "error:\nposi-\ntion", "error"),
    ReportColumn("velocity", "velo-\ncity", "error"),
    ReportColumn("acceleration", "acceler-\nation", "error"),
    ReportColumn("loads", "\nloads", "error"),
)
NOTES = (
    "times kernel: against one call of the kernel for the same quantities, in the same rounds.",
    "errors: largest, in parts of the quantity's largest value.",
)


def bench_table(bench: Bench) -> ReportTable:
    """Every method at every setting, and what could not run."""
    rows = [m.record() for m in bench.measurements]
    scene, chain = bench.scene, bench.scene.chain
    skipped = [f"{family} is left out: {why}" for family, why in bench.skipped.items()]
    title = (
        f"{scene.name}: {scene.result.rows} rows, {chain.equations} equations in "
        f"{len(chain.unknowns)} unknowns"
    )
    exact = f"exact: {bench.exact}."
    name = "bench_" + key_of(scene.name)
    return ReportTable(name, title, COLUMNS, rows, (*NOTES, exact, *skipped))


def csv_text(benches: Iterable[Bench]) -> str:
    """All measurements, one line each."""
    stream = StringIO()
    names = list(Measurement.__dataclass_fields__)
    writer = csv.DictWriter(stream, names, lineterminator="\n")
    writer.writeheader()
    for bench in benches:
        for m in bench.measurements:
            cells = {k: "" if v is None else v for k, v in m.record().items()}
            writer.writerow({k: repr(v) if isinstance(v, float) else v for k, v in cells.items()})
    return stream.getvalue()


def markdown(table: ReportTable) -> str:
    """A table as Markdown, notes below."""
    # a word that a line end divides is whole again
    whole = [re.sub(r"(?<=[a-z])-\n", "", column.label) for column in table.columns]
    labels = [" ".join(label.split()) for label in whole]
    sides = ["---" if c.kind == "text" else "---:" for c in table.columns]
    lines = [f"### {table.title}", "", _line(labels), _line(sides)]
    lines += [_line(cells) for cells in table.texts()]
    notes = " ".join(table.notes)
    return "\n".join([*lines, "", *([notes, ""] if notes else [])])


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


PANEL_WIDTH, PANEL_HEIGHT = 262.0, 176.0
MARGIN_LEFT, MARGIN_TOP, GAP_X, GAP_Y = 62.0, 58.0, 20.0, 44.0
LEGEND_LINE, BELOW = 20.0, 46.0
PER_ROW, LEGEND_COLUMNS = 3, 3

LEAST_ERROR, LARGEST_ERROR = -16.5, 0.5
"""Decimal exponents of the errors' axis; what is beyond stands on the edge."""

STYLE = """\
text{font:12px system-ui,sans-serif;fill:#24292f}
.bg{fill:#ffffff}.frame{fill:none;stroke:#8c959f}.grid{stroke:#d8dee4}
.small{font-size:10.5px}.title{font-weight:600}.head{font-size:15px;font-weight:600}
path{fill:none;stroke-width:2}.grid{stroke-width:1}
@media (prefers-color-scheme:dark){text{fill:#e6edf3}.bg{fill:#0d1117}
.frame{stroke:#6e7681}.grid{stroke:#30363d}}
"""


class FigureCurve(NamedTuple):
    """A curve of the figure: which measurements, its words, its colours on light and on dark."""

    name: str
    words: str
    light: str
    dark: str


SPACED = "mechkin: followed and closed, by spacing"
CURVES = (
    FigureCurve("kernel, by tolerance", "mechkin: kernel, by tolerance", "#0550ae", "#6cb6ff"),
    FigureCurve("sweep, by skeleton spacing", SPACED, "#1a7f7a", "#56d4cf"),
    FigureCurve("sweep, verdicts", "mechkin: analyze, with verdicts", "#116329", "#57d364"),
    FigureCurve("compiled Newton", "CasADi: compiled Newton, by steps", "#8250df", "#d2a8ff"),
    FigureCurve("Newton on its Jacobians", "Pinocchio: Newton, by steps", "#9a6700", "#e3b341"),
    FigureCurve("fsolve", "scipy: fsolve, by tolerance", "#bc4c00", "#ffa657"),
    FigureCurve("least_squares", "scipy: least_squares, by tolerance", "#a40e26", "#ff7b72"),
    FigureCurve("Euler's method", "explicit stepping: Euler", "#57606a", "#b1bac4"),
    FigureCurve("Runge-Kutta method", "explicit stepping: Runge-Kutta", "#6e5494", "#a5a2ff"),
    FigureCurve("constrained steps", "MuJoCo: steps in time, by step", "#bf3989", "#ff9bce"),
)
"""In the order of the legend."""


Panel = tuple[str, Sequence[Measurement]]
"""A mechanism's name and what was measured of it."""


class Axis(NamedTuple):
    """A logarithmic axis: decimal exponents of its ends, and where these lie."""

    low: float
    high: float
    first: float
    last: float

    def at(self, exponent: float) -> float:
        """The place of a power of ten, on the edge where it lies beyond."""
        inside = min(max(exponent, self.low), self.high)
        share = (inside - self.low) / (self.high - self.low)
        return self.first + share * (self.last - self.first)


def svg(panels: Sequence[Panel]) -> str:
    """The figure as one file."""
    points = [m for _, measured in panels for m in measured if _is_shown(m)]
    if not points:
        return _page(320.0, 60.0, [_text(16.0, 34.0, "nothing to show", "head")], ())
    times = [log10(m.microseconds) for m in points]
    low, high = floor(min(times)), floor(max(times)) + 1
    used = [c for c in CURVES if any(m.curve == c.name for m in points)]
    columns = min(PER_ROW, len(panels))
    lines = -(-len(panels) // columns)
    width = MARGIN_LEFT + columns * (PANEL_WIDTH + GAP_X) + GAP_X
    width = max(width, MARGIN_LEFT + PER_ROW * PANEL_WIDTH)
    bottom = MARGIN_TOP + lines * (PANEL_HEIGHT + GAP_Y)
    parts = [_text(MARGIN_LEFT, 26.0, "Time per position against its error", "head")]
    for number, panel in enumerate(panels):
        left = MARGIN_LEFT + (number % columns) * (PANEL_WIDTH + GAP_X)
        top = MARGIN_TOP + (number // columns) * (PANEL_HEIGHT + GAP_Y)
        x = Axis(LEAST_ERROR, LARGEST_ERROR, left, left + PANEL_WIDTH)
        y = Axis(low, high, top + PANEL_HEIGHT, top)
        parts += _panel(panel, x, y, used, labelled=number % columns == 0)
    middle = (MARGIN_TOP + bottom - GAP_Y) / 2.0
    parts.append(
        f'<text class="small" text-anchor="middle" transform="translate(14.0 {middle:.1f}) '
        'rotate(-90)">microseconds per position</text>'
    )
    said = "largest error of a position, in parts of the quantity's largest value"
    parts.append(_text(MARGIN_LEFT, bottom - 4.0, said, "small"))
    step = (width - MARGIN_LEFT) / LEGEND_COLUMNS
    for number, curve in enumerate(used):
        left = MARGIN_LEFT + (number % LEGEND_COLUMNS) * step
        top = bottom + 18.0 + (number // LEGEND_COLUMNS) * LEGEND_LINE
        mark = CURVES.index(curve)
        parts.append(f'<path class="c{mark}" d="M{left:.1f} {top:.1f}h22"/>')
        parts.append(f'<circle class="p{mark}" cx="{left + 11:.1f}" cy="{top:.1f}" r="3"/>')
        parts.append(_text(left + 28.0, top + 4.0, curve.words, "small"))
    height = bottom + BELOW + LEGEND_LINE * (-(-len(used) // LEGEND_COLUMNS) - 1)
    return _page(width, height, parts, used)


def _panel(
    panel: Panel, x: Axis, y: Axis, used: Iterable[FigureCurve], *, labelled: bool
) -> list[str]:
    name, measured = panel
    parts = [_text(x.first, y.last - 7.0, name, "title")]
    for exponent in range(int(y.low), int(y.high) + 1):
        at = y.at(exponent)
        parts.append(f'<path class="grid" d="M{x.first:.1f} {at:.1f}H{x.last:.1f}"/>')
        if labelled and exponent % 2 == 0:
            parts.append(_text(x.first - 6.0, at + 4.0, _power(exponent), "small", "end"))
    for exponent in range(-16, 1, 4):
        at = x.at(exponent)
        parts.append(f'<path class="grid" d="M{at:.1f} {y.first:.1f}V{y.last:.1f}"/>')
        words = "1" if exponent == 0 else f"1e{exponent}"
        parts.append(_text(at, y.first + 14.0, words, "small", "middle"))
    size = f'width="{x.last - x.first:.1f}" height="{y.first - y.last:.1f}"'
    parts.append(f'<rect class="frame" x="{x.first:.1f}" y="{y.last:.1f}" {size}/>')
    for curve in used:
        own = [m for m in measured if m.curve == curve.name and _is_shown(m)]
        places = [(x.at(log10(m.position or 1.0)), y.at(log10(m.microseconds))) for m in own]
        mark = CURVES.index(curve)
        if len(places) > 1:
            line = "L".join(f"{a:.1f} {b:.1f}" for a, b in places)
            parts.append(f'<path class="c{mark}" d="M{line}"/>')
        parts += [f'<circle class="p{mark}" cx="{a:.1f}" cy="{b:.1f}" r="3"/>' for a, b in places]
    return parts


def _is_shown(m: Measurement) -> bool:
    return m.level == "position" and bool(m.position) and m.microseconds > 0.0


def _power(exponent: int) -> str:
    return f"1e{exponent}" if exponent < 0 or exponent > 3 else f"{10**exponent}"


def _text(x: float, y: float, words: str, kind: str, anchor: str = "start") -> str:
    safe = words.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    at = f'x="{x:.1f}" y="{y:.1f}"'
    return f'<text class="{kind}" {at} text-anchor="{anchor}">{safe}</text>'


def _page(width: float, height: float, parts: Sequence[str], used: Iterable[FigureCurve]) -> str:
    marks = [(CURVES.index(curve), curve) for curve in used]
    light = "".join(f".c{k}{{stroke:{c.light}}}.p{k}{{fill:{c.light}}}" for k, c in marks)
    dark = "".join(f".c{k}{{stroke:{c.dark}}}.p{k}{{fill:{c.dark}}}" for k, c in marks)
    style = f"{STYLE}{light}\n@media (prefers-color-scheme:dark){{{dark}}}\n"
    size = f'width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.0f} {height:.0f}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img">'
    title = "<title>Time per position against its error, a curve for each method</title>"
    back = f'<rect class="bg" width="{width:.0f}" height="{height:.0f}"/>'
    return "\n".join([head, title, f"<style>{style}</style>", back, *parts, "</svg>", ""])


MOTION = ("position", "velocity", "acceleration")
SAME = 10.0
"""Errors within this factor count as the same."""

FASTER = {
    "kernel_ratio": "the kernel alone is",
    "followed_ratio": "a sweep followed and closed",
    "sweep_ratio": "`analyze` with all that it does besides",
}

COMPILED = "CasADi"
COMPILED_NOTE = (
    "CasADi's code takes a second and more to compile for every mechanism, which is not",
    "counted; it neither follows nor judges.",
)
"""Where it is among the methods."""

BEST_COLUMNS = (
    ReportColumn("scene", "mechanism"),
    ReportColumn("level", "asked for"),
    ReportColumn("peer", "fastest other method as exact"),
    ReportColumn("peer_error", "its error", "error"),
    ReportColumn("peer_us", "us per row", "time"),
    ReportColumn("own_error", "mechkin's error", "error"),
    ReportColumn("sweep_us", "`analyze` with verdicts, us per row", "time"),
    ReportColumn("sweep_ratio", "times faster", "time"),
    ReportColumn("followed_us", "followed and closed, us per row", "time"),
    ReportColumn("followed_ratio", "times faster", "time"),
    ReportColumn("kernel_us", "kernel alone, us per row", "time"),
    ReportColumn("kernel_ratio", "times faster", "time"),
)


def best_table(benches: Sequence[Bench]) -> ReportTable:
    """For positions and for the motion: the fastest other method whose error is no more than ten
    times that of mechkin's sweep."""
    levels = ("position", "motion")
    rows = [row for bench in benches for level in levels for row in _best(bench, level)]
    families = {m.family for bench in benches for m in bench.measurements}
    notes = (
        "as exact: every error at most ten times that of mechkin's sweep with its verdicts.",
        "`analyze` finds the first assembly, follows, closes and judges every row. Followed and",
        "closed: its two calls of the kernel.",
        *_beside(benches),
        "Kernel alone: guesses are given.",
        *(COMPILED_NOTE if COMPILED in families else ()),
    )
    return ReportTable(
        "ahead", "The fastest other method that is as exact", BEST_COLUMNS, rows, notes
    )


def _beside(benches: Iterable[Bench]) -> list[str]:
    """What `analyze` of the positions takes beside its two calls of the kernel, in words."""
    beside = []
    for bench in benches:
        own = {m.curve: m for m in bench.measurements if m.setting == "position"}
        if ANALYZED in own and FOLLOWED in own:
            us = own[ANALYZED].microseconds - own[FOLLOWED].microseconds
            beside.append(1e-3 * us * bench.scene.result.rows)
    if not beside:
        return []
    return [
        f"Beside them `analyze` takes {cell_text(median(beside), 'time')} ms, the median over the",
        "mechanisms, however few the rows are.",
    ]


def summary(table: ReportTable) -> str:
    """What `best_table` says, in a sentence."""
    parts = []
    for key, words in FASTER.items():
        found = [v for v in (row.get(key) for row in table.rows) if isinstance(v, float)]
        if found:
            low, high = (cell_text(end(found), "time") for end in (min, max))
            parts.append(f"{words} {low} to {high} times")
    if not parts:
        return "No other method was measured."
    return (
        "Against the fastest other method whose error is at most ten times as large, over all "
        "mechanisms and levels: "
        f"{', '.join(parts)} as fast. Below 1 the other method is faster."
    )


def _best(bench: Bench, level: str) -> list[dict[str, Cell]]:
    own = {m.curve: m for m in bench.measurements if m.family == FAMILY and m.setting == level}
    others = [m for m in bench.measurements if m.family != FAMILY and m.level == level]
    if not others:
        return []
    sweep = own[ANALYZED]
    limits = {kind: SAME * (getattr(sweep, kind) or 0.0) for kind in MOTION}

    def is_exact(m: Measurement) -> bool:
        return all((getattr(m, kind) or 0.0) <= limits[kind] for kind in MOTION if limits[kind])

    row: dict[str, Cell] = {"scene": bench.scene.name, "level": level, "own_error": _worst(sweep)}
    row["peer"] = "none"
    exact = [m for m in others if is_exact(m)]
    peer = min(exact, key=lambda m: m.microseconds, default=None)
    if peer is not None:
        row["peer"] = f"{peer.family}, {peer.curve}, {peer.setting}"
        row |= {"peer_error": _worst(peer), "peer_us": peer.microseconds}
    for key, curve in (("sweep", ANALYZED), ("followed", FOLLOWED), ("kernel", UNIT)):
        if curve in own:
            row[f"{key}_us"] = own[curve].microseconds
            if peer is not None:
                row[f"{key}_ratio"] = peer.microseconds / own[curve].microseconds
    return [row]


def _worst(m: Measurement) -> float | None:
    found = [e for e in (m.position, m.velocity, m.acceleration) if e is not None]
    return max(found, default=None)


def page(
    machine: Mapping[str, str],
    benches: Sequence[Bench],
    tables: Iterable[ReportTable],
    figure: str,
    command: str,
) -> str:
    """The page as Markdown; `figure` is where the picture lies, `command` what made it."""
    said = ", ".join(f"{name} {value}" for name, value in machine.items())
    best, tables = best_table(benches), list(tables)
    head = [
        "# What mechkin costs, and what it is worth",
        "",
        "How long does a position take, and how far is it from the true one, here and with other",
        "libraries? Every method gets the same tree of joints and the same closing joints. The",
        "other libraries start each row from the row before, as a script would. Errors are true",
        "errors, against double-double arithmetic from the file's text.",
        "",
        f"Made by `{command}` on {said};",
        "one thread, unless a line says otherwise. Times are medians of rounds in which all",
        "methods of a table take turns, and `+-` is half the distance of the quartiles. On another",
        "machine times differ, ratios less.",
        "",
        "*Kernel* is the compiled core, given first guesses; *followed and closed* also follows",
        "the branch from row to row; *`analyze`* also finds the first assembly and judges every",
        "row; *process* is the whole command, with Python's start and the reading of the file.",
        "",
        f"![time per position against error]({figure})",
        "",
        summary(best),
        "",
        markdown(best),
    ]
    rest = [markdown(table) for table in tables]
    rest += [markdown(bench_table(bench)) for bench in benches]
    return "\n".join([*head, *rest])


NAMES = {"json": "bench.json", "csv": "bench.csv", "page": "bench.md", "figure": "bench.svg"}


def record(
    machine: Mapping[str, str], benches: Sequence[Bench], tables: Sequence[ReportTable]
) -> dict[str, Any]:
    """The run as plain data: `mechanisms` with their measurements, then the tables by name."""
    return versions() | {
        "machine": dict(machine),
        "mechanisms": [bench.record() for bench in benches],
        "tables": {table.name: table.record() for table in (best_table(benches), *tables)},
    }


def figure(benches: Sequence[Bench]) -> str:
    """The figure of a run."""
    return svg([(bench.scene.name, bench.measurements) for bench in benches])


def write(
    folder: Path,
    machine: Mapping[str, str],
    benches: Sequence[Bench],
    tables: Sequence[ReportTable],
    command: str,
) -> list[Path]:
    """Writes all four files into a folder that is there and says where they are.

    Raises:
        OSError: the folder takes no file.
    """
    texts = {
        "json": json_text(record(machine, benches, tables)),
        "csv": csv_text(benches),
        "page": page(machine, benches, tables, NAMES["figure"], command),
        "figure": figure(benches),
    }
    paths = {folder / NAMES[kind]: text for kind, text in texts.items()}
    for path, text in paths.items():
        path.write_text(text, encoding="utf-8", newline="\n")
    return list(paths)
