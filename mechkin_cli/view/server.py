"""The local server of `mechkin view --live`: pages of this machine and this user alone.

It listens on 127.0.0.1 and answers only addresses with its token. A request whose Host is another
than its own (a foreign name that leads here) or that another page sends is refused, whatever it
asks for. The page itself runs in a frame without rights: it can neither ask the server nor read
anything; the shell around it does, and tells it.
"""

from __future__ import annotations

import json
import secrets
import threading
from base64 import b64encode
from functools import cache
from hashlib import sha256
from hmac import compare_digest
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.view.following import Changed, Follower
from mechkin_cli.view.page import script_json, waiting_page

if TYPE_CHECKING:
    pass

HOST = "127.0.0.1"
QUIET = 10.0
"""Seconds after which an open connection without news is told that it is still alive."""

MOST_ASKED = 1 << 16
"""Bytes of a request that writes: some hundred parameters."""

SHELL = Path(__file__).with_name("shell")
FRAME_RIGHTS = "allow-scripts allow-downloads allow-modals"
"""Of a page in a frame: it has no origin, so that it reaches nothing of the page around it."""

FRAME_POLICY = f"sandbox {FRAME_RIGHTS}; frame-ancestors 'self'"

_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class LiveServer(ThreadingHTTPServer):
    """Serves the page of a followed file from `start` to `close`, in threads of its own."""

    daemon_threads = True
    block_on_close = False

    def __init__(self, follower: Follower, port: int = 0) -> None:
        """Listens at a port, of which 0 is any that is free.

        Raises:
            UsageError: the port is taken.
        """
        self.follower = follower
        self.token = secrets.token_urlsafe(18)
        try:
            super().__init__((HOST, port), _Answer)
        except OSError as error:
            reason = error.strerror or str(error)
            raise UsageError(f"cannot listen at {HOST}:{port}: {reason}") from error
        self.place = f"{HOST}:{self.server_address[1]}"
        self._thread = threading.Thread(target=self.serve_forever, args=(0.05,), daemon=True)

    @property
    def address(self) -> str:
        """Of the page, with its token."""
        return f"http://{self.place}/{self.token}/"

    def start(self) -> None:
        """Answers from now on."""
        self._thread.start()

    def close(self) -> None:
        """Answers no more; pages that are open are told so."""
        self.follower.stop()
        self.shutdown()
        self.server_close()

    def handle_error(self, request: object, client_address: object) -> None:
        """A reader that goes away is no error of the server."""


