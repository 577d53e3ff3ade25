"""`coefficients:` - the dense system of all reactions at one row, as a table of coefficients."""

from typing import Annotated

from mechkin_cli.schema.base import NOTHING, Section
from mechkin_cli.schema.rules import After, Barred, Limits
from mechkin_cli.schema.scalars import Name, Text, WholeNumber
from mechkin_cli.schema.tables import TAKEN_FOR_EDITORS, TableName, free_name


class Coefficients(Section):
    """The equations of equilibrium of all links and the conditions of all pairs at one row.

    NAME.csv has an equation per row and an unknown per column, NAME_unknowns.csv the unknowns with
    their values.
    """

    name: Annotated[TableName, After(free_name), Barred(TAKEN_FOR_EDITORS)]
    """Name of the files written, without ending."""
    title: Text | None = None
    """Heading in Markdown; left out, the name."""
    row: Annotated[WholeNumber, Limits(ge=1)] = 1
    """Row of the sweep, counted from 1."""
    along: dict[Name, Annotated[tuple[Name, ...], Limits(min_length=2, max_length=2)]] = NOTHING
    """Directions of two force components of a ball; the third is along their cross
    product; left out, those along x, y and z."""
    counted: Annotated[WholeNumber, Limits(ge=1)] | None = None
    """Number of unknowns that the source counts, to stand beside those here; left out, none
    does."""
