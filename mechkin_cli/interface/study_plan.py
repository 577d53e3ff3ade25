"""A study as written to its variants and its question: every independent error at its place."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic
from mechkin_cli.expressions import ExpressionError, Vector
from mechkin_cli.interface.study_chunk import DEAD_CENTRE, VALUE, VARIANT, VERDICTS, Kept, Question
from mechkin_cli.interface.study_faults import Faults
from mechkin_cli.interface.study_variation import variation_of
from mechkin_cli.interface.variant_runs import sample_of
from mechkin_cli.interface.way import way_of
from mechkin_cli.mechanism.response import response_problem
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.runs import SWEEP
from mechkin_cli.schema import study as written
from mechkin_cli.studies.records import Heading
from mechkin_cli.studies.variation import Variation
from mechkin_cli.tables.layout import ROW_TEXTS
from mechkin_cli.tolerances import LAST_ROW

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.model import Model
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.reading.document import Document, KeyPath


class StudyPlan(NamedTuple):
    """A study that can be carried out: its variants, what is asked of each, and notes."""

    variation: Variation
    question: Question
    notes: tuple[Diagnostic, ...]


class _Along(NamedTuple):
    """What a run goes along, and its values in the file's units over the rows asked for."""

    heading: Heading
    values: Floats


def study_plan(file: written.StudyFile, document: Document, model: Model) -> StudyPlan:
    """The plan of a study of a model.

    Raises:
        InvalidFile: with every independent error and its place.
    """
    faults = Faults(document)
    variation = variation_of(file, model, faults)
    question = _Asking(file, model, faults).question(variation)
    return StudyPlan(variation, question, faults.notes())


class _Asking:
    """Reads what is asked of the variants."""

    def __init__(self, file: written.StudyFile, model: Model, faults: Faults) -> None:
        self.file, self.model, self.faults = file, model, faults
        self.run = self._run()
        whole = model.problem
        is_sweep = self.run == SWEEP
        self.problem: Problem = (
            whole if is_sweep else response_problem(whole, whole.responses[self.run])
        )
        self.along = self._along()

    def question(self, variation: Variation) -> Question:
        """The question of a study with these variants."""
        known, label = self.problem.parameters, self.problem.units.label
        names = variation.names
        parameters = tuple(Heading(name, label(known[name].dimension)) for name in names)
        taken = {VARIANT.label, DEAD_CENTRE, *names, *(heading.label for heading in VERDICTS)}
        kept = [
            column
            for number, section in enumerate(self.file.keep)
            for column in self._kept(("keep", number), section, taken)
        ]
        units = [self._unit(("rows", k), text) for k, text in enumerate(self.file.rows)]
        rows = [
            Heading(text, unit)
            for text, unit in zip(self.file.rows, units, strict=True)
            if unit is not None
        ]
        along = None if self.along is None else self.along.heading
        return Question(self.run, along, parameters, tuple(kept), tuple(rows), self._dead_centre())

    def _run(self) -> str:
        name, runs = self.file.run, self.model.runs
        if name is None or name in runs:
            return name or runs[0]
        hint = nearest_hint(name, runs) or f"runs are {', '.join(runs)}"
        self.faults.error("unknown-run", ("run",), f"there is no run {name[:LONGEST_NAME]}", hint)
        return runs[0]

    def _along(self) -> _Along | None:
        known, label = self.problem.quantities(), self.problem.units.label
        if self.run != SWEEP:
            moments = self.model.problem.responses[self.run].moments.written
            return _Along(Heading("time", label(known["time"].dimension)), moments)
        way = way_of(self.problem)
        if way is None:
            return None
        return _Along(Heading(way.name, label(known[way.name].dimension)), way.values)

    def _dead_centre(self) -> Heading | None:
        if self.file.dead_centres is None:
            return None
        if self.run == SWEEP and self.along is not None:
            return Heading(DEAD_CENTRE, self.along.heading.unit)
        path, hint = ("dead_centres",), "remove dead_centres:"
        self.faults.error("needless-key", path, "only a sweep has dead centres", hint, at_key=True)
        return None

    def _kept(self, path: KeyPath, section: written.Kept, taken: set[str]) -> list[Kept]:
        unit = self._unit((*path, "of"), section.of)
        if unit is None:
            return []
        found = []
        for word in section.words:
            at = self._at((*path, "at"), str(section.at)) if word == VALUE else np.nan
            label = _label(section, word)
            if label in taken:
                where = (*path, "label") if section.label is not None else path
                text = f"there are two columns {label!r}"
                self.faults.error("label-clash", where, text, "give one of them another label:")
            taken.add(label)
            if word.startswith("place"):
                own = self.along.heading.unit if self.along is not None else ""
            else:
                own = unit
            found.append(Kept(Heading(label, own), section.of, word, at))
        return found

    def _unit(self, path: KeyPath, text: str) -> str | None:
        """The unit of a quantity or expression of one number; None where it is none."""
        problem = self.problem
        if text.strip() in ROW_TEXTS:
            hint = "the verdict of every variant is kept anyway"
            self.faults.error("words", path, f"{text} is words, no number", hint)
            return None
        try:
            found = problem.definitions.parse(text).evaluate(sample_of(problem), problem.units)
        except ExpressionError as error:
            hint = error.hint or "write a quantity such as O1.theta, or an expression"
            place = self.faults.document.place_in(path, error.offset)
            self.faults.diagnostics.append(
                Diagnostic("expression", "error", error.message, place, hint=hint)
            )
            return None
        if isinstance(found.value, Vector):
            short = text[:LONGEST_NAME]
            hint = f"write norm({short}), or a component"
            self.faults.error("vector", path, f"{short} is a vector, not one number", hint)
            return None
        return problem.units.label(found.dimension)

    def _at(self, path: KeyPath, text: str) -> float:
        """A place at which a row stands, in the file's units."""
        if self.along is None:
            hint = "keep its rows: and read them there"
            text = "nothing moves, so no row has a place to name"
            self.faults.error("no-place", path, text, hint)
            return np.nan
        heading, values = self.along.heading, self.along.values
        dimension = self.problem.quantities()[heading.label].dimension
        at = self.faults.value(path, heading.label, text, dimension, self.problem.units)
        if at is None:
            return np.nan
        off = np.abs(values - at)
        row = int(off.argmin())
        if off[row] > LAST_ROW * float(np.ptp(values)):
            near = sorted(set(values[np.argsort(off, kind="stable")[:2]].tolist()))
            unit = f" {heading.unit}".rstrip()
            hint = f"the nearest stand at {' and '.join(f'{one:.12g}' for one in near)}{unit}"
            self.faults.error("no-row", path, f"no row has {heading.label} = {at:.12g}{unit}", hint)
        return at


def _label(section: written.Kept, word: str) -> str:
    """The heading of a word: the label given, or the word and the quantity."""
    if section.label is None:
        quantity = section.of.strip()
        return f"{quantity} at {section.at}" if word == VALUE else f"{word}({quantity})"
    return section.label if len(section.words) == 1 else f"{section.label} {word}"
