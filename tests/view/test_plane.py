"""A linkage that moves in a plane is looked at square to it, with up in it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from references import FILE_OF
from view.files import FOUR_BAR, SLIDER_CRANK
from view.seen import data

import mechkin_cli as mk
from mechkin_cli.view.joints import upwards


def cycled(text: str) -> str:
    """A file with all that is drawn turned: x to y, y to z, z to x."""
    vector = re.compile(r"\[([^\[\],:]+), ([^\[\],:]+), ([^\[\],:]+)\](?!,? *columns)")
    head, _, tables = text.partition("tables:")
    turned = re.sub(
        vector,
        lambda found: (
            found[0]
            if "crank" in found[0] or "A.theta" in found[0]
            else f"[{found[3]}, {found[1]}, {found[2]}]"
        ),
        head,
    )
    return turned + ("tables:" + tables if tables else "")


def test_a_plane_square_to_z() -> None:
    for text in (FOUR_BAR, SLIDER_CRANK):
        shown = data(mk.loads(text), modes=False)
        assert shown["planar"]
        assert shown["up"] == [0, 1, 0]
        assert shown["view"]["camera"] is None


def test_planes_square_to_x_and_y() -> None:
    square_to_x = cycled(FOUR_BAR)
    shown = data(mk.loads(square_to_x), modes=False)
    assert not shown["planar"]
    assert (shown["view"]["camera"], shown["up"]) == ([1, 0, 0], [0, 0, 1])
    shown = data(mk.loads(cycled(square_to_x)), modes=False)
    assert not shown["planar"]
    assert (shown["view"]["camera"], shown["up"]) == ([0, -1, 0], [0, 0, 1])


@pytest.mark.parametrize("stem", ["rcsr", "rssr", "stewart", "bennett", "hooke", "sarrus"])
def test_what_moves_in_space_has_no_plane(stem: str) -> None:
    shown = data(mk.load(FILE_OF[stem]), modes=False)
    assert not shown["planar"]
    assert shown["view"]["camera"] is None


def test_what_the_file_asks_for_goes_first() -> None:
    shown = data(mk.loads(FOUR_BAR + "view: {camera: [3, 0, 4]}\n"), modes=False)
    assert shown["view"]["camera"] == pytest.approx([0.6, 0, 0.8])


@pytest.mark.parametrize(
    ("gravity", "axis", "up"),
    [
        ((0, 0, -9.8), None, (0, 0, 1)),
        ((0, 0, 0), None, (0, 0, 1)),
        ((0, 0, 0), 2, (0, 1, 0)),
        ((0, 0, -9.8), 2, (0, 1, 0)),
        ((-9.8, 0, 0), 2, (1, 0, 0)),
        ((0, 3, 4), 0, (0, -0.6, -0.8)),
        ((5, 3, 4), 0, (0, -0.6, -0.8)),
        ((5, 0, 0), 0, (0, 0, 1)),
    ],
)
def test_up(gravity, axis, up) -> None:
    assert upwards(np.array(gravity, dtype=float), axis) == pytest.approx(np.array(up))
