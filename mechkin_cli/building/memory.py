"""How many rows a run may have: what it keeps must fit into memory.

A sweep is a single line of the file, so its rows are counted before any of them is made.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.tables.layout import default_table
from mechkin_cli.tolerances import MOST_NUMBERS

_ROW_COLUMNS: Final = 6
"""Columns of rows.csv beside the inputs."""


class RowLimit(NamedTuple):
    """Numbers that each row keeps: the cells of all tables, the columns of rows.csv and the
    freedoms of all joints."""

    per_row: int

    def is_exceeded(self, fields: Fields, path: Path, rows: float) -> bool:
        """Whether so many rows are too many; that is noted at `path`, where they are asked for."""
        numbers = rows * self.per_row
        if numbers <= MOST_NUMBERS:
            return False
        most = MOST_NUMBERS // self.per_row
        fields.error(
            "too-many-numbers",
            path,
            f"the run has too many numbers, {rows:.12g} rows of {self.per_row}",
            "take a larger step or fewer columns, or split the sweep into several files",
            measured=f"{numbers:.12g} numbers",
            limit=f"{MOST_NUMBERS} numbers, {most} rows",
            numbers=(Number("numbers", float(numbers), limit=MOST_NUMBERS),),
        )
        return True


def row_limit(file: MechanismFile, joints: Mapping[str, Joint]) -> RowLimit:
    """What a row of the file's run keeps."""
    motion = file.motion
    inputs = list(motion.inputs) if motion else []
    cells = sum(len(table.columns) for table in file.tables)
    if not file.tables:
        names = [name for joint in joints.values() for name in joint.coordinates]
        timed = motion is not None and motion.time is not None
        cells = len(default_table(names, inputs, timed=timed).columns)
    freedoms = sum(joint.type.freedoms for joint in joints.values())
    return RowLimit(cells + _ROW_COLUMNS + len(inputs) + freedoms)
