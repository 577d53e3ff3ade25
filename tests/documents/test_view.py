"""What the page about `mechkin view` tells is what it does."""

import re

import pytest
from documents.reading import blocks, page
from references import RCSR

import mechkin_cli as mk
from mechkin_cli.schema.base import fields_of
from mechkin_cli.schema.view import ViewSection
from mechkin_cli.view import page as limits
from mechkin_cli.view.page import PAGE_NAME

PAGE = page("docs/view.md")


def test_every_key_is_told_and_shown() -> None:
    keys = set(fields_of(ViewSection))
    assert set(re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE)) == keys
    (example,) = blocks(PAGE, "yaml")
    assert set(re.findall(r"^  (\w+):", example, re.MULTILINE)) == keys


def test_the_example_is_one_of_the_rcsr() -> None:
    (example,) = blocks(PAGE, "yaml")
    model = mk.loads(RCSR.read_text(encoding="utf-8") + "\n" + example)
    assert model.view_settings.speed == 6.0
    assert model.view_settings.hidden == {"coupler"}


LIMITS = ["MOST_POSES", "MOST_ROWS", "MOST_CELLS", "LEAST_ROWS"]
LIMITS += ["MOST_MODES", "MOST_MODE_ROWS", "MOST_MODE_POSES"]


@pytest.mark.parametrize("name", LIMITS)
def test_limits_are_those_of_the_code(name: str) -> None:
    table = PAGE.partition("## Limits")[2]
    assert str(getattr(limits, name)) in re.findall(r"\d+", table)


def test_the_file_is_called_so() -> None:
    assert f"`out/rcsr/{PAGE_NAME}`" in PAGE
