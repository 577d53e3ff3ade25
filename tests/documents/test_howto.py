"""The how-to pages: files are those kept, commands print what is shown, prose has its numbers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from documents.howto.pages import FENCE, PAGES, WHOLE, blocks, content, done, printed, saved
from documents.reading import page

NAMES = [path.stem for path in PAGES]
LONG = "many_variants"
"""Its study of 100 000 variants runs with fewer here."""
LONGEST = 130


def text_of(name: str) -> str:
    return page(f"docs/howto/{name}.md")


@pytest.mark.parametrize("name", NAMES)
def test_files_are_those_kept(name: str) -> None:
    for block in blocks(text_of(name)):
        if block.file is not None:
            whole = content(block.file)
            assert block.text in whole
            assert block.text == whole or not block.text.startswith(WHOLE)


@pytest.mark.parametrize("name", [name for name in NAMES if name != LONG])
def test_commands_print_what_is_shown(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = text_of(name)
    saved(text, tmp_path)
    ran = list(done(text))
    assert ran
    for _, shown, out in ran:
        assert out == shown, f"run `python -P tests/documents/howto {name}`"


def test_shares_of_the_long_study_merge(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = text_of(LONG)
    saved(text, tmp_path)
    drawn, shares = (block for block in blocks(text) if block.language == "sh")
    assert f"```sh\n{drawn.text}```\n\n```text\n{printed(drawn.text)}```" in text
    study = tmp_path / "studies/press_variants.yaml"
    fewer = study.read_text(encoding="utf-8").replace("count: 100000", "count: 500")
    study.write_text(fewer, encoding="utf-8")
    assert "500 variants: 500 ok" in printed(shares.text)
    printed("mechkin study studies/press_variants.yaml --out whole --quiet")
    assert Path("results/variants.csv").read_bytes() == Path("whole/variants.csv").read_bytes()


@pytest.mark.parametrize("name", NAMES)
def test_bold_numbers_are_printed(name: str) -> None:
    text = text_of(name)
    shown = " ".join(block.text for block in blocks(text) if block.language == "text")
    found = [float(number) for number in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?!\w)", shown)]
    said = re.findall(r"\*\*(-?\d+(?:\.\d+)?)\*\*", FENCE.sub("", text))
    assert said
    for number in said:
        decimals = len(number.partition(".")[2])
        assert any(round(one, decimals) == float(number) for one in found), number


@pytest.mark.parametrize("name", NAMES)
def test_a_page_has_its_parts(name: str) -> None:
    text = text_of(name)
    assert len(text.splitlines()) <= LONGEST
    assert re.search(r"^!\[[^]]+\]\(\S+/picture\.svg\)$", text, re.MULTILINE)
    assert "- **Next.**" in text
    assert {"sh", "text"} <= {block.language for block in blocks(text)}
