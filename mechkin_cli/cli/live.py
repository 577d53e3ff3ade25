"""`mechkin view --live`: a page that follows a file while it is edited."""

from __future__ import annotations

import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import model
from mechkin_cli.cli.interrupts import awaiting_the_end
from mechkin_cli.cli.messages import ExitCode, put, refuse_stdin, say, say_diagnostics, shown
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.reading import read_text
from mechkin_cli.view import Follower, LiveServer, Wish

if TYPE_CHECKING:
    from mechkin_cli.model import Model
    from mechkin_cli.view import Seen


def follow(file: Path, wish: Wish, opens: bool, quiet: bool) -> ExitCode:
    """Serves the page until Ctrl-C, or a request to end, and gives OK then.

    Raises:
        UsageError: there is no file to read.
    """
    refuse_stdin(file, "a file is followed")
    with suppress(InvalidFile):  # its faults stand on the page, until they are mended
        read_text(file)
    is_watched = sys.stderr is not None and sys.stderr.isatty() and not quiet
    follower = Follower(file, _loaded, wish, _Telling(file) if is_watched else lambda _: None)
    server = LiveServer(follower)
    with awaiting_the_end() as ended:
        follower.start()
        server.start()
        put(f"{server.address}\n")
        if is_watched:
            say(f"{shown(file)} is followed; Ctrl-C ends")
        if opens:
            # a browser of the terminal would hold up everything else
            threading.Thread(target=_show, args=(server.address,), daemon=True).start()
        # a wait without end would keep signals away on some systems
        while not ended.wait(0.5):
            pass
        server.close()
    return ExitCode.OK


def _loaded(text: str, name: str, folder: Path) -> Model:
    return model.loads(text, name, folder=folder)


def _show(address: str) -> None:
    import webbrowser

    if not webbrowser.open(address):
        say("no browser was found; open the address by hand")


class _Telling:
    """Tells a terminal of the file's faults, and that they are gone."""

    def __init__(self, file: Path) -> None:
        self._file, self._had_faults = file, False

    def __call__(self, seen: Seen) -> None:
        if seen.faults:
            say_diagnostics(seen.faults, shown(self._file))
        elif self._had_faults:
            say(f"{shown(self._file)}: sound again")
        self._had_faults = bool(seen.faults)