class _Answer(BaseHTTPRequestHandler):
    """Answers one connection."""

    server: LiveServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "mechkin", ""
    timeout = 60

    def do_GET(self) -> None:
        """Gives the shell, the page for its frame, the data of a picture, or news."""
        match self._steps():
            case [""]:
                shell, policy = shell_page()
                self._give(shell, "text/html; charset=utf-8", policy)
            case ["frame"]:
                self._give(waiting_page(), "text/html; charset=utf-8", FRAME_POLICY)
            case ["news"]:
                self._tell_news()
            case ["data", number]:
                picture = self.server.follower.seen.picture
                if picture is None or str(picture.number) != number:
                    self._give(b"", "text/plain", code=204)  # there is a newer one
                else:
                    self._give(picture.data, "application/json")
            case None:
                pass
            case _:
                self._refuse(404, "there is nothing here")

    def do_POST(self) -> None:
        """Writes values of parameters into the file."""
        steps = self._steps()
        if steps is None:
            return None
        if steps != ["parameters"]:
            return self._refuse(404, "there is nothing here")
        if self.headers.get("Origin") != f"http://{self.server.place}":
            return self._refuse(403, "another page may not write")
        try:
            asked = json.loads(self._body())
            given = _asked(asked)
        except (ValueError, OverflowError, RecursionError) as error:
            return self._refuse(400, f"this is not what a page asks: {error}")
        try:
            done = self.server.follower.write(*given)
        except Changed as error:
            return self._refuse(409, str(error))
        except UsageError as error:
            return self._refuse(422, str(error))
        return self._give(script_json(done._asdict()).encode("ascii"), "application/json")

    def _steps(self) -> list[str] | None:
        """The steps of the address behind the token; None, refused, where the request has none or
        does not come from a page of this server or from the address line."""
        own = f"http://{self.server.place}"
        _, token, *steps = self.path.partition("?")[0].split("/")
        if self.headers.get("Host") != self.server.place:
            self._refuse(421, "this server answers at its own address alone")
        elif self.headers.get("Origin", own) != own or self._is_sent_by_another():
            self._refuse(403, "another page may not ask")
        elif not steps or not compare_digest(token.encode(), self.server.token.encode()):
            self._refuse(403, "the address is not whole: mechkin prints it when it starts")
        else:
            return steps
        return None

    def _is_sent_by_another(self) -> bool:
        return self.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin")

    def _body(self) -> bytes:
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal() or int(length) > MOST_ASKED:
            raise ValueError(f"its length is {length or 'not given'} (limit {MOST_ASKED} bytes)")
        return self.rfile.read(int(length))

    def _tell_news(self) -> None:
        """What is seen of the file, as it is seen, until the reader goes away."""
        self.send_response(200)
        self._head("text/event-stream", None)
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        number = 0
        while True:
            seen = self.server.follower.wait(number, QUIET)
            if seen is None:
                text = ": nothing new\n\n"
            else:
                number = seen.number
                text = f"data: {script_json(seen.record())}\n\n"
            try:
                self.wfile.write(text.encode("ascii"))
                self.wfile.flush()
            except OSError:
                return
            if seen is not None and seen.ended:
                return

    def _head(self, kind: str, policy: str | None) -> None:
        self.send_header("Content-Type", kind)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Security-Policy", policy or "default-src 'none'")

    def _give(self, content: bytes, kind: str, policy: str | None = None, code: int = 200) -> None:
        self.send_response(code)
        self._head(kind, policy)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def _refuse(self, code: int, why: str) -> None:
        self.close_connection = True
        self._give(f"{why}\n".encode(), "text/plain; charset=utf-8", code=code)

    def log_message(self, format: str, *args: Any) -> None:
        """Says nothing: the terminal is for messages about the file."""


def _asked(asked: Any) -> tuple[str, dict[str, float], tuple[str, ...]]:
    """Hash, values and names to replace of a request.

    Raises:
        ValueError: it is not of that form.
    """
    if not isinstance(asked, dict) or not isinstance(asked.get("hash"), str):
        raise ValueError("it has no hash")
    values, replace = asked.get("values"), asked.get("replace", [])
    if not isinstance(values, dict) or not isinstance(replace, list):
        raise ValueError("it has no values")
    for value in values.values():
        if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
            raise ValueError(f"{value!r:.40} is not a number")
    if not all(isinstance(name, str) for name in replace):
        raise ValueError("a name is not a text")
    return asked["hash"], {name: float(value) for name, value in values.items()}, tuple(replace)


@cache
def shell_page() -> tuple[bytes, str]:
    """The page that holds the mechanism's in a frame, and its content security policy: it may ask
    this server, and nobody else, and runs no script but its own."""
    text, style = _source("shell.html"), _source("shell.css")
    script = f"{_source('frames.js')}\n{_source('shell.js')}"
    policy = (
        "default-src 'none'; connect-src 'self'; frame-src 'self'; base-uri 'none'; "
        "form-action 'none'; frame-ancestors 'none'; "
        f"style-src 'sha256-{_digest(style)}'; script-src 'sha256-{_digest(script)}'"
    )
    page = text.replace("/*style*/", style, 1).replace("/*script*/", script, 1)
    return page.encode("utf-8"), policy


def frames_source(name: str) -> str:
    """A script that holds pages in frames, with what it needs."""
    return f"{_source('frames.js')}\n{_source(name)}"


def _source(name: str) -> str:
    return SHELL.joinpath(name).read_text(encoding="utf-8").strip()


def _digest(text: str) -> str:
    return b64encode(sha256(text.encode("utf-8")).digest()).decode("ascii")
