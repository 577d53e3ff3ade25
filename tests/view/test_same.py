"""The same mechanism written otherwise is shown the same: renamed, reordered, turned, in other
units, run backwards, with what nothing needs."""

from __future__ import annotations

import re

import numpy as np
import pytest
from view.files import FOUR_BAR, SLIDER_CRANK
from view.seen import data, moved, number_of, poses, rotation

import mechkin_cli as mk

NEAR = 2e-6
"""Of the size: floats of two pages."""


def renamed(text: str, names: dict[str, str]) -> str:
    return re.sub(r"\b(" + "|".join(names) + r")\b", lambda found: names[found[0]], text)


def test_other_names_change_names_alone() -> None:
    names = {"crank": "k1", "coupler": "zz", "rocker": "aa", "A": "Q4", "B": "Q3", "C": "Q2"}
    shown, other = (data(mk.loads(text)) for text in (FOUR_BAR, renamed(FOUR_BAR, names)))
    assert [one["name"] for one in other["links"]] == ["ground", "k1", "zz", "aa"]
    for number in (0, 1):
        np.testing.assert_array_equal(poses(shown, 0, number), poses(other, 0, number))
    assert [one["halves"] for one in shown["joints"]] == [one["halves"] for one in other["joints"]]


def test_another_order_of_links_and_joints_gives_the_same_poses() -> None:
    lines = FOUR_BAR.splitlines()
    at = {key: i for i, line in enumerate(lines) for key in "ABCD" if line.startswith(f"  {key}:")}
    blocks = {"C": lines[at["C"] : at["C"] + 2], **{k: [lines[at[k]]] for k in "ABD"}}
    first, last = at["A"], at["D"] + 1
    turned = [line for key in "DCBA" for line in blocks[key]]
    text = "\n".join([*lines[:first], *turned, *lines[last:]])
    text = text.replace(
        "{crank: {}, coupler: {}, rocker: {}}", "{rocker: {}, coupler: {}, crank: {}}"
    )
    shown, other = data(mk.loads(FOUR_BAR)), data(mk.loads(text))
    for link in ("crank", "coupler", "rocker"):
        one = poses(shown)[:, number_of(shown, link)]
        same = poses(other)[:, number_of(other, link)]
        assert np.abs(one - same).max() <= NEAR * shown["size"]


def test_a_turned_drawing_turns_with_it() -> None:
    """All that is drawn turned by a third of a turn about (1, 1, 1): x to y, y to z, z to x."""

    def cycled(found: re.Match[str]) -> str:
        x, y, z = (part.strip() for part in found[1].split(","))
        return f"[{z}, {x}, {y}]"

    head, joints = SLIDER_CRANK.split("joints:\n")
    vector = re.compile(r"\[([^\[\],:]+,[^\[\],:]+,[^\[\],:]+)\]")
    body, tail = joints.split("assembly:")
    text = vector.sub(cycled, head) + "joints:\n" + vector.sub(cycled, body)
    text += "assembly:" + vector.sub(cycled, tail)
    shown, other = data(mk.loads(SLIDER_CRANK)), data(mk.loads(text))
    turn = rotation(np.array([0.5, 0.5, 0.5, 0.5]))
    for link, point in {"crank": (30, 0, 0), "rod": (130, 0, 0), "slider": (130, 10, 0)}.items():
        one = moved(poses(shown)[:, number_of(shown, link)], point)
        same = moved(poses(other)[:, number_of(other, link)], turn @ np.array(point, dtype=float))
        assert np.abs(one @ turn.T - same).max() <= NEAR * shown["size"]
    assert other["up"] == pytest.approx([0, 0, 1])
    assert shown["up"] == pytest.approx([0, 1, 0])


def test_backwards_is_the_same_in_the_other_order() -> None:
    back = SLIDER_CRANK.replace("from: 0, to: 360, step: 5", "from: 360, to: 0, step: 5")
    one, other = poses(data(mk.loads(SLIDER_CRANK))), poses(data(mk.loads(back)))
    same = other[::-1]
    assert np.abs(one[..., :3] - same[..., :3]).max() <= NEAR * 200
    signs = np.sign(np.einsum("plk,plk->pl", one[..., 3:], same[..., 3:]))
    assert np.abs(one[..., 3:] - signs[..., None] * same[..., 3:]).max() <= NEAR


def test_what_nothing_needs_changes_nothing_else() -> None:
    more = FOUR_BAR.replace("rocker: {}}", "rocker: {}, flag: {}}").replace(
        "joints:\n",
        "joints:\n  F: {type: R, links: [ground, flag], point: [0, 0, 9], axis: [1, 0, 0]}\n",
    )
    more = more.replace("step: 10, rate: 3 rad/s}}", "step: 10, rate: 3 rad/s}, F.theta: {at: 20}}")
    shown, other = data(mk.loads(FOUR_BAR)), data(mk.loads(more))
    for link in ("crank", "coupler", "rocker"):
        one = poses(shown)[:, number_of(shown, link)]
        assert np.abs(one - poses(other)[:, number_of(other, link)]).max() <= NEAR * shown["size"]


def test_another_unit_of_length_is_another_scale() -> None:
    """Numbers as they stand, in cm: the same numbers on the page, in doubles of other sizes."""
    shown, scaled = data(mk.loads(FOUR_BAR)), data(mk.loads(FOUR_BAR.replace("mm", "cm")))
    assert (shown["units"]["length"], scaled["units"]["length"]) == ("mm", "cm")
    assert scaled["size"] == pytest.approx(shown["size"], rel=1e-12)
    assert np.abs(poses(scaled) - poses(shown)).max() <= NEAR * shown["size"]


def test_parameters_set_anew_are_shown() -> None:
    """A varied model shows what its own file would."""
    text = FOUR_BAR.replace("links:", "parameters: {r: 20 mm}\nlinks:", 1)
    text = text.replace("point: [20, 0, 0]", "point: [r, 0, 0]")
    text += "view: {arrow_length: 2*r, shapes: {crank: {kind: rod, points: [A, [r, 0, 0]]}}}\n"
    varied = data(mk.loads(text).with_parameters({"r": "22 mm"}), modes=False)
    written = data(mk.loads(text.replace("r: 20 mm", "r: 22 mm")), modes=False)
    assert np.abs(poses(varied) - poses(written)).max() <= NEAR * written["size"]
    assert varied["view"] == written["view"]
    assert varied["links"] == written["links"]
    assert varied["view"]["arrow_length"] == pytest.approx(44.0)
