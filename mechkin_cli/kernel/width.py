"""The width of the kernel's packs: how many rows march together.

The widest that the machine has, unless one is forced for the whole process. No result depends on
it; the path of a sweep is followed one row at a time, in the narrowest packs.
"""

from __future__ import annotations

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel

INSTRUCTIONS = {2: "SSE2", 4: "AVX2", 8: "AVX-512"}
"""What a width needs of an x86 processor."""

_forced = 0


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
