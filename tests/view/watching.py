"""What a page in the browser shows: its row, poses, colours."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from view.browser import Browser

SINGLE = 2.0**-22
"""Poses are written in single precision: so far may lengths of a few hundred be off, in parts."""


Show = Callable[..., Browser]


def row(browser: Browser) -> int:
    return int(browser.evaluate("window.mechkin.row()"))


def pose(browser: Browser, link: str) -> tuple[np.ndarray, np.ndarray]:
    found = browser.evaluate(f"window.mechkin.pose({link!r})")
    return np.array(found["t"]), np.array(found["q"])


def moved(found: tuple[np.ndarray, np.ndarray], place: np.ndarray) -> np.ndarray:
    """R(q) place + t."""
    t, (w, *v) = found
    twice = 2 * np.cross(v, place)
    return place + w * twice + np.cross(v, twice) + t


CURVES = "window.mechkin.curves.plots.reduce((sum, plot) => sum + plot.series.length - 1, 0)"


def colours(browser: Browser) -> dict[str, int]:
    """How many points of the canvas have each colour, of a few thousand."""
    found: dict[str, int] = browser.evaluate("""(() => {
      window.mechkin.theatre.stage.draw();
      const from = document.querySelector('#stage canvas'), to = document.createElement('canvas');
      [to.width, to.height] = [100, 75];
      const brush = to.getContext('2d'), counts = {};
      brush.drawImage(from, 0, 0, 100, 75);
      const p = brush.getImageData(0, 0, 100, 75).data;
      for (let k = 0; k < p.length; k += 4) {
        const key = `${p[k] >> 4},${p[k + 1] >> 4},${p[k + 2] >> 4}`;
        counts[key] = (counts[key] ?? 0) + 1;
      }
      return counts;
    })()""")
    return found
