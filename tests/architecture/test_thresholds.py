"""Thresholds stand in `tolerances/`, where each has one name, a unit and a reason."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import pytest
from architecture.package import FILES, ROOT, of_every, room, tree

from mechkin_cli import tolerances

SMALL, LARGE = 1e-3, 1e6
"""Floats nearer to zero, or larger, are limits of something; others are numbers of a formula."""

ACCEPTED = {
    ("expressions/operations.py", 1.2556659146019252e-06): "the lower part of 2 pi",
    ("bench/measurement.py", 1e6): "microseconds",
    ("bench/measurement.py", 1e-18): "what is zero by its nature",
    ("bench/measurement.py", 1e-9): "seconds, against a division by zero",
    ("bench/runs.py", 1e-9): "nine digits of a row, which its reason tells",
    ("bench/runs.py", 1e-10): "the tolerance of responses, as the file format says",
}
"""(file, number) -> what it is."""

DEFINED = [path for path in FILES if room(path) == "tolerances"]


def extreme_numbers(source: ast.AST) -> set[float]:
    return {
        abs(node.value)
        for node in ast.walk(source)
        if isinstance(node, ast.Constant)
        and isinstance(node.value, float)
        and (0.0 < abs(node.value) < SMALL or abs(node.value) >= LARGE)
    }


@of_every(FILES)
def test_no_threshold_stands_alone(path: Path) -> None:
    if path not in DEFINED:
        name = str(path.relative_to(ROOT))
        assert {x for x in extreme_numbers(tree(path)) if (name, x) not in ACCEPTED} == set()


def test_accepted_numbers_exist() -> None:
    found = {(str(p.relative_to(ROOT)), x) for p in FILES for x in extreme_numbers(tree(p))}
    assert set(ACCEPTED) <= found


@pytest.mark.parametrize(
    "source", ["x < 1e-9", "abs(x) <= -4e-16", "LIMIT = 1e30", "f(eps=2.5e-4)"]
)
def test_a_threshold_is_seen(source: str) -> None:
    assert extreme_numbers(ast.parse(source))


@of_every(DEFINED)
def test_every_limit_has_a_reason(path: Path) -> None:
    body = tree(path).body
    for node, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(node, ast.AnnAssign):
            text = after.value if isinstance(after, ast.Expr) else None
            assert isinstance(text, ast.Constant), f"line {node.lineno} has no reason"
            assert len(text.value) > 20, f"line {node.lineno}"


def test_every_limit_stands_once_and_is_found_in_the_room() -> None:
    limits = Counter(
        node.target.id
        for path in DEFINED
        for node in tree(path).body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    )
    assert {name for name, count in limits.items() if count > 1} == set()
    assert limits.keys() == {name for name in dir(tolerances) if name.isupper()}
