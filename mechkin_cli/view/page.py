"""The page: the template built from `page/`, the data in it, and how much of a run it holds.

Data are JSON that stands in an HTML file: arrays in base64, row-major and little-endian, by their
type (`{"f32": ...}`, f64, i32, u8), and nothing that is markup. Where a run has more rows than a
page holds, it shows rows in even steps and those that must not be missed. At the end, what a file
leaves out and mechkin assumes, in sentences for the reader of the page.
"""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from mechkin_cli.diagnostics import legible
from mechkin_cli.mechanism import GROUND_NAME, is_written
from mechkin_cli.record import NamedTuple
from mechkin_cli.sweep import Readable
from mechkin_cli.units import LENGTH
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from mechkin_cli.building import Built, ViewSettings
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.modes import Modes
    from mechkin_cli.show import Floats
    from mechkin_cli.tables import Columns
    from mechkin_cli.units import UnitSystem

    Plain = dict[str, object]
    Numbers = NDArray[np.intp]


_TYPES = {"f32": "<f4", "f64": "<f8", "i32": "<i4", "u8": "|u1"}
_MARKUP = {ord("<"): "\\u003c", ord(">"): "\\u003e", ord("&"): "\\u0026"}


def packed(kind: Literal["f32", "f64", "i32", "u8"], values: ArrayLike) -> dict[str, str]:
    """An array of any shape.

    Example:
        >>> packed("i32", [1, 2])
        {'i32': 'AQAAAAIAAAA='}
    """
    array = np.ascontiguousarray(values, dtype=_TYPES[kind])
    return {kind: b64encode(array.tobytes()).decode("ascii")}


