"""A study as written to its variants and its question: every independent error at its place.

Variants are all combinations of the lists, of the lines of a table and of the samples. Of their
numbers, those of samples change fastest, then the table's, then the last list's.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Mapping
from functools import partial
from math import log2, prod
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import BadTable, Spacing, table_path, table_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Place, UsageError, nearest_hint
from mechkin_cli.expressions import ExpressionError, Quantity, Vector
from mechkin_cli.mechanism import response_problem
from mechkin_cli.record import dataclass, field
from mechkin_cli.schema import study as written
from mechkin_cli.studies.chunk import (
    DEAD_CENTRE,
    VALUE,
    VARIANT,
    VERDICTS,
    StudyColumn,
    StudyQuestion,
)
from mechkin_cli.studies.source import Faults, in_file_units, split
from mechkin_cli.tables import ROW_TEXTS, Heading, RunParameter
from mechkin_cli.tolerances import LAST_ROW, MOST_DRAWN, MOST_TABLE_TEXT, MOST_VARIANTS
from mechkin_cli.variants import (
    Draws,
    draws,
    has_scipy,
    needs_scipy,
    normal,
    sample_of,
    swept_parameter,
    uniform,
)
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis import Solvable
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.reading import Document, KeyPath
    from mechkin_cli.show import Floats


Distribution = Callable[["Floats"], "Floats"]
"""From samples (n,) between 0 and 1 to values (n,)."""


Samples = tuple[int, "Draws", Mapping[str, Distribution]]
"""How many are drawn, how, and the distribution of each parameter, in order of the dimensions."""


@dataclass(frozen=True)
class StudyVariation:
    """The variants of a study.

    Attributes:
        lists: values (n,) of a parameter, by name.
        together: lists go step by step, and have one length; else each with each.
        table: lines of values (n,), by name.
        samples: what is drawn.
    """

    lists: Mapping[str, Floats] = field(default_factory=dict)
    together: bool = False
    table: Mapping[str, Floats] = field(default_factory=dict)
    samples: Samples | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters that vary."""
        drawn = {} if self.samples is None else self.samples[2]
        return (*self.lists, *self.table, *drawn)

    @property
    def counts(self) -> tuple[int, int, int]:
        """Combinations of the lists, lines of the table, samples."""
        lengths = [len(values) for values in self.lists.values()]
        combinations = (lengths[0] if lengths else 1) if self.together else prod(lengths)
        lines = len(next(iter(self.table.values()))) if self.table else 1
        return combinations, lines, 1 if self.samples is None else self.samples[0]

    def __len__(self) -> int:
        return prod(self.counts)

    def values(self, begin: int, end: int) -> dict[str, Floats]:
        """Values of variants `begin` to `end` (without it), (variants,) by name."""
        _, lines, samples = self.counts
        numbers = np.arange(begin, end, dtype=np.int64)
        of_samples, rest = numbers % samples, numbers // samples
        of_lines, of_lists = rest % lines, rest // lines
        found = self._listed(of_lists)
        found |= {name: values[of_lines] for name, values in self.table.items()}
        return found | self._drawn(of_samples)

    def _listed(self, numbers: NDArray[np.int64]) -> dict[str, Floats]:
        if self.together:
            return {name: values[numbers] for name, values in self.lists.items()}
        found: dict[str, Floats] = {}
        for name, values in reversed(list(self.lists.items())):
            found[name] = values[numbers % len(values)]
            numbers = numbers // len(values)
        return {name: found[name] for name in self.lists}

    def _drawn(self, numbers: NDArray[np.int64]) -> dict[str, Floats]:
        if self.samples is None or not numbers.size:
            return {}
        first, last = int(numbers.min()), int(numbers.max()) + 1
        _, drawing, distributions = self.samples
        drawn = drawing(first, last)[numbers - first]
        return {n: shape(drawn[:, k]) for k, (n, shape) in enumerate(distributions.items())}


