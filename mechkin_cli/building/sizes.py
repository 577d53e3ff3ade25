"""Limits on what a well-formed file may ask for: loops to choose closings of, numbers to keep.

A file within all limits of the reader can still ask for more than a machine has: the choice of
closing joints grows exponentially with the number of loops, and a sweep is a single line.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.model import GROUND_NAME, Mechanism
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.tables.layout import TableLayout

MOST_LOOPS: Final = 12
"""Independent loops. A Stewart platform has 5. Measured on the slowest graphs found (six links,
each joined to each other): 0.7 s for 10 loops, 4 s for 12, 90 s for 15."""

MOST_NUMBERS: Final = 40_000_000
"""Numbers of a run: per row the cells of all tables, the columns of rows.csv and the freedoms of
all joints. Measured per number: 40 bytes with CSV, 80 with Markdown, 110 with JSON; 4.4 GB in
all."""

_ROW_COLUMNS: Final = 6
"""Columns of rows.csv beside the inputs."""


def check_loops(fields: Fields, mechanism: Mechanism) -> bool:
    """Whether the mechanism has few enough loops; if not, that is noted."""
    joints = tuple(mechanism.joints)
    loops = len(joints) - sum(name != GROUND_NAME for name in mechanism.links)
    if loops <= MOST_LOOPS:
        return True
    fields.error(
        "too-many-loops",
        ("joints",),
        f"the {len(joints)} joints close too many independent loops",
        "write parts that do not act on each other in files of their own",
        measured=f"{loops} loops",
        limit=f"{MOST_LOOPS} loops",
        numbers=(Number("loops", loops, limit=MOST_LOOPS),),
    )
    return False


def check_memory(
    fields: Fields, mechanism: Mechanism, motion: Motion, tables: Sequence[TableLayout]
) -> None:
    """Notes a run whose numbers would not fit into memory."""
    cells = sum(len(table.columns) for table in tables)
    freedoms = sum(joint.type.freedoms for joint in mechanism.joints.values())
    per_row = cells + _ROW_COLUMNS + len(motion.inputs) + freedoms
    if motion.rows * per_row <= MOST_NUMBERS:
        return
    fields.error(
        "too-many-numbers",
        ("motion", "inputs"),
        f"the run has too many numbers, {motion.rows} rows of {per_row}",
        "take a larger step or fewer columns, or split the sweep into several files",
        measured=f"{motion.rows * per_row:.4g} numbers",
        limit=f"{MOST_NUMBERS:.4g} numbers",
        numbers=(Number("numbers", motion.rows * per_row, limit=MOST_NUMBERS),),
    )
