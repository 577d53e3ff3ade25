"""Parts of joints, measured: a thread's true lead, how far parts reach, which way faces look."""

from __future__ import annotations

import json
import subprocess
from typing import Any

import numpy as np
import pytest
from view.browser import PACKAGES, missing
from view.page_data import PAGE, half, joint, link, page_data

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


def halves(letter: str, stops: str, turned: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The vertices (n, 3) of the halves of a joint of size 1 at the origin, about or along z, that
    slides from -40 to 60; the second one, which points to x, is turned by an angle."""
    found = in_node(f"""
        import {{ Vector3 }} from "three";
        import {{ Half }} from "./src/scene/halves.js";
        import {{ PAIRS }} from "./src/scene/pairs.js";
        const drawn = {{ point: [0, 0, 0], axis: [0, 0, 1], x: [0, 1, 0] }};
        const made = [[], []].map((parts) => {{
          const add = (geometry, matrix) => {{
            const part = geometry.index ? geometry.toNonIndexed() : geometry.clone();
            part.applyMatrix4(matrix);
            for (const each of part.attributes.position.array) parts.push(each);
          }};
          return {{ parts, half: new Half(drawn, {{ add }}, 1, new Vector3(1, 0, 0), false) }};
        }});
        const [first, second] = made.map(({{ half }}) => half);
        const box = {{ least: new Vector3(0, 0, -40), most: new Vector3(0, 0, 60) }};
        const joint = {{ lead: 5, stops: {stops} }};
        const more = {{ joint, stops: joint.stops.slide, u: 1, travel: [box, box] }};
        PAIRS.get("{letter}")({{ first, second, ...more }});
        console.log(JSON.stringify(made.map(({{ parts }}) => parts)));
    """)
    first, second = (np.array(parts).reshape(-1, 3) for parts in found)
    c, s = np.cos(turned), np.sin(turned)
    return first, second @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


@pytest.mark.parametrize(("letter", "hold"), [("P", 1.2), ("C", 1.2), ("H", 0.9)])
def test_what_slides_touches_its_stops_at_its_limits(letter: str, hold: float) -> None:
    first, second = halves(letter, "{turn: null, slide: [-50, 80]}")
    reach = second[:, 2].min(), second[:, 2].max()
    np.testing.assert_allclose(reach, [-hold, hold], atol=1e-6)
    wide = first[np.isclose(np.abs(first[:, 0]), 0.85)][:, 2]
    low, high = wide[wide < 0.0].max(), wide[wide > 0.0].min()
    np.testing.assert_allclose([low, high], [-50 + reach[0], 80 + reach[1]], atol=1e-5)
    free, _ = halves(letter, "{turn: null, slide: [null, null]}")
    assert not np.isclose(np.abs(free[:, 0]), 0.85).any()


@pytest.mark.parametrize("limits", [(-0.6, 1.9), (-0.6, None), (None, 1.9)])
def test_a_hand_comes_to_its_stops_at_the_limits_of_a_turn(limits: Any) -> None:
    written = json.dumps(limits)
    plain, _ = halves("R", "{turn: null, slide: null}")
    for side, limit in zip((-1, 1), limits, strict=True):
        if limit is None:
            continue
        first, second = halves("R", f"{{turn: {written}, slide: null}}", limit)
        hand = second[(second[:, 2] > 1.74) & (np.hypot(second[:, 0], second[:, 1]) > 1.2)]
        stops = first[first[:, 2] > 1.76]
        assert len(stops) > 0
        assert plain[:, 2].max() < 1.76
        # about where the hand points
        x, y = np.cos(limit), np.sin(limit)
        angles = [
            np.arctan2(x * p[:, 1] - y * p[:, 0], x * p[:, 0] + y * p[:, 1]) for p in (hand, stops)
        ]
        edge = np.abs(angles[0]).max()
        near = np.min(side * angles[1][np.abs(angles[1]) < 0.6])
        assert 0.0 < edge < near < edge + 0.1


def test_a_turn_of_more_than_one_has_no_stop() -> None:
    plain, _ = halves("R", "{turn: null, slide: null}")
    first, _ = halves("R", "{turn: [-7, 7], slide: null}")
    np.testing.assert_array_equal(first, plain)


def test_faces_of_a_bevel_wheel_are_flat() -> None:
    """All normals of a face are its own, whatever little its edge is broken."""
    found = in_node("""
        import { addWheel } from "./src/scene/wheels.js";
        const add = (geometry) => {
          const { position, normal } = geometry.attributes;
          console.log(JSON.stringify([[...position.array], [...normal.array]]));
        };
        const on = { centre: [0, 0, 0], axis: [0, 0, 1], x: [1, 0, 0] };
        const bevel = { radius: 50, width: 6, teeth: 40, apex: 20, lean: 0 };
        addWheel({ add }, { ...on, ...bevel, inner: false, reach: null }, 1);
    """)
    places, normals = (np.array(each).reshape(-1, 3, 3) for each in found)
    faces = np.ptp(places[:, :, 2], axis=1) < 1e-6
    assert faces.sum() > 100
    upright = np.sign(places[faces][:, :, 2])[:, :, None] * [0.0, 0.0, 1.0]
    np.testing.assert_allclose(normals[faces], upright, atol=1e-6)


def test_what_is_framed_holds_pulleys_and_stops() -> None:
    """A pulley of 30 at (100, 0), and a slide from -10 to 20 that ends at 45; not one that ends
    farther away than half the size of 200."""
    rail = half([0, 0, 0], [1, 0, 0], [0, 1, 0])
    joints = [
        joint("A", "P", (0, 1), rail, travel=[-10, 20], stops={"turn": None, "slide": [-500, 45]})
    ]
    cable = {"links": [1, 0, 1], "places": [[0, 0, 0], [100, 0, 0], [0, 9, 0]]}
    cables = [{**cable, "beside": [0, -30, 0]}]
    links = [link("ground"), link("slider")]
    shown = page_data("slide", links, joints, [], size=200.0, centre=[0.0, 0.0, 0.0], cables=cables)
    found = in_node(f"""
        import {{ placesOf }} from "./src/scene/viewpoint.js";
        const branch = {{ poseCount: 1, pose: () => ({{ t: [0, 0, 0], q: [1, 0, 0, 0] }}) }};
        const data = {json.dumps({**shown, "runs": []})};
        console.log(JSON.stringify(placesOf(data, branch).map((place) => place.toArray())));
    """)
    places = np.array(found)
    np.testing.assert_allclose(places.min(axis=0), [0, -30, 0])
    np.testing.assert_allclose(places.max(axis=0), [130, 30, 0])
    assert [45, 0, 0] in found
