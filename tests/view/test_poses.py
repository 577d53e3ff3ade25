"""Poses are those of closed forms, and carry points to where the tables have them."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf
from references import FILE_OF
from view.files import FOUR_BAR, SLIDER_CRANK
from view.seen import data, moved, number_of, posed_rows, poses

import mechkin_cli as mk
from mechkin_cli.mechanism import is_written
from mechkin_cli.view.branch import BranchScene
from mechkin_cli.view.joints import carried
from mechkin_cli.view.scene import view_scene

F32 = 1e-6
"""Of the size: a float's 24 bits, and the few roundings of what the page computes of them."""
F64 = 1e-12


def own_branch(model: mk.Model) -> BranchScene:
    """The first branch with poses in doubles."""
    scene, _ = view_scene(model.analyses(), False)
    return scene.branches[0][0]


def turned(angle: mpf, point: tuple[mpf, mpf], about: tuple[mpf, mpf]) -> tuple[mpf, mpf]:
    c, s = mp.cos(angle), mp.sin(angle)
    x, y = point[0] - about[0], point[1] - about[1]
    return (about[0] + c * x - s * y, about[1] + s * x + c * y)


def four_bar(theta: float) -> dict[str, list[float]]:
    """Where drawn points of the four-bar's links are, by the intersection of two circles."""
    mp.dps = 40
    crank, coupler, rocker, ground = mpf(20), mpf(60), mpf(50), mpf(70)
    angle = mp.radians(mpf(theta))
    bx, by = crank * mp.cos(angle), crank * mp.sin(angle)
    dx, dy = ground - bx, -by
    d = mp.sqrt(dx * dx + dy * dy)
    along = (coupler**2 - rocker**2 + d * d) / (2 * d)
    off = mp.sqrt(coupler**2 - along**2)
    cx, cy = bx + (along * dx - off * dy) / d, by + (along * dy + off * dx) / d
    tilt = mp.atan2(cy - by, cx - bx)
    # the coupler is drawn along x from B = (20, 0)
    px, py = turned(tilt, (mpf(50), mpf(30)), (mpf(20), mpf(0)))
    px, py = px - 20 + bx, py + by
    return {
        "crank": [float(bx), float(by), 0.0],
        "coupler": [float(px), float(py), 0.0],
        "rocker": [float(cx), float(cy), 0.0],
    }


DRAWN = {"crank": (20, 0, 0), "coupler": (50, 30, 0), "rocker": (70, 50, 0)}


@pytest.mark.parametrize("link", DRAWN)
def test_a_four_bar_is_where_two_circles_meet(link: str) -> None:
    model = mk.loads(FOUR_BAR)
    want = np.array([four_bar(10.0 * k)[link] for k in range(37)])
    shown = data(model, modes=False)
    assert posed_rows(shown).tolist() == list(range(37))
    found = moved(poses(shown)[:, number_of(shown, link)], DRAWN[link])
    assert np.abs(found - want).max() <= F32 * shown["size"]
    scene = own_branch(model)
    exact = carried(scene.poses[:, scene.links.index(link)], np.array(DRAWN[link]) * 1e-3)
    assert np.abs(exact * 1e3 - want).max() <= F64 * shown["size"]


def test_the_other_mode_of_a_four_bar_lies_below() -> None:
    shown = data(mk.loads(FOUR_BAR))
    assert len(shown["runs"][0]["branches"]) == 2
    above, below = (
        moved(poses(shown, 0, number)[:, number_of(shown, "rocker")], DRAWN["rocker"])
        for number in (0, 1)
    )
    # the two circles meet at places that mirror each other in the line from B to D
    for k in range(37):
        angle = np.radians(10.0 * k)
        b, d = np.array([20 * np.cos(angle), 20 * np.sin(angle), 0.0]), np.array([70.0, 0, 0])
        line = (d - b) / np.linalg.norm(d - b)
        mirror = b + 2 * line * (line @ (above[k] - b)) - (above[k] - b)
        assert np.abs(below[k] - mirror).max() <= 1e-5 * shown["size"]


def test_a_slider_crank_slides_as_its_closed_form() -> None:
    shown = data(mk.loads(SLIDER_CRANK), modes=False)
    theta = np.radians(np.arange(0, 361, 5))
    want = 30 * np.cos(theta) + np.sqrt(100.0**2 - (10 - 30 * np.sin(theta)) ** 2)
    pose = poses(shown)[:, number_of(shown, "slider")]
    place = moved(pose, (130, 10, 0))
    assert np.abs(place[:, 0] - want).max() <= F32 * shown["size"]
    assert np.abs(place[:, 1:] - [10, 0]).max() <= F32 * shown["size"]
    assert np.abs(pose[:, 3] - 1.0).max() <= F32
    least, most = shown["joints"][3]["travel"]
    assert [least, most] == pytest.approx([(want - 130).min(), (want - 130).max()], abs=1e-9)


@pytest.mark.parametrize("path", list(FILE_OF.values()), ids=lambda path: path.stem)
def test_joints_hold_and_points_are_where_the_tables_have_them(path) -> None:
    """In doubles to 1e-12 of the size: J.point and p.position, which the kernel tells by another
    way; and both halves of a joint with a point of its own meet."""
    model = mk.load(path)
    for analysis in model.analyses():
        scene, _ = view_scene([analysis], False)
        branch, mechanism = scene.branches[0][0], analysis.result.problem.mechanism
        size = np.linalg.norm(scene.box[1] - scene.box[0]) or 1.0
        known = analysis.result.problem.quantities()
        named = {f"{name}.position": at for name, at in mechanism.points.items()}
        named |= {f"{name}.point": joint.point for name, joint in mechanism.joints.items()}
        for name, at in named.items():
            if name not in known or not is_written(at.link):
                continue  # cylinders have links of their own, which are drawn from eye to eye
            quantity = analysis.result.quantity(name).value
            want = np.stack(quantity.components, axis=1)[branch.rows[branch.posed]]
            found = carried(branch.poses[:, branch.links.index(at.link)], at.vector)
            told = want.shape[1]  # two in a plane
            assert np.abs(found[:, :told] - want).max() <= F64 * size, name
            assert np.abs(found[:, told:]).max(initial=0.0) == 0.0


@pytest.mark.parametrize("stem", ["rcsr", "stewart", "rcsr_response", "hooke"])
def test_quaternions_are_of_length_one_and_do_not_jump(stem: str) -> None:
    model = mk.load(FILE_OF[stem])
    shown = data(model)
    for number in range(len(shown["runs"][0]["branches"])):
        q = poses(shown, 0, number)[:, :, 3:]
        assert np.abs(np.linalg.norm(q, axis=2) - 1.0).max() <= F32
        assert (np.einsum("plk,plk->pl", q[1:], q[:-1]) >= 0.0).all()
        assert (q[0, :, 0] >= 0.0).all()


def test_ground_stays() -> None:
    shown = data(mk.loads(FOUR_BAR))
    assert shown["links"][0]["name"] == "ground"
    assert (poses(shown)[:, 0] == [0, 0, 0, 1, 0, 0, 0]).all()
