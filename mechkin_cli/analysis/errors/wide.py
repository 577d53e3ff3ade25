"""The rows of a run by the kernel's double-double unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.analysis.errors.repeated import WideRun
    from mechkin_cli.analysis.sweep import Result


def wide_run(result: Result) -> WideRun:
    """What repeats the rows of a run."""
    raise NotImplementedError
