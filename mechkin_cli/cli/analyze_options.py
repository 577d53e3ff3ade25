"""What `mechkin analyze` is told: its options, checked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import tables as table_room
from mechkin_cli.cli.messages import FORMS
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import USUAL_FORMATS, WRITERS, refuse_without_library

if TYPE_CHECKING:
    from mechkin_cli.model import Model

DECIMAL_MARKS = ("point", "comma")
"""What `--decimal` takes."""


MOST_LABELS = 30
"""Labels that are listed where none is like the one asked for."""


class AnalyzeCommand(NamedTuple):
    """The options of the command, as `commands` declares them."""

    files: list[Path]
    out: Path | None = None
    format: list[str] | None = None
    units: bool = False
    decimal: str = DECIMAL_MARKS[0]
    set_: list[str] | None = None
    mode: str | None = None
    table: list[str] | None = None
    columns: list[str] | None = None
    summary_only: bool = False
    lanes: int = 0
    threads: int = 0
    certify: bool = False
    strict: bool = False
    errors: bool = False
    view: bool = False
    explain: bool = False
    messages: str | None = None
    json: bool = False
    quiet: bool = False

    @property
    def asked_formats(self) -> tuple[str, ...]:
        """The formats that are asked for, as they are written."""
        return tuple(dict.fromkeys(name for text in self.format or () for name in text.split(",")))

    @property
    def formats(self) -> tuple[str, ...]:
        """The formats of tables.

        Raises:
            UsageError: one is not known, or needs a library that is not installed.
        """
        usual = USUAL_FORMATS[:1] if self.summary_only else USUAL_FORMATS
        formats = self.asked_formats or usual
        for name in formats:
            if name not in WRITERS:
                cure = f"; for messages write --messages {name}" if name in FORMS else ""
                raise UsageError(f"--format {name}: formats are {', '.join(WRITERS)}{cure}")
        refuse_without_library(formats)
        return formats

    @property
    def decimal_comma(self) -> bool:
        """Whether numbers of CSV, Markdown and LaTeX are written with a comma.

        Raises:
            UsageError: the mark is not known.
        """
        if self.decimal not in DECIMAL_MARKS:
            raise UsageError(f"--decimal {self.decimal}: marks are {' and '.join(DECIMAL_MARKS)}")
        return self.decimal == DECIMAL_MARKS[1]

    @property
    def writes(self) -> bool:
        """Whether files are written."""
        return not self.json or self.out is not None or bool(self.format) or self.view


def with_labels(command: AnalyzeCommand, model: Model) -> AnalyzeCommand:
    """The command with the labels of the columns that it asks for, and only the tables that have
    one of them.

    Raises:
        UsageError: no table has a column of a label, or there is no label.
    """
    if command.columns is None:
        return command
    import csv

    wanted = table_room.chosen(tuple(model.tables), command.table)
    labels = {table.name: [column.label for column in table.columns] for table in wanted}
    known = dict.fromkeys(label for listed in labels.values() for label in listed)
    asked: list[str] = []
    for text in command.columns:
        # as the header of CSV is written, since a label may have a comma
        cells = [text] if text in known else next(csv.reader([text], skipinitialspace=True), [])
        if text.count('"') % 2 and text not in known:
            raise UsageError(f"--columns: {text[:LONGEST_NAME]} has a quote that does not end")
        asked += [cell if cell in known else cell.strip() for cell in cells]
    if not any(asked):
        first = ", ".join([*known][:MOST_LABELS])
        raise UsageError(f"--columns: no label is given; columns are {first}")
    for label in asked:
        if label not in known:
            some = [*list(known)[:MOST_LABELS], *(["..."] if len(known) > MOST_LABELS else [])]
            hint = nearest_hint(label, known) or f"columns are {', '.join(some)}"
            raise UsageError(f"--columns: no table has a column {label[:LONGEST_NAME]}; {hint}")
    tables = [name for name, own in labels.items() if set(own).intersection(asked)]
    return command._replace(columns=list(dict.fromkeys(asked)), table=tables)
