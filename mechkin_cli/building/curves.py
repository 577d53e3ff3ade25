"""Tables of two columns in CSV files to smooth curves.

A file has a header line and then one row `x,y` per line, x strictly increasing; numbers are bare
and in the units of the mechanism file. Errors name the line and column of the CSV file.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mechkin_cli.building.fields import Fields, is_tiny_length
from mechkin_cli.building.fields import Path as KeyPath
from mechkin_cli.building.table_files import BadTable, table_path, table_text
from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.expressions import literal, number_of
from mechkin_cli.expressions.limits import MAX_QUOTED
from mechkin_cli.mechanism.curve import Curve
from mechkin_cli.mechanism.joined_curve import Joining, joined_curve
from mechkin_cli.schema.joining import JoinedTable
from mechkin_cli.tape.rows import is_traced
from mechkin_cli.tape.scalars import is_finite, plain
from mechkin_cli.tolerances import LARGEST_NUMBER, OVERSHOOT, SMALLEST_SIZE
from mechkin_cli.units import Dimension

CODE = "csv-table"


SMOOTH = Joining()
"""As points are joined where nothing else is asked for."""


class Rows(NamedTuple):
    """The two columns of a table in the units of the mechanism file."""

    x: list[float]
    y: list[float]


def read_curve(
    fields: Fields,
    path: KeyPath,
    file_text: str,
    x_dimension: Dimension,
    y_dimension: Dimension,
    joining: Joining = SMOOTH,
) -> Curve | None:
    """The curve through a table, in SI; None where an error was noted in `fields`.

    Args:
        fields: knows the units and the mechanism file, from whose folder `file_text` leads.
        path: where the mechanism file names the table.
        file_text: the path of the CSV file as written.
        x_dimension: dimension of the first column, strictly increasing.
        y_dimension: dimension of the second column.
        joining: how its points are joined.
    """
    rows = read_rows(fields, path, file_text, x_dimension, y_dimension)
    if rows is None:
        return None
    to_si = fields.units.to_si
    x = [plain(to_si(value, x_dimension)) for value in rows.x]
    curve = join(fields, path, x, [plain(to_si(value, y_dimension)) for value in rows.y], joining)
    if curve is not None:
        note_overshoot(fields, path, curve, (x_dimension, y_dimension))
    return curve


def joining_of(table: JoinedTable) -> Joining:
    """How the points of a table of the file are joined."""
    return Joining(table.interpolation, table.ends or "not-a-knot")


def join(
    fields: Fields, path: KeyPath, x: list[float], y: list[float], joining: Joining
) -> Curve | None:
    """The curve through points; None where it is too steep for numbers, which is noted."""
    try:
        with np.errstate(all="ignore"):
            curve = joined_curve(x, y, joining)
    except ZeroDivisionError:  # two x that are one number in SI
        curve = None
    if curve is not None and all(map(is_finite, curve.coefficients.flat)):
        return curve
    text = "the curve through this table is too steep to compute"
    fields.error(CODE, path, text, "leave out rows that lie too close together")
    return None


def note_overshoot(
    fields: Fields, path: KeyPath, curve: Curve, dimensions: tuple[Dimension, Dimension] | None
) -> None:
    """A note where a curve leaves the range of its points by more than `OVERSHOOT`, with the place
    at which it goes farthest; `dimensions` of a curve in SI, None of one in the file's units."""
    if is_traced(curve.x) or is_traced(curve.coefficients):
        return  # the note was given when the file was read
    least, most = float(curve.coefficients[0].min()), float(curve.coefficients[0].max())
    places = curve.turning_places()
    values = curve.evaluate(places)[0]
    beyond = np.maximum(values - most, least - values)
    if not beyond.size or not beyond.max() > OVERSHOOT * (most - least):
        return
    farthest = int(beyond.argmax())
    x, y, limit = places[farthest], values[farthest], most if values[farthest] > most else least
    if dimensions is not None:
        from_si = fields.units.from_si
        x, y, limit = (
            float(from_si(one, of))
            for one, of in ((x, dimensions[0]), (y, dimensions[1]), (limit, dimensions[1]))
        )
    word = "above" if values[farthest] > most else "below"
    fields.note(
        Diagnostic(
            "table-overshoot",
            "note",
            f"the curve through this table goes to {y:.6g} at {x:.6g}, {word} all its values",
            fields.document.place(path),
            limit=f"{limit:.6g}",
            hint="write interpolation: monotone to keep it within them",
        )
    )


def read_rows(
    fields: Fields, path: KeyPath, file_text: str, x_dimension: Dimension, y_dimension: Dimension
) -> Rows | None:
    """The checked rows of a table in the file's units; arguments and errors as `read_curve`."""
    document = fields.document
    file = table_path(document, file_text)
    if document.folder is None and file_text not in document.tables:
        fields.error(
            CODE,
            path,
            f"{file_text} is sought beside the mechanism file, but this text comes from no file",
            "save the mechanism in a file and load that",
        )
        return None
    try:
        rows = _rows(table_text(document, file_text))
        for i, dimension in enumerate((x_dimension, y_dimension)):
            _check_size(fields, rows, i, dimension)
        return Rows([row[1] for row in rows], [row[2] for row in rows])
    except BadTable as bad:
        if bad.line == 0:
            fields.error(CODE, path, f"{file} {bad.message}", bad.hint)
        else:
            place = Place(str(file), bad.line, bad.column)
            fields.diagnostics.append(Diagnostic(CODE, "error", bad.message, place, hint=bad.hint))
        return None


def _rows(text: str) -> list[tuple[int, float, float]]:
    """(line, x, y) of every row; blank lines are passed over."""
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
        found = "one row" if rows else "no row"
        raise BadTable(len(lines), 1, f"this table has {found} behind its header", "give two")
    return rows


def _row(line: int, row: str) -> tuple[float, float]:
    cells = row.split(",")
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
            raise BadTable(row[0], 1, text, "check its exponent and unit")
        if is_tiny_length(fields.units.to_si(row[i + 1], dimension), dimension):
            text = f"{row[i + 1]:.4g} is a length below {SMALLEST_SIZE:g} m"
            raise BadTable(row[0], 1, text, "check its exponent and unit")
