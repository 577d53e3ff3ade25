"""The way in. It loads nothing before interrupts are quiet; `run` does the rest."""

from __future__ import annotations

from mechkin_cli.cli.interrupts import end_quietly, leave

TYPE_CHECKING = False  # typing is not loaded for its flag alone

if TYPE_CHECKING:
    from typing import NoReturn


def main() -> NoReturn:
    """Runs the command line and exits with its code."""

    end_quietly()
    from mechkin_cli.cli.run import run

    leave(run())
