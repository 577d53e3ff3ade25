"""`tables:` and `coefficients:` - layouts whose columns have known names and one number per row."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import mechanism
from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName, Vector
from mechkin_cli.mechanism import (
    Drives,
    Problem,
    Wanted,
    hint_in_plane,
    hint_of,
    is_of_motion,
    without_effort,
)
from mechkin_cli.schema import MechanismFile, tables as written
from mechkin_cli.tables import (
    CoefficientsLayout,
    ColumnLayout,
    PrintedSource,
    Remark,
    TableLayout,
    default_table,
    row_texts,
)
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.schema import Coefficients


def runs_of(file: MechanismFile) -> tuple[str, ...]:
    """The runs of a file by name, the sweep first; a file of responses alone has no sweep."""
    swept = file.motion is not None or not file.responses
    return (*((SWEEP,) if swept else ()), *file.responses)


def unknown_run(fields: Fields, path: Path, name: str, known: Collection[str]) -> None:
    """Notes that the name at `path` is not a run."""
    if name == SWEEP:
        text, hint = "there is no sweep: the file has no motion:", "name a response, or add motion:"
    else:
        text = f"there is no run {name}"
        hint = nearest_hint(name, list(known)) or f"runs are {', '.join(known)}"
    fields.error("unknown-run", path, text, hint)


def build_tables(fields: Fields, file: MechanismFile, problem: Problem) -> tuple[TableLayout, ...]:
    """The tables' layouts, and one for each run that has none; errors are noted in `fields`."""
    runs = runs_of(file)
    known = {run: quantities_of(problem, run) for run in runs}
    drives = problem.mechanism.drives
    tables = []
    for i, section in enumerate(file.tables):
        run = _run_of(fields, ("tables", i), section, runs)
        if run is not None:
            sample = ColumnSample(fields, known[run], run, drives if run == SWEEP else None)
            tables.append(_table(fields, ("tables", i), section, run, sample))
    read = {table.run for table in tables}
    named = {section.run for section in file.tables}
    for run in runs:
        if run not in read and run not in named:
            tables.append(_default(problem, run))
            _refuse_taken(fields, file, run)
    return tuple(tables)


def quantities_of(problem: Problem, run: str) -> Mapping[str, Wanted]:
    """The quantities that the rows of a run have, by name."""
    if run == SWEEP:
        return problem.quantities()
    return mechanism.response_problem(problem, problem.responses[run]).quantities()


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
    fields: Fields, path: Path, section: written.Table, run: str, sample: ColumnSample
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
    x, y = (None, ()) if section.plot is None else (section.plot.x, section.plot.y)
    return TableLayout(section.name, title, tuple(columns), published, run, section.summary, x, y)


def _default(problem: Problem, run: str) -> TableLayout:
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


def _published(section: written.PublishedValues | None) -> PrintedSource | None:
    if section is None:
        return None
    remarks = tuple(Remark(r.text, r.columns or (), r.data or ()) for r in section.remarks)
    return PrintedSource(section.file, remarks, section.rows_by)


def _column(
    fields: Fields, path: Path, column: written.Column, sample: ColumnSample
) -> ColumnLayout | None:
    try:
        expression = fields.definitions.parse(column.value)
        if column.value.strip() not in sample.texts:
            quantity = expression.evaluate(sample, fields.units)
            if isinstance(quantity.value, Vector):
                message = "a column holds one number per row, this is a vector"
                hint = f"write {quantity.value.components_of(column.value)}, each a column"
                raise ExpressionError(message, 0, hint)
    except ExpressionError as error:
        fields.expression_error(path, error)
        return None
    return ColumnLayout(column.label, expression, column.decimals)


class ColumnSample:
    """Resolves names to one-row stand-ins of the right dimension."""

    def __init__(
        self,
        fields: Fields,
        quantities: Mapping[str, Wanted],
        run: str,
        drives: Drives | None = None,
    ) -> None:
        self.run, self.drives = run, drives
        self.texts = row_texts(run)
        self.fields, self.parameters = fields, fields.parameters
        self.quantities = quantities

    def __call__(self, name: str) -> Quantity:
        """The stand-in of a name.

        Raises:
            ExpressionError: nothing has this name, or it is the name of a text.
        """
        if name in self.parameters:
            return self.parameters[name]
        if name in self.texts:
            message = f"{name} is a text, not a number"
            raise ExpressionError(message, 0, "make it a column of its own")
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        wanted = self.quantities.get(name)
        if wanted is None and self.run in self.fields.failed and is_of_motion(name):
            raise AlreadyRefused(name)
        if wanted is None:
            named = self.fields.definitions.named
            known = [*self.parameters, *named, *self.quantities, *self.texts]
            response = self.run != SWEEP
            passive = without_effort(name, self.quantities, self.drives, response=response)
            in_plane = hint_in_plane(name) if self.fields.plane else None
            raise UnknownName(name, known, passive or in_plane or hint_of(name, self.quantities))
        return Quantity(wanted.value([np.ones(1)] * 3), wanted.dimension)


