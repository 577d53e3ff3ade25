"""Each pair has a drawing, made anew as it is, with the coordinates that the joint table names."""

import re
from xml.etree import ElementTree

import pytest
from documents.joints.pairs import PAIRS
from documents.reading import ROOT, page

from mechkin_cli.mechanism.pairs import JOINT_TYPES, PLANE_JOINT_TYPES

PICTURES = ROOT / "docs" / "joints"
PAGES = page("docs/modelling.md") + page("docs/planar.md")
MARKED = {"Sp": {"normal"}, "Cp": {"normal"}}
"""What stands beside the coordinates."""


def picture(letter: str) -> str:
    """A drawing as it is kept."""
    return (PICTURES / f"{letter}.svg").read_text(encoding="utf-8")


def labels(letter: str) -> set[str]:
    """The words in a drawing."""
    texts = ElementTree.fromstring(picture(letter)).iter("{http://www.w3.org/2000/svg}text")
    return {word for text in texts for word in (text.text or "").split(", ")}


@pytest.mark.parametrize("letter", PAIRS)
def test_is_made_anew(letter: str) -> None:
    name, drawn = PAIRS[letter]
    assert picture(letter) == drawn().svg(name), "run `python -P tests/documents/joints`"


def test_every_pair_of_a_file_has_one_on_a_page() -> None:
    assert set(PAIRS) == set(JOINT_TYPES) | set(PLANE_JOINT_TYPES)
    assert {path.stem for path in PICTURES.iterdir()} == set(PAIRS)
    for letter, (name, _) in PAIRS.items():
        assert f"![{name}](joints/{letter}.svg)" in PAGES


@pytest.mark.parametrize("letter", PAIRS)
def test_shows_the_coordinates_of_the_joint_table(letter: str) -> None:
    types = PLANE_JOINT_TYPES if letter == "Ps" else JOINT_TYPES
    named = set(types[letter].coordinates)
    assert labels(letter) == named | MARKED.get(letter, set())


@pytest.mark.parametrize("letter", PAIRS)
def test_two_links_in_two_shades(letter: str) -> None:
    shades = set(re.findall(r'class="([ab])[012]"', picture(letter)))
    assert shades == {"a", "b"}


@pytest.mark.parametrize("letter", PAIRS)
def test_numbers_have_one_decimal_and_lie_in_the_picture(letter: str) -> None:
    ways = re.findall(r' d="M([^"]*?)Z?"', picture(letter))
    assert ways
    for way in ways:
        for place in way.split("L"):
            x, y = place.split(" ")
            assert re.fullmatch(r"-?\d+\.\d", x)
            assert re.fullmatch(r"-?\d+\.\d", y)
            assert 0.0 <= float(x) <= 150.0
            assert 0.0 <= float(y) <= 120.0
