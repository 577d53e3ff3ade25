"""`Analysis.plot`: pictures of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.interface.arguments import a_path, a_text, texts
from mechkin_cli.runs import SWEEP

if TYPE_CHECKING:
    from pathlib import Path

    from mechkin_cli.plots.figure import Figure
    from mechkin_cli.plots.picture import Picture


class Plotted:
    """The pictures of an analysis."""

    def plot(
        self,
        *y: str,
        x: str | None = None,
        table: str | None = None,
        to: str | Path | None = None,
    ) -> Figure:
        """Draws columns, quantities or expressions with matplotlib (the extra `plot`).

        Numbers stand over `x`, a panel for each unit; vectors are drawn in a plane with equal axes:
        `r.plot("tip.position")` is a coupler curve, `r.plot("A.force")` a polar diagram.

        Args:
            y: labels of columns, quantities or expressions; none: those of a table, as its `plot:`
                says.
            x: against which they stand; None: time where the run has one, else its first input
                that moves.
            table: the table that is drawn where no `y` is given; None: the first.
            to: a file to write it to, .svg, .png or .pdf.

        Raises:
            UsageError: matplotlib is not there, nothing to draw, words, no such table, or what
                cannot stand in one picture.
            ExpressionError: an unknown name, or dimensions that do not fit.

        Example:
            r.plot("O1.effort", "O4.theta")
            r.plot(to="table.svg")
        """
        from mechkin_cli.plots.figure import drawn, format_of, image

        path = None if to is None else a_path("to", to, 'the path of a picture such as "p.svg"')
        found = self.picture(y, x, table)
        if path is not None:
            from mechkin_cli.tables.files import write_files

            write_files(path.parent, {path.name: image(found, format_of(path))})
        return drawn(found)

    def picture(
        self: Any, y: Sequence[str] = (), x: str | None = None, table: str | None = None
    ) -> Picture:
        """What `plot` draws, as plain data; arguments and errors are those of `plot`."""
        from mechkin_cli.plots.of_tables import table_picture
        from mechkin_cli.plots.picture import picture

        y = texts("y", y, '["O4.theta"]')
        if x is not None:
            a_text("x", x, '"O4.theta"')
        if table is not None:
            a_text("table", table, '"table_03"')
        if y:
            title = self.model.name if self.run == SWEEP else self.run
            return picture(self, title, y, x)
        known = {layout.name: number for number, layout in enumerate(self.layouts)}
        if not known:
            raise UsageError("there is no table to draw; name what to draw")
        name = next(iter(known)) if table is None else table
        if name not in known:
            tables = ", ".join(known)
            raise UsageError(f"there is no table {name[:LONGEST_NAME]}; tables are {tables}")
        number = known[name]
        return table_picture(self, self.layouts[number], self.tables[number], x)