def script_json(data: Plain) -> str:
    r"""JSON in ASCII in which no text can end the script element that holds it, or begin another.

    Raises:
        ValueError: a number outside of arrays is not finite.

    Example:
        >>> script_json({"name": "</script>"})
        '{"name":"\\u003c/script\\u003e"}'
    """
    text = json.dumps(_shown(data), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.translate(_MARKUP)


def _shown(value: object) -> object:
    """Plain data whose texts hold no characters that do not print or that turn the line."""
    if isinstance(value, str):
        return legible(value)
    if isinstance(value, list):
        return [_shown(item) for item in value]
    if isinstance(value, dict):
        return {key: _shown(item) for key, item in value.items()}
    return value


PAGE_NAME = "view.html"
"""Name of the page where none is given: it stands beside the tables."""

TEMPLATE = Path(__file__).with_name("page.html")
PLACE = "/*mechkin-data*/null"
"""Where the data stand in the template, once."""


@cache
def template() -> str:
    """The text of the page without data."""
    return TEMPLATE.read_text(encoding="utf-8")


def filled(page: str, data: Plain) -> bytes:
    """The page with data in it, in UTF-8.

    Raises:
        ValueError: the page has no place for data, or several.
    """
    if page.count(PLACE) != 1:
        raise ValueError(
            f"the template of the page has {PLACE} {page.count(PLACE)} times, not once"
        )
    before, _, after = page.partition(PLACE)
    return (before + script_json(data) + after).encode("utf-8")


@cache
def waiting_page() -> bytes:
    """The page without data, which takes them from the page that holds it in a frame."""
    return template().replace(PLACE, "null", 1).encode("utf-8")


class Lengths:
    """Lengths (m) in the unit of one file."""

    def __init__(self, units: UnitSystem) -> None:
        self._units = units

    def one(self, value: float) -> float:
        """A length."""
        return float(self._units.from_si(float(value), LENGTH))

    def vector(self, point: Iterable[float]) -> list[float]:
        """A point or shift."""
        return [self.one(value) for value in point]

    def array(self, values: Floats) -> Floats:
        """A copy of an array."""
        return np.asarray(self._units.from_si(np.array(values), LENGTH), dtype=np.float64)


MOST_POSES = 2000
"""Poses of a branch: at 60 pictures a second half a minute of motion without a pose shown twice,
and 56 kB for each link."""

MOST_ROWS = 20_000
"""Rows of a branch that curves and tables show: more than any screen has points."""

MOST_CELLS = 400_000
"""Cells of the tables of a branch that are shown, and of those of all other modes together: 12 MB
as texts and numbers."""

LEAST_ROWS = 200
"""Rows of a branch that are shown however many columns and modes there are."""

MOST_MODES = 16
"""Assembly modes that are shown beside the file's own: more can hardly be distinguished by eye."""

MOST_MODE_ROWS = 100_000
"""Rows of all other assembly modes together: half a second of work for most mechanisms."""

MOST_MODE_POSES = 8000
"""Poses of all other assembly modes together, as many as of four runs."""

POINTS_APART = 0.001
"""Points of a link nearer to each other than this part of the mechanism's size are one."""

FLATNESS = 0.01
"""Points of a link lie in a line, or in a plane, where they are off by at most this part of their
extent: less than the thickness of what is drawn."""


Share = tuple[int, int]
"""The most rows, and the most poses, that a page shows of a branch."""


def shares(run: ShownRun) -> list[Share]:
    """The share of each branch of a run, in their order: the own branch has most."""
    others = len(run.branches) - 1
    columns = sum(len(table.columns) for table in run.own.tables)

    def rows(branches: int) -> int:
        return max(LEAST_ROWS, min(MOST_ROWS, MOST_CELLS // max(branches * columns, 1)))

    poses = min(MOST_POSES, MOST_MODE_POSES // max(others, 1))
    return [(rows(1), MOST_POSES), *[(rows(others), poses)] * others]


def thinned(rows: ArrayLike, most: int, keep: ArrayLike = ()) -> Numbers:
    """At most `most` (two or more) of rising row numbers: all if there are no more; else the first
    and the last, those of them to `keep`, up to half of what is left, and others in even steps.

    Example:
        >>> thinned(range(100), 5, keep=[60]).tolist()
        [0, 33, 60, 66, 99]
    """
    numbers = np.asarray(rows, dtype=np.intp)
    if numbers.size <= most:
        return numbers
    special = np.intersect1d(np.asarray(keep, dtype=np.intp), numbers)[: (most - 2) // 2]
    steps = np.linspace(0, numbers.size - 1, most - special.size)
    even = numbers[steps.round().astype(np.intp)]
    return np.union1d(even, special)


def turning_points(codes: ArrayLike) -> Numbers:
    """The rows on both sides of every change of a code.

    Example:
        >>> turning_points([0, 0, 0, 2, 2]).tolist()
        [2, 3]
    """
    changed = np.flatnonzero(np.diff(np.asarray(codes)))
    return np.union1d(changed, changed + 1).astype(np.intp)


def assumed(problem: Problem, runs: Sequence[ShownRun]) -> list[str]:
    """The sentences; those about a run are of its own branch."""
    sentences = [_units(problem.units), *_assemblies(runs), *_motion(problem, runs)]
    sentences += [*_bodies(problem), *_arrows(runs), *_idle(problem)]
    return list(dict.fromkeys(sentences))


def _units(units: UnitSystem) -> str:
    names = f"{units.length}, {units.angle}, {units.mass}, {units.force} and {units.time}"
    return f"Bare numbers are in {names}, angular rates in {units.angular_rate}."


def _assemblies(runs: Sequence[ShownRun]) -> Iterator[str]:
    for run in runs:
        result = run.own.result
        if result.how:
            yield f"{run.title}: the assembly at the first row is {result.how}."


def _motion(problem: Problem, runs: Sequence[ShownRun]) -> Iterator[str]:
    if not any(run.name == SWEEP for run in runs):
        return
    inputs = problem.motion.inputs
    still = [one.name for one in inputs if not np.any(one.rates)]
    if still:
        yield f"The rates of {', '.join(still)} are zero: none are given."
    if inputs and problem.mechanism.drives is None:
        names = ", ".join(one.name for one in inputs)
        yield f"Drives act at the inputs: {names}."


def _bodies(problem: Problem) -> Iterator[str]:
    mechanism = problem.mechanism
    links = [name for name in mechanism.links if name != GROUND_NAME and is_written(name)]
    light = [name for name in links if not mechanism.links[name].has_mass]
    if light and len(light) == len(links):
        yield "No link has mass."
    elif light:
        yield f"Links without mass: {', '.join(light)}."
    if not any(mechanism.gravity):
        yield "No gravity acts in the sweep." if problem.responses else "No gravity acts."
    yield "Bodies are rigid, and joints have no play."
    if not mechanism.frictions:
        yield "Joints do not rub."


def _arrows(runs: Sequence[ShownRun]) -> Iterator[str]:
    if any(run.forces for run in runs):
        yield (
            "Arrows at joints are what the first link exerts on the second, without the drive; one "
            "with axes behind its name, such as (x, y), has these components alone: redundant "
            "constraints leave the others arbitrary."
        )


def _idle(problem: Problem) -> Iterator[str]:
    for spin in problem.mechanism.spins:
        yield f"{spin.idle_words}: where it stands about that line is set by convention."
    for held in problem.held:
        yield f"{held.words}: {held.convention}."


# What a page shows: runs, their branches, and what it reads of `model.Analysis`.


class ShownAnalysis(Readable, Protocol):
    """An analysis whose model can be asked for the other assembly modes of its run."""

    @property
    def model(self) -> ShownModel:
        """Of the file."""
        ...


class ShownModel(Protocol):
    """What a page reads of a model."""

    @property
    def name(self) -> str:
        """The mechanism's name."""
        ...

    @property
    def built(self) -> Built:
        """The file, checked."""
        ...

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        ...

    @property
    def view_settings(self) -> ViewSettings:
        """How the file wants to be shown."""
        ...

    def modes(self, *, run: str | None = None) -> Modes:
        """All assembly modes at the first row of a run."""
        ...

    def live_record(self, analysis: Any, data: Any) -> dict[str, Any]:
        """What the page of a run computes it from with other parameters, or `why` it cannot."""
        ...

    def analyze(self, *, tables: Sequence[str], mode: str) -> ShownAnalysis:
        """Runs the sweep in a mode."""
        ...

    def run_free(self, name: str, *, tables: Sequence[str], mode: str) -> ShownAnalysis:
        """Runs a response, or finds equilibria, in a mode."""
        ...


class ShownRun(NamedTuple):
    """A run of the file in each of its assembly modes by name, the file's own one first, and its
    other tables; `forces`: whether arrows of forces may be read."""

    name: str
    title: str
    branches: Mapping[str, Readable]
    forces: bool = True
    tables: tuple[Columns, ...] = ()

    @property
    def own(self) -> Readable:
        """The run in the file's own mode."""
        return next(iter(self.branches.values()))
