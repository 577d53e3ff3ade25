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


def body(shape: str) -> np.ndarray:
    """The vertices (n, 3) of a link's shape, drawn where joints have the size 1."""
    found = in_node(f"""
        import {{ addShape, reached }} from "./src/scene/shapes.js";
        const parts = [];
        const add = (geometry, matrix) => {{
          const part = geometry.index ? geometry.toNonIndexed() : geometry.clone();
          parts.push(...part.applyMatrix4(matrix).attributes.position.array);
        }};
        addShape({{ add }}, {shape}, 1);
        console.log(JSON.stringify(parts));
    """)
    return np.array(found).reshape(-1, 3)


def volume(places: np.ndarray) -> float:
    a, b, c = places.reshape(-1, 3, 3).transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def test_a_cylinder_is_a_cup_of_its_radius_from_point_to_point() -> None:
    places = body("{kind: 'cylinder', points: [[1, 2, 3], [1, 2, 13]], radius: 2}")
    np.testing.assert_allclose(places.min(axis=0), [-1, 0, 3], atol=1e-5)
    np.testing.assert_allclose(places.max(axis=0), [3, 4, 13], atol=1e-5)
    # the bore of 78 % ends one wall above the bottom; 28 sides have a little less than a circle
    bore = 0.78 * 2
    solid = np.pi * (4 * 10 - bore**2 * (10 - (2 - bore)))
    assert volume(places - [1, 2, 3]) == pytest.approx(solid, rel=0.02)


@pytest.mark.parametrize("width", [1.0, 9.0])
def test_a_wheel_has_its_radius_and_width_about_its_axis(width: float) -> None:
    places = body(
        f"{{kind: 'wheel', points: [[5, 0, 0]], normal: [0, 1, 0], radius: 4, width: {width}}}"
    )
    np.testing.assert_allclose(np.abs(places[:, 1]).max(), width / 2, atol=1e-5)
    assert np.hypot(places[:, 0] - 5, places[:, 2]).max() == pytest.approx(4.0, rel=0.01)
    assert volume(places - [5, 0, 0]) > 0
    full = np.pi * 16 * width
    assert volume(places - [5, 0, 0]) == pytest.approx(full, rel=0.02) or width < 4


def test_what_a_wheel_reaches_holds_it() -> None:
    shape = "{kind: 'wheel', points: [[5, 0, 0]], normal: [1, 2, 2], radius: 4, width: 1}"
    found = in_node(f"""
        import {{ reached }} from "./src/scene/shapes.js";
        console.log(JSON.stringify(reached({shape}).map((place) => place.toArray())));
    """)
    corners, places = np.array(found), body(shape)
    axis = np.array([1, 2, 2]) / 3
    assert np.abs((corners - [5, 0, 0]) @ axis).max() == pytest.approx(0.5, abs=1e-6)
    assert (places.max(axis=0) <= corners.max(axis=0) + 1e-5).all()
    assert (places.min(axis=0) >= corners.min(axis=0) - 1e-5).all()
