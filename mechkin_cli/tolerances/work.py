"""How much a run may ask for, and when threads pay."""

from __future__ import annotations

from typing import Final

# --- memory --------------------------------------------------------------------------------------

MOST_NUMBERS: Final = 40_000_000
"""Numbers of a run: per row the cells of all tables, the columns of rows.csv and the freedoms of
all joints. Measured per number: 40 bytes with CSV, 80 with Markdown, 110 with JSON; 4.4 GB in
all."""

MOST_KEPT: Final = 400_000_000
"""Numbers that the results of variants may have together; 3.2 GB, the machine's memory before
anything is computed with them."""

MOST_VARIANTS: Final = 1_000_000_000
"""Variants of a study: a day of one machine at 0.1 ms each, and 100 GB of files."""

MOST_DRAWN: Final = 50_000_000
"""Numbers of a Latin hypercube, which is drawn whole: 0.4 GB, and as much again while it is
drawn."""

MOST_SAMPLED: Final = 100_000_000
"""Numbers that the samples of tolerances may hold in memory: 0.8 GB, and as much again while they
are put together."""

FEWEST_SAMPLES: Final = 2
"""Samples of tolerances: a standard deviation of one is none."""

MOST_TABLE_TEXT: Final = 64 << 20
"""Bytes of a study's table of variants: it is held in memory, ten times as large."""

MOST_NAMES: Final = 100_000
"""Names in one list that a caller gives: more come from an iterable without an end."""

# --- threads -------------------------------------------------------------------------------------

MOST_THREADS: Final = 1024
"""As many threads as may be asked for."""

THREAD_ROWS: Final = 512
"""Rows that make a thread worth waking: at 0.3 us a row or more, ten times the 15 us that it takes
to wake and to wait for it."""

CELLS_PER_THREAD: Final = 50_000
"""Cells of a table that are worth a thread of their own: 2 ms of work against 0.05 ms to start
one."""

MOST_TEXT_THREADS: Final = 64
"""Threads that write one table: beyond, the memory takes longer than the digits."""
