"""A stretch of a study's variants: `Model.vary`, and its rows made into records."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import InvalidFile, MechkinError
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.studies.formats import Records, Values, empty_values
from mechkin_cli.tables import REDUCTIONS, Heading, mean, root_mean_square
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.variants import vary, with_parameters
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from mechkin_cli.analysis import Solvable
    from mechkin_cli.show import Floats
    from mechkin_cli.variants import Variants

    Codes = NDArray[np.int8]
    """Of `Status` (variants, rows)."""

LONGEST_MESSAGE = 300


def messages(
    found: Variants,
    codes: Codes,
    texts: Iterable[str],
    along: Heading | None,
    places: Floats | None,
) -> Values:
    """Why variants are not ok (variants,), "" of those that are: what was said where one cannot be
    built, else the verdict of the first row that is not ok, with what is infinite.

    Args:
        found: all rows of the variants.
        codes: their verdicts.
        texts: quantities that are kept.
        along: what the run goes along, None where nothing moves.
        places: its values in the rows (variants, rows).
    """
    texts_of = empty_values("text", len(found))
    not_ok = codes != Status.ok
    infinite = _infinite(found, codes, texts)
    for number in np.flatnonzero(not_ok.any(axis=1)).tolist():
        row = int(np.argmax(not_ok[number]))
        place = "" if places is None else _place(along, float(places[number, row]))
        reason = _reason(Status(int(codes[number, row])))
        text = f"row {row + 1}{place}: {reason}{infinite.get(number, '')}"
        texts_of[number] = text[:LONGEST_MESSAGE]
    for number, error in found.errors.items():
        texts_of[number] = _error_text(error)
    return texts_of


def _reason(status: Status) -> str:
    """Without what becomes of cells where those that are infinite are named."""
    sentence = status.sentence.rstrip(".")
    return sentence.partition(":")[0] if status is Status.dead_centre else sentence


def _infinite(found: Variants, codes: Codes, texts: Iterable[str]) -> dict[int, str]:
    """Kept quantities that are infinite, and in which row first, by the number of the variant."""
    at = codes == Status.dead_centre
    numbers = np.flatnonzero(at.any(axis=1))
    words: dict[int, str] = {}
    for text in texts if numbers.size else ():
        rows = np.isinf(found[text][numbers])
        for number, where in zip(numbers.tolist(), rows, strict=True):
            if where.any():
                before = f"{words[number]}, " if number in words else "; infinite: "
                words[number] = f"{before}{text} in row {int(np.argmax(where)) + 1}"
    return words


def _place(along: Heading | None, place: float) -> str:
    if along is None or np.isnan(place):
        return ""
    return f" ({along.label} = {place:.9g} {along.unit}".rstrip() + ")"


def _error_text(error: MechkinError) -> str:
    text = str(error)
    if isinstance(error, InvalidFile):
        first = next((d for d in error.diagnostics if d.severity == "error"), None)
        text = str(first._replace(place=None)) if first is not None else text
    return " ".join(text.split())[:LONGEST_MESSAGE]


VARIANT = Heading("variant", kind="whole")
ROW = Heading("row", kind="whole")
DEAD_CENTRE = "dead_centre"
VERDICTS = (
    Heading("rows_not_ok", kind="whole"),
    Heading("verdict", kind="text"),
    Heading("message", kind="text"),
)
"""Columns of every variant beside what is asked for."""

NOT_BUILT, WORKER_DIED = "not-built", "worker-died"
"""Verdicts of variants without rows."""

VALUE = "value"
PLACES: Mapping[str, Callable[[Floats], Floats]] = {
    "place_of_max": lambda values: values,
    "place_of_min": np.negative,
    "place_of_peak": np.abs,
}
"""Words for places, and that whose largest value stands there."""


class StudyColumn(NamedTuple):
    """A column of variants: a word of `keep:` for a quantity; `at` is the place of `value`, in the
    file's units."""

    heading: Heading
    text: str
    word: str
    at: float = float("nan")


@dataclass(frozen=True)
class StudyQuestion:
    """What a study asks of every variant.

    Attributes:
        run: of the mechanism.
        parameter: what the run goes along, None where nothing moves.
        parameters: headings of what varies.
        columns: of variants.
        rows: headings of quantities of which all rows are kept, their labels the quantities.
        dead_centre: heading of the place at which a branch ends; None: not asked.
    """

    run: str
    parameter: Heading | None
    parameters: tuple[Heading, ...]
    columns: tuple[StudyColumn, ...]
    rows: tuple[Heading, ...]
    dead_centre: Heading | None

    @property
    def tables(self) -> dict[str, tuple[Heading, ...]]:
        """Headings of `variants` and, where rows are kept, of `rows`."""
        own = tuple(column.heading for column in self.columns)
        ends = () if self.dead_centre is None else (self.dead_centre,)
        found = {"variants": (VARIANT, *self.parameters, *own, *ends, *VERDICTS)}
        if self.rows:
            along = () if self.parameter is None else (self.parameter,)
            others = tuple(heading for heading in self.rows if heading not in along)
            found["rows"] = (VARIANT, ROW, *along, *others, VERDICTS[1])
        return found


