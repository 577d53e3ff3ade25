"""Every mistake is found, at its place, in words that help."""

from pathlib import Path

import pytest
from hypothesis import given, settings, strategies as st
from reading.bad_files import BAD_FILES, SOUND, BadFile

from mechkin_cli.building.source import open_text
from mechkin_cli.diagnostics import InvalidFile

GOOD = Path(__file__).parent / "good"


def messages(text: str) -> list[str]:
    with pytest.raises(InvalidFile) as caught:
        open_text(text, "bad.yaml")
    return [str(diagnostic) for diagnostic in caught.value.diagnostics]


def messages_if_any(text: str) -> list[str]:
    try:
        open_text(text, "bad.yaml")
    except InvalidFile as invalid:
        return [str(found) for found in invalid.diagnostics if found.code != "more"]
    return []


@pytest.mark.parametrize("bad", BAD_FILES, ids=lambda bad: repr(bad.text[-40:]))
def test_one_message_at_the_place_of_the_mistake(bad: BadFile) -> None:
    place = f"bad.yaml:{bad.place}: error:"
    found = messages(bad.text)
    assert any(text.startswith(place) and bad.words in text for text in found), found


def test_the_file_they_are_made_from_is_sound() -> None:
    assert list(open_text(SOUND, "sound.yaml")[0].joints) == ["O1"]


def test_independent_mistakes_are_reported_together_in_the_order_of_the_file() -> None:
    text = SOUND + "units: {lenght: in}\naccept: [all]\nparameters: {crank: 1, b: nan}\nidle: x\n"
    places = [message.split(": error")[0] for message in messages(text)]
    assert places == [
        "bad.yaml:5:9",
        "bad.yaml:6:10",
        "bad.yaml:7:14",
        "bad.yaml:7:27",
        "bad.yaml:8:7",
    ]


@pytest.mark.parametrize(
    ("right", "wrong"), [("point:", "pont:"), ("axis:", "Axis:"), ("links: [", "lins: [")]
)
def test_a_misspelt_key_is_not_reported_as_missing_as_well(right: str, wrong: str) -> None:
    (message,) = messages(SOUND.replace(right, wrong))
    assert f"there is no key '{wrong.partition(':')[0]}' here; did you mean {right[:4]}" in message
    assert "missing" not in message


def test_a_refused_item_is_not_reported_as_a_short_list_as_well() -> None:
    text = SOUND + "points: {p: {link: crank, at: [0, 0, nan]}}\n"
    assert len(messages(text)) == 1


def test_a_flood_of_mistakes_is_cut_off_with_a_count() -> None:
    text = SOUND + "parameters: {" + ", ".join(f"p{i}: nan" for i in range(200)) + "}\n"
    found = messages(text)
    assert len(found) == 51
    assert "150 more problems" in found[-1]


@pytest.mark.parametrize("key", ["(R)", "(", "[key]", "'0'", '""', "'a b'", '"\\x07"', "'#1'"])
def test_odd_keys_get_a_message(key: str) -> None:
    hinge = SOUND.splitlines()[-1].replace("point:", f"{key}: 1, point:").replace("O1", "O2")
    for line in (f"{key}: 1", f"  {key}: 1", hinge):
        assert all(message.startswith("bad.yaml:") for message in messages(f"{SOUND}{line}\n"))


CHARACTERS = st.sampled_from(" \n{}[],:-'\"#&*!|>?%(01a")
DAMAGE = st.tuples(st.integers(0, 10_000), st.integers(0, 20), CHARACTERS)


@given(st.sampled_from(sorted(GOOD.glob("*.yaml"))), st.lists(DAMAGE, min_size=1, max_size=4))
@settings(max_examples=150, deadline=None)
def test_damaged_files_are_read_or_refused(path: Path, damage: list[tuple[int, int, str]]) -> None:
    text = path.read_text(encoding="utf-8")
    for position, removed, added in damage:
        start = position % (len(text) + 1)
        text = text[:start] + added + text[start + removed :]
    assert all(message.startswith("bad.yaml:") for message in messages_if_any(text))


def test_messages_never_show_the_validator() -> None:
    inside = (
        "pydantic",
        "tuple",
        "dict",
        "Input should",
        "union",
        "(vector)",
        "(per link)",
        "None",
    )
    for bad in BAD_FILES:
        for message in messages(bad.text):
            assert not any(word in message for word in inside), message
