"""The way in. It loads nothing before interrupts are quiet; `run` does the rest."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> NoReturn:
    """Runs the command line and exits with its code."""
    from mechkin_cli.cli.interrupts import end_quietly, leave

    end_quietly()
    from mechkin_cli.cli.run import run

    leave(run())
