"""The language server of Red Hat's YAML extension, spoken to as an editor does (LSP over pipes)."""

from __future__ import annotations

import json
import queue
import subprocess
import threading
from pathlib import Path
from shutil import which
from typing import Any, NamedTuple

FOLDER = Path(__file__).parent
SERVER = FOLDER / "node_modules" / "yaml-language-server" / "bin" / "yaml-language-server"
SCHEMA = FOLDER.parents[1] / "schemas" / "mechanism.schema.json"
SECONDS = 60.0


def missing() -> str | None:
    """What is not on this machine, as a word for those who skip; None where all is there."""
    if which("node") is None:
        return "node is not installed"
    if not SERVER.is_file():
        return f"run `npm ci --prefix {FOLDER.relative_to(FOLDER.parents[1])}` first"
    return None


class Fault(NamedTuple):
    """A squiggle of the editor; line and column count from 1."""

    line: int
    column: int
    message: str


class Server:
    """One language server with mechkin's schema for every file."""

    def __init__(self) -> None:
        node = which("node")
        assert node is not None
        self._process = subprocess.Popen(
            [node, str(SERVER), "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        self._number = 0
        self._answers: queue.Queue[dict[str, Any]] = queue.Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self._ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
        self._tell("initialized", {})
        yaml = {
            "schemas": {SCHEMA.as_uri(): "*"},
            "schemaStore": {"enable": False},
            "validate": True,
            "hover": True,
            "completion": True,
        }
        self._settings = {"yaml": yaml}
        self._tell("workspace/didChangeConfiguration", {"settings": self._settings})
        self._wait_for_the_schema()

    def close(self) -> None:
        """Ends the server."""
        self._process.kill()
        self._process.wait()

    def faults(self, text: str, file: Path | None = None) -> list[Fault]:
        """What the editor underlines in a text, which may be a file's."""
        uri = self._open(text, file)
        while True:
            found = self._next()
            if found.get("method") == "textDocument/publishDiagnostics":
                said = found["params"]
                if said["uri"] == uri:
                    return [_fault(one) for one in said["diagnostics"]]

    def offers(self, text: str) -> list[str]:
        """What is offered at the `|` in a text."""
        uri, place = self._at_mark(text)
        found = self._ask("textDocument/completion", {"textDocument": {"uri": uri}} | place)
        items = found["items"] if isinstance(found, dict) else found or []
        return [item["label"] for item in items]

    def hover(self, text: str) -> str:
        """What is shown when the pointer rests at the `|` in a text."""
        uri, place = self._at_mark(text)
        found = self._ask("textDocument/hover", {"textDocument": {"uri": uri}} | place)
        return "" if found is None else str(found["contents"]["value"])

    def _wait_for_the_schema(self) -> None:
        """Until the server has taken its settings in; before, it answers without a schema."""
        uri = self._open("no_key_of_the_schema: 1\n")
        while True:
            found = self._next()
            said = found.get("params") or {}
            is_said = found.get("method") == "textDocument/publishDiagnostics"
            if is_said and said["uri"] == uri and said["diagnostics"]:
                return

    def _at_mark(self, text: str) -> tuple[str, dict[str, Any]]:
        before, _, after = text.partition("|")
        line, column = before.count("\n"), len(before.rpartition("\n")[2])
        return self._open(before + after), {"position": {"line": line, "character": column}}

    def _open(self, text: str, file: Path | None = None) -> str:
        self._number += 1
        uri = f"file:///mechanism-{self._number}.yaml" if file is None else file.as_uri()
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": text}
        self._tell("textDocument/didOpen", {"textDocument": document})
        return uri

    def _tell(self, method: str, params: Any, **more: Any) -> None:
        self._send({"jsonrpc": "2.0", "method": method, "params": params} | more)

    def _ask(self, method: str, params: Any) -> Any:
        self._number += 1
        number = self._number
        self._tell(method, params, id=number)
        while True:
            found = self._next()
            if found.get("id") == number and "method" not in found:
                assert "error" not in found, found
                return found["result"]

    def _next(self) -> dict[str, Any]:
        """The next message; what the server asks is answered on the way."""
        found = self._answers.get(timeout=SECONDS)
        if "method" in found and "id" in found:
            is_settings = found["method"] == "workspace/configuration"
            sections = found["params"]["items"] if is_settings else []
            result = [self._settings.get(one.get("section", "")) for one in sections] or None
            self._send({"jsonrpc": "2.0", "id": found["id"], "result": result})
        return found

    def _send(self, message: dict[str, Any]) -> None:
        assert self._process.stdin is not None
        body = json.dumps(message).encode()
        self._process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self._process.stdin.flush()

    def _listen(self) -> None:
        stream = self._process.stdout
        assert stream is not None
        while header := stream.readline():
            length = int(header.split(b":")[1])
            while stream.readline().strip():
                pass
            self._answers.put(json.loads(stream.read(length)))


def _fault(one: dict[str, Any]) -> Fault:
    start = one["range"]["start"]
    return Fault(start["line"] + 1, start["character"] + 1, one["message"])
