"""Values of loads that vary: expressions of quantities known without forces, and tables.

An expression is checked once on a sample of one row; its quantities are positions and rates, so
that it can be evaluated before any force is.

A table is a CSV file of two columns, which a smooth curve joins: a header line and then one row
`x,y` per line, x strictly increasing; numbers are bare and in the units of the mechanism file.
Errors name the line and column of the CSV file.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Set

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Fields, Path, is_tiny_length
from mechkin_cli.building.source import BadTable, table_path, table_text
from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.expressions import (
    MAX_QUOTED,
    Expression,
    ExpressionError,
    Quantity,
    UnknownName,
    Vector,
    literal,
    number_of,
    parse,
    scalar,
)
from mechkin_cli.mechanism import (
    Curve,
    Ends,
    Interpolation,
    LoadLaw,
    Varying,
    Wanted,
    hint_of,
    joined_curve,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import JoinedTable, TableValue
from mechkin_cli.tape import is_finite, is_traced, plain
from mechkin_cli.tolerances import LARGEST_NUMBER, OVERSHOOT, SMALLEST_SIZE
from mechkin_cli.units import Dimension

_KINDS = {"coordinate", "point", "direction", "omega", "axis", "joint_point", "slip", "time"}
ALLOWED = (
    " may read joint coordinates and their rates, positions, velocities, omegas, axes, "
    "directions, parameters and time"
)
NO_TIME = (
    "time is not known: the motion has no time",
    "give the motion time: {from: ..., to: ..., step: ...}, with laws for its inputs",
)
OWN_RUNS = "give the motion time: {from: ..., to: ..., step: ...}, or let the load act in "


class LoadLaws:
    """Collects the laws of varying loads; errors are noted in `fields`.

    Args:
        fields: of the file, with units and parameters.
        runs: the quantities of each run by name; only some runs have a time.
        reader: the owner of the laws, for messages.
    """

    def __init__(
        self, fields: Fields, runs: Mapping[str, Mapping[str, Wanted]], *, reader: str = "a load"
    ) -> None:
        self.fields = fields
        self.runs = runs
        self.reader = reader
        self.laws: list[LoadLaw] = []
        self.acting(runs.keys())

    def acting(self, runs: Collection[str]) -> None:
        """Sets the runs in which the next laws hold."""
        known = [self.runs[name] for name in runs if name in self.runs]
        known = known or list(self.runs.values())
        self.quantities = next((q for q in known if "time" not in q), known[0])
        timed = [name for name, q in self.runs.items() if "time" in q]
        alone = f"{OWN_RUNS}responses alone: runs: [{', '.join(timed)}]" if timed else NO_TIME[1]
        self.time_hint = alone

    def by_expression(self, path: Path, expression: Expression, dimension: Dimension) -> Varying:
        """The value of an expression of a dimension."""
        try:
            scalar(expression.in_doubles, dimension, self.fields.units, self._sample)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return Varying(0)
        reads = [self.quantities[name] for name in self._read(expression.names)]
        place = self.fields.document.place(path)
        self.laws.append(LoadLaw(tuple(q.name for q in reads), place, expression))
        return Varying(len(self.laws) - 1, any(_is_moving(q) for q in reads))

    def watched(self, path: Path, text: str) -> tuple[LoadLaw, Quantity] | None:
        """The law of an expression of any dimension, which is not a load, and what it is; None
        where an error was noted."""
        try:
            expression = self.fields.definitions.parse(text)
            if expression.names <= self.fields.parameters.keys():
                hint = "write an expression of coordinates, rates, positions, velocities or time"
                raise ExpressionError("this value never changes", 0, hint)
            quantity = expression.in_doubles.evaluate(self._sample, self.fields.units)
            if isinstance(quantity.value, Vector):
                hint = f"write {quantity.value.components_of(text)}"
                raise ExpressionError(f"{self.reader} takes one number, this is a vector", 0, hint)
        except ExpressionError as error:
            self.fields.expression_error(path, error)
            return None
        names = tuple(self._read(expression.names))
        return LoadLaw(names, self.fields.document.place(path), expression), quantity

    def by_table(self, path: Path, value: TableValue, over: str, dimension: Dimension) -> Varying:
        """The value of a dimension in a table, which runs over the quantity `over` unless it names
        another."""
        path, wanted = (*path, "table"), self._runs_over(path, value, over)
        if wanted is None:
            return Varying(0)
        dimensions = wanted.dimension, dimension
        curve = read_curve(self.fields, path, value.table, *dimensions, *joining_of(value))
        if curve is not None:
            place = self.fields.document.place(path)
            self.laws.append(LoadLaw((wanted.name,), place, curve=curve))
        return Varying(len(self.laws) - 1, _is_moving(wanted))

    def _runs_over(self, path: Path, value: TableValue, usual: str) -> Wanted | None:
        """The quantity of a table's first column; None where an error was noted."""
        if value.over is not None:
            try:
                over = parse(value.over)
                name = _one_name(over, over.evaluate(self._sample, self.fields.units))
            except ExpressionError as error:
                self.fields.expression_error((*path, "over"), error)
                return None
            if name not in self.quantities:
                hint = "name a coordinate, a rate or time"
                self.fields.error("load-table", (*path, "over"), f"{name} is a parameter", hint)
                return None
            return self.quantities[name]
        if self.fields.is_refused(usual):
            return None
        wanted = self.quantities.get(usual)
        if wanted is None:
            text = "a table of a load on a link runs over time, and the motion has none"
            self.fields.error("load-table", (*path, "table"), text, self.time_hint)
        return wanted

    def _read(self, names: Set[str]) -> list[str]:
        """The quantities behind the names of an expression, without parameters."""
        read = sorted(names - self.fields.parameters.keys())
        return [name if name in self.quantities else name.rpartition(".")[0] for name in read]

    def _sample(self, name: str) -> Quantity:
        """One row of a quantity, of its dimension."""
        if name in self.fields.parameters:
            parameter = self.fields.parameters[name]
            # a recorded number only has its value where the law is evaluated
            return replace(parameter, value=np.ones(1)) if is_traced(parameter.value) else parameter
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        if name == "time" and name not in self.quantities:
            raise ExpressionError(NO_TIME[0], 0, self.time_hint)
        allowed = self.reader + ALLOWED
        if name.startswith("row."):
            raise ExpressionError(f"{self.reader} cannot read {name}: it is a verdict", 0, allowed)
        wanted = self.quantities.get(name)
        if wanted is None:
            known = {q.name: q for q in self.quantities.values() if is_known(q)}
            raise UnknownName(name, [*self.fields.parameters, *known], hint_of(name, known))
        if not is_known(wanted):
            accelerated = wanted.order >= 2 or wanted.kind == "alpha"
            why = "it is an acceleration" if accelerated else "it follows from the loads"
            raise ExpressionError(f"{self.reader} cannot read {name}: {why}", 0, allowed)
        return Quantity(wanted.value([np.ones(1)] * 3), wanted.dimension)


