"""Links are rods, plates and stars as their points lie."""

from __future__ import annotations

import numpy as np
import pytest
from view.files import FOUR_BAR, SLIDER_CRANK
from view.seen import data

import mechkin_cli as mk
from mechkin_cli.view.joints import distinct, shape_through


def shapes(shown: dict) -> dict[str, str]:
    return {one["name"]: one["shape"]["kind"] for one in shown["links"]}


def test_two_joints_make_a_rod_and_a_named_point_a_plate() -> None:
    shown = data(mk.loads(FOUR_BAR), modes=False)
    assert shapes(shown) == {"ground": "none", "crank": "rod", "coupler": "plate", "rocker": "rod"}
    plate = shown["links"][2]["shape"]
    assert plate["points"] == [[20, 0, 0], [80, 0, 0], [50, 30, 0]]
    assert np.abs(plate["normal"]) == pytest.approx([0, 0, 1])
    assert shown["links"][3]["shape"]["points"] == [[70, 50, 0], [70, 0, 0]]


def test_what_has_one_place_is_its_joints_alone() -> None:
    assert shapes(data(mk.loads(SLIDER_CRANK), modes=False))["slider"] == "none"


def test_one_joint_and_a_mass_make_a_rod() -> None:
    text = SLIDER_CRANK.replace("[130, 10, 0]}}", "[180, 10, 0]}}")
    slider = data(mk.loads(text), modes=False)["links"][3]
    assert slider["shape"] == {
        "kind": "rod",
        "points": [[130, 10, 0], [180, 10, 0]],
        "radius": None,
    }


def random_points(kind: str, rng: np.random.Generator) -> np.ndarray:
    """Five points in a line, in a plane or in space, turned and shifted at random."""
    own = (
        rng.normal(size=(5, 3)) * {"line": [3, 0, 0], "plane": [3, 2, 0], "space": [3, 2, 2]}[kind]
    )
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return own @ turn.T + rng.normal(size=3)


@pytest.mark.parametrize(
    ("kind", "shape"), [("line", "rod"), ("plane", "plate"), ("space", "star")]
)
@pytest.mark.parametrize("seed", range(20))
def test_shapes_are_told_by_how_points_lie(kind: str, shape: str, seed: int) -> None:
    points = random_points(kind, np.random.default_rng(seed))
    found = shape_through(points)
    assert found.kind == shape
    if shape == "rod":
        apart = np.linalg.norm(points[:, None] - points[None], axis=2)
        assert np.linalg.norm(found.points[0] - found.points[1]) == pytest.approx(apart.max())
    if shape == "plate":
        assert np.abs((points - points[0]) @ found.normal).max() <= 1e-12
        assert np.linalg.norm(found.normal) == pytest.approx(1.0)
    if shape == "star":
        assert found.centre == pytest.approx(points.mean(axis=0))
    double = shape_through(2.0 * points + 1.0)
    assert double.kind == shape


@pytest.mark.parametrize("kind", ["rod", "plate", "star", "none", None])
@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_few_points_are_no_fault(kind, count: int) -> None:
    line = np.array([[float(k), 2.0 * k, 0.0] for k in range(count)]).reshape(-1, 3)
    found = shape_through(line, kind)
    assert found.kind in ("none", "rod", "star")
    assert (found.kind == "none") == (count < 2 or kind == "none")


def test_points_that_are_as_good_as_one_are_one() -> None:
    points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1e-7, 0.0, 0.0)]
    assert distinct(points, 1.0).tolist() == [[0, 0, 0], [1, 0, 0]]