def used_quantities(tables: Sequence[TableLayout], quantities: Mapping[str, Wanted]) -> list[str]:
    """Names of the quantities that some tables read."""
    used: dict[str, None] = {}
    for table in tables:
        for column in table.columns:
            for name in sorted(column.expression.names):
                candidates = (name, name.rpartition(".")[0])
                used |= dict.fromkeys([each for each in candidates if each in quantities][:1])
    return list(used)


def build_coefficients(
    fields: Fields, file: MechanismFile, problem: Problem, tables: Sequence[TableLayout]
) -> tuple[CoefficientsLayout, ...]:
    """The layouts of `coefficients:`; errors are noted in `fields`."""
    layouts: list[CoefficientsLayout] = []
    for number, section in enumerate(file.coefficients):
        path: Path = ("coefficients", number)
        if section.row > problem.motion.rows and SWEEP not in fields.failed:
            text = f"the sweep has {problem.motion.rows} rows"
            fields.error("unknown-row", (*path, "row"), text, f"write 1 to {problem.motion.rows}")
        along = _along(fields, (*path, "along"), section, problem)
        title = section.title or section.name
        links = [name for name in problem.mechanism.links if name != mechanism.GROUND_NAME]
        known = [*links, *problem.mechanism.joints]
        equations = _ordered(fields, (*path, "equations"), section.equations, known)
        unknowns = _ordered(fields, (*path, "unknowns"), section.unknowns, unknown_names(problem))
        order = (equations, unknowns)
        layout = CoefficientsLayout(
            section.name, title, section.row, along, section.counted, *order
        )
        taken = {table.name.casefold() for table in tables}
        taken |= {name.casefold() for other in layouts for name in other.names}
        for name in layout.names:
            if name.casefold() in taken:
                text = f"another table is written to {name}"
                fields.error("table-clash", (*path, "name"), text, "rename one of them")
        layouts.append(layout)
    if layouts and SWEEP not in runs_of(file):
        text = "coefficients: belong to a row of the sweep, and the file has responses alone"
        fields.error("no-sweep", ("coefficients",), text, "add motion:, or leave them out")
    if layouts and problem.mechanism.frictions:
        text = "there are no coefficients: where joints rub, since friction is not linear"
        fields.error("rubbing", ("coefficients",), text, "leave out coefficients: or the friction")
    if layouts and problem.hold_idle:
        text = "there are no coefficients: where idle freedoms are held against loads"
        fields.error("held-idle", ("coefficients",), text, "leave out coefficients: or idle: hold")
    return tuple(layouts)


def _ordered(
    fields: Fields, path: Path, written: Sequence[str], known: Sequence[str]
) -> tuple[str, ...]:
    """The names, of which each must be known and stand once."""
    names = [text.removeprefix("-") for text in written]
    for place, name in enumerate(names):
        if name not in known:
            hint = nearest_hint(name, known) or f"names are {', '.join(known)}"
            fields.error("unknown-name", (*path, place), f"there is no {name} here", hint)
        elif name in names[:place]:
            fields.error("named-twice", (*path, place), f"{name} is named twice", "name it once")
    return tuple(written)


def unknown_names(problem: Problem) -> list[str]:
    """Names of the unknowns of the dense system, those of three components once."""
    names = []
    for joint in problem.mechanism.joints.values():
        if joint.type.is_free:
            continue
        words = ["F"] if joint.type.is_oriented else ["F", "M"]
        if joint.type.is_guide:
            free = joint.type.free
            words += ["FA"] if joint.type.is_threaded or not free["slide"] else []
            words += ["MA"] if not (joint.type.is_threaded or free["turn"]) else []
        names += [f"{joint.name}.{word}" for word in words]
    drives = problem.mechanism.drives
    word = "drive" if drives is not None and drives.constraints else "effort"
    return [*names, *(f"{j}.{c}.{word}" for j, c in problem.acting)]


def _along(
    fields: Fields, path: Path, section: Coefficients, problem: Problem
) -> dict[str, tuple[str, str]]:
    joints, known = problem.mechanism.joints, problem.mechanism.directions
    along: dict[str, tuple[str, str]] = {}
    for name, directions in section.along.items():
        if name not in joints or not joints[name].type.is_ball:
            balls = [joint.name for joint in joints.values() if joint.type.is_ball]
            hint = f"balls are {', '.join(balls)}" if balls else "the mechanism has none"
            fields.error("no-ball", (*path, name), f"{name} is not a ball of the mechanism", hint)
            continue
        unknown = [direction for direction in directions if direction not in known]
        for direction in unknown:
            hint = nearest_hint(direction, known) or "name it in directions:"
            place = (*path, name, directions.index(direction))
            fields.error("unknown-name", place, f"there is no direction {direction}", hint)
        if not unknown:
            along[name] = (directions[0], directions[1])
    return along
