"""The way in, as `mechkin` and as `python -m mechkin_cli`. It loads nothing before interrupts are
quiet; `cli/run.py` does the rest."""

from __future__ import annotations

import contextlib
import gc
import os
import sys

from mechkin_cli.cli.interrupts import end_quietly, leave

TYPE_CHECKING = False  # typing is not loaded for its flag alone

if TYPE_CHECKING:
    from typing import NoReturn


def main() -> NoReturn:
    """Runs the command line and exits with its code."""
    end_quietly()
    gc.disable()  # until the command is loaded
    try:
        if os.name == "nt":
            from mechkin_cli.cli.windows import prepare

            prepare()
        from mechkin_cli.cli.run import run

        code = run()
    finally:
        gc.enable()
    leave(code)


def program() -> NoReturn:
    """As `main`, for a process of its own: its memory is not taken apart at the end, which takes
    longer than to solve a short sweep."""
    try:
        main()
    except SystemExit as ended:
        # threads, and what waits for the end of the process, are ended by Python
        if isinstance(ended.code, int) and "threading" not in sys.modules and _is_flushed():
            os._exit(ended.code)
        raise


def _is_flushed() -> bool:
    """Whether all that was said is out; a stderr that takes nothing does not count."""
    with contextlib.suppress(OSError, ValueError):
        if sys.stderr is not None:
            sys.stderr.flush()
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except (OSError, ValueError):
        return False
    return True


if __name__ == "__main__":
    program()
