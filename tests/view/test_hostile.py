"""No text of a file can leave the element that holds the data, or pass for other text."""

from __future__ import annotations

import json
import re

import pytest
from view.files import FOUR_BAR
from view.seen import data

import mechkin_cli as mk
from mechkin_cli.view.page import PLACE, filled, script_json
from mechkin_cli.view.scene import view_scene

PAGE = f'<script type="application/json" id="mechkin-data">{PLACE}</script><p>end</p>'
TEXTS = [
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "]]>",
    "&lt;/script&gt;",
    "a\u202eb",
    PLACE,
    '"; alert(1); "',
    "\\u003c/script>",
    "$& $1 \\1",
    "\U0001f600",
    "=HYPERLINK(1)",
]


def page_of(text: str) -> str:
    scene, _ = view_scene(mk.loads(text).analyses(), False)
    return filled(PAGE, scene.record()).decode()


@pytest.mark.parametrize("text", TEXTS)
def test_a_hostile_text_stays_in_its_element(text: str) -> None:
    quoted = json.dumps(text, ensure_ascii=False)
    file = FOUR_BAR.replace("name: four-bar", f"name: {quoted}", 1)
    file = file.replace(
        "columns: [A.theta,", f"title: {quoted}, columns: [{{label: {quoted}, value: A.theta}},"
    )
    page = page_of(file)
    plain = page_of(FOUR_BAR)
    assert page.count("<") == plain.count("<") == PAGE.count("<")
    assert page.isascii()
    (inside,) = re.findall(r'id="mechkin-data">(.*?)</script>', page, re.DOTALL)
    shown = json.loads(inside)
    assert shown["tables"][0]["title"] == shown["name"] == shown["tables"][0]["columns"][0]["label"]
    assert shown["name"].isprintable()
    if text.isprintable():
        assert shown["name"] == text


def test_line_breaks_of_scripts_and_half_characters_are_escapes() -> None:
    """Files hold none of them; names of files may."""
    shown = json.loads(script_json({"file": "a\u2028b\udcffc\x00"}))
    assert shown == {"file": "a\\u2028b\\xffc\\x00"}


def test_messages_with_texts_of_the_file_are_words() -> None:
    text = FOUR_BAR.replace("name: four-bar", 'name: "<b>"', 1)
    assert "<b>" in data(mk.loads(text))["runs"][0]["title"]


def test_a_template_with_no_place_or_two_is_refused() -> None:
    for page in ("<p></p>", PAGE + PAGE):
        with pytest.raises(ValueError, match="not once"):
            filled(page, {})


def test_numbers_that_json_has_not_are_refused() -> None:
    with pytest.raises(ValueError, match="JSON"):
        script_json({"x": float("nan")})
