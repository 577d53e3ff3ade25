"""What an editor underlines, and where: files as people write them, good and bad."""

from __future__ import annotations

import pytest
from editors.language_server import Server
from references import FILE_OF

GOOD = ["rcsr", "bennett", "csgc", "double_hooke", "five_link_suspension", "hooke", "sarrus"]

TOP = "format: 1\nlinks: {arm: {}}\njoints:\n"
PIN = "  A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}\n"


def joint(words: str) -> str:
    return f"{TOP}  A: {{{words}}}\n"


BAD = {
    "a point with two numbers": (
        joint("type: R, links: [ground, arm], point: [0, 0], axis: [0, 0, 1]"),
        [(4, 45, "Array has too few items. Expected 3 or more.")],
    ),
    "a point per link with two numbers": (
        joint("type: S, links: [ground, arm], point: {arm: [0, 0], ground: [0, 0, 0]}"),
        [(4, 51, "Array has too few items. Expected 3 or more.")],
    ),
    "a point whose name is none": (
        joint("type: S, links: [ground, arm], point: 2nd"),
        [(4, 45, "String does not match the pattern")],
    ),
    "a point that is one number": (
        joint("type: S, links: [ground, arm], point: 3"),
        [(4, 45, "Incorrect type. Expected")],
    ),
    "a thread without a lead": (
        joint("type: H, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]"),
        [(4, 3, 'Missing property "lead".')],
    ),
    "a lead where there is no thread": (
        joint("type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1], lead: 3"),
        [(4, 73, "Property lead is not allowed.")],
    ),
    "a type that is none": (
        joint("type: X, links: [ground, arm], point: [0, 0, 0]"),
        [(4, 13, 'Value is not accepted. Valid values: "R", "P", "C"')],
    ),
    "no type": (
        joint("links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]"),
        [(4, 3, 'Missing property "type".')],
    ),
    "a key of the file that is none": (
        f"{TOP}{PIN}motions: {{}}\n",
        [(5, 1, "Property motions is not allowed.")],
    ),
    "a word of a sweep that is none": (
        f"{TOP}{PIN}motion: {{inputs: {{A.theta: {{from: 0, to: 9, stepp: 1}}}}}}\n",
        [(5, 19, 'Missing property "step".'), (5, 45, "Property stepp is not allowed.")],
    ),
    "a force at a joint with a vector": (
        f"{TOP}{PIN}loads:\n  - {{type: force, joint: A, value: [0, 0, 1]}}\n",
        [(6, 36, 'Incorrect type. Expected "TableValue".')],
    ),
    "a spring between one point": (
        f"{TOP}{PIN}loads:\n  - {{type: spring, between: [P], stiffness: 3, free: 1}}\n",
        [(6, 29, "Array has too few items. Expected 2 or more.")],
    ),
}


@pytest.mark.parametrize("name", GOOD)
def test_good_files_have_no_faults(editor: Server, name: str) -> None:
    file = FILE_OF[name]
    assert editor.faults(file.read_text(encoding="utf-8"), file) == []


def test_names_of_points_have_no_faults(editor: Server) -> None:
    named = joint("type: R, links: [ground, arm], point: p, axis: [0, 0, 1]")
    per_link = "  B: {type: S, links: [ground, arm], point: {ground: p, arm: [0, 0, 1]}}\n"
    points = "points: {p: {link: arm, at: q}, q: {link: arm, at: [0, 0, 0]}}\n"
    load = "loads: [{type: force, link: arm, point: p, force: [1, 0, 0]}]\n"
    heavy = (named + per_link + points + load).replace("{}", "{mass: 1, center_of_mass: p}")
    assert editor.faults(heavy) == []


@pytest.mark.parametrize("name", BAD)
def test_the_fault_stands_at_its_place_and_nowhere_else(editor: Server, name: str) -> None:
    text, expected = BAD[name]
    found = sorted(editor.faults(text))
    assert [(one.line, one.column) for one in found] == [place[:2] for place in expected], found
    for fault, (_, _, words) in zip(found, expected, strict=True):
        assert words in fault.message
