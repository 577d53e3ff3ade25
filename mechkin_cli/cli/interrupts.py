"""Ctrl-C and requests to end: quiet at any moment.

An exception that a signal raises may come up where it is printed and lost, or turned into another:
in modules that are half loaded, and in functions that libraries call. So the process ends at once,
unless it is putting files in their places, which are taken back first.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys

TYPE_CHECKING = False  # typing is not loaded for its flag alone
if TYPE_CHECKING:
    import threading
    from collections.abc import Iterator
    from types import FrameType
    from typing import NoReturn


INTERRUPTED = 130
SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
"""Ctrl-C, and requests to end; each where the system has it."""

_next_step = ""
_final_code: int | None = None


def then(next_step: str) -> None:
    """Sets what the message of an interrupt says on the next step."""
    global _next_step
    _next_step = next_step


def said() -> None:
    """Says on stderr that the work was interrupted."""
    text = f"mechkin: interrupted; files written so far are whole{_next_step}\n"
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            os.write(2, text.encode())


def end_quietly() -> None:
    """Lets Ctrl-C, and a request to end (kill, a closed terminal, Ctrl-Break), end the process
    quietly."""
    global _final_code
    _final_code = None
    then("")
    for name in SIGNALS:
        number = getattr(signal, name, None)
        # nohup and parents that ignore a signal are obeyed
        usual = (signal.SIG_DFL, signal.default_int_handler)
        if number is not None and signal.getsignal(number) in usual:
            signal.signal(number, _interrupted)


@contextlib.contextmanager
def awaiting_the_end() -> Iterator[threading.Event]:
    """Inside, Ctrl-C and requests to end do no more than set the event: for work that goes on until
    then."""
    import threading

    ended = threading.Event()
    before = {
        number: signal.signal(number, lambda *_: ended.set())
        for name in SIGNALS
        if (number := getattr(signal, name, None)) is not None
        and signal.getsignal(number) is not signal.SIG_IGN
    }
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def leave(code: int) -> NoReturn:
    """Ends the process; an interrupt on the way out changes nothing."""
    global _final_code
    _final_code = code
    sys.exit(code)


def _interrupted(number: int, frame: FrameType | None) -> None:
    if _final_code is not None:
        os._exit(_final_code)
    if getattr(sys.modules.get("mechkin_cli.tables.file_set"), "replacing", None):
        raise KeyboardInterrupt
    claims = sys.modules.get("mechkin_cli.tables.folder")
    for claim in tuple(getattr(claims, "held", ())):
        claim.release()
    progress = sys.modules.get("mechkin_cli.cli.progress")
    if getattr(progress, "shown", None):
        with contextlib.suppress(OSError):
            os.write(2, progress.RESTORED)  # type: ignore[union-attr]
    said()
    os._exit(INTERRUPTED)
