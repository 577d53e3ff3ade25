"""The named expressions of docs/quantities.md hold for the suspension that they are of."""

import re
from pathlib import Path

import numpy as np
import yaml

import mechkin_cli as mk

ROOT = Path(__file__).parents[2]


def test_the_suspension_of_the_page() -> None:
    page = (ROOT / "docs" / "quantities.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```yaml\n(quantities:.*?)```", page, re.DOTALL)
    own = "".join(
        f"  {name}: {text}\n" for name, text in yaml.safe_load(block)["quantities"].items()
    )
    text = (ROOT / "mechanisms" / "classics" / "five_link_suspension.yaml").read_text(
        encoding="utf-8"
    )
    head, tail = text.split("quantities:\n")
    rest = tail.partition("motion:")[2]
    others = "  travel: wheel.position.z - 310 mm\n  toe: atan2(spindle.x, spindle.y)\n"
    whole = f"{head}quantities:\n{others}{own}motion:{rest}"
    rows = mk.loads(whole.replace("step: 10", "step: 1")).analyze()
    gain = np.gradient(np.radians(rows["camber"]), rows["strut.s"], edge_order=2)
    assert np.abs(rows["camber_gain"] - gain).max() < 1e-7
    y, z = rows["contact.position.y"], rows["contact.position.z"]
    slope = np.gradient(y, rows["strut.s"]) / np.gradient(z, rows["strut.s"])
    np.testing.assert_allclose(
        rows["roll_centre"][1:-1], (z + y * slope)[1:-1], rtol=1e-2, atol=0.1
    )
