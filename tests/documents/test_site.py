"""The site: every page is in its navigation, links are checked, pictures become live pages."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest
import yaml
from documents.reading import ROOT

SITE = ROOT / "docs" / "site"
MADE = {"gallery.md", *(f"python/{n}.md" for n in ("model", "analysis", "answers", "exceptions"))}
"""Pages that only the site has."""


def part(name: str) -> ModuleType:
    """A module of the script that builds the site."""
    spec = importlib.util.spec_from_file_location(name, SITE / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def navigated(entry: object) -> list[str]:
    """The pages of a part of the navigation."""
    if isinstance(entry, str):
        return [entry]
    inside = entry.values() if isinstance(entry, dict) else entry
    assert isinstance(inside, list | type({}.values()))
    return [page for each in inside for page in navigated(each)]


def test_every_page_is_in_the_navigation_once() -> None:
    text = (SITE / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:")[2]
    listed = navigated(yaml.safe_load(f"nav:{text}"))
    assert len(listed) == len(set(listed))
    kept = {page.relative_to(ROOT).as_posix() for page in (ROOT / "docs").rglob("*.md")}
    assert kept | MADE <= set(listed)
    assert [one for one in set(listed) - MADE if not (ROOT / one).is_file()] == []


def test_broken_links_are_seen(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<h1 id="here">a</h1><a href="#here">1</a><a href="b.html#there">2</a>'
        '<a href="b.html#nowhere">3</a><a href="none.html">4</a><a href="../out.html">5</a>'
        '<img src="https://example.org/a.png"><a href="https://example.org">6</a>',
        encoding="utf-8",
    )
    (tmp_path / "b.html").write_text('<p id="there">b</p>', encoding="utf-8")
    found = [fault.split(": ")[1:] for fault in part("links").faults(tmp_path)]
    cure = "; correct the link, or the page it names"
    assert found == [
        ["../out.html", f"leads out of the site{cure}"],
        ["b.html#nowhere", f"b.html has no anchor nowhere{cure}"],
        ["none.html", f"no such file in the site{cure}"],
        ["https://example.org/a.png", f"is loaded from the network{cure}"],
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("![a press](../mechanisms/m/press/picture.svg)", 'src="../gallery/m/press.html"'),
        ("| ![a](../mechanisms/m/press/picture.svg) | b |", "](../gallery/m/press.html) | b |"),
        ("![a](../mechanisms/m/other/picture.svg)", "![a](../mechanisms/m/other/picture.svg)"),
        ("see ![a](../mechanisms/m/press/picture.svg)", "see ![a]("),
    ],
)
def test_pictures_of_mechanisms_lead_to_live_pages(
    tmp_path: Path, text: str, expected: str
) -> None:
    for name in ("docs/a.md", "gallery/m/press.html"):
        (tmp_path / name).parent.mkdir(parents=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    part("gather")._with_live_pages(tmp_path / "docs/a.md", tmp_path)
    assert expected in (tmp_path / "docs/a.md").read_text(encoding="utf-8")
