"""The joint table alone knows the types: no other module asks for a letter or a coordinate's name.

What depends on the type is a property of its entry (`type.is_threaded`, `type.has_point`,
`coordinate.is_angle`, ...), so that a new pair is one entry.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from architecture.package import FILES, ROOT, of_every, tree

from mechkin_cli.mechanism.pair_type import ELEMENTARY
from mechkin_cli.mechanism.pairs import FREE, JOINT_TYPES

LETTERS = {*JOINT_TYPES, *ELEMENTARY, FREE.letter}
COORDINATES = {name for kind in JOINT_TYPES.values() for name in kind.coordinates}
PERMITTED = {
    "mechanism/pairs.py": "the table",
    "mechanism/pair_type.py": "the table of its parts",
    "schema/links_joints.py": "a rule of the file format: only the row of an H has a lead",
}
WORDS = ("letter", "type", "kind", "part", "coordinate", "name")
"""What holds a letter or a coordinate's name is called."""


def asked(node: ast.AST) -> Iterator[str]:
    """Texts that an expression is compared with: constants, and those of literal containers."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.Tuple | ast.List | ast.Set):
        for element in node.elts:
            yield from asked(element)


def is_letters(text: str) -> bool:
    """Whether a text is a letter, or several ("RC")."""
    return text in LETTERS or (text.isupper() and text.isalpha() and set(text) <= LETTERS)


def asked_letters(module: ast.Module) -> Iterator[tuple[int, str]]:
    """(line, source) of every comparison, start, case or choice by a letter or a coordinate."""
    for node in ast.walk(module):
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            texts = [text for side in sides for text in asked(side)]
            others = " ".join(ast.unparse(s) for s in sides if not list(asked(s))).lower()
            about = any(word in others for word in WORDS)
            if about and any(is_letters(t) or t in COORDINATES for t in texts):
                yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.MatchValue) and any(map(is_letters, asked(node.value))):
            yield node.value.lineno, ast.unparse(node)
        elif isinstance(node, ast.Dict):
            keys = [text for key in node.keys if key is not None for text in asked(key)]
            if len(keys) > 1 and all(map(is_letters, keys)):
                yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(".startswith"):
            texts = [text for argument in node.args for text in asked(argument)]
            if any(len(text) > 1 and text in COORDINATES for text in texts):
                yield node.lineno, ast.unparse(node)


@of_every(FILES)
def test_no_module_asks_for_a_letter(path: Path) -> None:
    if str(path.relative_to(ROOT)) in PERMITTED or "bench" in path.parts:
        return
    found = [f"{line}: {source}" for line, source in asked_letters(tree(path))]
    assert not found, f"{path}: ask for a property of the joint table: {found}"


@pytest.mark.parametrize(
    "source",
    [
        "joint.letter == 'H'",
        "joint.letter in 'RC'",
        "part.letter in ('R', 'C')",
        "coordinate in ('s', 'x', 'y')",
        "name.startswith('theta')",
        "{'R': 1, 'Sp': 2}[letter]",
        "match letter:\n    case 'U':\n        pass",
    ],
)
def test_what_would_be_found(source: str) -> None:
    assert list(asked_letters(ast.parse(source)))
