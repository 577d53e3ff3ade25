"""Milliseconds from the moment a file is saved to its picture in `mechkin view --live`.

Run as `python -P tests/view/pace_of_saves.py [--gl] [--modes] [NAME...]`. A comment is added
and the file saved, twenty times; the page notes when the new picture stands in it, drawn. By parts:
until the follower has the data (look, check, run, data), until the frame has drawn them. Chromium
draws nothing in three dimensions, or, with `--gl`, by software. Least, median and most; it ends
with 1 where the median is more than `BUDGET`.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from references import FILE_OF
from view.browser import NO_GL, SOFTWARE_GL, Browser, missing

import mechkin_cli as mk
from mechkin_cli.view import Follower, LiveServer, Wish

BUDGET = 200.0
"""Milliseconds: what is seen within them seems to follow at once."""

SAVES, APART = 20, 0.5
"""How often, and seconds after each, until the page waits for the next."""

NOTES = """(() => {
  window.pictures = [];
  const shows = window.live.frames.show.bind(window.live.frames);
  window.live.frames.show = async (text, first) => {
    const begun = performance.timeOrigin + performance.now();
    const done = await shows(text, first);
    if (done) window.pictures.push([begun, performance.timeOrigin + performance.now()]);
    return done;
  };
})()"""

NEXT = """(async () => {
  while (window.pictures.length === 0) await new Promise((done) => setTimeout(done, 20));
  return window.pictures.shift();
})()"""


def main(arguments: list[str]) -> int:
    if reason := missing():
        print(f"nothing is measured: {reason}")
        return 1
    flags = SOFTWARE_GL if "--gl" in arguments else NO_GL
    names = [each for each in arguments if not each.startswith("--")]
    slow = []
    print(f"{'':24} least median most; until the data are there, and drawn: medians")
    for name in names or ["planar_four_bar", "rcsr", "five_link_suspension", "excavator"]:
        browser = Browser(flags)
        with TemporaryDirectory() as folder:
            found = measured(browser, Path(folder), name, "--modes" in arguments)
        browser.close()
        totals, until, drawn = ([each[k] for each in found] for k in range(3))
        print(
            f"{name:24} {min(totals):5.0f} {middle(totals):6.0f} {max(totals):4.0f} "
            f"{middle(until):29.0f} {middle(drawn):10.0f}",
            flush=True,
        )
        if middle(totals) > BUDGET:
            slow.append(name)
    print(f"more than {BUDGET:g} ms: {', '.join(slow) or 'none'}")
    return 1 if slow else 0


def middle(values: list[float]) -> float:
    return sorted(values)[len(values) // 2]


def measured(browser: Browser, folder: Path, name: str, modes: bool) -> list[list[float]]:
    """Of each save: milliseconds in all, until the data are asked for, and until they are drawn."""
    path = folder / f"{name}.yaml"
    text = FILE_OF[name].read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    follower = Follower(
        path, lambda text, name, at: mk.loads(text, name, folder=at), Wish(modes=modes)
    )
    server = LiveServer(follower)
    follower.start()
    server.start()
    browser.visit(server.address)
    deadline = time.monotonic() + 60
    while not browser.evaluate("document.documentElement.dataset.picture ?? null"):
        assert time.monotonic() < deadline, "no first picture"
        time.sleep(0.05)
    browser.evaluate(NOTES)
    time.sleep(2.0)  # until the next frame waits and everything is warm
    found: list[list[float]] = []
    for k in range(SAVES):
        begun = time.time() * 1000.0
        # the whole way is gone for a comment, too
        path.write_text(f"{text}# {k}\n", encoding="utf-8")
        data, done = browser.evaluate(NEXT)
        found.append([done - begun, data - begun, done - data])
        time.sleep(APART)
    server.close()
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
