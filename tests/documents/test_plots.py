"""The picture on the page of plots is the curve that its command draws.

Fonts and margins change with matplotlib's version, so the curve's path alone is compared: its
points have to be those of the coupler point, shifted and scaled alike in both directions."""

import re

import numpy as np
import pytest
from documents.reading import ROOT, blocks, page

import mechkin_cli as mk


def test_the_coupler_curve() -> None:
    (command,) = blocks(page("docs/plots.md"), "sh")
    name, quantity = re.findall(r"mechkin plot (\S+) --y (\S+) -o curve\.svg", command)[0]
    (picture,) = re.findall(r"\]\((\S+\.svg)\)", page("docs/plots.md"))
    points = mk.load(ROOT / name).analyze()[quantity]
    drawn = [
        np.array([[float(x), float(y)] for x, y in re.findall(r"[ML] (\S+) (\S+)", path)])
        for path in re.findall(r'<path d="([^"]+)"', page(f"docs/{picture}"))
    ]
    (path,) = [found for found in drawn if len(found) == len(points)]
    shifted, placed = points - points.mean(axis=0), path - path.mean(axis=0)
    placed[:, 1] *= -1.0  # of a picture y points down
    scale = float((shifted * placed).sum() / (shifted * shifted).sum())
    assert scale > 0.0
    assert placed == pytest.approx(scale * shifted, abs=1e-3 * float(np.abs(placed).max()))
