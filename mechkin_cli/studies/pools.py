"""Processes of this machine that compute pieces of a study."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from multiprocessing import resource_tracker

from mechkin_cli.diagnostics import UsageError


def processes(count: int) -> ProcessPoolExecutor:
    """An executor of so many new processes, which end with this one whatever ends it.

    Raises:
        UsageError: they end before they compute anything.
    """
    context = multiprocessing.get_context("spawn")
    executor = ProcessPoolExecutor(count, mp_context=context, initializer=_begin)
    try:
        executor.submit(os.getpid).result()
    except BrokenExecutor:
        raise UsageError(
            "new processes end before they compute anything; a script that starts them does its "
            'work below `if __name__ == "__main__":`, since each of them reads it, too'
        ) from None
    return executor


def end_without_warnings() -> None:
    """For a command that a signal ends at once: what is left of its pools is cleared away by
    Python's tracker, which is to do so without a warning on the command's stderr.

    Before the first pool; a tracker that runs already is left as it is.
    """
    own = "ignore::UserWarning:multiprocessing.resource_tracker"
    given = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = own if given is None else f"{given},{own}"
    try:
        resource_tracker.ensure_running()
    finally:
        if given is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = given


def _begin() -> None:
    """In a new process: Ctrl-C is for the first one, and its end is the end of all."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: multiprocessing.process.BaseProcess) -> None:
    parent.join()
    os._exit(1)
