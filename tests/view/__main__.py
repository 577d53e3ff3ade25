"""Writes `docs/view.png`: the page of a five-link suspension with a hard point moved, in 256
colours."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from PIL import Image
from references import FILE_OF
from view.browser import SOFTWARE_GL, Browser, missing

import mechkin_cli as mk

TARGET = Path(__file__).parents[2] / "docs" / "view.png"
WIDTH, HEIGHT = 1200, 760

# the outer end of the track rod is put higher up, and its slider is in view
MOVE = """(() => {
  const { dimensions, curves } = window.mechkin;
  document.querySelector("#dimensions .fixed").open = true;
  dimensions.set("joints.B5.point.z", 315);
  window.mechkin.seek(12);
  const slider = document.querySelector("[aria-label='joints.B5.point.z'] input");
  const panel = document.querySelector("#dimensions");
  const box = panel.getBoundingClientRect();
  panel.scrollTop += slider.getBoundingClientRect().top - box.top - panel.clientHeight / 2;
})()"""


def main() -> int:
    reason = missing()
    if reason:
        print(f"{TARGET.name} is not made: {reason}")
        return 1
    with TemporaryDirectory() as folder:
        page, shot = Path(folder) / "page.html", Path(folder) / "page.png"
        mk.load(FILE_OF["five_link_suspension"]).view(page)
        browser = Browser(SOFTWARE_GL)
        browser.open(page, width=WIDTH, height=HEIGHT)
        browser.evaluate(MOVE)
        browser.press("f")
        browser.evaluate("new Promise((done) => setTimeout(done, 4000))")
        browser.shot(shot)
        browser.close()
        colours = Image.open(shot).convert("RGB").quantize(256, dither=Image.Dither.NONE)
        colours.save(TARGET, optimize=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
