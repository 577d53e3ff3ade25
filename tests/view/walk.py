"""The way from nothing to 'the crank 10 % longer, what peak torque?', by file and by page.

Run as `python -P tests/view/walk.py`; it prints what a person does, how many acts that are, and how
long the program takes for each. Both ways must end at the same torque.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from view.browser import SOFTWARE_GL, Browser, missing

import mechkin_cli

MECHKIN = [sys.executable, "-P", "-m", "mechkin_cli"]
WAY = dict(os.environ, PYTHONPATH=str(Path(mechkin_cli.__file__).parents[1]))
PEAK = (
    "(() => { const row = [...document.querySelectorAll('#peaks tbody tr')]"
    ".find((each) => each.textContent.startsWith('torque')); "
    "return row ? [...row.querySelectorAll('td')].map((each) => each.textContent) : null })()"
)


class Walk:
    """Acts, with the seconds that the program took for each."""

    def __init__(self, title: str) -> None:
        print(f"\n{title}")
        self.acts = 0
        self.seconds = 0.0

    def act(self, what: str, do: Callable[[], object]) -> object:
        begun = time.perf_counter()
        found = do()
        took = time.perf_counter() - begun
        self.acts, self.seconds = self.acts + 1, self.seconds + took
        print(f"  {self.acts}. {what:54} {took:6.2f} s")
        return found

    def end(self, answer: str) -> None:
        print(f"  {answer}: {self.acts} acts, {self.seconds:.2f} s of the program")


def command(folder: Path, *words: str) -> str:
    done = subprocess.run(
        [*MECHKIN, *words], cwd=folder, env=WAY, capture_output=True, text=True, check=True
    )
    return done.stdout


def by_file(folder: Path) -> float:
    walk = Walk("By file")
    path = folder / "bar.yaml"
    walk.act("mechkin new bar", lambda: command(folder, "new", "bar"))
    text = path.read_text(encoding="utf-8")
    longer = text.replace("crank: 40 mm", "crank: 44 mm")
    assert longer != text
    walk.act("edit crank: 40 mm to 44 mm, save", lambda: path.write_text(longer, encoding="utf-8"))
    words = ("analyze", "bar.yaml", "--json")
    found = walk.act("mechkin analyze bar.yaml", lambda: command(folder, *words))
    (values,) = [
        column["values"]
        for table in json.loads(str(found))["tables"]
        for column in table["columns"]
        if column["label"] == "torque"
    ]
    peak: float = max(values, key=abs)
    walk.act("look for the largest torque in the table", lambda: None)
    walk.end(f"peak torque {peak:.1f} N*mm")
    return peak


def until(ask: Callable[[], object]) -> object:
    deadline = time.monotonic() + 60
    while not (found := ask()) and time.monotonic() < deadline:
        time.sleep(0.005)
    assert found
    return found


def by_page(folder: Path, browser: Browser) -> float:
    walk = Walk("By page")
    walk.act("mechkin new bar", lambda: command(folder, "new", "bar"))
    served: list[subprocess.Popen[str]] = []

    def open_page() -> None:
        words = [*MECHKIN, "view", "--live", "--no-open", "bar.yaml"]
        process = subprocess.Popen(words, cwd=folder, env=WAY, stdout=subprocess.PIPE, text=True)
        served.append(process)
        assert process.stdout is not None
        browser.visit(process.stdout.readline().strip())
        until(lambda: browser.inside("window.mechkin.dimensions?.parameters.length"))

    try:
        walk.act("mechkin view --live bar.yaml", open_page)
        walk.act(
            "open the tab of peaks",
            lambda: browser.inside("document.querySelector('#tab-peaks').click()"),
        )

        def set_crank() -> object:
            browser.inside("window.mechkin.dimensions.set('crank', 44)")
            return until(lambda: (row := browser.inside(PEAK)) and row[1] and row)

        row = walk.act("set crank to 44 mm", set_crank)
        walk.end(f"peak torque {row[1]} N*mm, {row[2]}")  # type: ignore[index]

        def write() -> None:
            until(lambda: browser.evaluate("!document.querySelector('#write').hidden"))
            browser.click("#write")
            until(lambda: "crank: 44 mm" in (folder / "bar.yaml").read_text(encoding="utf-8"))

        walk.act("(write it into the file)", write)
        text = (folder / "bar.yaml").read_text(encoding="utf-8")
        shown = "Number(document.documentElement.dataset.picture ?? 0)"
        until(lambda: browser.inside("window.mechkin.dimensions?.own?.crank === 44"))

        def save() -> None:
            before = browser.evaluate(shown)
            longer = text.replace("base: 100 mm", "base: 101 mm")
            (folder / "bar.yaml").write_text(longer, encoding="utf-8")
            until(lambda: browser.evaluate(shown) > before)

        walk.act("(save another base in an editor, see it)", save)
    finally:
        for process in served:
            process.send_signal(signal.SIGINT)
            process.wait(10)
    return float(row[1])  # type: ignore[index]


def main() -> int:
    if reason := missing():
        print(f"the page cannot be walked: {reason}")
        return 1
    browser = Browser(SOFTWARE_GL)
    with TemporaryDirectory() as one, TemporaryDirectory() as other:
        file, page = by_file(Path(one)), by_page(Path(other), browser)
    browser.close()
    print(f"\nfile {file!r}, page {page!r}")
    return 0 if abs(page / file - 1) < 1e-3 else 1


if __name__ == "__main__":
    sys.exit(main())
