"""The page of exceptions names those there are, and its example prints what it shows."""

import contextlib
import importlib
import io
import pkgutil
import re

import pytest
from documents.reading import page

import mechkin_cli as mk

PAGE = page("docs/exceptions.md")


def every_exception() -> set[str]:
    """The names of all classes of the package that derive from the common one."""
    for module in pkgutil.walk_packages(mk.__path__, "mechkin_cli."):
        if module.name.split(".")[1] not in ("bench", "__main__", "cli"):
            importlib.import_module(module.name)
    found, seen = [mk.MechkinError], set()
    while found:
        one = found.pop()
        seen.add(one.__name__)
        found += one.__subclasses__()
    return seen


def test_the_tree_names_all_that_reach_a_caller() -> None:
    tree = set(re.findall(r"^    (?:[├└]── )?(\w+)", PAGE, re.MULTILINE))
    # known by their parents: one marks a field that another message has refused already, the other
    # is answered by the server of `view --live`
    inner = {"AlreadyRefused", "Changed"}
    assert tree & every_exception() == every_exception() - inner


def test_public_names_are_those_of_the_package() -> None:
    (sentence,) = re.findall(r"^(.*) are public names", PAGE, re.MULTILINE)
    for name in re.findall(r"mk\.(\w+)", sentence):
        assert issubclass(getattr(mk, name), mk.MechkinError)


def test_the_example_prints_what_stands_below_it() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (shown,) = re.findall(r"```\n\n    (missing-key .*)\n", PAGE)
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(code, "docs/exceptions.md", "exec"), {})
    assert said.getvalue().strip() == shown


def test_attributes_that_the_page_names() -> None:
    analysis = mk.loads("format: 1\nlinks: {a: {}}\njoints: {A: {type: W, links: [ground, a]}}")
    run = analysis.analyze()
    with pytest.raises(mk.ExpressionError) as raised:
        run["1 + norm(A.force"]
    named = re.findall(r"`error\.(offset|hint|position)`", PAGE)
    assert named
    assert all(hasattr(raised.value, name) for name in named)
    assert raised.value.offset == "1 + norm(".index("(")
