"""Hard points (a table of names and places) put into a mechanism file, whose other lines stay as
they are.

A file takes hard points in one of two ways. Where it has parameters NAME_x, NAME_y and NAME_z, as
the template `suspension` does, these are its hard points and nothing else is. Otherwise they are
the joints and the named points whose place is written in numbers.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Mapping
from typing import Final

from mechkin_cli import tolerances
from mechkin_cli.bridges.parts import NUMBER, Imported, listed, number_text, refuse
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError, nearest
from mechkin_cli.reading import Document, KeyPath, document_from_text, edited, shortened
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import LENGTH, UnitError, UnitSystem, parse_unit

MOST_POINTS: Final = 10_000
"""Rows of a table."""

_AXES = "xyz"
_HEADING = re.compile(r"\s*([A-Za-z ]+?)\s*(?:[\[(]\s*([^\])]+?)\s*[\])])?\s*")
_NAME_HEADINGS = ("name", "point", "hard point", "hardpoint")


class HardPoint(NamedTuple):
    """A row of a table: a name, its coordinates in the table's unit, and where it stands."""

    name: str
    place: tuple[float, ...]
    at: Place


class Table(NamedTuple):
    """The rows of a table; `unit` as its header gives it, None where it does not."""

    points: tuple[HardPoint, ...]
    unit: str | None = None
    ignored: tuple[str, ...] = ()


def folded(name: str) -> str:
    """A name as it is compared: `Lower Ball`, `lower-ball` and `lower_ball` are the same.

    >>> folded(" Lower-Ball ")
    'lower_ball'
    """
    return re.sub(r"[^a-z0-9]+", "_", name.casefold()).strip("_")


def hard_point_names(document: Document) -> dict[str, tuple[KeyPath, ...]]:
    """The hard points of a file, each with the paths of its coordinates in x, y and z."""
    data = document.data
    axes = _AXES[:2] if data.get("plane") == "xy" else _AXES
    parameters = data.get("parameters")
    names = list(parameters) if isinstance(parameters, dict) else []
    stems = [name[:-2] for name in names if name.endswith("_x")]
    found: dict[str, tuple[KeyPath, ...]] = {}
    for stem in stems:
        if all(f"{stem}_{axis}" in names for axis in axes):
            found[stem] = tuple(("parameters", f"{stem}_{axis}") for axis in axes)
    if found:
        return found
    for section, key in (("joints", "point"), ("points", "at")):
        entries = data.get(section)
        for name, entry in entries.items() if isinstance(entries, dict) else ():
            place = entry.get(key) if isinstance(entry, dict) else None
            if isinstance(place, list) and all(map(_is_written_out, place)):
                found[name] = tuple((section, name, key, i) for i in range(len(place)))
    return found


def _is_written_out(value: object) -> bool:
    """Whether a coordinate is a number, with or without a unit, and no expression."""
    return isinstance(value, str) and bool(
        re.fullmatch(rf"{NUMBER.pattern}(\s*[A-Za-z]+)?", value.strip())
    )


def with_hard_points(
    text: str,
    file: str,
    template: str,
    template_name: str,
    unit: str | None = None,
    renamed: Mapping[str, str] | None = None,
) -> Imported:
    """A template's text with the hard points of a table.

    Args:
        text: the table (CSV, also with semicolons or tabs): name, x, y, z in any order under a
            header, or in this order without one.
        file: its name in messages.
        template: the text of the mechanism file that takes the points.
        template_name: its name in messages.
        unit: of the table's lengths; left out, that of its header, else the template's.
        renamed: the template's name of points that are called otherwise in the table.

    Raises:
        InvalidFile: rows that are no hard points, or names that the template does not have.
        UsageError: a unit that is none, or a name of `renamed` that is not in the table.
    """
    document = document_from_text(template, template_name)
    expected = hard_point_names(document)
    if not expected:
        raise UsageError(
            f"{template_name} has no hard points: no parameters NAME_x, NAME_y, NAME_z, and no "
            "joint or point whose place is written in numbers; choose another --template"
        )
    table = read_table(text, file, len(next(iter(expected.values()))))
    own = _unit_of(document)
    table_unit = _checked_unit(unit or table.unit or own, file)
    taken = _assigned(table, expected, renamed or {}, template_name)
    values: dict[KeyPath, str] = {}
    for name, point in taken.items():
        for path, value in zip(expected[name], point.place, strict=True):
            # bare numbers are pure numbers among parameters, and in the file's units elsewhere
            is_bare = table_unit == own and path[0] != "parameters"
            values[path] = number_text(value) + ("" if is_bare else f" {table_unit}")
    notes = _notes(table, taken, expected, template_name, file)
    if unit is None and table.unit is None:
        told = f"the table gives no unit; its numbers are taken in {own}, the template's unit"
        cure = "give another with --unit mm, or in the header: x [mm]"
        notes.append(Diagnostic("unit-assumed", "note", told, Place(file, 1, 1), hint=cure))
    return Imported(edited(document.text, values), tuple(notes))


