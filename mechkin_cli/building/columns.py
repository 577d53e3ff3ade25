"""Checks the columns of the tables once: names, dimensions, one number per row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.building.run_names import runs_of, unknown_run
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName, Vector
from mechkin_cli.mechanism.derived_quantities import hint_in_plane, hint_of
from mechkin_cli.mechanism.drives import Drives, without_effort
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.runs import SWEEP
from mechkin_cli.schema import tables as written
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.tables.layout import (
    ColumnLayout,
    PlotLayout,
    PrintedRemark,
    PublishedValues,
    TableLayout,
    default_table,
    row_texts,
)


def build_tables(fields: Fields, file: MechanismFile, problem: Problem) -> tuple[TableLayout, ...]:
    """The tables' layouts, and one for each run that has none; what is wrong with a column is noted
    in `fields`."""
    runs = runs_of(file)
    known = {run: quantities_of(problem, run) for run in runs}
    drives = problem.mechanism.drives
    tables = []
    for i, section in enumerate(file.tables):
        run = _run_of(fields, ("tables", i), section, runs)
        if run is not None:
            sample = Sample(fields, known[run], run, drives if run == SWEEP else None)
            tables.append(_table(fields, ("tables", i), section, run, sample))
    read = {table.run for table in tables}
    named = {section.run for section in file.tables}
    for run in runs:
        if run not in read and run not in named:
            tables.append(_default(problem, run))
            _refuse_taken(fields, file, run)
    _warn_of_missing_print(fields, file)
    return tuple(tables)


def quantities_of(problem: Problem, run: str) -> Mapping[str, Wanted]:
    """The quantities that the rows of a run have, by name."""
    if run == SWEEP:
        return problem.quantities()
    from mechkin_cli.mechanism.response import response_problem

    return response_problem(problem, problem.responses[run]).quantities()


def _run_of(fields: Fields, path: Path, section: written.Table, runs: Sequence[str]) -> str | None:
    """The run that a table reads; None where an error was noted."""
    if section.run is None and runs[0] != SWEEP and len(runs) > 1:
        text = f"{section.name} does not say which run it reads"
        fields.error("unknown-run", path, text, f"add run: one of {', '.join(runs)}")
        return None
    run = section.run or runs[0]
    if run in runs:
        return run
    unknown_run(fields, (*path, "run"), run, runs)
    return None


def _table(
    fields: Fields, path: Path, section: written.Table, run: str, sample: Sample
) -> TableLayout:
    columns = []
    for k, column in enumerate(section.columns):
        place: Path = (*path, "columns", k)
        if fields.document.node((*place, "value")) is not None:
            place = (*place, "value")
        layout = _column(fields, place, column, sample)
        if layout is not None:
            columns.append(layout)
    title = section.title or section.name
    published = _published(section.published)
    plot = None if section.plot is None else PlotLayout(section.plot.x, section.plot.y)
    return TableLayout(section.name, title, tuple(columns), published, run, section.summary, plot)


def _default(problem: Problem, run: str) -> TableLayout:
    """The table of a run that has none."""
    if run == SWEEP:
        timed = problem.motion.time is not None
        efforts = [".".join(pair) for pair in problem.acting]
    else:
        timed = True
        efforts = [f"{joint}.{name}" for joint, name in problem.responses[run].efforts_of]
    return default_table(problem.mechanism.coordinates, efforts, run=run, timed=timed)


def _refuse_taken(fields: Fields, file: MechanismFile, run: str) -> None:
    """A run without tables writes one of its own name."""
    for i, section in enumerate(file.tables):
        if section.name.casefold() == run.casefold():
            text = f"the run {run} has no table and writes one called {run} itself"
            hint = f"rename this one, or give the other: run: {run}"
            fields.error("table-clash", ("tables", i, "name"), text, hint)


def _published(section: written.PublishedValues | None) -> PublishedValues | None:
    if section is None:
        return None
    remarks = tuple(PrintedRemark(r.text, r.columns or (), r.data or ()) for r in section.remarks)
    return PublishedValues(section.file, remarks, section.rows_by)


def _warn_of_missing_print(fields: Fields, file: MechanismFile) -> None:
    """Files of printed values that are not there are warned of, all at once, since tables need none
    until they are compared."""
    folder = fields.document.folder
    missing: list[tuple[Path, str]] = []
    for i, table in enumerate(file.tables):
        printed = table.published
        if folder is None or printed is None or (folder / printed.file).is_file():
            continue
        path: Path = ("tables", i, "published")
        at = path if fields.document.node((*path, "file")) is None else (*path, "file")
        missing.append((at, str(folder / printed.file)))
    if not missing:
        return
    (path, first), *others = missing
    more = f", nor in {len(others)} other{'s' * (len(others) > 1)}" if others else ""
    text = f"there are no printed values in {first}{more}"
    hint = "the path leads from the folder of the mechanism file; put the file there"
    place = fields.document.place(path)
    fields.note(Diagnostic("published-missing", "warning", text, place, hint=hint))


def _column(
    fields: Fields, path: Path, column: written.Column, sample: Sample
) -> ColumnLayout | None:
    try:
        expression = fields.definitions.parse(column.value)
        if column.value.strip() not in sample.texts:
            found = expression.evaluate(sample, fields.units)
            if isinstance(found.value, Vector):
                raise ExpressionError(
                    "a column holds one number per row, this is a vector",
                    0,
                    "write one component: .x, .y or .z",
                )
    except ExpressionError as error:
        fields.expression_error(path, error)
        return None
    return ColumnLayout(column.label, expression, column.decimals)


class Sample:
    """Resolves names to one-row stand-ins of the right dimension."""

    def __init__(
        self,
        fields: Fields,
        quantities: Mapping[str, Wanted],
        run: str,
        drives: Drives | None = None,
    ) -> None:
        self.run = run
        self.texts = row_texts(run)
        self.drives = drives
        self.fields = fields
        self.parameters = fields.parameters
        self.quantities = quantities

    def __call__(self, name: str) -> Quantity:
        """The stand-in of a name.

        Raises:
            ExpressionError: nothing has this name, or what has it is a text.
        """
        if name in self.parameters:
            return self.parameters[name]
        if name in self.texts:
            raise ExpressionError(f"{name} is a text, no number", 0, "make it a column of its own")
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        wanted = self.quantities.get(name)
        if wanted is None:
            known = [
                *self.parameters,
                *self.fields.definitions.named,
                *self.quantities,
                *self.texts,
            ]
            response = self.run != SWEEP
            passive = without_effort(name, self.quantities, self.drives, response=response)
            held = hint_in_plane(name) if self.fields.plane else None
            raise UnknownName(name, known, passive or held or hint_of(name))
        one = np.ones(1)
        return Quantity(wanted.value([one] * 3), wanted.dimension)


def used_quantities(tables: Sequence[TableLayout], quantities: Mapping[str, Wanted]) -> list[str]:
    """Names of the quantities that some tables read."""
    found: dict[str, None] = {}
    for table in tables:
        for column in table.columns:
            for name in sorted(column.expression.names):
                for candidate in (name, name.rpartition(".")[0]):
                    if candidate in quantities:
                        found[candidate] = None
                        break
    return list(found)