def is_known(wanted: Wanted) -> bool:
    """Whether a quantity is known before any force is."""
    return wanted.kind in _KINDS and wanted.order <= 1


def _is_moving(wanted: Wanted) -> bool:
    return wanted.order == 1 or wanted.kind == "omega"


def _one_name(expression: Expression, quantity: Quantity) -> str:
    """The name of the one number that an expression consists of.

    Raises:
        ExpressionError: it is more than a name, or a vector.
    """
    name = expression.text.strip()
    if expression.names != {name}:
        hint = "name one quantity, such as O1.theta, O1.theta_dot or time"
        raise ExpressionError("a table runs over one quantity, this is an expression", 0, hint)
    if isinstance(quantity.value, Vector):
        hint = "name a coordinate, a rate or time"
        raise ExpressionError(f"a table runs over one number, {name} is a vector", 0, hint)
    return name


CODE = "csv-table"


def read_curve(
    fields: Fields,
    path: Path,
    file_text: str,
    x_dimension: Dimension,
    y_dimension: Dimension,
    interpolation: Interpolation = "spline",
    ends: Ends = "not-a-knot",
) -> Curve | None:
    """The curve through a table, in SI; None where an error was noted in `fields`.

    Args:
        fields: of the mechanism file, from whose folder `file_text` leads.
        path: of the table's name in the mechanism file.
        file_text: the path of the CSV file as written.
        x_dimension: dimension of the first column, strictly increasing.
        y_dimension: dimension of the second column.
        interpolation: how its points are joined.
        ends: what holds there.
    """
    rows = read_rows(fields, path, file_text, x_dimension, y_dimension)
    if rows is None:
        return None
    to_si = fields.units.to_si
    x = [plain(to_si(value, x_dimension)) for value in rows[0]]
    y = [plain(to_si(value, y_dimension)) for value in rows[1]]
    curve = join(fields, path, x, y, interpolation, ends)
    if curve is not None:
        note_overshoot(fields, path, curve, (x_dimension, y_dimension))
    return curve


def joining_of(table: JoinedTable) -> tuple[Interpolation, Ends]:
    """The way in which the points of a table of the file are joined, and what holds at its ends."""
    return table.interpolation, table.ends or "not-a-knot"


def join(
    fields: Fields,
    path: Path,
    x: list[float],
    y: list[float],
    interpolation: Interpolation,
    ends: Ends,
) -> Curve | None:
    """The curve through points; None where it is too steep for numbers, which is noted."""
    try:
        with np.errstate(all="ignore"):
            curve = joined_curve(x, y, interpolation, ends)
    except ZeroDivisionError:  # two x that are one number in SI
        curve = None
    if curve is not None and all(map(is_finite, curve.coefficients.flat)):
        return curve
    text = "the curve through this table is too steep to compute"
    fields.error(CODE, path, text, "leave out rows that lie too close together")
    return None


