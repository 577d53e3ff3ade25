"""The page on couplings shows each type by a picture that is made anew, and the coupling of that
picture."""

from __future__ import annotations

import pytest
import yaml
from documents.couplings.pictures import PICTURES, model, picture
from documents.reading import ROOT, page

from mechkin_cli.schema.json_schema import json_schema_text

FOLDER = ROOT / "docs" / "couplings"
PAGE = page("docs/couplings.md")


@pytest.mark.parametrize("name", PICTURES)
def test_is_made_anew(name: str) -> None:
    kept = (FOLDER / f"{name}.svg").read_text(encoding="utf-8")
    assert kept == picture(name), "run `python -P tests/documents/couplings`"


@pytest.mark.parametrize("name", PICTURES)
def test_stands_on_the_page_with_its_coupling(name: str) -> None:
    words, _, coupling = PICTURES[name]
    assert f"![{words}](couplings/{name}.svg)" in PAGE
    assert f"```yaml\nK: {coupling}\n```" in PAGE


@pytest.mark.parametrize("name", PICTURES)
def test_the_mechanism_runs(name: str) -> None:
    assert set(model(name).analyze()["row.status"]) == {"ok"}


def test_no_other_pictures_are_kept() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == set(PICTURES)


def test_every_type_of_a_coupling_is_on_the_page() -> None:
    """By the words that the schema takes; a table looks as a function does."""
    found = {yaml.safe_load(coupling)["type"] for _, _, coupling in PICTURES.values()}
    schema = json_schema_text()
    for word in ("gear", "rack", "belt", "chain", "cable", "screw", "linear", "function", "table"):
        assert f'"{word}"' in schema
        assert word in found or f"{{type: {word}," in PAGE.replace("\n", " ")
