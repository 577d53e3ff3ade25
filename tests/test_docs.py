"""What README, changelog and docs point to exists, and what they show runs."""

import re
from pathlib import Path

import pytest
from references import RCSR

from mechkin_cli import tolerances

ROOT = RCSR.parents[2]
PAGES = sorted([ROOT / "README.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md")])
NAMES = [str(page.relative_to(ROOT)) for page in PAGES]
FENCES = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def prose(page: Path) -> str:
    return FENCES.sub("", page.read_text(encoding="utf-8"))


def anchor(heading: str) -> str:
    """The anchor that a heading gets on the usual hosts."""
    kept = "".join(c for c in heading.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def anchors(page: Path) -> set[str]:
    return {anchor(text) for text in re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)}


def broken_links(page: Path, text: str) -> list[str]:
    """Relative links whose file or heading is not there."""
    broken = []
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, heading = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists() or (heading and heading not in anchors(target)):
            broken.append(link)
    return broken


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_relative_links_resolve(page: Path) -> None:
    assert broken_links(page, prose(page)) == []


def test_a_broken_link_is_seen() -> None:
    page = ROOT / "docs/numerics.md"
    text = "[a](nowhere.md) [b](#no-such-heading) [c](#legs) [d](https://a.org) [e](../README.md)"
    assert broken_links(page, text) == ["nowhere.md", "#no-such-heading"]


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_files_named_exist(page: Path) -> None:
    named = re.findall(r"`((?:mechanisms|tests|mechkin_cli|schemas|docs)/[\w./]*)`", prose(page))
    rooms = re.findall(r"`(\w+/)`", prose(page))
    places = [ROOT / name for name in named] + [
        ROOT / room if (ROOT / room).exists() else ROOT / "mechkin_cli" / room for room in rooms
    ]
    assert [str(place) for place in places if not place.exists()] == []


SOURCES = [
    f"/{path.relative_to(ROOT)}"
    for folder in ("mechkin_cli", "tests", "benchmarks")
    for path in (ROOT / folder).rglob("*.*")
    if path.suffix in (".py", ".hpp", ".cpp", ".js") and "node_modules" not in path.parts
]


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_sources_named_exist(page: Path) -> None:
    """A source is named by the end of its path: `arc.cpp`, `structure/rank.py`."""
    named = set(re.findall(r"`([\w/]+\.(?:py|[hc]pp|js))`", prose(page))) - {"script.py"}
    assert {name for name in named if not any(s.endswith(f"/{name}") for s in SOURCES)} == set()


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_limits_named_exist(page: Path) -> None:
    named = set(re.findall(r"`([A-Z][A-Z0-9]*_[A-Z0-9_]+)`", prose(page))) - {"NO_COLOR"}
    assert {name for name in named if not hasattr(tolerances, name)} == set()


RUN_WITH_OUTPUT = ("scripting.md", "fit_examples.md")
"""Pages all of whose scripts `tests/documents/test_scripting.py` runs."""


@pytest.mark.parametrize("page", [page for page in PAGES if page.name not in RUN_WITH_OUTPUT])
def test_python_blocks_run(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    for language, code in FENCES.findall(page.read_text(encoding="utf-8")):
        if language == "python":
            exec(compile(code, page.name, "exec"), {})


def test_comments_that_cite_a_page_cite_one_of_the_repository() -> None:
    """`docs/numerics.md, Closing joints` in a comment is a file and a heading of it."""
    sources = [*(ROOT / "mechkin_cli").rglob("*.py"), *(ROOT / "mechkin_cli").rglob("*.[ch]pp")]
    cited = 0
    for source in sources:
        text = re.sub(r"\n(?://)? *", " ", source.read_text(encoding="utf-8"))
        assert not re.search(r"design(?:\.md| section)", text), source
        for path, heading in re.findall(r"\((docs/\w+\.md), ([\w ]+)\)", text):
            assert anchor(heading) in anchors(ROOT / path), (source, heading)
            cited += 1
    assert cited
