"""Progress on a terminal's stderr, once a piece of work has taken a second.

Before that, in a pipe and with `--quiet` nothing is shown; the line goes when the work ends. What
is printed meanwhile clears the line first (`pause`), which comes back after another second.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Any

from mechkin_cli.diagnostics import legible

if TYPE_CHECKING:
    import threading


AFTER = 1.0
"""Seconds of work before anything is shown."""

BAR = 10
"""Characters of the bar of counted work."""

RESTORED = b"\r\x1b[2K\x1b[?25h"
"""Clears the line and brings the cursor back: for a process that ends at once."""

Tell = Callable[[str], None]

running: set[_Display] = set()
"""The work that is under way."""

shown: set[_Display] = set()
"""What is on the terminal now: an interrupt must clear it."""


@contextmanager
def working(words: str, quiet: bool = False) -> Iterator[Tell]:
    """Shows the words, and for how long, while the work inside goes on; yields a function that
    changes them."""
    if quiet or not _can_show():
        yield lambda _: None
        return
    display = _Display(words)
    running.add(display)
    try:
        display.wait()
        yield display.tell
    finally:
        running.discard(display)
        display.clear()


@contextmanager
def counting(words: str, what: str, quiet: bool = False) -> Iterator[Callable[[int, int], None]]:
    """As `working`, for work that is counted: yields a function of how many are done, and of how
    many, first before any; shows a bar, the rate and the remaining time."""
    begun: list[tuple[float, int]] = []

    with working(words, quiet) as tell:

        def count(done: int, whole: int) -> None:
            if not begun:
                begun.append((monotonic(), done))
            since, before = begun[0]
            seconds = monotonic() - since
            rate = (done - before) / seconds if seconds > 0.0 else 0.0
            speed = f"{rate:.0f}" if rate >= 100.0 else f"{rate:.2g}"
            left = f", {speed}/s, {clock((whole - done) / rate)} left" if rate > 0.0 else ""
            filled = BAR * done // whole
            bar = "#" * filled + "-" * (BAR - filled)
            tell(f"{words} |{bar}| {done}/{whole} {what}{left}")

        yield count


def clock(seconds: float) -> str:
    """Hours, minutes and seconds: 1:02:03 or 2:03.

    >>> clock(62.4), clock(3723)
    ('1:02', '1:02:03')
    """
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def pause() -> None:
    """Clears the terminal's line for what is printed next."""
    for display in tuple(running):
        display.clear()
        display.wait()


def _can_show() -> bool:
    """Whether stderr is a terminal that can clear a line."""
    is_plain = os.environ.get("TERM", "") in ("dumb", "unknown")
    return sys.stderr is not None and sys.stderr.isatty() and not is_plain


class _Display:
    """A line with a turning mark, the words and the time, drawn by rich in a thread of its own."""

    def __init__(self, words: str) -> None:
        import threading

        self._words = words
        self._lock = threading.RLock()
        self._timer: threading.Timer | None = None
        self._bar: Any = None

    def wait(self) -> None:
        """Draws when a second has passed."""
        import threading

        with self._lock:
            self._timer = threading.Timer(AFTER, self._show)
            self._timer.daemon = True
            self._timer.start()

    def _show(self) -> None:
        from rich.console import Console
        from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

        columns = SpinnerColumn("line"), TextColumn("{task.description}"), TimeElapsedColumn()
        bar = Progress(*columns, console=Console(stderr=True), transient=True)
        with self._lock:
            if self._timer is None:  # the work has ended meanwhile
                return
            bar.add_task(_plain(self._words, bar.console.width), total=None)
            bar.tasks[0].start_time = bar.get_time() - AFTER
            self._bar = bar
            shown.add(self)
            bar.start()

    def tell(self, words: str) -> None:
        """Changes the words."""
        with self._lock:
            self._words = words
            if self._bar is not None:
                said = _plain(words, self._bar.console.width)
                self._bar.update(self._bar.tasks[0].id, description=said)

    def clear(self) -> None:
        """Clears the line, or cancels it."""
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
            self._timer = None
            if self._bar is not None:
                self._bar.stop()
            self._bar = None
            shown.discard(self)


def _plain(words: str, width: int) -> str:
    """The words without markup, cut so that the mark before them and the time behind have room."""
    from rich.markup import escape

    text, room = legible(words, also=""), max(width - len("- ") - len(" 0:00:00"), 1)
    return escape(text if len(text) <= room else f"{text[: room - 1]}\u2026")
