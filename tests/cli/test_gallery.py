"""`mechkin view FOLDER`: a page for each mechanism, and an index that links them."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

import pytest
from cli.conftest import Mechkin

from mechkin_cli.cli.messages import ExitCode

ARM = """\
format: 1
name: NAME
plane: xy
links: {arm: {}}
joints: {A: {type: R, links: [ground, arm], point: [0, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 10, step: 5}}}
"""


class Index(HTMLParser):
    """Tags, addresses and the text of an index."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.text = ""
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for key, value in attrs if key in ("href", "src")]

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.fixture
def mine(folder: Path) -> Path:
    """Two folders of mechanisms."""
    for place, name in (("a/arm.yaml", "an arm"), ("b/arm.yaml", "'<b>arm</b> & more'")):
        path = folder / "mine" / place
        path.parent.mkdir(parents=True)
        path.write_text(ARM.replace("NAME", name), encoding="utf-8")
    return folder / "mine"


def test_each_file_has_a_card_that_leads_to_its_page(mechkin: Mechkin, mine: Path) -> None:
    run = mechkin("view", "mine")
    assert (run.code, run.out) == (ExitCode.OK, "out/mine/index.html\n")
    assert run.err.startswith("2 of 2 mechanisms; ")
    index = Index(Path("out/mine/index.html"))
    assert index.addresses == ["a/arm.html", "a/arm.svg", "b/arm.html", "b/arm.svg"]
    assert all(Path("out/mine", address).is_file() for address in index.addresses)
    assert mechkin("view", "mine/a/arm.yaml", "-o", "arm.html").code == ExitCode.OK
    assert Path("arm.html").read_bytes() == Path("out/mine/a/arm.html").read_bytes()


def test_names_with_markup_are_text(mechkin: Mechkin, mine: Path) -> None:
    assert mechkin("view", "mine", "--quiet").err == ""
    index = Index(Path("out/mine/index.html"))
    assert "<b>arm</b> & more" in index.text
    assert "b" not in index.tags


def test_a_file_that_cannot_be_used_is_left_out_and_told(mechkin: Mechkin, mine: Path) -> None:
    (mine / "a/broken.yaml").write_text("format: 1\nnmae: x\n", encoding="utf-8")
    run = mechkin("view", "mine", "-o", "shown")
    assert run.code == ExitCode.INVALID_FILE
    assert "mine/a/broken.yaml:2:1" in run.err
    assert "2 of 3 mechanisms" in run.err
    assert not Path("shown/a/broken.html").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("mine", "--set", "r=1"), "name a file"),
        (("mine", "--run", "sweep"), "name a file"),
        (("empty",), "holds no mechanism files"),
        (("taken",), "rename it"),
    ],
)
def test_what_cannot_be_is_refused(
    mechkin: Mechkin, mine: Path, arguments: tuple[str, ...], words: str
) -> None:
    for name in ("empty", "taken"):
        Path(name).mkdir()
    Path("taken/index.yaml").write_text(ARM, encoding="utf-8")
    run = mechkin("view", *arguments)
    assert run.code == ExitCode.USAGE
    assert words in run.err
    assert not Path("out").exists()