TOO_MANY = "too-many-variants"
_NOTHING = partial(uniform, least=0.0, most=0.0)


def unknown_parameter(model: Solvable, name: str) -> tuple[str, str]:
    """That there is no such parameter, and what to do."""
    known = list(model.problem.parameters)
    hint = nearest_hint(name, known) or f"parameters are {', '.join(known[:10])}"
    if not known:
        hint = "write parameters: into the mechanism file"
    return f"{model.name} has no parameter {name[:LONGEST_NAME]}", hint


class _VariationReader:
    """The variants that a study's sections describe; what is wrong with them goes to `faults`."""

    def __init__(self, file: written.StudyFile, model: Solvable, faults: Faults) -> None:
        self.file, self.model, self.faults = file, model, faults
        self.known = model.problem.parameters
        self.units = model.problem.units

    def variation(self) -> StudyVariation:
        lists: dict[str, Floats] = {}
        drawn: dict[str, Distribution] = {}
        for name, form in self.file.vary.items():
            if name not in self.known:
                error = unknown_parameter(self.model, name)
                self.faults.error("unknown-parameter", ("vary", name), *error, at_key=True)
            elif isinstance(form, tuple):
                values = [self._value(name, t, k) for k, t in enumerate(form)]
                lists[name] = np.array([value for value in values if value is not None])
            elif isinstance(form, written.RangeOfValues):
                lists[name] = self._range(name, form)
            else:
                drawn[name] = self._distribution(name, form)
            self._note_replaced(name, form)
        together = self.file.lists == "together"
        if together and len({len(values) for values in lists.values()}) > 1:
            words = ", ".join(f"{name} {len(values)}" for name, values in lists.items())
            text = f"lists that go together have different lengths: {words}"
            self.faults.error("list-lengths", ("lists",), text, "give them equally many values")
        table = self._table(self.file.table) if self.file.table is not None else {}
        variation = StudyVariation(lists, together, table, self._samples(drawn))
        if not self.faults.are_errors and len(variation) > MOST_VARIANTS:
            counts = " x ".join(str(n) for n in variation.counts if n > 1)
            text = f"the study has {len(variation)} variants, {counts} (limit {MOST_VARIANTS})"
            self.faults.error(TOO_MANY, ("vary",), text, "take fewer values, or draw them")
        return variation

    def _note_replaced(self, name: str, form: written.Variation) -> None:
        """A value that is set is the own value of a parameter, about which only some forms vary."""
        about_own = isinstance(form, written.Tolerance) or (
            isinstance(form, written.Normal) and form.mean is None
        )
        if name in self.file.set and not about_own:
            text = f"{name} is varied, so what set: gives it counts in no variant"
            self.faults.note("replaced-value", ("set", name), text, "remove one of the two")

    def _value(self, name: str, text: str, *keys: str | int) -> float | None:
        path: KeyPath = ("vary", name, *keys)
        return self.faults.value(path, name, text, self.known[name].dimension, self.units)

    def _own(self, name: str) -> float:
        """The mechanism's own value in the file's units."""
        quantity: Quantity = self.known[name]
        in_si = float(np.asarray(quantity.value))
        return self.units.from_si(in_si, quantity.dimension)

    def _range(self, name: str, form: written.RangeOfValues) -> Floats:
        first, last = self._value(name, form.first, "from"), self._value(name, form.last, "to")
        step = None if form.step is None else self._value(name, form.step, "step")
        if first is None or last is None or (form.step is not None and step is None):
            return np.empty(0)
        count = form.count
        if step is not None:
            if step == 0.0:
                self.faults.error("zero-step", ("vary", name, "step"), "the step is 0", "write one")
                return np.empty(0)
            steps = abs(last - first) / abs(step) + LAST_ROW
            count = int(min(steps, 2.0 * MOST_DRAWN)) + 1
        assert count is not None
        if count > MOST_DRAWN:
            path = ("vary", name, "count" if step is None else "step")
            text = f"{name} has too many values (limit {MOST_DRAWN})"
            self.faults.error(TOO_MANY, path, text, "take fewer, or draw them")
            return np.empty(0)
        if step is None:
            return Spacing(first, last, None, count).values()
        return Spacing(first, last, abs(step), count).values()

    def _distribution(
        self, name: str, form: written.Uniform | written.Normal | written.Tolerance
    ) -> Distribution:
        if isinstance(form, written.Normal):
            return self._normal(name, form)
        if isinstance(form, written.Uniform):
            key, texts = "between", form.between
        else:
            key, texts = "tolerance", form.tolerance
        places = [(key, k) if len(texts) == 2 else (key,) for k in range(len(texts))]
        found = [self._value(name, t, *place) for t, place in zip(texts, places, strict=True)]
        limits = [value for value in found if value is not None]
        if len(limits) < len(texts):
            return _NOTHING
        least, most = limits if len(limits) == 2 else (-limits[0], limits[0])
        if not least < most and len(texts) == 2:
            text, hint = f"there is nothing between {texts[0]} and {texts[1]}", "write the smaller"
            self.faults.error("bad-value", ("vary", name, key), text, f"{hint} limit first")
        elif not least < most:
            text, hint = f"the tolerance {texts[0]} is not larger than 0", "write a positive one"
            self.faults.error("bad-value", ("vary", name, key), text, hint)
        if isinstance(form, written.Uniform):
            return partial(uniform, least=least, most=most)
        own = self._own(name)
        if form.distribution == "uniform":
            return partial(uniform, least=own + least, most=own + most)
        return partial(normal, mean=own + 0.5 * (least + most), deviation=(most - least) / 6.0)

    def _normal(self, name: str, form: written.Normal) -> Distribution:
        mean = self._own(name) if form.mean is None else self._value(name, form.mean, "mean")
        deviation = self._value(name, form.deviation, "deviation")
        if mean is None or deviation is None:
            return _NOTHING
        if deviation <= 0.0:
            text = f"the standard deviation {form.deviation} is not larger than 0"
            path = ("vary", name, "deviation")
            self.faults.error("bad-value", path, text, "write a positive one")
        return partial(normal, mean=mean, deviation=deviation)

    def _samples(self, drawn: Mapping[str, Distribution]) -> Samples | None:
        sample = self.file.sample
        if sample is None or not drawn:
            return None
        if needs_scipy(sample.method, drawn.values()) and not has_scipy():
            text = "latin, sobol and normal distributions are drawn with scipy, which is not here"
            hint = "pip install 'mechkin[studies]', or draw evenly with method: random"
            self.faults.error("no-scipy", ("sample",), text, hint)
            return None
        path = ("sample", "count")
        if sample.count > MOST_VARIANTS:
            text = f"{sample.count} samples are too many (limit {MOST_VARIANTS})"
            self.faults.error(TOO_MANY, path, text, "take fewer")
            return None
        drawn_whole = sample.count * len(drawn)
        if sample.method == "latin" and drawn_whole > MOST_DRAWN:
            text = f"a Latin hypercube is drawn whole: {drawn_whole} numbers (limit {MOST_DRAWN})"
            self.faults.error(TOO_MANY, path, text, "take fewer samples, or method: sobol")
            return None
        if sample.method == "sobol" and sample.count & (sample.count - 1):
            text = "a Sobol sequence is balanced where its samples are a power of 2"
            self.faults.note("sobol-count", path, text, f"take {1 << round(log2(sample.count))}")
        return sample.count, draws(sample.method, sample.count, len(drawn), sample.seed), drawn

    def _table(self, name: str) -> dict[str, Floats]:
        """The lines of a CSV file with names of parameters above them."""
        document = self.faults.document
        file = str(table_path(document, name))
        try:
            if document.folder is None and name not in document.tables:
                text = "is sought beside the study file, but this study comes from no file"
                raise BadTable(0, 0, text, "give the values as lists that go together")
            return self._lines(table_text(document, name, MOST_TABLE_TEXT))
        except BadTable as bad:
            text, hint = bad.message, bad.hint
            if bad.line == 0:
                self.faults.error("csv-table", ("table",), f"{file} {text}", hint)
            else:
                place = Place(file, bad.line, bad.column)
                found = Diagnostic("csv-table", "error", text, place, hint=hint)
                self.faults.diagnostics.append(found)
            return {}

    def _lines(self, text: str) -> dict[str, Floats]:
        lines = list(csv.reader(io.StringIO(text, newline="")))
        labels = [cell.strip() for cell in lines[0]] if lines else []
        for number, label in enumerate(labels):
            if label not in self.known:
                raise BadTable(1, 1, *unknown_parameter(self.model, label))
            if label in labels[:number]:
                raise BadTable(1, 1, f"{label} stands there twice", "name each parameter once")
            if label in self.file.vary:
                raise BadTable(1, 1, f"{label} varies in vary:, too", "remove one of them")
        rows = []
        for number, cells in enumerate(lines[1:], start=2):
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(labels):
                text = f"this line has {len(cells)} cells, not {len(labels)}"
                raise BadTable(number, 1, text, "give every parameter a value")
            rows.append([self._cell(number, *pair) for pair in zip(labels, cells, strict=True)])
        if not rows:
            raise BadTable(1, 1, "there is no variant below the header", "add a line")
        return dict(zip(labels, np.array(rows).T, strict=True))

    def _cell(self, line: int, name: str, text: str) -> float:
        try:
            return in_file_units(name, text, self.known[name].dimension, self.units)
        except UsageError as error:
            raise BadTable(line, 1, *split(error)) from None


