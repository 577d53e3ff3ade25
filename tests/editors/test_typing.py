"""What an editor offers while a file is typed, and what it shows of a key."""

from __future__ import annotations

import pytest
from editors.language_server import Server
from editors.test_faults import PIN, TOP

from mechkin_cli.schema.links_joints import JOINT_LETTERS

INPUT = f"{TOP}{PIN}motion:\n  inputs:\n    A.theta:\n      "

OFFERS = {
    "keys of the file": ("|", {"format", "links", "joints", "motion", "loads", "tables", "view"}),
    "types of joints": (f"{TOP}  A:\n    type: |", set(JOINT_LETTERS)),
    "keys of a thread": (
        f"{TOP}  A:\n    type: H\n    |",
        {"links", "point", "axis", "zero", "lead"},
    ),
    "keys of a universal joint": (
        f"{TOP}  A:\n    type: U\n    |",
        {"links", "point", "axis", "axis2"},
    ),
    "keys of forces on links and joints": (
        f"{TOP}{PIN}loads:\n  - type: force\n    |",
        {"link", "point", "force", "joint", "value", "runs"},
    ),
    "keys of an input": (f"{INPUT}|", {"from", "to", "step", "values", "at", "with", "law"}),
    "keys of a swept input": (f"{INPUT}from: 0\n      |", {"to", "step", "count", "rate"}),
    "laws": (f"{INPUT}law: |", {"harmonic", "cycloidal", "polynomial", "table"}),
    "keys of units": ("format: 1\nunits:\n  |", {"length", "angle", "mass", "force"}),
}
NOT_OFFERED = {
    "keys of a thread": {"axis2", "normal", "groove"},
    "keys of a universal joint": {"lead", "normal"},
}

HOVERS = {
    "a lead": (f"{TOP}  A:\n    type: H\n    le|ad: 3 mm\n", ["Length per turn", "5 mm"]),
    "a type": (f"{TOP}  A:\n    ty|pe: H\n", ["H: the second link turns by theta", "S: ball"]),
    "a point": (f"{TOP}  A:\n    type: S\n    po|int: [0, 0, 0]\n", ["home drawing", "10 mm"]),
    "units": ("format: 1\nun|its: {length: mm}\n", ["Units of bare numbers", "mm"]),
    "a rate": (f"{INPUT}ra|te: 3 rad/s\n", ["rad/s"]),
    "a mass": ("format: 1\nlinks: {arm: {ma|ss: 3}}\n", ["0.4 kg"]),
}


@pytest.mark.parametrize("name", OFFERS)
def test_offers(editor: Server, name: str) -> None:
    text, expected = OFFERS[name]
    offered = set(editor.offers(text))
    assert expected <= offered
    assert not offered & NOT_OFFERED.get(name, set())


@pytest.mark.parametrize("name", HOVERS)
def test_hover_shows_words_and_an_example(editor: Server, name: str) -> None:
    text, expected = HOVERS[name]
    shown = editor.hover(text)
    for words in expected:
        assert words in shown, shown
