"""The width of the kernel's packs, how many rows march together, and the threads that share rows.

The widest that the machine has, and as many threads as pay, unless others are forced for the whole
process. No result depends on either; the path of a sweep is followed one row at a time, in the
narrowest packs, by one thread.
"""

from __future__ import annotations

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel
from mechkin_cli.tolerances import MOST_THREADS

INSTRUCTIONS = {2: "SSE2", 4: "AVX2", 8: "AVX-512"}
"""What a width needs of an x86 processor."""

_forced = 0
_forced_threads = 0


def widths() -> tuple[int, ...]:
    """The widths that this machine has."""
    return tuple(lanes for lanes in INSTRUCTIONS if lanes <= _kernel.widest)


def force_width(lanes: int) -> None:
    """Makes every call of the kernel that names no width run in this one; 0 takes it back.

    Raises:
        UsageError: the machine does not have this width.
    """
    check_width(lanes)
    global _forced
    _forced = lanes


def check_width(lanes: int) -> None:
    """Raises UsageError where `lanes` is neither 0 nor a width that this machine has."""
    if lanes and lanes not in widths():
        known = ", ".join(map(str, widths()))
        raise UsageError(f"lanes {lanes}: this machine has {known}; 0 takes the widest")


def width(lanes: int = 0) -> int:
    """The width that a call asking for `lanes` (0: any) runs in."""
    return lanes or _forced or _kernel.widest


def force_threads(threads: int) -> None:
    """Makes every call of the kernel that names no number of threads run in this many; 0 takes it
    back.

    Raises:
        UsageError: not a whole number from 0 to MOST_THREADS.
    """
    check_threads(threads)
    global _forced_threads
    _forced_threads = threads


def check_threads(threads: int) -> None:
    """Raises UsageError where `threads` is not a whole number from 0 to MOST_THREADS."""
    whole = isinstance(threads, int) and not isinstance(threads, bool)
    if not whole or not 0 <= threads <= MOST_THREADS:
        raise UsageError(
            f"threads {threads}: a whole number from 1 to {MOST_THREADS}; 0 takes as many as pay"
        )


def threads_for(rows: int, threads: int = 0) -> int:
    """The threads that a call over some rows runs in when it asks for `threads` (0: any).

    Raises:
        UsageError: as `check_threads`.
    """
    check_threads(threads)
    asked = threads or _forced_threads
    if asked:
        return asked
    most = rows // tolerances.THREAD_ROWS
    return 1 if most < 2 else min(most, _kernel.available_processors())
