"""Every public name says what it is, its examples run, and no file grows beyond reading."""

from __future__ import annotations

import ast
import doctest
import subprocess
from importlib import import_module
from pathlib import Path

import pytest
from architecture.package import FILES, ROOT, of_every, tree

MOST_LINES = 640
MORE_LINES = {"model/model.py": 1010}
"""Files that hold one class with the text of its manual."""
SOURCES = sorted([*FILES, *ROOT.rglob("*.hpp"), *ROOT.rglob("*.cpp")])
Definition = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def public_definitions(body: list[ast.stmt], owner: str = "") -> list[tuple[str, Definition]]:
    """Public functions, classes and methods that a module or a class defines."""
    found = []
    for node in body:
        if isinstance(node, Definition) and not node.name.startswith("_"):
            found.append((owner + node.name, node))
            if isinstance(node, ast.ClassDef):
                found.extend(public_definitions(node.body, f"{node.name}."))
    return found


BINARY = {"docs/view.png", "mechkin_cli/kernel/wasm/mechkin.wasm.gz"}
EMPTY = {"__init__.py", "py.typed", ".gitkeep"}


@pytest.mark.skipif(not (ROOT.parent / ".git").exists(), reason="no repository")
def test_nothing_that_is_built_or_empty_is_kept() -> None:
    """A kernel under another name would be packed into the wheel."""
    command = ["git", "-C", str(ROOT.parent), "ls-files", "-z"]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    files = {name: ROOT.parent / name for name in listed.split("\0") if name}
    assert files
    kept = {name: path.read_bytes() for name, path in files.items() if path.is_file()}
    assert {name for name, content in kept.items() if b"\0" in content} == BINARY
    empty = {name for name, content in kept.items() if not content}
    assert {name for name in empty if files[name].name not in EMPTY} == set()


@of_every(FILES)
def test_public_names_have_docstrings(path: Path) -> None:
    assert ast.get_docstring(tree(path)), "the module says nothing"
    bare = [
        name
        for name, node in public_definitions(tree(path).body)
        if not ast.get_docstring(node) and not is_overload(node)
    ]
    assert bare == []


def is_overload(node: Definition) -> bool:
    return any(ast.unparse(each).endswith("overload") for each in node.decorator_list)


@of_every(SOURCES)
def test_files_are_short(path: Path) -> None:
    most = MORE_LINES.get(str(path.relative_to(ROOT)), MOST_LINES)
    assert len(path.read_text(encoding="utf-8").splitlines()) <= most


@pytest.mark.parametrize(
    "path", [path for path in FILES if ">>>" in path.read_text(encoding="utf-8")], ids=str
)
def test_examples_run(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT.parent)
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    module = import_module(".".join(part for part in parts if part != "__init__"))
    result = doctest.testmod(module)
    assert result.attempted > 0
    assert result.failed == 0