def study_plan(
    file: written.StudyFile, document: Document, model: Solvable
) -> tuple[StudyVariation, StudyQuestion, tuple[Diagnostic, ...]]:
    """The variants of a study of a model, what is asked of each, and notes.

    Raises:
        InvalidFile: with every independent error and its place.
    """
    faults = Faults(document)
    variation = _VariationReader(file, model, faults).variation()
    question = _QuestionReader(file, model, faults).question(variation)
    return variation, question, faults.notes()


class _QuestionReader:
    """What a study asks of its variants; what is wrong with that goes to `faults`."""

    def __init__(self, file: written.StudyFile, model: Solvable, faults: Faults) -> None:
        self.file, self.model, self.faults = file, model, faults
        self.run = self._run()
        whole = model.problem
        is_sweep = self.run == SWEEP
        self.problem: Problem = (
            whole if is_sweep else response_problem(whole, whole.responses[self.run])
        )
        self.along = self._along()

    def question(self, variation: StudyVariation) -> StudyQuestion:
        """The question of a study with these variants."""
        known, label = self.problem.parameters, self.problem.units.label
        names = variation.names
        parameters = tuple(Heading(name, label(known[name].dimension)) for name in names)
        taken = {VARIANT.label, DEAD_CENTRE, *names, *(heading.label for heading in VERDICTS)}
        columns = [
            column
            for number, section in enumerate(self.file.keep)
            for column in self._columns(("keep", number), section, taken)
        ]
        units = [self._unit(("rows", k), text) for k, text in enumerate(self.file.rows)]
        rows = [
            Heading(text, unit)
            for text, unit in zip(self.file.rows, units, strict=True)
            if unit is not None
        ]
        along = None if self.along is None else Heading(self.along.name, self.along.unit)
        return StudyQuestion(
            self.run, along, parameters, tuple(columns), tuple(rows), self._dead_centre()
        )

    def _run(self) -> str:
        name, runs = self.file.run, self.model.runs
        if name is None or name in runs:
            return name or runs[0]
        hint = nearest_hint(name, runs) or f"runs are {', '.join(runs)}"
        self.faults.error("unknown-run", ("run",), f"there is no run {name[:LONGEST_NAME]}", hint)
        return runs[0]

    def _along(self) -> RunParameter | None:
        if self.run != SWEEP:
            name, values = "time", self.model.problem.responses[self.run].moments.written
        elif (swept := swept_parameter(self.problem)) is not None:
            name, values = swept
        else:
            return None
        unit = self.problem.units.label(self.problem.quantities()[name].dimension)
        return RunParameter(name, values, unit)

    def _dead_centre(self) -> Heading | None:
        if self.file.dead_centres is None:
            return None
        if self.run == SWEEP and self.along is not None:
            return Heading(DEAD_CENTRE, self.along.unit)
        path, hint = ("dead_centres",), "remove dead_centres:"
        self.faults.error("needless-key", path, "only a sweep has dead centres", hint, at_key=True)
        return None

    def _columns(self, path: KeyPath, section: written.Kept, taken: set[str]) -> list[StudyColumn]:
        unit = self._unit((*path, "of"), section.of)
        if unit is None:
            return []
        columns = []
        for word in section.words:
            at = self._at((*path, "at"), str(section.at)) if word == VALUE else np.nan
            label = _label(section, word)
            if label in taken:
                where = (*path, "label") if section.label is not None else path
                text = f"there are two columns {label!r}"
                self.faults.error("label-clash", where, text, "give one of them another label:")
            taken.add(label)
            if word.startswith("place"):
                own = self.along.unit if self.along is not None else ""
            else:
                own = unit
            columns.append(StudyColumn(Heading(label, own), section.of, word, at))
        return columns

    def _unit(self, path: KeyPath, text: str) -> str | None:
        """The unit of a quantity or expression of one number; None where it is none."""
        problem = self.problem
        if text.strip() in ROW_TEXTS:
            hint = "every variant has its verdict anyway"
            self.faults.error("words", path, f"{text} is words, no number", hint)
            return None
        try:
            quantity = problem.definitions.parse(text).evaluate(sample_of(problem), problem.units)
        except ExpressionError as error:
            hint = error.hint or "write a quantity such as O1.theta, or an expression"
            place = self.faults.document.place_in(path, error.offset)
            self.faults.diagnostics.append(
                Diagnostic("expression", "error", error.message, place, hint=hint)
            )
            return None
        if isinstance(quantity.value, Vector):
            short = text[:LONGEST_NAME]
            hint = f"write norm({short}), or a component"
            self.faults.error("vector", path, f"{short} is a vector, not one number", hint)
            return None
        return problem.units.label(quantity.dimension)

    def _at(self, path: KeyPath, text: str) -> float:
        """A place at which a row stands, in the file's units."""
        if self.along is None:
            hint = "keep its rows: and read them there"
            text = "nothing moves, so no row has a place to name"
            self.faults.error("no-place", path, text, hint)
            return np.nan
        name, values, unit = self.along
        dimension = self.problem.quantities()[name].dimension
        at = self.faults.value(path, name, text, dimension, self.problem.units)
        if at is None:
            return np.nan
        off = np.abs(values - at)
        row = int(off.argmin())
        if off[row] > LAST_ROW * float(np.ptp(values)):
            near = sorted(set(values[np.argsort(off, kind="stable")[:2]].tolist()))
            unit = f" {unit}".rstrip()
            hint = f"the nearest stand at {' and '.join(f'{one:.12g}' for one in near)}{unit}"
            self.faults.error("no-row", path, f"no row has {name} = {at:.12g}{unit}", hint)
        return at


def _label(section: written.Kept, word: str) -> str:
    """The heading of a word: the label given, or the word and the quantity."""
    if section.label is None:
        quantity = section.of.strip()
        return f"{quantity} at {section.at}" if word == VALUE else f"{word}({quantity})"
    return section.label if len(section.words) == 1 else f"{section.label} {word}"
