"""The variants of a study, from its lists, ranges, distributions and its table."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from functools import partial
from math import log2
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building.sequences import by_count, by_step
from mechkin_cli.building.table_files import BadTable, table_path, table_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Place, UsageError
from mechkin_cli.interface.study_faults import Faults, in_file_units, split
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema import study as written
from mechkin_cli.studies.draws import draws, has_scipy, needs_scipy, normal, uniform
from mechkin_cli.studies.variation import Distribution, Samples, Variation
from mechkin_cli.tolerances import LAST_ROW, MOST_DRAWN, MOST_TABLE_TEXT, MOST_VARIANTS

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.interface.model import Model
    from mechkin_cli.reading.document import KeyPath

TOO_MANY = "too-many-variants"
_NOTHING = partial(uniform, least=0.0, most=0.0)


def variation_of(file: written.StudyFile, model: Model, faults: Faults) -> Variation:
    """The variants that a study's sections describe; what is wrong with them goes to `faults`."""
    return _Reader(file, model, faults).variation()


def unknown_parameter(model: Model, name: str) -> tuple[str, str]:
    """That there is no such parameter, and what to do."""
    known = list(model.problem.parameters)
    hint = nearest_hint(name, known) or f"parameters are {', '.join(known[:10])}"
    if not known:
        hint = "write parameters: into the mechanism file"
    return f"{model.name} has no parameter {name[:LONGEST_NAME]}", hint


class _Reader:
    def __init__(self, file: written.StudyFile, model: Model, faults: Faults) -> None:
        self.file, self.model, self.faults = file, model, faults
        self.known = model.problem.parameters
        self.units = model.problem.units

    def variation(self) -> Variation:
        lists: dict[str, Floats] = {}
        drawn: dict[str, Distribution] = {}
        for name, form in self.file.vary.items():
            if name not in self.known:
                said = unknown_parameter(self.model, name)
                self.faults.error("unknown-parameter", ("vary", name), *said, at_key=True)
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
        found = Variation(lists, together, table, self._samples(drawn))
        if not self.faults.are_errors and len(found) > MOST_VARIANTS:
            counts = " x ".join(str(n) for n in found.counts if n > 1)
            text = f"the study has {len(found)} variants, {counts} (limit {MOST_VARIANTS})"
            self.faults.error(TOO_MANY, ("vary",), text, "take fewer values, or draw them")
        return found

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
            return by_count(first, last, count)
        return by_step(first, abs(step) if last >= first else -abs(step), count)

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
        found = draws(sample.method, sample.count, len(drawn), sample.seed)
        return Samples(sample.count, found, drawn)

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