def chunk(
    model: Solvable, question: StudyQuestion, values: Mapping[str, Floats], begin: int, threads: int
) -> dict[str, Records]:
    """Records of variants with these values (variants,) by name, in the file's units, by name of
    table; the first variant has the number `begin`."""
    found, places = _varied(model, question, values, threads)
    count, codes = len(found), found.codes
    records: Records = {VARIANT.label: np.arange(begin, begin + count, dtype=np.int64)}
    records |= {name: np.asarray(column, dtype=np.float64) for name, column in values.items()}
    for column in question.columns:
        records[column.heading.label] = _reduced(found[column.text], column, places)
    words = np.array([status.label for status in Status], dtype=object)
    not_ok = codes != Status.ok
    records[VERDICTS[0].label] = np.count_nonzero(not_ok, axis=1).astype(np.int64)
    verdicts = words[codes[np.arange(count), np.argmax(not_ok, axis=1)]]
    verdicts[list(found.errors)] = NOT_BUILT
    if question.dead_centre is not None:
        records[question.dead_centre.label] = _dead_centres(model, values, codes, places)
    records[VERDICTS[1].label] = verdicts
    texts = dict.fromkeys(
        [column.text for column in question.columns] + [h.label for h in question.rows]
    )
    records[VERDICTS[2].label] = messages(found, codes, texts, question.parameter, places)
    tables = {"variants": records}
    if question.rows:
        tables["rows"] = _rows(question, found, codes, places, begin, words)
    return tables


def lost(question: StudyQuestion, values: Mapping[str, Floats], begin: int) -> dict[str, Records]:
    """The records of variants that their worker has died of."""
    count = len(next(iter(values.values())))
    tables = {
        name: {h.label: empty_values(h.kind, count if name == "variants" else 0) for h in headings}
        for name, headings in question.tables.items()
    }
    variants = tables["variants"]
    variants[VARIANT.label] = np.arange(begin, begin + count, dtype=np.int64)
    variants |= {name: np.asarray(column, dtype=np.float64) for name, column in values.items()}
    variants[VERDICTS[1].label][:] = WORKER_DIED
    variants[VERDICTS[2].label][:] = "the process that computed this variant died of it, every time"
    return tables


def _varied(
    model: Solvable, question: StudyQuestion, values: Mapping[str, Floats], threads: int
) -> tuple[Variants, Floats | None]:
    """The variants, with all rows of what is asked for; and the places of the rows."""
    asked = [column.text for column in question.columns] + [
        heading.label for heading in question.rows
    ]
    if question.parameter is not None:
        asked.append(question.parameter.label)
    found = vary(model, values, list(dict.fromkeys(asked)), run=question.run, threads=threads)
    if question.parameter is None:
        return found, None
    return found, found[question.parameter.label]


def _reduced(values: Floats, column: StudyColumn, places: Floats | None) -> Floats:
    """One number of the rows of every variant, (variants,)."""
    if column.word == VALUE:
        return _value_at(column.at, values, places)
    if column.word in PLACES:
        return _place_of_largest(PLACES[column.word](values), places)
    if column.word not in ("mean", "rms"):
        return REDUCTIONS[column.word](values)
    over = mean if column.word == "mean" else root_mean_square
    return over(values, places)


def _value_at(at: float, values: Floats, places: Floats | None) -> Floats:
    """The value in the first row that stands at a place; nan in variants without such a row."""
    if places is None:
        return np.full(len(values), np.nan)
    off = np.where(np.isnan(places), np.inf, np.abs(places - at))
    row = np.argmin(off, axis=1)
    every = np.arange(len(values))
    span = np.fmax.reduce(places, axis=1) - np.fmin.reduce(places, axis=1)
    return np.where(off[every, row] <= LAST_ROW * span, values[every, row], np.nan)


def _place_of_largest(sizes: Floats, places: Floats | None) -> Floats:
    """Where the first of the largest sizes stands; the number of the row where nothing moves."""
    there = ~np.isnan(sizes)
    row = np.argmax(np.where(there, sizes, -np.inf), axis=1)
    at = row + 1.0 if places is None else places[np.arange(len(row)), row]
    return np.where(there.any(axis=1), at, np.nan)


def _dead_centres(
    model: Solvable, values: Mapping[str, Floats], codes: Codes, places: Floats | None
) -> Floats:
    """The input at the dead centre at which a variant's branch ends, or at which a row stands, in
    the file's units; nan where it meets none."""
    stands = codes == Status.dead_centre
    ends = np.full(len(codes), np.nan)
    if places is not None and stands.any():
        first = _place_of_largest(stands.astype(np.float64), places)
        ends = np.where(stands.any(axis=1), first, np.nan)
    for number in np.flatnonzero((codes == Status.beyond_dead_centre).any(axis=1)):
        own = {name: float(column[number]) for name, column in values.items()}
        for diagnostic in with_parameters(model, own).analyze([], tables=[]).diagnostics:
            if diagnostic.code == "dead-centre" and diagnostic.numbers:
                ends[number] = diagnostic.numbers[0].value
    return ends


def _rows(
    question: StudyQuestion,
    found: Variants,
    codes: Codes,
    places: Floats | None,
    begin: int,
    words: NDArray[np.object_],
) -> Records:
    """All rows of all variants, one below the other; none behind the one at which a stop ends a
    response."""
    count, rows = codes.shape
    records: Records = {
        VARIANT.label: np.repeat(np.arange(begin, begin + count, dtype=np.int64), rows),
        ROW.label: np.tile(np.arange(1, rows + 1, dtype=np.int64), count),
    }
    if question.parameter is not None and places is not None:
        records[question.parameter.label] = places.reshape(-1)
    for heading in question.rows:
        records[heading.label] = found[heading.label].reshape(-1)
    records[VERDICTS[1].label] = words[codes.reshape(-1)]
    if places is not None and question.run != SWEEP:
        asked = ~(np.isnan(places) & (codes == Status.ok)).reshape(-1)
        records = {label: column[asked] for label, column in records.items()}
    return records