def _unit_of(document: Document) -> str:
    units = document.data.get("units")
    given = units.get("length") if isinstance(units, dict) else None
    return given if isinstance(given, str) else UnitSystem().label(LENGTH)


def _checked_unit(unit: str, file: str) -> str:
    try:
        if parse_unit(unit).dimension == LENGTH:
            return unit
    except UnitError:
        pass
    raise UsageError(
        f"{file}: {shortened(unit)!r} is no unit of length; name one such as mm, m or in "
        "with --unit, or in the header"
    )


def _assigned(
    table: Table,
    expected: Mapping[str, object],
    renamed: Mapping[str, str],
    template_name: str,
) -> dict[str, HardPoint]:
    """The row of each name of the template."""
    by_folded = {folded(name): name for name in expected}
    ways = {folded(own): target for own, target in renamed.items()}
    rows = {folded(point.name) for point in table.points}
    for own, target in renamed.items():
        if folded(own) not in rows:
            raise UsageError(f"--rename {own}={target}: the table has no point {own!r}; check it")
        if folded(target) not in by_folded:
            raise UsageError(
                f"--rename {own}={target}: {template_name} has no hard point {target!r}; "
                f"its hard points are {listed(expected)}"
            )
    taken: dict[str, HardPoint] = {}
    wrong = []
    for point in table.points:
        name = by_folded.get(folded(ways.get(folded(point.name), point.name)))
        if name is None:
            wrong.append(_unknown(point, expected, taken, template_name))
        elif name in taken:
            message = f"the hard point {name} is given twice, first in line {taken[name].at.line}"
            hint = "leave one of the rows out"
            wrong.append(Diagnostic("given-twice", "error", message, point.at, hint=hint))
        else:
            taken[name] = point
    if wrong:
        raise InvalidFile(wrong)
    return taken


def _unknown(
    point: HardPoint, expected: Iterable[str], taken: Iterable[str], template_name: str
) -> Diagnostic:
    name = shortened(point.name)
    close = nearest(folded(point.name), [one for one in expected if one not in taken])
    meant = f"did you mean {close}? " if close else ""
    hint = (
        f"{meant}its hard points are {listed(expected)}; rename the row, or say which is meant by "
        f"--rename '{name}={close or next(iter(expected))}'"
    )
    message = f"{template_name} has no hard point {name!r}"
    return Diagnostic("unknown-hard-point", "error", message, point.at, hint=hint)


def _notes(
    table: Table,
    taken: Mapping[str, HardPoint],
    expected: Iterable[str],
    template_name: str,
    file: str,
) -> list[Diagnostic]:
    notes = []
    missing = [name for name in expected if name not in taken]
    if missing:
        message = f"the table lacks {len(missing)} of the hard points: {listed(missing)}"
        hint = f"they stay as in {template_name}; add rows for them"
        notes.append(Diagnostic("hard-points-missing", "warning", message, None, hint=hint))
    if table.ignored:
        message = f"columns of the table are left out: {listed(table.ignored)}"
        notes.append(Diagnostic("left-out", "note", message, Place(file, 1, 1)))
    return notes


# The table itself.


