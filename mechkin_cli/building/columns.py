"""Checks the columns of the tables once: names, dimensions, one number per row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Fields, Path
from mechkin_cli.expressions import ExpressionError, Quantity, UnknownName, Vector, parse
from mechkin_cli.mechanism.derived_quantities import hint_of
from mechkin_cli.mechanism.quantities import Wanted
from mechkin_cli.schema import tables as written
from mechkin_cli.tables.layout import (
    ROW_TEXTS,
    ColumnLayout,
    PrintedRemark,
    PublishedValues,
    TableLayout,
)


def build_tables(
    fields: Fields, sections: Sequence[written.Table], quantities: Mapping[str, Wanted]
) -> tuple[TableLayout, ...]:
    """The tables' layouts; what is wrong with a column is noted in `fields`."""
    tables = []
    for i, section in enumerate(sections):
        columns = []
        for k, column in enumerate(section.columns):
            path: Path = ("tables", i, "columns", k)
            if fields.document.node((*path, "value")) is not None:
                path = (*path, "value")
            layout = _column(fields, path, column, quantities)
            if layout is not None:
                columns.append(layout)
        title = section.title or section.name
        printed = _published(section.published)
        tables.append(TableLayout(section.name, title, tuple(columns), printed))
    return tuple(tables)


def _published(section: written.PublishedValues | None) -> PublishedValues | None:
    if section is None:
        return None
    remarks = tuple(PrintedRemark(r.text, r.columns or (), r.data or ()) for r in section.remarks)
    return PublishedValues(section.file, remarks, section.rows_by)


def _column(
    fields: Fields, path: Path, column: written.Column, quantities: Mapping[str, Wanted]
) -> ColumnLayout | None:
    try:
        expression = parse(column.value)
        if column.value.strip() not in ROW_TEXTS:
            found = expression.evaluate(_Sample(fields, quantities), fields.units)
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


class _Sample:
    """Resolves names to one-row stand-ins of the right dimension."""

    def __init__(self, fields: Fields, quantities: Mapping[str, Wanted]) -> None:
        self.fields = fields
        self.parameters = fields.parameters
        self.quantities = quantities

    def __call__(self, name: str) -> Quantity:
        if name in self.parameters:
            return self.parameters[name]
        if name in ROW_TEXTS:
            raise ExpressionError(f"{name} is a text, no number", 0, "make it a column of its own")
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        wanted = self.quantities.get(name)
        if wanted is None:
            known = [*self.parameters, *self.quantities, *ROW_TEXTS]
            raise UnknownName(name, known, hint_of(name))
        one = np.ones(1)
        value = Vector(one, one, one) if wanted.vector else one
        return Quantity(value, wanted.dimension)


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
