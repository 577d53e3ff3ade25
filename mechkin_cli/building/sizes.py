"""Limits on what a well-formed file may ask for: equations of one block, numbers to keep.

A file within all limits of the reader can still ask for more than a machine has: the work grows
with the cube of the equations that must be solved together, and a sweep is a single line.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.graph.errors import listed
from mechkin_cli.tables.layout import TableLayout

MOST_EQUATIONS: Final = 120
"""Closing equations of one block. A Stewart platform has 6, with universal joints 15. The work of a
row grows with their cube (a ladder of four-bars driven at its far end, with a search of its
assemblies: 50 equations 9 s, 120 equations 28 s); blocks and loops may be any number."""

MOST_NUMBERS: Final = 40_000_000
"""Numbers of a run: per row the cells of all tables, the columns of rows.csv and the freedoms of
all joints. Measured per number: 40 bytes with CSV, 80 with Markdown, 110 with JSON; 4.4 GB in
all."""

_ROW_COLUMNS: Final = 6
"""Columns of rows.csv beside the inputs."""


def check_blocks(fields: Fields, graph: SolverGraph) -> bool:
    """Whether every block is small enough; if not, the first that is not is noted."""
    for block in graph.blocks:
        if block.equations <= MOST_EQUATIONS:
            continue
        closings = [graph.closings[c] for c in block.closings]
        members = {graph.edges[k].joint.name for closing in closings for k, _ in closing.loop}
        joints = sorted(members | {closing.joint.name for closing in closings})
        fields.error(
            "block-too-large",
            ("joints",),
            f"{len(closings)} loops through {len(joints)} joints must be solved together: "
            f"{listed(joints)}",
            "drive a coordinate inside, or write parts that do not act on each other in files of "
            "their own",
            measured=f"{block.equations} closing equations",
            limit=f"{MOST_EQUATIONS} closing equations",
            numbers=(Number("closing equations", block.equations, limit=MOST_EQUATIONS),),
        )
        return False
    return True


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
