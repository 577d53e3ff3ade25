"""What a file may say: numbers, rows, tables, drawings."""

from __future__ import annotations

from typing import Final

# --- numbers -------------------------------------------------------------------------------------

LARGEST_NUMBER: Final = 1e100
"""SI value of a field above which it is a slip of the pen: products of three such values are the
last that stay doubles (1.8e308); beyond, cells would be empty without a reason."""

LARGEST_DRAWN: Final = 1e300
"""Size in its unit above which no curve is drawn: the margins and steps of its axis would be no
doubles."""

SMALLEST_DIVISOR: Final = 1e-60
"""SI value of a duration, a radius or a number of teeth below which it is a slip of the pen: the
third derivative of a rise of 1e100 over that time is the last that stays a double."""

LARGEST_TURNS: Final = float(1 << 52)
"""Whole turns beyond which an angle says nothing of the place within a turn: doubles so large have
no places behind the point. A slip of the pen: the earth has turned 2e12 times."""

SMALLEST_SIZE: Final = 1e-100
"""Size of a drawing in m below which it is a slip of the pen: the inverse of its square is the last
that stays a double with what it is multiplied by; atoms are drawn with 1e-10."""

GRAVITY_ON_EARTH: Final = 0.025
"""Parts of standard gravity by which a number may differ and still be meant as gravity: on Earth it
varies by 0.004, and 10 m/s^2 is its round number."""

LARGEST_FACTOR: Final = 1e30
"""Size in SI beyond which (or below whose inverse) a unit of a file is taken for a mistake."""

LARGEST_CONVERSION: Final = 1e290
"""Conversion factor beyond which (or below whose inverse) products with numbers of a file are no
doubles any more."""

INDEFINITE_BUSHING: Final = 1e-9
"""Least eigenvalue of a bushing's matrix, scaled to a diagonal of ones, down to minus which it is
taken for semidefinite: measured matrices are printed with nine digits at most, and a direction that
is meant to be free comes out as zero to those."""

# --- rows and tables -----------------------------------------------------------------------------

OVERSHOOT: Final = 0.01
"""Parts of the range of a table's values by which the curve through them may leave it before a note
says so: less is not seen in a figure, and smooth data sampled coarsely do as much."""

LAST_ROW: Final = 1e-9
"""Steps by which the last row may lie beyond the end of a sweep, part of format 1: the quotient of
written numbers is wrong by 1e-16 times the number of rows, of which there are at most 1e7."""

EQUAL_STEPS: Final = 1e-9
"""Parts of a step by which rows of a cycle may be unequal, and of a turn by which it may be open:
rows by from and step differ by rounding, 1e-15 of their values."""

TABLE_END: Final = 1e-9
"""Parts of a table's range by which a row may lie beyond its ends and still take the end's value:
coordinates at an end are computed to 1e-12, and written numbers have nine digits and more."""

AT_LIMIT: Final = 1e-9
"""rad, and slides in parts of the mechanism's size: a coordinate so far beyond its limit is still
at it; positions are right to 1e-12, and written numbers have nine digits and more."""

# --- drawing -------------------------------------------------------------------------------------

AXES_SQUARE: Final = 1e-9
"""Inertia axes must be square to this (cosine): typed numbers have nine digits and more."""

UNPHYSICAL_INERTIA: Final = 1e-9
"""Parts of the largest eigenvalue by which a tensor may miss the triangle inequality of a real
body."""

PARALLEL: Final = 1e-9
"""Sine of the angle below which a reference direction is parallel to the axis it should stand
square to."""

FLEET: Final = 1e-7
"""Angle (rad) by which a cable may leave the plane of a pulley, or the line about which one
swivels: drawings have eight digits, and closure leaves as many. Its length is wrong by half of the
square, 5e-15."""

LARGEST_FLANK: Final = 1.4
"""Angle (rad) of a thread's flank against the plane square to the axis, some 80 degrees: no thread
is nearly a cylinder, and the normal load goes with 1 / cos."""


# How much a run may ask for, and when threads pay.

# --- memory --------------------------------------------------------------------------------------

MOST_NUMBERS: Final = 40_000_000
"""Numbers of a run: per row the cells of all tables, the columns of rows.csv and the freedoms of
all joints. Measured per number: 40 bytes with CSV, 80 with Markdown, 110 with JSON; 4.4 GB in
all."""

LONG_RUN: Final = (1 << 16) + 1
"""Rows of a run from which on its numbers are made part by part, as they are wanted."""

MOST_ROWS: Final = 1e12
"""Rows of a sweep: a week of a machine that closes a million of them in a second."""

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

# --- files of tables -----------------------------------------------------------------------------

TEXT_ROOM: Final = 2 << 20
"""Bytes of memory, for each thread, that lines of a table are written into at a time: sixty
thousand numbers, which are worth a call of the thread, and still lie in a processor's cache when
they go on to a checksum and a file."""

PACKED_PART: Final = 1 << 20
"""Bytes that are packed at a time, so that a packed file depends on its text alone, and not on the
blocks that the text comes in."""

HELD_BYTES: Final = 1 << 20
"""Bytes of a file that are held in memory before it begins on the disk: smaller files are compared
with what stands there, and need no folder of their own where nothing changed."""

ROW_GROUP: Final = 65536
"""Rows of a row group of Parquet and of a batch of Arrow, whatever the blocks were: half a MB a
column in memory, and enough for readers that share groups among their threads."""


# Where a search for dimensions steps, and what it takes as held or reached.

FIT_STEP: Final = 1e-3
"""Of a parameter's bounds: steps of the four-point differences. Their error is a thirtieth of its
fourth power, 3e-14 of the fifth derivative; rounding leaves 1e-15 divided by it."""

FIT_NARROW_STEP: Final = 1e-6
"""Of a parameter's bounds: the step where the wider ones leave what assembles."""

FIT_ENDED: Final = 1e-14
"""Relative change of cost, of dimensions and of the gradient at which a local search ends: what
rounding leaves of sums of squares."""

FIT_HELD: Final = 1e-6
"""Of a bound's scale: how far a constraint may be exceeded and still be called held. The
constrained search leaves 1e-8; a millionth of a transmission angle is no angle to build."""

FIT_AT_BOUND: Final = 1e-6
"""Of a parameter's bounds: nearer than this to one of them, it is at the bound."""

WRAP_ROUNDING: Final = 1e-15
"""What a wrapped angle may be beyond half a turn by rounding, in rad, for the first turn; with more
turns as much times their square, which bounds what the products of many turns leave."""


# Values written back into a file.

FOLLOWS: Final = 1e-14
"""Relative: by this part an expression that follows others may be off the value that it is to have,
which a few operations round."""
