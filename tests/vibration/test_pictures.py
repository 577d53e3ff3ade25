"""The picture of modes: a panel for each, with arrows along which points move."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from vibration.test_played import TWO_PENDULUMS

import mechkin_cli as mk
from mechkin_cli.cli.vibrate import vibrate

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
NUMBER = re.compile(r"-?\d+\.\d")


def arrows(picture: str) -> list[list[np.ndarray]]:
    """The ways (2,) of the arrows of each panel, in points, downwards positive, by their places
    from above."""
    found = []
    for panel in picture.split("<text")[1:]:
        ways = []
        shafts = re.findall(r'<path class="v" [^>]* d="([^"]*)"', panel)
        heads = re.findall(r'<path class="v a" [^>]* d="([^"]*)"', panel)
        for shaft, head in zip(shafts, heads, strict=True):
            begin = np.array(NUMBER.findall(shaft)[:2], dtype=float)
            tip = np.array(NUMBER.findall(head)[2:4], dtype=float)
            ways.append((begin[1], tip - begin))
        found.append([way for _, way in sorted(ways, key=lambda one: one[0])])
    return found


def test_two_pendulums() -> None:
    # the places of equal masses go as 1 to 1 + sqrt(2) in the slow mode, and as 1 to 1 - sqrt(2)
    v = mk.loads(TWO_PENDULUMS).vibration()
    picture = v.picture()
    assert picture.count("mode 1: ") == picture.count("mode 2: ") == 1
    for ways, ratio in zip(arrows(picture), (1 + np.sqrt(2), 1 - np.sqrt(2)), strict=True):
        # the joint B is where the first mass is: one arrow for both
        upper, lower = ways
        longest = max(np.hypot(*upper), np.hypot(*lower))
        assert longest == pytest.approx(26.0, abs=0.15)
        np.testing.assert_allclose(lower, ratio * upper, atol=0.4)


def test_what_stands_still_has_no_arrow() -> None:
    # in the slow mode of two equal carriages both go alike, in the fast one the middle rests
    joints = "  S: {type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}\n"
    joints += "  T: {type: P, links: [ground, b], point: [1, 0, 0], axis: [1, 0, 0]}\n"
    joints += "  U: {type: P, links: [ground, c], point: [2, 0, 0], axis: [1, 0, 0]}\n"
    links = "".join(
        f"  {name}: {{mass: 1, center_of_mass: [{x}, 0, 0]}}\n" for x, name in enumerate("abc")
    )
    points = "".join(f"  p{x}: {{link: {name}, at: [{x}, 0, 0]}}\n" for x, name in enumerate("abc"))
    spring = "  - {type: spring, between: [p%d, p%d], stiffness: 4 N/m, free: 1 m}\n"
    text = f"format: 1\nunits: {{length: m, force: N}}\nlinks:\n{links}joints:\n{joints}"
    text += f"points:\n{points}loads:\n{spring % (0, 1)}{spring % (1, 2)}"
    text += "motion: {inputs: {S.s: {at: 0}, T.s: {at: 0}, U.s: {at: 0}}}\n"
    rigid, outer, middle = arrows(mk.loads(text).vibration().picture())
    assert [len(rigid), len(outer), len(middle)] == [3, 2, 3]
    np.testing.assert_allclose(outer[0], -outer[1], atol=0.3)
    np.testing.assert_allclose(middle[0], middle[2], atol=0.3)
    np.testing.assert_allclose(middle[1], -2 * middle[0], atol=0.5)


def test_the_command_writes_it(tmp_path: Path) -> None:
    file = MECHANISMS / "vibration" / "engine_mounts.yaml"
    vibrate(file, row=2, out=tmp_path, quiet=True)
    told = mk.load(file).vibration(row=2).picture()
    assert (tmp_path / "modes.svg").read_text(encoding="utf-8") == told
    assert told.count("<text") == 6
