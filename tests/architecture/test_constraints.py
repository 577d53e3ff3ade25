"""Constraints are of one kind: `mechanism/constraint.py` alone tells one from another.

What depends on the kind is a property of its entry (`equations`, `has_coordinates`, `links`,
`spin`, ...), so that a new kind is one class.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from architecture.package import FILES, ROOT, of_every, told_apart, tree

HOME = "mechanism/constraint.py"
KINDS = {"DistanceConstraint", "InputConstraint", "PairConstraint"}
LEG = re.compile(r"(?<![A-Za-z])(legs?|Legs?)(?![a-z])")
OF_THE_FORMAT = {
    "schema/errors.py": "coordinates in an example",
    "schema/json_schema.py": "coordinates in an example",
    "tolerances/mobility.py": "what a telescope is",
}
"""Files that may speak of legs beside the one that knows them."""


@of_every(FILES)
def test_no_module_asks_for_a_kind(path: Path) -> None:
    assert list(told_apart(tree(path), KINDS)) == []


@pytest.mark.parametrize(
    "source",
    [
        "isinstance(c, PairConstraint)",
        "isinstance(c, Joint | DistanceConstraint)",
        "type(c) is DistanceConstraint",
        "match c:\n    case PairConstraint():\n        pass",
    ],
)
def test_what_would_be_found(source: str) -> None:
    assert list(told_apart(ast.parse(source), KINDS))


def test_one_file_knows_legs() -> None:
    names = {
        str(path.relative_to(ROOT))
        for path in FILES
        if LEG.search(path.read_text(encoding="utf-8"))
    }
    assert names == {HOME, *OF_THE_FORMAT}
