"""Parts of joints, measured: a thread's true lead, how far parts reach, which way faces look."""

from __future__ import annotations

import json
import subprocess
from typing import Any

import numpy as np
import pytest
from view.browser import PACKAGES, missing
from view.page_data import PAGE

SOURCES = PAGE.parent / "page"


def vertices(part: str) -> np.ndarray:
    """The vertices (n, 3) of a part that `parts.js` makes."""
    found = in_node(f"""
        import * as parts from "./src/scene/parts.js";
        console.log(JSON.stringify(Array.from(parts.{part}.attributes.position.array)));
    """)
    return np.array(found).reshape(-1, 3)


def in_node(script: str) -> Any:
    if not (PACKAGES / "three").is_dir():
        pytest.skip(f"parts are not measured: {missing() or 'three is not installed'}")
    run = subprocess.run(
        ["node", "--input-type=module", "-e", script],
        cwd=SOURCES,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)


@pytest.mark.parametrize("lead", [8.0, -8.0, 1.5, -30.0])
def test_a_thread_has_its_true_lead(lead: float) -> None:
    places = vertices(f"thread(4, 1, {lead}, 2, -10, 10)")
    crest = places[np.hypot(places[:, 0], places[:, 1]) > 4.99]
    assert np.ptp(crest[:, 2]) > 15
    turn = np.arctan2(crest[:, 1], crest[:, 0]) / (2 * np.pi)
    starts = max(1, round(abs(lead) / 2))
    # every start's crest is z = lead * (turn - start / starts) + a whole number of leads
    off = (crest[:, 2] + 10) / lead - turn
    np.testing.assert_allclose((off * starts + 0.5) % 1, 0.5, atol=1e-4)


@pytest.mark.parametrize(
    ("part", "least", "most"),
    [
        ("bar(2, -3, 5)", [-2, -2, -3], [2, 2, 5]),
        ("sleeve(1, 2, -3, 3)", [-2, -2, -3], [2, 2, 3]),
        ("shell(2, 3, 0, Math.PI / 2)", [-3, -3, 0], [3, 3, 3]),
        ("trough(2, 3, -4, 6)", [-3, -3, -4], [0, 3, 6]),
        ("squareTube(1, 2, -3, 3)", [-2, -2, -3], [2, 2, 3]),
        ("nut(1, 2, -3, 3)", [-2, -np.sqrt(3), -3], [2, np.sqrt(3), 3]),
        ("block([-1, -2, -3], [4, 5, 6])", [-1, -2, -3], [4, 5, 6]),
    ],
)
def test_parts_reach_as_far_as_they_say(part: str, least: Any, most: Any) -> None:
    places = vertices(part)
    np.testing.assert_allclose(places.min(axis=0), least, atol=1e-5)
    np.testing.assert_allclose(places.max(axis=0), most, atol=1e-5)


@pytest.mark.parametrize(
    "part",
    [
        "sleeve(1, 2, -3, 3)",
        "shell(2, 3, 0, Math.PI / 2)",
        "shell(2, 3, 1, 2)",
        "trough(2, 3, -4, 6)",
        "thread(4, 1, 8, 2, -10, 10)",
        "thread(4, 1, -8, 2, -10, 10)",
    ],
)
def test_parts_are_not_inside_out(part: str) -> None:
    a, b, c = vertices(part).reshape(-1, 3, 3).transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    if part.startswith("thread"):  # a ridge without a floor: its faces look away from the axis
        outwards = np.einsum("ij,ij->i", (a + b + c) * [1, 1, 0], np.cross(b - a, c - a))
        volume = outwards.sum()
    assert volume > 0