def note_overshoot(
    fields: Fields, path: Path, curve: Curve, dimensions: tuple[Dimension, Dimension] | None
) -> None:
    """Notes where a curve leaves the range of its points by more than `OVERSHOOT`, with the place
    at which it goes farthest; `dimensions` of a curve in SI, None of one in the file's units."""
    if is_traced(curve.x) or is_traced(curve.coefficients):
        return  # noted when the file was read
    least, most = float(curve.coefficients[0].min()), float(curve.coefficients[0].max())
    places = curve.turning_places()
    values = curve.evaluate(places)[0]
    beyond = np.maximum(values - most, least - values)
    if not beyond.size or not beyond.max() > OVERSHOOT * (most - least):
        return
    farthest = int(beyond.argmax())
    x, y, limit = places[farthest], values[farthest], most if values[farthest] > most else least
    if dimensions is not None:
        x, y, limit = (
            float(fields.units.from_si(value, dimension))
            for value, dimension in zip((x, y, limit), (*dimensions, dimensions[1]), strict=True)
        )
    word = "above" if values[farthest] > most else "below"
    text = f"the curve through this table goes to {y:.6g} at {x:.6g}, {word} all its values"
    hint = "write interpolation: monotone to keep it within them"
    place = fields.document.place(path)
    fields.note(Diagnostic("table-overshoot", "note", text, place, limit=f"{limit:.6g}", hint=hint))


def read_rows(
    fields: Fields, path: Path, file_text: str, x_dimension: Dimension, y_dimension: Dimension
) -> tuple[list[float], list[float]] | None:
    """The checked columns x and y of a table in the file's units; arguments and errors as
    `read_curve`."""
    document = fields.document
    file = table_path(document, file_text)
    if document.folder is None and file_text not in document.tables:
        text = f"{file_text} is sought beside the mechanism file, but this text comes from no file"
        fields.error(CODE, path, text, "save the mechanism in a file and load that")
        return None
    try:
        rows = _rows(table_text(document, file_text))
        for i, dimension in enumerate((x_dimension, y_dimension)):
            _check_size(fields, rows, i, dimension)
        return [row[1] for row in rows], [row[2] for row in rows]
    except BadTable as bad:
        if bad.line == 0:
            fields.error(CODE, path, f"{file} {bad.message}", bad.hint)
        else:
            place = Place(str(file), bad.line, bad.column)
            fields.diagnostics.append(Diagnostic(CODE, "error", bad.message, place, hint=bad.hint))
        return None


def _rows(text: str) -> list[tuple[int, float, float]]:
    """(line, x, y) of every row; blank lines are skipped."""
    lines = text.replace("\r\n", "\n").split("\n")
    if all(literal(cell) is not None for cell in lines[0].split(",")):
        hint = "the first line is a header, for example time,value"
        raise BadTable(1, 1, "this table has no header", hint)
    rows: list[tuple[int, float, float]] = []
    for line, row in enumerate(lines[1:], start=2):
        if not row.strip():
            continue
        x, y = _row(line, row)
        if rows and x <= rows[-1][1]:
            text = f"{x!r} is not larger than the {rows[-1][1]!r} before it"
            raise BadTable(line, 1, text, "order the rows by the first column, each value once")
        rows.append((line, x, y))
    if len(rows) < 2:
        text = f"this table has {'one row' if rows else 'no row'} behind its header"
        raise BadTable(len(lines), 1, text, "give two")
    return rows


def _row(line: int, row: str) -> tuple[float, float]:
    cells = row.split(",")
    if ";" in row:
        text = "the columns of this table are parted by semicolons"
        raise BadTable(line, 1, text, "write x,y with a comma between them and a point in decimals")
    if len(cells) != 2:
        text = f"this row has {len(cells)} {'column' if len(cells) == 1 else 'columns'}, not two"
        hint = "write x,y with a comma between them and a point in decimals"
        raise BadTable(line, 1, text, hint)
    values = []
    for cell, column in zip(cells, (1, len(cells[0]) + 2), strict=True):
        value = number_of(cell)
        if value is None:
            shown = repr(cell.strip()[:MAX_QUOTED])
            hint = "write a finite number without its unit: the mechanism file's units hold"
            raise BadTable(line, column, f"{shown} is not a number", hint)
        values.append(value)
    return values[0], values[1]


def _check_size(
    fields: Fields, rows: list[tuple[int, float, float]], i: int, dimension: Dimension
) -> None:
    largest = LARGEST_NUMBER / fields.units.factor(dimension)
    for row in rows:
        if abs(row[i + 1]) > largest:
            text = f"{row[i + 1]:.4g} is too large to compute with (limit {largest:.4g})"
        elif is_tiny_length(fields.units.to_si(row[i + 1], dimension), dimension):
            text = f"{row[i + 1]:.4g} is a length below {SMALLEST_SIZE:g} m"
        else:
            continue
        raise BadTable(row[0], 1, text, "check its exponent and unit")
