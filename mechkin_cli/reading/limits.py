"""How large a mechanism file may be: limits that keep bad input from exhausting time or memory.

The largest mechanism file written by hand has some thousand lines; each limit leaves a factor of
ten or more above that and still keeps the work of the slowest parser within seconds.
"""

from __future__ import annotations

from typing import Final

MOST_BYTES: Final = 1 << 20
"""Size of the file in bytes."""

MOST_EVENTS: Final = 100_000
"""YAML events (scalars, starts and ends of lists and mappings) in a file."""

MOST_LEVELS: Final = 32
"""Lists and mappings inside one another; format 1 itself needs eight."""

MOST_PIECES: Final = 100
"""Pieces of one expression that YAML has cut at its commas; no function takes so many values."""

LONGEST_EXPRESSION: Final = 4000
"""Characters of a line searched for the end of an expression that YAML has cut."""

MOST_DIAGNOSTICS: Final = 50
"""Messages shown for one file; the rest is counted in one more message."""
