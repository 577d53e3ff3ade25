"""The page of the format has every key of the schemas, and is as they are."""

import json
from functools import cache
from typing import Any

import pytest
from documents.format.page import PAGE, page as made_anew
from documents.reading import ROOT, page

FORMAT = page("docs/format.md")
MADE = FORMAT.partition("<!-- made by")[2]


@cache
def rows() -> list[list[str]]:
    """The cells of all rows of all tables."""
    lines = [line for line in MADE.replace("\\|", "/").splitlines() if line.startswith("| `")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def keys() -> list[tuple[str, str, str, dict[str, Any]]]:
    """File, section, key and schema of everything that may be written."""
    found = []
    for name in ("mechanism", "study"):
        text = (ROOT / "schemas" / f"{name}.schema.json").read_text(encoding="utf-8")
        whole = json.loads(text)
        for section, part in ({"": whole} | whole["$defs"]).items():
            found += [(name, section, key, one) for key, one in part.get("properties", {}).items()]
    return found


def test_is_made_anew() -> None:
    again = "run `python -P tests/documents/format`"
    assert PAGE.read_text(encoding="utf-8") == made_anew(), again


def test_the_schemas_have_keys_enough_for_a_page() -> None:
    assert len(keys()) > 300


@pytest.mark.parametrize(("name", "section", "key", "value"), keys())
def test_every_key_stands_on_the_page(
    name: str, section: str, key: str, value: dict[str, Any]
) -> None:
    own = [cells for cells in rows() if cells[0].strip("`").rpartition(".")[2] == key]
    assert own, f"{section}.{key} of a {name} is not on the page"
    if key in ("type", "law") and "const" in value:
        assert any(f"`{value['const']}`" in " ".join(cells) for cells in own)
        return
    first = value["description"].replace("|", "/").partition(" Unit: ")[0]
    told = first.partition("; left out")[0].partition(". Left out")[0].rstrip(".")
    assert any(any(cell.startswith(told) for cell in cells) for cells in own), (section, told)


def test_every_row_says_all() -> None:
    for cells in rows():
        told, kind, absent, example = cells[-4:]
        assert told.endswith("."), cells
        assert kind, cells
        assert absent, cells
        assert example.startswith("`"), cells


def test_a_key_that_may_be_left_out_says_what_holds_then() -> None:
    silent = {cells[0] for cells in rows() if cells[-2] == "-"}
    # needed by some types of joint, chosen among keys of which one is needed, or said in its words
    told_otherwise = {"`at`", "`lead`", "`radius`", "`start`", "`stop.at`"}
    assert silent <= told_otherwise


def test_units_of_keys_are_those_of_the_schema() -> None:
    measured = [one for one in keys() if " Unit: that of " in one[3].get("description", "")]
    assert len(measured) > 60
    for _, section, key, value in measured:
        unit = value["description"].partition(" Unit: that of ")[2].partition(",")[0]
        own = [cells for cells in rows() if cells[0].strip("`").rpartition(".")[2] == key]
        assert any(unit in cells[-3] for cells in own), (section, key, unit)
