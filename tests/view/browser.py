"""Debian's Chromium, driven through Node and playwright-core; says what is missing where it is."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

DRIVER = Path(__file__).with_name("driver.mjs")
PACKAGES = Path(__file__).parents[2] / "mechkin_cli" / "view" / "page" / "node_modules"
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NO_GL = ["--disable-gpu", "--disable-3d-apis"]


def missing() -> str | None:
    """What is not on this machine, as a word for those who skip; None where all is there."""
    if shutil.which("node") is None:
        return "Node is not installed"
    if shutil.which("chromium") is None:
        return "Debian's Chromium is not installed"
    if not (PACKAGES / "playwright-core").is_dir():
        return "`npm ci` has not been run in mechkin_cli/view/page"
    return None


class Browser:
    """A browser that stays open; each `open` is a new window without a past."""

    def __init__(self, flags: list[str]) -> None:
        executable = shutil.which("chromium")
        assert executable is not None
        self._process = subprocess.Popen(
            ["node", str(DRIVER), executable, *flags],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    def _ask(self, command: str, **rest: Any) -> Any:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps({"command": command, **rest}) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        assert line, "the browser has ended"
        answer = json.loads(line)
        assert "error" not in answer, answer["error"]
        return answer["value"]

    def open(self, path: Path, **options: Any) -> None:
        """Opens a page; `width`, `height`, `dark`, `touch`."""
        self._ask("open", url=path.resolve().as_uri(), **options)

    def evaluate(self, script: str) -> Any:
        return self._ask("evaluate", script=script)

    def press(self, key: str) -> None:
        self._ask("press", key=key)

    def click(self, selector: str, at: tuple[float, float] | None = None) -> None:
        self._ask("click", selector=selector, at=at)

    def tap(self, selector: str) -> None:
        self._ask("tap", selector=selector)

    def fill(self, selector: str, value: object) -> None:
        self._ask("fill", selector=selector, value=str(value))

    def drag(self, way: list[list[float]], touch: bool = False) -> None:
        """Presses the mouse, or puts a finger down, at the first place and lifts it at the last."""
        self._ask("drag", way=way, touch=touch)

    def select(self, selector: str, label: str) -> None:
        self._ask("select", selector=selector, label=label)

    def resize(self, width: int, height: int) -> None:
        self._ask("resize", width=width, height=height)

    def shot(self, path: Path, selector: str | None = None) -> None:
        self._ask("shot", path=str(path), selector=selector)

    def media(self, media: str | None = None, scheme: str | None = None) -> None:
        self._ask("media", media=media, scheme=scheme)

    def pdf(self, path: Path) -> None:
        self._ask("pdf", path=str(path))

    def told(self) -> dict[str, list[str]]:
        """`said`: errors and warnings of the console; `asked`: the addresses that were loaded."""
        found: dict[str, list[str]] = self._ask("told")
        return found

    def close(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait(30)