def read_table(text: str, file: str, dimensions: int = 3) -> Table:
    """The rows of a table of hard points.

    Lines that are empty or begin with # are passed over. Where semicolons or tabs separate the
    columns, numbers may have a decimal comma.

    Args:
        text: the table.
        file: its name in messages.
        dimensions: 3, or 2 in a plane, where z may be left out or is 0.

    Raises:
        InvalidFile: with every row that is wrong, and why.
    """
    lines = [
        (number, line)
        for number, line in enumerate(text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        hint = "write a row for each point: name, x, y, z"
        refuse("empty-table", "the table has no rows", Place(file, 1, 1), hint)
    if len(lines) > MOST_POINTS:
        place = Place(file, lines[MOST_POINTS][0], 1)
        hint = f"keep at most {MOST_POINTS} rows"
        refuse("table-too-long", "the table is too long", place, hint, f"{len(lines)} rows")
    first = lines[0][1]
    separator = next((one for one in "\t;" if one in first), ",")
    rows = [(number, line, _cells(line, separator)) for number, line in lines]
    # spreadsheets write rows of empty cells
    rows = [row for row in rows if any(row[2])]
    if not rows:
        hint = "write a row for each point: name, x, y, z"
        refuse("empty-table", "the table has no rows", Place(file, lines[0][0], 1), hint)
    heading = _heading(rows[0], file, dimensions)
    wrong: list[Diagnostic] = []
    points = []
    for number, line, cells in rows[heading.rows :]:
        found = _point(Place(file, number, 1), line, cells, heading, separator != ",")
        if isinstance(found, HardPoint):
            points.append(found)
        else:
            wrong.append(found)
    if wrong:
        raise InvalidFile(wrong[:50])
    if not points:
        place = Place(file, rows[-1][0], 1)
        refuse("empty-table", "the table has no rows", place, "write a row for each point")
    return Table(tuple(points), heading.unit, heading.ignored)


class Heading(NamedTuple):
    """Which column is what: the name, then the coordinates; None: z of a table in a plane that has
    none."""

    name: int
    places: tuple[int | None, ...]
    dimensions: int
    rows: int = 0
    unit: str | None = None
    ignored: tuple[str, ...] = ()


def _cells(line: str, separator: str) -> list[str]:
    try:
        return [
            cell.strip()
            for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True))
        ]
    except (csv.Error, StopIteration):
        return [cell.strip() for cell in line.split(separator)]


def _heading(row: tuple[int, str, list[str]], file: str, dimensions: int) -> Heading:
    number, _, cells = row
    words = [_HEADING.fullmatch(cell) for cell in cells]
    heads = [word[1].casefold() if word else "" for word in words]
    if not ({"x", "y"} <= set(heads)):
        return Heading(0, (1, 2, 3 if dimensions == 3 or len(cells) > 3 else None), dimensions)
    place = Place(file, number, 1)
    own = next((i for i, head in enumerate(heads) if head in _NAME_HEADINGS), None)
    if own is None or (dimensions == 3 and "z" not in heads):
        lack = "name" if own is None else "z"
        hint = "head the columns name, x, y, z"
        refuse("no-column", f"the header has no column {lack}", place, hint)
    units = {word[2] for word, head in zip(words, heads, strict=True) if word and head in _AXES}
    units.discard(None)
    if len(units) > 1:
        hint = "write all coordinates in one unit"
        refuse("several-units", "the columns have several units", place, hint, listed(units))
    places = tuple(heads.index(axis) if axis in heads else None for axis in _AXES)
    ignored = [c for i, c in enumerate(cells) if c and i != own and i not in places]
    return Heading(own, places, dimensions, 1, next(iter(units), None), tuple(ignored))


def _point(
    at: Place, line: str, cells: list[str], heading: Heading, decimal_comma: bool
) -> HardPoint | Diagnostic:
    if len(cells) <= max(heading.name, *(p for p in heading.places if p is not None)):
        hint = "write name, x, y, z, with commas, semicolons or tabs between them"
        return Diagnostic(
            "row-too-short", "error", "a cell is missing", at, f"{len(cells)} cells", hint=hint
        )
    name = cells[heading.name]
    if not folded(name):
        hint = "write the name of the point"
        return Diagnostic("no-name", "error", "the row has no name", at, hint=hint)
    place = []
    for axis, column in zip(_AXES, heading.places, strict=True):
        if column is None:
            continue
        cell = cells[column]
        number = cell.replace(",", ".") if decimal_comma else cell
        value = float(number) if NUMBER.fullmatch(number) else math.nan
        if not abs(value) <= tolerances.LARGEST_IMPORTED:
            where = at._replace(column=max(line.find(cell), 0) + 1)
            most = f"{tolerances.LARGEST_IMPORTED:g}"
            hint = f"write a number without a unit, such as 12.5, below {most}"
            message = f"{axis} of {shortened(name)} is no number: {shortened(cell)!r}"
            return Diagnostic("not-a-number", "error", message, where, hint=hint)
        place.append(value)
    if heading.dimensions == 2 and any(place[2:]):
        hint = "the template is plane; leave z out, or write 0"
        return Diagnostic("off-plane", "error", f"z of {shortened(name)} is not 0", at, hint=hint)
    return HardPoint(name, tuple(place[: heading.dimensions]), at)
