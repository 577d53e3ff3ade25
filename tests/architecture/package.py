"""The package's source files, read and never imported."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence, Set
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2] / "mechkin_cli"
FILES = sorted(ROOT.rglob("*.py"))


def of_every(files: Sequence[Path]) -> Callable[[Callable[[Path], None]], Callable[[], None]]:
    """One test of many files, which names all that fail: thousands of tests would take longer to
    be given out than to be done."""

    def tested(check: Callable[[Path], None]) -> Callable[[], None]:
        def test() -> None:
            faults = []
            for path in files:
                try:
                    check(path)
                except AssertionError as fault:
                    faults.append(f"{path.relative_to(ROOT)}: {fault}")
            assert files
            assert not faults, "\n\n".join(faults)

        test.__name__, test.__doc__ = check.__name__, check.__doc__
        return test

    return tested


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def room(path: Path) -> str:
    """The folder of a file, or its name where it lies beside the folders."""
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imports(path: Path) -> list[tuple[int, str]]:
    """(line, dotted module) of all imports, at the top, inside functions and for type checkers."""
    found = []
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found.extend((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            module = node.module or ""
            if module == "mechkin_cli":
                found.extend((node.lineno, f"{module}.{alias.name}") for alias in node.names)
            else:
                found.append((node.lineno, module))
        elif is_import_call(node):
            found.append((node.lineno, node.args[0].value))
    return found


def is_import_call(node: ast.AST) -> bool:
    """`import_module("...")` with a plain text."""
    return (
        isinstance(node, ast.Call)
        and "import_module" in (getattr(node.func, "id", ""), getattr(node.func, "attr", ""))
        and isinstance(node.args[0], ast.Constant)
    )


def imported_names(path: Path) -> list[tuple[str, str]]:
    """(dotted module, name) of all imports of names, of every kind."""
    return list(_imported_names(path))


@cache
def _imported_names(path: Path) -> list[tuple[str, str]]:
    return [
        (node.module or "", alias.name)
        for node in ast.walk(tree(path))
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    ]


def told_apart(module: ast.Module, kinds: Set[str]) -> Iterator[tuple[int, str]]:
    """(line, source) of every question for one of some classes: by isinstance, by type, or by a
    pattern."""
    for node in ast.walk(module):
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("isinstance", "issubclass"):
            names = {part.id for part in ast.walk(node.args[1]) if isinstance(part, ast.Name)}
        elif isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            names = {side.id for side in sides if isinstance(side, ast.Name)}
        elif isinstance(node, ast.MatchClass):
            names = {ast.unparse(node.cls)}
        else:
            continue
        if names & kinds:
            yield getattr(node, "lineno", 0), ast.unparse(node)


def offered_names(path: Path) -> list[tuple[str, str]]:
    """(dotted module, name) of all that a door loads when it is first used."""
    return list(_offered_names(path))


@cache
def _offered_names(path: Path) -> list[tuple[str, str]]:
    door = ".".join(path.relative_to(ROOT.parent).parent.parts)
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "lazy_names":
            chapters = ast.literal_eval(node.args[1])
            return [
                (f"{door}.{chapter}", name)
                for chapter, names in chapters.items()
                for name in (names.split() if isinstance(names, str) else names)
            ]
    return []


def defined_names(path: Path) -> set[str]:
    """The public names that a module defines."""
    found = set()
    for node in tree(path).body:
        for one in node.body if isinstance(node, ast.If) else [node]:
            if isinstance(one, ast.FunctionDef | ast.ClassDef):
                found.add(one.name)
            elif isinstance(one, ast.Assign | ast.AnnAssign):
                targets = one.targets if isinstance(one, ast.Assign) else [one.target]
                names = [name for target in targets for name in ast.walk(target)]
                found |= {name.id for name in names if isinstance(name, ast.Name)}
    return {name for name in found if not name.startswith("_")}
